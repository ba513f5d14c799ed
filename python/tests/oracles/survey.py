"""Questions to a house, with the engine's answers and those of oracles."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import dwell
from oracles.answers import Answer, Viewer
from oracles.belonging import belongs_to, belongs_to_building, hangs_at_window
from oracles.contacts import against, touching, under
from oracles.distances import above, between, closer_to, far, near, next_to
from oracles.fronts import is_known, opposite, opposite_agent
from oracles.openness import openness
from oracles.outlook import Outlook
from oracles.places import at_end_of, in_middle_of, in_room, larger_room, on_storey
from oracles.reach import Walk
from oracles.removal import Physics, on_and_in
from oracles.scene import Scene
from oracles.sides import before_by_boxes, before_by_clouds, facing, left_by_clouds
from oracles.sight import before_by_masks, left_by_masks, seen
from oracles.sizes import larger, taller, wider

Pair = tuple[str, str]


@dataclasses.dataclass(frozen=True)
class Question:
    """One question with both answers."""

    predicate: str
    way: str
    things: tuple[str, ...]
    engine: Answer
    oracle: Answer
    viewer: Viewer | None = None
    #: What else is known of it where the answers differ.
    note: str = ""

    @property
    def name(self) -> str:
        """The predicate, and how the oracle answered."""
        return f"{self.predicate} ({self.way})"


def _said(truth: bool | None) -> Answer:
    return "void" if truth is None else "yes" if truth else "no"


class Survey:
    """Questions to one house, half of them with pairs of which the engine says that it holds."""

    def __init__(self, house: str, seed: int = 0, each: int = 2) -> None:
        """Opens a house; ``each`` is how many true and how many false ones are asked at once."""
        self.name, self.each = house, each
        self.rng = np.random.default_rng([seed, *house.encode()])
        self.house = dwell.House.open(house)
        self.world = dwell.World(self.house, agents=0)
        self.scene = Scene(self.world)
        self.asked: list[Question] = []
        # Doors and windows are parts of walls; a room's outline does not tell where they are.
        self.things = [
            name
            for name, row in self.scene.rows.items()
            if row["room"] is not None and not name.startswith(("door", "window", "garage"))
        ]
        self.places = {name: np.array(self.scene.rows[name]["center"]) for name in self.things}

    def chosen(self, items: Sequence[Any], count: int) -> list[Any]:
        """Some of a list, drawn."""
        if not len(items):
            return []
        picks = self.rng.permutation(len(items))[:count]
        return [items[int(k)] for k in picks]

    def ask(
        self,
        predicate: str,
        way: str,
        things: tuple[str, ...],
        oracle: Answer,
        viewer: Viewer | None = None,
        world: dwell.World | None = None,
        note: str = "",
    ) -> None:
        """Notes a question with the oracle's answer and the engine's."""
        # A piece of the building has no name, but an id.
        asked = [int(name[10:]) if name.startswith("structure:") else name for name in things]
        truth = (world or self.world).holds(
            predicate, *asked, viewer=None if viewer is None else viewer.asked
        )
        self.asked.append(Question(predicate, way, things, _said(truth), oracle, viewer, note))

    def pairs(self, predicate: str, viewer: Viewer | None = None) -> list[Pair]:
        """Pairs for a predicate: some of which it holds, some neighbours, and one from afar."""
        known = set(self.things)
        asked = None if viewer is None else viewer.asked
        true = [
            (a, b)
            for a, _, b in self.world.relations([predicate], viewer=asked)
            if a in known and b in known
        ]
        found = self.chosen(true, self.each)
        held = set(true)
        for _ in range(self.each * 12):
            if len(found) >= 2 * self.each or len(self.things) < 3:
                break
            a = self.things[int(self.rng.integers(len(self.things)))]
            if self.rng.random() < 0.75:
                close = sorted(
                    self.things, key=lambda b: float(np.abs(self.places[b] - self.places[a]).max())
                )[1:9]
                b = close[int(self.rng.integers(len(close)))]
            else:
                b = self.things[int(self.rng.integers(len(self.things)))]
            if a != b and (a, b) not in held:
                found.append((a, b))
        return found

    def two(self) -> None:
        """Predicates of two things that clouds tell."""
        scene = self.scene
        ways: dict[str, Callable[[Scene, str, str], Answer]] = {
            "near": near,
            "far": far,
            "above": above,
            "next_to": next_to,
            "under": under,
            "touching": touching,
            "taller_than": taller,
            "wider_than": wider,
            "larger_than": larger,
        }
        for predicate, oracle in ways.items():
            for a, b in self.pairs(predicate):
                self.ask(predicate, "cloud", (a, b), oracle(scene, a, b))
                if predicate == "above":
                    self.ask("below", "cloud", (b, a), oracle(scene, a, b))

    def beside_walls(self) -> None:
        """What stands along walls and other things."""
        names = {row["id"]: name for name, row in self.scene.rows.items()}
        walls = [
            (names[a], f"structure:{b}")
            for a, _, b in self.world.relation_array(["against"]).tolist()
            if names.get(a) in self.places and b not in names
        ]
        picked = self.chosen(walls, self.each)
        # Another thing, along a wall that is known.
        for _, wall in picked[:]:
            a = self.things[int(self.rng.integers(len(self.things)))]
            if (a, wall) not in walls:
                picked.append((a, wall))
        for a, b in (*picked, *self.pairs("against")):
            self.ask("against", "cloud", (a, b), against(self.scene, a, b))

    def rooms(self) -> None:
        """Where things are, and what is between others."""
        scene = self.scene
        names = [room["name"] for room in scene.rooms]
        for name in self.chosen(self.things, self.each):
            own = scene.rows[name]["room"]
            other = names[int(self.rng.integers(len(names)))]
            for room in {own, other}:
                self.ask("in_room", "floor", (name, f"room:{room}"), in_room(scene, name, room))
        for a, b in (self.chosen(names, 2) for _ in range(2 if len(names) > 1 else 0)):
            self.ask("larger_than", "floor", (f"room:{a}", f"room:{b}"), larger_room(scene, a, b))
        for name in self.chosen(self.things, 2 if len(scene.heights) > 1 else 0):
            for number in range(len(scene.heights)):
                answer = on_storey(scene, name, number)
                self.ask("on_storey", "floor", (name, f"storey:{number}"), answer)
        middles = [
            (a, room[5:])
            for a, _, room in self.world.relations(["in_middle_of"])
            if a in self.places
        ]
        others = [(name, scene.rows[name]["room"]) for name in self.chosen(self.things, 1)]
        for name, room in (*self.chosen(middles, 1), *others):
            answer = in_middle_of(scene, name, room)
            self.ask("in_middle_of", "floor", (name, f"room:{room}"), answer)
        done = 0
        for _ in range(60):
            if done >= self.each or len(self.things) < 3:
                break
            b, c = self.chosen(self.things, 2)
            way = self.places[c] - self.places[b]
            if scene.rows[b]["room"] != scene.rows[c]["room"] or np.linalg.norm(way) > 3.5:
                continue
            middle = (self.places[b] + self.places[c]) / 2
            close = sorted(
                (name for name in self.things if name not in (b, c)),
                key=lambda name: float(np.linalg.norm(self.places[name] - middle)),
            )
            a = close[int(self.rng.integers(min(3, len(close))))]
            # Half of what is asked holds; what does is rarer.
            if (self.world.holds("between", a, b, c) is True) != (done % 2 == 0):
                continue
            done += 1
            self.ask("between", "cloud", (a, b, c), between(scene, a, b, c))

    def _in_rooms(self, predicate: str, viewer: Viewer | None = None) -> list[Pair]:
        """Things and rooms: some for which a predicate holds, and as many others."""
        asked = None if viewer is None else viewer.asked
        held = [
            (a, room[5:])
            for a, _, room in self.world.relations([predicate], viewer=asked)
            if a in self.places
        ]
        names = [room["name"] for room in self.scene.rooms]
        others = [
            (name, self.scene.rows[name]["room"] if k % 3 else str(self.rng.choice(names)))
            for k, name in enumerate(self.chosen(self.things, 6 * self.each))
        ]
        known = set(held)
        found = self.chosen(held, self.each)
        return found + [pair for pair in others if pair not in known][: self.each]

    def ends(self, count: int = 2) -> None:
        """What is at ends of rooms, with and without somebody who looks from within them."""
        for viewer in (None, *self.viewers(count)):
            # Whoever looks is in one room; ends of others are as for nobody.
            pairs = self._in_rooms("at_end_of", viewer)
            if viewer is not None:
                here = next(
                    room["name"] for room in self.scene.rooms if tuple(room["eye"]) == viewer.eye
                )
                known: dict[bool, list[Pair]] = {True: [], False: []}
                for name in self.things:
                    if self.scene.rows[name]["room"] == here:
                        truth = self.world.holds(
                            "at_end_of", name, f"room:{here}", viewer=viewer.asked
                        )
                        known[truth is True].append((name, here))
                pairs = [pair for k in known for pair in self.chosen(known[k], self.each)]
            for name, room in pairs:
                answer = at_end_of(self.scene, name, room, viewer)
                way = "floor" if viewer is None else "floor, viewer"
                self.ask("at_end_of", way, (name, f"room:{room}"), answer, viewer)

    def closer(self) -> None:
        """What is closer to one thing than to another."""
        for k in range(2 * self.each if len(self.things) > 3 else 0):
            for _ in range(20):
                a = self.things[int(self.rng.integers(len(self.things)))]
                close = sorted(
                    (name for name in self.things if name != a),
                    key=lambda b: float(np.linalg.norm(self.places[b] - self.places[a])),
                )[:25]
                b, c = self.chosen(close if self.rng.random() < 0.8 else self.things, 2)
                if a in (b, c):
                    continue
                # Half of what is asked holds.
                if (self.world.holds("closer_to", a, b, c) is True) == (k % 2 == 0):
                    self.ask("closer_to", "cloud", (a, b, c), closer_to(self.scene, a, b, c))
                    break

    def across(self) -> None:
        """What is opposite to what, of kinds of which it is known if they have a front."""
        known = {name for name in self.things if is_known(name)}
        held = [
            (a, b)
            for a, _, b in self.world.relations(["opposite"])
            if a in known and b in known and a < b
        ]
        found = self.chosen(held, 2 * self.each)
        taken = set(held)
        for a in self.chosen(sorted(known), 12 * self.each):
            if len(found) >= 4 * self.each:
                break
            room = self.scene.rows[a]["room"]
            there = [b for b in sorted(known) if self.scene.rows[b]["room"] == room and b != a]
            for b in self.chosen(there, 1):
                if (min(a, b), max(a, b)) not in taken:
                    found.append((a, b))
        for k, (a, b) in enumerate(found):
            pair = (a, b) if k % 2 else (b, a)
            self.ask("opposite", "cloud", pair, opposite(self.scene, *pair))

    def outlooks(self) -> None:
        """What is seen from rooms, things and other rooms."""
        scene, outlook = self.scene, Outlook(self.scene)
        names = [room["name"] for room in scene.rooms]
        own: dict[str, str] = {name: scene.rows[name]["room"] for name in self.things}
        known: dict[tuple[bool, bool], list[Pair]] = {}
        for name in self.chosen(self.things, 40):
            for room in names:
                truth = self.world.holds("visible_from_room", name, f"room:{room}") is True
                known.setdefault((truth, own[name] == room), []).append((name, room))
        for key in ((True, True), (True, False), (False, True), (False, False)):
            # What is in a room is mostly seen from there: through doors is harder.
            for name, room in self.chosen(known.get(key, []), self.each if key[1] ^ key[0] else 1):
                answer = outlook.thing(name, room)
                self.ask("visible_from_room", "pixels", (name, f"room:{room}"), answer)
        rooms: dict[bool, list[Pair]] = {True: [], False: []}
        for a in names:
            for b in names:
                if a != b:
                    there = self.world.holds("visible_from_room", f"room:{a}", f"room:{b}")
                    rooms[there is True].append((a, b))
        for a, b in (*self.chosen(rooms[True], self.each), *self.chosen(rooms[False], self.each)):
            answer = outlook.room(a, b)
            self.ask("visible_from_room", "lines", (f"room:{a}", f"room:{b}"), answer)

    def viewers(self, count: int) -> list[Viewer]:
        """Places in rooms, looking anywhere."""
        found = []
        for room in self.chosen(self.scene.rooms, count):
            yaw = float(np.round(self.rng.uniform(-180, 180), 1))
            if self.rng.random() < 0.5:
                yaw = float(room["yaw_deg"])
            pitch = float(self.rng.choice((-25.0, -10.0, 0.0, 0.0, 15.0)))
            x, y, z = (float(v) for v in room["eye"])
            found.append(Viewer((x, y, z), yaw, pitch))
        return found

    def _plain(self, viewer: Viewer) -> list[str]:
        """Things that the viewer sees nearly all of."""
        found = []
        for name in self.chosen(self.things, 80):
            way = self.places[name] - viewer.place
            side, ahead = viewer.seen_from(way)
            if ahead > abs(side) * 0.4 and np.linalg.norm(way) < 7:
                glimpse = self.scene.glimpse(viewer.place, name)
                if glimpse.pixels >= 9 and glimpse.hidden <= 0.1 and not glimpse.cut:
                    found.append(name)
        return found

    def sides(self, count: int = 2) -> None:
        """Left, right, before, behind and visible for some viewers."""
        scene, said = self.scene, self.world
        for viewer in self.viewers(count):
            for predicate, converse, ways in (
                ("left_of", "right_of", {"mask": left_by_masks, "cloud": left_by_clouds}),
                ("in_front_of", "behind", {"mask": before_by_masks, "cloud": before_by_clouds}),
            ):
                plain = self._plain(viewer)
                seen_whole = set(plain)
                held = [
                    (a, b)
                    for a, _, b in said.relations([predicate], viewer=viewer.asked)
                    if a in seen_whole and b in seen_whole
                ]
                picked = {
                    "cloud": self.pairs(predicate, viewer),
                    "mask": self.chosen(held, self.each),
                }
                for _ in range(self.each if len(plain) > 2 else 0):
                    a, b = self.chosen(plain, 2)
                    picked["mask"].append((a, b))
                for way, oracle in ways.items():
                    for k, (a, b) in enumerate(picked[way]):
                        answer = oracle(scene, viewer, a, b)
                        note = ""
                        if predicate == "in_front_of" and answer == "no":
                            note = f"by boxes: {before_by_boxes(scene, viewer, a, b)}"
                        if k % 2 == 0:
                            self.ask(predicate, way, (a, b), answer, viewer, note=note)
                        else:
                            self.ask(converse, way, (b, a), answer, viewer, note=note)
            look = viewer.yaw_deg, viewer.pitch_deg
            known: dict[bool, list[str]] = {True: [], False: []}
            for name in self.things:
                if np.linalg.norm(self.places[name] - viewer.place) < 6:
                    truth = said.holds("visible", name, viewer=viewer.asked)
                    known[truth is True].append(name)
            for name in (*self.chosen(known[True], 2), *self.chosen(known[False], 2)):
                answer = seen(scene, viewer.place, name, look)
                self.ask("visible", "pixels", (name,), answer, viewer)

    def agent(self, *, reach: bool = True) -> None:
        """What an agent sees, faces and reaches."""
        scene = self.scene
        world = dwell.World(self.house, agents=1)
        room = self.chosen(scene.rooms, 1)[0]
        yaw = float(np.round(self.rng.uniform(-180, 180), 1))
        world.place_agent(room["stand"], yaw)
        agent = world.agents()[0]
        eye = np.array(agent["position"]) + np.array((0.0, agent["body"]["eye_height_m"], 0.0))
        viewer = Viewer((float(eye[0]), float(eye[1]), float(eye[2])), yaw, 0.0)
        close = [n for n in self.things if np.linalg.norm(self.places[n] - eye) < 8]
        for predicate in ("visible_from", "facing"):
            known: dict[bool, list[str]] = {True: [], False: []}
            for name in close:
                things = (name, "agent:0") if predicate == "visible_from" else ("agent:0", name)
                known[world.holds(predicate, *things) is True].append(name)
            for name in (*self.chosen(known[True], 2), *self.chosen(known[False], 2)):
                if predicate == "visible_from":
                    answer = seen(scene, eye, name, None)
                    self.ask(predicate, "pixels", (name, "agent:0"), answer, world=world)
                else:
                    here = room["name"]
                    answer = facing(scene, viewer, name, here)
                    self.ask(predicate, "cloud", ("agent:0", name), answer, world=world)
        # Turned to something, it is opposite to more.
        inside = [n for n in close if is_known(n) and scene.rows[n]["room"] == room["name"]]
        for name in self.chosen(inside, 1):
            way = self.places[name] - eye
            yaw = float(np.round(np.rad2deg(np.arctan2(-way[0], -way[2])), 1))
            world.place_agent(room["stand"], yaw)
            viewer = Viewer(viewer.eye, yaw, 0.0)
        known = {True: [], False: []}
        for name in inside:
            known[world.holds("opposite", "agent:0", name) is True].append(name)
        for name in (*self.chosen(known[True], self.each), *self.chosen(known[False], self.each)):
            radius = float(agent["body"]["radius_m"])
            answer = opposite_agent(scene, viewer, radius, name, room["name"])
            self.ask("opposite", "cloud, agent", ("agent:0", name), answer, world=world)
        if not reach:
            return
        walk = Walk(scene, agent)
        known = {True: [], False: []}
        for name in self.things:
            known[world.holds("reachable", name, "agent:0") is True].append(name)
        for name in (*self.chosen(known[True], 3), *self.chosen(known[False], 3)):
            self.ask("reachable", "map", (name, "agent:0"), walk.thing(name), world=world)
        for row in self.chosen(scene.rooms, 3):
            answer = walk.room(row["name"])
            self.ask(
                "reachable", "map, rooms", (f"room:{row['name']}", "agent:0"), answer, world=world
            )
        sure = [name for name in self.chosen(known[True], 4) if walk.thing(name) == "yes"]
        for name in self.chosen(sure, 1):
            truth = world.holds("reachable", name, "agent:0")
            answer = walk.walk_to(world, name)
            self.asked.append(
                Question("reachable", "walked", (name, "agent:0"), _said(truth), answer)
            )

    def support(self, count: int = 2) -> None:
        """On, in, supports and contains, by taking things out of the house."""
        physics = Physics(self.house)
        free = [name for name in physics.movable if name in self.places]
        known: dict[str, dict[str, str]] = {}
        for predicate in ("on", "in"):
            for a, _, b in self.world.relations([predicate]):
                if a in free and b in self.places:
                    known.setdefault(b, {})[a] = predicate
        bearers = [b for b in known if "on" in known[b].values()]
        holders = [b for b in known if "in" in known[b].values()]
        picked = {*self.chosen(bearers, count), *self.chosen(holders, 1)}
        for b in sorted(picked):
            moves = physics.without(b)
            true = [a for a in free if a in known[b] and a != b]
            low, high = self.scene.aim(b)
            by_way = sorted(
                (a for a in free if a not in known[b] and a != b),
                key=lambda a: float(
                    np.linalg.norm(
                        np.maximum(0, np.maximum(low - self.places[a], self.places[a] - high))
                    )
                ),
            )[:8]
            for a in (*self.chosen(true, 3), *self.chosen(by_way, 3)):
                carried, within = on_and_in(self.scene, physics, a, b, moves)
                if self.rng.random() < 0.7:
                    self.ask("on", "removal", (a, b), carried)
                    self.ask("in", "removal", (a, b), within)
                else:
                    self.ask("supports", "removal", (b, a), carried)
                    self.ask("contains", "removal", (b, a), within)
                belongs = belongs_to(self.scene, physics, a, b, moves)
                if self.rng.random() < 0.5:
                    self.ask("belongs_to", "removal", (a, b), belongs)
                else:
                    self.ask("has", "removal", (b, a), belongs)
        self.fixtures(physics)

    def fixtures(self, physics: Physics) -> None:
        """What belongs to walls, floors and ceilings, and cloth to windows."""
        names = {row["id"]: name for name, row in self.scene.rows.items()}
        held = [
            (names[a], b)
            for a, _, b in self.world.relation_array(["belongs_to"]).tolist()
            if a in names and b not in names
        ]
        hung = [(a, b) for a, b in held if a not in physics.movable]
        put = [(a, b) for a, b in held if a in physics.movable]
        picked = [*self.chosen(hung, 2 * self.each), *self.chosen(put, self.each)]
        pieces = sorted({b for _, b in held})
        known = set(held)
        for a, _ in picked[:]:
            b = pieces[int(self.rng.integers(len(pieces)))]
            if (a, b) not in known:
                picked.append((a, b))
        # What stands along a wall does not belong to it.
        beside = [
            (names[a], b)
            for a, _, b in self.world.relation_array(["against"]).tolist()
            if a in names and b not in names and (names[a], b) not in known
        ]
        for a, b in (*picked, *self.chosen(beside, self.each)):
            answer = belongs_to_building(self.scene, physics, a, b)
            self.ask("belongs_to", "building", (a, f"structure:{b}"), answer)
        windows = [name for name in self.scene.rows if name.startswith("window")]
        cloths = [name for name in self.things if name.startswith(("curtain", "blind"))]
        for a in self.chosen(cloths, 1):
            close = sorted(
                windows,
                key=lambda name: float(
                    np.linalg.norm(np.array(self.scene.rows[name]["center"]) - self.places[a])
                ),
            )
            for window in close[:2]:
                answer = hangs_at_window(self.scene, a, window)
                if self.rng.random() < 0.5:
                    self.ask("belongs_to", "window", (a, window), answer)
                else:
                    self.ask("has", "window", (window, a), answer)

    def doors(self) -> None:
        """Open and closed, by scans of all places of a joint."""
        names = sorted({row["object"] for row in self.world.joints()})
        wide_open = [name for name in names if self.world.holds("open", name) is True]
        for name in dict.fromkeys((*self.chosen(wide_open, 1), *self.chosen(names, 2))):
            part = openness(self.world, name)
            if part is None:
                continue
            wide: Answer = "grey" if part == 0.5 else "yes" if part > 0.5 else "no"
            self.ask("open", "scan", (name,), wide)
            self.ask("closed", "scan", (name,), "yes" if part == 0 else "no")

    def counts(self) -> None:
        """How many there are of a kind: ids in a sweep of pictures from above."""
        seen_ids = self.scene.slices(0.2, 0.04)
        classes: dict[str, set[int]] = {}
        names = self.house.semantic_classes("fine")
        rows = {
            row["id"]: self.world.attributes(row["name"])["category"]
            for row in self.scene.rows.values()
        }
        for number, name in rows.items():
            if number in seen_ids:
                classes.setdefault(name, set()).add(number)
        alone = [
            name
            for name in classes
            if not any(other != name and other.endswith(name) for other in names)
        ]
        for name in self.chosen(sorted(alone), 3):
            noun = name.replace("_", " ")
            try:
                said = self.world.check(f"How many {noun}s are there?")["answer"]["number"]
            except dwell.ConfigError:
                continue
            count = len(classes[name])
            # What lies in shut cupboards may fall between the pictures.
            hidden = any(number not in seen_ids for number in rows)
            answer: Answer = "yes" if said == count else "grey" if hidden else "no"
            self.asked.append(
                Question("count", "sweep", (name, str(said), str(count)), "yes", answer)
            )

    def all(self, *, reach: bool = True, sweep: bool = True, viewers: int = 2) -> list[Question]:
        """Asks everything; ``reach`` takes a map of a storey, ``sweep`` counts things."""
        self.two()
        self.beside_walls()
        self.rooms()
        self.ends(viewers)
        self.closer()
        self.across()
        self.outlooks()
        self.sides(viewers)
        self.support(viewers)
        self.doors()
        self.agent(reach=reach)
        if sweep:
            self.counts()
        return self.asked
