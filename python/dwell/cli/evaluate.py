"""``dwell evaluate``: a policy plays episodes, and a result that can be checked."""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from dwell.arguments import from_json
from dwell.cli.common import (
    ProgressBar,
    count,
    count_from_1,
    path,
    print_json,
    refuse_unused,
    workers,
)
from dwell.cli.episodes import add_task_settings, task_settings
from dwell.cli.job_journal import Journal

#: What is printed for people of the means.
_SHOWN = ("success", "spl", "soft_spl", "sna", "sws", "distance_to_goal", "steps", "reward")


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "policy",
        metavar="POLICY",
        nargs="?",
        help="random, expert, stop, forward, ears (of --sensors audio), or module:Name of a class "
        "with act(observation)",
    )
    parser.add_argument(
        "--episodes", type=path, nargs="+", metavar="FILE", help="of `dwell episodes`; or else:"
    )
    parser.add_argument("--task", help="make episodes of this task")
    parser.add_argument("--houses", metavar="HOUSES", nargs="+", help="in these")
    parser.add_argument("--split", choices=("train", "val", "test"), help="as --houses split:NAME")
    parser.add_argument("--count", type=count_from_1, help="so many")
    parser.add_argument("--seed", type=count, default=0, help="from this seed")
    parser.add_argument(
        "--expert",
        action="store_true",
        help="the expert plays made episodes first, for SNA; those of files have it, or not",
    )
    add_task_settings(parser)
    parser.add_argument(
        "--sensors",
        help="names with commas, or JSON of settings by name; default: the task's, and gps for "
        "the policies by name alone",
    )
    parser.add_argument("--stride", metavar="JSON", help="forward_m, turn_deg, look_deg")
    parser.add_argument(
        "--action-mode",
        choices=("discrete", "velocity", "pointer", "object", "dict"),
        default="discrete",
        help="the form of the policy's actions",
    )
    parser.add_argument("--max-steps", type=count_from_1, help="default: the task's")
    parser.add_argument(
        "--workers",
        type=workers,
        default=1,
        help="processes that play, each with a policy of its own (default: this one)",
    )
    parser.add_argument(
        "--out",
        type=path,
        metavar="FILE.json",
        help="the result; a run that was stopped goes on",
    )
    parser.add_argument(
        "--verify",
        type=path,
        metavar="FILE.json",
        help="play the actions of a result again: all that it states holds, or fail; with POLICY "
        "its source is compared, with --episodes the files that were played",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Plays or verifies, and prints.

    Returns:
        1 when a result does not hold.
    """
    from dwell.policies import PolicyError

    if args.policy is not None and ":" in args.policy:
        # A policy lies where the command is given more often than in an installed package. Not "":
        # to processes of its own, multiprocessing gives that as the folder of its own import.
        here = str(Path.cwd())
        if here not in sys.path:
            sys.path.insert(0, here)
    try:
        return _verify(args) if args.verify is not None else _evaluate(args)
    except PolicyError as error:
        print(error.trace, end="", file=sys.stderr)
        raise


def _evaluate(args: argparse.Namespace) -> int:
    if args.policy is None:
        raise ValueError("expected a POLICY, or --verify FILE.json")
    if args.episodes is not None:
        refuse_unused(
            args,
            {"policy", "episodes", "sensors", "stride", "action_mode", "max_steps", "workers"}
            | {"out", "json", "set", "settings"},
            "an evaluation of episodes of a file",
        )
    result = _result(args)
    if args.json:
        print_json({key: value for key, value in result.items() if key != "episodes"})
        return 0
    print(f"{result['policy']}: {result['count']} episodes of {result['task']['name']}")
    for name in _SHOWN:
        row = result["metrics"].get(name)
        if row is not None and row["mean"] is not None:
            print(f"{name}: {row['mean']:.4g} ({row['low']:.4g} to {row['high']:.4g})")
    for kind, row in result["by_goal_kind"].items():
        print(f"{kind}: success {100 * row['success']:.4g} % of {row['episodes']} episodes")
    if args.out:
        print(args.out)
    return 0


def _verify(args: argparse.Namespace) -> int:
    from dwell.evaluation import differences, read_result
    from dwell.policies import BASELINES

    refuse_unused(args, {"policy", "verify", "episodes", "json"}, "a result that is verified")
    result = read_result(args.verify)
    told = differences(result, policy=args.policy, episodes=args.episodes, progress=ProgressBar())
    if args.json:
        print_json({"file": str(args.verify), "differences": told})
    elif not told:
        who = result["policy"]
        is_unknown = args.policy is None and who not in BASELINES
        but = f", but for who chose the actions: give {who} to compare its source"
        print(f"{args.verify}: all that it states holds{but if is_unknown else ''}")
    for sentence in told:
        print(f"{args.verify}: {sentence}", file=sys.stderr)
    return 1 if told else 0


def _result(args: argparse.Namespace) -> dict[str, Any]:
    from dwell.evaluation import Evaluation, episode_set, result_of, text_of
    from dwell.evaluation_workers import played_rows

    houses = args.houses
    if args.split is not None:
        if houses is not None:
            raise ValueError("--split and --houses: one of them says which houses")
        houses = [f"split:{args.split}"]
    own = task_settings(args) or None
    which = episode_set(
        args.episodes, args.task, houses, args.count, args.seed, own, expert=args.expert
    )
    job = Evaluation(
        args.policy,
        which,
        sensors=_sensors(args.sensors),
        task_settings=own,
        stride=None if args.stride is None else from_json("--stride", args.stride),
        action_mode=args.action_mode,
        max_steps=args.max_steps,
    )
    bar, all_episodes = ProgressBar(), len(job.episodes)
    if args.out is None:
        rows = []
        for row in played_rows(job, job.episodes, workers=args.workers):
            rows.append(row)
            bar(len(rows) / all_episodes, row["scene_id"])
        return result_of(job.about, rows)
    listed = "\n".join(json.dumps(one.as_dict(), sort_keys=True) for one in job.episodes)
    digest = hashlib.sha256(listed.encode()).hexdigest()
    source = job.about["policy_source"]
    apart = ("scene_ids", "policy_source")
    about = {key: value for key, value in job.about.items() if key not in apart}
    # Told by these names where they are others: results of two policies are not mixed.
    hashes = {"the episodes (a hash)": digest, "the policy's source (a hash)": source}
    journal = Journal(args.out, {"command": "evaluate", **about, **hashes})
    result: dict[str, Any] = {}
    try:
        left = [one for one in job.episodes if one.episode_id not in journal.done]
        for one, row in zip(left, played_rows(job, left, workers=args.workers), strict=True):
            journal.add(one.episode_id, [row])
            bar(len(journal.done) / all_episodes, one.scene_id)

        def whole(rows: Iterator[dict[str, Any]]) -> str:
            result.update(result_of(job.about, [*rows]))
            return text_of(result)

        journal.finish(whole)
    except BaseException:
        journal.close()
        if journal.done:
            kept = f"{len(journal.done)} of {all_episodes} are kept; run again"
            print(f"dwell evaluate: {kept}", file=sys.stderr)
        raise
    return result


def _sensors(given: str | None) -> Any:  # noqa: ANN401 - names, or settings by name
    if given is None or not given.lstrip().startswith("{"):
        return None if given is None else [name.strip() for name in given.split(",")]
    return from_json("--sensors", given)
