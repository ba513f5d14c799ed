"""Random streams by name: what is drawn for one clip does not depend on the others."""

from __future__ import annotations

import zlib

import numpy as np


def stream(seed: int, *names: str | int) -> np.random.Generator:
    """The stream of a name below a seed; other names have streams of their own."""
    words = [zlib.crc32(f"{type(name).__name__}:{name}".encode()) for name in names]
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, *words])))
