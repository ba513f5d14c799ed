"""Markdown of the repository as pages, with links that lead where the pages are."""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Callable
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]

#: What stands outside of docs/, and its page.
OUTSIDE = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "assets/README.md": "assets.md",
    "benches/peers/README.md": "peers.md",
    "examples/README.md": "guide/index.md",
}

#: A link or a picture: what stands before its target, the target, what stands behind it.
_LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()([^)\s]+)(\))")


def text(path: str) -> str:
    """A file of the repository."""
    return (ROOT / path).read_text("utf-8")


def documents(folder: str) -> list[str]:
    """The pages of a folder of docs/, as paths in the site."""
    found = sorted((ROOT / folder).glob("*.md"))
    return [path.relative_to(ROOT / "docs").as_posix() for path in found]


def title(markdown: str) -> str:
    """A page's first heading."""
    found = re.search(r"^# (.+)$", markdown, re.MULTILINE)
    return found[1] if found else ""


def pages() -> dict[str, str]:
    """The files outside of docs/, and the list of decisions; links still as they are written."""
    found = {page: text(path) for path, page in OUTSIDE.items()}
    names = [PurePosixPath(path).name for path in documents("docs/decisions")]
    rows = [f"- [{title(text(f'docs/decisions/{name}'))}]({name})" for name in names]
    about = "What was asked, what was chosen, what was rejected, and the price."
    found["decisions/index.md"] = "\n".join(["# Decisions", "", about, "", *rows, ""])
    return found


def page_of(path: str) -> str | None:
    """Where a file or folder of the repository is in the site; None where it is not."""
    if path in OUTSIDE:
        return OUTSIDE[path]
    if path == "docs/decisions":
        return "decisions/index.md"
    if re.fullmatch(r"examples/\d\d_\w+\.py", path):
        return f"guide/{PurePosixPath(path).stem}.md"
    inside = path.startswith("docs/") and (ROOT / path).is_file()
    return path.removeprefix("docs/") if inside else None


def source_of(page: str) -> str:
    """The file of the repository that a page shows; for a generated page where it would stand."""
    back = {page: path for path, page in OUTSIDE.items()}
    return back.get(page, f"docs/{page}")


def local_links(markdown: str) -> list[str]:
    """The targets of a page's links into the repository or the page itself, code left out."""
    found: list[str] = []

    def keep(link: re.Match[str]) -> str:
        found.append(link[2])
        return link[0]

    _each_link(markdown, keep)
    return [target for target in found if not re.match(r"[a-z]+:", target)]


def linked(page: str, markdown: str) -> str:
    """A page whose links lead to pages.

    A link to a file that the site does not show becomes the file's name; one to nothing stays, so
    that mkdocs refuses it.
    """

    def lead(link: re.Match[str]) -> str:
        target, hash_, anchor = link[2].partition("#")
        if not target or re.match(r"[a-z]+:", target):
            return link[0]
        folder = posixpath.dirname(source_of(page))
        path = posixpath.normpath(posixpath.join(folder, target))
        there = page_of(path)
        if there is not None:
            near = os.path.relpath(there, posixpath.dirname(page) or ".").replace(os.sep, "/")
            return f"{link[1]}{near}{hash_}{anchor}{link[3]}"
        return f"{link[1][1:-2]} (`{path}`)" if (ROOT / path).exists() else link[0]

    return _each_link(markdown, lead)


def _each_link(markdown: str, change: Callable[[re.Match[str]], str]) -> str:
    """Changes links outside of fences and of code in a line."""
    lines, fenced = [], False
    for line in markdown.split("\n"):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        lines.append(line if fenced else _outside_code(line, change))
    return "\n".join(lines)


def _outside_code(line: str, change: Callable[[re.Match[str]], str]) -> str:
    code = [(found.start(), found.end()) for found in re.finditer(r"(`+).+?\1", line)]

    def one(link: re.Match[str]) -> str:
        inside = any(start <= link.start() < end for start, end in code)
        return link[0] if inside else change(link)

    return _LINK.sub(one, line)


def anchors(markdown: str) -> set[str]:
    """The anchors of a page's headings, as mkdocs and GitHub make them."""
    found: set[str] = set()
    fenced = False
    for line in markdown.split("\n"):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        heading = None if fenced else re.match(r"#{1,6} +(.+?) *#*$", line)
        if heading is not None:
            plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
            found.add(re.sub(r"[^\w\- ]", "", plain).strip().replace(" ", "-"))
    return found
