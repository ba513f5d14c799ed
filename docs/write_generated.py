"""Writes what is generated from the engine's tables; with --check says what is stale instead."""

from __future__ import annotations

import sys

from pages import generated
from pages.sources import ROOT


def main() -> int:
    """Writes or checks."""
    if sys.argv[1:] == ["--check"]:
        stale = generated.stale()
        for path in stale:
            sys.stderr.write(f"{path} is stale: run .venv/bin/python docs/write_generated.py\n")
        return 1 if stale else 0
    for path, content in generated.files().items():
        (ROOT / path).write_text(content, "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
