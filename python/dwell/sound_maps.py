"""A measure of sound over a house: values on a grid, and their picture on the plan."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dwell import ConfigError
from dwell.acoustics import AcousticScene
from dwell.arguments import above_zero, choice, instance_of, integer_in_range, quoted, real_array
from dwell.array_record import ArrayRecord
from dwell.charts import BACKGROUND_COLOR, TEXT_COLOR, font
from dwell.false_color import scale_colors
from dwell.listening import Source, source_of
from dwell.places import receiver_grid
from dwell.plans import floor_plan
from dwell.world import World

#: What can be drawn: its field in a row of ``AcousticScene.metrics``, title and unit. Numbers are
#: the mean of the octaves of 500 Hz and 1 kHz (ISO 3382-1:2009, table A.1).
MEASURES: dict[str, tuple[str, str, str]] = {
    "level": ("g_db", "Level re 1 m in the free field", "dB"),
    "edt": ("edt_s", "Early decay time", "s"),
    "t20": ("t20_s", "Reverberation time T20", "s"),
    "t30": ("t30_s", "Reverberation time T30", "s"),
    "c50": ("c50_db", "Clarity C50", "dB"),
    "c80": ("c80_db", "Clarity C80", "dB"),
    "d50": ("d50", "Definition D50", ""),
    "ts": ("ts_s", "Centre time", "s"),
    "drr": ("drr_db", "Direct to reverberant", "dB"),
}
# G is re 10 m, the map re 1 m.
_TEN_METRES_DB = 20.0
_CENTRES_HZ = (500.0, 1000.0)
# Floors of one storey may be this much lower than its rooms', m.
_STEP_M = 0.3
# Places whose energies are held at once.
_AT_ONCE = 128


@dataclass(frozen=True, eq=False)
class SoundMap(ArrayRecord):
    """A measure at the nodes of a grid.

    Attributes:
        measure: Which, a key of :data:`MEASURES`.
        source: What sounds.
        places: Where it was taken (node, 3), m.
        values: Shape (node,), in the measure's unit; NaN where it does not exist.
        spacing_m: Distance of neighbours, m.
        house_hash: ``hash()`` of the :class:`~dwell.House`; ``None``: not known.
    """

    measure: str
    source: Source
    places: NDArray[np.float64]
    values: NDArray[np.float64]
    spacing_m: float
    house_hash: int | None = None


def sound_map(
    scene: AcousticScene,
    source: Source | Sequence[float],
    measure: str = "level",
    *,
    spacing_m: float = 0.5,
    height_m: float = 1.2,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[float, str], None] = lambda fraction, what: None,
) -> SoundMap:
    """Takes a measure wherever someone can stand in a house.

    Args:
        scene: The house.
        source: What sounds.
        measure: A key of :data:`MEASURES`.
        spacing_m: Distance of neighbours, m, 0.1 to 10.
        height_m: Height over the floor, m, 0.1 to 2.
        seed: The seed of the rays.
        threads: How many threads to use; the result does not depend on it.
        progress: Is told a fraction and what is being done.
    """
    scene = instance_of("scene", scene, AcousticScene)
    field = MEASURES[choice("measure", measure, tuple(MEASURES))][0]
    if not callable(progress):
        raise ConfigError(f"progress is {quoted(progress)}; expected a function")
    places = receiver_grid(scene.house, spacing_m, height_m)
    values: list[float] = []
    for first in range(0, len(places), _AT_ONCE):
        some = places[first : first + _AT_ONCE]
        for rows in scene.metrics_at(source, list(some), seed=seed, threads=threads):
            values.append(_single(rows, field))
        progress(len(values) / len(places), f"{len(values)} of {len(places)} places")
    found = np.array(values) - (_TEN_METRES_DB if measure == "level" else 0.0)
    return SoundMap(measure, source_of(source), places, found, float(spacing_m), hash(scene.house))


def _single(rows: list[dict[str, Any]], field: str) -> float:
    found = [row[field] for row in rows if row["centre_hz"] in _CENTRES_HZ]
    return float(np.mean([np.nan if value is None else value for value in found]))


def draw_map(
    found: SoundMap, world: World, level: int = 0, *, longest_edge: int = 900
) -> Image.Image:
    """A map on the plan of a storey, with its scale of colours and the source.

    Args:
        found: The map.
        world: The house's world, for the plan.
        level: The storey, from 0.
        longest_edge: Pixels of the plan's longer edge.

    Raises:
        ConfigError: There is no value on this storey, a field of the map is wrong, or the map is of
            another house.
    """
    world = instance_of("world", world, World)
    found = _checked(instance_of("found", found, SoundMap))
    if found.house_hash is not None and found.house_hash != hash(world.house):
        raise ConfigError(
            f"found is the map of another house than {quoted(world.house.name)}, that of the world"
        )
    level = integer_in_range("level", level)
    _, title, unit = MEASURES[found.measure]
    here = _on_storey(found.places, world, level)
    there = here & np.isfinite(found.values)
    if not there.any():
        raise ConfigError(f"storey {level}: no place has a value of {found.measure}")
    low, high = (float(v) for v in np.quantile(found.values[there], (0.02, 0.98)))
    span = max(high - low, 1e-9)
    squares = []
    for (x, _, z), value in zip(found.places[there], found.values[there], strict=True):
        r, g, b = (int(v) for v in scale_colors(np.array((value - low) / span)))
        squares.append((float(x), float(z), found.spacing_m, (r, g, b)))
    at = found.source.position
    ways = [("#1f8f5f", [at])] if _on_storey(np.array([at]), world, level)[0] else []
    plan = floor_plan(world, level, longest_edge=longest_edge, ways=ways, squares=squares)
    words = f"{title}, 500 Hz and 1 kHz" + (f", {unit}" if unit else "")
    return _with_scale(plan, words, low, high)


def _checked(found: SoundMap) -> SoundMap:
    """A map whose fields are of their types and fit each other."""
    places = real_array("found.places", found.places, np.float64)
    values = real_array("found.values", found.values, np.float64)
    if places.ndim != 2 or places.shape[1] != 3 or values.shape != places.shape[:1]:
        raise ConfigError(
            f"found: places of shape {places.shape} and values of shape {values.shape}; expected "
            "(node, 3) and (node,)"
        )
    return SoundMap(
        choice("found.measure", found.measure, tuple(MEASURES)),
        instance_of("found.source", found.source, Source),
        places,
        values,
        above_zero("found.spacing_m", found.spacing_m),
        None
        if found.house_hash is None
        else integer_in_range("found.house_hash", found.house_hash, low=-(2**63)),
    )


def _on_storey(places: NDArray[np.float64], world: World, level: int) -> NDArray[np.bool_]:
    """Which places are on a storey: from a step below its floors up to that of the next."""
    of_room = {room["name"]: room["level"] for room in world.house.info()["rooms"]}
    floors = [(of_room[room["name"]], room["floor_y"]) for room in world.house.rooms()]
    own = min((y for on, y in floors if on == level), default=-np.inf) - _STEP_M
    above = min((y for on, y in floors if on == level + 1), default=np.inf) - _STEP_M
    on: NDArray[np.bool_] = (places[:, 1] >= own) & (places[:, 1] < above)
    return on


def _with_scale(plan: Image.Image, words: str, low: float, high: float) -> Image.Image:
    """A picture with a bar of colours below it, from 2 % to 98 % of the values."""
    size = max(plan.width // 50, 11)
    canvas = Image.new("RGB", (plan.width, plan.height + 5 * size), BACKGROUND_COLOR)
    canvas.paste(plan)
    draw = ImageDraw.Draw(canvas)
    top, wide = plan.height + 2 * size, plan.width - 4 * size
    bar = scale_colors(np.linspace(0.0, 1.0, wide))[None].repeat(size, axis=0)
    canvas.paste(Image.fromarray(bar), (2 * size, top))
    draw.text((2 * size, top - size // 2), words, TEXT_COLOR, font(size), "ls")
    for k in range(5):
        value, x = low + (high - low) * k / 4, 2 * size + wide * k / 4
        anchor = ("ls", "ms", "ms", "ms", "rs")[k]
        draw.text((x, top + 2.3 * size), f"{value:.3g}", TEXT_COLOR, font(size), anchor)
    return canvas
