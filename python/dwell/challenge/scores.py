"""Scores of verdicts on cases."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from dwell.arguments import quoted

__all__ = ["score", "wilson_interval"]

#: The d' below which rivals are one with the truth, and from which on they are apart.
_INSEPARABLE, _SEPARABLE = 1.0, 5.0
#: Edges of the detection curve, in d'.
_CURVE = (1.5, 5.0, 10.0, 20.0, 50.0, 150.0)

_Row = Mapping[str, Any]


def wilson_interval(hits: int, count: int) -> list[float] | None:
    """The 95 % interval of a share; ``None`` of none.

    E. B. Wilson, Journal of the American Statistical Association 22 (1927), 209-212.
    """
    if count == 0:
        return None
    z = 1.959964
    share = hits / count
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z / (1 + z * z / count) * math.sqrt(share * (1 - share) / count + (z / count) ** 2 / 4)
    return [max(0.0, middle - half), min(1.0, middle + half)]


def _share(flags: Iterable[bool]) -> dict[str, Any]:
    rows = list(flags)
    hits = sum(rows)
    share = hits / len(rows) if rows else None
    return {
        "hits": hits,
        "of": len(rows),
        "share": share,
        "interval": wilson_interval(hits, len(rows)),
    }


def score(answers: Iterable[_Row], verdicts: Iterable[_Row]) -> dict[str, Any]:
    """The scores of a method on the cases that it judged.

    Args:
        answers: Rows of the answers' file.
        verdicts: Rows of :func:`~dwell.challenge.run`.

    Returns:
        Each score with ``hits``, ``of``, ``share`` and its 95 % ``interval`` by Wilson's formula:

        ``false_alarms``: nothing-cases with a name, or a choice of names. ``not_quiet``: those
        with any verdict but "nothing". ``wrong_names_of_faults``: cases of a fault alone of which
        anything else is named, a law or another fault, or a choice without it.
        ``top_1_from_10`` and ``top_1_5_to_10``: cases of one effect at a d' of 10 and more or 5 to
        10, whose rivals are a d' above 5 away: it alone is named. ``set``: cases of one effect or a
        fault, at 10 and more: it is among the explanations; ``mean_set_size`` of theirs.
        ``inseparable``: cases of one with a rival within a d' of 1, at 10 and more: several are
        given, the truth among them. ``both_of_two``: two effects at 10 and more each that no single
        one imitates, both named and no other. ``single_name_of_two``: of those one name alone.
        ``outside_unnamed``: no name for what is outside the library, at 10 and more;
        ``outside_apart_unnamed``: of those that no single effect of the library imitates;
        ``outside_seen``: of all at 10 and more those with any verdict but "nothing". ``coverage``:
        95 % intervals of named right ones that hold the truth; ``median_error`` of their values.
        ``curve``: cases of one effect or fault named right, by d', but for those with a rival that
        is much nearer to the truth than nothing is. ``judged``: number of cases;
        ``unanswered``: verdicts on other cases than those of the answers, which do not count.

    Raises:
        ValueError: A case has two verdicts or two different answers, the verdicts are of several
            methods, or none is on a case of the answers.
    """
    known, judged = _by_case(answers, verdicts)
    pairs = [(known[name], row) for name, row in judged.items() if name in known]
    by_kind: dict[str, list[tuple[_Row, _Row]]] = {}
    for answer, verdict in pairs:
        by_kind.setdefault(answer["kind"], []).append((answer, verdict))
    nothing = by_kind.get("nothing", [])
    beyond = [row for row in by_kind.get("outside", []) if _d_prime(row[0]) >= 10.0]
    single = by_kind.get("one", []) + by_kind.get("fault", [])
    strong = [row for row in single if _d_prime(row[0]) >= 10.0]
    two = [
        row for row in by_kind.get("two", []) if _d_prime(row[0]) >= 10.0 and _is_separable(row[0])
    ]
    laws = [row for row in by_kind.get("one", []) if _is_separable(row[0])]
    sizes = [len(row[1]["sets"]) for row in strong if _has_truth(*row)]
    right = [row for row in single if _is_named_right(*row)]
    checks = [check for answer, verdict in right for check in _parameters(answer, verdict)]
    return {
        "judged": len(pairs),
        "unanswered": len(judged) - len(pairs),
        "false_alarms": _share(_names(verdict) for _, verdict in nothing),
        "not_quiet": _share(verdict["kind"] != "nothing" for _, verdict in nothing),
        "wrong_names_of_faults": _share(_is_named_wrong(*row) for row in by_kind.get("fault", [])),
        "top_1_from_10": _share(_is_named_right(*row) for row in laws if _d_prime(row[0]) >= 10.0),
        "top_1_5_to_10": _share(
            _is_named_right(*row) for row in laws if 5.0 <= _d_prime(row[0]) < 10.0
        ),
        "set": _share(_has_truth(*row) for row in strong),
        "mean_set_size": float(np.mean(sizes)) if sizes else None,
        "inseparable": _share(
            len(verdict["sets"]) > 1 and _has_truth(answer, verdict)
            for answer, verdict in strong
            if min(answer["rivals"].values(), default=math.inf) < _INSEPARABLE
        ),
        "both_of_two": _share(_is_named_right(*row) for row in two),
        "single_name_of_two": _share(
            len(verdict["sets"]) == 1 and len(verdict["sets"][0]) == 1 for _, verdict in two
        ),
        "outside_unnamed": _share(not _names(verdict) for _, verdict in beyond),
        "outside_apart_unnamed": _share(
            not _names(verdict) for answer, verdict in beyond if _is_separable(answer)
        ),
        "outside_seen": _share(verdict["kind"] != "nothing" for _, verdict in beyond),
        "coverage": _share(check["covers"] for check in checks),
        "median_error": float(np.median([check["error"] for check in checks])) if checks else None,
        "curve": _curve(single),
    }


def _by_case(
    answers: Iterable[_Row], verdicts: Iterable[_Row]
) -> tuple[dict[str, _Row], dict[str, _Row]]:
    known: dict[str, _Row] = {}
    for row in answers:
        if known.setdefault(row["case"], row) != row:
            raise ValueError(f"answers: case {quoted(row['case'])} has two that differ")
    judged: dict[str, _Row] = {}
    for row in verdicts:
        if row["case"] in judged:
            raise ValueError(f"verdicts: two on case {quoted(row['case'])}; expected one on each")
        judged[row["case"]] = row
    methods = sorted({str(row["method"]) for row in judged.values() if row.get("method")})
    if len(methods) > 1:
        named = ", ".join(map(quoted, methods))
        raise ValueError(f"verdicts: of the methods {named}; scores are of one")
    if judged and judged.keys().isdisjoint(known):
        raise ValueError(
            f"verdicts: none of the {len(judged)} is on one of the {len(known)} cases of the "
            f"answers: the first is on case {quoted(next(iter(judged)))}, the first answer is to "
            f"{quoted(next(iter(known), None))}"
        )
    return known, judged


def _hidden(answer: _Row) -> set[str]:
    return {one["id"] for one in answer["hidden"]}


def _d_prime(answer: _Row) -> float:
    """The least of what is hidden."""
    return min((float(one["d_prime"]) for one in answer["hidden"]), default=0.0)


def _is_separable(answer: _Row) -> bool:
    return all(value > _SEPARABLE for value in answer["rivals"].values())


def _names(verdict: _Row) -> bool:
    return bool(verdict["kind"] in ("named", "one_of"))


def _has_truth(answer: _Row, verdict: _Row) -> bool:
    return any(set(one) == _hidden(answer) for one in verdict["sets"])


def _is_named_right(answer: _Row, verdict: _Row) -> bool:
    return bool(verdict["kind"] == "named") and _has_truth(answer, verdict)


def _is_named_wrong(answer: _Row, verdict: _Row) -> bool:
    return _names(verdict) and not _has_truth(answer, verdict)


def _parameters(answer: _Row, verdict: _Row) -> list[dict[str, Any]]:
    """Of each hidden parameter that the verdict has: its relative error, and whether it is held."""
    found = []
    for one in answer["hidden"]:
        told = verdict["parameters"].get(one["id"], {})
        for name, truth in one["parameters"].items():
            if name in told and truth:
                value, low, high = told[name]
                found.append(
                    {"error": abs(value / truth - 1.0), "covers": bool(low <= truth <= high)}
                )
    return found


def _curve(single: Sequence[tuple[_Row, _Row]]) -> list[dict[str, Any]]:
    rows = []
    for low, high in itertools.pairwise(_CURVE):
        within = [
            row
            for row in single
            if low <= _d_prime(row[0]) < high
            and all(value > min(_SEPARABLE, 0.9 * low) for value in row[0]["rivals"].values())
        ]
        rows.append({"d_prime": [low, high], **_share(_is_named_right(*row) for row in within)})
    return rows
