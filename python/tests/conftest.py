"""Shared parts of the tests."""

from __future__ import annotations

import pytest

import dwell


@pytest.fixture(scope="session")
def apartment() -> dwell.House:
    return dwell.House.open("builtin:apartment")


@pytest.fixture(scope="session")
def shoebox() -> dwell.House:
    return dwell.House.shoebox((6.0, 3.0, 5.0), substance="plaster")
