"""A follower for the task PiedPiper that goes by its ears.

Of the world it takes what it hears (``audio``, two ears) and what is named (``instruction``); to
walk without bumping into things ``lidar``, ``gps`` and ``compass``, of which it takes what is in
the way and nothing about who makes which sound.

- *Which, and where.* The dry signals of the library are known, and that they begin with the
  episode. So what is heard tells when the named one arrives at each ear, and with that how far
  away it is and on which side: :mod:`dwell.sound_ranging`.
- *Belief.* Who leads walks at a known speed. A Bayesian filter over the floor
  (:mod:`dwell.place_belief`) weighs places by what was heard from them, while it walks, too.
- *Doors.* What comes through a door has gone around its frame: a place that cannot be seen from
  where it listens is heard as far away as the way to it is long, and from where that way begins.
- *Walking.* It walks in any direction (``action_mode="velocity"``) towards the most probable place,
  on a map of what its distances say (:mod:`dwell.floor_chart`); what was not seen yet counts as
  free. Its head turns slowly from side to side about where the sound comes from: front and back
  move to different sides. Where it gets nowhere it goes some other way for a while.
- *A thing of the house.* It may make the same sound. Who leads walks, so what is always heard
  from one place says nothing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.floor_chart import FloorChart
from dwell.place_belief import PlaceBelief
from dwell.sound_ranging import KnownSound, Pose, known_sounds
from dwell.sound_ways import apparent_places

Array = NDArray[np.float64]

#: The sensors that the policy needs, as settings of an agent.
SENSORS: dict[str, dict[str, Any]] = {
    "audio": {},
    "instruction": {},
    "gps": {},
    "compass": {},
    "lidar": {"beams": 72, "elevations_deg": [-35.0, -18.0, -8.0, 0.0, 15.0, 35.0]},
}
#: What may be named, as the task draws it by default.
_SOUNDS = ("radio", "vacuum_cleaner", "kettle", "television", "alarm")
#: Steps after which it weighs what it heard, and after which it thinks again where to go.
_WEIGH, _THINK = 3, 4
#: At first it stands and turns for so many steps.
_AT_FIRST = 24
#: Turns, as shares of the greatest; how far its head swings from where the sound comes from.
_SCAN, _SWING, _SWING_RAD = 0.6, 0.3, np.deg2rad(40.0)
#: So many steps within so little, m, and it goes some other way for so many.
_STUCK_STEPS, _STUCK_M, _DETOUR_M, _DETOUR_STEPS = 40, 0.35, 3.0, 25
#: Where it has heard nothing it goes so far somewhere, for so many steps.
_EXPLORE_M, _EXPLORE_STEPS, _SEARCH_STEPS = 6.0, 80, 32
#: A way may end so many m further from its goal for each m that it is shorter: what nobody saw may
#: be a wall.
_LENGTH = 0.2
#: How far a step leads.
_STEP_M = 0.1
#: It does not walk nearer than this, and walks away from who comes nearer than that, m.
_KEEP_M, _YIELDS_M = 1.2, 0.7
#: Sounds that things of houses make, too; how soon it notices what is always heard from a place,
#: how much that is on average, and how far around it nothing is believed then, m.
_OF_THINGS = ("radio", "television")
_NOTICES, _THING, _STILL_M = 0.01, 1.2, 0.6
#: How soon it notices what is always in the way, and how often that must have been: others walk on.
_SEES, _ALWAYS = 0.05, 0.7
#: How far around it looks for ways of sound, m, and after how many steps again.
_NEAR_M, _LOOKS = 8.0, 9
#: Parts of a cell in which something may be, m from its middle.
_PARTS_M = [np.array([k, j]) * 0.08 for k in (-1, 0, 1) for j in (-1, 0, 1)]
#: Two bodies are further apart than this, m; what takes off nearer places.
_BODIES_M, _OWN = 0.4, 3.0
#: Sure of less than this it has not heard where the sound is; of more than that
#: it explores no further; of less than the last it does not wait.
_SURE, _FOUND, _LOST = 0.03, 0.35, 0.3


class FollowByEars:
    """The policy; see the module."""

    def __init__(
        self,
        *,
        sounds: tuple[str, ...] = _SOUNDS,
        rate_hz: int = 16_000,
        turn_deg: float = 9.0,
    ) -> None:
        """Takes what may be named, and how far a turn goes.

        Args:
            sounds: As the task's setting.
            rate_hz: Samples a second of ``audio``.
            turn_deg: As of ``stride``.
        """
        self._sounds, self._rate_hz = sounds, rate_hz
        self._turn_rad = np.deg2rad(turn_deg)

    def reset(self, observation: Mapping[str, Any]) -> None:
        """Begins an episode.

        Raises:
            ConfigError: No known sound is named.
        """
        text = str(observation["instruction"])
        found = re.fullmatch(r"Go near the (.+)\.", text)
        named = found[1].replace(" ", "_") if found else ""
        if named not in self._sounds:
            raise ConfigError(f"instruction is {text!r}; expected one that names a sound")
        #: The sound that is named.
        self.named = named
        samples = np.asarray(observation["audio"]).shape[-1]
        self._hears = known_sounds(named, self._rate_hz, samples)
        #: Where it is believed to be, m ahead and left of the start.
        self.belief = PlaceBelief()
        #: What it heard from each cell on average, and how often something was in the way there.
        self._always = np.zeros(len(self.belief.cells))
        self._solid = np.zeros(len(self.belief.cells))
        #: Cells around it, where they seem to be, and whether they are seen.
        self._around: tuple[Any, Array, NDArray[np.bool_]] | None = None
        self._chart = FloorChart()
        self._step = 0
        #: Where it goes, m ahead and left of the start; and where the sound comes from.
        self._way: Array | None = None
        self._source: Array | None = None
        #: The direction in which it went in the last step, how far, and where it was.
        self._went: Array | None = None
        self._share = 1.0
        self._last: Array | None = None
        #: To which side its head turns.
        self._side = 1.0
        #: Where it was and when, to notice that it gets nowhere; and what it does about it.
        self._anchor = (np.zeros(2), 0)
        self._detour: tuple[Array, int] | None = None
        #: Whether that is because nothing was heard.
        self._explores = False
        self._stream = np.random.default_rng(len(text))

    def act(self, observation: Mapping[str, Any]) -> NDArray[np.float32]:
        """The next action, of the form ``velocity``: ahead, right, turn to the left, look up."""
        place = np.asarray(observation["gps"], np.float64)
        yaw_rad = float(np.asarray(observation["compass"]).ravel()[0])
        if self._went is not None and self._last is not None:
            progress_m = float((place - self._last) @ self._went)
            # Also where it slides along what is in the way.
            if progress_m < 0.3 * self._share * _STEP_M:
                self._chart.bumped(place, self._went, self._step)
        self._last = place
        if self._step % 3 == 0:
            ranges = np.asarray(observation["lidar"], np.float64)
            self._chart.add(place, yaw_rad, ranges, SENSORS)
            self._look(place, yaw_rad, ranges)
        # What is heard at the reset was before the sounds began.
        if self._step > 0:
            for hears in self._hears:
                hears.add(np.asarray(observation["audio"], np.float64), Pose(place, yaw_rad))
        if self._step % _WEIGH == 0:
            self._weigh(place)
        self._step += 1
        if self._step >= _AT_FIRST and self._step % _THINK == 0:
            self._think(place)
        return self._velocity(place, yaw_rad)

    def _look(self, place: Array, yaw_rad: float, ranges: Array) -> None:
        """What is in the way around it; now and then where it would hear what it does not see."""
        rows = self.belief.square(place, _NEAR_M)
        cells = self.belief.cells[rows]
        blocked = np.mean([self._chart.blocked(cells + side) for side in _PARTS_M], axis=0) > 0.2
        self._solid[rows] += _SEES * (blocked - self._solid[rows])
        if self._step % _LOOKS == 0:
            elevations = np.deg2rad(SENSORS["lidar"]["elevations_deg"])
            level = ranges * np.cos(elevations)[:, None]
            far = level[(elevations >= 0.0) & (elevations < 0.3)].max(axis=0)
            azimuths = yaw_rad - np.pi + 2.0 * np.pi * np.arange(len(far)) / len(far)
            order = np.argsort(azimuths % (2.0 * np.pi))
            told = ((azimuths % (2.0 * np.pi))[order], far[order])
            apparent, seen = apparent_places(place, cells, told, blocked)
            self._around = (rows, apparent, seen)

    def _told(self, hears: KnownSound) -> Array | None:
        """What was heard says of each cell: as it is, and as it is heard around corners."""
        told = hears.likelihood(self.belief.cells, again=self._around is not None)
        if told is None or self._around is None:
            return told
        rows, apparent, seen = self._around
        unseen = told[rows][~seen]
        around = hears.likelihood(apparent[~seen])
        assert around is not None
        best = told[rows]
        best[~seen] = np.maximum(unseen, around)
        told[rows] = best
        return told

    def _weigh(self, place: Array) -> None:
        """What was heard since the last time changes the belief."""
        self.belief.walked(_WEIGH, self._solid > _ALWAYS)
        for hears in self._hears:
            told = self._told(hears)
            if told is None:
                continue
            if self.named in _OF_THINGS:
                # What is always heard from one place is a thing.
                self._always += _NOTICES * (told - self._always)
                things = self.belief.cells[self._always > _THING]
                for thing in things:
                    told[np.hypot(*(self.belief.cells - thing).T) < _STILL_M] = 0.0
            # Nobody stands where it stands itself.
            own = np.hypot(*(self.belief.cells - place).T) < _BODIES_M
            self.belief.heard(np.where(own, told - _OWN, told))

    def _think(self, place: Array) -> None:
        """Where the sound is by now, and the way there."""
        source, sure = self.belief.best()
        if sure < _LOST and self._detour is None and np.hypot(*(source - place)) < 2.0 * _KEEP_M:
            # It would have been heard here.
            elsewhere, _ = self.belief.best(beyond=(place, 2.0 * _KEEP_M))
            self._detour, self._explores = (elsewhere, self._step + _SEARCH_STEPS), True
        self._source = source if sure > _SURE else None
        if self._explores and sure > _FOUND:
            self._detour, self._explores = None, False
        self._way = None
        if self._source is None and (self._detour is None or self._step >= self._detour[1]):
            self._explore(place, _EXPLORE_M, _EXPLORE_STEPS)
            self._explores = True
        goal = self._source if self._detour is None else self._detour[0]
        assert goal is not None
        away_m = float(np.hypot(*(goal - place)))
        if self._detour is None and away_m < _YIELDS_M and sure > _LOST:
            # Out of its way.
            self._way = place + _YIELDS_M * (place - goal) / max(away_m, 1e-6)
        elif away_m > _KEEP_M:
            way = self._chart.way(place, goal, self._step, length=_LENGTH)
            self._way = None if way is None else place + way
        self._notice_stuck(place)

    def _notice_stuck(self, place: Array) -> None:
        """Where it gets nowhere it goes some other way for a while."""
        if self._detour is not None and self._step >= self._detour[1]:
            self._detour, self._explores = None, False
        is_away = np.hypot(*(place - self._anchor[0])) > _STUCK_M
        if is_away or self._way is None:
            self._anchor = (place, self._step)
        elif self._step - self._anchor[1] > _STUCK_STEPS:
            self._explore(place, _DETOUR_M, _DETOUR_STEPS)
            self._anchor = (place, self._step)

    def _explore(self, place: Array, far_m: float, steps: int) -> None:
        """Goes anywhere for a while."""
        angle = self._stream.uniform(0.0, 2.0 * np.pi)
        goal = place + far_m * np.array([np.cos(angle), np.sin(angle)])
        self._detour = (goal, self._step + steps)

    def _velocity(self, place: Array, yaw_rad: float) -> NDArray[np.float32]:
        """Goes its way, whatever it faces; its head swings about where the sound comes from."""
        turn = _SCAN * self._side
        if self._source is not None:
            ahead, left = self._source - place
            away_rad = float(np.angle(np.exp(1j * (yaw_rad - np.arctan2(left, ahead)))))
            if abs(away_rad) > _SWING_RAD:
                self._side = -float(np.sign(away_rad))
            fast = abs(away_rad) > _SWING_RAD + 0.3
            turn = (_SCAN if fast else _SWING) * self._side
        ahead = right = 0.0
        self._went = None
        if self._way is not None:
            way = self._way - place
            length_m = float(np.hypot(*way))
            if length_m > 0.05:
                share = self._share = min(1.0, length_m / _STEP_M)
                self._went = way / length_m
                c, s = np.cos(yaw_rad), np.sin(yaw_rad)
                ahead = share * (self._went[0] * c + self._went[1] * s)
                right = share * (self._went[0] * s - self._went[1] * c)
        return np.array([ahead, right, turn, 0.0], np.float32)
