"""Infos that libraries of tensors take."""

from __future__ import annotations

from typing import Any

from pettingzoo.utils import BaseParallelWrapper

ByAgent = dict[str, dict[str, Any]]


class PlainInfos(BaseParallelWrapper):  # type: ignore[misc] # untyped
    """Leaves of each info its ``action_mask``, where there is one, and nothing else.

    TorchRL's ``PettingZooWrapper`` makes tensors of all that infos hold, and takes it for granted
    that ``reset`` and ``step`` give the same keys; names of houses and goals are text.
    """

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[ByAgent, ByAgent]:
        """As the environment's, with fewer infos."""
        observations, infos = self.env.reset(seed=seed, options=options)
        return observations, _plain(infos)

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[ByAgent, dict[str, float], dict[str, bool], dict[str, bool], ByAgent]:
        """As the environment's, with fewer infos."""
        observations, rewards, terminations, truncations, infos = self.env.step(actions)
        return observations, rewards, terminations, truncations, _plain(infos)


def _plain(infos: ByAgent) -> ByAgent:
    return {
        name: {key: value for key, value in info.items() if key == "action_mask"}
        for name, info in infos.items()
    }
