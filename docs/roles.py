"""Roles such as ``:meth:`step` `` in docstrings, as links of mkdocstrings."""

from __future__ import annotations

import re
from typing import Any

import griffe
from pages import api

_ROLE = re.compile(r":(?:class|meth|func|data|mod):`~?([\w.]+)`")


class Roles(griffe.Extension):
    """Rewrites docstrings once the package is loaded.

    What the site shows becomes a link, which mkdocs checks; the rest becomes code.
    """

    def on_object(self, *, obj: griffe.Object, loader: griffe.GriffeLoader, **kwargs: Any) -> None:  # noqa: ANN401
        """Rewrites one docstring."""
        del kwargs
        if obj.docstring is not None:
            obj.docstring.value = _ROLE.sub(
                lambda role: _linked(role[1], obj, loader), obj.docstring.value
            )


def _linked(name: str, obj: griffe.Object, loader: griffe.GriffeLoader) -> str:
    scope: griffe.Object | griffe.Alias | None = obj
    while scope is not None:
        path = _shown(f"{scope.path}.{name}", loader)
        if path is not None:
            return f"[`{name}`][{path}]"
        scope = scope.parent
    path = _shown(name, loader)
    return f"`{name}`" if path is None else f"[`{name}`][{path}]"


def _shown(path: str, loader: griffe.GriffeLoader) -> str | None:
    """Where the site shows an object, if it does."""
    try:
        real: str = loader.modules_collection[path].canonical_path
    except (KeyError, griffe.AliasResolutionError):
        return None
    for module, names in api.modules().items():
        for name in names:
            at = loader.modules_collection[f"{module}.{name}"].canonical_path
            if real == at or real.startswith(f"{at}."):
                return real
        if real == module:
            return real
    return None
