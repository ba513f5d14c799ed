"""Actions as policies give them, as results hold them, and as they are packed."""

from __future__ import annotations

import itertools
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

from dwell import ConfigError, _native
from dwell.arguments import integer_in_range, mapping, quoted, sequence_items

if TYPE_CHECKING:
    from dwell.envs import DwellEnv

#: A number, and how many times.
_RUN = re.compile(r"([0-9]{1,9})(?:\*([0-9]{1,9}))?")
#: Of an episode that is read.
_MOST_ACTIONS = 10_000_000


def spoken_actions(env: DwellEnv) -> list[str]:
    """The names of the discrete actions that an environment's form of actions can say."""
    from dwell.envs.action_modes import OF_BODY, VelocityActions
    from dwell.envs.asking import AskingActions

    form = env.action_form
    form = form.form if isinstance(form, AskingActions) else form
    return [*OF_BODY] if isinstance(form, VelocityActions) else env.actions()


def said_action(name: str, env: DwellEnv, stream: np.random.Generator | None = None) -> Any:  # noqa: ANN401 - of the action space
    """A discrete action in the form that an environment takes, on what the agent looks at.

    With an answer, where the task expects one.

    Args:
        name: The action's name.
        env: The environment.
        stream: Draws every field of the answer, each value equally likely; without it they are 0.
    """
    from dwell.envs.action_modes import first_of

    number = _native.actions().index(name)
    own = first_of(env.action_form.expert(np.array([number], np.int64)))
    own = int(own) if isinstance(own, np.integer) else own
    if not env.has_answers:
        return own
    answer: dict[str, Any] = {}
    for field, space in env.action_space["answer"].items():  # type: ignore[index] # a Dict
        if isinstance(space, spaces.Discrete):
            answer[field] = 0 if stream is None else int(stream.integers(space.n))
        else:
            low, high = float(space.low[0]), float(space.high[0])
            share = 0.0 if stream is None else stream.uniform(low, high)
            answer[field] = np.array([share], np.float32)
    return {**(own if isinstance(own, dict) else {"action": own}), "answer": answer}


def written_action(action: object, env: DwellEnv) -> tuple[Any, dict[str, Any] | None]:
    """An action that a policy gave, and the answer in it, as JSON holds them.

    Raises:
        ConfigError: It is none.
    """
    answer = None
    if env.has_answers:
        parts = mapping("the policy's action", action, "a mapping with action and answer")
        space = env.action_space
        expected = [*space.spaces] if isinstance(space, spaces.Dict) else []
        if set(parts) != set(expected):
            raise ConfigError(
                f"the policy's action has {sorted(parts)}; expected {' and '.join(expected)}"
            )
        given = mapping("the policy's answer", parts.pop("answer"))
        answer = {name: _number(f"the policy's answer: {name}", given[name]) for name in given}
        action = parts if isinstance(env.action_form.space, spaces.Dict) else parts["action"]
    own_space = env.action_form.space
    if isinstance(own_space, spaces.Discrete):
        if isinstance(action, np.ndarray) and action.size == 1:
            action = action.reshape(())[()]
        return integer_in_range("the policy's action", action, high=int(own_space.n) - 1), answer
    try:
        env.action_form.one(action)
    except ConfigError as error:
        raise ConfigError(f"the policy's action: {error}") from None
    return _written(own_space, action), answer


def element_of(written: Any, answer: Mapping[str, Any] | None, env: DwellEnv) -> Any:  # noqa: ANN401 - of the action space
    """The element of an environment's action space that :func:`written_action` wrote."""
    own = _element(env.action_form.space, written)
    if answer is None:
        return own
    return {**(own if isinstance(own, dict) else {"action": own}), "answer": answer}


def _written(space: spaces.Space[Any], value: Any) -> Any:  # noqa: ANN401 - an element
    if isinstance(space, spaces.Dict):
        return {name: _written(part, value[name]) for name, part in space.items()}
    if isinstance(space, spaces.Discrete):
        return int(np.asarray(value).reshape(())[()])
    kind = np.int64 if isinstance(space, spaces.MultiDiscrete) else np.float32
    return np.asarray(value, kind).reshape(space.shape or ()).tolist()


def _element(space: spaces.Space[Any], written: Any) -> Any:  # noqa: ANN401 - an element
    if isinstance(space, spaces.Dict):
        return {name: _element(part, written[name]) for name, part in space.items()}
    if isinstance(space, spaces.Discrete):
        return written
    return np.array(written, np.int64 if isinstance(space, spaces.MultiDiscrete) else np.float32)


def _number(at: str, value: object) -> float | int:
    """A number, also as an array of one."""
    array = np.asarray(value)
    if array.size != 1 or array.dtype.kind not in "iuf":
        raise ConfigError(f"{at} is {quoted(value)}; expected a number")
    number: float | int = array.reshape(())[()].item()
    return number


def packed(actions: Iterable[Any]) -> Any:  # noqa: ANN401 - text or a list
    """Actions as a result holds them, equal ones in a row together.

    Returns:
        Of numbers a text, ``1*12 3 0``: twelve times action 1, then 3, then 0. Of other forms a
        list of ``[times, action]``.
    """
    runs = [(same[0], len(same)) for _, same in _runs(actions)]
    if all(isinstance(action, int) for action, _ in runs):
        return " ".join(f"{number}*{count}" if count > 1 else f"{number}" for number, count in runs)
    return [[count, action] for action, count in runs]


def _runs(actions: Iterable[Any]) -> Iterable[tuple[str, list[Any]]]:
    for key, same in itertools.groupby(actions, json.dumps):
        yield key, [*same]


def unpacked(name: str, written: object) -> list[Any]:
    """The actions of :func:`packed`.

    Raises:
        ConfigError: It is none.
    """
    actions: list[Any] = []
    for count, action in _counted(name, written):
        if len(actions) + count > _MOST_ACTIONS:
            raise ConfigError(f"{name}: more than {_MOST_ACTIONS} actions")
        actions += [action] * count
    return actions


def _counted(name: str, written: object) -> Iterable[tuple[int, Any]]:
    if isinstance(written, str):
        for word in written.split():
            found = _RUN.fullmatch(word)
            if found is None:
                raise ConfigError(
                    f"{name}: found {quoted(word, 60)}; expected NUMBER or NUMBER*COUNT, each of 1 "
                    "to 9 digits"
                )
            yield int(found[2] or 1), int(found[1])
        return
    expected = "expected text, or a list of [times, action]"
    for k, row in enumerate(sequence_items(name, written, expected)):
        if not isinstance(row, list | tuple) or len(row) != 2:
            raise ConfigError(f"{name}[{k}] is {quoted(row, 60)}; expected [times, action]")
        yield integer_in_range(f"{name}[{k}][0]", row[0], low=1), row[1]


def refuse_other_form(name: str, actions: Sequence[Any], env: DwellEnv) -> None:
    """Refuses actions of a result that an environment does not take.

    Raises:
        ConfigError: The message begins with ``name`` and the first that is none.
    """
    space = env.action_form.space
    for k, action in enumerate(actions):
        try:
            if isinstance(space, spaces.Discrete):
                integer_in_range("action", action, high=int(space.n) - 1)
            else:
                env.action_form.one(action)
        except ConfigError as error:
            raise ConfigError(f"{name}: action {k} of {len(actions)}: {error}") from None
