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
from dwell import pettingzoo as zoo
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
    command = [sys.executable, "-m", "dwell", "view", *map(str, arguments), "--json"]
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


def named_cells(columns: dict[str, list[tuple[str, Any]]], column: str, end: str) -> list[Any]:
    """The cells of a column of the entities whose paths end so, in order."""
    return [cell.as_py() for path, cell in columns.get(column, []) if path.endswith(end)]


def test_all_agents_of_a_replay_are_recorded(tmp_path: Path) -> None:
    names = ("anna", "ben")
    agents: dict[str, Any] = {"anna": {"voice": {"words": ["sofa", "bed"]}}, "ben": {}}
    own = zoo.parallel_env("Free", agents=agents, houses=HOUSE, sensors=["heard_tokens"])
    env = zoo.ParallelReplayRecorder(own, tmp_path)
    env.reset(seed=5)
    things = [row["name"] for row in own.world.objects() if row["pickable"]]
    ways: dict[str, list[list[float]]] = {name: [] for name in names}
    understood = []
    for step in range(26):
        for name, state in own.agent_states().items():
            ways[name].append(state["position"])
        tokens = np.zeros(8, np.int64)
        if step == 0:
            tokens[:2] = [1, 2]
        say = {"action": 2, "say": {"tokens": tokens}}
        env.step({"anna": say, "ben": 0 if step == 24 else 1} if step < 25 else {"anna": say})
        understood += [(row["speaker"], row["word"]) for row in own.world.heard(1)]
    for name, state in own.agent_states().items():
        ways[name].append(state["position"])
    env.close()
    assert things
    columns = recorded(tmp_path / "episode_0000.replay", "--out", tmp_path / "all.rrd")
    for name in names:
        (way,) = named_cells(columns, "LineStrips3D:strips", f"/ways/{name}")
        np.testing.assert_allclose(way[0], ways[name], atol=1e-6)
        eyes = named_cells(columns, "Transform3D:translation", f"/agents/{name}/eye")
        assert len(eyes) == len(ways[name]) == 27
        np.testing.assert_allclose(
            np.array(eyes)[:, 0, [0, 2]], np.array(ways[name])[:, [0, 2]], atol=1e-5
        )
        bodies = named_cells(columns, "Boxes3D:labels", f"/agents/{name}/body")
        assert bodies == [[name]] * 27
        assert len(named_cells(columns, "Image:buffer", f"/agents/{name}/eye/rgb")) == 27
        assert (
            len(named_cells(columns, "Scalars:scalars", f"/{name}/left\\ ear\\,\\ dB\\ SPL")) == 27
        )
    told = {name: named_cells(columns, "TextLog:text", f"/agents/{name}") for name in names}
    assert told["anna"] == [["says (normal): sofa bed"]]
    assert told["ben"][-1] == ["ended"]
    words = [line[0].split(": ")[1].split(" (")[0] for line in told["ben"][:-1]]
    heard = [word or "a word that it does not understand" for _, word in understood]
    assert words == heard
    assert len(heard) == 2


@pytest.mark.slow
def test_the_experts_of_a_task_of_several_agents_are_recorded(tmp_path: Path) -> None:
    task = ("--task", "Cooperate", "--seed", "0")
    columns = recorded("builtin:apartment", *task, "--out", tmp_path / "pair.rrd")
    env = zoo.parallel_env(
        "Cooperate",
        agents=2,
        houses="builtin:apartment",
        voice=True,
        sensors=["heard_tokens", "heard_directions"],
    )
    env.reset(seed=0)
    steps = 0
    while env.agents:
        env.step(env.expert_actions())
        steps += 1
    for name in env.possible_agents:
        eyes = named_cells(columns, "Transform3D:translation", f"/agents/{name}/eye")
        assert len(eyes) == steps + 1
        np.testing.assert_allclose(
            np.array(eyes[-1])[0, [0, 2]],
            np.array(env.agent_states()[name]["position"])[[0, 2]],
            atol=1e-5,
        )
        assert ["succeeded"] in named_cells(columns, "TextLog:text", f"/agents/{name}")


class Told:
    """A recording that only keeps what it is told, for where the SDK is not installed."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, str]] = []
        self.held: list[tuple[str, str | None]] = []
        self.ways: dict[str, int] = {}
        self.labels: list[str] = []
        self.levels: list[list[float]] = []

    def text(self, name: str, text: str) -> None:
        self.lines.append((name, text))

    def told(self, name: str, what: str) -> None:
        self.lines.append((name, what))

    def holds(self, name: str, thing: str | None, place: object) -> None:
        assert (thing is None) == (place is None)
        self.held.append((name, thing))

    def way(self, name: str, way: list[list[float]]) -> None:
        self.ways[name] = len(way)

    def ears(self, name: str, levels_db: list[float]) -> None:
        self.levels.append(levels_db)

    def step(self, step: int, agent: Any, image: Any, camera: Any, **more: Any) -> None:  # noqa: ANN401 - not looked at
        self.labels.append(more["label"])


def test_who_holds_what_is_shown() -> None:
    """Without the SDK: what is handed to it."""
    from dwell.camera import Camera
    from dwell.recording.agents import RecordedAgents
    from dwell.replay_agents import AgentStep

    world = dwell.World("builtin:apartment", agents=2)
    thing = next(row for row in world.objects() if row["pickable"] and row["center"][1] > 0.5)
    x, _, z = thing["center"]
    # In front of it, so that its hand reaches it.
    points = np.array(
        [
            place
            for place in world.navigation().points().tolist()
            if world.house.native.room_at((place[0], place[1] + 1.0, place[2])) == thing["room"]
        ]
    )
    stand = points[np.hypot(points[:, 0] - x, points[:, 2] - z).argmin()]
    yaw_deg = float(np.rad2deg(np.arctan2(stand[0] - x, stand[2] - z)))
    world.place_agent([*map(float, stand)], yaw_deg, agent=1)
    told = Told()
    shown = RecordedAgents(told, Camera(16, 12, 90.0))  # type: ignore[arg-type] # stands in for it
    idle = AgentStep(None, 0.0, "", success=False, acts=True)
    agents = {"anna": idle, "ben": idle}
    shown.step(0, world, agents)
    outcome = world.act("pick", thing["name"], agent=1)
    assert outcome.success, outcome
    world.step()
    shown.step(1, world, agents)
    world.act("drop", agent=1)
    world.step()
    shown.step(2, world, agents)
    shown.finish()
    name = thing["name"]
    assert told.held == [("ben", name), ("ben", None)]
    assert told.lines[1:] == [("ben", f"takes {name}"), ("ben", f"lets go of {name}")]
    assert told.labels == ["anna", "ben", "anna", f"ben, holds {name}", "anna", "ben"]
    assert told.ways == {"anna": 3, "ben": 3}
    assert len(told.levels) == 6


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
