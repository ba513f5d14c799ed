"""Predicates against oracles: pictures, clouds of points, physics and walks answer alike."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.outlines import area, gap, shared
from oracles.scene import Cloud
from oracles.survey import Question, Survey

#: Small ones; ``python -m oracles`` asks in a thousand.
HOUSES = ("builtin:studio", "seed:4?home=studio", "seed:8?home=studio")
LEAST = 0.98


@pytest.fixture(
    scope="module", params=[HOUSES[:2], pytest.param(HOUSES, marks=pytest.mark.slow)], ids=len
)
def questions(request: pytest.FixtureRequest) -> list[Question]:
    found: list[Question] = []
    for k, house in enumerate(request.param):
        found += Survey(house, seed=0, each=1).all(reach=k == 0, sweep=k == 1, viewers=1)
    return found


@pytest.mark.long
def test_predicates_agree_with_oracles(questions: list[Question]) -> None:
    rows: dict[str, list[Question]] = {}
    for question in questions:
        if question.oracle != "grey":
            rows.setdefault(question.predicate, []).append(question)
    assert len(rows) >= 25
    for predicate, asked in rows.items():
        apart = [question for question in asked if question.oracle != question.engine]
        assert len(apart) <= (1 - LEAST) * len(asked), (predicate, apart)


def test_oracles_decide_both_ways(questions: list[Question]) -> None:
    decided: dict[str, list[str]] = {"yes": [], "no": []}
    for question in questions:
        decided.get(question.oracle, []).append(question.predicate)
    both = set(decided["yes"]) & set(decided["no"])
    assert {"above", "against", "in", "near", "on", "touching", "visible", "wider_than"} <= both


def test_polygons_are_measured_as_by_hand() -> None:
    square = np.array(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))
    assert area(square) == 1.0
    assert area(shared(square, square + 0.25)) == pytest.approx(0.5625)
    assert area(shared(square, square[::-1] + np.array((0.5, 0.0)))) == pytest.approx(0.5)
    assert gap(square, square + np.array((3.0, 4.0))) == pytest.approx(np.hypot(2.0, 3.0))
    assert gap(square, square * 0.2 + 0.4) == 0.0
    corners = np.array(((0.0, 0.0, 0.0), (3.0, 1.0, 0.0), (3.0, 0.0, 2.0), (0.0, 0.0, 2.0)))
    turn = np.deg2rad(30.0)
    level = np.array(((np.cos(turn), 0, -np.sin(turn)), (0, 1, 0), (np.sin(turn), 0, np.cos(turn))))
    assert Cloud(corners @ level, 0.01, cut=False).edges == pytest.approx((3.0, 2.0))
