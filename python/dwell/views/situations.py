"""Questions about what one would do where a picture was taken: ways, and why an action fails.

Their answers are not all in the picture: who answers needs to know the house.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from dwell.views.forms import Form, the

if TYPE_CHECKING:
    from dwell.views.record import ViewRecord
    from dwell.world import World

#: A form, its words, and its answer in each view by number.
Situation = tuple[Form, str, dict[int, str]]
#: Rooms to which ways are asked from a view, and things that are tried in it.
_MOST_ROOMS, _MOST_THINGS = 4, 6

_WHY = {
    "too_far": "it is too far away",
    "already_open": "it is open already",
    "already_closed": "it is closed already",
    "behind_agent": "it is behind you",
    "not_in_sight": "something is in the way",
    "latched": "it is shut",
    "locked": "it is locked",
}


def _paths(world: World, records: Sequence[ViewRecord]) -> Iterator[Situation]:
    """Which way do you turn first to go to the kitchen?"""
    rooms = world.house.rooms()
    kinds = Counter(room["kinds"][0] for room in rooms if room["kinds"])
    single = [room for room in rooms if room["kinds"] and kinds[room["kinds"][0]] == 1]
    for room in single[:_MOST_ROOMS]:
        answers, noun = {}, ""
        for k, record in enumerate(records):
            goal = f"room:{room['name']}"
            texts = world.describe("route", viewer=_viewer(record), to=goal, length="short")
            steps = texts[0].claims[0]["form"].get("request") if texts else None
            if steps:
                answers[k] = steps[0].get("turn", "not at all")
                noun = _last_room(texts[0].claims[-1]["form"]["request"][-1]) or noun
        ways = "left, right, around or not at all"
        if noun:
            form = {"request": [{"go_to": {"described": _room(noun)}}]}
            yield form, f"Which way do you turn first to go to the {noun}: {ways}?", answers


def _last_room(step: object) -> str | None:
    """The noun of the room that a step names last."""
    if isinstance(step, Mapping):
        noun = step.get("noun")
        if isinstance(noun, Mapping) and "room" in noun:
            return str(noun["room"])
        step = list(step.values())
    if isinstance(step, list):
        found = [_last_room(part) for part in step]
        return next((noun for noun in reversed(found) if noun), None)
    return None


def _room(noun: str) -> Form:
    found = the(noun)["described"]
    return {**found, "noun": {"room": noun}}


def _failures(world: World, records: Sequence[ViewRecord]) -> Iterator[Situation]:
    """You try to open the door, and fail. Why?"""
    from dwell.world import World

    asked: dict[tuple[str, str], dict[int, str]] = {}
    acting = World(world.house, agents=1, settle_s=0.0)
    start = acting.snapshot()
    for k, record in enumerate(records):
        camera = record.row["camera"]
        x, y, z = camera["position"]
        acting.place_agent((x, y - camera["eye_height_m"], z), camera["yaw_deg"])
        things = [thing for thing in record.row["things"] if thing.get("openness") is not None]
        nouns = Counter(thing["noun"] for thing in things)
        for thing in [thing for thing in things if nouns[thing["noun"]] == 1][:_MOST_THINGS]:
            for verb in ("open", "close"):
                outcome = acting.act(verb, thing["id"])
                if not outcome.success and outcome.code in _WHY:
                    asked.setdefault((verb, thing["noun"]), {})[k] = _WHY[outcome.code]
                elif outcome.success:
                    acting.restore(start)
                    acting.place_agent((x, y - camera["eye_height_m"], z), camera["yaw_deg"])
    for (verb, noun), answers in sorted(asked.items()):
        form = {"request": [{"do": {"verb": verb, "object": the(noun)}}]}
        yield form, f"You try to {verb} the {noun}, and fail. Why?", answers


def _viewer(record: ViewRecord) -> dict[str, Any]:
    camera = record.row["camera"]
    return {name: camera[name] for name in ("position", "yaw_deg", "pitch_deg")}


#: Kind and what gives its situations.
SITUATIONS: dict[str, Callable[[World, Sequence[ViewRecord]], Iterator[Situation]]] = {
    "path": _paths,
    "failure": _failures,
}
