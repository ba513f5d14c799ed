"""Finds what a simulation lacks: throws with something hidden in them."""

import tempfile

import dwell
from dwell.calibration import write_example

with tempfile.TemporaryDirectory() as folder:
    print("hidden:", write_example(folder, 3))
    report = dwell.calibrate(folder)
print("found:", report["sentence"])
