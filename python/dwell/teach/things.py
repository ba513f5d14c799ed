"""The things that users teach: 22 of them, of which each user has some."""

from __future__ import annotations

import dataclasses
import functools

import dwell

_RGB = tuple[int, int, int]
#: The things of a user, as many as one has in MHRI, and those of them that lie on the table.
THINGS_OF_A_USER = 10
THINGS_ON_THE_TABLE = 6


@dataclasses.dataclass(frozen=True)
class Thing:
    """A thing of the pool.

    Attributes:
        name: Its name in every house.
        kind: Its kind in the catalogue.
        seed: What sizes are drawn from.
        srgb: Its colour, where two of a kind shall differ.
    """

    name: str
    kind: str
    seed: int
    srgb: _RGB | None = None


#: Small, silent, and told apart by their words; of four kinds there are two of different colours.
#: Names are those that no house has.
POOL = (
    Thing("mug_a", "mug", 1, (176, 36, 36)),
    Thing("mug_b", "mug", 2, (36, 76, 176)),
    Thing("bottle_a", "bottle", 2),
    Thing("bottle_b", "bottle", 3, (40, 130, 60)),
    Thing("book_a", "book", 4, (170, 40, 40)),
    Thing("book_b", "book", 6, (40, 120, 60)),
    Thing("ball_a", "toy_ball", 2),
    Thing("ball_b", "toy_ball", 5, (235, 200, 40)),
    Thing("bowl_a", "bowl", 2),
    Thing("plate_a", "plate", 1),
    Thing("teapot_a", "teapot", 1),
    Thing("jar_a", "jar", 1),
    Thing("vase_a", "vase", 2, (110, 60, 130)),
    Thing("candle_a", "candle", 1),
    Thing("block_a", "toy_block", 0),
    Thing("train_a", "toy_train", 2),
    Thing("bear_a", "teddy_bear", 0),
    Thing("plant_a", "small_plant", 2),
    Thing("pencil_cup_a", "pencil_cup", 2),
    Thing("camera_a", "camera", 0),
    Thing("bread_a", "bread", 2),
    Thing("fruit_a", "fruit", 1),
)


@functools.cache
def sizes_m() -> dict[str, tuple[float, float, float]]:
    """The edges of the box around each thing of the pool as it stands unturned, by name, m."""
    builder = dwell.HouseBuilder("things", style="nordic")
    builder.room("room", (0.0, 0.0, 1.0 + len(POOL), 2.0))
    for k, thing in enumerate(POOL):
        add(builder, thing, (1.0 + k, 0.0, 1.0), 0.0)
    world = dwell.World(builder.build(), agents=0)
    found = {}
    for thing in POOL:
        x, y, z = world.object(thing.name)["size"]
        found[thing.name] = (x, y, z)
    return found


def add(
    edits: dwell.HouseBuilder | dwell.HouseEdit,
    thing: Thing,
    at: tuple[float, float, float],
    yaw_deg: float,
) -> None:
    """Puts a thing of the pool into a house."""
    edits.add(
        thing.kind,
        at,
        yaw_deg=yaw_deg,
        name=thing.name,
        style="nordic",
        seed=thing.seed,
        srgb=thing.srgb,
    )
