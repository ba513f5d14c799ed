"""The examples in the package's docstrings run."""

from __future__ import annotations

import doctest
import importlib
import importlib.util
import pkgutil
from pathlib import Path

import pytest

import dwell

pytestmark = pytest.mark.usefixtures("open_once")


def modules() -> list[str]:
    """Every module of the package in whose source an example stands."""
    found = ["dwell"]
    found += [row.name for row in pkgutil.walk_packages(dwell.__path__, "dwell.")]
    return [name for name in found if not name.endswith(("__main__", "_native")) and _has(name)]


def _has(name: str) -> bool:
    spec = importlib.util.find_spec(name)
    source = None if spec is None or spec.origin is None else Path(spec.origin)
    return source is not None and ">>> " in source.read_text("utf-8")


@pytest.mark.long
@pytest.mark.parametrize("module", modules())
def test_the_examples_of_a_module_run(module: str) -> None:
    failed, tried = doctest.testmod(importlib.import_module(module))
    assert tried > 0
    assert failed == 0
