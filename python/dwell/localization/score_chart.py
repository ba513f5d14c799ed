"""A picture of errors: how far directions are off, by distance, reverberation, noise and so on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PIL import Image, ImageDraw

from dwell.charts import BACKGROUND_COLOR, TEXT_COLOR, font

#: Panels, and what their values are called.
_PANELS = {
    "distance_m": "distance, m",
    "t20_s": "reverberation time T20, s",
    "drr_db": "direct to reverberant, dB",
    "snr_db": "signal to noise, dB",
    "sources": "sources at once",
    "occlusion": "between source and array",
}
_COLORS = ((0, 121, 107), (198, 93, 20), (82, 82, 168), (150, 46, 88), (92, 120, 24))
_LINE_COLOR = (215, 214, 208)
#: A panel's edges, and the height of the text above all, pixels.
_WIDE, _HIGH, _TOP = 420, 250, 44
#: Ends of scales that have none.
_OPEN = 100.0


def score_chart(reports: Mapping[str, Mapping[str, Any]]) -> Image.Image:
    """The median error in each group, degrees, for one or several estimators by name."""
    canvas = Image.new("RGB", (2 * _WIDE, _TOP + 3 * _HIGH), BACKGROUND_COLOR)
    draw = ImageDraw.Draw(canvas)
    at = 16
    for k, name in enumerate(reports):
        color = _COLORS[k % len(_COLORS)]
        draw.rectangle((at, 18, at + 12, 30), fill=color)
        draw.text((at + 18, 24), name, TEXT_COLOR, font(14), "lm")
        at += 40 + int(draw.textlength(name, font(14)))
    draw.text((2 * _WIDE - 16, 24), "median error, degrees", TEXT_COLOR, font(14), "rm")
    medians = [
        row["median"]
        for report in reports.values()
        for rows in report["by"].values()
        for row in rows
    ]
    top = max(10.0, 10.0 * -(-max(medians, default=10.0) // 10.0))
    for number, (key, title) in enumerate(_PANELS.items()):
        corner = (number % 2 * _WIDE, _TOP + number // 2 * _HIGH)
        _panel(draw, corner, title, {name: one["by"][key] for name, one in reports.items()}, top)
    return canvas


def _panel(
    draw: ImageDraw.ImageDraw,
    corner: tuple[int, int],
    title: str,
    rows: Mapping[str, list[dict[str, Any]]],
    top: float,
) -> None:
    left, upper = corner[0] + 50, corner[1] + 26
    right, lower = corner[0] + _WIDE - 16, corner[1] + _HIGH - 34
    draw.text((left, upper - 12), title, TEXT_COLOR, font(14), "lm")
    for step in range(5):
        y = lower - (lower - upper) * step / 4
        draw.line([(left, y), (right, y)], fill=_LINE_COLOR)
        draw.text((left - 6, y), f"{top * step / 4:g}", TEXT_COLOR, font(12), "rm")
    groups = list(dict.fromkeys(_name(row) for found in rows.values() for row in found))
    if not groups:
        return
    wide = (right - left) / len(groups)
    bar = 0.7 * wide / max(len(rows), 1)
    for k, found in enumerate(rows.values()):
        for row in found:
            x = left + wide * (groups.index(_name(row)) + 0.15) + k * bar
            y = lower - (lower - upper) * min(row["median"] / top, 1.0)
            draw.rectangle((x, y, x + bar - 2, lower), fill=_COLORS[k % len(_COLORS)])
    for k, name in enumerate(groups):
        draw.text((left + wide * (k + 0.5), lower + 12), name, TEXT_COLOR, font(12), "mm")


def _name(row: dict[str, Any]) -> str:
    """What a group is called below its bar."""
    if "is" in row:
        return str(row["is"])
    low, high = row["from"], row["to"]
    if abs(low) >= _OPEN:
        return f"< {high:g}"
    return f"{low:g} +" if high >= _OPEN else f"{low:g} to {high:g}"
