"""``dwell generate``: houses in bulk."""

from __future__ import annotations

import argparse
import contextlib
import itertools
import json
import re
import sys
import time
import zlib
from collections import Counter, deque
from collections.abc import Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from dwell import _native
from dwell.arguments import integer_in_range, text
from dwell.cli.common import ProgressBar, count, count_from_1, path, print_json, shard, workers
from dwell.cli.job_journal import Journal, claim
from dwell.files import MAX_TEXT_BYTES, lines, open_file, parse_json, read, read_json
from dwell.result_version import VERSION, refuse_other_version
from dwell.workers import thread_count, thread_pool

_FORMS = ("dwell", "suncg", "glb")
#: Letters of the files of a room of SUNCG, and what says that there is none.
_ROOM_PARTS = (("c", "hideCeiling"), ("f", "hideFloor"), ("w", "hideWalls"))
#: How whole files that houses show end; a file that was cut does not.
_ENDS = {".png": b"IEND\xae\x42\x60\x82", ".obj": b"\n", ".mtl": b"\n", ".json": b"}"}
#: Houses that failed and are told of on standard error.
_MAX_LISTED_FAILURES = 10


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument("--seed", type=count, default=0, help="the first seed (default 0)")
    parser.add_argument("--count", type=count_from_1, required=True, help="how many houses")
    parser.add_argument("--out", type=path, required=True, metavar="DIR")
    parser.add_argument("--format", choices=_FORMS, default="dwell")
    parser.add_argument(
        "--split",
        choices=("train", "val", "test", "all"),
        default="all",
        help="only seeds of this split: of ten, the ninth is val, the tenth test; each has the "
        "looks of its own split",
    )
    parser.add_argument(
        "--spec",
        action="append",
        default=[],
        metavar="FIELD=VALUE",
        help="what shall not be drawn, as in seed:N?FIELD=VALUE; several times",
    )
    parser.add_argument(
        "--shard", type=shard, default=(0, 1), metavar="K/N", help="the K-th of N parts, from 0"
    )
    parser.add_argument(
        "--workers", type=workers, help="threads, at most 1024 (default: one a processor)"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Makes and writes the houses; a run that was stopped goes on where it stopped.

    Returns:
        1 when a house could not be made; its row in the manifest says why.
    """
    dataset = {
        "command": "generate",
        "seed": args.seed,
        "count": args.count,
        "format": args.format,
        "split": args.split,
        "spec": [_field(field) for field in args.spec],
    }
    # Before the folder is begun with them.
    _native.seed_range(f"seed:0..1?{'&'.join(args.spec)}")
    claim(args.out, dataset)
    which, shards = args.shard
    name = "manifest" if shards == 1 else f"manifest-{which:05}-of-{shards:05}"
    manifest = args.out / f"{name}.jsonl"
    start, made = time.perf_counter(), 0
    if not manifest.exists():
        # Another process of this job may have ended it since.
        with contextlib.suppress(FileExistsError):
            made = _make(args, manifest, {**dataset, "shard": [which, shards]})
    made += _regenerate_missing(args, manifest)
    seconds = time.perf_counter() - start
    rows, failed, told = 0, 0, []
    for row in _rows(manifest):
        rows += 1
        if "error" in row:
            failed += 1
            if failed <= _MAX_LISTED_FAILURES:
                told.append(f"{row.get('house')}: {row['error']}")
    summary = {
        "houses": rows - failed,
        "failed": failed,
        "made_now": made,
        "houses_per_s": made / seconds if made else None,
        "manifest": str(manifest),
    }
    if args.json:
        print_json(summary)
    else:
        rate = f", {summary['houses_per_s']:.1f} a second" if made else ""
        print(f"{summary['houses']} houses ({made} made now{rate}); {manifest}")
    for sentence in told:
        print(f"dwell generate: {sentence}", file=sys.stderr)
    return 1 if failed else 0


def _make(args: argparse.Namespace, manifest: Path, job: dict[str, Any]) -> int:
    """Makes what is not there yet; returns how many."""
    from dwell.house import House

    journal = Journal(manifest, job)
    first, step = args.shard
    all_seeds = len(range(first, args.count, step))
    # Seeds are many, and drawn one by one.
    left = (seed for seed in _job_seeds(args) if str(seed) not in journal.done)
    made = 0
    threads = thread_count(args.workers, all_seeds - len(journal.done))
    bar = ProgressBar()
    # A few houses ahead, in order: the manifest is the same for any number of workers.
    ahead: deque[tuple[int, Future[dict[str, Any]]]] = deque()
    is_added = True
    try:
        with thread_pool(threads) as pool:
            while True:
                for seed in itertools.islice(left, 2 * threads - len(ahead)):
                    ahead.append((seed, pool.submit(_house, args, seed)))
                if not ahead:
                    break
                seed, future = ahead[0]
                row = future.result()
                is_added = False
                ahead.popleft()
                journal.add(str(seed), [row])
                is_added = True
                made += "error" not in row
                bar(len(journal.done) / all_seeds, f"seed {seed}")
        House.finish_folder(args.out, args.format)
        journal.finish(order=lambda lines: _in_order(args, lines))
    except BaseException:
        # Those that stand in the folder by now.
        for seed, future in ahead if is_added else ():
            if future.done() and not future.cancelled() and future.exception() is None:
                journal.add(str(seed), [future.result()])
        journal.close()
        kept = f"{len(journal.done)} of {all_seeds} are kept; run again"
        print(f"dwell generate: {kept}", file=sys.stderr)
        raise
    return made


def _in_order(args: argparse.Namespace, lines: Iterator[bytes]) -> Iterator[bytes]:
    """The rows of all seeds of the job, ascending: after a stop some were written early."""
    early: dict[int, bytes] = {}
    for seed in _job_seeds(args):
        while seed not in early:
            line = next(lines)
            early[json.loads(line)["seed"]] = line
        yield early.pop(seed)


def _job_seeds(args: argparse.Namespace) -> Iterator[int]:
    """The seeds of the shard, ascending."""
    first, step = args.shard
    return itertools.islice(_seeds(args.seed, args.split), first, args.count, step)


def _job_rows(args: argparse.Namespace, manifest: Path) -> Iterator[dict[str, Any]]:
    """The rows of a finished manifest, one for each seed of the job.

    Raises:
        ValueError: As of :func:`_rows`; a seed is missing, or is none of the job.
    """
    for row, seed in itertools.zip_longest(_rows(manifest), _job_seeds(args)):
        found = None if row is None else row["seed"]
        if row is None or found != seed:
            what = "is at its end" if found is None else f"has seed {found}"
            expected = "no more" if seed is None else f"seed {seed}"
            raise ValueError(
                f"{manifest}: {what} where this job has {expected}; put its lines back, or remove "
                f"{manifest} and run again"
            )
        yield row


def _regenerate_missing(args: argparse.Namespace, manifest: Path) -> int:
    """Makes the houses of the manifest that are not there as they were written; returns how many.

    Raises:
        ValueError: One is another house now than the manifest says.
    """
    from dwell.house import House

    models: set[Path] = set()
    missing = (
        row
        for row in _job_rows(args, manifest)
        if "error" not in row and not _is_there(args, row, models)
    )
    made = 0
    with thread_pool(thread_count(args.workers, args.count)) as pool:
        while some := list(itertools.islice(missing, 64)):
            for row, new in zip(
                some, pool.map(lambda row: _regenerate_house(args, row), some), strict=True
            ):
                # Older manifests have fewer fields; the check of those of this one is another.
                old = {key: row[key] for key in row if key != "check"}
                if {key: new[key] for key in new if key in old} != old:
                    raise ValueError(
                        f"{manifest}: {row.get('path')} was missing or changed, and seed "
                        f"{row.get('seed')} gives another house now than the manifest says; remove "
                        f"{args.out} and make all anew, or use the version that made it"
                    )
                made += 1
    if made:
        House.finish_folder(args.out, args.format)
    return made


def _regenerate_house(args: argparse.Namespace, row: dict[str, Any]) -> dict[str, Any]:
    return _house(args, integer_in_range(f"{args.out}: seed", row.get("seed")))


def _is_there(args: argparse.Namespace, row: dict[str, Any], whole_models: set[Path]) -> bool:
    """Returns whether the house is at the row's path, with as many bytes, and all that it shows.

    Models that are whole are added to ``whole_models`` and not looked at again.
    """
    path = Path(args.out, str(row.get("path")))
    if not path.exists() or row.get("bytes", _bytes(path)) != _bytes(path):
        return False
    try:
        return all(map(_is_whole, _shown(path, whole_models)))
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        # What is no table of a house was changed since.
        return False


def _is_whole(file: tuple[Path, int]) -> bool:
    """Returns whether a regular file has as many bytes, or more, and ends as its form does."""
    path, least = file
    if not path.is_file() or path.stat().st_size < least:
        return False
    end = _ENDS.get(path.suffix, b"")
    with open_file(path) as opened:
        opened.seek(max(0, path.stat().st_size - len(end)))
        return opened.read() == end if end else True


def _shown(path: Path, whole_models: set[Path]) -> Iterator[tuple[Path, int]]:
    """The files that a house shows beside its own, each with the bytes that it has at least."""
    if path.suffix == ".dwell":
        with open_file(path / "house.glb") as file:
            # The length of the tables stands in the header of a GLB.
            length = int.from_bytes(file.read(20)[12:16], "little")
            tables = parse_json(file.read(min(length, MAX_TEXT_BYTES)), f"{path}/house.glb")
        for row in (*tables.get("buffers", ()), *tables.get("images", ())):
            if "uri" in row and not row["uri"].startswith("data:"):
                yield path / row["uri"], row.get("byteLength", 1)
    elif path.name == "house.json":
        root = path.parents[2]
        house = read_json(path)
        nodes = [node for level in house["levels"] for node in level["nodes"]]
        parts = [
            root / "room" / house["id"] / f"{node['modelId']}{letter}"
            for node in nodes
            if _has(node, "Room")
            for letter, hidden in _ROOM_PARTS
            if not node.get(hidden)
        ]
        objects = {node["modelId"] for node in nodes if _has(node, "Object")}
        models = [*parts, *(root / "object" / name / name for name in sorted(objects))]
        for model in models:
            if model in whole_models:
                continue
            files = [model.with_name(model.name + ending) for ending in (".obj", ".mtl")]
            if model.parent.name in objects:
                files.append(model.with_name("row.json"))
            yield from ((file, 1) for file in files)
            for line in read(files[1]).decode("utf-8", "replace").splitlines():
                if line.startswith("map_"):
                    yield model.parent / line.partition(" ")[2].strip(), 1
            whole_models.add(model)


def _has(node: dict[str, Any], kind: str) -> bool:
    return node.get("type") == kind and "modelId" in node


def _bytes(path: Path) -> int:
    """Bytes of the files that are the house's own, beside what it shares with others."""
    # A SUNCG house is named by a file of its folder.
    own = path.parent if path.name == "house.json" else path
    files = own.rglob("*") if own.is_dir() else (own,)
    return sum(file.stat().st_size for file in files if file.is_file())


def _rows(manifest: Path) -> Iterator[dict[str, Any]]:
    """The rows of a manifest.

    Raises:
        ValueError: A line is no row, was changed since it was written, or has the seed of another.
    """
    line_of: dict[int, int] = {}
    with open_file(manifest) as file:
        for number, line in enumerate(lines(file, manifest), start=1):
            at = f"{manifest} line {number}"
            row = parse_json(line, at)
            if not isinstance(row, dict):
                raise ValueError(f"{at}: expected an object, found {row!r:.60}")
            refuse_other_version(at, row)
            # Older manifests have none.
            if "check" in row and row["check"] != _check(row):
                raise ValueError(
                    f"{at}: changed since it was written: its check is {row['check']!r:.60}, and "
                    f"that of its other fields is {_check(row)!r}; put it back, or remove "
                    f"{manifest} and run again"
                )
            seed = integer_in_range(f"{at}: seed", row.get("seed"))
            before = line_of.setdefault(seed, number)
            if before != number:
                raise ValueError(
                    f"{at}: seed {seed} stands in line {before} already; a manifest has each seed "
                    "once: remove one of them"
                )
            yield row


def _check(row: dict[str, Any]) -> str:
    """The check sum of a row's other fields."""
    written = json.dumps({name: row[name] for name in row if name != "check"}, sort_keys=True)
    return f"{zlib.crc32(written.encode()):08x}"


def _checked(row: dict[str, Any]) -> dict[str, Any]:
    return {**row, "check": _check(row)}


def _house(args: argparse.Namespace, seed: int) -> dict[str, Any]:
    """Makes and writes one house; returns its row of the manifest.

    Raises:
        OSError: There is no room for it, or the system refuses for another reason.
        HouseError: It cannot be written, because something else stands in its place.

    What was not written is no fault of the house: it has no row, and the next run tries again.
    """
    from dwell import HouseError
    from dwell.house import House, split_of_seed

    split = split_of_seed(seed)
    fields = [f"split={split}", *args.spec]
    name = f"seed:{seed}?{'&'.join(fields)}"
    row: dict[str, Any] = {"version": VERSION, "seed": seed, "split": split, "house": name}
    try:
        house = House.open(name)
    except OSError:
        raise
    except HouseError as error:
        return _checked({**row, "error": str(error)})
    path, _ = house.write_into(args.out, f"seed_{seed}", args.format)
    row["path"] = Path(path).relative_to(args.out).as_posix()
    row["bytes"] = _bytes(path)
    return _checked({**row, **_statistics(house.info())})


def _statistics(info: dict[str, Any]) -> dict[str, Any]:
    """The manifest's row of a house."""
    rooms = info["rooms"]
    kinds = Counter(kind for room in rooms for kind in room["kinds"][:1])
    given_up = [row["sentence"] for row in info["report"].get("warnings", [])]
    return {
        "hash": info["fingerprint"],
        "storeys": info["levels"],
        "rooms": dict(sorted(kinds.items())),
        "area_m2": round(sum(room["area_m2"] for room in rooms), 2),
        "objects": info["objects"],
        "categories": info["categories"],
        "triangles": info["triangles"],
        "given_up": given_up,
    }


def _seeds(first: int, split: str) -> Iterator[int]:
    """Seeds of a split, from ``first`` upwards."""
    from dwell.house import split_of_seed

    return (seed for seed in itertools.count(first) if split in ("all", split_of_seed(seed)))


def _field(given: str) -> str:
    """A field of the spec as it stands in a HOUSE string."""
    if not re.fullmatch(r"[a-z0-9_]+=[^&]*", text("--spec", given)):
        raise ValueError(f"--spec: expected FIELD=VALUE, found {given!r}")
    if given.startswith("split="):
        raise ValueError(
            f"--spec {given}: each seed has the looks of its own split; --split chooses seeds"
        )
    return given
