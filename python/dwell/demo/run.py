"""The order of the demo, and the folder it writes."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from dwell import ConfigError, plans
from dwell.demo import (
    calibration,
    episode,
    instruction,
    page,
    recording,
    rooms,
    second_agent,
    throughput,
)
from dwell.files import refuse_link
from dwell.house import House

Progress = Callable[[float, str], None]


def run(house: str, out: Path, progress: Progress) -> dict[str, Any]:
    """Runs the demo and writes ``out``/index.html with what it shows.

    The folder appears when everything is written; that of an earlier demo is replaced.

    Args:
        house: A HOUSE string.
        out: The folder.
        progress: Told a fraction and what is being done.

    Returns:
        A summary: what was fulfilled, done, heard, found, and how fast.

    Raises:
        FileExistsError: ``out`` holds something that no demo wrote.
        OSError: ``out`` is a link, or the system refuses.
    """
    refuse_link(out)
    if out.exists() and any(out.iterdir()) and not (out / "index.html").exists():
        raise FileExistsError(f"{out}: holds files that no demo wrote; choose another folder")
    out.parent.mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(prefix=f".{out.name}.", dir=out.parent))
    folder.chmod(0o755)
    try:
        summary = _fill(house, folder, progress)
        if out.exists():
            shutil.rmtree(out)
        folder.rename(out)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    progress(1.0, f"written to {out}")
    return summary


def _fill(name: str, folder: Path, progress: Progress) -> dict[str, Any]:
    progress(0.0, f"opening {name}")
    house = House.open(name)
    story: dict[str, Any] = {"house": name, "info": house.info(), "text": house.describe("house")}
    if not story["info"]["rooms"]:
        raise ConfigError(f"{name}: has no rooms; the demo needs a house to walk through")
    progress(0.05, "looking into every room")
    story["rooms"] = rooms.pictures(house, folder)
    progress(0.15, "following an instruction")
    story["instruction"] = instruction.follow(name, folder)
    progress(0.3, "opening, taking, listening")
    story["errand"] = episode.run_episode(
        house, folder, lambda part: progress(0.3 + 0.25 * part, "walking")
    )
    progress(0.55, "meeting another agent")
    story["second_agent"] = second_agent.meet(house, folder)
    ways = [("#1f7a6d", story["instruction"].get("way", [])), ("#c4532f", story["errand"]["way"])]
    ways += [("#3b6fb5", way) for way in story["second_agent"].get("ways", [])[1:]]
    world = story["errand"]["world"]
    plans.floor_plan(world, longest_edge=1000, ways=ways).save(folder / "map.png")
    plans.dollhouse(world, width=1000).save(folder / "dollhouse.png")
    progress(0.6, "finding a hidden error in measured data")
    story["calibration"] = calibration.example(
        folder, lambda part: progress(0.6 + 0.15 * part, "fitting")
    )
    progress(0.75, "timing every stage")
    story["figures"] = throughput.measure(name, lambda part: progress(0.75 + 0.2 * part, "timing"))
    progress(0.95, "recording for the Rerun viewer")
    story["recording"] = recording.write(story["errand"], story["second_agent"], folder)
    (folder / "index.html").write_text(page.html(story), "utf-8")
    return {
        "house": name,
        "instruction": story["instruction"].get("text"),
        "fulfilled": story["instruction"].get("success", False),
        "errand": [line["sentence"] for line in story["errand"]["log"]],
        "errand_full_scale_pa": story["errand"]["full_scale_pa"],
        "second_agent": {
            name: story["second_agent"].get(name) for name in ("heard", "seen", "refused")
        },
        "verdict": story["calibration"]["sentence"],
        "figures": story["figures"],
    }
