"""Files of the parts of a data set, opened when the first record of a part comes."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from typing_extensions import Self


class SplitFiles:
    """One file for each part: ``train``, ``val``, ``test``."""

    def __init__(self, out: Path, ending: str) -> None:
        """Files ``SPLIT`` + ``ending`` in ``out``."""
        self._out, self._ending = out, ending
        self._files: dict[str, IO[bytes]] = {}

    def of(self, split: str) -> IO[bytes]:
        """The file of a part, to write to."""
        if split not in self._files:
            self._files[split] = (self._out / f"{split}{self._ending}").open("wb")
        return self._files[split]

    def __enter__(self) -> Self:
        """Closes all files at the end."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Closes all files."""
        for file in self._files.values():
            file.close()
