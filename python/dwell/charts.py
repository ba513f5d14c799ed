"""Echograms as pictures: decay curves by band, and from where sound comes."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from dwell.arguments import instance_of, integer_in_range
from dwell.echogram import CELL_COLUMNS, CELL_ROWS, CENTRES_HZ, Echogram
from dwell.false_color import scale_colors

BACKGROUND_COLOR = (250, 249, 246)
TEXT_COLOR = (38, 40, 46)
_SECONDARY_COLOR = (215, 214, 208)
#: Charts are drawn this much larger and then made smaller, so that edges are smooth.
_SUPERSAMPLING = 2
#: Decays are shown down to here, dB.
_LOWEST_DB = -60
#: Pixels across of a chart.
_MIN_WIDTH, _MAX_WIDTH = 64, 8192
#: Spans of an echogram by direction, s after the first arrival, and their names.
_SPANS = ((0.0, 0.005, "0 to 5 ms"), (0.005, 0.08, "5 to 80 ms"), (0.08, np.inf, "from 80 ms"))


def _width(width: int) -> int:
    return integer_in_range("width", width, low=_MIN_WIDTH, high=_MAX_WIDTH)


def font(size: float) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """The font that comes with Pillow."""
    try:
        return ImageFont.load_default(size)
    except TypeError:  # Pillow before 10.1 has one size
        return ImageFont.load_default()


def decay_chart(echogram: Echogram, *, width: int = 800) -> Image.Image:
    """The decay of the energy over time in each octave, dB re all (Schroeder's integral).

    Args:
        echogram: What to draw.
        width: Pixels across, 64 to 8192; names are legible from 200 on.

    Raises:
        ConfigError: ``echogram`` is none, or ``width`` out of range.
    """
    echogram, width = instance_of("echogram", echogram, Echogram), _width(width)
    wide, high = _SUPERSAMPLING * width, _SUPERSAMPLING * width * 5 // 8
    size = wide // 55
    left, right, top, bottom = 4 * size, wide - 7 * size, 2 * size, high - 4 * size
    step_s = 0.001
    decay = echogram.decay_db(step_s)
    shown = np.flatnonzero((decay > _LOWEST_DB).any(axis=1))
    end_s = max(step_s * (int(shown[-1]) + 1 if len(shown) else 1), 0.05)
    canvas = Image.new("RGB", (wide, high), BACKGROUND_COLOR)
    draw = ImageDraw.Draw(canvas)

    def x(time_s: float) -> float:
        return left + (right - left) * time_s / end_s

    def y(level_db: float) -> float:
        return top + (bottom - top) * level_db / _LOWEST_DB

    for level_db in range(0, _LOWEST_DB - 1, -10):
        draw.line(
            [(left, y(level_db)), (right, y(level_db))], fill=_SECONDARY_COLOR, width=_SUPERSAMPLING
        )
        draw.text((left - size // 2, y(level_db)), f"{level_db}", TEXT_COLOR, font(size), "rm")
    tick_s = next(t for t in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0) if end_s / t <= 10)
    for k in range(int(end_s / tick_s) + 1):
        draw.line(
            [(x(k * tick_s), top), (x(k * tick_s), bottom)],
            fill=_SECONDARY_COLOR,
            width=_SUPERSAMPLING,
        )
        draw.text((x(k * tick_s), bottom + size), f"{k * tick_s:g}", TEXT_COLOR, font(size), "mm")
    draw.text(((left + right) / 2, bottom + 2.7 * size), "time, s", TEXT_COLOR, font(size), "mm")
    draw.text((left, top - 0.7 * size), "energy left, dB", TEXT_COLOR, font(size), "ls")
    colors = scale_colors(np.linspace(0.0, 0.9, len(CENTRES_HZ)))
    for band, centre_hz in enumerate(CENTRES_HZ):
        color = (int(colors[band, 0]), int(colors[band, 1]), int(colors[band, 2]))
        inside = np.flatnonzero(decay[:, band] > _LOWEST_DB)
        points = [(x(k * step_s), y(float(decay[k, band]))) for k in inside]
        if len(points) > 1:
            draw.line(points, fill=color, width=2 * _SUPERSAMPLING, joint="curve")
        middle = top + (1 + 1.6 * band) * size
        draw.line(
            [(right + size, middle), (right + 2 * size, middle)],
            fill=color,
            width=3 * _SUPERSAMPLING,
        )
        draw.text((right + 2.4 * size, middle), f"{centre_hz:g} Hz", TEXT_COLOR, font(size), "lm")
    return canvas.resize((wide // _SUPERSAMPLING, high // _SUPERSAMPLING), Image.Resampling.BOX)


def direction_chart(echogram: Echogram, *, width: int = 800) -> Image.Image:
    """From where the energy of all octaves comes: direct, early and late, in dB re all.

    Each panel shows the sphere in cells of equal area: a turn from +X over +Z across, height from
    straight up to straight down.

    Args:
        echogram: What to draw.
        width: Pixels across, 64 to 8192; names are legible from 200 on.

    Raises:
        ConfigError: ``echogram`` is none, or ``width`` out of range.
    """
    echogram, width = instance_of("echogram", echogram, Echogram), _width(width)
    wide = _SUPERSAMPLING * width
    size = wide // 55
    panel = (wide - 8 * size) // 3
    cell = panel // CELL_COLUMNS
    high = cell * CELL_ROWS + 10 * size
    canvas = Image.new("RGB", (wide, high), BACKGROUND_COLOR)
    draw = ImageDraw.Draw(canvas)
    heard = np.flatnonzero(echogram.tail_energy.sum(axis=1))
    first_s = (
        float(echogram.path_s.min())
        if len(echogram.path_s)
        else (float(heard[0]) * echogram.bin_s if len(heard) else 0.0)
    )
    # Paths are known in single precision: the first belongs to the first span.
    first_s -= 1e-6
    spans = [echogram.by_direction(first_s + a, first_s + b) for a, b, _ in _SPANS]
    total = max(float(sum(span.sum() for span in spans)), 1e-300)
    shares_db = [10.0 * np.log10(np.maximum(span / total, 1e-12)) for span in spans]
    high_db = max(float(share.max()) for share in shares_db)
    low_db = high_db - 40.0
    for k, (share_db, (_, _, name)) in enumerate(zip(shares_db, _SPANS, strict=True)):
        left, top = 2 * size + k * (panel + 2 * size), 3 * size
        draw.text((left, top - size), name, TEXT_COLOR, font(size), "ls")
        for row in range(CELL_ROWS):
            for column in range(CELL_COLUMNS):
                part = (float(share_db[row, column]) - low_db) / (high_db - low_db)
                color = scale_colors(np.array(part))
                x, y = left + column * cell, top + (CELL_ROWS - 1 - row) * cell
                fill = (int(color[0]), int(color[1]), int(color[2]))
                draw.rectangle(
                    (x, y, x + cell - _SUPERSAMPLING, y + cell - _SUPERSAMPLING), fill=fill
                )
        for eighth, axis in ((0, "+X"), (2, "+Z"), (4, "-X"), (6, "-Z")):
            place = (left + eighth * cell, top + CELL_ROWS * cell + size)
            draw.text(place, axis, TEXT_COLOR, font(size), "mm")
    y, bar = high - 4 * size, wide - 4 * size
    colors = scale_colors(np.linspace(0.0, 1.0, bar))[None].repeat(size, axis=0)
    canvas.paste(Image.fromarray(colors), (2 * size, y))
    for part, anchor in ((0.0, "ls"), (0.5, "ms"), (1.0, "rs")):
        text = f"{low_db + part * (high_db - low_db):.0f}" + (" dB re all" if part == 1.0 else "")
        draw.text((2 * size + part * bar, y + 2.4 * size), text, TEXT_COLOR, font(size), anchor)
    return canvas.resize((wide // _SUPERSAMPLING, high // _SUPERSAMPLING), Image.Resampling.BOX)
