"""What a world is told beside its house: laws, parameters, rates."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from dwell._native import ConfigError
from dwell.arguments import fields, finite, mapping, path, text, whole
from dwell.configs import WorldSettings, bodies, checked
from dwell.heads import Head, head_of

#: Laws to install; or what calibration found (laws and parameters), as a mapping or by path.
Laws = str | os.PathLike[str] | Mapping[str, Any] | Sequence[Mapping[str, Any]] | None

_FOUND = {"laws", "parameters"}


def _read(path: str | os.PathLike[str]) -> Any:  # noqa: ANN401 - any JSON value
    name = os.fspath(path)
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"laws: {name}: {error.strerror or error}") from error
    except ValueError as error:
        raise ConfigError(f"laws: {name}: no JSON: {error}") from error


def found(laws: Laws) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """Laws and parameters by address, from all forms in which they are given.

    Raises:
        ConfigError: It is neither a list of laws nor an object with ``laws`` and ``parameters``.
    """
    at = "laws"
    if isinstance(laws, str | os.PathLike):
        at = f"laws: {os.fspath(laws)}"
        laws = _read(laws)
    if laws is None:
        return [], {}
    parameters: Mapping[str, float] = {}
    if isinstance(laws, Mapping):
        if unknown := sorted(set(laws) - _FOUND):
            raise ConfigError(f"{at}: no field {unknown[0]!r}; allowed are {sorted(_FOUND)}")
        parameters = laws.get("parameters", {})
        laws = laws.get("laws", [])
    if not isinstance(laws, Sequence) or not all(isinstance(law, Mapping) for law in laws):
        raise ConfigError(f"{at}: expected a list of laws, each {{id, version, target, params}}")
    if not isinstance(parameters, Mapping):
        raise ConfigError(f"{at}: parameters: expected values by address")
    rows = [fields(f"laws[{k}]", law, _LAW) for k, law in enumerate(laws)]
    for k, row in enumerate(rows):
        for name in ("id", "version"):
            if name not in row:
                raise ConfigError(f"laws[{k}]: no field {name!r}; a law has {', '.join(_LAW)}")
    return rows, _values("parameters", parameters)


def _values(name: str, parameters: object) -> dict[str, float]:
    """Values by address."""
    values = mapping(name, parameters, "values by address")
    return {address: finite(address, value) for address, value in values.items()}


def _target(name: str, value: object) -> str | None:
    return None if value is None else text(name, value)


def _params(name: str, value: object) -> dict[str, float]:
    return {key: finite(f"{name}.{key}", part) for key, part in mapping(name, value).items()}


#: The fields of a law, and what they may be.
_LAW: dict[str, Callable[[str, object], Any]] = {
    "id": text,
    "version": whole,
    "target": _target,
    "params": _params,
}


def with_head(
    further: Mapping[str, Any] | None,
) -> tuple[Mapping[str, Any] | None, tuple[Head, ...]]:
    """Settings whose ``sound_head`` is a head also where a SOFA file's path was given, and heads.

    Raises:
        ConfigError: It is neither.
        MeasuredDataError: The file is none of a head.
    """
    if not isinstance(further, Mapping) or further.get("sound_head") is None:
        return further, ()
    head = head_of("sound_head", further["sound_head"])
    return {**further, "sound_head": head}, () if head is None else (head,)


def world_settings(
    laws: Laws, parameters: Mapping[str, float] | None, further: Mapping[str, Any] | None
) -> dict[str, Any]:
    """The native WorldConfig. ``parameters`` go before those that stand beside the laws.

    Raises:
        ConfigError: ``further`` names what has an argument of its own.
    """
    further = {} if further is None else mapping("world", further)
    for name in sorted(_FOUND & set(further)):
        raise ConfigError(f"world: holds {name!r}; give it as the argument {name}= instead")
    further = checked(WorldSettings, further)
    if "agents" in further:
        further = {**further, "agents": bodies(further["agents"])}
    if (head := further.get("sound_head")) is not None:
        if not isinstance(head, Head):
            raise ConfigError(f"sound_head is {head!r}; allowed is a dwell.Head")
        further = {**further, "sound_head": head.id}
    if further.get("sound_root") is not None:
        further = {**further, "sound_root": path("sound_root", further["sound_root"])}
    rows, values = found(laws)
    if (renderer := os.environ.get("DWELL_RENDERER")) and "renderer" not in further:
        further = {**further, "renderer": renderer}
    own = {} if parameters is None else _values("parameters", parameters)
    return {"laws": rows, "parameters": {**values, **own}, **further}
