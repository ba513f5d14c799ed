"""Responses of a box by pyroomacoustics, the quickest form that it has. See hear.py."""

import json
from pathlib import Path

import numpy as np
import pyroomacoustics as pra
from listen import Heard, run


def load(scene: Path, rays: int) -> Heard:
    """Image sources to order 3 and rays for the first pair of the scene."""
    told = json.loads(scene.read_text("utf-8"))
    pra.constants.set("num_threads", 1)
    (material,) = told["materials"].values()
    bands = told["bands_hz"]
    air = told["air"]

    def heard(seed: int) -> np.ndarray:
        # Its noise comes from numpy's global generator.
        np.random.seed(seed)  # noqa: NPY002
        pra.libroom.set_rng_seed(seed)
        room = pra.ShoeBox(
            told["shoebox"],
            fs=told["fs"],
            materials=pra.Material(
                {"coeffs": material["absorption"], "center_freqs": bands},
                {"coeffs": material["scattering"], "center_freqs": bands},
            ),
            max_order=3,
            ray_tracing=True,
            air_absorption=True,
            temperature=air["temperature_c"],
            humidity=air["humidity_pct"],
        )
        room.set_ray_tracing(
            n_rays=rays,
            receiver_radius=0.5,
            hist_bin_size=0.004,
            time_thres=told["duration_s"],
            energy_thres=1e-7,
        )
        room.add_source(told["sources"][0]["pos"])
        room.add_microphone(told["receivers"][0]["pos"])
        room.compute_rir()
        return np.asarray(room.rir[0][0])

    return heard


run(load)
