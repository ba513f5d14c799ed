"""Predicates, relations and attributes of the things of a world."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import (
    finite_number,
    integer_in_range,
    point,
    quoted,
    sequence_items,
    text,
    text_list,
)
from dwell.object_state_api import StateApi

#: A thing by its name or its id in instance images; ``"room:NAME"``, ``"storey:0"``,
#: ``"agent:0"`` and ``"part:OBJECT/PART"`` for the rest.
Thing = str | int
#: Who looks: an agent by its number, or a camera's ``position``, ``yaw_deg`` and ``pitch_deg``.
Viewer = int | Mapping[str, Any]


class RelationApi(StateApi):
    """Predicates, relations and attributes of a world, as it is now."""

    _native: _native.World

    def holds(self, name: str, *things: Thing, viewer: Viewer | None = None) -> bool | None:
        """Returns whether a predicate holds; :func:`dwell.relations.predicates` lists them.

        Args:
            name: The predicate's name.
            things: One to three things, the subject first: by name or by id in instance images; a
                room as ``"room:NAME"`` (names as in :meth:`House.rooms`), a storey as
                ``"storey:0"``, an agent as ``"agent:0"``, a part as ``"part:OBJECT/PART"``.
            viewer: Who looks, for left, right, front and behind: an agent's number, or a mapping
                with ``position`` (m), ``yaw_deg`` and ``pitch_deg`` of a camera.

        Returns:
            ``None`` where it cannot be asked of these things here; :meth:`why_undecided` says why.

        Raises:
            ConfigError: There is no such predicate, thing or viewer.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> world.holds("in_room", "radio_1", "room:child_room")
            True
            >>> world.holds("open", "radio_1") is None
            True
        """
        return self._truth(name, things, viewer)[0]

    def why_undecided(self, name: str, *things: Thing, viewer: Viewer | None = None) -> str | None:
        """The reason why :meth:`holds` is ``None``, as a sentence; ``None`` where it is not.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> world.why_undecided("open", "radio_1")
            'It does not open.'
        """
        return self._truth(name, things, viewer)[1]

    def _truth(
        self, name: str, things: Sequence[Thing], viewer: Viewer | None
    ) -> tuple[bool | None, str | None]:
        named = [thing_argument("things", thing) for thing in things]
        return _native.world_holds(self._native, text("name", name), named, viewer_argument(viewer))

    def relations(
        self, names: Sequence[str] | None = None, *, viewer: Viewer | None = None
    ) -> list[tuple[str, str, str]]:
        """The relations that hold of objects and agents: subject, predicate, object, by name.

        Args:
            names: Predicates of two things; all that are ``listed`` by default, with a viewer also
                the sides from there.
            viewer: As of :meth:`holds`. Sides are told of the 1,000 things nearest before it.

        Raises:
            ConfigError: There is no such predicate of two things, or it needs a viewer.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> [row for row in world.relations(["in_room"]) if row[0] == "radio_1"]
            [('radio_1', 'in_room', 'room:child_room')]
        """
        wanted = None if names is None else text_list("names", names)
        return _native.world_relations(self._native, wanted, viewer_argument(viewer))

    def relation_array(
        self, names: Sequence[str] | None = None, *, viewer: Viewer | None = None
    ) -> NDArray[np.int32]:
        """As :meth:`relations`, by number: shape (relation, 3), of subject, predicate, object.

        Things have their ids in instance images; rooms are -1, -2 and so on in the order of
        :meth:`House.rooms`, storeys -1001, -1002 and so on. A predicate has its place in
        :func:`dwell.relations.predicates`.
        """
        wanted = None if names is None else text_list("names", names)
        return _native.world_relation_array(self._native, wanted, viewer_argument(viewer))

    def select(
        self,
        order: str,
        things: Sequence[Thing],
        n: int = 1,
        *,
        reference: Thing | None = None,
        viewer: Viewer | None = None,
    ) -> str | None:
        """The n-th of things in an order, such as ``from_left``; by name.

        Args:
            order: A name of :func:`dwell.relations.orders`.
            things: Those among which is chosen.
            n: The place, counted from 1.
            reference: To what distances are measured, for ``closest_to`` and ``farthest_from``.
            viewer: As of :meth:`holds`.

        Returns:
            ``None`` where there are fewer, where neighbours in the order differ too little to be
            told apart, and without the viewer or reference that it needs.

        Raises:
            ConfigError: There is no such order, thing or viewer.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> world.select("largest", ["radio_1", "refrigerator_1"])
            'refrigerator_1'
        """
        rows = sequence_items("things", things, "expected a list of names or ids of things")
        named = [thing_argument("things", thing) for thing in rows]
        compared = None if reference is None else thing_argument("reference", reference)
        place = integer_in_range("n", n, low=1, high=2**31 - 1)
        found: tuple[str | None, str | None] = _native.world_select(
            self._native, text("order", order), named, place, compared, viewer_argument(viewer)
        )
        return found[0]

    def attributes(self, thing: Thing) -> dict[str, Any]:
        """The attributes of an object.

        Returns:
            ``id``, ``name``, ``noun``; ``category``, its row in the table of categories, with
            ``synset`` (a name of WordNet 3.0), ``nyu40_id`` and ``nyu40_name``; ``colors`` (spoken
            words) and ``substances`` with their shares, largest first; ``pattern``: ``striped``,
            ``checked``, ``patterned`` or ``None``; ``size`` for its kind:
            ``tiny``, ``small``, ``normal``, ``large`` or ``huge``; ``center`` and ``extents`` of
            its box, m; ``room`` and ``storey``, counted from 0; ``openness`` (0 to 1),
            ``switched_on`` and ``held_by``, or ``None``.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> row = world.attributes("radio_1")
            >>> row["synset"], row["switched_on"]
            ('radio_receiver.n.01', False)
        """
        found: dict[str, Any] = _native.world_attributes(
            self._native, thing_argument("thing", thing)
        )
        return found

    def color_names(self, thing: Thing, vocabulary: int = 16) -> list[tuple[str, float]]:
        """The names of an object's colours with their shares of what is seen of it.

        Args:
            thing: Its name, or its id.
            vocabulary: How many names there are: 12 plain words, the 16 of HTML 4, the 139 colours
                that CSS names, or the 949 names of the xkcd colour survey.

        Returns:
            The largest share first; empty for what is nearly all clear glass or mirror.
        """
        count = integer_in_range("vocabulary", vocabulary)
        return _native.world_color_names(self._native, thing_argument("thing", thing), count)

    def scene_graph(self, *, viewer: Viewer | None = None) -> dict[str, Any]:
        """Storeys, rooms, objects and agents as nodes, relations as edges.

        Returns:
            ``storeys``, ``rooms``, ``objects`` and ``agents``: a list of mappings each;
            ``relations``: mappings with ``subject``, ``predicate`` and ``object``, the ids of
            instance images, or the number of a room or storey for predicates that lead to those
            alone. :mod:`dwell.relations` makes arrays and NetworkX graphs of it.
        """
        graph: dict[str, Any] = json.loads(
            _native.world_graph_json(self._native, viewer_argument(viewer))
        )
        return graph


def thing_argument(name: str, thing: object) -> Thing:
    """A name or an id.

    Raises:
        ConfigError: It is neither.
    """
    if not isinstance(thing, str):
        return _whole_or(name, thing, "names")
    kind, colon, number = text(name, thing).partition(":")
    if colon and kind in ("agent", "storey") and not re.fullmatch("0|[1-9][0-9]{0,8}", number):
        raise ConfigError(f"{name} is {quoted(thing)}; expected a number from 0, as {kind}:0")
    return thing


def _whole_or(name: str, value: object, other: str) -> int:
    """An id or a number; what else is allowed stands in the error, too."""
    try:
        return integer_in_range(name, value, high=2**31 - 1)
    except ConfigError as error:
        raise ConfigError(f"{error}, and {other}") from None


def viewer_argument(viewer: object) -> int | dict[str, Any] | None:
    """The viewer in the form that the native side takes.

    Raises:
        ConfigError: It is neither an agent's number nor a camera's place.
    """
    if viewer is None:
        return None
    if not isinstance(viewer, Mapping):
        return _whole_or("viewer", viewer, "mappings with position, yaw_deg and pitch_deg")
    unknown = [key for key in viewer if key not in ("position", "yaw_deg", "pitch_deg")]
    if unknown or "position" not in viewer:
        raise ConfigError(
            f"viewer is {quoted(dict(viewer))}; expected an agent's number, or a mapping with "
            "position, and if wanted yaw_deg and pitch_deg"
        )
    return {
        "position": list(point("viewer position", viewer["position"])),
        "yaw_deg": finite_number("viewer yaw_deg", viewer.get("yaw_deg", 0.0)),
        "pitch_deg": finite_number("viewer pitch_deg", viewer.get("pitch_deg", 0.0)),
    }
