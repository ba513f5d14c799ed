"""``dwell ir --grid``: grids of impulse responses for houses, as SOFA or HDF5."""

from __future__ import annotations

import argparse
import contextlib
import json
import re
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.cli.common import ProgressBar, number, print_json
from dwell.cli.job_journal import claim, is_of_files, refuse_other
from dwell.files import (
    atomic_write,
    check_writable,
    open_exclusive,
    open_file,
    read,
    read_json,
    refuse_link,
    save_array,
)
from dwell.listening import Receiver

#: Format and the suffix of its files.
_FORMATS = {"sofa": ".sofa", "hdf5": ".h5"}
# Receivers whose responses are held at once.
_AT_ONCE = 64
_JOB = "job.json"


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "--grid",
        type=number,
        metavar="M",
        help="microphones wherever someone can stand, so far apart; HOUSE may be seed:A..B, "
        "and a stopped run goes on where it stopped",
    )
    parser.add_argument("--format", choices=tuple(_FORMATS), default="sofa", help="of a grid")
    parser.add_argument(
        "--source-height", type=number, default=1.5, metavar="M", help="of a grid (default 1.5)"
    )


def run(args: argparse.Namespace) -> int:
    """Computes all responses of all houses and writes a file for each.

    Returns:
        1 when a house could not be done; a sentence says why.
    """
    from dwell import DwellError
    from dwell.house import House
    from dwell.responses.dataset import hdf5_module

    hdf5 = hdf5_module(args.format.upper())
    if args.out is None:
        raise ValueError("--out is needed: the folder for the files")
    houses = House.expand(args.house)
    files = {house: args.out / (_slug(house) + _FORMATS[args.format]) for house in houses}
    if not 0.1 <= args.grid <= 10.0:
        raise ValueError(f"--grid is {args.grid:g}; allowed is 0.1 to 10 m")
    if len(set(files.values())) < len(files):
        raise ValueError("two houses would have one file; compute them into two folders")
    job = _job(args)
    dataset = {"command": "ir --grid", "format": args.format, **job}
    refuse_other(args.out, dataset)
    made, failed, started = 0, [], time.perf_counter()
    for house, file in files.items():
        try:
            if file.exists() and _is_whole(file, hdf5) and _is_of(file, house, hdf5):
                continue
            made += _house(args, house, file, job, dataset)
        except DwellError as error:
            failed.append((house, str(error)))
    took = time.perf_counter() - started
    summary = {
        "houses": len(houses) - len(failed),
        "failed": len(failed),
        "responses_made_now": made,
        "responses_per_s": round(made / took, 2) if made else None,
        "files": [str(file) for file in files.values() if file.exists()],
    }
    if args.json:
        print_json(summary)
    else:
        print(f"{summary['houses']} houses, {made} responses made now in {took:.0f} s; {args.out}")
    for house, why in failed:
        print(f"dwell ir: {house}: {why}", file=sys.stderr)
    return 1 if failed else 0


@contextlib.contextmanager
def _alone(out: Path) -> Iterator[None]:
    """Keeps other processes from the parts of a file.

    Raises:
        ValueError: Another process writes it.
    """
    path = out.with_name(f".{out.name}.lock")
    with open_exclusive(path):
        try:
            yield
        finally:
            path.unlink(missing_ok=True)


def _job(args: argparse.Namespace) -> dict[str, Any]:
    """The settings on which the responses depend, beside the house."""
    sources = args.sources or "1"
    if args.source is not None and args.sources is not None:
        raise ValueError("--source is one place and --sources how many are drawn; give one of them")
    if args.source is None and not re.fullmatch(r"[1-9][0-9]{0,3}|10000", sources):
        raise ValueError(f"--sources is {sources!r}; of a grid it is how many, 1 to 10000")
    head = {} if args.head is None else {"head": args.head.id}
    return {
        **head,
        "grid_m": args.grid,
        "height_m": args.height,
        "sources": list(args.source) if args.source else int(sources),
        "source_height_m": args.source_height,
        "ears": args.ears,
        "yaw_deg": args.yaw_deg,
        "rate_hz": args.rate_hz,
        "rays": args.rays,
        "image_order": args.image_order,
        "seed": args.seed,
        "laws": read_json(args.laws) if args.laws else [],
    }


def _house(
    args: argparse.Namespace, name: str, out: Path, job: dict[str, Any], dataset: dict[str, Any]
) -> int:
    """Computes what is missing of one house, writes its file; returns how many responses."""
    from dwell import __version__
    from dwell.acoustics import AcousticScene
    from dwell.places import random_sources, receiver_grid
    from dwell.responses import Dataset, write_hdf5, write_sofa

    scene = AcousticScene(
        name, laws=args.laws, rate_hz=args.rate_hz, rays=args.rays, image_order=args.image_order
    )
    receivers = receiver_grid(scene.house, args.grid, args.height)
    if args.source:
        sources = np.array([args.source], np.float64)
    else:
        sources = random_sources(scene.house, job["sources"], args.source_height, args.seed)
    fingerprint = str(scene.house.info()["fingerprint"])
    parts = out.with_name(f".{out.name}.parts")
    check_writable(out)
    refuse_link(parts)
    # What cannot be was refused by now.
    claim(args.out, dataset)
    with _alone(out):
        _begin(parts, {**job, "house": name, "fingerprint": fingerprint, "dwell": __version__})
        made, bar = 0, ProgressBar()
        for k, source in enumerate(sources):
            part = parts / f"{k}.npy"
            if part.exists():
                continue

            def told(fraction: float, k: int = k) -> None:
                bar((k + fraction) / len(sources), f"{name}: source {k + 1} of {len(sources)}")

            found = _source(scene, source, receivers, args, told)
            # What is there is whole: a file gets its name when it is written.
            with atomic_write(part) as path:
                save_array(path, found)
            made += len(receivers)
        radius = None if args.head is None else args.head.summary
        data = Dataset(
            house=name,
            fingerprint=fingerprint,
            rate_hz=scene.rate_hz,
            sources=sources,
            receivers=receivers,
            yaw_deg=args.yaw_deg,
            parts=[parts / f"{k}.npy" for k in range(len(sources))],
            head_radius_m=float(radius["radius_m"] if radius else scene.config["head_radius_m"]),
            corners=np.array(scene.material_report()["bounds_m"], np.float64),
            air=scene.config["air"],
            settings=job,
            version=__version__,
            created=time.strftime("%Y-%m-%d %H:%M:%S", time.gmtime()),
        )
        write = write_sofa if args.format == "sofa" else write_hdf5
        with atomic_write(out) as path:
            write(path, data)
        shutil.rmtree(parts)
        return made


def _is_whole(file: Path, hdf5: Any) -> bool:  # noqa: ANN401 - the module h5py
    """Whether a finished file has all the bytes that it says it has; else it is made again.

    Raises:
        OSError: The system refuses, or it is no regular file.
    """
    open_file(file).close()
    try:
        hdf5.File(file, "r").close()
    except OSError:
        return False
    return True


def _is_of(file: Path, house: str, hdf5: Any) -> bool:  # noqa: ANN401 - the module h5py
    """Whether a finished file is of the house as it is now; else it is made again."""
    from dwell.house import House

    if not is_of_files(house):
        return True
    with hdf5.File(file, "r") as found:
        said = found.attrs.get("house_fingerprint", found.attrs.get("Origin"))
    if said is None:
        return True
    told = said.decode(errors="replace") if isinstance(said, bytes) else str(said)
    return told.endswith(str(House.open(house).info()["fingerprint"]))


def _begin(parts: Path, job: dict[str, Any]) -> None:
    """Keeps the parts of an interrupted run of the same job; those of another are deleted."""
    text = json.dumps(job, indent=2, sort_keys=True) + "\n"
    path = parts / _JOB
    if path.exists() and read(path) == text.encode():
        return
    shutil.rmtree(parts, ignore_errors=True)
    with atomic_write(path) as draft:
        draft.write_text(text, "utf-8")


def _source(
    scene: Any,  # noqa: ANN401 - an AcousticScene, imported late
    source: NDArray[np.float64],
    receivers: NDArray[np.float64],
    args: argparse.Namespace,
    told: Callable[[float], None],
) -> NDArray[np.float32]:
    """The responses from one source, shape (receiver, channel, sample)."""
    listeners = [
        Receiver.binaural(place, yaw_deg=args.yaw_deg, head=args.head)
        if args.ears
        else Receiver.omni(place)
        for place in receivers
    ]
    found: list[NDArray[np.float32]] = []
    for first in range(0, len(listeners), _AT_ONCE):
        some = listeners[first : first + _AT_ONCE]
        found += scene.impulse_responses(source, some, seed=args.seed, threads=args.threads)
        told(len(found) / len(listeners))
    longest = max(response.shape[1] for response in found)
    channels = 2 if args.ears else 1
    rows = np.zeros((len(found), channels, longest), np.float32)
    for row, response in zip(rows, found, strict=True):
        row[:, : response.shape[1]] = response
    return rows


def _slug(house: str) -> str:
    """A HOUSE string as the name of a file."""
    return re.sub(r"[^A-Za-z0-9.]+", "-", house).strip("-.")[-100:] or "house"
