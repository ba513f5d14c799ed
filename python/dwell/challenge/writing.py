"""Bundles of cases without a trace of what is hidden, and their answers."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from dwell.challenge.cases import WORLDS, Case, ChallengeSettings, case
from dwell.files import atomic_folder, make_folder

__all__ = ["bundle_of", "make"]

#: The time that all files of bundles have, s since 1970: 2026-01-01.
_FILE_TIME_S = 1_767_225_600


def make(
    out: Path, settings: ChallengeSettings, shard: tuple[int, int] = (0, 1)
) -> Iterator[tuple[Case, Path, bool]]:
    """Writes bundles that are missing, each whole or not at all.

    Args:
        out: The folder of bundles.
        settings: Which cases.
        shard: Which of how many parts, from 0.

    Yields:
        Each case, the folder of its bundle, and whether that was written now.
    """
    which, shards = shard
    make_folder(out)
    for number in range(which, settings.cases, shards):
        one = case(number, settings)
        folder = bundle_of(out, one.name)
        is_new = not folder.exists()
        if is_new:
            with atomic_folder(folder) as draft:
                _write(draft, one, settings.seed)
            os.utime(folder, (_FILE_TIME_S, _FILE_TIME_S))
        yield one, folder, is_new


def bundle_of(out: Path, name: str) -> Path:
    """The folder of a case's bundle."""
    return out / f"{name}.measured"


def _write(folder: Path, one: Case, seed: int) -> None:
    # Apart from what draws the case, so that noise doesn't depend on what is hidden.
    rng = np.random.default_rng([seed, one.number, 1])
    world = WORLDS[one.world]
    clean = world.observe(one.known, world.nuisances(one.known), one.values)
    further = world.further(one.known, rng)
    places = clean.shape[2]
    count = len(clean)
    names = [f"{int(value):08x}" for value in rng.integers(1 << 32, size=count)]
    # Two or three in a row are held out together.
    sessions = [f"{int(value):06x}" for value in rng.integers(1 << 24, size=count // 2 + 1)]
    begins = rng.uniform(1.0, 60.0, count)
    told = world.commands(one.known)
    episodes, trajectory, commands = [], [], []
    for k in rng.permutation(count):
        samples = int(one.known.samples[k])
        seen = one.noise.add(rng, clean[k, :samples])
        rows = np.column_stack([seen, further[k, :samples]])
        episodes.append(f"{names[k]},{sessions[k // 2]},\n")
        for sample, row in enumerate(rows):
            if np.isnan(row[0]):
                continue
            t_s = begins[k] + sample / one.known.rate_hz
            for channel, value in zip(world.channels, row, strict=True):
                digits = 7 if channel in world.channels[:places] else 4
                trajectory.append(
                    f"{names[k]},{t_s:.6f},{world.entity},{channel},{value:.{digits}f}\n"
                )
        if told is not None:
            for step, value in enumerate(told[1][k]):
                t_s = begins[k] + step / told[0]
                commands.append(f"{names[k]},{t_s:.6f},{world.entity},position,{value:.7f}\n")
    noise_sd = one.noise.sd if one.noise_is_known else None
    manifest = world.manifest(one.known, noise_sd)
    files = {
        "manifest.json": json.dumps(manifest, indent=1),
        "episodes.csv": "episode,split_group,conditions\n" + "".join(episodes),
        "trajectory.csv": "episode,t_s,entity,channel,value\n" + "".join(trajectory),
    }
    if told is not None:
        files["command.csv"] = "episode,t_s,actuator,kind,value\n" + "".join(commands)
    for name, text in files.items():
        path = folder / name
        path.write_text(text, "utf-8")
        os.utime(path, (_FILE_TIME_S, _FILE_TIME_S))
