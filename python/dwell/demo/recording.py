"""The errand as a recording for the Rerun viewer, where the extra is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dwell import UsageError
from dwell.demo import episode, second_agent
from dwell.recording import Recording, record_house
from dwell.world import World

#: What the two agents are called in the viewer, and what is between errand and meeting, steps.
_NAMES, _BETWEEN = ("first", "second"), 20


def write(errand: dict[str, Any], meeting: dict[str, Any], folder: Path) -> dict[str, str]:
    """Writes ``errand.rrd``; returns its file, or a sentence why there is none.

    Args:
        errand: What :func:`dwell.demo.episode.run_episode` returned.
        meeting: What :func:`dwell.demo.second_agent.meet` returned.
        folder: Where the file goes.
    """
    path = folder / "errand.rrd"
    try:
        recording = Recording("dwell demo", path)
    except UsageError as error:
        return {"missing": f"No recording: {error}."}
    world: World = errand["world"]
    record_house(recording, world)
    recording.way("errand", errand["way"])
    for pose, frame in zip(errand["poses"], errand["frames"], strict=True):
        recording.step(pose["step"], pose, frame, episode.CAMERA)
    _meeting(recording, errand["steps"] + _BETWEEN, meeting)
    recording.close()
    return {"file": path.name}


def _meeting(recording: Recording, begins: int, meeting: dict[str, Any]) -> None:
    """The second agent and the first one, behind the errand on the same line of time."""
    if "refused" in meeting:
        return
    for name, way in zip(_NAMES, meeting["ways"], strict=True):
        recording.way(f"meeting, {name}", way)
    told: dict[int, list[tuple[str, str]]] = {step: [] for step, _, _ in meeting["told"]}
    for step, whose, what in meeting["told"]:
        told[step].append((_NAMES[whose], what))
    shown = {step: (k, states) for k, (step, states) in enumerate(meeting["poses"])}
    for step in range(meeting["steps"] + 1):
        recording.at_step(begins + step)
        if step in shown:
            k, states = shown[step]
            for name, state in zip(_NAMES, states, strict=True):
                frame = meeting["frames"][k] if name == _NAMES[0] else None
                recording.step(
                    begins + step, state, frame, second_agent.CAMERA, name=name, label=name
                )
        for name, what in told.get(step, []):
            recording.told(name, what)
        if step > 0:
            recording.ears(_NAMES[0], meeting["levels_db"][step - 1])
