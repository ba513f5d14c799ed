"""Settings of a world beside its house: laws, parameters, rates."""

from __future__ import annotations

import contextlib
import difflib
import functools
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from dwell import _native
from dwell._native import ConfigError, SceneError
from dwell.arguments import (
    checked_fields,
    finite_number,
    integer_in_range,
    mapping,
    path,
    quoted,
    text,
)
from dwell.configs import bodies, checked
from dwell.files import read_json
from dwell.heads import Head, head_of

#: Laws to install: a name, names, rows in full, or parameters by name; or what calibration found
#: (laws and parameters), as a mapping or by path.
Laws = str | os.PathLike[str] | Mapping[str, Any] | Sequence[str | Mapping[str, Any]] | None

#: Intervals from which each episode draws: what calibration found, as a mapping or by path, or
#: ``[low, high]`` by address.
Randomize = str | os.PathLike[str] | Mapping[str, Any] | None

_FOUND = {"laws", "parameters"}
#: What calibration says of it besides, for readers.
_FOUND_ABOUT = {"version", "intervals", "provenance"}
#: The version of the form of ``found.json``; older files do not say it.
_FOUND_VERSION = 1
#: More than anybody has causes for; each is looked for among those before it.
_MAX_LAWS = 1_000
_EXPECTED = (
    "expected a law's name, a list of names and of {id, version, target, params}, parameters by "
    "name as {'drag': {'c_d': 0.5}}, or the path of what calibration found"
)


@functools.cache
def _laws() -> dict[str, dict[str, Any]]:
    """Descriptions of all laws, by id."""
    return {law["id"]: law for law in _native.laws()}


def _read(file: str) -> Any:  # noqa: ANN401 - any JSON value
    try:
        return read_json(file)
    except ValueError as error:
        raise ConfigError(f"laws: {error}") from error


def _is_file(laws: Laws) -> bool:
    """Returns whether laws stand in a file: a path, or text that is no law's name."""
    if not isinstance(laws, str):
        return isinstance(laws, os.PathLike)
    is_like_one = laws.endswith(".json") or os.path.basename(laws) != laws
    return laws not in _laws() and (is_like_one or (laws != "" and Path(laws).exists()))


@contextlib.contextmanager
def file_of_laws_named(laws: Laws) -> Iterator[None]:
    """Lets what the engines refuse of parameters that a file holds begin with its name."""
    try:
        yield
    except (ConfigError, SceneError) as error:
        if not _is_file(laws) or "parameter" not in str(error):
            raise
        raise type(error)(f"laws: {path('laws', laws)}: {error}") from None


def found(laws: Laws, at: str = "laws") -> tuple[list[dict[str, Any]], dict[str, float]]:
    """Laws and parameters by address, from all accepted forms; ``at``: what errors begin with.

    Raises:
        ConfigError: It is none of them, or a law, a parameter or a number that there is not.
        OSError: It is the path of a file that the system refuses to read.
    """
    if _is_file(laws):
        laws = path(at, laws)
        at = f"{at}: {laws}"
        laws = _read(laws)
    if laws is None:
        return [], {}
    parameters: Mapping[str, float] = {}
    if isinstance(laws, Mapping) and _FOUND & set(laws):
        if unknown := sorted(set(laws) - _FOUND - _FOUND_ABOUT):
            allowed = sorted(_FOUND | _FOUND_ABOUT)
            raise ConfigError(f"{at}: no field {unknown[0]!r}; allowed are {allowed}")
        _refuse_other_version(at, laws)
        parameters = laws.get("parameters", {})
        laws = laws.get("laws", [])
    if not isinstance(parameters, Mapping):
        raise ConfigError(f"{at}: parameters: expected values by address")
    if isinstance(laws, Mapping) and "id" not in laws:
        by_name = mapping(at, laws, "parameters by the laws' names")
        # No numbers: the usual ones.
        rows = [
            _row(f"{at}.{name:.200}", {"id": name, **({"params": params} if params else {})})
            for name, params in by_name.items()
        ]
        return rows, _values(f"{at}: parameters", parameters)
    if isinstance(laws, str | Mapping):
        laws = [laws]
    if (
        isinstance(laws, bytes)
        or not isinstance(laws, Sequence)
        or not all(isinstance(law, str | Mapping) for law in laws)
    ):
        raise ConfigError(f"{at}: found {quoted(laws)}; {_EXPECTED}")
    if len(laws) > _MAX_LAWS:
        raise ConfigError(f"{at}: found {len(laws)} laws; allowed are at most {_MAX_LAWS}")
    rows = [_row(f"{at}[{k}]", law) for k, law in enumerate(laws)]
    return rows, _values(f"{at}: parameters", parameters)


def intervals(
    randomize: Randomize,
) -> tuple[tuple[list[dict[str, Any]], dict[str, float]], dict[str, list[float]]]:
    """Laws and parameters that are installed beside what is drawn, and the intervals by address.

    Raises:
        ConfigError: It is neither what calibration found nor intervals by address.
        OSError: It is the path of a file that the system refuses to read.
    """
    if randomize is None:
        return ([], {}), {}
    at = "randomize"
    if isinstance(randomize, str | os.PathLike):
        file = path(at, randomize)
        at = f"randomize: {file}"
        try:
            randomize = read_json(file)
        except ValueError as error:
            raise ConfigError(f"randomize: {error}") from error
    given = mapping(at, randomize, "what calibration found, or [low, high] by address")
    fixed: Laws = None
    if (_FOUND | _FOUND_ABOUT) & set(given):
        if unknown := sorted(set(given) - _FOUND - _FOUND_ABOUT):
            allowed = sorted(_FOUND | _FOUND_ABOUT)
            raise ConfigError(f"{at}: no field {unknown[0]!r}; allowed are {allowed}")
        _refuse_other_version(at, given)
        fixed = {name: given[name] for name in sorted(_FOUND & set(given))}
        given = mapping(f"{at}: intervals", given.get("intervals", {}), "[low, high] by address")
    rows = {address: _interval(f"{at}: {address}", ends) for address, ends in given.items()}
    return found(fixed, at), rows


def _refuse_other_version(at: str, given: Mapping[str, Any]) -> None:
    """Refuses what a newer release found.

    Raises:
        ConfigError: It says another version than this dwell reads.
    """
    version = given.get("version", _FOUND_VERSION)
    if version != _FOUND_VERSION or isinstance(version, bool):
        raise ConfigError(f"{at}: version is {quoted(version)}; this dwell reads {_FOUND_VERSION}")


def _interval(at: str, ends: object) -> list[float]:
    """The two ends of an interval."""
    if isinstance(ends, Sequence) and not isinstance(ends, str | bytes) and len(ends) == 2:
        low, high = (finite_number(at, end) for end in ends)
        if low <= high:
            return [low, high]
    raise ConfigError(f"{at} is {quoted(ends)}; expected [low, high] with low <= high")


def _row(at: str, given: str | Mapping[str, Any]) -> dict[str, Any]:
    """A law in full."""
    row = checked_fields(at, {"id": given} if isinstance(given, str) else given, _LAW)
    if "id" not in row:
        raise ConfigError(f"{at}: no field 'id'; a law has {', '.join(_LAW)}")
    name = row["id"]
    if name not in _laws():
        near = difflib.get_close_matches(name, _laws(), 3)
        meant = f"did you mean {' or '.join(near)}? " if near else ""
        raise ConfigError(f"{at}: no law {quoted(name)}; {meant}allowed are {', '.join(_laws())}")
    law = _laws()[name]
    if not row.get("params"):
        if law["usual"] is None:
            first = law["params"][0]
            example = {name: {first["name"]: first["plausible"][1]}}
            raise ConfigError(
                f"{at}: {name} without numbers does nothing; "
                f"give some, as laws={example}; {_has(law)}"
            )
        row["params"] = law["usual"]
    known = {param["name"]: param for param in law["params"]}
    for param, value in row["params"].items():
        if param not in known:
            near = difflib.get_close_matches(param, known, 1)
            meant = f"did you mean {near[0]}? " if near else ""
            raise ConfigError(f"{at}: {name} has no parameter {quoted(param)}; {meant}{_has(law)}")
        low, high = known[param]["low"], known[param]["high"]
        if not low <= value <= high:
            raise ConfigError(f"{at}: {name}.{param} is {value:g}; {_has(law)}")
    return {"version": law["version"], **row}


def _has(law: Mapping[str, Any]) -> str:
    """The parameters of a law with their bounds."""
    rows = []
    for param in law["params"]:
        unit = "" if param["unit"] == "1" else f" {param['unit']}"
        low, high = param["plausible"]
        bounds = f"{param['low']:g} to {param['high']:g}{unit}"
        rows.append(f"{param['name']} ({bounds}, plausible {low:g} to {high:g})")
    return f"{law['id']} has {', '.join(rows)}"


def _values(name: str, parameters: object) -> dict[str, float]:
    """Values by address."""
    values = mapping(name, parameters, "values by address")
    return {
        address: finite_number(f"{name}: {address}", value) for address, value in values.items()
    }


def _target(name: str, value: object) -> str | None:
    return None if value is None else text(name, value)


def _params(name: str, value: object) -> dict[str, float]:
    return {key: finite_number(f"{name}.{key}", part) for key, part in mapping(name, value).items()}


#: The fields of a law, and what they may be.
_LAW: dict[str, Callable[[str, object], Any]] = {
    "id": text,
    "version": integer_in_range,
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
    laws: Laws,
    parameters: Mapping[str, float] | None,
    further: Mapping[str, Any] | None,
    randomize: Randomize = None,
) -> dict[str, Any]:
    """The native WorldConfig. ``parameters`` take precedence over those beside the laws.

    What calibration found is installed with ``randomize``, too, where ``laws`` do not say else.

    Raises:
        ConfigError: ``further`` names what has an argument of its own; a parameter is stated and
            drawn, too.
    """
    further = {} if further is None else mapping("world", further)
    for name in sorted({*_FOUND, "randomize"} & set(further)):
        raise ConfigError(f"world: holds {name!r}; give it as the argument {name}= instead")
    further = checked("WorldConfig", further)
    if "agents" in further:
        further = {**further, "agents": bodies(further["agents"])}
    if (head := further.get("sound_head")) is not None:
        if not isinstance(head, Head):
            raise ConfigError(f"sound_head is {quoted(head)}; allowed is a dwell.Head")
        further = {**further, "sound_head": head.id}
    if further.get("sound_root") is not None:
        further = {**further, "sound_root": path("sound_root", further["sound_root"])}
    rows, values = found(laws)
    (found_rows, found_values), drawn = intervals(randomize)
    said = {(row["id"], row.get("target")) for row in rows}
    rows += [row for row in found_rows if (row["id"], row.get("target")) not in said]
    values = {**found_values, **values}
    if (renderer := os.environ.get("DWELL_RENDERER")) and "renderer" not in further:
        further = {**further, "renderer": renderer}
    own = {} if parameters is None else _values("parameters", parameters)
    for address in sorted({*own} & {*drawn}):
        raise ConfigError(
            f"parameters, randomize: found both for {address!r}; expected one of them: a value, or "
            "an interval to draw it from"
        )
    # What is usual is not stated: files say it as they always did.
    more = {"randomize": drawn} if drawn else {}
    return {"laws": rows, "parameters": {**values, **own}, **more, **further}
