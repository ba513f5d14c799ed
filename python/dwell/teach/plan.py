"""What happens in a clip, and when: drawn before anything is simulated."""

from __future__ import annotations

import dataclasses
from typing import Literal, get_args

import numpy as np

from dwell.teach.draws import stream
from dwell.teach.settings import TeachSettings
from dwell.teach.users import UserParameters

ClipType = Literal["point", "show", "speak"]
#: What a user does with a thing.
CLIP_TYPES: tuple[ClipType, ...] = get_args(ClipType)

#: Ranges from which is drawn, s: the same for all types, so that times alone tell none.
_SPEECH_START_S = (0.3, 0.7)
_REACH_START_S = (0.2, 0.5)
_AFTER_SPEECH_S = (1.7, 2.4)
#: How long movements take at a pace of 1, s.
_REACH_S = 0.8
_GRASP_S = 0.2
_LIFT_S = 0.8
#: The shortest clip, s; what is shown is up by then.
SHORTEST_S = 3.2


@dataclasses.dataclass(frozen=True)
class Timeline:
    """When what happens, s from the start of the clip.

    Attributes:
        speech_start_s: The first word.
        after_speech_s: From the last word to the end of the clip.
        reach_start_s: The hand sets off; the head turns to the target.
        reach_end_s: It is there: it points, or takes what it shows.
        lift_start_s: It sets off with what it shows.
        lift_end_s: That is up.
        apex_s: What the clip shows is complete: it points, it is up; the head turns to the robot.
    """

    speech_start_s: float
    after_speech_s: float
    reach_start_s: float
    reach_end_s: float
    lift_start_s: float
    lift_end_s: float
    apex_s: float


@dataclasses.dataclass(frozen=True)
class ClipPlan:
    """A clip.

    Attributes:
        number: Of the user's clips, from 0, in the order in which they are played.
        type: What the user does.
        number_of_type: Of the user's clips of this type, counted from 1.
        target: The thing, by its number in the pool.
        timeline: When what happens.
        stance: Where the person stands: between the middle of the table (0) and the target (1).
        aim_noise: Two normal draws, of the direction of pointing to the side and up.
        show_offset_m: Where it is shown, against the usual place: right, up.
    """

    number: int
    type: ClipType
    number_of_type: int
    target: int
    timeline: Timeline
    stance: float
    aim_noise: tuple[float, float]
    show_offset_m: tuple[float, float]

    @property
    def folder(self) -> str:
        """The name of its folder below the user's."""
        return f"{self.type}_{self.number_of_type:02}"


def clip_plans(settings: TeachSettings, user: UserParameters) -> list[ClipPlan]:
    """The clips of a user, in the order in which they are played."""
    random = stream(settings.seed, "order", user.number)
    # As many of each type as the number allows, in an order of the user's own.
    types = [CLIP_TYPES[k % len(CLIP_TYPES)] for k in range(settings.clips)]
    order = [types[k] for k in random.permutation(settings.clips)]
    targets = {kind: random.permutation(user.things) for kind in CLIP_TYPES}
    counted = dict.fromkeys(CLIP_TYPES, 0)
    plans = []
    for number, kind in enumerate(order):
        target = targets[kind][counted[kind] % len(user.things)]
        counted[kind] += 1
        drawn = stream(settings.seed, "clip", user.number, number)
        plans.append(
            ClipPlan(
                number=number,
                type=kind,
                number_of_type=counted[kind],
                target=int(target),
                timeline=_timeline(drawn, user, kind),
                stance=float(drawn.uniform(0.3, 0.9)),
                aim_noise=(float(drawn.normal()), float(drawn.normal())),
                show_offset_m=(float(drawn.uniform(-0.1, 0.1)), float(drawn.uniform(-0.05, 0.1))),
            )
        )
    return plans


def _timeline(random: np.random.Generator, user: UserParameters, kind: ClipType) -> Timeline:
    speech_start, after_speech, reach_start = (
        float(random.uniform(*limits))
        for limits in (_SPEECH_START_S, _AFTER_SPEECH_S, _REACH_START_S)
    )
    reach_end = reach_start + _REACH_S * user.pace
    lift_start = reach_end + _GRASP_S * user.pace
    lift_end = lift_start + _LIFT_S * user.pace
    return Timeline(
        speech_start_s=speech_start,
        after_speech_s=after_speech,
        reach_start_s=reach_start,
        reach_end_s=reach_end,
        lift_start_s=lift_start,
        lift_end_s=lift_end,
        apex_s=lift_end if kind == "show" else reach_end,
    )
