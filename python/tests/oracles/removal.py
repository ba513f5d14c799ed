"""Support and containment by physics: what falls without another thing."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import dwell
from oracles.answers import Answer, all_of, at_least, negated
from oracles.outlines import gap
from oracles.scans import Floats, take
from oracles.scene import Cloud, Scene, clear


class Physics:
    """What falls when a thing is taken out of a house."""

    def __init__(self, house: dwell.House, steps: int = 12) -> None:
        """Lets the whole house stand for so many steps of 0.05 s: the control."""
        self.house, self.steps = house, steps
        self.world = dwell.World(house, agents=0)
        self.start = self.world.snapshot()
        self.movable: list[str] = []
        for row in self.world.objects():
            try:
                self.world.set_body(row["name"])
            except dwell.DwellError:
                continue
            self.movable.append(row["name"])
        self.world.restore(self.start)
        self.control = self._moves(self.world, self.movable)
        self.world.restore(self.start)

    def _moves(self, world: dwell.World, names: Iterable[str]) -> dict[str, Floats]:
        before = {}
        for name in names:
            before[name] = np.array(world.body(name)["position"])
            world.set_body(name)  # awake, as it stands
        for _ in range(self.steps):
            world.step()
        return {
            name: np.array(world.body(name)["position"]) - place for name, place in before.items()
        }

    def without(self, name: str) -> dict[str, Floats]:
        """How everything moves without one thing."""
        world = dwell.World(self.house.edit().remove(name).done(), agents=0)
        return self._moves(world, (thing for thing in self.movable if thing != name))

    def falls(self, name: str, moves: dict[str, Floats]) -> Answer:
        """Whether a thing sinks that stays where it is in the whole house; by 8 mm or more."""
        rest, now = self.control[name], moves[name]
        if np.linalg.norm(rest) > 0.006:
            return "grey"
        sinks = float(-(now - rest)[1])
        return "yes" if sinks > 0.008 else "no" if np.linalg.norm(now) < 0.006 else "grey"

    def enclosed(self, scene: Scene, a: str, b: str) -> float | None:
        """The part of level directions from a's middle in which b is met; others' are left out."""
        middle = scene.cloud(a).middle
        place = middle + np.array((0.0, 80.0, 0.0))
        self.world.set_body(a, position=tuple(place))
        camera = dwell.Camera(72, 36, near_m=0.001, projection={"kind": "equirectangular"})
        ids = take(self.world, middle, (0, 0), camera, ("instance",))["instance"][..., 0]
        self.world.restore(self.start)
        # Rows from 90 degrees down; those of -5 to 20 degrees.
        band = ids[14:19]
        number = scene.rows[b]["id"]
        others = np.isin(band, [row["id"] for row in scene.rows.values() if row["id"] != number])
        known = ~others
        if known.mean() < 0.5:
            return None
        return float((band == number)[known].mean())


def _box_share(one: Cloud, other: Cloud) -> float:
    """The part of one's box in the other's, grown by 0.02 m."""
    low = np.maximum(one.low, other.low - 0.02)
    high = np.minimum(one.high, other.high + 0.02)
    return float(np.prod(np.maximum(high - low, 0) / np.maximum(one.high - one.low, 1e-6)))


#: By convention these hold nothing, as soft and deep as they may be: what lies there is on them.
SEATS = ("sofa", "chair", "bed", "bench", "stool", "ottoman", "seat", "swing", "hammock", "pouf")


def on_and_in(
    scene: Scene, physics: Physics, a: str, b: str, moves: dict[str, Floats]
) -> tuple[Answer, Answer]:
    """Whether a is on b, and in b, by taking b away.

    What falls was carried. What stands on something that falls, too, may be carried by that alone:
    grey. What falls is in the other, not on it, where four fifths of its box are in the other's
    (margin 0.1) and 60 % of what is around its middle is the other; it is not where 30 % is.
    """
    falls = physics.falls(a, moves)
    if not clear(scene, a, b):
        return "grey", "grey"
    one, other = scene.cloud(a), scene.cloud(b)
    within: Answer = at_least(_box_share(one, other), 0.8, 0.1)
    if any(word in b for word in SEATS):
        within = "no"
    if within != "no":
        part = physics.enclosed(scene, a, b)
        around: Answer = "grey" if part is None else at_least(part, 0.45, 0.15)
        within = all_of(within, around)
    if falls != "yes":
        return falls, all_of(falls, within) if falls == "no" else "grey"
    indirect = any(
        name not in (a, b)
        and physics.falls(name, moves) != "no"
        and np.abs(np.array(scene.rows[name]["center"]) - one.middle).max() < 2.5
        and gap(scene.cloud(name).outline, one.outline) < 0.03
        and scene.cloud(name).low[1] < one.low[1] - 0.002
        and scene.cloud(name).high[1] > one.low[1] - 0.04
        for name in moves
    )
    carried: Answer = "grey" if indirect else "yes"
    return all_of(negated(within), carried), within
