"""Where the episodes of a result come from is checked: their houses, seed and files."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dwell import DwellError
from dwell.arguments import quoted
from dwell.episode_maker import drawn_seeds
from dwell.evaluation import EpisodeSet
from dwell.house_list import HouseList
from dwell.policy_source import file_digest

#: Places of episodes that are looked through for the seeds of a result.
_MOST_PLACES = 50_000
#: Houses that are tried at such a place, for this.
_MOST_HOUSES = 4


def origin_differences(
    result: Mapping[str, Any], files: EpisodeSet | None, *, counts_expert: bool
) -> Iterator[str]:
    """What is said of houses, seed and files of episodes and is not so, a sentence each.

    Args:
        result: A result whose fields are of their kinds.
        files: The files of episodes that are given with it.
        counts_expert: Whether a result holds the actions that these files count of the expert.
    """
    try:
        houses = HouseList(result["houses"])
    except (DwellError, OSError) as error:
        yield f"houses: {error}"
        return
    for scene in result["scene_ids"]:
        if scene not in houses:
            yield (
                f"houses: the file states {quoted(result['houses'])}, among which there is no "
                f"{quoted(scene)} of scene_ids"
            )
    if files is not None:
        yield from _of_files(result, files, counts_expert=counts_expert)
    elif result["seed"] is None:
        if len(result["episode_files"]) < 2:
            yield "seed: the file states None; only episodes of several files have no seed of all"
    elif not _come_from(result, houses):
        of_files = result["episode_files"]
        names = ", ".join(row["name"] for row in of_files)
        yield (
            f"seed: the file states {result['seed']}, from which `dwell episodes` draws other "
            "episodes than these in these houses"
            + (f"; where they were chosen or made otherwise, give {names}" if of_files else "")
        )


def _of_files(
    result: Mapping[str, Any], files: EpisodeSet, *, counts_expert: bool
) -> Iterator[str]:
    """What is not as in the files of episodes that are given."""
    given = [{"name": os.path.basename(file), "sha256": file_digest(file)} for file in files.files]
    if [row["sha256"] for row in given] != [row["sha256"] for row in result["episode_files"]]:
        yield (
            f"episode_files: the file states {quoted(result['episode_files'])}, those given are "
            f"{quoted(given)}"
        )
        return
    found = {
        "houses": [*(files.houses or files.header.houses)],
        "seed": files.header.seed if files.has_one_seed else None,
    }
    for name, value in found.items():
        if value != result[name]:
            yield f"{name}: the file states {quoted(result[name])}, the episodes' {quoted(value)}"
    ids = [one.episode_id for one in files.episodes]
    stated = [row["episode_id"] for row in result["episodes"]]
    if ids != stated:
        k = next((k for k, (a, b) in enumerate(zip(ids, stated, strict=False)) if a != b), 0)
        yield f"episodes: those of the files are others, or in another order, from number {k} on"
        return
    for k, (row, one) in enumerate(zip(result["episodes"], files.episodes, strict=True)):
        count = one.expert_actions if counts_expert and one.expert_success else None
        if row["expert_actions"] != count:
            at, own = f"episodes[{k}].expert_actions", row["expert_actions"]
            yield f"{at}: the file states {quoted(own)}, the episodes' {quoted(count)}"


def _come_from(result: Mapping[str, Any], houses: HouseList) -> bool:
    """Returns whether ``dwell episodes`` draws the episodes of a result from its seed.

    Those that state their start and goal were made otherwise: that they are those of a file, only
    the file tells.
    """
    rows = result["episodes"]
    if all(_is_at(row, k, len(rows), result["seed"], houses) for k, row in enumerate(rows)):
        return True
    if not result["episode_files"]:
        return False
    # Some of those of a file: in order, at any places.
    left = iter(range(_MOST_PLACES))
    drawn = (row for row in rows if row.get("stated") is None)
    return all(_is_drawn(row["seed"], result["seed"], left) for row in drawn)


def _is_at(
    row: Mapping[str, Any], place: int, count: int, seed: int, houses: Sequence[str]
) -> bool:
    """Returns whether an episode is the one at a place: of its seed, in the house tried for it."""
    first = place * len(houses) // count
    for k, seeds in enumerate(itertools.islice(drawn_seeds(seed, place), len(houses))):
        if row["seed"] in seeds:
            house = houses[(first + k) % len(houses)]
            return house == str(row["scene_id"])
    return False


def _is_drawn(wanted: int, seed: int, places: Iterator[int]) -> bool:
    """Returns whether a seed is one of those that are tried at one of the places."""
    return any(
        wanted in seeds
        for place in places
        for seeds in itertools.islice(drawn_seeds(seed, place), _MOST_HOUSES)
    )
