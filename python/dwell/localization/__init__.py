"""Localization of sounds: recordings with labels, DCASE's measures, and baselines.

``docs/localization.md`` describes them.
"""

from __future__ import annotations

from dwell.localization.baselines import BASELINES
from dwell.localization.dataset import DatasetMaker
from dwell.localization.labels import Label, read_labels, write_labels
from dwell.localization.layouts import PRESETS, Layout
from dwell.localization.measures import JointMeasures
from dwell.localization.settings import Settings

__all__ = [
    "BASELINES",
    "PRESETS",
    "DatasetMaker",
    "JointMeasures",
    "Label",
    "Layout",
    "Settings",
    "read_labels",
    "write_labels",
]
