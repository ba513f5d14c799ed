"""The predicates, the orders, and scene graphs in other forms."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import integer_in_range, mapping, point, quoted

if TYPE_CHECKING:
    import networkx

#: The lists of a scene graph.
_LISTS = ("storeys", "rooms", "objects", "agents", "relations")
#: The kinds of nodes in arrays, by their numbers.
NODE_KINDS = ("storey", "room", "object", "agent", "structure")


def predicates() -> list[dict[str, Any]]:
    """Every predicate; its place in the list is its number in :meth:`World.relation_array`.

    Returns:
        ``name``; ``places``: the kinds of things that each of its one to three places takes;
        ``definition`` and ``source``; ``laws``: what always holds of it; ``needs_viewer``: whether
        it is meant from somebody's place; ``listed``: whether :meth:`World.relations` has it
        unasked.

    Examples:
        >>> import dwell.relations
        >>> [row["name"] for row in dwell.relations.predicates()][:3]
        ['in_room', 'room_contains', 'on_storey']
    """
    rows: list[dict[str, Any]] = json.loads(_native.predicates_json())["predicates"]
    return rows


def orders() -> list[dict[str, Any]]:
    """Every order out of which :meth:`World.select` chooses.

    Returns:
        ``name``, ``definition``, ``source``; ``margin``: the least difference by which neighbours
        must differ; ``needs_viewer`` and ``needs_reference``.
    """
    rows: list[dict[str, Any]] = json.loads(_native.predicates_json())["orders"]
    return rows


def graph_arrays(
    graph: Mapping[str, Any], *, nodes: int = 512, edges: int = 4096
) -> dict[str, NDArray[Any]]:
    """A scene graph as arrays of fixed size.

    Args:
        graph: From :meth:`World.scene_graph`.
        nodes: How many rows the arrays of nodes have.
        edges: How many rows the array of edges has.

    Returns:
        ``node_kind``, int32 (nodes,): a place in ``NODE_KINDS``. ``node_id``, int32 (nodes,): the
        id in instance images, or the number of a room or storey. ``node_room`` and
        ``node_storey``, int32 (nodes,). ``node_nyu40``, int32 (nodes,). ``node_center`` and
        ``node_size``, float32 (nodes, 3), m; zeros for storeys and rooms. ``edges``, int32
        (edges, 3): row of the subject's node, number of the predicate, row of the object's node.
        ``node_count`` and ``edge_count``, int32 (). Rows beyond them, and what a node has not, are
        -1 (zeros of places).

    Raises:
        ConfigError: It is no scene graph, or has more nodes or edges than there are rows.
    """
    room = integer_in_range("nodes", nodes, low=1, high=10**6)
    wide = integer_in_range("edges", edges, low=1, high=10**8)
    rows, found = _parts(graph)
    for name, count, most in (("nodes", len(rows), room), ("edges", len(found), wide)):
        if count > most:
            raise ConfigError(f"{name} is {most}; this graph has {count}")
    arrays: dict[str, NDArray[Any]] = {
        f"node_{name}": np.full(room, -1, np.int32)
        for name in ("kind", "id", "room", "storey", "nyu40")
    }
    arrays |= {f"node_{name}": np.zeros((room, 3), np.float32) for name in ("center", "size")}
    for k, row in enumerate(rows):
        for name, value in row.items():
            if value is not None and name != "name":
                arrays[f"node_{name}"][k] = value
    arrays["edges"] = np.full((wide, 3), -1, np.int32)
    if found:
        arrays["edges"][: len(found)] = found
    arrays["node_count"] = np.array(len(rows), np.int32)
    arrays["edge_count"] = np.array(len(found), np.int32)
    return arrays


def to_networkx(graph: Mapping[str, Any]) -> networkx.MultiDiGraph[str]:
    """A scene graph for NetworkX (``pip install 'dwell[graph]'``).

    Nodes are called as in :meth:`World.holds` (``"radio_1"``, ``"room:0"`` by number,
    ``"storey:0"``, ``"agent:0"``, ``"structure:12"``) with their mappings as attributes; edges have
    the predicate as key.

    Raises:
        ImportError: NetworkX is not installed.
        ConfigError: It is no scene graph.
    """
    import networkx

    rows, edges = _parts(graph)
    made: networkx.MultiDiGraph[str] = networkx.MultiDiGraph()
    names = [str(row["name"]) for row in rows]
    told = (*graph["storeys"], *graph["rooms"], *graph["objects"], *graph["agents"])
    for k, (name, row) in enumerate(zip(names, rows, strict=True)):
        attributes = told[k] if k < len(told) else {}
        made.add_node(name, kind=NODE_KINDS[row["kind"]], **attributes)
    labels = [row["name"] for row in predicates()]
    for subject, code, target in edges:
        made.add_edge(names[subject], names[target], key=labels[code])
    return made


def _parts(graph: object) -> tuple[list[dict[str, Any]], list[tuple[int, int, int]]]:
    """The nodes of a graph, and its edges by the places of their nodes and predicates.

    Raises:
        ConfigError: It is no scene graph.
    """
    expected = "a scene graph as World.scene_graph gives it"
    found = mapping("graph", graph, expected)
    for name in _LISTS:
        rows = found.get(name)
        if not isinstance(rows, list) or not all(isinstance(row, Mapping) for row in rows):
            raise ConfigError(f"graph.{name} is {quoted(rows)}; expected {expected}")
    try:
        nodes, index = _nodes(found)
        return nodes, _edges(found, index)
    except (KeyError, TypeError, ValueError) as error:
        if isinstance(error, ConfigError):
            raise
        told = f"no {error}" if isinstance(error, KeyError) else str(error)
        raise ConfigError(f"graph: {told}; expected {expected}") from None


def _nodes(graph: Mapping[str, Any]) -> tuple[list[dict[str, Any]], dict[tuple[int, int], int]]:
    """The nodes of a graph in one row, and their places by kind and number."""
    rows: list[dict[str, Any]] = [
        {"kind": 0, "id": row["storey"], "name": f"storey:{row['storey']}"}
        for row in graph["storeys"]
    ]
    rows += [
        {"kind": 1, "id": row["room"], "storey": row["storey"], "name": f"room:{row['room']}"}
        for row in graph["rooms"]
    ]
    rows += [
        {
            "kind": 2,
            "id": row["id"],
            "name": row["name"],
            "room": row["room"],
            "storey": row["storey"],
            "nyu40": row["nyu40_id"],
            "center": point(f"graph: center of {quoted(row['name'])}", row["center"]),
            "size": point(f"graph: extents of {quoted(row['name'])}", row["extents"]),
        }
        for row in graph["objects"]
    ]
    rows += [
        {
            "kind": 3,
            "id": row["id"],
            "name": f"agent:{row['agent']}",
            "room": row["room"],
            "storey": row["storey"],
            "center": point("graph: position of an agent", row["position"]),
        }
        for row in graph["agents"]
    ]
    known = {row["id"] for row in rows if row["kind"] in (2, 3)}
    pieces = {
        edge["object"] for edge in graph["relations"] if not _place_kinds()[edge["predicate"]]
    }
    rows += [
        {"kind": 4, "id": piece, "name": f"structure:{piece}"} for piece in sorted(pieces - known)
    ]
    return rows, {(min(row["kind"], 2), row["id"]): k for k, row in enumerate(rows)}


@cache
def _place_kinds() -> dict[str, str]:
    """To what a predicate leads where that is a room or a storey alone, else no text."""
    found: dict[str, str] = {}
    for row in predicates():
        kinds = row["places"][1] if len(row["places"]) == 2 else []
        found[row["name"]] = kinds[0] if kinds in (["room"], ["storey"]) else ""
    return found


def _edges(
    graph: Mapping[str, Any], index: Mapping[tuple[int, int], int]
) -> list[tuple[int, int, int]]:
    """The edges of a graph by the places of their nodes and predicates."""
    codes = {row["name"]: k for k, row in enumerate(predicates())}
    kinds = _place_kinds()
    numbers = {"storey": 0, "room": 1, "": 2}
    return [
        (
            index[2, edge["subject"]],
            codes[edge["predicate"]],
            index[numbers[kinds[edge["predicate"]]], edge["object"]],
        )
        for edge in graph["relations"]
    ]
