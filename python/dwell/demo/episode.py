"""An errand with hands and ears: open a door, let something fall, go and hear what sounds."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import DwellError
from dwell.actions import Outcome
from dwell.camera import Camera
from dwell.demo.animation import save_film
from dwell.demo.spectrogram import save_spectrogram
from dwell.house import House
from dwell.sounds import write_wav
from dwell.world import World, actions

#: What it sees with.
CAMERA = Camera(256, 192)
_SAMPLES = 800
_RATE_HZ = 16_000
#: Steps that one walk may take, and that all may take together.
_MAX_WALK_STEPS = 220
_MAX_STEPS = 520
#: Below this nothing is heard, dB SPL.
_SILENCE_DB = 0.0


class DemoAgent:
    """An agent that is led through a world, with what it saw, heard and did."""

    def __init__(self, house: House) -> None:
        """Puts the agent into the hallway, or into the first room of a house without one."""
        self.world = World(house)
        self.rooms = house.rooms()
        start = next((room for room in self.rooms if "hallway" in room["kinds"]), self.rooms[0])
        self.world.place_agent(start["stand"], start["yaw_deg"])
        self.frames: list[NDArray[Any]] = []
        self.sound: list[NDArray[np.float32]] = []
        self.way: list[list[float]] = [self.position()]
        self.poses: list[dict[str, Any]] = []
        self.log: list[dict[str, Any]] = []

    def position(self) -> list[float]:
        """The agent's position, m."""
        place: list[float] = self.world.agents()[0]["position"]
        return place

    def act(self, action: int | str) -> Outcome:
        """Makes one step, and looks and listens."""
        outcome = self.world.do(action)
        self.sound.append(self.world.listen(_SAMPLES))
        self.way.append(self.position())
        if len(self.way) % 4 == 0:
            image = self.world.render(camera=CAMERA)["rgb"]
            self.frames.append(image)
            self.poses.append({"step": len(self.way), **self.world.agents()[0]})
        return outcome

    def tired(self) -> bool:
        """True if the errand has become too long."""
        return len(self.way) > _MAX_STEPS

    def note(self, what: str, outcome: Outcome) -> None:
        """Writes a line of the log."""
        self.log.append(
            {
                "what": what,
                "success": outcome.success,
                "code": outcome.code,
                "sentence": outcome.sentence or "Done.",
                "time_s": round(len(self.way) * 0.05, 2),
            }
        )

    def walk_to(self, goal: list[float]) -> bool:
        """Walks to a point; doors on the way are opened."""
        for _ in range(_MAX_WALK_STEPS):
            if self.tired():
                return False
            step = self.world.toward(goal)
            if step is None:
                return True
            self.act(step)
        return False

    def face(self, thing: str) -> bool:
        """Turns to a thing; whether it is then in the middle of the view."""
        for _ in range(60):
            step = self.world.facing(thing)
            if step is None:
                break
            self.act(step)
        return self.world.gaze_target() == thing


def _distance(a: list[float], b: list[float]) -> float:
    return float(np.hypot(a[0] - b[0], a[2] - b[2]))


def _open_a_door(walker: DemoAgent) -> None:
    here = walker.position()
    doors = [
        thing
        for thing in walker.world.objects()
        if thing["category"] == "door" and thing["openness"] is not None
    ]

    def order(door: dict[str, Any]) -> tuple[bool, float]:
        return door["openness"] >= 0.5, _distance(here, door["center"])

    for door in sorted(doors, key=order)[:3]:
        # Where every door stands open, one is closed instead.
        what = "open" if door["openness"] < 0.5 else "close"
        # A step back from the door on the side on which one stands.
        away = np.array(here) - np.array(door["center"])
        away[1] = 0.0
        spot = np.array(door["center"]) + away / max(float(np.linalg.norm(away)), 1e-6) * 1.2
        spot[1] = here[1]
        try:
            reached = walker.walk_to([float(value) for value in spot])
        except DwellError:
            continue
        if reached and walker.face(door["name"]):
            outcome = walker.act(what)
            walker.note(f"{what} {door['name']}", outcome)
            if outcome.success:
                for _ in range(30):
                    walker.act("wait")
                return
    if not walker.log:
        why = "No door could be reached." if doors else "No door in this house can be moved."
        walker.log.append(_nothing_to_do("open a door", why))


def _nothing_to_do(what: str, sentence: str) -> dict[str, Any]:
    return {"what": what, "success": False, "code": "none", "sentence": sentence, "time_s": 0.0}


def _take_and_drop(walker: DemoAgent) -> None:
    here = walker.position()
    things = [
        thing
        for thing in walker.world.objects()
        if thing["pickable"] and thing["center"][1] - here[1] < 1.8
    ]

    def order(thing: dict[str, Any]) -> tuple[bool, float]:
        handy = max(thing["size"]) < 0.45 and 0.3 < thing["center"][1] - here[1] < 1.3
        return not handy, _distance(here, thing["center"])

    tried = 0
    for thing in sorted(things, key=order):
        if tried >= 4 or walker.tired():
            break
        try:
            goal = [thing["center"][0], here[1], thing["center"][2]]
            if walker.world.native.path(0, (goal[0], goal[1], goal[2])) is None:
                continue
            tried += 1
            walker.walk_to(goal)
        except DwellError:
            continue
        walker.face(thing["name"])
        outcome = walker.act("pick")
        walker.note(f"take {thing['name']}", outcome)
        if outcome.success:
            for action in ("turn_right", "turn_right", "turn_right", "wait", "wait"):
                walker.act(action)
            walker.note(f"let go of {thing['name']}", walker.act("drop"))
            for _ in range(15):
                walker.act("wait")
            return
    if not any(line["what"].startswith("take") for line in walker.log):
        why = "Nothing that a hand can take is in reach."
        why = why if things else "Nothing in this house is for a hand to take."
        walker.log.append(_nothing_to_do("take something", why))


def _level_db(sound: NDArray[Any]) -> float | None:
    """The mean level of pressure in Pa, dB SPL; ``None`` for silence."""
    rms = float(np.sqrt(np.mean(np.square(sound, dtype=np.float64)))) if sound.size else 0.0
    level = 20.0 * float(np.log10(max(rms, 1e-12) / 20e-6))
    return round(level, 1) if level > _SILENCE_DB else None


def _visit_a_sound(walker: DemoAgent) -> None:
    """Goes to the radio, or to whatever else sounds, and tells what is heard there."""
    here = walker.position()
    sources = [thing for thing in walker.world.objects() if thing["sounds"]]

    def order(thing: dict[str, Any]) -> tuple[bool, float]:
        return thing["category"] != "radio", _distance(here, thing["center"])

    rooms = {room["name"]: room for room in walker.rooms}
    source = next((thing for thing in sorted(sources, key=order) if thing["room"] in rooms), None)
    if source is None:
        what = "go to what sounds"
        walker.log.append(_nothing_to_do(what, "Nothing in this house makes a sound of its own."))
        return
    name, room = source["name"], rooms[source["room"]]
    if source["on"] is False:
        walker.note(f"switch {name} on", walker.world.act("toggle", name))
    try:
        arrived = walker.walk_to(room["stand"])
    except DwellError:
        arrived = False
    for _ in range(30):
        walker.act("wait")
    plays = any(
        thing["name"] == name and thing["on"] is not False for thing in walker.world.objects()
    )
    level = _level_db(np.concatenate(walker.sound[-20:], axis=1))
    heard = "Nothing is heard here." if level is None else f"{level:.0f} dB SPL are heard here."
    state = "It plays." if plays else "It is switched off."
    walker.log.append(
        {
            "what": f"walk to {name} in the {next(iter(room['kinds']), 'room')}",
            "success": arrived,
            "code": "done" if arrived else "blocked",
            "sentence": f"{state} {heard}" if arrived else f"The way was too long. {heard}",
            "time_s": round(len(walker.way) * 0.05, 2),
        }
    )


def run_episode(house: House, folder: Path, progress: Callable[[float], None]) -> dict[str, Any]:
    """Runs the errand; writes its film, its sound and the sound's picture."""
    walker = DemoAgent(house)
    for k, part in enumerate((_open_a_door, _take_and_drop, _visit_a_sound)):
        part(walker)
        progress((k + 1) / 3)
    save_film(
        walker.frames or [walker.world.render(camera=CAMERA)["rgb"]],
        folder / "errand.gif",
        frame_s=0.12,
    )
    sound = np.concatenate(walker.sound or [np.zeros((2, _SAMPLES), np.float32)], axis=1)
    peak = max(float(np.abs(sound).max()), 1e-6)
    # 16 bits: browsers play them all, and as loud as they can.
    write_wav(folder / "errand.wav", sound, _RATE_HZ, full_scale_pa=peak)
    save_spectrogram(sound, _RATE_HZ, folder / "spectrogram.png")
    return {
        "log": walker.log,
        "way": walker.way,
        "poses": walker.poses,
        "frames": walker.frames,
        "steps": len(walker.way),
        "film": "errand.gif",
        "wav": "errand.wav",
        "full_scale_pa": peak,
        "spectrogram": "spectrogram.png",
        "level_db": _level_db(sound),
        "actions": actions(),
        "world": walker.world,
    }
