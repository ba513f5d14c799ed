"""What a recording is made of."""

from __future__ import annotations

import dataclasses
from typing import Any, Literal, get_args

from dwell import ConfigError
from dwell.arguments import choice, integer_in_range, number_in_range, text

Form = Literal["png", "npz"]
#: How pictures are kept: a PNG for each, or the arrays of a camera in one file.
FORMS: tuple[Form, ...] = get_args(Form)

#: Steps of physics a second, as of every world.
PHYSICS_RATE_HZ = 120
#: Steps of control a second at least: the hand moves smoothly between pictures.
_LEAST_CONTROL_RATE_HZ = 20
#: Samples of sound a second; the second one where the first is no multiple of the steps.
_SOUND_RATES_HZ = (16_000, 48_000)


@dataclasses.dataclass(frozen=True)
class TeachSettings:
    """What a recording is made of; equal settings give equal bytes.

    Attributes:
        users: Persons, 1 to 1000.
        clips: Clips of each, 1 to 1000: a third each points, shows and speaks.
        seed: What all is drawn from.
        fps: Pictures a second of every camera, 1 to 60: a divisor of 120.
        width: Pixels across the pictures of the two Kinects, 32 to 1920, a multiple of 4; they are
            4:3, those of the HD camera twice as wide and 16:9.
        form: ``png``: a file for each picture; ``npz``: one for each camera.
        noise: Strength of the Kinects' noise of depth; 1 is the published one, 0 none.
        pointing_noise_deg: Standard deviation of the direction in which users point, degrees;
            ``None``: each user's own.
        house: A HOUSE in which the table is put up; ``None``: a room made for it.

    Raises:
        ConfigError: A field is of another type or out of its range.
    """

    users: int = 10
    clips: int = 30
    seed: int = 0
    fps: int = 10
    width: int = 320
    form: Form = "png"
    noise: float = 1.0
    pointing_noise_deg: float | None = None
    house: str | None = None

    def __post_init__(self) -> None:
        """Checks the fields."""
        checked: dict[str, Any] = {
            "users": integer_in_range("users", self.users, low=1, high=1000),
            "clips": integer_in_range("clips", self.clips, low=1, high=1000),
            "seed": integer_in_range("seed", self.seed),
            "fps": integer_in_range("fps", self.fps, low=1, high=60),
            "width": integer_in_range("width", self.width, low=32, high=1920),
            "form": choice("form", self.form, FORMS),
            "noise": number_in_range("noise", self.noise, 0.0, 10.0),
        }
        if self.pointing_noise_deg is not None:
            checked["pointing_noise_deg"] = number_in_range(
                "pointing_noise_deg", self.pointing_noise_deg, 0.0, 30.0, "degrees"
            )
        if self.house is not None:
            checked["house"] = text("house", self.house)
        if PHYSICS_RATE_HZ % checked["fps"]:
            allowed = [rate for rate in range(1, 61) if PHYSICS_RATE_HZ % rate == 0]
            raise ConfigError(f"fps is {self.fps}; allowed are {', '.join(map(str, allowed))}")
        if checked["width"] % 4:
            raise ConfigError(f"width is {self.width}; allowed are multiples of 4")
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @property
    def control_rate_hz(self) -> int:
        """Steps of the world a second: the first multiple of ``fps`` that is fine enough."""
        multiples = range(self.fps, PHYSICS_RATE_HZ + 1, self.fps)
        return next(
            rate
            for rate in multiples
            if rate >= _LEAST_CONTROL_RATE_HZ and PHYSICS_RATE_HZ % rate == 0
        )

    @property
    def sound_rate_hz(self) -> int:
        """Samples of sound a second: a multiple of the steps of control."""
        coarse, fine = _SOUND_RATES_HZ
        return coarse if coarse % self.control_rate_hz == 0 else fine

    @property
    def steps_a_frame(self) -> int:
        """Steps of the world from one picture to the next."""
        return self.control_rate_hz // self.fps

    def as_dict(self) -> dict[str, Any]:
        """The settings as plain data."""
        return dataclasses.asdict(self)
