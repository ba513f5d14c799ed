"""What every kind of measurement has, and what all bundles hold."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dwell.arguments import finite_number
from dwell.measured.maps import COMMON, Job, Map
from dwell.measured.samples import Episode

#: Of episodes that are left out, so many names are told.
MAX_LISTED = 10


@dataclass(frozen=True)
class Kind:
    """A kind of measurement.

    Attributes:
        name: In maps and bundles.
        about: What is measured, in some words.
        template: A filled map.
        schema: What its maps may hold, beside what all maps may.
        version: Of the bundle's form.
        write: Writes the bundle; returns counts.
    """

    name: str
    about: str
    template: Map
    schema: Map
    version: int
    write: Callable[[Job], dict[str, Any]]

    def keys(self) -> Map:
        """What its maps may hold."""
        return {**COMMON, **self.schema}


def write_manifest(job: Job, version: int, scene: Map, more: Map) -> None:
    """The manifest."""
    mapping = job.mapping
    told = {"g_m_s2": mapping.get("g_m_s2"), **(mapping.get("environment") or {})}
    environment = {
        key: None if value is None else finite_number(f"{job.at}: {key}", value)
        for key, value in told.items()
    }
    manifest = {
        "version": version,
        "title": mapping.get("title") or "measured",
        "licence": mapping.get("licence") or "unknown",
        "kind": mapping["kind"],
        "scene": {"environment": environment, **scene},
        "notes": mapping.get("notes") or "",
        **more,
    }
    job.draft.fields["scene.environment.g_m_s2"] = f"{job.at}: g_m_s2"
    job.draft.fields["scene.environment."] = f"{job.at}: environment."
    text = json.dumps(manifest, indent=1) + "\n"
    (job.draft.folder / "manifest.json").write_text(text, "utf-8")


def write_episodes(job: Job, rows: Sequence[tuple[str, str, str]]) -> None:
    """The list of episodes: name, group and conditions of each."""
    with job.draft.table("episodes.csv", "episode,split_group,conditions") as write:
        for row in rows:
            write([*row])


def listing(episodes: Sequence[Episode]) -> list[tuple[str, str, str]]:
    """The rows of the list of episodes."""
    return [(episode.name, episode.group, episode.conditions) for episode in episodes]


def counted(job: Job, rows: int, episodes: int, left_out: Mapping[str, None]) -> dict[str, Any]:
    """What an import says of itself."""
    return {
        "rows": rows,
        "episodes": episodes,
        "left_out": len(left_out),
        **({"left_out_episodes": [*left_out][:MAX_LISTED]} if left_out else {}),
        **({"notes": job.notes} if job.notes else {}),
    }
