"""A clip ready to be played: its world with all in place, what is said and what is pointed at."""

from __future__ import annotations

import dataclasses

import numpy as np

import dwell
from dwell.teach.cameras import ROBOT_BODY, ROBOT_EYE_M, laws
from dwell.teach.draws import stream
from dwell.teach.layout import PERSON_FROM_EDGE_M, TABLE_M, Layout
from dwell.teach.motion import Point
from dwell.teach.person import PERSON, ROBOT, Person, Pose, person_body
from dwell.teach.phrases import Phrase, deictic_phrase, relation_phrase
from dwell.teach.plan import ClipPlan
from dwell.teach.pointing import aim_points, finger_goal, first_hit, turned_aim
from dwell.teach.scene import TABLE, furnished, place_things, stage
from dwell.teach.settings import TeachSettings
from dwell.teach.things import POOL
from dwell.teach.users import UserParameters

#: How often the table is laid anew until the target can be seen, reached, pointed at and told of.
_TRIES = 50
#: Things come to rest before the clip, s.
_SETTLE_S = 1.0
#: Of a target at most this share is hidden from the person.
_MOST_HIDDEN = 0.5
#: A palm that comes so near to where it takes the target has reached it, m.
_REACHED_M = 0.03
#: Hands rest above the person's edge of the table: to each side of the body, over the table, and
#: from the edge, m.
_READY_M = (0.17, 0.10, -0.04)
#: What is shown is held before the chest: from the body's middle towards the robot, m, and as a
#: part of the person's height.
_SHOW_AHEAD_M = 0.44
_SHOW_HEIGHT = 0.76
#: Things up to this height are taken from above, higher ones from the person's side, m.
_LOW_M = 0.12
#: The palm is so far from the box around what it takes, m.
_PALM_M = 0.02
#: The longest clip: so many seconds of pictures lie between the first steps of two clips.
LONGEST_S = 10.0


@dataclasses.dataclass
class Session:
    """A clip in its world, before its first step.

    Attributes:
        settings: Of the recording.
        user: Who teaches.
        plan: What is drawn of the clip.
        layout: Where the table stands.
        world: Everything.
        person: The user in it.
        target: The thing's name.
        things: The names of all things on the table, by id.
        phrase: What is said.
        ready: The palms at rest: left, right, m.
        grasp: Where the palm takes the target, m.
        shown: Where the palm shows it, m.
        robot_eyes: What the person looks at when it does not look at the target, m.
        meant: The point of the target that the person means, m.
        aim: The point that it points at, with the noise of its pointing, m.
        finger: Where the finger goes, short of that on the line from the eyes, m.
        tries: How many tables were laid.
    """

    settings: TeachSettings
    user: UserParameters
    plan: ClipPlan
    layout: Layout
    world: dwell.World
    person: Person
    target: str
    things: list[str]
    phrase: Phrase
    ready: tuple[Point, Point]
    grasp: Point
    shown: Point
    robot_eyes: Point
    meant: Point
    aim: Point
    finger: Point
    tries: int


def open_session(settings: TeachSettings, user: UserParameters, plan: ClipPlan) -> Session:
    """Lays the table until the target can be seen, reached, pointed at and told of.

    All types of clips are held to the same conditions, so that where things lie tells none.

    Raises:
        DwellError: No such table was found.
    """
    house, layout = stage(settings.house)
    others = tuple(number for number in user.things if number != plan.target)
    for tries in range(1, _TRIES + 1):
        random = stream(settings.seed, "table", user.number, plan.number, tries)
        placed = place_things(random, plan.target, others)
        stance_m = plan.stance * placed[0].right_m
        world = _world(furnished(house, layout, placed), settings, user, layout, stance_m)
        found = _prepared(settings, user, plan, layout, world, stance_m, random, tries)
        if found is not None:
            return found
    raise dwell.DwellError(
        f"user {user.number}, clip {plan.number}: {_TRIES} tables were laid, and on none "
        f"{POOL[plan.target].name} can be seen, reached, pointed at and told apart by words"
    )


def _world(
    house: dwell.House,
    settings: TeachSettings,
    user: UserParameters,
    layout: Layout,
    stance_m: float,
) -> dwell.World:
    world = dwell.World(
        house,
        agents=[person_body(user), ROBOT_BODY],
        # The voice and the looks are drawn from it.
        seed=user.voice,
        laws=laws(settings),
        control_rate_hz=settings.control_rate_hz,
        sound_rate_hz=settings.sound_rate_hz,
        settle_s=_SETTLE_S,
    )
    world.place_agent(layout.person(stance_m).tolist(), layout.person_yaw_deg, agent=PERSON)
    world.place_agent(layout.robot().tolist(), layout.yaw_deg, agent=ROBOT)
    return world


def _prepared(
    settings: TeachSettings,
    user: UserParameters,
    plan: ClipPlan,
    layout: Layout,
    world: dwell.World,
    stance_m: float,
    random: np.random.Generator,
    tries: int,
) -> Session | None:
    """The session, or ``None`` where the target cannot be seen, reached or told of."""
    target = POOL[plan.target].name
    things = [row["name"] for row in world.objects() if TABLE in row["rests_on"]]
    if target not in things:
        return None
    person = Person(world, user)
    robot_eyes = layout.robot() + np.array([0.0, ROBOT_EYE_M, 0.0])
    ready = _ready(layout, stance_m)
    grasp = _grasp(world, target, layout)
    shown = _shown(layout, user, plan, stance_m) + grasp - _middle(world, target)
    rest = Pose(robot_eyes, ready[0], ready[1])
    for place in (grasp, shown):
        person.take(rest.with_palm(person.hand, place))
        if np.linalg.norm(person.palm(person.joints()) - place) > _REACHED_M:
            return None
    person.take(rest)
    eyes = person.joints()["eyes"]
    points, hidden = aim_points(world, eyes, target)
    if hidden > _MOST_HIDDEN:
        return None
    meant = next((p for p in points if _is_hit(world, person, rest, p, target)), None)
    if meant is None:
        return None
    # Eyes move as the head turns.
    person.take(dataclasses.replace(rest, look_at=meant))
    eyes = person.joints()["eyes"]
    person.take(rest)
    if plan.type == "speak":
        phrase = relation_phrase(world, target, things, random)
    else:
        phrase = deictic_phrase(world, target, user, random)
    if phrase is None:
        return None
    right_deg, up_deg = (draw * user.pointing_noise_deg for draw in plan.aim_noise)
    aim = turned_aim(eyes, meant, right_deg, up_deg)
    return Session(
        settings=settings,
        user=user,
        plan=plan,
        layout=layout,
        world=world,
        person=person,
        target=target,
        things=things,
        phrase=phrase,
        ready=ready,
        grasp=grasp,
        shown=shown,
        robot_eyes=robot_eyes,
        meant=meant,
        aim=aim,
        finger=finger_goal(eyes, aim),
        tries=tries,
    )


def _is_hit(world: dwell.World, person: Person, rest: Pose, aim: Point, target: str) -> bool:
    """Whether the ray of who points there meets the target first."""
    looking = dataclasses.replace(rest, look_at=aim)
    person.take(looking)
    person.take(looking.pointing_to(person.hand, finger_goal(person.joints()["eyes"], aim)))
    origin, direction = person.ray(person.joints())
    number: int = world.object(target)["id"]
    return first_hit(world, origin, direction)[0] == number


def _ready(layout: Layout, stance_m: float) -> tuple[Point, Point]:
    """Where the palms rest, the left and the right one."""
    side, above, inward = _READY_M
    # What is left to the person is right to the robot.
    return (
        layout.on_table(stance_m + side, inward, above),
        layout.on_table(stance_m - side, inward, above),
    )


def _grasp(world: dwell.World, target: str, layout: Layout) -> Point:
    """Where a palm takes a thing: over its middle, or at its side that faces the person."""
    size = np.asarray(world.object(target)["size"])
    toward_palm = np.array([0.0, 1.0, 0.0])
    if size[1] > _LOW_M:
        toward_palm = layout.point(0.0, 0.0, 1.0) - layout.point(0.0, 0.0, 0.0)
    half_m = float(np.abs(toward_palm) @ size) / 2.0
    found: Point = _middle(world, target) + (half_m + _PALM_M) * toward_palm
    return found


def _middle(world: dwell.World, thing: str) -> Point:
    """The middle of the box around a thing, m."""
    middle: Point = np.asarray(world.object(thing)["center"], np.float64)
    return middle


def _shown(layout: Layout, user: UserParameters, plan: ClipPlan, stance_m: float) -> Point:
    """Where the middle of what is shown is held."""
    right, up = plan.show_offset_m
    ahead = TABLE_M[2] / 2.0 + PERSON_FROM_EDGE_M - _SHOW_AHEAD_M
    return layout.point(stance_m + right, _SHOW_HEIGHT * user.height_m + up, ahead)
