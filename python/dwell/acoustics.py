"""Impulse responses and room-acoustic measures."""

from __future__ import annotations

import logging
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import (
    boolean,
    finite_number,
    integer_in_range,
    plain_settings,
    point,
    sequence_items,
)
from dwell.configs import checked
from dwell.echogram import Echogram
from dwell.engine_types import AcousticSettings
from dwell.heads import Head
from dwell.house import House
from dwell.listening import Receiver, Source, source_of
from dwell.outside_rooms import warn_outside_rooms
from dwell.world_settings import Laws, file_of_laws_named, found

if TYPE_CHECKING:
    from typing_extensions import Unpack


_LOG = logging.getLogger("dwell.acoustics")
#: The attributes that a pickle's arguments make again.
_OWN = ("house", "_native", "_config", "_laws")


class AcousticScene:
    """A house prepared for sound, as it starts. Needs neither physics nor a GPU."""

    def __init__(
        self,
        house: House | str,
        *,
        laws: Laws = None,
        **config: Unpack[AcousticSettings],
    ) -> None:
        """Prepares a house.

        Args:
            house: A house or a HOUSE string.
            laws: Laws to install, as :class:`dwell.World` takes them; or what calibration
                found (laws and parameters), as a mapping or as the path of its ``found.json``.
                Those of air and sources change energies and responses; those of microphones act on
                what ``impulse_response`` returns, as on a recording of the impulse. Those of motion
                and of cameras change nothing here, and are logged (logger ``dwell.acoustics``).
            **config: What :attr:`config` lists, by name: ``rate_hz`` (8,000 to 192,000), ``rays``
                of the tail (0 to 10,000,000), ``image_order`` (0 to 4), ``max_duration_s`` (0.02 to
                20) and so on. A response ends after ``max_duration_s``: decay times of a room that
                rings longer come out too short, so give it at least the longest T30.
        """
        self.house = house if isinstance(house, House) else House.open(house)
        rows, values = found(laws)
        _warn_of_silent_laws(rows)
        settings = plain_settings(checked("AcousticConfig", config))
        with file_of_laws_named(laws):
            self._native = _native.AcousticScene(
                self.house.native, settings, plain_settings(rows), plain_settings(values)
            )
        self._config = settings
        self._laws = {"laws": rows, "parameters": values}

    def __reduce__(self) -> tuple[Any, tuple[Any, ...], dict[str, Any]]:
        """House, laws and settings; and what else a subclass holds."""
        own = {name: value for name, value in vars(self).items() if name not in _OWN}
        return _rebuild, (type(self), self.house, self._laws, self._config), own

    def __repr__(self) -> str:
        """The house and the rate."""
        return f"AcousticScene({self.house.name!r}, rate_hz={self.rate_hz})"

    @property
    def rate_hz(self) -> int:
        """Samples a second of impulse responses."""
        return self._native.rate_hz

    @property
    def config(self) -> dict[str, Any]:
        """All settings, with the air as laws make it."""
        return self._native.config()

    def impulse_response(
        self,
        source: Source | Sequence[float],
        mic: Receiver | Sequence[float],
        *,
        ears: bool = False,
        yaw_deg: float = 0.0,
        head: Head | str | os.PathLike[str] | None = None,
        seed: int = 0,
        threads: int | None = None,
    ) -> NDArray[np.float32]:
        """Pressure in Pa for a source that makes an impulse of 1 Pa at 1 m.

        Args:
            source: What sounds, or the point (m) from which sound goes equally to all sides.
            mic: What hears, or the point (m) of a microphone or of the middle of a head.
            ears: Only at a point: two ears on a spherical head, left first, not a microphone.
            yaw_deg: Where that head faces; of a microphone it means nothing, and is refused.
            head: Only at a point: the head that the ears are on, or the path of its SOFA file; by
                default, with ``ears``, a sphere of ``head_radius_m``.
            seed: The seed of the rays and of the tail's details.
            threads: How many threads to use; the result does not depend on it.

        Returns:
            Shape (channels, samples). The first sample is the moment of the impulse.

        Raises:
            ConfigError: ``ears``, ``yaw_deg`` or ``head`` is given beside a receiver, which has its
                own; ``yaw_deg`` without ears.
        """
        given = {"ears": boolean("ears", ears), "head": head is not None}
        given["yaw_deg"] = finite_number("yaw_deg", yaw_deg) != 0.0
        if isinstance(mic, Receiver):
            for name in (name for name, is_given in given.items() if is_given):
                raise ConfigError(
                    f"mic, {name}: found both; a receiver has what it hears with, as "
                    "Receiver.binaural makes it"
                )
        else:
            if given["ears"] or given["head"]:
                mic = Receiver.binaural(point("mic", mic), yaw_deg=yaw_deg, head=head)
            elif given["yaw_deg"]:
                raise ConfigError(
                    f"yaw_deg is {yaw_deg!r}: a microphone at a point hears alike from all sides; "
                    "expected ears=True or a head beside it"
                )
            else:
                mic = _microphone("mic", mic)
        return self.impulse_responses(source, [mic], seed=seed, threads=threads)[0]

    def impulse_responses(
        self,
        source: Source | Sequence[float],
        receivers: Sequence[Receiver | Sequence[float]],
        *,
        seed: int = 0,
        threads: int | None = None,
    ) -> list[NDArray[np.float32]]:
        """As :meth:`impulse_response` for many receivers, which share the source's rays.

        A point (x, y, z), m, is one microphone that hears alike from all sides.

        Returns:
            One array of shape (channels, samples) for each receiver; their lengths differ.
        """
        given, sounding = _receivers("receivers", receivers), source_of(source)
        self._tell_outside(sounding, given)
        return self._native.impulse_responses(
            plain_settings(sounding.to_json()),
            plain_settings([receiver.to_json() for receiver in given]),
            heads=[receiver.head.native for receiver in given if receiver.head is not None],
            seed=integer_in_range("seed", seed),
            threads=_threads(threads),
        )

    def _tell_outside(self, source: Source, receivers: Sequence[Receiver]) -> None:
        warn_outside_rooms(self.house, "a source", point("source", source.position))
        for receiver in receivers:
            warn_outside_rooms(self.house, "a microphone", receiver.pose["position"])

    def metrics(
        self,
        source: Source | Sequence[float],
        mic: Receiver | Sequence[float],
        *,
        seed: int = 0,
        threads: int | None = None,
    ) -> list[dict[str, Any]]:
        """The measures of each octave band (ISO 3382-1:2009), without the chance of one noise.

        They are those of the room, without laws of microphones, and come from exact early paths and
        the traced tail. :mod:`dwell.measures` has those of an impulse response.

        Returns:
            For each band ``centre_hz``, ``edt_s``, ``t20_s``, ``t30_s`` (s for 60 dB), ``c50_db``,
            ``c80_db``, ``d50`` (0 to 1), ``ts_s``, ``g_db`` (re the free field at 10 m), ``drr_db``
            and ``lf`` (0 to 1; a microphone faces the source, other receivers stay as they are);
            ``None`` where the decay is too short for one, or nothing is heard.
        """
        return self.metrics_at(source, [mic], seed=seed, threads=threads)[0]

    def metrics_at(
        self,
        source: Source | Sequence[float],
        mics: Sequence[Receiver | Sequence[float]],
        *,
        seed: int = 0,
        threads: int | None = None,
    ) -> list[list[dict[str, Any]]]:
        """As :meth:`metrics` at many places, which share the source's rays."""
        receivers, sounding = _receivers("mics", mics), source_of(source)
        self._tell_outside(sounding, receivers)
        return self._native.metrics(
            plain_settings(sounding.to_json()),
            plain_settings([receiver.to_json() for receiver in receivers]),
            seed=integer_in_range("seed", seed),
            threads=_threads(threads),
        )

    def echogram(
        self,
        source: Source | Sequence[float],
        mic: Receiver | Sequence[float],
        *,
        seed: int = 0,
        threads: int | None = None,
    ) -> Echogram:
        """The echogram at the middle of a receiver, from which responses are made."""
        receiver = _microphone("mic", mic)
        sounding = source_of(source)
        self._tell_outside(sounding, [receiver])
        found = self._native.echogram(
            plain_settings(sounding.to_json()),
            plain_settings(receiver.to_json()),
            seed=integer_in_range("seed", seed),
            threads=_threads(threads),
        )
        return Echogram.from_json(found)

    def early_paths(
        self, source: Source | Sequence[float], mic: Sequence[float]
    ) -> list[dict[str, Any]]:
        """The direct sound and early reflections, by length.

        Returns:
            For each ``points`` (the source, where it is reflected, the microphone; m) and ``path``:
            ``length_m``, ``energy`` of each octave band from 62.5 Hz against a free path of 1 m,
            ``arrival`` and ``departure`` (directions), ``walls`` that it passes through,
            ``diffraction_points`` (where it goes around edges).

        Raises:
            DwellError: A point is not finite.
        """
        return self._native.early_paths(
            plain_settings(source_of(source).to_json()), point("mic", mic)
        )

    def material_report(self) -> dict[str, Any]:
        """Surfaces that sound meets: areas, mean absorption, which materials are guesses."""
        return self._native.material_report()


def _receivers(name: str, given: object) -> list[Receiver]:
    """Receivers; points become microphones."""
    rows = sequence_items(name, given, "expected a list of receivers or points")
    return [_microphone(f"{name}[{k}]", one) for k, one in enumerate(rows)]


def _microphone(name: str, given: object) -> Receiver:
    """A receiver; a point becomes a microphone."""
    return given if isinstance(given, Receiver) else Receiver.omni(point(name, given))


def _threads(threads: int | None) -> int | None:
    return None if threads is None else integer_in_range("threads", threads, low=1)


def _rebuild(
    kind: type[AcousticScene], house: House, laws: dict[str, Any], config: dict[str, Any]
) -> AcousticScene:
    scene = kind.__new__(kind)
    AcousticScene.__init__(scene, house, laws=laws, **config)
    return scene


def _warn_of_silent_laws(rows: Sequence[Mapping[str, Any]]) -> None:
    """Logs which laws act on no sound: allowed, since a world may have the same list."""
    engines = {law["id"]: law["engine"] for law in _native.laws()}
    silent = [str(row["id"]) for row in rows if engines.get(row["id"], "acoustics") != "acoustics"]
    if silent:
        _LOG.warning("laws: %s: no law of sound; an AcousticScene is as without", ", ".join(silent))
