"""Responses of a measured-room scene by dwell. See hear.py."""

from pathlib import Path

from listen import Heard, run

from dwell import AcousticScene
from dwell.cli.measured_room import MeasuredRoom


def load(scene: Path, rays: int) -> Heard:
    """Traces the first pair of the scene."""
    room = MeasuredRoom.read(scene)
    source = next(iter(room.sources.values()))
    receiver = next(iter(room.receivers.values()))
    traced = AcousticScene(str(scene), rays=rays, image_order=3, **room.config())
    return lambda seed: traced.impulse_response(source, receiver, seed=seed, threads=1)[
        0
    ]


run(load)
