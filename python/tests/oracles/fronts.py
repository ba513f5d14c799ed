"""Fronts by how things look and where they stand, and what is opposite to what."""

from __future__ import annotations

import numpy as np

import dwell
from oracles.answers import Answer, Viewer, all_of, any_of, at_least
from oracles.places import room_of, same_room, upright_box
from oracles.scans import Flags, Floats, angles_to, flat_picture, frame
from oracles.scene import Cloud, Scene, clear

#: These are higher at their backs.
SEATS = ("chair", "armchair", "office_chair", "bench_chair", "sofa", "double_bed", "single_bed")
#: These stand or hang with their backs along walls.
BACKED = (
    "bookshelf",
    "cooker",
    "desk",
    "dresser",
    "hanging_kitchen_cabinet",
    "kitchen_cabinet",
    "mirror",
    "picture_frame",
    "refrigerator",
    "shelving",
    "shoes_cabinet",
    "television",
    "toilet",
    "tv_stand",
    "wardrobe_cabinet",
    "washer",
    "whiteboard",
)
#: These look alike from all sides, or no side of them is the one that is used.
PLAIN = (
    "bag",
    "ball",
    "basket",
    "blanket",
    "book",
    "books",
    "bottle",
    "bowl",
    "box",
    "bread",
    "candle",
    "chandelier",
    "cloth",
    "coffee_table",
    "containers",
    "cup",
    "dining_table",
    "drinking_glass",
    "floor_lamp",
    "flowers",
    "food",
    "pan",
    "pillow",
    "plant",
    "plate",
    "pot",
    "rug",
    "shoes",
    "table",
    "table_lamp",
    "towel",
    "trash_can",
    "vase",
)


def kind(name: str) -> str:
    """What a thing's name says that it is."""
    return name.rsplit("_", 1)[0]


def is_known(name: str) -> bool:
    """Whether it is known if such a thing has a front."""
    return kind(name) in (*SEATS, *BACKED, *PLAIN)


def _axes(scene: Scene, name: str) -> Floats:
    """Two level directions (2, 2), x and z, along a thing's edges, by its pose or its outline."""
    try:
        x, y, z, w = scene.world.body(name)["rotation"]
        along = np.array((1 - 2 * (y * y + z * z), 2 * (x * z - y * w)))
    except dwell.DwellError:
        outline, best = scene.cloud(name).outline, np.inf
        for turn in np.deg2rad(np.arange(0.0, 90.0, 0.5)):
            axes = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
            size = float(np.prod(np.ptp(outline @ axes, axis=0)))
            if size < best:
                best, along = size, axes[:, 0]
    along = along / np.linalg.norm(along)
    return np.array((along, (-along[1], along[0])))


def _by_height(cloud: Cloud, axes: Floats) -> Floats | None:
    """Away from the side on which the upper sixth of a thing is; grey where it is not on one."""
    flat = cloud.points[:, [0, 2]] @ axes.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    top = cloud.points[:, 1] > cloud.high[1] - (cloud.high[1] - cloud.low[1]) / 6
    part = (flat[top].mean(axis=0) - (low + high) / 2) / (high - low) * 2
    axis = int(np.abs(part).argmax())
    if abs(part[axis]) < 0.5 or abs(part[1 - axis]) > 0.25:
        return None
    away: Floats = -np.sign(part[axis]) * axes[axis]
    return away


def _walled(scene: Scene, cloud: Cloud, way: Floats) -> float:
    """The part of a thing's side beyond which the building is at most 0.15 m away.

    Pictures look away from the side; some begin a little within it, as it may cut into a wall.
    """
    across = np.array((-way[1], way[0]))
    flat = cloud.points[:, [0, 2]]
    first, last = float((flat @ across).min()), float((flat @ across).max())
    edge = float((flat @ way).max())
    known = [row["id"] for row in scene.rows.values()]
    size = (max(0.01, last - first), max(0.01, float(cloud.high[1] - cloud.low[1])))
    met: Flags = np.zeros((16, 16), np.bool_)
    deep = float(np.ptp(flat @ way))
    # From within a slim thing's other half they would show what is behind that.
    for start in (0.002, *(-x for x in (0.004, 0.01, 0.03) if x < 0.4 * deep)):
        x, z = way * (edge + start) + across * (first + last) / 2
        eye = np.array((x, cloud.middle[1], z))
        view = angles_to(np.array((way[0], 0.0, way[1])))
        ids, depth, _ = flat_picture(scene.world, eye, view, size, (16, 16))
        met |= (ids > 0) & ~np.isin(ids, known) & (depth < 0.15 - start)
    return float(met.mean())


def _by_walls(scene: Scene, name: str, axes: Floats) -> Floats | None:
    """Away from the only side along which a wall runs; only wide sides count, if twice as wide."""
    cloud = scene.cloud(name)
    size = np.ptp(cloud.points[:, [0, 2]] @ axes.T, axis=0)
    backs = []
    for axis in range(2):
        if size[axis] > 2 * size[1 - axis]:
            continue
        for way in (axes[axis], -axes[axis]):
            part = _walled(scene, cloud, way)
            if part > 0.25:
                backs.append((part, -way))
    return backs[0][1] if len(backs) == 1 and backs[0][0] >= 0.6 else None


def front(scene: Scene, name: str) -> Floats | Answer:
    """The level direction, x and z, of a thing's front; ``no``: it has none, ``grey``: unclear."""
    what = kind(name)
    if what in PLAIN:
        return "no"
    found = None
    if what in SEATS:
        found = _by_height(scene.cloud(name), _axes(scene, name))
    elif what in BACKED:
        found = _by_walls(scene, name, _axes(scene, name))
    return "grey" if found is None else found


def _ahead(one: Floats, way: Floats, other: Floats, spacing: float) -> Answer:
    """Whether points lie straight ahead of others: 0.5 m, margin 0.04; half of the narrower width.

    The margin of widths is 0.06, a pixel, and a degree of the way there.
    """
    across = np.array((-way[1], way[0]))
    beyond = float((other @ way).min() - (one @ way).max())
    mine, theirs = one @ across, other @ across
    common = float(min(mine.max(), theirs.max()) - max(mine.min(), theirs.min()))
    narrower = max(1e-3, min(float(np.ptp(mine)), float(np.ptp(theirs))))
    error = 0.01 + spacing + 0.017 * max(0.0, beyond)
    return all_of(
        at_least(beyond, 0.5, 0.04 + spacing / 2),
        at_least(common / narrower, 0.5, 0.06 + error / narrower),
    )


def _along_floor(scene: Scene, a: str, b: str) -> Answer:
    """Whether things lie straight beyond each other along the floor, in halves of their own."""
    room = room_of(scene, a)
    box = None if room is None else upright_box(scene, room)
    if box is None:
        return "grey"
    clouds = [scene.cloud(name) for name in (a, b)]
    flat = [cloud.points[:, [0, 2]] for cloud in clouds]
    spacing = sum(cloud.spacing for cloud in clouds) / 2
    answers = []
    for axis in range(2):
        sides = [float(c.middle[[0, 2]][axis] - (box[0] + box[1])[axis] / 2) for c in clouds]
        way = np.zeros(2)
        way[axis] = np.sign(sides[1] - sides[0]) or 1.0
        # One on each side; as far as the nearer one is from the middle.
        apart = -np.sign(sides[0] * sides[1]) * min(abs(side) for side in sides)
        halves = at_least(float(apart), 0.0, 0.1)
        answers.append(all_of(halves, _ahead(flat[0], way, flat[1], spacing)))
    return any_of(*answers)


def opposite(scene: Scene, a: str, b: str) -> Answer:
    """Clouds before fronts, or along the floor's edges where neither has one."""
    if not clear(scene, a, b):
        return "grey"
    same = same_room(scene, a, b)
    fronts = [front(scene, name) for name in (a, b)]
    if same == "no":
        return "no"
    if all(isinstance(way, str) and way == "no" for way in fronts):
        return all_of(same, _along_floor(scene, a, b))
    answers: list[Answer] = [same]
    for way, one, other in ((fronts[0], a, b), (fronts[1], b, a)):
        if isinstance(way, str):
            answers.append("grey" if way == "grey" else "yes")
            continue
        clouds = scene.cloud(one), scene.cloud(other)
        flat = [cloud.points[:, [0, 2]] for cloud in clouds]
        spacing = (clouds[0].spacing + clouds[1].spacing) / 2
        answers.append(_ahead(flat[0], way, flat[1], spacing))
    return all_of(*answers)


def opposite_agent(
    scene: Scene, viewer: Viewer, radius_m: float, name: str, room: str | None
) -> Answer:
    """As of opposite, for an agent, a disc with a front where it faces, in a room."""
    cloud = scene.cloud(name)
    if cloud.cut or room is None:
        return "grey"
    found = room_of(scene, name)
    same: Answer = "grey" if found is None else "yes" if found == room else "no"
    turns = np.arange(60) * (2 * np.pi / 60)
    disc = viewer.place[[0, 2]] + radius_m * np.stack((np.cos(turns), np.sin(turns)), axis=1)
    ahead = frame(viewer.yaw_deg, 0.0)[2][[0, 2]]
    flat = cloud.points[:, [0, 2]]
    answers = [same, _ahead(disc, ahead, flat, cloud.spacing / 2)]
    way = front(scene, name)
    if not isinstance(way, str):
        answers.append(_ahead(flat, way, disc, cloud.spacing / 2))
    elif way == "grey":
        answers.append("grey")
    return all_of(*answers)
