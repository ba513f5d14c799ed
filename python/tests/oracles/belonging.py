"""What belongs to what: what falls without it, what it rests on, and what it hangs on."""

from __future__ import annotations

import numpy as np

from oracles.answers import Answer, all_of, any_of, at_least, at_most
from oracles.outlines import area, gap, nearest_on, over, thinned
from oracles.places import same_room
from oracles.removal import Physics, on_and_in
from oracles.scans import Floats, flat_picture, scan
from oracles.scene import Scene, clear

#: Parts of walls: nothing need hold them.
OPENINGS = ("door", "window", "garage")
CLOTH = ("curtain", "blind")


def rests_on(scene: Scene, physics: Physics, a: str) -> dict[int, float] | None:
    """The parts of a movable thing's sole that have other ids within 0.03 m above or below.

    The thing is taken away, so that the picture from above shows what was below it.
    """
    if a not in physics.movable or scene.cloud(a).cut:
        return None
    cloud, sole = scene.cloud(a), scene.sole(a)
    if len(sole) < 4:
        return None
    low, high = cloud.low - 0.004, cloud.high + 0.004
    size = (float(high[0] - low[0]), float(high[2] - low[2]))
    pixels = (int(np.clip(size[0] / 0.004, 8, 160)), int(np.clip(size[1] / 0.004, 8, 160)))
    eye = np.array(((low[0] + high[0]) / 2, cloud.low[1] + 0.03, (low[2] + high[2]) / 2))
    physics.world.set_body(a, position=tuple(cloud.middle + np.array((0.0, 80.0, 0.0))))
    ids, depth, _ = flat_picture(physics.world, eye, (0, -90), size, pixels)
    physics.world.restore(physics.start)
    column = ((sole[:, 0] - low[0]) / size[0] * pixels[0]).astype(int)
    row = ((sole[:, 2] - low[2]) / size[1] * pixels[1]).astype(int)
    spot = np.clip(row, 0, pixels[1] - 1), np.clip(column, 0, pixels[0] - 1)
    below = np.where(depth[spot] < 0.06, ids[spot], 0)
    numbers, counts = np.unique(below, return_counts=True)
    return {
        int(number): float(count) / len(below)
        for number, count in zip(numbers, counts, strict=True)
        if number > 0
    }


def _just_below(scene: Scene, a: str, rise_m: float) -> dict[int, float]:
    """The parts of a thing's outline, by id, under which points are from 0.04 m below its foot up.

    What its own faces hide is not met. Its rim, a twenty-fifth of it, is left out.
    """
    cloud = scene.cloud(a)
    low = np.array((cloud.low[0], cloud.low[1] - 0.04, cloud.low[2]))
    high = np.array((cloud.high[0], cloud.low[1] + rise_m, cloud.high[2]))
    size = high - low
    low, high = low + size * (0.04, 0, 0.04), high - size * (0.04, 0, 0.04)
    spacing = max(0.004, float(size.max() / 60))
    ids, points = scan(scene.world, low, high, spacing)
    found: dict[int, float] = {}
    for number in set(np.unique(ids).tolist()) - {scene.rows[a]["id"]}:
        flat = np.floor(points[ids == number][:, [0, 2]] / spacing)
        cells = {(int(x), int(z)) for x, z in flat}
        inside = sum(over(cloud.outline, (np.array(cell) + 0.5) * spacing) for cell in cells)
        found[int(number)] = inside * spacing**2 / max(area(cloud.outline), spacing**2)
    return found


def _free_below(scene: Scene, a: str) -> Answer:
    """Whether nothing is just below a thing: no other under a fiftieth of its outline."""
    return "yes" if sum(_just_below(scene, a, 0.012).values()) < 0.02 else "grey"


def _stands_on(scene: Scene, a: str, number: int) -> Answer:
    """Whether something that is not to be moved stands on a piece of the building.

    It does if that is under half of its outline, and nothing else is; not, if that is not there.
    """
    below = _just_below(scene, a, 0.03)
    mine = below.pop(number, 0.0)
    if mine > 0.5 and sum(below.values()) < 0.02:
        return "yes"
    # The faces of its sole may hide what is there.
    if mine == 0.0 and (sum(below.values()) > 0.3 or _free_below(scene, a) == "yes"):
        return "no"
    return "grey"


def _walls_and_ceilings(scene: Scene, a: str) -> tuple[dict[int, float], dict[int, float]]:
    """Gaps in m, by id, to pieces of the building beside a thing and over it, as far as 0.15 m."""
    cloud = scene.cloud(a)
    reach = np.array((0.15, 0.15, 0.15))
    low, high = cloud.low - reach, cloud.high + reach
    ids, points = scan(scene.world, low, high, max(0.008, float((high - low).max()) / 80), 4)
    known = [row["id"] for row in scene.rows.values()]
    beside: dict[int, float] = {}
    over_it: dict[int, float] = {}
    for number in set(np.unique(ids).tolist()) - set(known):
        mine = points[ids == number]
        level = mine[(mine[:, 1] > cloud.low[1] + 0.005) & (mine[:, 1] < cloud.high[1] - 0.005)]
        if len(level) >= 6:
            flat = thinned(level[:, [0, 2]], 1500)
            beside[int(number)] = min(
                0.0
                if over(cloud.outline, p)
                else float(np.linalg.norm(nearest_on(cloud.outline, p) - p))
                for p in flat
            )
        above = mine[(mine[:, 1] > cloud.high[1] - 0.02)]
        above = above[[over(cloud.outline, p) for p in above[:, [0, 2]]]] if len(above) else above
        if len(above) >= 2 and len(level) < 6:
            over_it[int(number)] = float(above[:, 1].min() - cloud.high[1])
    return beside, over_it


def _nearest(gaps: dict[int, float], number: int, most_m: float) -> Answer:
    """Whether one is the nearest, and near enough; margins 0.015 m."""
    mine = gaps.get(number, np.inf)
    least = min((way for other, way in gaps.items() if other != number), default=np.inf)
    if mine > most_m + 0.015:
        return "no"
    if least < mine - 0.015:
        return "no"
    return "yes" if mine < most_m - 0.015 and least > mine + 0.015 else "grey"


def hangs_on(scene: Scene, a: str, number: int) -> Answer:
    """Whether a wall, or else a ceiling, is what a thing is fixed to: gaps of 0.06 m, margin 0.015.

    A thing below which something is may stand there, and cloth hangs before windows: grey.
    """
    cloud = scene.cloud(a)
    if cloud.cut:
        return "grey"
    beside, over_it = _walls_and_ceilings(scene, a)
    if a.startswith(OPENINGS):
        return _nearest(beside, number, 0.06)
    free = _free_below(scene, a)
    height = scene.height_below(float(cloud.middle[1]))
    # A wall's foot is at the floor, or lower.
    raised = height is not None and cloud.low[1] > height + 0.12
    wall = all_of(_nearest(beside, number, 0.06), "yes" if raised else "grey")
    none_beside = at_least(min(beside.values(), default=np.inf), 0.06, 0.015)
    ceiling = all_of(_nearest(over_it, number, 0.06), none_beside)
    found = any_of(wall, ceiling)
    if found == "no":
        return "no"
    if any(word in a for word in CLOTH):
        return "grey"
    return all_of(found, free)


def belongs_to_building(scene: Scene, physics: Physics, a: str, number: int) -> Answer:
    """Whether a thing rests or hangs on a piece of the building, by the piece's id.

    Resting: a third of the sole, margin 0.12. What rests on something does not hang.
    """
    below = rests_on(scene, physics, a)
    if scene.cloud(a).cut:
        return "grey"
    if below is None:
        return any_of(_stands_on(scene, a, number), hangs_on(scene, a, number))
    resting = at_least(below.get(number, 0.0), 1 / 3, 0.12)
    if max(below.values(), default=0.0) > 0.45:
        return resting
    return any_of(resting, hangs_on(scene, a, number))


def belongs_to(scene: Scene, physics: Physics, a: str, b: str, moves: dict[str, Floats]) -> Answer:
    """Whether a is in or on b, by taking b away; whichever of both it is does not matter.

    What falls and has nothing else below is on it or in it. What rests on a third thing is at
    most in b; what does not fall may be in it and stand on the floor.
    """
    if not clear(scene, a, b):
        return "grey"
    falls = physics.falls(a, moves)
    carried, within = on_and_in(scene, physics, a, b, moves)
    below = rests_on(scene, physics, a)
    number = scene.rows[b]["id"]
    direct: Answer = "grey" if below is None else at_least(below.get(number, 0.0), 1 / 3, 0.12)
    if falls == "yes":
        if any_of(carried, within) == "yes":
            return "yes"
        return any_of(direct, within)
    one, other = scene.cloud(a), scene.cloud(b)
    if gap(one.outline, other.outline) > 0.06 or one.low[1] > other.high[1] + 0.05:
        return "no"
    if falls == "no" and direct == "no":
        # Its middle is not in the other's box: it is not in it, whether it falls or not.
        outside = np.any(one.middle < other.low - 0.03) or np.any(one.middle > other.high + 0.03)
        return "no" if outside else "grey"
    return "grey"


def hangs_at_window(scene: Scene, a: str, window: str) -> Answer:
    """Whether cloth hangs at a window: 0.3 m, margin 0.05; of windows the nearest, margin 0.05."""
    windows = [name for name in scene.rows if name.startswith("window")]
    if not clear(scene, a, window):
        return "grey"
    cloud = scene.cloud(a)

    def away(name: str) -> float:
        other = scene.cloud(name)
        beside = min(cloud.high[1], other.high[1]) - max(cloud.low[1], other.low[1])
        return gap(cloud.outline, other.outline) if beside > -0.02 else np.inf

    other = scene.cloud(window)
    common = min(cloud.high[1], other.high[1]) - max(cloud.low[1], other.low[1])
    least = min((away(name) for name in windows if name != window), default=np.inf)
    mine = away(window)
    if np.isinf(mine):
        return "no"
    return all_of(
        at_most(mine, 0.3, 0.05),
        "grey" if abs(least - mine) < 0.05 else "yes" if mine < least else "no",
        "yes" if common > 0.1 else "grey",
        # Windows are in walls, between rooms.
        "grey" if same_room(scene, a, window) == "no" else "yes",
        _free_below(scene, a),
    )
