"""What is understood of agents' words, through the whole chain: voice, room, noise, ears.

    python benches/environments/intelligibility.py            # some minutes

Rows by distance in a hall, by noise beside the listener, by vocal effort, and by a door and a wall
in between. Of each 20 utterances of 8 words are said; printed are the share of words that were
understood, taken for others, lost or not noticed, the mean speech transmission index and level, and
the share that the index alone predicts.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from typing import Any

import numpy as np

import dwell
from dwell import _native

WORDS = 8


def hall() -> dwell.House:
    """A hall of 24 by 3.5 by 12 m with the absorption of a furnished one."""
    return dwell.House.shoebox((24.0, 3.5, 12.0), absorption=0.3, scattering=0.3)


def rooms(*, walls: str, opened: float | None) -> dwell.House:
    """Two rooms of 4 by 4 m with carpets and absorbing ceilings; a door between them, or none."""
    builder = dwell.HouseBuilder("two rooms")
    for name, west in (("west", 0.0), ("east", 4.3)):
        builder.room(
            name,
            (west, 0.0, west + 4.0, 4.0),
            floor="carpet",
            walls=walls,
            ceiling="acoustic_panel",
        )
    if opened is not None:
        builder.door("west", "east", opened=opened)
    return builder.build()


def spoken(world: dwell.World, utterances: int, effort: str) -> dict[str, float]:
    """What agent 1 makes of what agent 0 says."""
    world.listen(agent=1)
    stream = np.random.default_rng(5)
    count = len(_native.vocabulary())
    right = wrong = lost = missed = 0
    sti: list[float] = []
    level: list[float] = []
    for _ in range(utterances):
        words = stream.integers(1, count + 1, WORDS).tolist()
        world.say(0, words, effort=effort)
        heard: list[dict[str, Any]] = []
        while world.speaks(0):
            world.step()
            heard += world.heard(1)
        for _ in range(6):
            world.step()
            heard += world.heard(1)
        missed += WORDS - len(heard)
        for row, word in zip(heard, words[-len(heard) :] if heard else (), strict=False):
            lost += row["token"] is None
            right += row["token"] == word
            wrong += row["token"] not in (None, word)
            sti.append(row["sti"])
            level.append(row["level_db"])
    total = utterances * WORDS
    return {
        "understood": right / total,
        "confused": wrong / total,
        "lost": lost / total,
        "unnoticed": missed / total,
        # Of a thousand words; see docs/sounds.md.
        "predicted": sum((1 - 10 ** (-max(s - 0.1, 0.0) / 0.41)) ** 1.36 for s in sti) / total,
        "sti": float(np.mean(sti)) if sti else 0.0,
        "level_db": float(np.mean(level)) if level else float("nan"),
    }


def cases() -> Iterator[tuple[str, dwell.World, str]]:
    """Name, world and vocal effort of each row."""
    house = hall()
    for distance in (1.0, 2.0, 4.0, 8.0, 16.0):
        yield f"hall, {distance:g} m", pair(house, distance), "normal"
    for effort in ("whisper", "normal", "shout"):
        yield f"hall, 8 m, {effort}", pair(house, 8.0), effort
    for level_db in (40.0, 50.0, 60.0, 70.0, 80.0):
        world = pair(house, 2.0)
        world.play("noise", at=(6.0, 1.5, 8.0), level_db=level_db, loop=True)
        yield (
            f"hall, 2 m, noise of {level_db:g} dB (at 1 m) 2.2 m beside",
            world,
            "normal",
        )
    for name, house in (
        ("an open door", rooms(walls="brick", opened=1.0)),
        ("a closed door", rooms(walls="brick", opened=0.0)),
        ("a wall of brick", rooms(walls="brick", opened=None)),
    ):
        yield f"4.3 m, {name} between", pair(house, 4.3, at=(2.0, 0.0, 2.0)), "normal"


def pair(
    house: dwell.House,
    distance_m: float,
    at: tuple[float, float, float] = (4.0, 0.0, 6.0),
) -> dwell.World:
    """A world in which agent 1 stands so far from agent 0, facing it."""
    world = dwell.World(house, agents=2)
    world.place_agent(at, yaw_deg=-90.0, agent=0)
    world.place_agent((at[0] + distance_m, at[1], at[2]), yaw_deg=90.0, agent=1)
    return world


def main() -> None:
    """Prints the rows."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--utterances", type=int, default=20)
    given = parser.parse_args()
    for name, world, effort in cases():
        row = spoken(world, given.utterances, effort)
        print(
            json.dumps({"case": name, **{k: round(v, 3) for k, v in row.items()}}),
            flush=True,
        )


if __name__ == "__main__":
    main()
