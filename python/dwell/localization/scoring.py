"""How well directions are found: DCASE's measures, and errors by what makes it hard."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError
from dwell.arguments import choice, quoted
from dwell.localization.assignment import least_cost_pairs
from dwell.localization.baselines import BASELINES, blocks_of, fits
from dwell.localization.clip_facts import (
    OCCLUSIONS,
    ClipFacts,
    array_names,
    class_count,
    clip_facts,
    read_details,
)
from dwell.localization.labels import FRAME_S, Label, angles_deg, direction, read_labels
from dwell.localization.layouts import PRESETS, Layout, layout
from dwell.localization.measures import JointMeasures, angles_between_deg
from dwell.sounds import read_wav

#: What is heard for a frame, s: the frame, and so much before and after it.
_CONTEXT_S = 0.05
#: Edges of the groups in which errors are told.
_EDGES: dict[str, tuple[float, ...]] = {
    "distance_m": (0.0, 1.0, 2.0, 3.0, 5.0, 100.0),
    "t20_s": (0.0, 0.3, 0.5, 0.8, 1.2, 100.0),
    "drr_db": (-100.0, -10.0, -5.0, 0.0, 5.0, 100.0),
    "snr_db": (-100.0, 0.0, 10.0, 20.0, 30.0, 1000.0),
}


@dataclass(frozen=True)
class FrameError:
    """The error of one source in one frame, and what it was like there.

    Attributes:
        angle_deg: Between label and estimate.
        facts: By name: ``distance_m``, ``t20_s``, ``drr_db``, ``snr_db``, ``sources`` and
            ``occlusion``; what is not known is left out.
    """

    angle_deg: float
    facts: dict[str, float | str]


@dataclass(frozen=True)
class Clip:
    """A recording of a data set, with its truth.

    Attributes:
        facts: What is known of it.
        labels: Where sources are.
        sound: Its file.
        name: Its name.
        classes: How many classes the data set has; ``None``: nobody knows.
    """

    facts: ClipFacts
    labels: list[Label]
    sound: Path
    name: str
    classes: int | None = None


def clips_of(folder: Path, array: str, part: str | None = None) -> Iterator[Clip]:
    """The recordings of an array in a data set, in order.

    Raises:
        ConfigError: There is none, or a file is none of a data set; the message names it.
        OSError: The system refuses.
    """
    found, classes = 0, class_count(folder)
    for path in sorted((folder / "details_dev").glob(f"{part or '*'}/*.json")):
        details = read_details(path)
        if array not in array_names(path, details):
            continue
        facts = clip_facts(path, details, array)
        csv = folder / "metadata_dev" / path.parent.name / f"{path.stem}.csv"
        labels = read_labels(csv, classes=classes, sources=len(facts.drr_db))
        found += 1
        yield Clip(facts, labels, folder / facts.file, path.stem, classes)
    if not found:
        raise ConfigError(
            f"{folder}: no recording of {quoted(array)}"
            + (f" in {part}" if part else "")
            + "; expected a folder that dwell localize make wrote"
        )


def array_of(name: str, file: str | None) -> Layout:
    """A recorded array by its name; of one's own from the file it was made with.

    Raises:
        ConfigError: It is not known.
    """
    if file is not None:
        return layout(file)
    if name not in PRESETS:
        raise ConfigError(
            f"array is {quoted(name)}; of an array of one's own give the file that it was made with"
        )
    return PRESETS[name]


def baseline(name: str, array: Layout) -> Callable[[Clip], list[Label]]:
    """What a baseline says of a clip: directions; how many, and of what, it is told by the labels.

    Raises:
        ConfigError: There is no such baseline, or it cannot use the array.
    """
    estimate = BASELINES[choice("baseline", name, tuple(BASELINES))]
    if why := fits(name, array):
        raise ConfigError(f"{array.name}: {why}")

    def said(clip: Clip) -> list[Label]:
        sound, rate_hz = read_wav(clip.sound, full_scale_pa=clip.facts.full_scale_pa)
        if rate_hz not in clip.facts.rates_hz:
            allowed = ", ".join(map(str, clip.facts.rates_hz))
            raise ConfigError(f"{clip.sound}: {rate_hz} samples a second; allowed are {allowed}")
        if sound.shape[0] != array.channels:
            raise ConfigError(
                f"{clip.sound}: {sound.shape[0]} channels; {array.name} has {array.channels}"
            )
        found = []
        frames = int(sound.shape[1] / rate_hz / FRAME_S + 1e-9)
        for frame, rows in _by_frame(clip.labels).items():
            if frame >= frames:
                raise ConfigError(
                    f"{clip.sound}: has {frames} frames of {1000.0 * FRAME_S:g} ms, counted from "
                    f"0; its labels name frame {frame}"
                )
            first = max(0, round((frame * FRAME_S - _CONTEXT_S) * rate_hz))
            last = round(((frame + 1) * FRAME_S + _CONTEXT_S) * rate_hz)
            blocks = blocks_of(sound[:, first:last], rate_hz, array)
            vectors = estimate(blocks, min(len(rows), array.channels - 1))
            found += _named(rows, vectors)
        return found

    return said


def _named(rows: list[Label], vectors: NDArray[np.float64]) -> list[Label]:
    """Directions with the classes of the labels that they are nearest to."""
    angles = angles_between_deg(_directions(rows), vectors)
    found = []
    for row, column in zip(*least_cost_pairs(angles), strict=True):
        label = rows[row]
        azimuth, elevation = angles_deg(vectors[column])
        found.append(Label(label.frame, label.class_index, label.source, azimuth, elevation))
    return found


def estimates_in(folder: Path) -> Callable[[Clip], list[Label]]:
    """What files ``NAME.csv`` in a folder say of clips."""

    def said(clip: Clip) -> list[Label]:
        path = folder / f"{clip.name}.csv"
        if not path.exists():
            raise ConfigError(f"{path}: not there; expected a file for each clip, empty if silent")
        return read_labels(path, classes=clip.classes)

    return said


def score(
    clips: Iterator[Clip],
    said: Callable[[Clip], list[Label]],
    *,
    max_angle_deg: float = 20.0,
    segment_frames: int = 10,
    on_clip: Callable[[int], None] = lambda number: None,
) -> dict[str, Any]:
    """Measures of all clips: DCASE's, and errors of frames in groups.

    Returns:
        ``clips``, ``measures`` (:meth:`JointMeasures.result`), ``angle_deg`` (``frames``, ``mean``,
        ``median``, ``within``: the share up to the bound) and ``by``: the same in groups by
        distance, T20, DRR, SNR, number of sources and occlusion.
    """
    joint = JointMeasures(max_angle_deg=max_angle_deg, segment_frames=segment_frames)
    errors: list[FrameError] = []
    count = 0
    for count, clip in enumerate(clips, start=1):
        found = said(clip)
        joint.add(clip.labels, found)
        errors += _errors(clip, found)
        on_clip(count)
    return {
        "clips": count,
        "measures": joint.result(),
        "angle_deg": _summary(errors, max_angle_deg),
        "by": _groups(errors, max_angle_deg),
    }


def _by_frame(labels: list[Label]) -> dict[int, list[Label]]:
    found: dict[int, list[Label]] = defaultdict(list)
    for row in labels:
        found[row.frame].append(row)
    return dict(sorted(found.items()))


def _directions(labels: list[Label]) -> NDArray[np.float64]:
    return np.array([direction(row.azimuth_deg, row.elevation_deg) for row in labels])


def _errors(clip: Clip, found: list[Label]) -> list[FrameError]:
    """Errors of estimates that have a label of their class in their frame."""
    known = clip.facts
    estimates, errors = _by_frame(found), []
    for frame, rows in _by_frame(clip.labels).items():
        for kind in sorted({row.class_index for row in rows}):
            given = [row for row in rows if row.class_index == kind]
            told = [row for row in estimates.get(frame, []) if row.class_index == kind]
            if not told:
                continue
            angles = angles_between_deg(_directions(given), _directions(told))
            for row, column in zip(*least_cost_pairs(angles), strict=True):
                source = given[row].source
                facts: dict[str, float | str | None] = {
                    "distance_m": given[row].distance_m,
                    "t20_s": known.t20_s,
                    "drr_db": known.drr_db[source],
                    "snr_db": known.snr_db,
                    "sources": float(len(rows)),
                    "occlusion": known.occlusion[source],
                }
                told_of = {name: fact for name, fact in facts.items() if fact is not None}
                errors.append(FrameError(float(angles[row, column]), told_of))
    return errors


def _summary(errors: list[FrameError], max_angle_deg: float) -> dict[str, Any]:
    if not errors:
        return {"frames": 0, "mean": None, "median": None, "within": None}
    angles = np.array([one.angle_deg for one in errors])
    return {
        "frames": len(angles),
        "mean": float(angles.mean()),
        "median": float(np.median(angles)),
        "within": float(np.mean(angles <= max_angle_deg)),
    }


def _groups(errors: list[FrameError], max_angle_deg: float) -> dict[str, list[dict[str, Any]]]:
    found: dict[str, list[dict[str, Any]]] = {}
    for name, edges in _EDGES.items():
        rows = []
        for low, high in itertools.pairwise(edges):
            inside = [
                one
                for one in errors
                if isinstance(fact := one.facts.get(name), float) and low <= fact < high
            ]
            if inside:
                rows.append({"from": low, "to": high, **_summary(inside, max_angle_deg)})
        found[name] = rows
    counts = sorted({fact for one in errors if isinstance(fact := one.facts["sources"], float)})
    found["sources"] = [
        {
            "is": f"{count:g}",
            **_summary([one for one in errors if one.facts["sources"] == count], max_angle_deg),
        }
        for count in counts
    ]
    found["occlusion"] = [
        {"is": kind, **_summary(inside, max_angle_deg)}
        for kind in OCCLUSIONS
        if (inside := [one for one in errors if one.facts.get("occlusion") == kind])
    ]
    return found
