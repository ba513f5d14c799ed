"""An errand with hands and ears: open a door, take something and let it fall, hear the radio."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import DwellError
from dwell.demo.film import save_film
from dwell.demo.spectrogram import save_spectrogram
from dwell.house import House
from dwell.sounds import write_wav
from dwell.world import Camera, Outcome, World, actions

_CAMERA = Camera(256, 192)
_SAMPLES = 800
_RATE_HZ = 16_000
#: Steps that one walk may take, and that all may take together.
_LONGEST_WALK = 220
_LONGEST = 520


class Walker:
    """An agent that is led through a world, with what it saw, heard and did."""

    def __init__(self, house: House) -> None:
        """Puts the agent into the room in which one can stand most freely."""
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
        """Where it stands, m."""
        place: list[float] = self.world.agents()[0]["position"]
        return place

    def act(self, action: int | str) -> Outcome:
        """Makes one step, and looks and listens."""
        outcome = self.world.do(action)
        self.sound.append(self.world.listen(_SAMPLES))
        self.way.append(self.position())
        if len(self.way) % 4 == 0:
            image = self.world.render(camera=_CAMERA)["rgb"]
            self.frames.append(image)
            self.poses.append({"step": len(self.way), **self.world.agents()[0]})
        return outcome

    def tired(self) -> bool:
        """Whether the errand has become too long."""
        return len(self.way) > _LONGEST

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
        x, y, z = goal
        for _ in range(_LONGEST_WALK):
            if self.tired():
                return False
            step = self.world.native.guide(0, (x, y, z))
            if step is None:
                return True
            self.act(step)
        return False

    def face(self, thing: str) -> bool:
        """Turns to a thing; whether it is then in the middle of the view."""
        for _ in range(60):
            step = self.world.native.face(0, thing)
            if step is None:
                break
            self.act(step)
        return self.world.native.gaze_target(0) == thing


def _distance(a: list[float], b: list[float]) -> float:
    return float(np.hypot(a[0] - b[0], a[2] - b[2]))


def _open_a_door(walker: Walker) -> None:
    here = walker.position()
    doors = [
        thing
        for thing in walker.world.objects()
        if thing["category"] == "door" and thing["openness"] is not None and thing["openness"] < 0.5
    ]
    for door in sorted(doors, key=lambda door: _distance(here, door["center"]))[:3]:
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
            outcome = walker.act("open")
            walker.note(f"open {door['name']}", outcome)
            if outcome.success:
                for _ in range(30):
                    walker.act("wait")
                return
    if not walker.log:
        walker.log.append(_nothing("open a door", "No closed door could be reached."))


def _nothing(what: str, sentence: str) -> dict[str, Any]:
    return {"what": what, "success": False, "code": "none", "sentence": sentence, "time_s": 0.0}


def _take_and_drop(walker: Walker) -> None:
    here = walker.position()
    things = [
        thing
        for thing in walker.world.objects()
        if thing["pickable"] and max(thing["size"]) < 0.45 and 0.3 < thing["center"][1] < 1.3
    ]
    tried = 0
    for thing in sorted(things, key=lambda thing: _distance(here, thing["center"])):
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
        walker.log.append(_nothing("take something", "Nothing that a hand can take is in reach."))


def _visit_the_radio(walker: Walker) -> None:
    things = walker.world.objects()
    radio = next((thing for thing in things if thing["category"] == "radio"), None)
    room = radio and next((room for room in walker.rooms if room["name"] == radio["room"]), None)
    if radio is None or room is None:
        walker.log.append(_nothing("pass the radio", "There is no radio in this house."))
        return
    if radio["on"] is False:
        walker.note("switch the radio on", walker.world.act("toggle", radio["name"]))
    arrived = walker.walk_to(room["stand"])
    for _ in range(30):
        walker.act("wait")
    kind = next(iter(room["kinds"]), "room")
    walker.log.append(
        {
            "what": f"walk to the radio in the {kind}",
            "success": arrived,
            "code": "done" if arrived else "blocked",
            "sentence": "It plays." if arrived else "The way was too long.",
            "time_s": round(len(walker.way) * 0.05, 2),
        }
    )


def walk(house: House, folder: Path, progress: Callable[[float], None]) -> dict[str, Any]:
    """Runs the errand; writes its film, its sound and the sound's picture."""
    walker = Walker(house)
    for k, part in enumerate((_open_a_door, _take_and_drop, _visit_the_radio)):
        part(walker)
        progress((k + 1) / 3)
    save_film(
        walker.frames or [walker.world.render(camera=_CAMERA)["rgb"]],
        folder / "errand.gif",
        frame_s=0.12,
    )
    sound = np.concatenate(walker.sound or [np.zeros((2, _SAMPLES), np.float32)], axis=1)
    peak = max(float(np.abs(sound).max()), 1e-6)
    write_wav(folder / "errand.wav", sound, _RATE_HZ, full_scale_pa=peak)
    save_spectrogram(sound, _RATE_HZ, folder / "spectrogram.png")
    rms = float(np.sqrt(np.mean(sound.astype(np.float64) ** 2)))
    return {
        "log": walker.log,
        "way": walker.way,
        "poses": walker.poses,
        "frames": walker.frames,
        "steps": len(walker.way),
        "film": "errand.gif",
        "wav": "errand.wav",
        "spectrogram": "spectrogram.png",
        "level_db": round(20.0 * float(np.log10(max(rms, 1e-12) / 20e-6)), 1),
        "actions": actions(),
        "world": walker.world,
    }
