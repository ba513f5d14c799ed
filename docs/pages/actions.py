"""Actions: the numbers of environments, the controls of a step, and what hands do."""

from __future__ import annotations

import inspect
import re
from typing import Any

import dwell
from dwell import _native
from dwell.actions import action_table
from dwell.envs.action_modes import ACTION_MODES, STOP_BELOW, action_form
from dwell.schemas import settings
from pages.observations import fields_table
from pages.schema_words import schema_words
from pages.tables import code, number, table

#: The ways of getting about whose limits the page lists.
_BASES = ("walking", "differential_drive", "holonomic")

_UNITS = {"rad_s": "rad/s", "m_s": "m/s"}


def discrete() -> list[tuple[int, str, str]]:
    """Number, name and text of the discrete actions."""
    said = {kind["name"]: kind["about"] for kind in action_table()["kinds"]}
    return [(k, name, said[name]) for k, name in enumerate(_native.actions())]


def controls() -> list[dict[str, Any]]:
    """The fields of a control; the first four are the columns of an array."""
    return settings()["AgentControl"]


def hand() -> list[dict[str, Any]]:
    """The kinds of action of the hand, with what each needs."""
    return [kind for kind in action_table()["kinds"] if kind["is_of_hand"]]


def _control_row(place: int, field: dict[str, Any]) -> tuple[str, ...]:
    name, kind = field["name"], schema_words(field["schema"])
    unit = next((unit for end, unit in _UNITS.items() if name.endswith(end)), "")
    column = str(place) if kind == "number" else ""
    span = "any finite" if "number" in kind else "false, true"
    return (code(name), column, kind, unit, span, field["about"])


def _limits(base: str) -> list[tuple[str, ...]]:
    """The numbers of a body that gets about in one way, as a world tells them."""
    room = dwell.House.shoebox((4.0, 2.5, 4.0), substance="plaster")
    world = dwell.World(room, agents=[{"locomotion": {base: {}}}])
    return [
        (
            code(address),
            number(known["value"]),
            str(known["unit"]),
            number(known["low"]),
            number(known["high"]),
        )
        for address, known in world.parameters().items()
        if address.startswith("agent/0/base/")
    ]


def page() -> str:
    """The page."""
    space = action_form("{}").space
    stride = fields_table(settings()["StepSizes"])
    head = ("address", "default", "unit", "lowest", "highest")
    bases = "\n".join(f"### {_words(base)}\n\n{table(head, _limits(base))}" for base in _BASES)
    return f"""# Actions

## Discrete

The action space of every environment is `{space}`, the first of these; `actions=` names others.
`World.do` takes the same numbers and names. The hand acts on what the agent looks at.

{table(("number", "name", "what it does"), ((k, code(n), a) for k, n, a in discrete()))}
How far the movement actions go is the environment's `stride`:

{stride}
## Modes

`action_mode=` gives an environment another form of actions:

{table(("action_mode", "action space", "what it says"), _modes())}
Velocities are shares of what the movement actions make in a step. In `velocity` those that are all
below {STOP_BELOW:g} say `stop`, and there is no hand: doors stand open at the start.

## Continuous

`World.step(controls)` takes an array of shape (agent, 4), float32, whose columns are those below,
or a mapping for each agent. The body's limits keep what it does within what it can.

{
        table(
            ("field", "column", "type", "unit", "range", "what it is"),
            [_control_row(k, one) for k, one in enumerate(controls())],
        )
    }
## Limits of bodies

Numbers that bound the controls, by their address for `parameters` and `World.set_parameter`; those
of agent 0. The range of some depends on the others.

{bases}
## Hands

`World.act(kind, object, ...)` lets an agent do something. It answers with success, a code and a
sentence.

{table(("kind", "what it does", "what it needs"), [_hand_row(one) for one in hand()])}
The target is an object, a part of one, a pixel of a camera, a ray, or else what the agent looks
at:

{fields_table(action_table()["target"])}
## Codes

{
        table(
            ("code", "what it says"),
            ((code(one["name"]), one["about"]) for one in action_table()["codes"]),
        )
    }"""


def _modes() -> list[tuple[str, str, str]]:
    """The forms of actions, with their spaces."""
    rows = []
    for mode, form in ACTION_MODES.items():
        made = action_form(f'{{"action_mode": "{mode}"}}')
        about = (inspect.getdoc(form) or "").partition("\n\n")[0].replace("\n", " ")
        rows.append((code(mode), code(str(made.space)), about))
    return rows


def _hand_row(kind: dict[str, Any]) -> tuple[str, ...]:
    needs = [f"target: {_uncapped(kind['target'])}"] if kind["target"] else []
    needs += [f"{code(field['name'])}: {_uncapped(field['about'])}" for field in kind["fields"]]
    return (code(kind["name"]), kind["about"], "; ".join(needs))


def _uncapped(sentence: str) -> str:
    """A sentence that goes on in a list: without its full stop, small where it began large."""
    return re.sub(r"^[A-Z](?=[a-z])", lambda first: first[0].lower(), sentence).rstrip(".")


def _words(name: str) -> str:
    return name.replace("_", " ").capitalize()
