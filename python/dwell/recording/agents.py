"""Several agents in a recording: where they go, what they see, say, hear and hold."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from dwell.camera import Camera
from dwell.recording.viewer import Recording
from dwell.replay_agents import AgentStep
from dwell.world import World

_REFERENCE_PA = 2e-5
#: What is fainter is shown as this, dB SPL.
_FAINTEST_DB = 0.0


class RecordedAgents:
    """The agents of an episode while it is recorded."""

    def __init__(
        self, recording: Recording, camera: Camera, listeners: Collection[str] | None = None
    ) -> None:
        """Begins.

        Args:
            recording: Where they are shown.
            camera: What their eyes see with.
            listeners: Whose ears are opened, if they are not open; default all. A scripted agent
                may act by what it hears: its ears stay as they are, or it would act otherwise.
        """
        self._recording, self._camera, self._listeners = recording, camera, listeners
        self._ways: dict[str, list[list[float]]] = {}
        self._holds: dict[str, str | None] = {}
        self._ended: set[str] = set()

    def step(self, step: int, world: World, agents: Mapping[str, AgentStep]) -> None:
        """Shows all agents of a world after a step."""
        recording, names = self._recording, [*agents]
        if step == 0:
            asked = [f"{name}: {agents[name].instruction}" for name in names]
            recording.text("instruction", "\n".join(asked))
        states = world.agents()
        objects = world.objects() if any(row["holding"] is not None for row in states) else []
        for k, name in enumerate(names):
            state = states[k]
            self._ways.setdefault(name, []).append(state["position"])
            thing = None if state["holding"] is None else objects[state["holding"]]
            held = None if thing is None else str(thing["name"])
            label = name if held is None else f"{name}, holds {held}"
            image = world.render(agent=k, camera=self._camera)["rgb"]
            recording.step(step, state, image, self._camera, name=name, label=label)
            self._tell_hands(name, held, thing)
            self._tell_words(name, agents[name], world.heard(k), names)
            if not agents[name].acts and name not in self._ended:
                self._ended.add(name)
                recording.told(name, "succeeded" if agents[name].success else "ended")
            if self._listeners is None or name in self._listeners:
                recording.ears(name, _levels_db(world.listen(world.samples_a_step, agent=k)))

    def finish(self) -> None:
        """Shows the ways that were gone."""
        for name, way in self._ways.items():
            self._recording.way(name, way)

    def _tell_hands(self, name: str, held: str | None, thing: Mapping[str, Any] | None) -> None:
        before = self._holds.get(name)
        if held is not None or before is not None:
            self._recording.holds(name, held, None if thing is None else thing["center"])
        if held != before:
            self._recording.told(
                name, f"takes {held}" if before is None else f"lets go of {before}"
            )
        self._holds[name] = held

    def _tell_words(
        self, name: str, agent: AgentStep, heard: list[dict[str, Any]], names: list[str]
    ) -> None:
        if agent.says:
            self._recording.told(name, f"says ({agent.effort}): {' '.join(agent.says)}")
        for row in heard:
            word = "a word that it does not understand" if row["word"] is None else row["word"]
            self._recording.told(
                name,
                f"hears {names[row['speaker']]}: {word} ({row['level_db']:.0f} dB SPL, "
                f"STI {row['sti']:.2f})",
            )


def _levels_db(sound: np.ndarray[Any, np.dtype[np.float32]]) -> list[float]:
    """The levels of both ears, dB SPL."""
    powers = np.square(sound, dtype=np.float64).mean(axis=1) / _REFERENCE_PA**2
    return [max(_FAINTEST_DB, 10.0 * float(np.log10(power + 1e-12))) for power in powers]
