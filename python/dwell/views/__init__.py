"""Views of houses with words: records of pictures, captions, expressions, relations, questions.

``docs/views.md`` has the form of records and data sets.
"""

from __future__ import annotations

from dwell.views.cameras import HeldCamera, held_cameras
from dwell.views.dataset import ViewSettings, house_records, make, records
from dwell.views.record import ViewRecord, view_record

__all__ = [
    "HeldCamera",
    "ViewRecord",
    "ViewSettings",
    "held_cameras",
    "house_records",
    "make",
    "records",
    "view_record",
]
