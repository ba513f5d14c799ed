"""``dwell localize make``: a data set of recordings with labels."""

from __future__ import annotations

import argparse
import sys
import time

from dwell.cli.common import ProgressBar, count, count_from_1, number, path, print_json, shard
from dwell.cli.job_journal import claim, refuse_other

#: Houses that were skipped and are told of on standard error.
_MOST_TOLD = 10


def configure(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "houses",
        nargs="+",
        metavar="HOUSES",
        help="seed:A..B?home=studio, split:train, data/*.dwell, HOUSE; shoebox:A..B: empty rooms; "
        "several",
    )
    parser.add_argument("--count", type=count_from_1, required=True, help="clips in all")
    parser.add_argument("--out", type=path, required=True, metavar="FOLDER")
    parser.add_argument(
        "--array",
        nargs="+",
        default=["foa"],
        metavar="ARRAY",
        help="foa, hoa2, hoa3, binaural, tetrahedral, six_ring, eigenmike, phone, or FILE.json: a "
        "list of microphones (right, up, back), m; several record the same scenes",
    )
    parser.add_argument(
        "--held-out-array",
        nargs="+",
        default=[],
        metavar="ARRAY",
        help="those of them that record the test part alone",
    )
    parser.add_argument(
        "--sounds",
        default="signals",
        metavar="WHAT",
        help="signals (default), household (the house's appliances), or a folder CLASS/NAME.wav",
    )
    parser.add_argument("--duration-s", type=number, default=10.0, metavar="S")
    parser.add_argument("--rate-hz", type=count, default=24_000, help="16000, 24000 or 48000")
    parser.add_argument("--preset", default="rl", help="how sound is traced: rl or full")
    parser.add_argument("--max-sources", type=count, default=2, help="of a clip, 1 to 4")
    parser.add_argument("--moving", type=number, default=0.0, help="share of sources that move")
    parser.add_argument(
        "--moving-listener", type=number, default=0.0, help="share of clips whose array moves"
    )
    parser.add_argument(
        "--snr-db", type=number, nargs=2, default=[10.0, 30.0], metavar=("LOW", "HIGH")
    )
    parser.add_argument(
        "--distance-m", type=number, nargs=2, default=[0.5, 4.0], metavar=("LOW", "HIGH")
    )
    parser.add_argument(
        "--out-of-sight", action="store_true", help="sources may be behind things and walls, too"
    )
    parser.add_argument(
        "--test-share", type=number, default=0.2, help="of the houses (default 0.2)"
    )
    parser.add_argument("--bits", type=int, choices=(16, 32), default=16)
    parser.add_argument(
        "--parts", action="store_true", help="direct, early and late sound and noise, too"
    )
    parser.add_argument("--responses", action="store_true", help="impulse responses, too")
    parser.add_argument("--seed", type=count, default=0)
    parser.add_argument(
        "--shard", type=shard, default=(0, 1), metavar="K/N", help="the K-th of N parts, from 0"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output")


def run(args: argparse.Namespace) -> int:
    """Makes what is missing; a run that was stopped goes on when it is given again.

    Returns:
        1 when a house could not be used; a sentence says why.
    """
    from dwell.localization.dataset import DatasetMaker
    from dwell.localization.settings import Settings

    settings = Settings(
        arrays=tuple(args.array),
        held_out_arrays=tuple(args.held_out_array),
        sounds=args.sounds,
        duration_s=args.duration_s,
        rate_hz=args.rate_hz,
        preset=args.preset,
        max_sources=args.max_sources,
        moving=args.moving,
        moving_listener=args.moving_listener,
        snr_db=(args.snr_db[0], args.snr_db[1]),
        distance_m=(args.distance_m[0], args.distance_m[1]),
        in_sight=not args.out_of_sight,
        test_share=args.test_share,
        bits=args.bits,
        parts=args.parts,
        responses=args.responses,
        seed=args.seed,
    )
    maker = DatasetMaker(args.houses, settings, count=args.count, shard=args.shard)
    refuse_other(args.out, maker.to_json())
    if not (args.out / "dataset.json").exists():
        maker.refuse_unopenable()
    claim(args.out, maker.to_json())
    skipped: dict[str, str] = {}

    def skip(house: str, why: str) -> None:
        skipped[house] = why
        if len(skipped) <= _MOST_TOLD:
            print(f"dwell localize: skipped {house}: {why}", file=sys.stderr)

    bar, made, started = ProgressBar(), 0, time.perf_counter()
    for done, (clip, is_new) in enumerate(maker.make(args.out, on_skip=skip), start=1):
        made += is_new
        bar(done / len(maker.clips), maker.name_of(clip))
    seconds = time.perf_counter() - started
    if len(skipped) > _MOST_TOLD:
        print(f"dwell localize: skipped {len(skipped) - _MOST_TOLD} more houses", file=sys.stderr)
    summary = {
        "clips": len(maker.clips),
        "made_now": made,
        "clips_per_hour": round(3600.0 * made / seconds, 1) if made else None,
        "skipped": skipped,
        "folder": str(args.out),
    }
    if args.json:
        print_json(summary)
    else:
        print(f"{made} of {len(maker.clips)} clips made now in {seconds:.0f} s; {args.out}")
    return 1 if skipped else 0
