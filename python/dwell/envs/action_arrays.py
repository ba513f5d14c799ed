"""The numbers of actions are checked: fields, choices and shares, one for each environment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import abbreviated_list, mapping, quoted, refuse_no_array


def stacked_fields(at: str, action: object, keys: Sequence[str]) -> dict[str, Any]:
    """An action of one environment as those of several."""
    return {key: [value] for key, value in exact_fields(at, action, keys).items()}


def exact_fields(at: str, actions: object, keys: Sequence[str]) -> dict[str, Any]:
    """The parts of an action, which has these and no others.

    Raises:
        ConfigError: It is none.
    """
    given = mapping(at, actions, f"a mapping with {', '.join(keys)}")
    if set(given) != set(keys):
        raise ConfigError(f"{at} has {sorted(map(str, given))}; expected {sorted(keys)}")
    return given


def plain_array(at: str, given: object, expected: str) -> NDArray[Any]:
    """Any numbers as an array.

    Raises:
        ConfigError: They are none; the message says what was ``expected``.
    """
    refuse_no_array(at, given)
    try:
        return np.asarray(given)
    except (ValueError, np.ma.MaskError):
        raise ConfigError(f"{at} are {quoted(given)}; expected {expected}") from None


def choices_below(at: str, given: object, count: int, choices: int) -> NDArray[np.int64]:
    """Whole numbers below ``choices``, one for each of ``count`` environments.

    Raises:
        ConfigError: They are none.
    """
    expected = f"whole numbers of shape ({count},)"
    numbers = plain_array(at, given, expected)
    if numbers.shape != (count,) or numbers.dtype.kind not in "iu":
        raise ConfigError(
            f"{at}: expected {expected}, found {numbers.dtype} of shape {numbers.shape}"
        )
    wrong = np.flatnonzero((numbers < 0) | (numbers >= choices)).tolist()
    if wrong:
        raise ConfigError(
            f"{at} of environments {abbreviated_list(wrong)} are "
            f"{abbreviated_list(numbers[wrong].tolist())}; allowed are 0 to {choices - 1}"
        )
    return numbers.astype(np.int64)


def whole_numbers(at: str, given: object, shape: tuple[int], last: int) -> NDArray[np.int64]:
    """Whole numbers up to ``last``; one environment's may be alone.

    Raises:
        ConfigError: They are none.
    """
    numbers = np.atleast_1d(plain_array(at, given, "whole numbers"))
    return choices_below(at, numbers, shape[0], last + 1)


def numbers_within(
    at: str, given: object, shape: tuple[int], width: int, span: tuple[float, float]
) -> NDArray[np.float32]:
    """Numbers within bounds, shape (environment, ``width``).

    Raises:
        ConfigError: They are none.
    """
    (low, high), wanted = span, (*shape, width)
    expected = f"numbers of shape {wanted if shape != (1,) else (width,)} from {low:g} to {high:g}"
    numbers = plain_array(at, given, expected)
    if shape == (1,) and numbers.shape == (width,):
        numbers = numbers[np.newaxis]
    if numbers.shape != wanted or numbers.dtype.kind not in "iuf":
        raise ConfigError(
            f"{at}: expected {expected}, found {numbers.dtype} of shape {numbers.shape}"
        )
    if not ((numbers >= low) & (numbers <= high)).all():
        raise ConfigError(f"{at}: expected {expected}, found {quoted(numbers.tolist())}")
    return numbers.astype(np.float32)
