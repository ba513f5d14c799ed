"""Masks as COCO has them: run lengths of columns, counted or as text, and boxes."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["box", "decode_rle", "encode_rle", "run_lengths"]


def box(mask: NDArray[np.bool_]) -> list[int]:
    """The box around the pixels of a mask: first column, first row, width, height.

    Args:
        mask: Shape (height, width).

    Returns:
        Four zeros for a mask without pixels.
    """
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return [0, 0, 0, 0]
    left, top = int(columns[0]), int(rows[0])
    return [left, top, int(columns[-1]) - left + 1, int(rows[-1]) - top + 1]


def encode_rle(mask: NDArray[np.bool_]) -> dict[str, Any]:
    """A mask of shape (height, width) as COCO's compressed run lengths.

    Returns:
        ``size`` (height, width) and ``counts``, text: the lengths of runs of 0 and 1 in turn, down
        the columns, the first of 0.

    Examples:
        >>> import numpy as np
        >>> from dwell.views.masks import decode_rle, encode_rle
        >>> mask = np.eye(3, dtype=bool)
        >>> encode_rle(mask)
        {'size': [3, 3], 'counts': '013000'}
        >>> bool((decode_rle(encode_rle(mask)) == mask).all())
        True
    """
    flat = np.asarray(mask, bool).ravel(order="F")
    edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    bounds = np.concatenate(([0], edges, [len(flat)]))
    counts = np.diff(bounds).tolist() if len(flat) else []
    if len(flat) and flat[0]:
        counts.insert(0, 0)
    return {"size": [int(mask.shape[0]), int(mask.shape[1])], "counts": _text_of(counts)}


def decode_rle(rle: dict[str, Any]) -> NDArray[np.bool_]:
    """The mask, shape (height, width), of what :func:`encode_rle` gives."""
    height, width = rle["size"]
    counts = run_lengths(rle["counts"])
    values = np.arange(len(counts)) % 2 == 1
    return np.repeat(values, counts).reshape((height, width), order="F")


def _text_of(counts: list[int]) -> str:
    """Counts as text: each from the third on less the one two before it, in groups of five bits.

    Source: the format of masks of the COCO data set (``rleToString`` of its interface).
    """
    letters = []
    for k, count in enumerate(counts):
        rest = count - counts[k - 2] if k > 2 else count
        while True:
            group = rest & 0x1F
            rest >>= 5
            more = rest != (-1 if group & 0x10 else 0)
            letters.append(chr((group | 0x20 if more else group) + 48))
            if not more:
                break
    return "".join(letters)


def run_lengths(text: str) -> list[int]:
    """The lengths of runs that a text of :func:`encode_rle` holds.

    Raises:
        ValueError: It is none of run lengths.
    """
    if not re.fullmatch("(?:[P-o]{0,6}[0-O])*", text):
        raise ValueError("no run lengths")
    counts: list[int] = []
    at = 0
    while at < len(text):
        value = shift = 0
        while True:
            group = ord(text[at]) - 48
            at += 1
            value |= (group & 0x1F) << shift
            shift += 5
            if not group & 0x20:
                break
        if group & 0x10:
            value -= 1 << shift
        counts.append(value + counts[-2] if len(counts) > 2 else value)
    return counts
