"""The example that learns from the expert: its gradients are right, and it runs."""

from __future__ import annotations

import json
import runpy
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

EXAMPLE = str(Path(__file__).parents[2] / "examples" / "imitation.py")


@pytest.fixture(scope="module")
def example() -> dict[str, Any]:
    return runpy.run_path(EXAMPLE)


def test_gradients_are_those_of_the_loss(example: dict[str, Any]) -> None:
    rng = np.random.default_rng(3)
    network = example["Network"](5, SimpleNamespace(sizes=[4, 3], stop=0), rng)
    network.weights = [weight.astype(np.float64) for weight in network.weights]
    network.biases = [bias + rng.normal(size=bias.shape) for bias in network.biases]
    inputs, shares = rng.normal(size=(6, 5)), rng.uniform(0.5, 2.0, 6)
    labels = np.stack([rng.integers(4, size=6), rng.integers(3, size=6)], axis=1)

    def loss() -> float:
        total = 0.0
        for head, part in enumerate(np.split(network.logits(inputs)[-1], [4], axis=1)):
            normal = part - np.log(np.exp(part).sum(axis=1, keepdims=True))
            total -= float((shares * normal[np.arange(6), labels[:, head]]).mean())
        return total

    for layer, (slope, bias_slope) in enumerate(network.gradients(inputs, labels, shares)):
        for values, slopes in (
            (network.weights[layer], slope),
            (network.biases[layer], bias_slope),
        ):
            at = tuple(rng.integers(size) for size in values.shape)
            kept, sides = values[at], []
            for step in (1e-6, -1e-6):
                values[at] = kept + step
                sides.append(loss())
            values[at] = kept
            assert (sides[0] - sides[1]) / 2e-6 == pytest.approx(slopes[at], rel=1e-4, abs=1e-7)


@pytest.mark.long
def test_it_learns_what_can_be_told_apart(example: dict[str, Any]) -> None:
    rng = np.random.default_rng(4)
    inputs = rng.normal(size=(500, 3)).astype(np.float32)
    labels = np.stack([(inputs[:, 0] > 0) + 2 * (inputs[:, 1] > 0)], axis=1)
    learner = example["learnt"](inputs, labels, SimpleNamespace(sizes=[4], stop=0), 150)
    said = learner.network.logits((inputs - learner.center) / learner.scale)[-1].argmax(axis=1)
    # By chance a quarter.
    assert (said == labels[:, 0]).mean() > 0.9


@pytest.mark.long
@pytest.mark.parametrize(
    "task",
    [
        "PointNav",
        pytest.param("EmbodiedQA", marks=pytest.mark.slow),
        pytest.param("SoundLocalization", marks=pytest.mark.slow),
    ],
)
def test_it_runs_and_writes_the_curve(
    task: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "curve.json"
    options = "--demonstrations 1,2 --episodes 1 --houses 1 --updates 9 --max-steps 9 --dagger"
    monkeypatch.setattr(sys, "argv", [EXAMPLE, task, *options.split(), "--out", str(out)])
    runpy.run_path(EXAMPLE, run_name="__main__")
    assert capsys.readouterr().out.count("demonstrations") == 2
    told = json.loads(out.read_text("utf-8"))
    assert [row["demonstrations"] for row in told["curve"]] == [1, 2]
    assert told["curve"][1]["success"]["episodes"] == 1
