"""The guide: the numbered examples, each with its source."""

from __future__ import annotations

import ast
import re

from pages.sources import ROOT, text


def _examples() -> list[str]:
    return sorted(path.stem for path in (ROOT / "examples").glob("[0-9][0-9]_*.py"))


def paths() -> list[str]:
    """The pages in order."""
    return ["guide/index.md", *(f"guide/{stem}.md" for stem in _examples())]


def listed() -> dict[str, str]:
    """What the list of examples says of each."""
    rows = re.findall(r"\]\((\w+)\.py\): (.+)$", text("examples/README.md"), re.MULTILINE)
    return dict(rows)


def pages() -> dict[str, str]:
    """A page for each example."""
    return {f"guide/{stem}.md": _page(stem) for stem in _examples()}


def _page(stem: str) -> str:
    source = text(f"examples/{stem}.py")
    about = (ast.get_docstring(ast.parse(source)) or "").strip()
    name = stem[3:].replace("_", " ").capitalize()
    program = source.split('"""', 2)[2].strip()
    return f"""# {int(stem[:2])}. {name}

{about}

```python
{program}
```

`python examples/{stem}.py` runs it.
"""
