"""Houses as pictures for people: floor plans, doll's houses, contact sheets."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from PIL import Image, ImageColor, ImageDraw, ImageFont

from dwell import ConfigError, _native
from dwell.arguments import (
    finite_number,
    instance_of,
    integer_in_range,
    mapping,
    point,
    quoted,
    sequence_items,
    text,
)
from dwell.camera import Camera, Preset
from dwell.edit_fields import rgb
from dwell.house import House
from dwell.messages import printable
from dwell.world import World

#: Pictures are drawn this much larger and then made smaller, so that edges are smooth.
_SUPERSAMPLING = 2
_BACKGROUND_COLOR = (250, 249, 246)
_TEXT_COLOR = (38, 40, 46)
_SECONDARY_COLOR = (110, 113, 122)
_DOOR_COLOR = (176, 92, 44)
#: How much squares hide of what is below them, of 255.
_SQUARE_ALPHA = 190
#: Lengths that a scale may show, m.
_SCALES_M = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
_MAX_PIXELS = 8192
#: Pictures in a row of a sheet.
MAX_COLUMNS = 64
_PATHS_EXPECTED = "expected a colour and positions (x, y, z) in metres for each"
_TITLED = "expected a title and a picture of Pillow for each"
#: More pictures than a sheet can hold.
_MOST_PICTURES = 10_000
_SQUARES_EXPECTED = "expected (x, z, edge, colour) for each, the edge in metres"

_Font = ImageFont.FreeTypeFont | ImageFont.ImageFont


def floor_plan(
    world: World,
    level: int = 0,
    *,
    longest_edge: int = 1000,
    ways: Sequence[tuple[str, Sequence[Sequence[float]]]] = (),
    squares: Sequence[tuple[float, float, float, tuple[int, int, int]]] = (),
) -> Image.Image:
    """A storey from above with its rooms' names and sizes, the swing of its doors, and a scale.

    Args:
        world: The world as it stands.
        level: The storey, from 0.
        longest_edge: Pixels of the plan's longer edge, 16 to 8192; the scale stands below it.
        ways: Lines to draw over it: for each a colour and positions (x, y, z) in m.
        squares: Squares to paint on its floor: for each the middle (x, z) and the edge in m, and a
            colour, which lets the plan shine through.

    Raises:
        DwellError: There is no such storey; a line or square that is none.
    """
    world = instance_of("world", world, World)
    strokes = [
        _stroke(f"ways[{k}]", row)
        for k, row in enumerate(sequence_items("ways", ways, _PATHS_EXPECTED))
    ]
    tiles = [
        _tile(f"squares[{k}]", row)
        for k, row in enumerate(sequence_items("squares", squares, _SQUARES_EXPECTED))
    ]
    edge = integer_in_range("longest_edge", longest_edge, low=16, high=_MAX_PIXELS)
    picture, (left, top), scale = world.map(_SUPERSAMPLING * edge, level=level)
    plan = _native.floor_plan(world.native, integer_in_range("level", level))
    foot = round(max(_SUPERSAMPLING * edge * 0.05, 40.0))
    canvas = Image.new("RGB", (picture.shape[1], picture.shape[0] + foot), _BACKGROUND_COLOR)
    canvas.paste(Image.fromarray(picture))
    line = max(round(_SUPERSAMPLING * edge / 700), 1)

    def place(x: float, z: float) -> tuple[float, float]:
        return (x - left) * scale, (z - top) * scale

    if tiles:
        paint = Image.new("RGBA", canvas.size)
        brush = ImageDraw.Draw(paint)
        for x, z, wide, color in tiles:
            corners = [place(x - 0.5 * wide, z - 0.5 * wide), place(x + 0.5 * wide, z + 0.5 * wide)]
            brush.rectangle(corners, (*color, _SQUARE_ALPHA))
        canvas.paste(paint, mask=paint)
    draw = ImageDraw.Draw(canvas)
    for door in plan["doors"]:
        hinge = place(*door["hinge"])
        draw.line([hinge, place(*door["open"])], fill=_DOOR_COLOR, width=2 * line)
        draw.line([place(*point) for point in _door_swing(door)], fill=_DOOR_COLOR, width=line)
    for stroke, way in strokes:
        _draw_path(draw, stroke, [place(x, z) for x, _, z in way], line)
    for room in plan["rooms"]:
        at = place(*room["label_position"])
        _name(draw, room, at, _SUPERSAMPLING * edge, canvas.width)
    _scale(draw, canvas.size, scale, foot, line)
    return _smooth(canvas)


def _stroke(name: str, row: object) -> tuple[str, list[tuple[float, float, float]]]:
    """A colour and positions."""
    parts = sequence_items(name, row, _PATHS_EXPECTED)
    if len(parts) != 2:
        raise ConfigError(f"{name} is {quoted(row)}; {_PATHS_EXPECTED}")
    color = text(f"{name}[0]", parts[0])
    try:
        ImageColor.getrgb(color)
    except ValueError:
        expected = "expected a colour, as 'red' or '#1f8f5f'"
        raise ConfigError(f"{name}[0] is {quoted(color)}; {expected}") from None
    places = sequence_items(f"{name}[1]", parts[1], "expected positions (x, y, z) in metres")
    return color, [point(f"{name}[1][{k}]", place) for k, place in enumerate(places)]


def _tile(name: str, row: object) -> tuple[float, float, float, tuple[int, int, int]]:
    """The middle and the edge of a square, and its colour."""
    parts = sequence_items(name, row, _SQUARES_EXPECTED)
    if len(parts) != 4:
        raise ConfigError(f"{name} is {quoted(row)}; {_SQUARES_EXPECTED}")
    x, z, wide = (finite_number(f"{name}[{k}]", part) for k, part in enumerate(parts[:3]))
    if wide <= 0.0:
        raise ConfigError(f"{name}[2] is {wide:g}; allowed are edges above 0 m")
    red, green, blue = rgb(f"{name}[3]", parts[3])
    return x, z, wide, (red, green, blue)


def dollhouse(
    world: World,
    *,
    width: int = 1000,
    yaw_deg: float = 25.0,
    down_deg: float = 52.0,
    cut_m: float = 1.6,
) -> Image.Image:
    """The house as a doll's house: every storey from outside, cut open.

    The lowest storey is at the bottom; of narrow houses, whose storeys stand side by side, left.

    Args:
        world: The world as it stands.
        width: Pixels across, 16 to 8192.
        yaw_deg: Where one looks, to the left of -Z.
        down_deg: How far one looks down, 20 to 90.
        cut_m: Height of the cut over each floor, m, 0.3 to 10.
    """
    world = instance_of("world", world, World)
    wide = _SUPERSAMPLING * integer_in_range("width", width, low=16, high=_MAX_PIXELS)
    config = {
        "width": wide,
        "yaw_deg": finite_number("yaw_deg", yaw_deg),
        "down_deg": finite_number("down_deg", down_deg),
        "cut_m": finite_number("cut_m", cut_m),
    }
    storeys = [
        Image.fromarray(_native.dollhouse(world.native, level, config))
        for level in range(levels_of(world.house))
    ]
    joined = _stack_storeys(storeys)
    return joined.resize(
        (
            wide // _SUPERSAMPLING,
            max(round(joined.height * wide / joined.width / _SUPERSAMPLING), 1),
        ),
        Image.Resampling.BOX if joined.width == wide else Image.Resampling.LANCZOS,
    )


def levels_of(house: House) -> int:
    """How many storeys a house has."""
    return int(instance_of("house", house, House).info()["levels"])


def sheet(
    pictures: Sequence[tuple[str, Image.Image]],
    *,
    columns: int = 4,
    tile: tuple[int, int] = (360, 270),
) -> Image.Image:
    """Pictures beside and below one another, each with a line below it.

    Args:
        pictures: A title and a picture each; they are made smaller to fit, never larger. Of a
            title that is longer than its line the beginning and the end are shown.
        columns: Pictures in a row, from 1.
        tile: Pixels across and down for each.
    """
    edges = sequence_items("tile", tile, "expected pixels across and down", most=2)
    if len(edges) != 2:
        raise ConfigError(f"tile is {quoted(tile)}; expected pixels across and down")
    across, down = (integer_in_range("tile", edge, low=8, high=_MAX_PIXELS) for edge in edges)
    given = sequence_items("pictures", pictures, _TITLED, most=_MOST_PICTURES)
    titled = [_picture(f"pictures[{k}]", row) for k, row in enumerate(given)]
    columns = integer_in_range("columns", columns, low=1, high=MAX_COLUMNS)
    columns = min(columns, max(len(titled), 1))
    gap, foot = 10, 24
    rows = math.ceil(len(titled) / columns)
    size = (columns * (across + gap) + gap, rows * (down + foot + gap) + gap)
    canvas = Image.new("RGB", size, _BACKGROUND_COLOR)
    draw = ImageDraw.Draw(canvas)
    for k, (title, picture) in enumerate(titled):
        x, y = gap + k % columns * (across + gap), gap + k // columns * (down + foot + gap)
        small = picture.convert("RGB")
        small.thumbnail((across, down), Image.Resampling.LANCZOS)
        canvas.paste(small, (x + (across - small.width) // 2, y + (down - small.height) // 2))
        _text(draw, (x + 2, y + down + 18), title, 15, _TEXT_COLOR, widest=across - 2)
    return canvas


def _picture(name: str, row: object) -> tuple[str, Image.Image]:
    """A title and a picture."""
    parts = sequence_items(name, row, _TITLED, most=2)
    if len(parts) != 2 or not isinstance(parts[1], Image.Image):
        raise ConfigError(f"{name} is {quoted(row)}; {_TITLED}")
    return text(f"{name}[0]", parts[0]), parts[1]


def house_sheet(
    world: World,
    *,
    columns: int = 4,
    preset: Preset = "lit",
    progress: Callable[[float, str], None] | None = None,
) -> Image.Image:
    """One house: the doll's house, the plan of each storey, a view of each room.

    Args:
        world: The house as it stands.
        columns: Pictures in a row, from 1 to 64.
        preset: How the rooms are lit.
        progress: Is told the share that is done, 0 to 1, and the picture that comes next.
    """
    house = instance_of("world", world, World).house
    # Before pictures are made for nothing.
    columns = integer_in_range("columns", columns, low=1, high=MAX_COLUMNS)
    levels, rooms = range(levels_of(house)), house.rooms()
    pictures: list[tuple[str, Image.Image]] = []

    def show_progress(title: str) -> None:
        if progress is not None:
            progress(len(pictures) / (1 + len(levels) + len(rooms)), title)

    show_progress("doll's house")
    pictures.append((house.name, dollhouse(world, width=720)))
    for level in levels:
        title = f"storey {level + 1}" if len(levels) > 1 else "plan"
        show_progress(title)
        pictures.append((title, floor_plan(world, level, longest_edge=720)))
    for room in rooms:
        show_progress(_room_title(room))
        image = room_view(world, room, Camera(720, 540, preset=preset))
        pictures.append((f"{_room_title(room)}, {room['area_m2']:.1f} m²", image))
    show_progress(f"{len(pictures)} pictures")
    return sheet(pictures, columns=columns)


def houses_sheet(houses: Sequence[str], *, columns: int = 4) -> Image.Image:
    """Many houses: the doll's house of each, with its name and its number of rooms.

    Args:
        houses: HOUSE strings, each of one house.
        columns: Pictures in a row.
    """
    # Before pictures are made for nothing.
    columns = integer_in_range("columns", columns, low=1, high=MAX_COLUMNS)
    names = sequence_items("houses", houses, "expected HOUSE strings", most=_MOST_PICTURES)
    return sheet([house_tile(name) for name in names], columns=columns)


def house_tile(name: str) -> tuple[str, Image.Image]:
    """A title and the doll's house of a HOUSE string, for :func:`sheet`."""
    house = House.open(name)
    rooms = len(house.info()["rooms"])
    title = f"{name}, {rooms} room{'' if rooms == 1 else 's'}"
    return title, dollhouse(World(house, agents=0), width=540)


def room_view(world: World, room: dict[str, Any], camera: Camera) -> Image.Image:
    """The view of a room from its viewpoint, a row of ``House.rooms()``.

    Raises:
        ConfigError: It is none, or ``world`` or ``camera`` is of another type.
    """
    world = instance_of("world", world, World)
    row = mapping("room", room, "a row of House.rooms()")
    if missing := sorted({"eye", "yaw_deg"} - set(row)):
        raise ConfigError(f"room has no {missing[0]}; expected a row of House.rooms()")
    seen = world.render(
        position=point("room.eye", row["eye"]),
        yaw_deg=finite_number("room.yaw_deg", row["yaw_deg"]),
        pitch_deg=-6.0,
        camera=instance_of("camera", camera, Camera),
    )
    return Image.fromarray(seen["rgb"])


def _room_title(room: dict[str, Any]) -> str:
    return str(room["kinds"][0] if room["kinds"] else room["name"])


def _font(size: float) -> _Font:
    try:
        # Nobody reads letters of less than a pixel; the font refuses them.
        return ImageFont.load_default(max(size, 1.0))
    except TypeError:  # Pillow before 10.1 has one size
        return ImageFont.load_default()


def _smooth(canvas: Image.Image) -> Image.Image:
    size = (max(canvas.width // _SUPERSAMPLING, 1), max(canvas.height // _SUPERSAMPLING, 1))
    return canvas.resize(size, Image.Resampling.BOX)


def _stack_storeys(storeys: list[Image.Image]) -> Image.Image:
    """Below one another, or side by side if they are higher than wide; all have one width."""
    wide, high = storeys[0].width, max(picture.height for picture in storeys)
    beside = high > wide
    size = (wide * len(storeys), high) if beside else (wide, sum(one.height for one in storeys))
    canvas = Image.new("RGB", size, _BACKGROUND_COLOR)
    left, top = 0, size[1]
    for picture in storeys:
        top -= picture.height
        canvas.paste(picture, (left, high - picture.height) if beside else (0, top))
        left += picture.width
    return canvas


def _door_swing(door: dict[str, Any]) -> list[tuple[float, float]]:
    """The way of a leaf's edge from shut to open, past the middle."""
    hinge_x, hinge_z = door["hinge"]
    turns = [
        math.atan2(door[key][1] - hinge_z, door[key][0] - hinge_x)
        for key in ("shut", "half", "open")
    ]
    for k in (1, 2):
        turns[k] = turns[k - 1] + math.remainder(turns[k] - turns[k - 1], math.tau)
    radius = math.dist(door["hinge"], door["shut"])
    steps = [turns[0] + (turns[2] - turns[0]) * k / 24 for k in range(25)]
    return [(hinge_x + radius * math.cos(a), hinge_z + radius * math.sin(a)) for a in steps]


def _draw_path(
    draw: ImageDraw.ImageDraw, color: str, points: list[tuple[float, float]], line: int
) -> None:
    """A line with a halo, its start white and its end filled."""
    if not points:
        return
    if len(points) > 1:
        draw.line(points, fill="white", width=7 * line, joint="curve")
        draw.line(points, fill=color, width=4 * line, joint="curve")
    for (x, y), fill in zip((points[0], points[-1]), ("white", color), strict=True):
        r = 6 * line
        draw.ellipse((x - r, y - r, x + r, y + r), fill=fill, outline="black", width=2 * line)


def _name(
    draw: ImageDraw.ImageDraw, room: dict[str, Any], at: tuple[float, float], edge: int, wide: int
) -> None:
    """The room's word, at most so wide, with its area below it."""
    halo = max(edge // 500, 1)
    place, word = (at[0], at[1] - edge * 0.004), _room_title(room)
    _text(draw, place, word, edge * 0.02, _TEXT_COLOR, halo, 0.5, widest=wide)
    area = f"{room['area_m2']:.1f} m²"
    _text(draw, (at[0], at[1] + edge * 0.016), area, edge * 0.016, _SECONDARY_COLOR, halo, 0.5)


def _text(
    draw: ImageDraw.ImageDraw,
    at: tuple[float, float],
    words: str,
    size: float,
    color: tuple[int, int, int],
    halo: int = 0,
    before: float = 0.0,
    widest: float | None = None,
) -> None:
    """A line of words on the baseline at a place, of which a part stands before it.

    The font that comes with Pillow has no raised 2: one at the end is a small one, raised. Of words
    that are wider than ``widest``, pixels, the middle is left out.
    """
    raised = words.endswith("²")
    words, font, small = words.removesuffix("²"), _font(size), _font(0.7 * size)
    beside = draw.textlength("2", small) if raised else 0.0
    if widest is not None:
        words = _fitted(words, widest - beside, lambda part: draw.textlength(part, font))
    width = draw.textlength(words, font) + beside
    x, y = at[0] - before * width, at[1]
    halo_color = _BACKGROUND_COLOR if halo else None
    draw.text((x, y), words, color, font, "ls", stroke_width=halo, stroke_fill=halo_color)
    if raised:
        place = (x + draw.textlength(words, font), y - 0.35 * size)
        draw.text(place, "2", color, small, "ls", stroke_width=halo, stroke_fill=halo_color)


def _fitted(words: str, widest: float, width_of: Callable[[str], float]) -> str:
    """Words on one line, without their middle where they are wider than ``widest``."""
    words = " ".join(printable(words).splitlines())

    # Letters narrower than half a pixel cannot be read, and Pillow refuses to measure long text.
    most = min(len(words), max(round(2.0 * widest), 0))
    if most == len(words) and width_of(words) <= widest:
        return words

    def part(count: int) -> str:
        return f"{words[: count - count // 2]}...{words[len(words) - count // 2 :]}"

    low, high = 0, most + 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if width_of(part(middle)) <= widest else (low, middle)
    return part(low) if width_of(part(low)) <= widest else ""


def _scale(
    draw: ImageDraw.ImageDraw, size: tuple[int, int], scale: float, foot: int, line: int
) -> None:
    """A bar of a round length, at most a quarter of the width."""
    length_m = max((m for m in _SCALES_M if m * scale <= size[0] / 4), default=_SCALES_M[0])
    x, y = foot / 2, size[1] - foot / 2
    end = x + length_m * scale
    draw.line([(x, y), (end, y)], fill=_TEXT_COLOR, width=2 * line)
    for at in (x, end):
        draw.line([(at, y - foot / 6), (at, y + foot / 6)], fill=_TEXT_COLOR, width=2 * line)
    _text(draw, (end + foot / 4, y + foot * 0.15), f"{length_m:g} m", foot * 0.45, _TEXT_COLOR)
