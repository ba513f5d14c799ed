"""Routines of people: errands by the time of day, said in the instruction grammar.

A routine says which errand a person goes about from when on: ``{"07:00": "Go to the kitchen."}``.
It gives the person's next action, step by step, so that it acts among others: in a world of its
own, or as one of the agents of an environment.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import integer_in_range, mapping, number_in_range, quoted, text
from dwell.language import say

if TYPE_CHECKING:
    from dwell.world import World

_DAY_H = 24.0
_CLOCK = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)")
#: What the hand does for a verb.
_HAND = {
    "open": "open",
    "close": "close",
    "switch_on": "toggle",
    "switch_off": "toggle",
    "pick_up": "pick",
}
_LOOKS = ("face", "point_at", "find", "approach")
#: Steps after which it gives a way, a look or a reach up; tries of an action of the hand.
_WALK_STEPS, _LOOK_STEPS, _TRIES = 3000, 60, 3
#: From this openness on a door is open: its drive leaves a little.
_OPEN = 0.9
#: A door that moves by less than this share in each of so many steps has stopped.
_STILL, _STILL_STEPS = 1e-4, 10
#: Distance from the outline of a door that stopped, from which it is tried again, m.
_ASIDE_M = 1.0
#: So many steps it points.
_POINT_STEPS = 20
#: Floors of two storeys are further apart than this, m.
_STOREY_M = 2.0


class Errand(NamedTuple):
    """One errand of a routine.

    Attributes:
        hour: From when on, hours from 0 to below 24.
        sentence: A request of the instruction grammar.
    """

    hour: float
    sentence: str


class ErrandReport(NamedTuple):
    """How an errand went.

    Attributes:
        errand: Which.
        begun_s: When it began, s of the world.
        ended_s: When it ended.
        failure: Why it was given up; empty where it was done.
    """

    errand: Errand
    begun_s: float
    ended_s: float
    failure: str


class _GivenUpError(Exception):
    """A step of an errand that cannot be done."""


class PersonRoutine:
    """What a person does at which time of the day, one action after the other.

    An errand that is due begins as soon as the one before has ended; of several that are due by
    then only the last one is gone about. Between errands it waits. The day begins again after 24 h.

    Examples:
        >>> import dwell
        >>> from dwell.person_routine import PersonRoutine
        >>> world = dwell.World("builtin:apartment", agents=[{"kind": "person"}])
        >>> day = {"07:00": "Go to the kitchen.", "07:30": "Find the sofa."}
        >>> routine = PersonRoutine(world, day, start="06:59", hours_per_s=0.05)
        >>> while len(routine.reports) < 2:
        ...     outcome = world.do(routine.next_action())
        >>> [report.failure for report in routine.reports]
        ['', '']
    """

    def __init__(
        self,
        world: World,
        errands: Mapping[str, str],
        *,
        agent: int = 0,
        start: str = "07:00",
        hours_per_s: float = 1.0 / 3600.0,
    ) -> None:
        """Reads the errands.

        Args:
            world: Where the person lives.
            errands: Requests by the time of day from which they are due, ``"HH:MM"``.
            agent: Who goes about them. Gestures are made where the body is a person's.
            start: The time of day at this moment.
            hours_per_s: How fast the day passes, hours for each s of the world; by default as fast
                as the world's own time.

        Raises:
            ConfigError: A time is none, or a sentence is no request of the grammar.
        """
        self._world = world
        self._agent = integer_in_range("agent", agent, high=len(world.agents()) - 1)
        self._begins_h, self._begins_s = _hour("start", start), world.time_s
        self._speed = number_in_range("hours_per_s", hours_per_s, 0.0, 100.0)
        rows = mapping("errands", errands, "requests by the time of day")
        #: The errands, by time.
        self.errands = sorted(
            Errand(_hour("errands", at), self._request(str(at), asked))
            for at, asked in rows.items()
        )
        #: How those went that have ended.
        self.reports: list[ErrandReport] = []
        self._is_person = world.agents()[self._agent]["body"].get("kind") == "person"
        self._looked_at = self._elapsed_h()
        self._going: Iterator[str] | None = None
        self._current: tuple[Errand, float] | None = None

    def _request(self, at: str, sentence: object) -> str:
        at = f"errands[{at}]"
        asked = text(at, sentence)
        try:
            form = self._world.check(asked, agent=self._agent)["form"]
        except ConfigError as error:
            raise ConfigError(f"{at}: {error}") from None
        if "request" not in form:
            raise ConfigError(f"{at} is {quoted(asked)}; expected a request")
        return asked

    @property
    def hour(self) -> float:
        """The time of day, hours from 0 to below 24."""
        return self._elapsed_h() % _DAY_H

    @property
    def errand(self) -> Errand | None:
        """What it is about; ``None`` between errands."""
        return None if self._current is None else self._current[0]

    def _elapsed_h(self) -> float:
        return self._begins_h + (self._world.time_s - self._begins_s) * self._speed

    def next_action(self) -> str:
        """The name of the person's next discrete action: one control step of it."""
        if self._going is None and (due := self._due()) is not None:
            self._current = (due, self._world.time_s)
            self._going = self._do(due)
        if self._going is None or self._current is None:
            return "wait"
        failure = ""
        try:
            return next(self._going)
        except StopIteration:
            pass
        except _GivenUpError as error:
            failure = str(error)
        errand, begun_s = self._current
        self.reports.append(ErrandReport(errand, begun_s, self._world.time_s, failure))
        self._going = self._current = None
        if self._is_person:
            self._world.set_gesture(self._agent)
        return "wait"

    def _due(self) -> Errand | None:
        """The last errand whose time has come since it was looked for."""
        before, now = self._looked_at, self._elapsed_h()
        self._looked_at = np.nextafter(now, np.inf)
        passed = [
            (errand.hour + _DAY_H * day, errand)
            for day in range(int(before // _DAY_H), int(now // _DAY_H) + 1)
            for errand in self.errands
        ]
        due = [row for row in passed if before <= row[0] <= now]
        return max(due)[1] if due else None

    def _do(self, errand: Errand) -> Iterator[str]:
        """The actions of an errand."""
        form = self._world.check(errand.sentence, agent=self._agent)["form"]["request"]
        if not isinstance(form, list):
            raise _GivenUpError("conditional errands are not gone about")
        for step in form:
            ((kind, told),) = step.items()
            things = self._things(step)
            if kind == "go_to":
                yield from self._go_to_room(things[0])
            elif kind == "bring":
                yield from self._handle("pick", things[0]["name"])
                yield from self._go_to_room(things[1])
                yield "drop"
            elif kind == "put":
                yield from self._handle("pick", things[0]["name"])
                where = "put_in" if told["predicate"] in ("in", "inside") else "place"
                yield from self._handle(where, things[1]["name"])
            elif kind == "do" and told["verb"] in _HAND:
                name = things[0]["name"]
                if self._is_so(told["verb"], name):
                    continue
                yield from self._handle(_HAND[told["verb"]], name)
                yield from self._until_so(told["verb"], name)
            elif kind == "do" and told["verb"] in _LOOKS:
                yield from self._look(told["verb"], things[0])
            else:
                raise _GivenUpError(f"{kind} is not gone about")

    def _things(self, step: Mapping[str, Any]) -> list[dict[str, Any]]:
        """The first thing of each noun phrase of a step; inner phrases only describe."""
        found = self._world.check(say({"request": [step]}), agent=self._agent)
        outer: list[dict[str, Any]] = []
        end = -1
        for phrase in sorted(found["phrases"], key=lambda row: (row["start"], -row["end"])):
            if phrase["start"] >= end:
                outer.append(phrase)
                end = phrase["end"]
        for phrase in outer:
            if not phrase["things"]:
                said = found["said"][phrase["start"] : phrase["end"]]
                raise _GivenUpError(f"there is no {said!r}")
        return [phrase["things"][0] for phrase in outer]

    def _go_to_room(self, room: Mapping[str, Any]) -> Iterator[str]:
        rooms = {row["name"]: row for row in self._world.house.rooms()}
        name = str(room["name"]).removeprefix("room:")
        if name not in rooms:
            raise _GivenUpError(f"{name} is no room")
        yield from self._walk(rooms[name]["stand"])

    def _walk(self, goal: Any) -> Iterator[str]:  # noqa: ANN401 - a point
        for _ in range(_WALK_STEPS):
            action = self._world.toward(goal, agent=self._agent)
            if action is None:
                return
            yield action
        raise _GivenUpError("no way leads there in time")

    def _beside(self, thing: str, gap_m: float = 0.0) -> NDArray[np.float32]:
        """The place to stand that is nearest to a thing's outline.

        With ``gap_m`` the one nearest to the person that is as far away, or further.
        """
        row = self._world.object(thing)
        here = np.asarray(self._world.agents()[self._agent]["position"])
        places = self._world.navigation().points(here.tolist())
        middle, half = np.asarray(row["center"]), 0.5 * np.asarray(row["size"])
        away = np.maximum(np.abs(places - middle) - half, 0.0)[:, [0, 2]]
        cost = np.hypot(*away.T) + 0.1 * np.hypot(*(places - middle)[:, [0, 2]].T)
        if gap_m > 0.0:
            way = np.hypot(*(places - here)[:, [0, 2]].T)
            cost = np.where(np.hypot(*away.T) >= gap_m, way, np.inf)
        cost = np.where(np.abs(places[:, 1] - (middle - half)[1]) > _STOREY_M, np.inf, cost)
        if not len(places) or not np.isfinite(cost).any():
            raise _GivenUpError(f"nobody can stand beside {thing}")
        best: NDArray[np.float32] = places[int(cost.argmin())]
        return best

    def _look(self, verb: str, thing: Mapping[str, Any]) -> Iterator[str]:
        """Looks at a thing; first it goes there where the verb says so."""
        name = str(thing["name"])
        middle = self._world.object(name)["center"]
        if verb in ("find", "approach"):
            yield from self._walk(self._beside(name))
        if self._is_person:
            self._world.set_gesture(self._agent, look_at=middle)
        for _ in range(_LOOK_STEPS):
            action = self._world.facing(name, agent=self._agent)
            if action is None:
                break
            yield action
        if verb == "point_at" and self._is_person:
            self._world.set_gesture(self._agent, look_at=middle, point_at=middle)
            for _ in range(_POINT_STEPS):
                yield "wait"

    def _handle(self, action: str, thing: str) -> Iterator[str]:
        """Goes to a thing, looks at it, and lets the hand act."""
        yield from self._walk(self._beside(thing))
        for _ in range(_TRIES):
            yield from self._look("face", {"name": thing})
            before = self._facts(thing)
            yield action
            for _ in range(_LOOK_STEPS):
                if self._facts(thing) != before:
                    return
                yield "wait"
        raise _GivenUpError(f"{action} {thing} did nothing")

    def _is_so(self, verb: str, thing: str) -> bool:
        """Whether nothing is left to do."""
        row = self._world.object(thing)
        if verb in ("switch_on", "switch_off"):
            return bool(row["on"] == (verb == "switch_on"))
        openness = row["openness"]
        if verb not in ("open", "close") or openness is None:
            return False
        return float(np.max(openness)) >= _OPEN if verb == "open" else not np.any(openness)

    def _until_so(self, verb: str, thing: str) -> Iterator[str]:
        """Waits until what a door was set to do is done; a door that sticks is tried again."""
        if verb not in ("open", "close"):
            return
        for _ in range(_TRIES):
            before = self._world.object(thing)["openness"]
            still = 0
            while still < _STILL_STEPS and not self._is_so(verb, thing):
                yield "wait"
                after = self._world.object(thing)["openness"]
                still = 0 if np.max(np.abs(np.subtract(after, before))) > _STILL else still + 1
                before = after
            if self._is_so(verb, thing):
                return
            # A door that swings may have met the body: it steps back.
            yield from self._walk(self._beside(thing, _ASIDE_M))
            yield from self._look("face", {"name": thing})
            yield _HAND[verb]
        raise _GivenUpError(f"{thing} did not {verb}: something is in its way")

    def _facts(self, thing: str) -> tuple[Any, ...]:
        """What an action of the hand on a thing changes."""
        row = self._world.object(thing)
        held = [own["id"] for own in self._world.objects() if own["held_by"] == self._agent]
        openness = row["openness"]
        opened = None if openness is None else round(float(np.max(openness)), 1)
        return (opened, tuple(held), row["on"])


def _hour(at: str, clock: object) -> float:
    """Hours of a time of day."""
    found = _CLOCK.fullmatch(clock) if isinstance(clock, str) else None
    if found is None:
        raise ConfigError(f"{at}: time of day is {quoted(clock)}; expected HH:MM, 00:00 to 23:59")
    return int(found[1]) + int(found[2]) / 60.0
