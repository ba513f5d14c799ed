"""``dwell calibrate``: measured data against the simulation."""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import sys
from collections.abc import Iterator
from typing import Any

from dwell.cli.common import ProgressBar, path, print_json
from dwell.files import atomic_write, check_writable


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "measured", metavar="NAME.measured", help="the folder of the measured bundle"
    )
    parser.add_argument("--house", help="the HOUSE it was measured in, if the bundle does not say")
    parser.add_argument(
        "--peer",
        action="append",
        default=[],
        metavar="FILE.csv",
        help="scores of another simulator on the same pose trajectories",
    )
    parser.add_argument(
        "--budget-s",
        type=float,
        metavar="S",
        help="seconds after which the search ends with what it has tried; Ctrl-C does so, too",
    )
    parser.add_argument(
        "--out", type=path, metavar="DIR", help="for report.html, report.json, found.json"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def roll_outs(report: dict[str, Any]) -> Iterator[str]:
    """The tables of a study of roll-outs, line by line."""
    yield "\nwhole episodes           position, widths   rotation, degrees   e_q         e_q < 0.05"
    yield "                         mean   median      mean   median       median"
    rows = [(model["model"]["name"], model["summary"]) for model in report["models"]]
    rows += [(peer["name"], peer["summary"]) for peer in report["models"][0]["against"]]
    for name, summary in rows:
        place, turn = summary["position_widths"], summary["rotation_deg"]
        yield (
            f"{name[:22]:<22}   {place['mean']:.3f}  {place['median']:.3f}       "
            f"{turn['mean']:5.1f}  {turn['median']:5.1f}        "
            f"{summary['e_q']['median']:.4f}      {100 * summary['predicted_share']:.0f} %"
        )
    yield "\nfitted                   by fold"
    for model in report["models"]:
        for k, parameter in enumerate(model["model"]["parameters"]):
            values = "  ".join(f"{fold[k]:.4g}" for fold in model["chosen"])
            unit = "" if parameter["unit"] == "1" else f", {parameter['unit']}"
            yield f"{model['model']['name']}: {parameter['name']}{unit}: {values}"
    for model in report["models"]:
        yield f"\n{model['model']['name']}, rms by samples ahead and what happens on the way"
        for window in model["windows"]:
            yield (
                f"{window['horizon']:3d} ahead  {window['regime'] or 'all':<8} "
                f"{window['position_rms_mm']:8.2f} mm {window['rotation_rms_deg']:7.2f} deg  "
                f"({window['count']} windows)"
            )


class _Progress:
    """A progress bar that ends the search once somebody has pressed Ctrl-C."""

    def __init__(self) -> None:
        """Nobody has."""
        self._bar = ProgressBar()
        self._goes_on = True

    def __call__(self, fraction: float, what: str) -> bool:
        """Shows it; says whether the search goes on."""
        self._bar(fraction, what)
        return self._goes_on

    @contextlib.contextmanager
    def interruptible(self) -> Iterator[None]:
        """Meanwhile the first Ctrl-C ends the search; the second one is as ever."""
        try:
            before = signal.signal(signal.SIGINT, lambda *_: self._end())
        except ValueError:  # Signals are the main thread's.
            yield
            return
        self._before = before
        try:
            yield
        finally:
            signal.signal(signal.SIGINT, before)

    def _end(self) -> None:
        self._goes_on = False
        signal.signal(signal.SIGINT, self._before)
        print("\nending with what was tried; Ctrl-C again: at once", file=sys.stderr)


#: What ``--out`` gets.
_FILES = ("report.html", "report.json", "found.json")


def run(args: argparse.Namespace) -> int:
    """Calibrates, writes the report, and prints the verdict."""
    from dwell.calibration import calibrate

    for name in _FILES if args.out else ():
        check_writable(args.out / name)
    progress = _Progress()
    with progress.interruptible():
        report = calibrate(
            args.measured,
            house=args.house,
            progress=progress,
            peers=args.peer,
            budget_s=args.budget_s,
        )
    page = report.pop("html", "")
    if args.out:
        texts = (
            page,
            json.dumps(report, indent=1, ensure_ascii=False),
            json.dumps(report["found"], indent=1),
        )
        for name, text in zip(_FILES, texts, strict=True):
            with atomic_write(args.out / name) as path:
                path.write_text(text, "utf-8")
    if args.json:
        print_json(report)
    else:
        print(report["sentence"])
        if report.get("kind") == "pose_trajectory":
            for line in roll_outs(report):
                print(line)
        if args.out:
            print(f"Open {args.out / 'report.html'}")
    return 0
