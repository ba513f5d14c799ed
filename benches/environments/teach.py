"""What tells apart whether a user points, shows or speaks: words, sound, sight.

    dwell record teach out/teach --users 10 --clips 30 --fps 5 --width 128    # some twenty minutes
    python benches/environments/teach.py out/teach --out out/teach-figures

Classifiers are trained on all users but one and asked about that one, for each user in turn. The
first word is judged by its counts (naive Bayes), all words likewise; sound and sight by a ridge
regression on few numbers: levels of sound in bands and its length, and which parts of the picture
of the Kinect ahead came nearer or went away since the first one. No label but the type is used.
Printed are shares of right answers with the 95 % interval of chance (binomial), the confusions, and
what must hold of the recording: rays, phrases, occlusion. ``--out`` gets a sheet of pictures.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dwell.teach import RecordedClip, recorded_clips
from dwell.teach.plan import CLIP_TYPES

Array = NDArray[np.float64]
#: Weight of the ridge, on features of unit variance.
RIDGE = 30.0
#: Bands of rows of the picture, and moments of the clip, as parts of its length.
BANDS, MOMENTS = 8, (0.35, 0.6, 1.0)
#: What counts as another depth, m: more than a Kinect's noise.
CHANGE_M = 0.04
#: Edges of bands of sound, Hz.
BANDS_HZ = (100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0, 6400.0)


def naive_bayes(rows: list[list[str]], types: list[str], users: list[int]) -> list[str]:
    """The type that counts of words tell, for each clip, by the clips of other users."""
    said = []
    for words, user in zip(rows, users, strict=True):
        known = [k for k, other in enumerate(users) if other != user]
        best = {}
        for kind in sorted(set(types)):
            counts = Counter(word for k in known if types[k] == kind for word in rows[k])
            prior = sum(types[k] == kind for k in known)
            total = sum(counts.values()) + len(counts) + 1
            chance = sum(math.log((counts[word] + 1) / total) for word in words)
            best[kind] = math.log(prior) + chance
        said.append(max(best, key=lambda kind: best[kind]))
    return said


def ridge(features: Array, types: list[str], users: list[int]) -> list[str]:
    """The type that a ridge regression tells, for each clip, by the clips of other users."""
    kinds = sorted(set(types))
    target = np.array([[1.0 if kind == one else -1.0 for kind in kinds] for one in types])
    said = [""] * len(types)
    for user in sorted(set(users)):
        held = np.array([other == user for other in users])
        mean, spread = features[~held].mean(0), features[~held].std(0) + 1e-9
        known, asked = ((features[which] - mean) / spread for which in (~held, held))
        known = np.c_[known, np.ones(len(known))]
        gram = known.T @ known + RIDGE * np.eye(known.shape[1])
        weights = np.linalg.solve(gram, known.T @ target[~held])
        scores = np.c_[asked, np.ones(len(asked))] @ weights
        for k, row in zip(np.nonzero(held)[0], scores, strict=True):
            said[k] = kinds[int(row.argmax())]
    return said


def sound_features(clip: RecordedClip) -> Array:
    """Level in bands at each ear, its spread over time, and the length of the clip."""
    sound, rate_hz = clip.sound()
    block = rate_hz // 10
    blocks = sound[:, : sound.shape[1] // block * block].reshape(2, -1, block)
    power = np.abs(np.fft.rfft(blocks * np.hanning(block), axis=2)) ** 2
    at_hz = np.fft.rfftfreq(block, 1.0 / rate_hz)
    rows = []
    for low, high in itertools.pairwise(BANDS_HZ):
        level = 10.0 * np.log10(power[:, :, (at_hz >= low) & (at_hz < high)].sum(2) + 1e-9)
        rows += [level.mean(1), level.std(1), level.max(1)]
    return np.array([*np.concatenate(rows), sound.shape[1] / rate_hz])


def sight_features(clip: RecordedClip) -> Array:
    """In bands of rows and at moments, the share of pixels that came nearer and that went away."""
    depth = clip.pictures("kinect_front", "depth").astype(float) / 1000.0
    last, rows = len(depth) - 1, depth.shape[1] // BANDS * BANDS
    found = []
    for part in MOMENTS:
        change = (depth[round(part * last)] - depth[0])[:rows].reshape(BANDS, -1)
        found += [(change < -CHANGE_M).mean(1), (change > CHANGE_M).mean(1)]
    return np.concatenate(found)


def share(said: list[str], types: list[str]) -> dict[str, float]:
    """The share of right answers, and the interval of guessing by the most frequent type."""
    n, chance = len(types), max(Counter(types).values()) / len(types)
    half = 1.96 * math.sqrt(chance * (1.0 - chance) / n)
    right = sum(a == b for a, b in zip(said, types, strict=True)) / n
    return {
        "right": right,
        "chance_low": chance - half,
        "chance_high": chance + half,
        "clips": n,
    }


def confusion(said: list[str], types: list[str]) -> dict[str, dict[str, int]]:
    """Clips by what they are and what they were said to be."""
    pairs = Counter(zip(types, said, strict=True))
    return {kind: {other: pairs[kind, other] for other in CLIP_TYPES} for kind in CLIP_TYPES}


def figures(clips: list[RecordedClip]) -> dict[str, Any]:
    """All figures of a recording."""
    types = [clip.label["type"] for clip in clips]
    users = [clip.label["user"]["number"] for clip in clips]
    words = [clip.label["speech"]["phrase"].lower().strip(".").split() for clip in clips]
    first = [row[:1] for row in words]
    sound = np.stack([sound_features(clip) for clip in clips])
    sight = np.stack([sight_features(clip) for clip in clips])
    speaks = ["speak" if kind == "speak" else "other" for kind in types]
    # Whether the first word is one of those with which users show something, beside what is seen.
    told = np.array([[float(row[0] == "the")] for row in first])
    pair = [k for k, kind in enumerate(types) if kind != "speak"]

    def of_pair(rows: list[Any]) -> list[Any]:
        return [rows[k] for k in pair]

    both = (of_pair(types), of_pair(users))
    all_three = {
        "first word": naive_bayes(first, types, users),
        "all words": naive_bayes(words, types, users),
        "sound": ridge(sound, types, users),
        "sight": ridge(sight, types, users),
        "sight and first word": ridge(np.c_[sight, told * 3.0], types, users),
    }
    return {
        "speak or not": {
            "first word": share(naive_bayes(first, speaks, users), speaks),
        },
        "point or show": {
            "first word": share(naive_bayes(of_pair(first), *both), both[0]),
            "all words": share(naive_bayes(of_pair(words), *both), both[0]),
            "sound": share(ridge(sound[pair], *both), both[0]),
            "sight": share(ridge(sight[pair], *both), both[0]),
        },
        "all three": {name: share(said, types) for name, said in all_three.items()},
        "confusion": {name: confusion(said, types) for name, said in all_three.items()},
        "recording": recording(clips),
    }


def recording(clips: list[RecordedClip]) -> dict[str, Any]:
    """What holds of the recording."""
    rays = [clip.label["ray"] for clip in clips if clip.label["ray"] is not None]
    labels = [clip.label for clip in clips]
    hidden = [
        view["occlusion"]
        for label in labels
        for key in label["key_frames"]
        if key["name"] == "apex"
        for camera, view in key["views"].items()
        if camera == "kinect_front" and view["occlusion"] is not None
    ]
    one = sum(label["speech"]["reads_to"] == [label["target"]["name"]] for label in labels)
    return {
        "clips": len(labels),
        "users": len({label["user"]["number"] for label in labels}),
        "first words": Counter(label["speech"]["first_word"] for label in labels).most_common(),
        "phrases that read to the target alone": one,
        "rays": len(rays),
        "rays that meet the target first": sum(ray["first_hit"]["is_target"] for ray in rays),
        "pointing noise, degrees": sorted({ray["noise_deg"] for ray in rays}),
        "targets that the front Kinect sees at the apex": len(hidden),
        "mean part of them that is hidden": float(np.mean(hidden)),
        "tables laid for a clip": float(np.mean([row["clip"]["tables_laid"] for row in labels])),
    }


def sheet(clips: list[RecordedClip]) -> Image.Image:
    """A row for each type: the key frames of one clip from ahead, and the last from above."""
    rows = []
    for kind in CLIP_TYPES:
        clip = next(clip for clip in clips if clip.label["type"] == kind)
        front, top = clip.pictures("kinect_front"), clip.pictures("kinect_top")
        keys = [key["frame"] for key in clip.label["key_frames"]]
        row = np.hstack([*(front[k] for k in keys), top[keys[2]]])
        picture = Image.new("RGB", (row.shape[1], row.shape[0] + 16), "white")
        picture.paste(Image.fromarray(row), (0, 16))
        phrase = clip.label["speech"]["phrase"]
        ImageDraw.Draw(picture).text((3, 2), f'{kind}: "{phrase}"', fill="black")
        rows.append(np.asarray(picture))
    width = max(row.shape[1] for row in rows)
    padded = [np.pad(r, ((0, 0), (0, width - r.shape[1]), (0, 0))) for r in rows]
    return Image.fromarray(np.vstack(padded))


def main() -> None:
    """Prints the figures, and writes the pictures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="a recording that is whole")
    parser.add_argument("--out", type=Path, help="a folder for pictures and figures.json")
    args = parser.parse_args()
    clips = list(recorded_clips(args.folder))
    found = figures(clips)
    for question in ("speak or not", "point or show", "all three"):
        for name, row in found[question].items():
            print(
                f"{question:14} {name:22} {row['right']:.3f}   chance "
                f"{row['chance_low']:.2f} to {row['chance_high']:.2f}, {row['clips']} clips"
            )
    for name, table in found["confusion"].items():
        print(name, json.dumps(table))
    print(json.dumps(found["recording"], indent=1))
    if args.out is not None:
        args.out.mkdir(parents=True, exist_ok=True)
        (args.out / "figures.json").write_text(json.dumps(found, indent=1) + "\n", "utf-8")
        sheet(clips).save(args.out / "clips.png")


if __name__ == "__main__":
    main()
