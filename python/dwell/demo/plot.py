"""A small line plot as SVG."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape


def line_plot(
    title: str, unit: str, before: Sequence[Sequence[float]], after: Sequence[Sequence[float]]
) -> str:
    """Two rows of (x, y) points, before in the warning colour and after in the accent colour."""
    points = [*before, *after]
    if not points:
        return ""
    xs, ys = [point[0] for point in points], [point[1] for point in points]
    low, high = min([*ys, 0.0]), max([*ys, 0.0])
    left, right = min(xs), max(xs)

    def place(point: Sequence[float]) -> str:
        x = 50 + 420 * (point[0] - left) / max(right - left, 1e-12)
        y = 150 - 130 * (point[1] - low) / max(high - low, 1e-12)
        return f"{x:.1f},{y:.1f}"

    def dots(row: Sequence[Sequence[float]], css: str) -> str:
        marks = (place(point).split(",") for point in row)
        return "".join(f'<circle class="{css}" cx="{x}" cy="{y}" r="2"/>' for x, y in marks)

    zero = place([left, 0.0]).split(",")[1]
    return (
        f'<svg viewBox="0 0 480 180" role="img" aria-label="{escape(title)}">'
        f'<line class="axis" x1="50" y1="{zero}" x2="470" y2="{zero}"/>'
        f"{dots(before, 'before')}{dots(after, 'after')}"
        f'<text x="50" y="12">{escape(title)}</text>'
        f'<text x="4" y="26">{high:.3g}</text><text x="4" y="150">{low:.3g}</text>'
        f'<text x="4" y="88">{escape(unit)}</text></svg>'
    )
