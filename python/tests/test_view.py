"""``dwell view``: what it records, read back."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell import _native
from dwell.envs import DwellEnv

HOUSE = "builtin:studio"


def test_without_the_sdk_one_sentence_says_how_to_get_it(tmp_path: Path) -> None:
    out = tmp_path / "x.rrd"
    script = (
        "import sys; sys.modules['rerun'] = None\n"
        "from dwell.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", script, "view", HOUSE, "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert "pip install" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not out.exists()


def recorded(*arguments: str | Path) -> dict[str, list[tuple[str, Any]]]:
    """The recording of ``dwell view``: for each column its chunks' entity paths and cells."""
    chunk = pytest.importorskip("rerun.chunk", reason="needs the Rerun SDK of `make demo`")
    out = arguments[-1]
    command = [sys.executable, "-m", "dwell.cli", "view", *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {"file": str(out)}
    columns: dict[str, list[tuple[str, Any]]] = {}
    for piece in chunk.RrdReader(str(out)).stream().to_chunks():
        rows = piece.to_record_batch()
        for name in rows.schema.names:
            cells = columns.setdefault(name, [])
            cells += [(str(piece.entity_path), cell) for cell in rows.column(name)]
    return columns


def test_a_recording_holds_the_whole_house(tmp_path: Path) -> None:
    columns = recorded(HOUSE, "--out", tmp_path / "studio.rrd")

    def count(column: str, under: str) -> int:
        cells = columns.get(column, [])
        return sum(len(cell) for path, cell in cells if path.startswith(under))

    house = dwell.House.open(HOUSE)
    info, rooms = house.info(), house.rooms()
    fixtures = _native.fixtures(dwell.World(house, agents=0).native)
    assert count("Mesh3D:triangle_indices", "/world/") == info["triangles"]
    assert 0 < count("Mesh3D:triangle_indices", "/world/ceilings") < info["triangles"]
    assert count("Boxes3D:labels", "/world/boxes") == len(fixtures["boxes"]) == info["objects"]
    assert count("Points3D:positions", "/world/lamps") == info["lights"]
    assert count("Points3D:positions", "/world/sound/sources") == info["emitters"]
    assert count("Arrows3D:vectors", "/world/joints") == info["joints"]
    assert len(columns["Pinhole:image_from_camera"]) == len(rooms)
    for image in ("Image:buffer", "DepthImage:buffer", "SegmentationImage:buffer"):
        assert len(columns[image]) == len(rooms)
    named = {label.as_py() for _, cell in columns["Boxes3D:labels"] for label in cell}
    assert named == {row["name"] for row in fixtures["boxes"]}
    assert columns["Mesh3D:albedo_texture_buffer"]
    sounding = [row for row in fixtures["sources"] if row["on"]]
    listeners = count("Points3D:positions", "/world/sound/rays")
    assert listeners == len(sounding)


def test_an_episode_is_recorded_step_by_step(tmp_path: Path) -> None:
    task = ("--task", "InstructionFollowing", "--seed", "5")
    columns = recorded(HOUSE, *task, "--out", tmp_path / "episode.rrd")
    env = DwellEnv("InstructionFollowing", houses=HOUSE, sensors=["instruction"])
    observation, _ = env.reset(seed=5)
    way, done = [env.agents()[0]["position"]], False
    while not done:
        *_, done, _, _ = env.step(np.int64(env.expert_action()))
        way.append(env.agents()[0]["position"])
    (drawn,) = [cell for path, cell in columns["LineStrips3D:strips"] if "ways" in path]
    np.testing.assert_allclose(drawn.as_py()[0], way, atol=1e-6)
    seen = [cell for path, cell in columns["Image:buffer"] if "agent/eye" in path]
    eyes = [cell for path, cell in columns["Transform3D:translation"] if "agent/eye" in path]
    assert len(seen) == len(eyes) == len(way) > 5
    texts = [cell.as_py() for path, cell in columns["TextDocument:text"] if "instruction" in path]
    assert texts == [[str(observation["instruction"])]]


def test_early_paths_lead_from_the_source_to_the_microphone(shoebox: dwell.House) -> None:
    scene = dwell.AcousticScene(shoebox)
    source, mic = (1.0, 1.2, 1.5), (4.5, 1.6, 3.0)
    paths = scene.early_paths(source, mic)
    assert sum(len(path["points"]) == 3 for path in paths) == 6
    lengths = [path["path"]["length_m"] for path in paths]
    assert lengths == sorted(lengths)
    for path in paths:
        assert path["points"][0] == pytest.approx(source)
        assert path["points"][-1] == pytest.approx(mic)
    with pytest.raises(dwell.DwellError, match="source"):
        scene.early_paths((float("nan"), 0.0, 0.0), mic)


def test_the_viewer_takes_the_names_of_all_houses_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("rerun", reason="needs the Rerun SDK of `make demo`")
    out = tmp_path / "named.rrd"
    program = (
        "import sys, pathlib\n"
        "from dwell.recording import Recording\n"
        "Recording('dwell seed:7?home=studio', pathlib.Path(sys.argv[1])).close()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(out)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert b"dwell seed:7?home=studio" in out.read_bytes()
