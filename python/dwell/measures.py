"""Room-acoustic measures of impulse responses, simulated or recorded.

:meth:`dwell.AcousticScene.metrics` gives those of a house without the chance of one response.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from dwell import ConfigError, _native
from dwell.arguments import choice, finite_number, finite_row, real_array

#: How wide bands are: eight octaves from 62.5 Hz, or 24 third octaves from 50 Hz (IEC 61260-1).
Bands = Literal["octave", "third_octave"]


def response_metrics(
    response: NDArray[Any], rate_hz: float, *, bands: Bands = "octave"
) -> list[dict[str, float | None]]:
    """The measures of one channel, by band (ISO 3382-1:2009).

    Times count from where the response first rises to -20 dB of its peak; the direct sound is what
    arrives within 2.5 ms of that. Noise of a recording is not compensated for.

    Args:
        response: The impulse response (samples,), or (1, samples) as
            :meth:`dwell.AcousticScene.impulse_response` gives for one microphone; for levels, re a
            pulse of 1 at 1 m.
        rate_hz: Samples a second.
        bands: How wide the bands are.

    Returns:
        For each band ``centre_hz`` (nominal), ``edt_s``, ``t20_s``, ``t30_s`` (s for 60 dB),
        ``c50_db``, ``c80_db``, ``d50`` (0 to 1), ``ts_s``, ``g_db`` (re the free field at 10 m) and
        ``drr_db``;
        ``None`` where the response is too short for one, or holds nothing there.

    Raises:
        ConfigError: The response is not one row of finite numbers, or the rate is out of range.
    """
    given = real_array("response", response, np.float64).reshape(np.shape(response))
    samples = finite_row("response", given[0] if given.ndim == 2 and len(given) == 1 else given)
    rate = _rate(rate_hz)
    rows = _native.response_metrics(samples, rate, _width(bands))
    return [{key: row[key] for key in row if key != "lf"} for row in rows]


def binaural_metrics(
    ears: NDArray[Any], rate_hz: float, *, bands: Bands = "octave"
) -> dict[str, Any]:
    """Interaural measures of one impulse (ISO 3382-1:2009, annex B).

    Args:
        ears: The impulse responses (2, samples), left first.
        rate_hz: Samples a second.
        bands: How wide the bands are.

    Returns:
        ``itd_s`` and ``ild_db``: how much earlier (up to 1.5 kHz) and louder the direct sound is
        at the left ear; ``bands``: for each ``centre_hz``, ``iacc_early`` (first 80 ms),
        ``iacc_late``, ``iacc`` (0 to 1), ``itd_s`` and ``ild_db``. ``None`` where an ear hears
        nothing.

    Raises:
        ConfigError: There are not two rows of finite numbers, or the rate is out of range.
    """
    rows = real_array("ears", ears, np.float64)
    if rows.ndim != 2 or rows.shape[0] != 2:
        raise ConfigError(f"ears: expected shape (2, samples), found {rows.shape}")
    left, right = finite_row("ears[0]", rows[0]), finite_row("ears[1]", rows[1])
    return _native.ear_metrics(left, right, _rate(rate_hz), _width(bands))


def _rate(rate_hz: object) -> float:
    rate = finite_number("rate_hz", rate_hz)
    if not 1000.0 <= rate <= 1e6:
        raise ConfigError(f"rate_hz is {rate:g}; allowed are 1000 to 1000000")
    return rate


def _width(bands: object) -> str:
    return choice("bands", bands, ("octave", "third_octave"))
