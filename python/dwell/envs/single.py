"""One environment."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.envs.config import Houses, HouseShelf, Laws, Sensors, env_json, house_names
from dwell.envs.runner import INFO_KEYS, Runner
from dwell.envs.spaces import action_space, observation_space
from dwell.world import Camera

#: The image that ``render()`` gives.
RENDER_CAMERA = Camera(width=320, height=240, fov_deg=90.0)


class DwellEnv(gymnasium.Env[dict[str, Any], np.int64]):
    """A task in a house, with one agent.

    An episode's house is drawn from ``houses``, and everything else in it from the seed. The step
    limit belongs to ``gymnasium.make`` (a ``TimeLimit`` wrapper).
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - gymnasium declares it an instance variable
        "render_modes": ["rgb_array"],
        "render_fps": 20,
    }

    def __init__(
        self,
        task: str = "InstructionFollowing",
        *,
        houses: Houses = "builtin:apartment",
        sensors: Sensors = None,
        laws: Laws = None,
        parameters: Mapping[str, float] | None = None,
        task_settings: Mapping[str, Any] | None = None,
        stride: Mapping[str, float] | None = None,
        world: Mapping[str, Any] | None = None,
        threads: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment.

        Args:
            task: The task's name.
            houses: A HOUSE string or several.
            sensors: Names of sensors, or settings by name; default the task's own choice.
            laws: Laws to install, or the path of a JSON file with them.
            parameters: Values by address.
            task_settings: The task's own settings.
            stride: How far movement actions go: ``forward_m``, ``turn_deg``, ``look_deg``.
            world: Further fields of the native WorldConfig.
            threads: How many threads to use; results do not depend on it.
            render_mode: ``rgb_array`` or ``None``.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            modes = self.metadata["render_modes"]
            raise ValueError(f"render_mode: found {render_mode!r}, allowed are None and {modes}")
        self.render_mode = render_mode
        self._config = env_json(
            task,
            sensors=sensors,
            laws=laws,
            parameters=parameters,
            task_settings=task_settings,
            stride=stride,
            world=world,
        )
        self._shelf = HouseShelf(house_names(houses))
        self._threads = threads
        self._runners: dict[int, Runner] = {}
        self._house = 0
        self._episode = 0
        self._seed = 0
        self._alone = np.ones(1, np.bool_)
        self.observation_space = observation_space(self._runner.specs)
        self.action_space = action_space()

    @property
    def _runner(self) -> Runner:
        if self._house not in self._runners:
            houses = [self._shelf[self._house]]
            self._runners[self._house] = Runner(houses, self._config, self._threads)
        return self._runners[self._house]

    def _observation(self) -> dict[str, Any]:
        self._runner.observe(self._alone)
        return {
            name: value[0] if isinstance(value, tuple) else value[0].copy()
            for name, value in self._runner.observation().items()
        }

    def _info(self) -> dict[str, Any]:
        return {
            "scene_id": self._shelf.names[self._house],
            "episode_id": f"{self._shelf.names[self._house]}#{self._seed}",
            "seed": self._seed,
        }

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Starts an episode.

        Args:
            seed: Seeds this and all following episodes.
            options: ``house``: the number of the house to play in; else it is drawn.
        """
        super().reset(seed=seed)
        drawn = int(self.np_random.integers(len(self._shelf.names)))
        self._house = int((options or {}).get("house", drawn)) % len(self._shelf.names)
        self._seed = int(self.np_random.integers(2**63))
        self._runner.batch.reset([self._seed])
        return self._observation(), self._info()

    def step(
        self, action: np.int64 | int
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Makes one control step."""
        answer = self._runner.batch.step(np.array([action], np.int64))
        info: dict[str, Any] = {key: np.asarray(answer[key])[0].item() for key in INFO_KEYS}
        info["action_error"] = answer["action_error"][0]
        terminated = bool(answer["terminated"][0])
        return (
            self._observation(),
            float(answer["reward"][0]),
            terminated,
            False,
            {
                **info,
                **self._info(),
            },
        )

    def render(self) -> NDArray[np.uint8] | None:
        """What the agent sees, (240, 320, 3) uint8; ``None`` without a render mode."""
        if self.render_mode is None:
            return None
        camera = {key: getattr(RENDER_CAMERA, key) for key in ("width", "height", "fov_deg")}
        image: NDArray[np.uint8] = self._runner.batch.render(0, json.dumps(camera))
        return image

    def close(self) -> None:
        """Lets go of the worlds; may be called again."""
        self._runners.clear()

    def expert_action(self) -> int:
        """What the task's scripted expert would do now."""
        return int(self._runner.batch.expert_actions()[0])

    def state_hash(self) -> int:
        """A number that changes with any bit of state, physics, sound queues or random streams."""
        return self._runner.batch.state_hash(0)

    def snapshot(self) -> bytes:
        """The world as bytes."""
        return self._runner.batch.snapshot(0)

    def agents(self) -> list[dict[str, Any]]:
        """The agents' states."""
        agents: list[dict[str, Any]] = json.loads(self._runner.batch.agents_json(0))
        return agents

    def describe(self, level: str = "house") -> list[str]:
        """Sentences about the house as it starts; see :meth:`dwell.House.describe`."""
        return self._shelf[self._house].native.describe(level)

    def actions(self) -> list[str]:
        """The names of the actions, in the order of their numbers."""
        return _native.actions()
