"""What the ``reset`` of several environments is asked for."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import (
    integer_in_range,
    quoted,
    refuse_no_array,
    reset_options,
    sequence_items,
)


@dataclasses.dataclass(frozen=True)
class VectorReset:
    """What one call of ``reset`` asks for.

    Attributes:
        which: The environments to reset, shape (n,) bool.
        seeds: The seed of each environment, ``None`` for those that go on with their own.
        episode_ids: The ids of the episodes that are asked for, by environment, unchecked.
    """

    which: NDArray[np.bool_]
    seeds: list[int | None]
    episode_ids: dict[int, object]

    @classmethod
    def of(cls, seed: object, options: Mapping[str, object] | None, num_envs: int) -> VectorReset:
        """Reads the arguments of ``reset``.

        Args:
            seed: One seed (then environment k has ``seed + k``), or one for each environment.
            options: ``reset_mask`` and ``episode_id``.
            num_envs: How many environments there are.

        Raises:
            ConfigError: There is no such option, or one is not for each environment.
        """
        options = reset_options(options, "reset_mask", "episode_id")
        which = _mask(options.get("reset_mask"), num_envs)
        seeds = _seeds(seed, num_envs)
        return cls(which, seeds, _episode_ids(options.get("episode_id"), which))


def _mask(mask: object, num_envs: int) -> NDArray[np.bool_]:
    """The environments to reset, as C has them; all of them by default."""
    refuse_no_array("reset_mask", mask)
    if mask is None:
        return np.ones(num_envs, np.bool_)
    try:
        which = np.asarray(mask, order="C")
    except ValueError:
        expected = f"expected bool of shape ({num_envs},)"
        raise ConfigError(f"reset_mask is {quoted(mask)}; {expected}") from None
    if which.shape != (num_envs,) or which.dtype != np.bool_ or not which.any():
        raise ConfigError(
            f"reset_mask: expected bool of shape ({num_envs},) with a true element, found "
            f"{which.dtype} of shape {which.shape}"
        )
    return which


def _seeds(seed: object, num_envs: int) -> list[int | None]:
    """The seed of each environment."""
    if seed is None:
        return [None] * num_envs
    if isinstance(seed, int | np.integer):
        return [integer_in_range("seed", seed) + k for k in range(num_envs)]
    expected = "expected a whole number, or one for each environment"
    given = sequence_items("seed", seed, expected)
    seeds = [None if one is None else integer_in_range("seed", one) for one in given]
    if len(seeds) != num_envs:
        raise ConfigError(f"seed: expected {num_envs} seeds, found {len(seeds)}")
    return seeds


def _episode_ids(episodes: object, which: NDArray[np.bool_]) -> dict[int, object]:
    """The ids of the episodes that are asked for, by environment."""
    if episodes is None:
        return {}
    expected = f"expected one for each of {len(which)} environments, or None"
    if isinstance(episodes, str) or not isinstance(episodes, Sequence | np.ndarray):
        raise ConfigError(f"episode_id is {quoted(episodes)}; {expected}")
    if len(episodes) != len(which):
        raise ConfigError(f"episode_id: found {len(episodes)}; {expected}")
    asked = {k: one for k, one in enumerate(episodes) if one is not None}
    for k in asked:
        if not which[k]:
            raise ConfigError(
                f"episode_id[{k}] is {quoted(asked[k])}, and reset_mask leaves environment {k} "
                "out; expected None there"
            )
    return asked
