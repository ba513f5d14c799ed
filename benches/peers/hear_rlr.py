"""Responses of a measured-room scene by RLR-Audio-Propagation. See hear.py."""

import json
from pathlib import Path

import numpy as np
import rlr_audio_propagation as rlr
from listen import Heard, box, run


def load(scene: Path, rays: int) -> Heard:
    """Traces the first pair of the scene; energies are absorbed as they are given."""
    told = json.loads(scene.read_text("utf-8"))
    bands = told["bands_hz"]
    (material,) = told["materials"].values()

    def curve(values: list[float]) -> list[float]:
        return [float(x) for pair in zip(bands, values, strict=True) for x in pair]

    name = "wall_of_the_box"
    database = {
        "name": name,
        "labels": [name],
        "absorption": curve(material["absorption"]),
        "scattering": curve(material["scattering"]),
        "transmission": curve([0.0] * len(bands)),
        "damping": [],
        "density": 1.0,
        "speed": 1500.0,
    }
    file = scene.with_suffix(".rlr.json")
    file.write_text(json.dumps({"materials": [database]}), "utf-8")
    config = rlr.Config()
    config.frequency_bands = 8
    config.indirect_ray_count = rays
    config.thread_count = 1
    config.sample_rate = float(told["fs"])
    config.max_ir_length = float(told["duration_s"])
    context = rlr.Context(config)
    context.set_material_database_json(str(file))
    corners, triangles = box(told["shoebox"])
    context.add_object()
    context.add_mesh_vertices(corners.astype(np.float32).ravel().tolist())
    context.add_mesh_indices(triangles.astype(np.uint32).ravel().tolist(), 3, name)
    context.finalize_object_mesh(0)
    context.add_source()
    context.set_source_position(0, told["sources"][0]["pos"])
    context.add_listener(rlr.ChannelLayout(rlr.ChannelLayoutType.Mono, 1))
    context.set_listener_position(0, told["receivers"][0]["pos"])

    def heard(seed: int) -> np.ndarray:
        # It has no seed; each simulation goes on where the last one's chance ended.
        context.simulate()
        return np.array(context.get_ir_channel(0, 0, 0))

    return heard


run(load)
