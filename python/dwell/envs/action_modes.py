"""Forms of actions: the space of an environment's action, and what the engine takes for it.

Adding a form is one class and one line in :data:`ACTION_MODES`; the engine knows its name
(``ActionMode``).
"""

from __future__ import annotations

import abc
import dataclasses
import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from dwell import ConfigError, UsageError, _native
from dwell.arguments import (
    boolean,
    from_json,
    integer_in_range,
    mapping,
    quoted,
)
from dwell.envs.action_arrays import (
    choices_below,
    exact_fields,
    numbers_within,
    plain_array,
    stacked_fields,
    whole_numbers,
)
from dwell.envs.asking import MAX_QUESTION_TOKENS, AskingActions, question_row
from dwell.envs.movement_velocities import velocities_of
from dwell.envs.utterance_rows import MAX_TOKENS, NORMAL_EFFORT, said_of_row

#: Of the first axis of velocities: forward, right, turn to the left, look up.
_VELOCITY_NAMES = ("forward", "right", "turn", "look")
#: What velocities and ``stop`` say, whatever the hands can do.
OF_BODY = ("stop", "move_forward", "turn_left", "turn_right", "look_up", "look_down")
#: Below this, all of them, velocities alone say ``stop``.
STOP_BELOW = 0.05
#: The turn by which ``wait`` is said in velocities alone, of which the least stand for ``stop``.
_LEAST_TURN = 0.06
#: Ids of things that an action can name: more than any house has.
_IDS = 1 << 20
#: Numbers that an answer can have, whatever the task.
ANSWER_FIELDS = 4


@dataclasses.dataclass(frozen=True)
class EngineActions:
    """Actions of several environments as the engine takes them.

    Attributes:
        numbers: Of the discrete actions, -1 for none, shape (n,) int64.
        velocities: Shares of what movement actions make, shape (n, 4) float32; ``None``: theirs.
        places: Of pictures, shares of width and height, shape (n, 2) float32.
        objects: Ids of things, 0 for what is looked at, shape (n,) int64.
        answers: Numbers that the task expects with ``stop``, shape (n, 4) float32.
        tokens: What is said from now on, numbers of words up to the first 0, shape (n, 8) int64.
        efforts: With which of the vocal efforts, shape (n,) int64.
        questions: What is asked of oracles, as ``tokens``, shape (n, 16) int64.
    """

    numbers: NDArray[np.int64]
    velocities: NDArray[np.float32] | None = None
    places: NDArray[np.float32] | None = None
    objects: NDArray[np.int64] | None = None
    answers: NDArray[np.float32] | None = None
    tokens: NDArray[np.int64] | None = None
    efforts: NDArray[np.int64] | None = None
    questions: NDArray[np.int64] | None = None

    def step(self, batch: _native.Batch) -> dict[str, Any]:
        """One control step of all environments of a batch; what its ``step`` answers."""
        velocities, places, objects = self.velocities, self.places, self.objects
        return batch.step(
            np.ascontiguousarray(self.numbers),
            None if velocities is None else np.ascontiguousarray(velocities).ravel(),
            None if places is None else np.ascontiguousarray(places).ravel(),
            None if objects is None else np.ascontiguousarray(objects),
            None if self.answers is None else np.ascontiguousarray(self.answers).ravel(),
            None if self.tokens is None else np.ascontiguousarray(self.tokens).ravel(),
            None if self.efforts is None else np.ascontiguousarray(self.efforts),
            None if self.questions is None else np.ascontiguousarray(self.questions).ravel(),
        )

    def without(self, idle: NDArray[np.bool_]) -> EngineActions:
        """The same, with none in the environments of ``idle``."""
        return dataclasses.replace(self, numbers=np.where(idle, -1, self.numbers))

    @classmethod
    def interleaved(cls, agents: Sequence[EngineActions]) -> EngineActions:
        """The rows of several agents as the engine takes them: those of an environment together.

        Args:
            agents: The actions of each agent, one for each environment.
        """

        def joined(name: str, empty: NDArray[Any]) -> Any:  # noqa: ANN401 - an array, or none
            given = [getattr(own, name) for own in agents]
            if all(rows is None for rows in given):
                return None
            shape = (len(agents[0].numbers), *empty.shape)
            rows = [np.broadcast_to(empty, shape) if one is None else one for one in given]
            return np.stack(rows, 1).reshape(-1, *empty.shape)

        # What is NaN is not stated.
        return cls(
            np.stack([own.numbers for own in agents], 1).ravel(),
            joined("velocities", np.full(4, np.nan, np.float32)),
            joined("places", np.full(2, np.nan, np.float32)),
            joined("objects", np.zeros((), np.int64)),
            joined("answers", np.full(ANSWER_FIELDS, np.nan, np.float32)),
            joined("tokens", np.zeros(MAX_TOKENS, np.int64)),
            joined("efforts", np.full((), NORMAL_EFFORT, np.int64)),
            joined("questions", np.zeros(MAX_QUESTION_TOKENS, np.int64)),
        )

    def names(self) -> list[str]:
        """The names of the discrete actions; none is ''."""
        known = [*_native.actions(), ""]
        return [known[number] for number in self.numbers.tolist()]

    def row(self, env: int) -> str | dict[str, Any]:
        """One environment's action as files hold it: a name, or a mapping that says more."""
        row: dict[str, Any] = {"action": _native.actions()[self.numbers[env]]}
        if self.velocities is not None:
            row["velocity"] = self.velocities[env].tolist()
        if self.places is not None:
            row["pixel"] = self.places[env].tolist()
        if self.objects is not None:
            row["object"] = int(self.objects[env])
        if self.answers is not None:
            row["answer"] = self.answers[env].tolist()
        if self.questions is not None and self.questions[env].any():
            row["question"] = self.questions[env].tolist()
        if self.tokens is not None and self.tokens[env, 0] > 0:
            # All up to the first 0; behind it nothing is said.
            words = [*itertools.takewhile(bool, self.tokens[env].tolist())]
            effort = NORMAL_EFFORT if self.efforts is None else int(self.efforts[env])
            row["say"] = {"tokens": words, "effort": _native.vocal_efforts()[effort]}
        return row if len(row) > 1 else str(row["action"])

    @classmethod
    def of_row(cls, at: str, row: object) -> EngineActions:
        """The action of one environment that :meth:`row` gave.

        Raises:
            ConfigError: It is none; the message begins with ``at``.
        """
        fields = {"action": row} if isinstance(row, str) else mapping(at, row)
        names = _native.actions()
        allowed = ("action", "velocity", "pixel", "object", "answer", "question", "say")
        if unknown := sorted(set(fields) - {*allowed}):
            raise ConfigError(f"{at} has {unknown[0]!r}; allowed are {', '.join(allowed)}")
        if "action" not in fields:
            raise ConfigError(f"{at} has no 'action'; allowed are {', '.join(names)}")
        if fields["action"] not in names:
            found = quoted(fields["action"])
            raise ConfigError(f"{at} is {found}; allowed are {', '.join(names)}")
        numbers = np.array([names.index(fields["action"])], np.int64)
        one = (1,)
        velocity, pixel, thing, answer, question, say = (fields.get(key) for key in allowed[1:])
        tokens, efforts = (None, None) if say is None else said_of_row(f"{at}: say", say)
        return cls(
            numbers,
            None
            if velocity is None
            else numbers_within(f"{at}: velocity", velocity, one, 4, (-1.0, 1.0)),
            None if pixel is None else numbers_within(f"{at}: pixel", pixel, one, 2, (0.0, 1.0)),
            None if thing is None else whole_numbers(f"{at}: object", thing, one, _IDS - 1),
            None
            if answer is None
            else numbers_within(f"{at}: answer", answer, one, ANSWER_FIELDS, (-1e6, 1e6)),
            questions=None if question is None else question_row(f"{at}: question", question),
            tokens=tokens,
            efforts=efforts,
        )


class DiscreteActions:
    """The number of an action; hands are used on what the agent looks at."""

    def __init__(self, names: Sequence[str]) -> None:
        """Takes the names of the actions, in the order of their numbers."""
        self.names = [*names]
        known = _native.actions()
        self._native = np.array([known.index(name) for name in names], np.int64)
        self.space: spaces.Space[Any] = spaces.Discrete(len(self.names))

    def one(self, action: object) -> EngineActions:
        """The action of one environment.

        Raises:
            ConfigError: It is none of the space.
        """
        number = integer_in_range("action", action, high=len(self.names) - 1)
        return EngineActions(self._native[[number]])

    def many(self, actions: object, count: int) -> EngineActions:
        """The actions of several environments.

        Raises:
            ConfigError: They are none of the space, or not one for each.
        """
        return EngineActions(
            self._native[choices_below("actions", actions, count, len(self.names))]
        )

    def expert(self, numbers: NDArray[np.int64]) -> Any:  # noqa: ANN401 - of the space
        """Actions of the engine's experts as elements of the batched space.

        Raises:
            UsageError: One cannot be said in this form.
        """
        return self._of_engine(numbers)

    def masks(self, possible: NDArray[np.bool_]) -> NDArray[np.int8]:
        """What :meth:`gymnasium.spaces.Discrete.sample` takes, out of all of the engine's actions.

        Args:
            possible: Shape (environment, action of the engine).

        Returns:
            Shape (environment, action).
        """
        return possible[:, self._native].astype(np.int8)

    def _of_engine(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        places = np.full(len(_native.actions()) + 1, -1, np.int64)
        places[self._native] = np.arange(len(self.names))
        found = places[numbers]
        missing = np.flatnonzero((found < 0) & (numbers >= 0)).tolist()
        if missing:
            name = _native.actions()[numbers[missing[0]]]
            raise UsageError(
                f"the expert wants to {name}, which is none of the environment's actions: "
                f"{', '.join(self.names)}"
            )
        return found


class _Targeted(abc.ABC):
    """An action, and what a hand is used on."""

    #: The key of what a hand is used on.
    _key: str

    def __init__(self, names: Sequence[str], target: spaces.Space[Any]) -> None:
        self._verbs = DiscreteActions(names)
        self.names = self._verbs.names
        self.space: spaces.Space[Any] = spaces.Dict(
            {"action": self._verbs.space, self._key: target}
        )

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        return self.many(stacked_fields("action", action, ("action", self._key)), 1)

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        parts = exact_fields("actions", actions, ("action", self._key))
        verbs = self._verbs.many(parts["action"], count)
        return self._with_target(verbs, parts[self._key], (count,))

    @abc.abstractmethod
    def _with_target(
        self, verbs: EngineActions, target: object, shape: tuple[int]
    ) -> EngineActions:
        """The actions with what their hands are used on."""

    def masks(self, possible: NDArray[np.bool_]) -> NDArray[np.int8]:
        """As :meth:`DiscreteActions.masks`, of the field ``action``."""
        return self._verbs.masks(possible)

    def expert(self, numbers: NDArray[np.int64]) -> Any:  # noqa: ANN401 - of the space
        """As :meth:`DiscreteActions.expert`."""
        count = len(numbers)
        return {"action": self._verbs.expert(numbers), self._key: self._looked_at(count)}

    @abc.abstractmethod
    def _looked_at(self, count: int) -> NDArray[Any]:
        """What says that hands are used on what is looked at."""


class PointerActions(_Targeted):
    """An action, and a place in the picture on which hands are used."""

    _key = "pixel"

    def __init__(self, names: Sequence[str]) -> None:
        """As :class:`DiscreteActions`."""
        super().__init__(names, spaces.Box(0.0, 1.0, (2,), np.float32))

    def _with_target(
        self, verbs: EngineActions, target: object, shape: tuple[int]
    ) -> EngineActions:
        places = numbers_within("pixel", target, shape, 2, (0.0, 1.0))
        return dataclasses.replace(verbs, places=places)

    def _looked_at(self, count: int) -> NDArray[np.float32]:
        return np.full((count, 2), 0.5, np.float32)


class ObjectActions(_Targeted):
    """An action, and the id of a thing on which hands are used; 0 for what is looked at."""

    _key = "object"

    def __init__(self, names: Sequence[str]) -> None:
        """As :class:`DiscreteActions`."""
        super().__init__(names, spaces.Discrete(_IDS))

    def _with_target(
        self, verbs: EngineActions, target: object, shape: tuple[int]
    ) -> EngineActions:
        return dataclasses.replace(verbs, objects=whole_numbers("object", target, shape, _IDS - 1))

    def _looked_at(self, count: int) -> NDArray[np.int64]:
        return np.zeros(count, np.int64)


class VelocityActions:
    """Velocities of the body: forward, right, turn to the left, look up.

    Each is a share of what the movement actions make in a step, -1 to 1; all within
    :data:`STOP_BELOW` of 0 say ``stop``.
    """

    def __init__(self, names: Sequence[str]) -> None:
        """Takes ``stop``, which small velocities say."""
        self.names = [*names]
        self.space: spaces.Space[Any] = spaces.Box(-1.0, 1.0, (len(_VELOCITY_NAMES),), np.float32)
        known = _native.actions()
        self._stop, self._wait = known.index("stop"), known.index("wait")

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        return self._of(numbers_within("action", action, (1,), 4, (-1.0, 1.0)))

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        return self._of(numbers_within("actions", actions, (count,), 4, (-1.0, 1.0)))

    def _of(self, velocities: NDArray[np.float32]) -> EngineActions:
        stops = (np.abs(velocities) < STOP_BELOW).all(axis=1)
        return EngineActions(np.where(stops, self._stop, self._wait), velocities)

    def expert(self, numbers: NDArray[np.int64]) -> Any:  # noqa: ANN401 - of the space
        """As :meth:`DiscreteActions.expert`; to wait is to turn by less than half a degree."""
        velocities = velocities_of(numbers)
        for k, number in enumerate(numbers.tolist()):
            if number == self._wait:
                velocities[k, 2] = _LEAST_TURN
        return velocities


class DictActions:
    """Velocities of base and head, and an action of the hand at a place in the picture, together.

    ``base``: forward, right, turn to the left; ``head``: look up; each as in
    :class:`VelocityActions`. ``hand``: 0 for none, then the actions of the hand in order.
    ``pixel``: as in :class:`PointerActions`. ``stop``: 1 declares the task done.
    """

    def __init__(self, names: Sequence[str]) -> None:
        """As :class:`DiscreteActions`; of the names those of hands are numbered.

        Raises:
            ConfigError: A name is missing of what feet and head do, or ``stop``.
        """
        if missing := [name for name in OF_BODY if name not in names]:
            raise ConfigError(
                f"actions have no {', '.join(missing)}; in the action_mode dict feet, head and "
                f"stop are always there: name {', '.join(OF_BODY)} and the actions of hands to "
                "choose from, or leave actions out"
            )
        of_hand = {kind["name"]: kind["is_of_hand"] for kind in _native.action_table()["kinds"]}
        self.names = [*names]
        self._hands = [name for name in names if of_hand[name]]
        known = _native.actions()
        self._stop, self._wait = known.index("stop"), known.index("wait")
        self._native = np.array([self._wait, *map(known.index, self._hands)], np.int64)
        self.space: spaces.Space[Any] = spaces.Dict(
            {
                "base": spaces.Box(-1.0, 1.0, (3,), np.float32),
                "head": spaces.Box(-1.0, 1.0, (1,), np.float32),
                "hand": spaces.Discrete(1 + len(self._hands)),
                "pixel": spaces.Box(0.0, 1.0, (2,), np.float32),
                "stop": spaces.Discrete(2),
            }
        )

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        return self.many(stacked_fields("action", action, self._keys()), 1)

    def _keys(self) -> tuple[str, ...]:
        return ("base", "head", "hand", "pixel", "stop")

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        parts = exact_fields("actions", actions, self._keys())
        shape = (count,)
        base = numbers_within("base", parts["base"], shape, 3, (-1.0, 1.0))
        head = numbers_within("head", parts["head"], shape, 1, (-1.0, 1.0))
        hands = self._native[choices_below("hand", parts["hand"], count, len(self._native))]
        stops = choices_below("stop", parts["stop"], count, 2) == 1
        return EngineActions(
            np.where(stops, self._stop, hands),
            np.concatenate([base, head], axis=1),
            numbers_within("pixel", parts["pixel"], shape, 2, (0.0, 1.0)),
        )

    def masks(self, possible: NDArray[np.bool_]) -> NDArray[np.int8]:
        """As :meth:`DiscreteActions.masks`, of the field ``hand``."""
        return possible[:, self._native].astype(np.int8)

    def expert(self, numbers: NDArray[np.int64]) -> Any:  # noqa: ANN401 - of the space
        """As :meth:`DiscreteActions.expert`."""
        known = self._native.tolist()
        names = _native.actions()
        hands = [
            0 if number < 0 or names[number] in OF_BODY else _place_of(number, known, self._hands)
            for number in numbers.tolist()
        ]
        moves = np.where(np.array(hands) > 0, self._wait, numbers)
        velocities = velocities_of(moves)
        return {
            "base": velocities[:, :3],
            "head": velocities[:, 3:],
            "hand": np.array(hands, np.int64),
            "pixel": np.full((len(numbers), 2), 0.5, np.float32),
            "stop": (numbers == self._stop).astype(np.int64),
        }


class AnsweredActions:
    """Actions of another form, and the answer that the task expects with ``stop``.

    Numbers of an answer are shares of their highest value, as gymnasium recommends: from -1 or 0 on
    to 1. Choices are whole numbers.
    """

    def __init__(self, form: ActionForm, fields: Sequence[Mapping[str, Any]]) -> None:
        """Adds to ``form`` the fields that a batch's ``answer_fields`` names."""
        self.form, self._fields = form, [*fields]
        self.names = form.names
        answer = spaces.Dict({field["name"]: _answer_space(field) for field in fields})
        own = form.space
        self._is_dict = isinstance(own, spaces.Dict)
        parts = dict(own.spaces) if isinstance(own, spaces.Dict) else {"action": own}
        self.space: spaces.Space[Any] = spaces.Dict({**parts, "answer": answer})

    def one(self, action: object) -> EngineActions:
        """As :meth:`DiscreteActions.one`."""
        parts = exact_fields("action", action, list(self.space))  # type: ignore[call-overload] # a Dict
        names = [field["name"] for field in self._fields]
        answer = stacked_fields("answer", parts.pop("answer"), names)
        return self._with(self.form.one(parts if self._is_dict else parts["action"]), answer, 1)

    def many(self, actions: object, count: int) -> EngineActions:
        """As :meth:`DiscreteActions.many`."""
        parts = exact_fields("actions", actions, list(self.space))  # type: ignore[call-overload] # a Dict
        answer = parts.pop("answer")
        form = self.form.many(parts if self._is_dict else parts["action"], count)
        return self._with(form, answer, count)

    def _with(self, actions: EngineActions, answer: object, count: int) -> EngineActions:
        given = exact_fields("answer", answer, [field["name"] for field in self._fields])
        columns = np.zeros((count, ANSWER_FIELDS), np.float32)
        for k, field in enumerate(self._fields):
            at, value = f"answer: {field['name']}", given[field["name"]]
            if field["choices"] is not None:
                columns[:, k] = choices_below(at, value, count, len(field["choices"]))
                continue
            low, high = _shares(field)
            numbers = np.asarray(plain_array(at, value, "numbers")).reshape(-1, 1)
            shares = numbers_within(at, numbers, (count,), 1, (low, high))[:, 0]
            columns[:, k] = shares * field["range"][1]
        return dataclasses.replace(actions, answers=columns)

    def expert(self, numbers: NDArray[np.int64], answers: NDArray[np.float32]) -> Any:  # noqa: ANN401 - of the space
        """As :meth:`DiscreteActions.expert`, with the experts' answers, shape (n, 4)."""
        own = self.form.expert(numbers)
        answer: dict[str, NDArray[Any]] = {}
        for k, field in enumerate(self._fields):
            column = answers[:, k]
            is_choice = field["choices"] is not None
            if is_choice:
                answer[field["name"]] = column.astype(np.int64)
                continue
            shares = np.clip(column / field["range"][1], *_shares(field))
            answer[field["name"]] = shares.astype(np.float32)[:, np.newaxis]
        return {**(own if self._is_dict else {"action": own}), "answer": answer}


def _answer_space(field: Mapping[str, Any]) -> spaces.Space[Any]:
    """The space of a field of an answer."""
    if field["choices"] is not None:
        return spaces.Discrete(len(field["choices"]))
    box: spaces.Box[Any] = spaces.Box(*_shares(field), (1,), np.float32)
    return box


def _shares(field: Mapping[str, Any]) -> tuple[float, float]:
    """Lowest and highest number of a field that is no choice, as shares of its highest value."""
    return (-1.0 if field["range"][0] < 0 else 0.0), 1.0


ActionForm = (
    DiscreteActions | PointerActions | ObjectActions | VelocityActions | DictActions | AskingActions
)

#: By ``action_mode``.
ACTION_MODES: dict[str, Callable[[Sequence[str]], ActionForm]] = {
    "discrete": DiscreteActions,
    "velocity": VelocityActions,
    "pointer": PointerActions,
    "object": ObjectActions,
    "dict": DictActions,
}


def action_form(
    config: str,
    answer_fields: Sequence[Mapping[str, Any]] = (),
    agent: int = 0,
    *,
    asks: bool = False,
) -> ActionForm | AnsweredActions:
    """The form of an agent's actions under the native ``EnvConfig`` as JSON.

    Args:
        config: The settings.
        answer_fields: Those of a batch: what the agent's task expects with ``stop``.
        agent: Its place among those who act.
        asks: Whether its task has an oracle that takes questions.

    Raises:
        ConfigError: An action is unknown, or there is none to choose from.
    """
    settings = mapping("config", from_json("config", config))
    rows = settings.get("agents", [])
    general = settings.get("action_mode", "discrete")
    mode = rows[agent].get("action_mode", general) if rows else general
    form = ACTION_MODES[mode](_native.chosen_actions(config, agent))
    form = AskingActions(form) if asks else form
    return AnsweredActions(form, answer_fields) if answer_fields else form


#: Forms that have an action to choose, and so masks.
MaskedActions = DiscreteActions | PointerActions | ObjectActions | DictActions


def masked_form(action_mask: object, form: ActionForm | AnsweredActions) -> MaskedActions | None:
    """The form of actions whose masks are asked for, if they are.

    Raises:
        ConfigError: The form has none.
    """
    if not boolean("action_mask", action_mask):
        return None
    own = form
    while isinstance(own, AnsweredActions | AskingActions):
        own = own.form
    if isinstance(own, VelocityActions):
        raise ConfigError("action_mask is True; the action_mode velocity has no actions to mask")
    return own


def checked_mode(mode: object) -> str:
    """``action_mode`` of an environment.

    Raises:
        ConfigError: There is none of this name.
    """
    if isinstance(mode, str) and mode in ACTION_MODES:
        return mode
    raise ConfigError(f"action_mode is {quoted(mode)}; allowed are {', '.join(ACTION_MODES)}")


def first_of(batched: Any) -> Any:  # noqa: ANN401 - of any action space
    """The only element of actions of one environment."""
    if isinstance(batched, Mapping):
        return {key: first_of(value) for key, value in batched.items()}
    return batched[0]


def _place_of(number: int, known: list[int], hands: list[str]) -> int:
    if number in known:
        return known.index(number)
    name = _native.actions()[number]
    raise UsageError(
        f"the expert wants to {name}, which is none of the hand's actions: {', '.join(hands)}"
    )
