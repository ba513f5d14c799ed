"""The Python interface, a page a module. mkdocstrings fills them in from the package's sources."""

from __future__ import annotations

import importlib
import inspect
import re

import dwell
import dwell.envs
from pages.tables import code, table

#: What is public besides the names of `dwell` and `dwell.envs`: what these return, and functions
#: that stand beside them.
_BESIDE = {
    "dwell.calibration": ("write_example", "Recorder", "coverage", "Coverage"),
    "dwell.echogram": ("Echogram",),
    "dwell.episode_maker": ("EpisodeMaker",),
    "dwell.habitat_conversion": ("HabitatConverter", "Comparison"),
    "dwell.habitat_episodes": ("read", "HabitatEpisode"),
    "dwell.episodes": ("read", "write", "Episode", "EpisodeFile", "Header"),
    "dwell.evaluation": ("evaluate", "differences", "read_result", "write_result"),
    "dwell.policies": ("Policy",),
    "dwell.house": ("split_of_seed",),
    "dwell.localization": (
        "Settings",
        "DatasetMaker",
        "Layout",
        "PRESETS",
        "Label",
        "read_labels",
        "write_labels",
        "JointMeasures",
        "BASELINES",
    ),
    "dwell.measures": ("response_metrics", "binaural_metrics"),
    "dwell.navigation": ("Route", "Occupancy"),
    "dwell.places": ("receiver_grid", "random_sources"),
    "dwell.plans": ("floor_plan", "dollhouse", "sheet", "house_sheet", "houses_sheet"),
    "dwell.relations": ("orders", "graph_arrays", "to_networkx"),
    "dwell.sound_maps": ("SoundMap",),
    "dwell.sounds": ("signals", "write_wav", "read_wav"),
    "dwell.teach": (
        "record",
        "recorded_clips",
        "RecordedClip",
        "TeachSettings",
        "UserParameters",
        "user_parameters",
        "Clip",
    ),
    "dwell.world": ("actions",),
}


def modules() -> dict[str, list[str]]:
    """Modules with the public names of each."""
    found: dict[str, list[str]] = {"dwell.envs": [*dwell.envs.__all__]}
    for name in dwell.__all__:
        thing = getattr(dwell, name)
        home = getattr(thing, "__module__", "")
        if home.startswith("dwell.") and name not in dwell.envs.__all__ and not _is_error(thing):
            found.setdefault(home, []).append(name)
    for home, names in _BESIDE.items():
        found.setdefault(home, []).extend(names)
    return dict(sorted(found.items()))


def errors() -> dict[str, type[dwell.DwellError]]:
    """The exceptions, the base first."""
    named = {name: getattr(dwell, name) for name in dwell.__all__}
    kinds = {name: kind for name, kind in named.items() if _is_error(kind)}
    return dict(sorted(kinds.items(), key=lambda row: (row[1] is not dwell.DwellError, row[0])))


def _is_error(thing: object) -> bool:
    return inspect.isclass(thing) and issubclass(thing, BaseException)


def _page_of(module: str) -> str:
    return f"{module.split('.')[-1]}.md"


def paths() -> list[object]:
    """The pages in order."""
    named = [{module: f"api/{_page_of(module)}"} for module in modules()]
    return ["api/index.md", {"Errors": "api/errors.md"}, *named]


def pages() -> dict[str, str]:
    """A page for each module, one of errors, and the list of all names."""
    found = {f"api/{_page_of(module)}": _module(module, n) for module, n in modules().items()}
    return {**found, "api/errors.md": _errors(), "api/index.md": _index()}


def _module(module: str, names: list[str]) -> str:
    members = "\n".join(f"        - {name}" for name in names)
    return f"::: {module}\n    options:\n      members:\n{members}\n"


def _errors() -> str:
    sections = [
        f"## {name}\n\n{kind.__doc__} Of the kind {' and '.join(_bases(kind))}.\n"
        for name, kind in errors().items()
    ]
    about = "Every error of dwell's own is a `dwell.DwellError`."
    return "\n".join(["# Errors", "", about, "", *sections])


def _bases(kind: type) -> list[str]:
    return [code(base.__name__) for base in kind.__bases__]


def _index() -> str:
    rows = [
        (f"[`{module}.{name}`]({_page_of(module)}#{module}.{name})", _summary(module, name))
        for module, names in modules().items()
        for name in names
    ]
    rows += [
        (f"[`dwell.{name}`](errors.md#{name.lower()})", (kind.__doc__ or "").strip())
        for name, kind in errors().items()
    ]
    about = (
        "The classes can be imported from `dwell` itself; `dwell.__version__` is the version. "
        f"Here: {dwell.__version__}."
    )
    return f"# Python\n\n{about}\n\n{table(('name', 'what it is'), rows)}"


def _summary(module: str, name: str) -> str:
    thing = getattr(importlib.import_module(module), name)
    said = (inspect.getdoc(thing) or "").split("\n\n")[0].replace("\n", " ")
    return re.sub(r":\w+:(?=`)", "", said).replace("``", "`")
