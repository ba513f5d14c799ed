"""``dwell ir SCENE.json``: the room of the file, its pairs in order, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from dwell.cli import main

_SCENE: dict[str, Any] = {
    "name": "box",
    "fs": 16000,
    "duration_s": 0.25,
    "bands_hz": [125, 250, 500, 1000, 2000, 4000],
    "shoebox": [6.0, 5.0, 3.0],
    "walls": dict.fromkeys(("x0", "x1", "y0", "y1", "z0", "z1"), "m"),
    "materials": {"m": {"absorption": 0.2, "scattering": 0.5}},
    "sources": [{"id": "S1", "pos": [1.2, 1.4, 1.5]}],
    "receivers": [
        {"id": "R1", "pos": [4.6, 3.3, 1.2]},
        {"id": "R2", "pos": [2.6, 4.1, 1.7]},
    ],
}


def _written(folder: Path, **changes: object) -> str:
    path = folder / "scene.json"
    path.write_text(json.dumps(_SCENE | changes))
    return str(path)


def test_every_pair_arrives_after_its_distance_in_the_files_order(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "ir.npz"
    code = main(["ir", _written(tmp_path), "--out", str(out), "--rays", "300"])
    assert code == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["sources"], told["receivers"]) == (["S1"], ["R1", "R2"])
    with np.load(out) as file:
        responses, rate_hz = file["ir"], int(file["fs"])
    assert (responses.shape, rate_hz) == ((1, 2, 4000), 16000)
    source = np.array(_SCENE["sources"][0]["pos"])
    for k, receiver in enumerate(_SCENE["receivers"]):
        distance = float(np.linalg.norm(source - np.array(receiver["pos"])))
        direct = distance / 343.2 * rate_hz
        loudest = int(np.argmax(np.abs(responses[0, k, : int(direct) + 8])))
        assert abs(loudest - direct) < 2.0
        assert abs(responses[0, k, loudest]) == pytest.approx(1.0 / distance, rel=0.25)


def test_some_pairs_are_those_of_all(tmp_path: Path) -> None:
    scene, all_of, one = _written(tmp_path), tmp_path / "all.npz", tmp_path / "one.npz"
    assert main(["ir", scene, "--out", str(all_of), "--rays", "100"]) == 0
    assert main(["ir", scene, "--out", str(one), "--rays", "100", "--receivers", "R2"]) == 0
    with np.load(all_of) as a, np.load(one) as b:
        np.testing.assert_array_equal(a["ir"][:, 1:], b["ir"])


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"sources": []}, "sources"),
        ({"receivers": [{"id": "R1", "pos": [1, 2]}]}, "receivers[0].pos"),
        ({"receivers": [{"id": "R1", "pos": [1, 2, "x"]}]}, "receivers[0].pos"),
        ({"sources": [{"pos": [1, 2, 3]}]}, "sources[0].id"),
        ({"fs": 0}, "fs"),
        ({"receivers": None, "recievers": []}, "receivers: missing; 'recievers' is nearly its"),
        ({"duration_s": -1}, "scene.json: duration_s is -1; allowed is 0.02 to 20 s"),
        ({"air": {"temperature_c": 99}}, "temperature_c"),
        ({"walls": {}}, "walls.x0"),
    ],
)
def test_what_cannot_be_is_refused_by_its_field(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Any], word: str
) -> None:
    code = main(["ir", _written(tmp_path, **changes), "--rays", "10"])
    assert code != 0
    assert word in capsys.readouterr().err


def test_pairs_that_do_not_exist_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["ir", _written(tmp_path), "--receivers", "R9"]) != 0
    assert "R1, R2" in capsys.readouterr().err
