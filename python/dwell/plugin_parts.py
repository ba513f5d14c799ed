"""The common base of environments' parts in Python: tasks, rewards and sensors."""

from __future__ import annotations

import contextlib
import functools
import importlib
import inspect
import os
import traceback
import types
import weakref
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar

from dwell import ConfigError, UsageError
from dwell.arguments import mapping, quoted, refuse_unknown, text
from dwell.messages import with_short_words

_Part = TypeVar("_Part", bound="PluginPart")
#: Who plays with a part, by the part's identity; they hold it, so that it is nobody else's.
_USERS: weakref.WeakValueDictionary[int, object] = weakref.WeakValueDictionary()


@contextlib.contextmanager
def refusing_exit() -> Iterator[None]:
    """Code of a user's that is called in the block does not end the process without a word.

    Raises:
        UsageError: It called ``sys.exit``.
    """
    try:
        yield
    except SystemExit as stop:
        raise UsageError(f"code that dwell called ends the process: {_exit(stop)}") from stop


def _exit(stop: SystemExit) -> str:
    """What was called, and where."""
    frames = traceback.extract_tb(stop.__traceback__)
    code = "" if stop.code is None else quoted(stop.code)
    where = f"{os.path.basename(frames[-1].filename)} line {frames[-1].lineno}"
    return f"sys.exit({code}) in {where}; to say that something is wrong, raise an error"


class PluginPart:
    """A part of an environment in Python. Every environment makes its own.

    Attributes:
        state: What the part remembers within an episode, by name; empty at each start. It goes into
            the environment's snapshots, so it holds what JSON holds: numbers, text, lists, and
            dicts with text for keys, all of Python's own kinds. Taking a snapshot refuses arrays
            and tuples, which would come back as lists, and NumPy's numbers and enumerations, which
            would come back as plain ones.
        agent: Which of the world's agents the environment is about: ``world.agents()[self.agent]``.
    """

    state: dict[str, Any]
    agent: int = 0


def factory(
    at: str, given: object, kind: type[_Part], settings: Mapping[str, Any] | None = None
) -> Callable[[], _Part]:
    """The factory of parts of a kind: a class, a function, or ``"module:Name"`` of a class.

    What a name stands for is called only if it is a class of the kind.

    Args:
        at: What the argument is called, for errors.
        given: The argument.
        kind: What shall come out.
        settings: What it is called with.

    Raises:
        ConfigError: It is none of these, lacks a method, or there is no such module or name.
    """
    make = imported(at, given) if isinstance(given, str) else given
    if isinstance(make, kind):
        name = type(make).__name__
        raise ConfigError(
            f"{at} is a {name} that exists already; expected the class {name} itself, of which "
            "every environment makes its own"
        )
    # What a partial calls in the end.
    called = make
    while isinstance(called, functools.partial):
        called = called.func
    is_class = isinstance(called, type) and issubclass(called, kind)
    # Nobody is called who only happens to be callable, as os.abort is.
    is_function = isinstance(called, types.FunctionType | types.MethodType)
    of = "of the settings" if settings else "without arguments"
    expected = (
        f"expected a subclass of dwell.{kind.__name__}, a function {of} that makes one, or "
        "'module:Name' of a subclass"
    )
    if not callable(make) or not (is_class or (is_function and not isinstance(given, str))):
        raise ConfigError(f"{at} is {quoted(given)}; {expected}")
    if missing := sorted(getattr(called, "__abstractmethods__", ())):
        raise ConfigError(f"{at}: {quoted(given)} lacks the method {missing[0]}")
    fields = {} if settings is None else mapping(f"settings of {at}", settings)
    if fields:
        _refuse_unknown_settings(f"settings of {at}", make, fields)
    try:
        inspect.signature(make).bind(**fields)
    except TypeError as error:
        by = "settings" if fields else "no arguments"
        raise ConfigError(
            f"{at} is {quoted(given)}, which cannot be called with {by}: {error}; {expected}"
        ) from None
    except ValueError:
        # Some that are not written in Python have no signature; they say themselves what is wrong.
        pass

    def made() -> _Part:
        part = make(**fields)
        if not isinstance(part, kind):
            raise ConfigError(
                f"{at}: {quoted(make)} made {quoted(part)}; expected a dwell.{kind.__name__}"
            )
        # Of one that an environment plays with, the state is that environment's.
        if id(part) not in _USERS:
            part.state = {}
        return part

    return made


def claim_part(part: PluginPart, user: object, is_same: Callable[[Any], bool]) -> None:
    """Says who plays with a part as long as they live: states would mix where it were two.

    Args:
        part: The part.
        user: Who plays with it.
        is_same: Whether another user, who claimed it before, is the same environment.

    Raises:
        ConfigError: Another environment plays with it.
    """
    other = _USERS.get(id(part))
    if other is not None and not is_same(other):
        name = type(part).__name__
        raise ConfigError(
            f"found the same {name} in two environments; every one has its own: expected the "
            f"class, or a function that makes a new {name} each time it is called"
        )
    _USERS[id(part)] = user


def _refuse_unknown_settings(
    at: str, make: Callable[..., object], fields: Mapping[str, object]
) -> None:
    """Refuses settings that are no arguments of their part, where these can be known."""
    try:
        arguments = inspect.signature(make).parameters.values()
    except (TypeError, ValueError):
        return
    if any(one.kind is one.VAR_KEYWORD for one in arguments):
        return
    known = [
        one.name for one in arguments if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)
    ]
    refuse_unknown(at, [name for name in fields if name not in known], known)


def imported(at: str, given: str) -> object:
    """What ``"module:Name"`` stands for; nothing of it is called.

    Raises:
        ConfigError: There is no such module or name, or the module called ``sys.exit``.
    """
    module, _, name = given.partition(":")
    try:
        return getattr(importlib.import_module(text(at, module)), name)
    except SystemExit as stop:
        raise ConfigError(
            f"{at} is {quoted(given)}, whose module ends the process: {_exit(stop)}"
        ) from stop
    # TypeError: a relative name, of which nobody knows whose relative it is.
    except (ImportError, AttributeError, ValueError, TypeError) as error:
        why = with_short_words(str(error))
        raise ConfigError(f"{at} is {quoted(given)}; expected 'module:Name': {why}") from None
