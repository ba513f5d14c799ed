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


def level_plot(
    levels_db: Sequence[Sequence[float]],
    step_s: float,
    marks: Sequence[tuple[float, str]],
) -> str:
    """The levels at both ears over time, with marked moments.

    Args:
        levels_db: Of each step the levels at the left and the right ear, dB SPL.
        step_s: How long a step is.
        marks: Times in s, with words.
    """
    if not levels_db:
        return ""
    end_s = len(levels_db) * step_s
    low, high = 0.0, 10.0 * (max(map(max, levels_db)) // 10.0 + 1.0)

    def x(time_s: float) -> float:
        return 50 + 890 * time_s / end_s

    def y(level_db: float) -> float:
        return 180 - 150 * (level_db - low) / (high - low)

    lines = []
    for ear, css in enumerate(("before", "after")):
        points = " ".join(
            f"{x((k + 0.5) * step_s):.1f},{y(row[ear]):.1f}" for k, row in enumerate(levels_db)
        )
        lines.append(f'<polyline class="{css} line" points="{points}"/>')
    for k, (time_s, words) in enumerate(marks):
        top = 14 + 14 * (k % 2)
        lines.append(
            f'<line class="axis" x1="{x(time_s):.1f}" y1="{top}" x2="{x(time_s):.1f}" y2="180"/>'
            f'<text x="{x(time_s) + 4:.1f}" y="{top + 8}">{escape(words)}</text>'
        )
    seconds = [float(k) for k in range(int(end_s) + 1)]
    ticks = "".join(
        f'<text x="{x(k):.1f}" y="196" text-anchor="middle">{k:g} s</text>' for k in seconds
    )
    return (
        '<svg viewBox="0 0 960 200" role="img" aria-label="levels at both ears over time">'
        f'<line class="axis" x1="50" y1="180" x2="940" y2="180"/>{"".join(lines)}{ticks}'
        f'<text x="4" y="34">{high:g} dB</text><text x="4" y="184">{low:g} dB</text></svg>'
    )
