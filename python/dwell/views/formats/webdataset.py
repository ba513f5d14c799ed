"""WebDataset: tar shards in which the files of a view stand side by side."""

from __future__ import annotations

import contextlib
import io
import json
import tarfile
from pathlib import Path

from dwell.views.stored import picture_bytes, records

#: Views of a shard.
_VIEWS = 1000


def write(folder: Path, out: Path) -> None:
    """Writes ``SPLIT-000000.tar`` and so on: ``ID.rgb.png``, ``ID.depth.png`` ..., ``ID.json``.

    Equal data sets give equal bytes.
    """
    tars: dict[str, tarfile.TarFile] = {}
    counts: dict[str, int] = {}
    with contextlib.ExitStack() as stack:
        for row, house in records(folder):
            split = row["split"]
            number = counts.get(split, 0)
            if number % _VIEWS == 0:
                if split in tars:
                    tars[split].close()
                path = out / f"{split}-{number // _VIEWS:06}.tar"
                opened = tarfile.open(path, "w", format=tarfile.USTAR_FORMAT)  # noqa: SIM115
                tars[split] = stack.enter_context(opened)
            counts[split] = number + 1
            for kind, name in row["images"].items():
                _add(tars[split], f"{row['id']}.{kind}.png", picture_bytes(house, name))
            text = json.dumps(row, ensure_ascii=False).encode()
            _add(tars[split], f"{row['id']}.json", text)


def _add(tar: tarfile.TarFile, name: str, content: bytes) -> None:
    member = tarfile.TarInfo(name)
    member.size = len(content)
    tar.addfile(member, io.BytesIO(content))
