"""One instruction, followed by the task's scripted expert through the gymnasium environment."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dwell import DwellError
from dwell.demo.animation import save_film
from dwell.envs.single import DwellEnv

_SEED = 5
_MAX_STEPS = 600


def follow(house: str, folder: Path) -> dict[str, Any]:
    """Plays one episode; returns the text, whether it was fulfilled, the way, the film's file."""
    sensors = {
        "rgb": {"width": 256, "height": 192},
        "instruction": {},
    }
    try:
        env = DwellEnv(houses=house, sensors=sensors)
        observation, _ = env.reset(seed=_SEED)
    except DwellError as error:
        return {"refused": str(error)}
    way, frames = [env.agents()[0]["position"]], [observation["rgb"]]
    text, terminated, steps = str(observation["instruction"]), False, 0
    info: dict[str, Any] = {}
    while not terminated and steps < _MAX_STEPS:
        observation, _, terminated, _, info = env.step(env.expert_action())
        steps += 1
        way.append(env.agents()[0]["position"])
        if steps % 3 == 0:
            frames.append(observation["rgb"])
    save_film(frames, folder / "instruction.gif", frame_s=0.15)
    return {
        "text": text,
        "success": bool(info.get("success", False)),
        "spl": info.get("spl", 0.0),
        "steps": steps,
        "way": way,
        "film": "instruction.gif",
    }
