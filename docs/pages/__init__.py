"""The pages of the site that are written when it is built.

They come from what the repository and the package say. Nothing here needs mkdocs: a page is a path
and its Markdown. `docs/hooks.py` hands them to mkdocs.
"""

from __future__ import annotations

from pages import actions, api, commands, environments, guide, observations, sources


def pages() -> dict[str, str]:
    """Path in the site and Markdown of every generated page."""
    return {
        **sources.pages(),
        **guide.pages(),
        "environments.md": environments.page(),
        "observations.md": observations.page(),
        "actions.md": actions.page(),
        "commands.md": commands.page(),
        **api.pages(),
    }


def navigation() -> list[dict[str, object]]:
    """The site's contents. mkdocs refuses the build where a page is missing in it."""
    return [
        {"Home": "index.md"},
        {"Guide": guide.paths()},
        {"Tutorials": sources.documents("docs/tutorials")},
        {"Tasks": sources.documents("docs/tasks")},
        {
            "Reference": [
                "environments.md",
                "observations.md",
                "actions.md",
                {"Command line": "commands.md"},
                {"Python": api.paths()},
            ]
        },
        {"How it works": sources.documents("docs")},
        {"Formats": sources.documents("docs/formats")},
        {"Decisions": ["decisions/index.md", *sources.documents("docs/decisions")]},
        {"Other simulators": "peers.md"},
        {"Assets": "assets.md"},
        {"Changelog": "changelog.md"},
    ]
