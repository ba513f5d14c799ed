"""A person teaches a robot the things on a table: clips that point, show and speak, with labels.

``dwell record teach`` writes them; ``docs/teach.md`` has the layout and what each number means.
"""

from __future__ import annotations

from dwell.teach.dataset import Clip, record
from dwell.teach.reading import RecordedClip, recorded_clips
from dwell.teach.settings import TeachSettings
from dwell.teach.users import UserParameters, user_parameters

__all__ = [
    "Clip",
    "RecordedClip",
    "TeachSettings",
    "UserParameters",
    "record",
    "recorded_clips",
    "user_parameters",
]
