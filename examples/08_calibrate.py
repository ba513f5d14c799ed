"""Finds what a simulation lacks: throws with something hidden in them."""

import tempfile

import dwell
from dwell import _native

with tempfile.TemporaryDirectory() as folder:
    print("hidden:", _native.calibration_example(folder, 3))
    report = dwell.calibrate(folder)
print("found:", report["sentence"])
