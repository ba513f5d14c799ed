"""Forms of data sets that trainers read. One file a form, and one line here.

The module of a form has ``write(folder, out)``: it writes what a data set holds into an empty
folder.
"""

from __future__ import annotations

import importlib
from pathlib import Path

from dwell.files import atomic_folder

#: Form and what it is; the module of that name writes it.
FORMS = {
    "jsonl": "JSON Lines by split, images as paths",
    "parquet": "Parquet by split, pictures inside (extra data)",
    "webdataset": "tar shards by split, images and JSON of each view side by side",
    "coco": "COCO: instances, panoptic with PNGs, captions, by split",
    "refcoco": "referring expressions as RefCOCO has them, with COCO's instances",
    "huggingface": "a folder that datasets.load_dataset reads, with a card",
}


def export(folder: Path, out: Path, form: str) -> None:
    """Writes a data set of views in another form, whole or not at all.

    Args:
        folder: The data set.
        out: A folder that is not there yet.
        form: A name of :data:`FORMS`.

    Raises:
        FileExistsError: ``out`` is there.
        FileNotFoundError: ``folder`` holds no records.
        ModuleNotFoundError: The form needs an extra that is not installed.
        ValueError: There is no such form.
    """
    if form not in FORMS:
        raise ValueError(f"form is {form!r}; allowed are {', '.join(FORMS)}")
    module = importlib.import_module(f"dwell.views.formats.{form}")
    with atomic_folder(out) as draft:
        module.write(folder, draft)
