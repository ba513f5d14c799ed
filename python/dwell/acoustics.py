"""Impulse responses and room-acoustic measures."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell import _native
from dwell.arguments import finite, point, to_json, whole
from dwell.house import House
from dwell.settings import Laws, found


class AcousticScene:
    """A house prepared for sound, as it starts. Needs neither physics nor a GPU."""

    def __init__(
        self,
        house: House | str,
        *,
        laws: Laws = None,
        **config: Any,  # noqa: ANN401 - fields of the native AcousticConfig
    ) -> None:
        """Prepares a house.

        Args:
            house: A house or a HOUSE string.
            laws: Laws to install, as ``{"id", "version", "target", "params"}``; or what calibration
                found (laws and parameters), as a mapping or as the path of its ``found.json``.
                Those of air and sources change energies and responses; those of microphones act on
                what ``impulse_response`` returns, as on a recording of the impulse.
            **config: ``rate_hz``, ``rays``, ``max_duration_s``, ``image_order``, ...: the fields of
                ``dwell_acoustics::AcousticConfig``.
        """
        self.house = house if isinstance(house, House) else House.open(house)
        rows, values = found(laws)
        self._native = _native.AcousticScene(
            self.house.native, to_json(config), to_json(rows), to_json(values)
        )
        self._config = config
        self._laws = {"laws": rows, "parameters": values}

    def __reduce__(self) -> tuple[Any, tuple[House, dict[str, Any], dict[str, Any]]]:
        """House, laws and settings."""
        return _again, (self.house, self._laws, self._config)

    @property
    def rate_hz(self) -> int:
        """Samples a second of impulse responses."""
        return self._native.rate_hz

    def impulse_response(
        self,
        source: Sequence[float],
        mic: Sequence[float],
        *,
        ears: bool = False,
        yaw_deg: float = 0.0,
        seed: int = 0,
        threads: int | None = None,
    ) -> NDArray[np.float32]:
        """Pressure in Pa for a source that makes an impulse of 1 Pa at 1 m.

        Args:
            source: Where it is, m.
            mic: Where the microphone, or the middle of the head, is, m.
            ears: Two ears on a spherical head (left first) instead of a microphone.
            yaw_deg: Where the head faces.
            seed: The seed of the rays and of the tail's details.
            threads: How many threads to use; the result does not depend on it.

        Returns:
            Shape (1 or 2, samples). The first sample is the moment of the impulse.
        """
        return self._native.impulse_response(
            point("source", source),
            point("mic", mic),
            yaw_deg=finite("yaw_deg", yaw_deg),
            ears=ears,
            seed=whole("seed", seed),
            threads=None if threads is None else whole("threads", threads, low=1),
        )

    def metrics(
        self, source: Sequence[float], mic: Sequence[float], *, seed: int = 0
    ) -> list[dict[str, Any]]:
        """``centre_hz`` and T20, T30, EDT, C50, C80, D50, Ts and DRR of each octave band.

        They are those of the room, without laws of microphones.
        """
        metrics: list[dict[str, Any]] = json.loads(
            self._native.metrics_json(
                point("source", source), point("mic", mic), whole("seed", seed)
            )
        )
        return metrics

    def early_paths(self, source: Sequence[float], mic: Sequence[float]) -> list[dict[str, Any]]:
        """The direct sound and early reflections, by length.

        Returns:
            For each ``points`` (the source, where it is reflected, the microphone; m) and ``path``:
            ``length_m``, ``energy`` of each octave band from 62.5 Hz against a free path of 1 m,
            ``arrival`` and ``departure`` (directions), ``walls`` that it passes through.

        Raises:
            DwellError: A point is not finite.
        """
        paths: list[dict[str, Any]] = json.loads(
            self._native.early_paths_json(point("source", source), point("mic", mic))
        )
        return paths

    def explain(self) -> dict[str, Any]:
        """What sound meets: areas, mean absorption, which materials are guesses."""
        explained: dict[str, Any] = json.loads(self._native.explain_json())
        return explained


def _again(house: House, laws: dict[str, Any], config: dict[str, Any]) -> AcousticScene:
    return AcousticScene(house, laws=laws, **config)
