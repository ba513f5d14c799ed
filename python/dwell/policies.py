"""Policies that are evaluated: baselines by name, and those of users."""

from __future__ import annotations

import contextlib
import importlib
import inspect
import os
import traceback
import types
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from dwell import ConfigError, DwellError
from dwell.arguments import allowed_values, quoted
from dwell.ears_policy import Ears
from dwell.played_actions import said_action, spoken_actions
from dwell.plugin_parts import imported
from dwell.stated_episodes import seed_of

if TYPE_CHECKING:
    from dwell.envs import DwellEnv


class Policy(Protocol):
    """What chooses actions. A method ``reset(observation, info)`` is called where there is one.

    ``reset`` begins an episode, with the observation and info of the environment's own ``reset``;
    whatever a policy remembers of an episode before should be forgotten there, and what it draws
    should come from ``info["episode_id"]``, so that an episode goes the same way in any order.
    """

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        """The next action, an element of the environment's action space."""


class PolicyError(DwellError):
    """What a user's policy raised; ``trace`` is the traceback, from the policy's own code on.

    It goes through processes: its arguments are texts.
    """

    def __init__(self, sentence: str, trace: str) -> None:
        """Takes the sentence and the traceback's text."""
        super().__init__(sentence, trace)
        self.trace = trace

    def __str__(self) -> str:
        """The sentence."""
        return str(self.args[0])


@contextlib.contextmanager
def naming_policy(name: str, where: str) -> Iterator[None]:
    """Errors in the block are told as those of a policy, with the traceback of its own code.

    Args:
        name: What a result calls the policy.
        where: What it was doing.

    Raises:
        PolicyError: Something was raised that is no interruption; ``sys.exit`` raises, too.
    """
    try:
        yield
    except (Exception, SystemExit) as error:
        shown = "".join(traceback.format_exception(type(error), error, _own_trace(error)))
        said = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise PolicyError(f"the policy {name} raised {said}, {where}", shown) from error


def _own_trace(error: BaseException) -> types.TracebackType | None:
    """The traceback from the first frame on that is not dwell's; all of it where every one is."""
    package = os.path.join(os.path.dirname(os.path.abspath(__file__)), "")
    between = (str(contextlib.__file__), str(importlib.__file__))
    trace = error.__traceback__
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if not file.startswith((package, "<frozen importlib")) and file not in between:
            return trace
        trace = trace.tb_next
    return error.__traceback__


class _Constant:
    def __init__(self, env: DwellEnv, action: str) -> None:
        self._action = said_action(action, env)

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        del observation
        return self._action


class _Random:
    """Every action is equally likely, ``stop`` too; hands act on what the agent looks at.

    In the action mode ``velocity``, which has no other names, these are the actions of feet and
    head.
    """

    def __init__(self, env: DwellEnv) -> None:
        self._env = env
        self._names = spoken_actions(env)
        self._stream = np.random.default_rng(0)

    def reset(self, observation: Mapping[str, Any], info: Mapping[str, Any]) -> None:
        del observation
        # Of the episode, so that it goes the same way in any order.
        self._stream = np.random.default_rng(seed_of(info["episode_id"]))

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        del observation
        name = self._names[int(self._stream.integers(len(self._names)))]
        return said_action(name, self._env, self._stream)


class _Expert:
    """The task's own, which knows the house."""

    def __init__(self, env: DwellEnv) -> None:
        self._env = env

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        del observation
        return self._env.expert_action()


#: What makes the baselines, by name.
BASELINES: dict[str, Callable[[DwellEnv], Policy]] = {
    "random": _Random,
    "expert": _Expert,
    "stop": lambda env: _Constant(env, "stop"),
    "forward": lambda env: _Constant(env, "move_forward"),
    "ears": Ears,
}


def name_of(policy: object) -> str:
    """What a result calls a policy."""
    if isinstance(policy, str):
        return policy
    kind = policy if isinstance(policy, type | types.FunctionType) else type(policy)
    return f"{kind.__module__}:{kind.__qualname__}"


def policy_of(policy: object, env: DwellEnv) -> Policy:
    """A policy for an environment.

    Args:
        policy: The name of a baseline; a policy; a class or function that makes one without
            arguments; or ``"module:Name"`` of such a class or function.
        env: What it plays in.

    Raises:
        ConfigError: It is none of these.
    """
    if isinstance(policy, str) and policy in BASELINES:
        return BASELINES[policy](env)
    if isinstance(policy, str) and ":" not in policy:
        raise ConfigError(
            f"policy is {quoted(policy)}; {allowed_values(policy, BASELINES)} and 'module:Name'"
        )
    made: Any = policy
    name = name_of(policy)
    if isinstance(policy, str):
        _import(policy)
        made = imported("policy", policy)
        # Nothing is called that its module has from elsewhere or that is no policy's maker.
        is_own = getattr(made, "__module__", None) == policy.partition(":")[0]
        is_maker = isinstance(made, types.FunctionType) and is_own
        if not is_maker and not callable(getattr(made, "act", None)):
            raise ConfigError(
                f"policy is {quoted(policy)}; expected a class with a method act(observation), or "
                "a function of that module that makes a policy"
            )
    if isinstance(made, type | types.FunctionType | types.MethodType):
        if needed := _needed_arguments(made):
            raise ConfigError(
                f"policy {name} is made with {needed}; expected a class or function that makes one "
                "without arguments"
            )
        with naming_policy(name, "when it was made"):
            made = made()
    if not callable(getattr(made, "act", None)) or inspect.isclass(made):
        raise ConfigError(f"policy is {quoted(made)}; expected an object with act(observation)")
    chosen: Policy = made
    return chosen


def _needed_arguments(maker: Callable[..., Any]) -> str:
    """The arguments without which a maker cannot be called, as ``"a, b"``."""
    try:
        parameters = inspect.signature(maker).parameters.values()
    except (TypeError, ValueError):
        # What is written in C may not tell.
        return ""
    rest = inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD
    needed = [one for one in parameters if one.default is one.empty and one.kind not in rest]
    return ", ".join(one.name for one in needed)


def _import(policy: str) -> None:
    """Imports the module of ``"module:Name"``; that there is none is told by others.

    Raises:
        PolicyError: The module raised something.
    """
    module = policy.partition(":")[0]
    with naming_policy(policy, "when its module was imported"):
        try:
            importlib.import_module(module)
        except ModuleNotFoundError as error:
            if error.name is None or not f"{module}.".startswith(f"{error.name}."):
                raise
        except (TypeError, ValueError):
            # A name that is none, as ''.
            if module.strip(".") == module and module:
                raise
