"""Policies that are evaluated: baselines by name, and those of users."""

from __future__ import annotations

import inspect
import types
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from gymnasium import spaces

from dwell import ConfigError
from dwell.arguments import allowed_values, integer_in_range, mapping, quoted
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


class _Constant:
    def __init__(self, env: DwellEnv, action: str) -> None:
        self._action = with_answer(env.actions().index(action), env)

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        del observation
        return self._action


class _Random:
    """Every action is equally likely, ``stop`` too."""

    def __init__(self, env: DwellEnv) -> None:
        self._env, self._count = env, len(env.actions())
        self._stream = np.random.default_rng(0)

    def reset(self, observation: Mapping[str, Any], info: Mapping[str, Any]) -> None:
        del observation
        # Of the episode, so that it goes the same way in any order.
        self._stream = np.random.default_rng(seed_of(info["episode_id"]))

    def act(self, observation: Mapping[str, Any]) -> Any:  # noqa: ANN401 - of the action space
        del observation
        return with_answer(int(self._stream.integers(self._count)), self._env, self._stream)


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
    if isinstance(policy, str):
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
        made = made()
    if not callable(getattr(made, "act", None)) or inspect.isclass(made):
        raise ConfigError(f"policy is {quoted(made)}; expected an object with act(observation)")
    chosen: Policy = made
    return chosen


def with_answer(
    number: int, env: DwellEnv, stream: np.random.Generator | None = None
) -> int | dict[str, Any]:
    """An action of an environment with an answer, where its task expects one.

    Args:
        number: The action's number.
        env: The environment.
        stream: Draws every field of the answer, each value equally likely; without it they are 0.
    """
    if not isinstance(env.action_space, spaces.Dict):
        return number
    answer: dict[str, Any] = {}
    for name, space in env.action_space["answer"].items():  # type: ignore[attr-defined] # a Dict
        if isinstance(space, spaces.Discrete):
            answer[name] = 0 if stream is None else int(stream.integers(space.n))
        else:
            low, high = float(space.low[0]), float(space.high[0])
            share = 0.0 if stream is None else stream.uniform(low, high)
            answer[name] = np.array([share], np.float32)
    return {"action": number, "answer": answer}


def checked_action(action: object, env: DwellEnv) -> tuple[int, dict[str, Any] | None]:
    """The number of an action that a policy gave, and the answer in it, as JSON holds them.

    Raises:
        ConfigError: It is none.
    """
    answer = None
    if isinstance(env.action_space, spaces.Dict):
        parts = mapping("the policy's action", action, "a mapping with action and answer")
        if set(parts) != {"action", "answer"}:
            raise ConfigError(
                f"the policy's action has {sorted(parts)}; expected action and answer"
            )
        action = parts["action"]
        given = mapping("the policy's answer", parts["answer"])
        answer = {name: _number(f"the policy's answer: {name}", given[name]) for name in given}
    if isinstance(action, np.ndarray) and action.size == 1:
        action = action.reshape(())[()]
    number = integer_in_range("the policy's action", action, high=len(env.actions()) - 1)
    return number, answer


def _number(at: str, value: object) -> float | int:
    """A number, also as an array of one."""
    array = np.asarray(value)
    if array.size != 1 or array.dtype.kind not in "iuf":
        raise ConfigError(f"{at} is {quoted(value)}; expected a number")
    number: float | int = array.reshape(())[()].item()
    return number
