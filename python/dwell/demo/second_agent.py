"""A second agent in another room, which is heard before it is seen."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import DwellError
from dwell.camera import Camera
from dwell.demo.animation import save_film
from dwell.envs.action_modes import EngineActions
from dwell.envs.agent_settings import MultiAgentSetup
from dwell.envs.native_batch import NativeBatch
from dwell.house import House
from dwell.world import World, actions

#: What the first agent sees with; the mask says what of the other is in view.
CAMERA = Camera(192, 144)
_SEED = 5
#: Steps: before the other speaks, that it speaks before it walks, at most, after it came into view.
_QUIET, _SPEAKS_FIRST, _MAX_STEPS, _AFTER = 10, 30, 260, 20
#: A picture of the film is taken in one of so many steps.
_FRAME_EVERY = 3
#: The way between the two at the start is about so long, m.
_WAY_M = 6.0
#: How far a turn goes, degrees.
_TURN_DEG = 9.0
#: Pixels of the other that count as seen.
_SEEN_PX = 12
#: What it says, over and over, and how loudly.
_WORDS, _EFFORT = ("come", "here", "please"), "loud"
_REFERENCE_PA = 2e-5
#: The two.
LISTENER, OTHER = 0, 1


def meet(house: House, folder: Path) -> dict[str, Any]:
    """The other speaks and comes; the first stands and turns to where it hears words come from.

    Who comes is led by the navigation; who listens goes by what it hears alone
    (:meth:`dwell.World.heard`).

    Returns:
        ``heard`` and ``seen``: the first word that was understood, and the first step with the
        other in the instance mask; ``None`` where there is none. Levels at both ears by step, ways,
        frames and the film's file. Or ``refused``: why there is nothing to show.
    """
    setup = MultiAgentSetup.plain("Free", 2)
    runner = NativeBatch([house], setup.config, None)
    runner.reset([_SEED])
    world = runner.world(0)
    places = _places(world)
    if places is None:
        return {"refused": "No room of this house lies out of sight of another that leads to it."}
    stand, yaw_deg, far = places
    world.place_agent(far, agent=OTHER)
    world.place_agent(stand, yaw_deg, agent=LISTENER)
    meeting = _Meeting(runner, world, stand)
    while not meeting.is_over and len(meeting.levels) < _MAX_STEPS:
        meeting.step()
    save_film(meeting.frames, folder / "second_agent.gif", frame_s=0.15)
    return {
        "heard": meeting.heard,
        "seen": meeting.seen,
        "words": " ".join(_WORDS),
        "effort": _EFFORT,
        "steps": len(meeting.levels),
        "levels_db": meeting.levels,
        "step_s": meeting.step_s,
        "ways": meeting.ways,
        "poses": meeting.poses,
        "frames": meeting.frames,
        "told": meeting.told,
        "film": "second_agent.gif",
    }


def _places(world: World) -> tuple[list[float], float, list[float]] | None:
    """Where the first stands and faces, and where the other starts: far off, out of sight."""
    rooms = world.house.rooms()
    start = next((room for room in rooms if "hallway" in room["kinds"]), rooms[0])
    grid = world.navigation()
    ways: list[tuple[float, list[float]]] = []
    for room in rooms:
        try:
            way_m = grid.distance(room["stand"], start["stand"])
        except DwellError:
            continue
        if way_m is not None and room["name"] != start["name"]:
            ways.append((way_m, room["stand"]))
    number = _instance_id(world, OTHER)
    # Not too far: it is to come into view before the reader tires.
    for way_m, stand in sorted(ways, key=lambda row: (abs(row[0] - _WAY_M), row[0])):
        world.place_agent(stand, agent=OTHER)
        world.place_agent(start["stand"], start["yaw_deg"], agent=LISTENER)
        if way_m > 1.0 and not _is_seen_around(world, start["stand"], number):
            return start["stand"], start["yaw_deg"], stand
    return None


def _is_seen_around(world: World, stand: list[float], number: int) -> bool:
    """Whether an entity is seen from a place in any direction."""
    for quarter in range(4):
        world.place_agent(stand, 90.0 * quarter, agent=LISTENER)
        if _pixels(world, number):
            return True
    return False


def _instance_id(world: World, agent: int) -> int:
    """The number of an agent in instance images: they come behind all objects."""
    return max((int(row["id"]) for row in world.objects()), default=0) + 1 + agent


def _pixels(world: World, number: int) -> int:
    """How many pixels of the first agent's view are of an entity."""
    mask = world.render(agent=LISTENER, camera=CAMERA, channels=["instance"])["instance"]
    return int((mask == number).sum())


class _Meeting:
    """The two in their world, with what the first one heard and saw."""

    def __init__(self, runner: NativeBatch, world: World, goal: list[float]) -> None:
        self._runner, self._world, self._goal = runner, world, goal
        self._samples = world.samples_a_step
        self.step_s = self._samples / world.sound_rate_hz
        self._number = _instance_id(world, OTHER)
        #: Of a turn to where a word came from: steps, positive to the left.
        self._turns = 0
        self.heard: dict[str, Any] | None = None
        self.seen: dict[str, Any] | None = None
        #: Of each step the levels at the left and the right ear, dB SPL.
        self.levels: list[list[float]] = []
        self.frames: list[NDArray[Any]] = []
        self.ways: list[list[list[float]]] = [[], []]
        #: Of each frame the step and both agents' states.
        self.poses: list[tuple[int, list[dict[str, Any]]]] = []
        #: Lines: step, whose, what.
        self.told: list[tuple[int, int, str]] = []
        self._world.listen(self._samples, agent=LISTENER)
        self._look()

    @property
    def is_over(self) -> bool:
        """Whether it has been in view for long enough."""
        return self.seen is not None and len(self.levels) - self.seen["step"] >= _AFTER

    def step(self) -> None:
        """One control step of both."""
        world, step = self._world, len(self.levels)
        if step >= _QUIET and not world.speaks(OTHER):
            world.say(OTHER, " ".join(_WORDS), effort=_EFFORT)
            self.told.append((step, OTHER, f"says ({_EFFORT}): {' '.join(_WORDS)}"))
        walks = world.toward(self._goal, agent=OTHER) if step >= _QUIET + _SPEAKS_FIRST else None
        turn = "turn_left" if self._turns > 0 else "turn_right"
        own = turn if self._turns else "wait"
        self._turns -= int(np.sign(self._turns))
        known = actions()
        numbers = [known.index(own), known.index("wait" if walks is None else walks)]
        self._runner.step(EngineActions(np.array(numbers, np.int64)))
        self._listen(step)
        self._look()

    def _listen(self, step: int) -> None:
        sound = self._world.listen(self._samples, agent=LISTENER)
        self.levels.append(_levels_db(sound))
        for row in self._world.heard(LISTENER):
            if row["speaker"] != OTHER:
                continue
            right, _, back = row["direction"]
            left_deg = math.degrees(math.atan2(-right, -back))
            said = row["word"] or "a word"
            line = f"hears {said}: {row['level_db']:.0f} dB SPL, {left_deg:.0f} degrees to the left"
            self.told.append((step + 1, LISTENER, line))
            if self.heard is None:
                self.heard = {
                    "step": step + 1,
                    "time_s": round((step + 1) * self.step_s, 2),
                    "word": row["word"],
                    "level_db": round(float(row["level_db"]), 1),
                    "left_deg": round(left_deg, 1),
                    "sti": round(float(row["sti"]), 2),
                    "pixels": _pixels(self._world, self._number),
                }
            if right or back:
                self._turns = round(left_deg / _TURN_DEG)

    def _look(self) -> None:
        world, step = self._world, len(self.levels)
        states = world.agents()
        for way, state in zip(self.ways, states, strict=True):
            way.append(state["position"])
        pixels = _pixels(world, self._number)
        if self.seen is None and pixels >= _SEEN_PX:
            time_s = round(step * self.step_s, 2)
            self.seen = {"step": step, "time_s": time_s, "pixels": pixels}
            self.told.append((step, LISTENER, f"sees the other: {pixels} pixels"))
        if step % _FRAME_EVERY == 0:
            self.frames.append(world.render(agent=LISTENER, camera=CAMERA)["rgb"])
            self.poses.append((step, states))


def _levels_db(sound: NDArray[Any]) -> list[float]:
    """The level at each ear, dB SPL; 0 where it is less."""
    powers = np.square(sound, dtype=np.float64).mean(axis=1) / _REFERENCE_PA**2
    return [max(0.0, round(10.0 * math.log10(power + 1e-12), 1)) for power in powers.tolist()]
