"""Grids of impulse responses, for those who train on recorded ones: the data and its files."""

from __future__ import annotations

from dwell.responses.dataset import Dataset
from dwell.responses.hdf5 import write_hdf5
from dwell.responses.sofa import write_sofa

__all__ = ["Dataset", "write_hdf5", "write_sofa"]
