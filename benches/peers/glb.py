"""Reads the triangles of a GLB that dwell wrote: one part a material, in the house's frame, +Y up.

Only what ``House.write(..., "glb")`` uses: float positions, normals and texture coordinates, index
lists, plain nodes in a tree, PNG images inside the file, one base colour and texture a material
with ``KHR_texture_transform``.
"""

from __future__ import annotations

import io
import json
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]

_SHAPES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}


@dataclass
class Part:
    """All triangles of one material.

    Attributes:
        positions: Shape (vertex, 3), m.
        normals: Shape (vertex, 3).
        uv: Shape (vertex, 2), from the upper left corner of the image.
        triangles: Shape (triangle, 3), vertices.
        color: Linear base colour with opacity, shape (4,); the texture is multiplied by it.
        image: A PNG file's bytes, or none.
    """

    positions: Floats
    normals: Floats
    uv: Floats
    triangles: NDArray[np.uint32]
    color: Floats
    image: bytes | None

    def mean_srgb(self) -> Floats:
        """The colour without its pattern: sRGB with opacity, 0 to 1, shape (4,)."""
        linear = self.color[:3].copy()
        if self.image is not None:
            from PIL import Image

            with Image.open(io.BytesIO(self.image)) as file:
                pixels = np.asarray(file.convert("RGB"), np.float32) / 255.0
            linear *= _linear(pixels).reshape(-1, 3).mean(0)
        return np.append(_srgb(linear), self.color[3]).astype(np.float32)


def _linear(srgb: Floats) -> Floats:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _srgb(linear: Floats) -> Floats:
    curve = 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, linear * 12.92, curve)


class _File:
    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        (length,) = struct.unpack_from("<I", data, 12)
        self.json: dict[str, Any] = json.loads(data[20 : 20 + length])
        self.binary = data[20 + length + 8 :]

    def view(self, index: int) -> bytes:
        view = self.json["bufferViews"][index]
        start = view.get("byteOffset", 0)
        return self.binary[start : start + view["byteLength"]]

    def accessor(self, index: int) -> NDArray[Any]:
        accessor = self.json["accessors"][index]
        width = _SHAPES[accessor["type"]]
        numbers = np.frombuffer(
            self.view(accessor["bufferView"]),
            _TYPES[accessor["componentType"]],
            accessor["count"] * width,
            accessor.get("byteOffset", 0),
        )
        return numbers.reshape(-1, width)


def _local(node: dict[str, Any]) -> NDArray[np.float64]:
    """parent_from_node."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0.0, 0.0, 0.0, 1.0))
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    out = np.eye(4)
    out[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)))
    out[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return out


def read(path: Path) -> list[Part]:
    """The parts of a house, by material."""
    file = _File(path)
    pieces: dict[int, list[tuple[NDArray[Any], ...]]] = {}
    open_nodes = [
        (root, np.eye(4)) for root in file.json["scenes"][file.json["scene"]]["nodes"]
    ]
    while open_nodes:
        index, parent = open_nodes.pop()
        node = file.json["nodes"][index]
        world = parent @ _local(node)
        open_nodes += [(child, world) for child in node.get("children", [])]
        if "mesh" not in node:
            continue
        for primitive in file.json["meshes"][node["mesh"]]["primitives"]:
            names = primitive["attributes"]
            positions = (
                file.accessor(names["POSITION"]) @ world[:3, :3].T + world[:3, 3]
            )
            normals = file.accessor(names["NORMAL"]) @ np.linalg.inv(world[:3, :3])
            uv = file.accessor(names["TEXCOORD_0"])
            triangles = file.accessor(primitive["indices"]).reshape(-1, 3)
            piece = (positions, normals, uv, triangles)
            pieces.setdefault(primitive["material"], []).append(piece)
    return [_part(file, material, pieces[material]) for material in sorted(pieces)]


def _part(file: _File, material: int, pieces: list[tuple[NDArray[Any], ...]]) -> Part:
    look = file.json["materials"][material].get("pbrMetallicRoughness", {})
    positions, normals, uv = (
        np.concatenate([piece[k] for piece in pieces]) for k in range(3)
    )
    firsts = np.cumsum([0] + [len(piece[0]) for piece in pieces])
    triangles = [
        piece[3] + first for piece, first in zip(pieces, firsts[:-1], strict=True)
    ]
    image = None
    if (texture := look.get("baseColorTexture")) is not None:
        source = file.json["textures"][texture["index"]]["source"]
        image = file.view(file.json["images"][source]["bufferView"])
        moved = texture.get("extensions", {}).get("KHR_texture_transform", {})
        uv = uv * np.array(moved.get("scale", (1, 1))) + np.array(
            moved.get("offset", (0, 0))
        )
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return Part(
        positions=positions.astype(np.float32),
        normals=(normals / np.where(length > 0, length, 1)).astype(np.float32),
        uv=uv.astype(np.float32),
        triangles=np.concatenate(triangles).astype(np.uint32),
        color=np.array(look.get("baseColorFactor", (1, 1, 1, 1)), np.float32),
        image=image,
    )
