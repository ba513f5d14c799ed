"""``dwell challenge``: cases with a hidden cause for methods of calibration, and their scores."""

from __future__ import annotations

import argparse
import hashlib
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dwell.cli.common import ProgressBar, count, count_from_1, path, print_json, shard
from dwell.cli.job_journal import alone, claim, refuse_other
from dwell.files import atomic_write

if TYPE_CHECKING:
    from dwell.challenge import ChallengeSettings


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the commands."""
    what = parser.add_subparsers(dest="what", metavar="make|run|score", required=True)
    make = what.add_parser("make", help="bundles with a hidden cause, and apart their answers")
    make.add_argument("--cases", type=count_from_1, default=80, metavar="N", help="how many (80)")
    make.add_argument("--seed", type=count, default=0, metavar="S", help="draws them (0)")
    make.add_argument(
        "--worlds", nargs="+", metavar="WORLD", help="of flights, servos; default: all"
    )
    make.add_argument("--shard", type=shard, default=(0, 1), metavar="I/N", help="a part of them")
    make.add_argument("--out", type=path, required=True, metavar="DIR", help="for NAME.measured")
    make.add_argument(
        "--answers", type=path, metavar="FILE.jsonl", help="what is hidden; not where bundles are"
    )
    make.set_defaults(do=_make)
    run = what.add_parser("run", help="verdicts of dwell calibrate; goes on where it was stopped")
    run.add_argument("bundles", type=path, metavar="DIR", help="the folder of bundles")
    run.add_argument("--shard", type=shard, default=(0, 1), metavar="I/N", help="a part of them")
    run.add_argument(
        "--method",
        choices=("calibrate", "least-squares", "one-at-a-time"),
        default="calibrate",
        help="dwell calibrate (default), or a baseline that knows the worlds' equations",
    )
    run.add_argument(
        "--out", type=path, required=True, metavar="FILE.jsonl", help="verdicts; of each shard one"
    )
    run.set_defaults(do=_run)
    score = what.add_parser("score", help="scores of verdicts, with their intervals")
    score.add_argument("verdicts", type=path, nargs="+", metavar="VERDICTS.jsonl")
    score.add_argument("--answers", type=path, nargs="+", required=True, metavar="FILE.jsonl")
    score.add_argument("--json", action="store_true", help="one JSON object on standard output")
    score.set_defaults(do=_score)


def run(args: argparse.Namespace) -> int:
    """Runs one of them."""
    return int(args.do(args))


def _make(args: argparse.Namespace) -> int:
    from dwell import ConfigError
    from dwell.challenge import ChallengeSettings, make

    if args.answers and args.answers.resolve().is_relative_to(args.out.resolve()):
        raise ConfigError(f"--answers is {args.answers}; expected a file outside of {args.out}")
    chosen = {} if args.worlds is None else {"worlds": tuple(args.worlds)}
    settings = ChallengeSettings(cases=args.cases, seed=args.seed, **chosen)
    job = _job(settings)
    refuse_other(args.out, job)
    if args.answers:
        _refuse_lost_answers(args.answers, settings, args.shard)
    claim(args.out, job)
    with alone(args.out, args.shard):
        progress = ProgressBar()
        answers, written = [], 0
        for one, folder, is_new in make(args.out, settings, args.shard):
            answers.append(json.dumps(one.answer()) + "\n")
            written += is_new
            progress((one.number + 1) / settings.cases, folder.name)
        progress(1.0, "done")
        if args.answers:
            with atomic_write(args.answers) as draft:
                draft.write_text("".join(answers), "utf-8")
    print(f"{written} of {len(answers)} bundles written to {args.out}")
    return 0


def _job(settings: ChallengeSettings) -> dict[str, Any]:
    """What a folder of bundles is begun with; the number of cases may be another later.

    The seed tells what is hidden, so that those who judge see that it is another one, and no more.
    """
    seed = hashlib.blake2b(f"dwell challenge {settings.seed}".encode(), digest_size=8)
    worlds = [*settings.worlds]
    return {"command": "challenge make", "worlds": worlds, "seed (a hash)": seed.hexdigest()}


def _refuse_lost_answers(file: Path, settings: ChallengeSettings, shard: tuple[int, int]) -> None:
    """Refuses to write over answers to other cases.

    Raises:
        ValueError: There are some, or what stands there are no answers.
    """
    from dwell.challenge import read_answers
    from dwell.challenge.cases import name_of

    if not os.path.lexists(file):
        return
    which, shards = shard
    ours = {name_of(number, settings) for number in range(which, settings.cases, shards)}
    others = [row["case"] for row in read_answers(file) if row["case"] not in ours]
    if others:
        raise ValueError(
            f"{file} keeps {len(others)} answers to cases that are not made now, as {others[0]}: "
            "of another seed, other worlds, another shard or more cases; give another --answers"
        )


def _run(args: argparse.Namespace) -> int:
    from dwell.challenge import calibrated_verdict
    from dwell.challenge import run as judge
    from dwell.challenge.baselines import BASELINES

    names = len(list(args.bundles.glob("*.measured")))
    which, shards = args.shard
    expected = max(1, len(range(which, names, shards)))
    progress = ProgressBar()
    done = new = 0
    method = BASELINES.get(args.method, calibrated_verdict)
    for name, is_new in judge(args.bundles, args.out, method, args.shard, name=args.method):
        done, new = done + 1, new + is_new
        progress(done / expected, name)
    print(f"{new} of {done} bundles judged; verdicts in {args.out}")
    return 0


def _score(args: argparse.Namespace) -> int:
    from dwell.challenge import read_answers, read_verdicts, score

    answers = [row for file in args.answers for row in read_answers(file)]
    verdicts = [row for file in args.verdicts for row in read_verdicts(file)]
    found = score(answers, verdicts)
    if args.json:
        print_json(found)
        return 0
    others = found["unanswered"]
    print(
        f"{found['judged']} cases judged"
        + (f"; {others} verdicts on other cases left out" if others else "")
    )
    for name, value in found.items():
        if isinstance(value, dict):
            print(_line(name, value))
    for name in ("mean_set_size", "median_error"):
        if found[name] is not None:
            print(f"{name:<26} {found[name]:.3f}")
    for row in found["curve"]:
        low, high = row["d_prime"]
        print(_line(f"named right, d' {low:g} to {high:g}", row))
    return 0


def _line(name: str, value: dict[str, Any]) -> str:
    if value["share"] is None:
        return f"{name:<26} no cases"
    low, high = (100.0 * end for end in value["interval"])
    share = 100.0 * value["share"]
    return f"{name:<26} {share:5.1f} %  ({low:.1f} to {high:.1f})  {value['hits']} of {value['of']}"
