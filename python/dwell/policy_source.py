"""What a policy is made of: a hash of its source, which tells results of two policies apart."""

from __future__ import annotations

import hashlib
import inspect
import os
import sys
import sysconfig
import types
from collections.abc import Iterator

from dwell import ConfigError
from dwell.arguments import quoted
from dwell.files import open_file

#: Where modules lie that are not the policy's own.
_INSTALLED = ("purelib", "platlib", "stdlib", "platstdlib")


def source_hash(given: object, made: object) -> str | None:
    """A hash of the source that a policy is made of.

    Of the module that is named, of those of its class and the classes above, and of what these
    import from the same folder or package; and of the policy's attribute ``identity``, a text by
    which it says what else it is made of, such as the weights that it has read.

    Args:
        given: What was given: the policy, what made it, or ``"module:Name"``.
        made: The policy.

    Returns:
        64 hexadecimal digits; ``None`` where there is no source to read, as in an interactive
        session.

    Raises:
        ConfigError: ``identity`` is no text.
    """
    roots = _module_names(given, made)
    files: set[tuple[str, str]] = set()
    for name in roots:
        for path in _files_from(sys.modules.get(name)):
            digest = file_digest(path)
            if digest is not None:
                # Not where it lies: the same source elsewhere is the same policy.
                files.add((os.path.basename(path), digest))
    if not files:
        return None
    identity = getattr(made, "identity", "")
    if not isinstance(identity, str):
        raise ConfigError(f"the policy's identity is {quoted(identity)}; expected a text")
    rows = [f"{name} {digest}" for name, digest in sorted(files)]
    rows.append(identity)
    return hashlib.sha256("\n".join(rows).encode(errors="replace")).hexdigest()


def _module_names(given: object, made: object) -> list[str]:
    """The modules of what was given and of the classes of what was made."""
    if isinstance(given, str):
        first = given.partition(":")[0]
    else:
        first = str(getattr(given, "__module__", ""))
    classes = [kind.__module__ for kind in type(made).__mro__]
    return [name for name in dict.fromkeys([first, *classes]) if name and not _is_foreign(name)]


def _is_foreign(name: str) -> bool:
    """Returns whether a module is Python's own, or dwell's."""
    top = name.partition(".")[0]
    return top == "dwell" or top in sys.stdlib_module_names


def _files_from(module: types.ModuleType | None) -> Iterator[str]:
    """The files of a module and of those beside it that it imports, directly or not."""
    folder = _own_folder(module)
    waiting, seen = [module], set()
    while waiting:
        one = waiting.pop()
        path = None if one is None else _path(one)
        if one is None or path is None or path in seen:
            continue
        seen.add(path)
        yield path
        if folder is None:
            continue
        for value in [*vars(one).values()]:
            other = value if isinstance(value, types.ModuleType) else _module_of(value)
            found = None if other is None else _path(other)
            if found is not None and found.startswith(folder):
                waiting.append(other)


def _module_of(value: object) -> types.ModuleType | None:
    if not isinstance(value, type | types.FunctionType):
        value = type(value)
    name = getattr(value, "__module__", None)
    return sys.modules.get(name) if isinstance(name, str) else None


def _own_folder(module: types.ModuleType | None) -> str | None:
    """The folder of a module's package, or in which it lies; ``None`` for a folder of many."""
    path = None if module is None else _path(module)
    if module is None or path is None:
        return None
    top = sys.modules.get(module.__name__.partition(".")[0])
    if top is not None and hasattr(top, "__path__"):
        return os.path.join(os.path.dirname(_path(top) or path), "")
    folder = os.path.dirname(path)
    installed = {os.path.abspath(sysconfig.get_path(name)) for name in _INSTALLED}
    return None if folder in installed else os.path.join(folder, "")


def _path(module: types.ModuleType) -> str | None:
    try:
        found = inspect.getsourcefile(module)
    except (TypeError, AttributeError):
        return None
    return None if found is None else os.path.abspath(found)


def file_digest(path: str) -> str | None:
    """The SHA-256 of a file, hexadecimal; ``None`` where it cannot be read."""
    digest = hashlib.sha256()
    try:
        with open_file(path) as file:
            while piece := file.read(2**20):
                digest.update(piece)
    except (OSError, ValueError):
        return None
    return digest.hexdigest()
