"""``dwell localize score``: how well sounds are found in a data set."""

from __future__ import annotations

import argparse
import json
from typing import Any

from dwell.cli.common import (
    ProgressBar,
    count_from_1,
    number,
    path,
    print_json,
    refuse_other_suffix,
)
from dwell.files import atomic_write, check_writable


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "folder", type=path, metavar="FOLDER", help="a data set of dwell localize make"
    )
    parser.add_argument(
        "--baseline",
        nargs="+",
        default=[],
        metavar="NAME",
        help="gcc_phat, srp_phat, music, intensity; several are shown beside each other",
    )
    parser.add_argument(
        "--estimates",
        type=path,
        metavar="FOLDER",
        help="what another program found: NAME.csv for each clip, in the form of the labels",
    )
    parser.add_argument("--array", default="foa", metavar="NAME", help="whose recordings")
    parser.add_argument("--array-file", metavar="FILE.json", help="of an array of one's own")
    parser.add_argument("--part", choices=("dev-train", "dev-test"), help="default: both")
    parser.add_argument("--count", type=count_from_1, help="the first so many clips alone")
    parser.add_argument(
        "--max-angle-deg", type=number, default=20.0, help="of what counts as found (20)"
    )
    parser.add_argument(
        "--segment-frames",
        type=count_from_1,
        default=10,
        help="frames that are judged together: 10 as DCASE until 2023, 1 as since 2024",
    )
    parser.add_argument("--out", type=path, metavar="FILE.json", help="the whole report")
    parser.add_argument(
        "--plot", type=path, metavar="FILE.png", help="errors by distance and so on"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Scores, writes the report and the picture, and prints the measures."""
    from dwell.cli.write_files import save_picture
    from dwell.localization import scoring
    from dwell.localization.score_chart import score_chart

    if bool(args.baseline) == (args.estimates is not None):
        raise ValueError("expected one of --baseline and --estimates")
    for option, file, suffix in (("--out", args.out, ".json"), ("--plot", args.plot, ".png")):
        refuse_other_suffix(file, suffix, option)
        if file is not None:
            check_writable(file)
    if args.estimates is not None:
        estimators = {"estimates": scoring.estimates_in(args.estimates)}
    else:
        array = scoring.array_of(args.array, args.array_file)
        estimators = {name: scoring.baseline(name, array) for name in args.baseline}
    clips = [*scoring.clips_of(args.folder, args.array, args.part)][: args.count]
    reports: dict[str, dict[str, Any]] = {}
    bar = ProgressBar()
    for name, said in estimators.items():
        reports[name] = scoring.score(
            iter(clips),
            said,
            max_angle_deg=args.max_angle_deg,
            segment_frames=args.segment_frames,
            on_clip=lambda done, name=name: bar(done / len(clips), name),  # type: ignore[misc]
        )
    report = {
        "data": str(args.folder),
        "array": args.array,
        "part": args.part,
        "max_angle_deg": args.max_angle_deg,
        "segment_frames": args.segment_frames,
        "reports": reports,
    }
    if args.out is not None:
        with atomic_write(args.out) as draft:
            draft.write_text(json.dumps(report, indent=1) + "\n", "utf-8")
    if args.plot is not None:
        save_picture(args.plot, score_chart(reports))
    if args.json:
        print_json(report)
        return 0
    for name, found in reports.items():
        one, angle = found["measures"], found["angle_deg"]
        print(
            f"{name}, {found['clips']} clips: F20 {one['f20']:.3f}, ER20 {one['er20']:.3f}, "
            f"LE_CD {_number(one['le_cd_deg'])} degrees, LR_CD {one['lr_cd']:.3f}; of "
            f"{angle['frames']} frames median error {_number(angle['median'])} degrees"
        )
    return 0


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.1f}"
