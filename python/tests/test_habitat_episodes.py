"""Episodes of Habitat and SoundSpaces: read, converted, played.

The files are written here by hand, in the form that the data sets of habitat-lab and SoundSpaces
have; their starts and goals are places of our houses.
"""

from __future__ import annotations

import gzip
import json
import math
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from habitat_files import HOUSE, SCENE, Row, converted, point_nav, rotation, written

import dwell
from dwell import habitat_episodes
from dwell.envs import DwellEnv
from dwell.habitat_conversion import HabitatConverter

pytestmark = pytest.mark.usefixtures("open_once")

Command = Callable[..., subprocess.CompletedProcess[str]]


def expert(env: DwellEnv) -> dict[str, Any]:
    """Plays the episode that has begun to its end."""
    for _ in range(400):
        _, _, terminated, _, info = env.step(env.expert_action())
        if terminated:
            return info
    raise AssertionError("the expert does not end the episode")


# ---- the files


def test_a_split_with_a_file_for_each_scene_is_read(points: Path, places: list[Any]) -> None:
    found = [*habitat_episodes.read(points)]
    assert [one.episode_id for one in found] == ["0", "1", "2", "3"]
    for k, (one, (start, goal, way_m)) in enumerate(zip(found, places, strict=False)):
        assert (one.task, one.scene_id, one.index) == ("PointNav", SCENE, k)
        assert one.start_position == pytest.approx(start)
        assert [*one.goal_positions[0]] == pytest.approx(goal)
        assert one.geodesic_distance == way_m
        assert one.start_yaw_deg == pytest.approx(40.0 * k - 130.0)
        assert Path(one.file) == points.parent / "content" / "studio.json.gz"


def test_a_file_that_is_not_packed_is_read(tmp_path: Path, places: list[Any]) -> None:
    path = tmp_path / "val.json"
    path.write_text(json.dumps({"episodes": [point_nav(0, places[0])]}), "utf-8")
    (one,) = habitat_episodes.read(path)
    assert one.start_position == pytest.approx(places[0][0])


@pytest.mark.parametrize("yaw_deg", [0.0, 90.0, -90.0, 179.0, -45.0, 30.0])
def test_an_agent_faces_where_habitat_says(yaw_deg: float, tmp_path: Path) -> None:
    # Rotated by the quaternion, the camera's -Z points as ours does at that heading.
    x, y, z, w = rotation(yaw_deg)
    ahead = np.array([-2 * (x * z + w * y), -2 * (y * z - w * x), -(1 - 2 * (x * x + y * y))])
    row = {
        "episode_id": 0,
        "scene_id": "a",
        "start_position": [0, 0, 0],
        "start_rotation": [x, y, z, w],
        "goals": [{"position": [1, 0, 0]}],
    }
    (one,) = habitat_episodes.read(written(tmp_path / "a.json.gz", {"episodes": [row]}))
    yaw = math.radians(one.start_yaw_deg)
    assert ahead == pytest.approx([-math.sin(yaw), 0.0, -math.cos(yaw)], abs=1e-6)


def damaged(change: Callable[[Row], object]) -> Callable[[Row], None]:
    def damage(whole: Row) -> None:
        change(whole["episodes"][1])

    return damage


def put(**fields: object) -> Callable[[Row], None]:
    return damaged(lambda row: row.update(fields))


def without(name: str) -> Callable[[Row], None]:
    return damaged(lambda row: row.pop(name))


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (without("scene_id"), "episodes[1]: scene_id: missing"),
        (without("episode_id"), "episodes[1]: episode_id: missing"),
        (put(episode_id=True), "episodes[1]: episode_id is True; expected text or a whole number"),
        (put(episode_id=[1]), "episodes[1]: episode_id is [1]; expected text or a whole number"),
        (without("start_position"), "episodes[1]: start_position: missing"),
        (without("goals"), "episodes[1]: goals is None; expected a list of goals"),
        (put(goals=[]), "episodes[1]: goals is []; expected at least one goal"),
        (put(goals=[{}]), "episodes[1]: goals[0].position: missing"),
        (put(goals=[7]), "episodes[1]: goals[0] is 7"),
        (put(goals=[{"position": [0, 0, 0]}] * 2), "episodes[1]: goals: 2 points; one is read"),
        (put(goals=[{"position": [0, "x", 0]}]), "episodes[1]: goals[0].position[1] is 'x'"),
        (put(start_position=[1, 2]), "episodes[1]: start_position: expected three numbers"),
        (put(start_position=[1, math.nan, 2]), "episodes[1]: start_position[1] is nan"),
        (put(start_position=[1e300, 0, 2]), "episodes[1]: start_position[0] is 1e+300"),
        (put(start_position="here"), "episodes[1]: start_position: expected three numbers"),
        (put(start_rotation=[0, 0, 0, 0]), "episodes[1]: start_rotation: expected a rotation"),
        (put(start_rotation=[1, 0, 0, 1]), "episodes[1]: start_rotation leans by 90 degrees"),
        (put(start_rotation=[0] * 900), "episodes[1]: start_rotation: expected a rotation"),
        (put(info={"geodesic_distance": -1}), "episodes[1]: info.geodesic_distance is -1"),
        (put(info={"geodesic_distance": math.nan}), "episodes[1]: info.geodesic_distance is nan"),
        (put(info=[1]), "episodes[1]: info is [1]"),
        (put(instruction={"instruction_text": "Go."}), "episodes[1]: instruction: an episode of"),
        (put(sound_id=3), "episodes[1]: sound_id is 3; expected text"),
        (put(sound_id="a.wav", duration="long"), "episodes[1]: duration is 'long'"),
        (put(object_category=[1]), "episodes[1]: object_category is [1]; expected text"),
        (lambda whole: whole["episodes"].__setitem__(1, [3]), "episodes[1]: found [3]"),
        (lambda whole: whole.pop("episodes"), "episodes: found {}; expected a data set"),
        (lambda whole: whole.update(goals_by_category=[]), "goals_by_category is []"),
        (lambda whole: whole.update(content_scenes_path="/etc/{scene}"), "content_scenes_path is"),
        (
            lambda whole: whole.update(content_scenes_path="{data_path}/../{scene}.json.gz"),
            "content_scenes_path is '{data_path}/../{scene}.json.gz'; expected one as",
        ),
    ],
)
def test_a_bad_file_is_told_by_episode_and_field(
    damage: Callable[[Row], object], told: str, tmp_path: Path, places: list[Any]
) -> None:
    whole = {"episodes": [point_nav(k, place) for k, place in enumerate(places[:3])]}
    damage(whole)
    path = written(tmp_path / "bad.json.gz", whole)
    with pytest.raises(dwell.MeasuredDataError) as refused:
        [*habitat_episodes.read(path)]
    assert str(refused.value).startswith(f"{path}: {told}"), refused.value


def test_what_is_no_json_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "bad.json.gz"
    packed = gzip.compress(b'{"episodes": [' + b"1, " * 50_000 + b"1]}")
    for content, told in (
        (packed[: len(packed) // 2], f"its {len(packed) // 2} bytes are no whole gzip: it was cut"),
        (packed[:20] + b"\xff" * 40 + packed[60:], "no gzip, or a damaged one: "),
        (gzip.compress(b'{"episodes": [}'), "no JSON: line 1 column 15"),
        (gzip.compress(b"\xff"), "no JSON: byte 0 is not UTF-8"),
        (gzip.compress(b"[" * 500 + b"]" * 500), "nested 500 deep"),
        (b"", "no JSON"),
    ):
        path.write_bytes(content)
        with pytest.raises(dwell.MeasuredDataError) as refused:
            [*habitat_episodes.read(path)]
        assert str(refused.value).startswith(f"{path}: {told}"), refused.value
    # A bomb: a thousandfold when unpacked. It is stopped at the cap, not at its end.
    monkeypatch.setattr(habitat_episodes, "MAX_TEXT_BYTES", 3 * 2**20)
    path.write_bytes(gzip.compress(b" " * (64 * 2**20)))
    with pytest.raises(dwell.MeasuredDataError, match="more than 3145728 bytes when unpacked"):
        [*habitat_episodes.read(path)]
    monkeypatch.setattr(habitat_episodes, "MAX_VALUES", 1000)
    path.write_bytes(packed)
    with pytest.raises(dwell.MeasuredDataError, match="at most 1000 are read"):
        [*habitat_episodes.read(path)]


# ---- conversion


@pytest.mark.long
def test_episodes_of_points_are_played_to_their_goals(
    points: Path, tmp_path: Path, places: list[Any]
) -> None:
    out = tmp_path / "val.jsonl"
    converter = converted(points, out, expert=True)
    found = [*dwell.episodes.read(out)]
    assert dwell.episodes.read(out).header.task == "PointNav"
    for k, (one, (start, goal, way_m)) in enumerate(zip(found, places, strict=False)):
        assert one.episode_id == f"{HOUSE}#{k}"
        assert one.source_id == f"studio.json.gz#{k}"
        assert one.start_position == pytest.approx(start)
        assert one.goal is not None
        assert one.goal["position"] == pytest.approx(goal)
        assert one.source_distance_to_goal == way_m
        # Ways over cells are a few percent longer than those pulled tight.
        assert one.start_distance_to_goal == pytest.approx(way_m, rel=0.12, abs=0.1)
        assert one.expert_success
    assert converter.comparison.compared == converter.comparison.converted == len(found)
    assert converter.comparison.most_m < 1.0
    assert not converter.comparison.skipped
    env = gymnasium.make(
        "dwell/PointNav-v0", episodes=out, sensors=["gps", "pointgoal_with_gps_compass"]
    ).unwrapped
    assert isinstance(env, DwellEnv)
    for one, (start, goal, _) in zip(found, places, strict=False):
        observation, info = env.reset(options={"episode_id": one.episode_id})
        assert env.agents()[0]["position"] == pytest.approx(start)
        straight_m = math.hypot(goal[0] - start[0], goal[2] - start[2])
        assert observation["pointgoal_with_gps_compass"][0] == pytest.approx(straight_m, abs=1e-4)
        last = expert(env)
        assert last["success"]
        assert last["spl"] == pytest.approx(
            info["start_distance_to_goal"]
            / max(info["start_distance_to_goal"], last["path_length"])
        )
        ended = np.array(env.agents()[0]["position"])
        assert np.linalg.norm(ended - np.array(goal)) < 0.35


def object_nav(places: list[Any], category: str, things: list[list[float]], version: int) -> Row:
    """A data set of ObjectNav: 1 has its goals in each episode, 2 has them once."""
    goals = [
        {
            "position": thing,
            "radius": None,
            "object_id": k,
            "object_name": f"{category}_{k}",
            "object_category": category,
            "room_id": None,
            "room_name": None,
            "view_points": [
                {"agent_state": {"position": thing, "rotation": [0, 0, 0, 1]}, "iou": 0.2}
            ],
        }
        for k, thing in enumerate(things)
    ]
    episodes = []
    for k, place in enumerate(places):
        row = point_nav(k, place)
        row["info"] = {"geodesic_distance": 1.0, "closest_goal_object_id": 0}
        row |= {"goals": goals} if version == 1 else {"goals": [], "object_category": category}
        episodes.append(row)
    whole: Row = {
        "episodes": episodes,
        "category_to_task_category_id": {category: 0, "bed": 1},
        "category_to_mp3d_category_id": {category: 5, "bed": 11},
    }
    if version == 2:
        whole["goals_by_category"] = {f"studio.basis.glb_{category}": goals}
    return whole


def things_of(name: str) -> list[list[float]]:
    """The middles of the things of a class in the house."""
    env = DwellEnv("Free", houses=HOUSE, sensors=["gps"])
    env.reset(seed=1)
    rows = env.world.objects()
    return [[float(x) for x in row["center"]] for row in rows if row["category"] == name]


@pytest.mark.parametrize("version", [1, 2])
def test_episodes_of_things_are_played_to_one_of_them(
    version: int, tmp_path: Path, places: list[Any]
) -> None:
    things = things_of("sofa")
    assert things
    path = written(tmp_path / "val.json.gz", object_nav(places[:2], "sofa", things, version))
    out = tmp_path / "val.jsonl"
    for instances in ("class", "stated"):
        converter = converted(path, out, instances=instances)
        assert converter.header.task == "ObjectNav"
        env = DwellEnv("ObjectNav", episodes=out, sensors=["objectgoal"])
        for one in dwell.episodes.read(out):
            _, info = env.reset(options={"episode_id": one.episode_id})
            assert info["goal_class"] == "sofa"
            assert len(info["goal_objects"]) == len(things)
            assert env.instruction() == "Find a sofa."
            assert expert(env)["success"]


def audio_nav(places: list[Any], **sound: object) -> Row:
    """A data set of SoundSpaces."""
    rows = []
    for k, place in enumerate(places):
        row = point_nav(k, place)
        row["info"] = {"geodesic_distance": place[2], "num_action": 11}
        row["goals"][0]["radius"] = 1e-5
        row["scene_id"] = "replica/studio/habitat/mesh_semantic.ply"
        rows.append(row | sound)
    return {"episodes": rows}


def test_episodes_of_sounds_are_played_to_them(tmp_path: Path, places: list[Any]) -> None:
    whole = audio_nav(places[:2], sound_id="telephone.wav", offset="2", duration=25)
    path, out = written(tmp_path / "val.json.gz", whole), tmp_path / "val.jsonl"
    with pytest.raises(dwell.MeasuredDataError, match=r"episodes\[0\].sound_id is 'telephone.wav'"):
        converted(path, out)
    converter = converted(path, out, sounds={"telephone": "phone"})
    assert converter.header.task == "AudioNav"
    for one in dwell.episodes.read(out):
        assert one.goal is not None
        assert one.goal["sound"] == "phone"
        assert (one.goal["offset_s"], one.goal["duration_s"]) == (2.0, 25.0)
    converted(path, out, sounds={"telephone.wav": "phone"}, everlasting=True)
    env = DwellEnv("AudioNav", episodes=out, sensors=["gps"])
    for one, (_, goal, _) in zip(dwell.episodes.read(out), places, strict=False):
        assert one.goal is not None
        assert "duration_s" not in one.goal
        env.reset(options={"episode_id": one.episode_id})
        (played,) = (row for row in env.world.sounds() if row["sound"] == {"signal": "phone"})
        assert played["position"] == pytest.approx([goal[0], goal[1] + 1.5, goal[2]], abs=1e-4)
        assert expert(env)["success"]


def test_sounds_may_be_files(tmp_path: Path, places: list[Any]) -> None:
    sounds = tmp_path / "sounds"
    sounds.mkdir()
    tone = np.sin(np.arange(16_000) * 0.2)[None].astype(np.float32)
    dwell.sounds.write_wav(sounds / "beep.wav", tone, 16_000)
    path = written(tmp_path / "val.json.gz", audio_nav(places[:1], sound_id="beep.wav"))
    out = tmp_path / "val.jsonl"
    level = {"level_db": 70.0}
    converted(path, out, sound_root=sounds, task_settings=level)
    env = DwellEnv("AudioNav", episodes=out, sensors=["gps"], world={"sound_root": str(sounds)})
    env.reset(seed=1)
    assert any(row["sound"] == {"file": "beep.wav"} for row in env.world.sounds())
    with pytest.raises(dwell.DwellError, match="sound_root"):
        DwellEnv("AudioNav", episodes=out, sensors=["gps"]).reset(seed=1)


def test_ways_that_differ_are_reported(tmp_path: Path, places: list[Any], command: Command) -> None:
    rows = [point_nav(k, place) for k, place in enumerate(places[:3])]
    rows[1]["info"]["geodesic_distance"] *= 3.0
    rows[2]["info"]["geodesic_distance"] = math.inf
    path, out = written(tmp_path / "val.json.gz", {"episodes": rows}), tmp_path / "val.jsonl"
    args = ("episodes", "--from", path, "--houses", f"studio={HOUSE}", "--out", out)
    done = command(*args, "--json")
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert (summary["episodes"], summary["distances"]["compared"]) == (3, 2)
    assert [*summary["distances"]["differing"]] == [f"{path}: episodes[1]"]
    assert f"{path}: episodes[1]: the way to the goal is {3 * places[1][2]:.2f} m" in done.stderr
    # SPL is by our own way.
    found = [*dwell.episodes.read(out)]
    assert found[1].start_distance_to_goal == pytest.approx(places[1][2], rel=0.12, abs=0.1)
    assert found[2].source_distance_to_goal is None
    assert "ways that are stated ours differ by" in command(*args).stdout


def test_places_off_the_floor_are_skipped_or_moved(
    tmp_path: Path, places: list[Any], command: Command
) -> None:
    rows = [point_nav(k, place) for k, place in enumerate(places[:3])]
    rows[0]["start_position"] = [places[0][0][0], places[0][0][1] + 0.5, places[0][0][2]]
    rows[2]["goals"][0]["position"] = [900.0, 0.0, 0.0]
    path, out = written(tmp_path / "val.json.gz", {"episodes": rows}), tmp_path / "val.jsonl"
    args = ("episodes", "PointNav", "--from", path, "--houses", f"studio={HOUSE}", "--out", out)
    done = command(*args, "--json")
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert [*summary["skipped"]] == [f"{path}: episodes[0]", f"{path}: episodes[2]"]
    assert "doors sweep: the nearest is" in done.stderr
    assert "0.50 m away" in done.stderr
    assert [one.source_id for one in dwell.episodes.read(out)] == ["val.json.gz#1"]
    done = command(*args, "--json", "--snap", "0.6")
    summary = json.loads(done.stdout)
    assert [*summary["skipped"]] == [f"{path}: episodes[2]"]
    assert summary["moved"] == 1
    (first, _) = dwell.episodes.read(out)
    assert first.start_position == pytest.approx(places[0][0])
    # A house with another origin.
    for row in rows[:2]:
        for place in (row["start_position"], row["goals"][0]["position"]):
            place[0] += 7.0
    rows[0]["start_position"][1] -= 0.5
    written(path, {"episodes": rows[:2]})
    done = command(*args, "--json", "--move=-7,0,0")
    assert json.loads(done.stdout)["episodes"] == 2, done.stderr
    done = command(*args)
    assert done.returncode == 1
    assert "none of 2 episodes can be played in these houses" in done.stderr


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["ObjectNav"], "task is 'ObjectNav'; the episodes of"),
        (["--houses", "attic=builtin:studio"], "scene_id is 'data/scene_datasets/made/studio.bas"),
        (["--houses", "studio"], "--houses: expected NAME=VALUE, found 'studio'"),
        (["--snap", "-1"], "snap_m is -1"),
        (["--shard", "0/2"], "--shard is given, and --from does not read it"),
        (["--set", "colour=1"], "no argument 'colour'"),
        (["--classes", "a=b", "--classes", "a=c"], "--classes: a is given twice"),
        (["--classes", "a=b"], "classes is given, and is read for episodes of ObjectNav; these"),
        (["--instances", "stated"], "instances is given, and is read for episodes of ObjectNav"),
        (["--sounds", "a=phone"], "sounds is given, and is read for episodes of AudioNav; these"),
        (["--sound-root", "."], "sound_root is given, and is read for episodes of AudioNav"),
        (["--everlasting"], "everlasting is given, and is read for episodes of AudioNav; these"),
    ],
)
def test_what_cannot_be_converted_is_refused(
    options: list[str], told: str, points: Path, tmp_path: Path, command: Command
) -> None:
    out = tmp_path / "x.jsonl"
    houses = [] if "--houses" in options else ["--houses", f"studio={HOUSE}"]
    done = command("episodes", *options, "--from", points, *houses, "--out", out)
    assert done.returncode == 1
    assert told in done.stderr
    assert not out.exists()
    done = command("episodes", "PointNav", "--houses", HOUSE, "--out", out)
    assert "expected TASK and --count, or --from" in done.stderr


def test_categories_that_are_unknown_are_mapped(tmp_path: Path, places: list[Any]) -> None:
    whole = object_nav(places[:1], "throne", things_of("sofa"), 2)
    path, out = written(tmp_path / "val.json.gz", whole), tmp_path / "val.jsonl"
    with pytest.raises(dwell.MeasuredDataError, match=r"episodes\[0\].object_category is 'throne'"):
        converted(path, out)
    converted(path, out, classes={"throne": "sofa"})
    (one,) = dwell.episodes.read(out)
    assert one.goal_class == "sofa"
    del whole["category_to_task_category_id"]["throne"]
    written(path, whole)
    with pytest.raises(dwell.MeasuredDataError, match="category_to_task_category_id has 'bed'"):
        converted(path, out)


def test_houses_may_be_those_of_a_folder(points: Path, tmp_path: Path) -> None:
    folder = tmp_path / "houses"
    folder.mkdir()
    dwell.House.open(HOUSE).write(folder / "studio.dwell", "dwell")
    converter = HabitatConverter(points, folder)
    (first, *_) = converter.episodes(1)
    assert first.scene_id == str(folder / "studio.dwell")
    (folder / "studio.glb").write_bytes(b"")
    with pytest.raises(dwell.ConfigError, match="are of one scene; give a mapping"):
        HabitatConverter(points, folder)
    with pytest.raises(dwell.ConfigError, match="holds no house"):
        HabitatConverter(points, tmp_path / "pointnav" / "val" / "content")
