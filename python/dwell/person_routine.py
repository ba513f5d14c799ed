"""Routines of people: errands by the time of day, said in the instruction grammar.

A routine says which errand a person goes about from when on: ``{"07:00": "Go to the kitchen."}``.
It gives the person's next action, step by step, so that it acts among others: in a world of its
own, or as one of the agents of an environment.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import integer_in_range, mapping, number_in_range, quoted, text
from dwell.language import say
from dwell.navigation import Walker

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
#: Another place to try from is at least so far from the others, m.
_ELSEWHERE_M = 0.4
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
        form = self._world.check(errand.sentence, agent=self._agent)["form"]
        yield from self._steps(form["request"])

    def _steps(self, steps: Iterable[Mapping[str, Any]]) -> Iterator[str]:
        for step in steps:
            ((kind, told),) = step.items()
            if kind == "if":
                is_so = self._is_true(told["condition"])
                yield from self._steps(told["then" if is_so else "otherwise"])
            elif kind == "go_to":
                yield from self._go_to_room(self._things(step)[0][0])
            # What is not to be done asks for nothing.
            elif kind != "do_not":
                things, *places = self._things(step)
                for thing in things[: _count(told["object"])]:
                    yield from self._act(kind, told, thing, [place[0] for place in places])

    def _act(
        self, kind: str, told: Mapping[str, Any], thing: Mapping[str, Any], places: Sequence[Any]
    ) -> Iterator[str]:
        """What a step asks to be done with one thing."""
        name = str(thing["name"])
        if kind == "bring":
            yield from self._handle("pick", name)
            yield from self._go_to_room(places[0])
            yield "drop"
        elif kind == "put":
            yield from self._handle("pick", name)
            where = "put_in" if told["predicate"] in ("in", "inside") else "place"
            yield from self._handle(where, places[0]["name"])
        elif told["verb"] in _HAND:
            if not self._is_so(told["verb"], name):
                yield from self._handle(_HAND[told["verb"]], name)
                yield from self._until_so(told["verb"], name)
        elif told["verb"] in _LOOKS:
            yield from self._look(told["verb"], thing)
        else:
            raise _GivenUpError(f"{told['verb']} is not gone about")

    def _is_true(self, claim: Mapping[str, Any]) -> bool:
        """Whether a claim is true now; who cannot tell takes it as false."""
        found = self._world.check(say({"claim": claim}), agent=self._agent)
        return bool(found["answer"]["truth"])

    def _things(self, step: Mapping[str, Any]) -> list[list[dict[str, Any]]]:
        """The things of each noun phrase of a step; inner phrases only describe."""
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
        return [phrase["things"] for phrase in outer]

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

    def _beside(self, thing: str, gap_m: float = 0.0) -> list[NDArray[np.float32]]:
        """Places to stand in a thing's room, the nearest to its outline first.

        With ``gap_m`` the one nearest to the person that is as far away, or further.
        """
        row = self._world.object(thing)
        agent = self._world.agents()[self._agent]
        here, body = np.asarray(agent["position"]), agent["body"]
        walker = Walker(radius_m=body["radius_m"], height_m=body["height_m"], doors="open")
        places = self._world.navigation(walker).points(here.tolist())
        middle, half = np.asarray(row["center"]), 0.5 * np.asarray(row["size"])
        away = np.maximum(np.abs(places - middle) - half, 0.0)[:, [0, 2]]
        cost = np.hypot(*away.T) + 0.1 * np.hypot(*(places - middle)[:, [0, 2]].T)
        if gap_m > 0.0:
            way = np.hypot(*(places - here)[:, [0, 2]].T)
            cost = np.where(np.hypot(*away.T) >= gap_m, way, np.inf)
        cost = np.where(np.abs(places[:, 1] - (middle - half)[1]) > _STOREY_M, np.inf, cost)
        found: list[NDArray[np.float32]] = []
        room_at = self._world.house.room_at
        for k in np.argsort(cost, kind="stable")[: np.isfinite(cost).sum()]:
            # From another room a wall may be between.
            if row["room"] in (None, room_at(places[k].tolist())) and all(
                np.hypot(*(places[k] - one)[[0, 2]]) > _ELSEWHERE_M for one in found
            ):
                found.append(places[k])
            if len(found) == _TRIES:
                break
        if not found:
            raise _GivenUpError(f"nobody can stand beside {thing}")
        return found

    def _look(self, verb: str, thing: Mapping[str, Any]) -> Iterator[str]:
        """Looks at a thing; first it goes there where the verb says so."""
        name = str(thing["name"])
        middle = self._world.object(name)["center"]
        if verb in ("find", "approach"):
            yield from self._walk(self._beside(name)[0])
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
        """Goes to a thing, looks at it, and lets the hand act; in vain it tries from elsewhere."""
        for place in self._beside(thing):
            yield from self._walk(place)
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
            yield from self._walk(self._beside(thing, _ASIDE_M)[0])
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


def _count(phrase: Mapping[str, Any]) -> int | None:
    """How many things a noun phrase asks for; ``None``: all."""
    quantifier = phrase.get("described", {}).get("quantifier")
    if isinstance(quantifier, Mapping):
        (number,) = quantifier.values()
        return int(number)
    return None if quantifier == "every" else 1


def _hour(at: str, clock: object) -> float:
    """Hours of a time of day."""
    found = _CLOCK.fullmatch(clock) if isinstance(clock, str) else None
    if found is None:
        raise ConfigError(f"{at}: time of day is {quoted(clock)}; expected HH:MM, 00:00 to 23:59")
    return int(found[1]) + int(found[2]) / 60.0
