"""Episodes in files: made, read, filtered, played; and the HOUSES strings they are made over."""

from __future__ import annotations

import json
import pickle
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import dwell
from dwell.cli.job_journal import Journal
from dwell.envs import DwellEnv, DwellVectorEnv
from dwell.episode_maker import EpisodeMaker
from dwell.house import split_of_seed
from dwell.house_list import HouseList

pytestmark = pytest.mark.usefixtures("open_once")

Command = Callable[..., subprocess.CompletedProcess[str]]
ENV_ID = "dwell/PointNav-v0"
HOUSES = ("builtin:studio", "seed:0..2?home=studio")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Eight episodes in three houses."""
    path = tmp_path_factory.mktemp("episodes") / "all.jsonl"
    maker = EpisodeMaker("PointNav", HOUSES, count=8, seed=5)
    assert dwell.episodes.write(path, maker.header, maker.episodes()) == 8
    return path


def rows(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text("utf-8").splitlines()]


def put(path: Path, lines: list[Any]) -> Path:
    path.write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
    return path


# ---- HOUSES strings


@pytest.mark.parametrize("split", ["train", "val", "test"])
def test_a_split_is_its_seeds_in_order_with_its_looks(split: str) -> None:
    houses = HouseList([f"split:{split}"])
    seeds = [k for k in range(1_000_000) if split_of_seed(k) == split]
    assert len(houses) == len(seeds)
    for k in (0, 7, 8, 9, 12_345, len(seeds) - 1):
        assert houses[k] == f"seed:{seeds[k]}?split={split}"
        assert houses.index(houses[k]) == k
    assert f"seed:{3 if split != 'train' else 18}?split={split}" not in houses
    some = HouseList([f"split:{split}:3..40?home=studio"])
    names = [f"seed:{seed}?split={split}&home=studio" for seed in seeds[3:40]]
    assert [*some] == names
    assert some == HouseList(names)
    assert some != HouseList([*names[:-1], names[0]])
    assert some.count(names[5]) == 1


def test_a_house_of_a_split_opens_again_by_its_name() -> None:
    (name,) = dwell.House.expand("split:val:1..2?home=studio")
    assert name == "seed:18?split=val&home=studio"
    assert dwell.House.open(name).rooms()
    with pytest.raises(dwell.HouseNotFoundError, match="stands for several houses"):
        dwell.House.open("split:val")


@pytest.mark.parametrize(
    ("houses", "told"),
    [
        ("split:dev", "no such split; allowed are split:train, split:val, split:test"),
        ("split:", "no such split"),
        ("split:val:5..5", "found '5..5'; allowed is A..B"),
        ("split:val:0..100001", "up to 100000, as many houses as the split val has"),
        ("split:val:x", "found 'x'"),
        ("split:val?split=train", "split stands twice"),
        ("split:val?storeys=99", "storeys: found 99; possible: 1 to 3"),
        ("nowhere/*.dwell", "no path is of this pattern"),
        ("@", "expected @FILE"),
    ],
)
def test_wrong_houses_are_told_by_what_is_allowed(houses: str, told: str) -> None:
    with pytest.raises(dwell.HouseError) as refused:
        HouseList([houses])
    assert told in str(refused.value)


def test_patterns_find_paths_sorted_and_a_path_that_exists_is_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("b.dwell", "a.dwell", "c[1].dwell", "d.glb"):
        (tmp_path / name).mkdir()
    monkeypatch.chdir(tmp_path)
    assert [*HouseList(["*.dwell"])] == ["a.dwell", "b.dwell", "c[1].dwell"]
    assert [*HouseList(["c[1].dwell", "?.glb"])] == ["c[1].dwell", "d.glb"]
    assert [*HouseList([f"{tmp_path}/[ab].dwell?map=m.json"])] == [
        f"{tmp_path}/a.dwell?map=m.json",
        f"{tmp_path}/b.dwell?map=m.json",
    ]


def test_a_list_names_houses_relative_to_its_folder(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data/x.dwell").mkdir()
    path = tmp_path / "list.txt"
    path.write_text("# mine\n\nbuiltin:studio\n data/*.dwell \nseed:3..5\nhome.json\n", "utf-8")
    assert [*HouseList([f"@{path}"])] == [
        "builtin:studio",
        f"{tmp_path}/data/x.dwell",
        "seed:3",
        "seed:4",
        f"{tmp_path}/home.json",
    ]


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
def test_a_line_of_a_list_ends_by_a_line_feed_alone(tmp_path: Path, ending: str) -> None:
    odd = [f"a{mark}b.json" for mark in "\v\f\r\x1c\x1d\x1e\x85\u2028\u2029"]
    # Of a path, its ends too.
    odd += ["\u2028c.json\u2029", "\xa0d.json\f"]
    path = tmp_path / "list.txt"
    path.write_bytes(ending.join([*odd, "", " \tseed:3..5\t "]).encode())
    assert [*HouseList([f"@{path}"])] == [
        *(f"{tmp_path}/{name}" for name in odd),
        "seed:3",
        "seed:4",
    ]
    path.write_bytes(f"builtin:studio{ending}".encode())
    assert [*HouseList([f"@{path}"])] == ["builtin:studio"]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"builtin:studio\nseed:5..3\n", "list.txt line 2: seed: found 5..3"),
        (b"@other.txt\n", "list.txt line 1: '@other.txt' is a list; a list names no other list"),
        (b"\n\nno/*.glb\n", "list.txt line 3: "),
        (b"# nothing\n", "list.txt: names no house"),
        (b"\xff\n", "list.txt: byte 0 is not UTF-8"),
    ],
)
def test_a_wrong_list_is_told_by_its_line(content: bytes, told: str, tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_bytes(content)
    with pytest.raises(dwell.HouseError) as refused:
        HouseList([f"@{tmp_path}/list.txt"])
    assert told in str(refused.value)


def test_a_list_that_is_not_there_is_an_error_of_the_system(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        HouseList([f"@{tmp_path}/none.txt"])
    with pytest.raises(OSError, match="a folder"):
        HouseList([f"@{tmp_path}"])


def test_environments_and_commands_take_all_of_them(tmp_path: Path, command: Command) -> None:
    (tmp_path / "list.txt").write_text("builtin:studio\n")
    env = DwellEnv("Free", houses=["split:val?home=studio", f"@{tmp_path}/list.txt"])
    assert len(env._shelf.names) == 100_001
    done = command("describe", f"@{tmp_path}/list.txt", "--length", "short", "--json")
    assert done.returncode == 0, done.stderr
    assert {row["house"] for row in json.loads(done.stdout)["rows"]} == {"builtin:studio"}


# ---- files of episodes


def test_an_episode_states_what_is_found_when_it_is_played(made: Path) -> None:
    header, *lines = rows(made)
    assert (header["format"], header["version"], header["count"]) == ("dwell-episodes", 1, 8)
    assert header["task_settings"]["max_distance_m"] == 30.0
    env = DwellEnv("PointNav", houses=[*HOUSES], sensors=["pointgoal_with_gps_compass"])
    assert [line["scene_id"] for line in lines] == sorted(
        (line["scene_id"] for line in lines), key=[*HouseList(HOUSES)].index
    )
    assert {line["scene_id"] for line in lines} == {*HouseList(HOUSES)}
    for line in lines:
        observation, info = env.reset(seed=0, options={"episode_id": line["episode_id"]})
        for name, value in info.items():
            assert line[name] == (list(value) if isinstance(value, tuple) else value)
        agent = env.agents()[0]
        assert line["start_position"] == pytest.approx(agent["position"])
        assert line["start_yaw_deg"] == pytest.approx(agent["yaw_deg"])
        straight_m = observation["pointgoal_with_gps_compass"][0]
        assert line["straight_distance_to_goal"] == pytest.approx(straight_m)
        assert line["instruction"] == env.instruction()


@pytest.mark.long
def test_shards_give_the_same_episodes_by_any_number_of_threads(
    made: Path, tmp_path: Path, command: Command
) -> None:
    args = ("episodes", "PointNav", "--houses", *HOUSES, "--count", "8", "--seed", "5")
    whole = tmp_path / "whole.jsonl"
    assert command(*args, "--out", whole).returncode == 0
    assert whole.read_bytes() == made.read_bytes()
    parts = []
    for shard in range(3):
        path = tmp_path / f"{shard}.jsonl"
        done = command(*args, "--shard", f"{shard}/3", "--out", path, "--workers", "2", "--json")
        assert done.returncode == 0, done.stderr
        parts.append(path)
        assert len([*dwell.episodes.read(path)]) == json.loads(done.stdout)["episodes"]
    assert [line for path in parts for line in rows(path)[1:]] == rows(whole)[1:]
    sharded = DwellEnv("PointNav", episodes=parts, sensors=["gps"])
    assert (
        sharded.reset(seed=3)[1]
        == DwellEnv("PointNav", episodes=whole, sensors=["gps"]).reset(seed=3)[1]
    )


def test_a_run_that_was_stopped_goes_on(
    made: Path, tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(EpisodeMaker.parts, "__defaults__", (2,))
    out, add, left = tmp_path / "cut.jsonl", Journal.add, [3]

    def stop(self: Journal, *args: object) -> None:
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        add(self, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(Journal, "add", stop)
    args = ("episodes", "PointNav", "--houses", *HOUSES, "--count", "8", "--seed", "5")
    stopped = command(*args, "--out", out)
    assert stopped.returncode == 130
    assert "2 pieces are kept; run again" in stopped.stderr
    assert not out.exists()
    monkeypatch.setattr(Journal, "add", add)
    again = command(*args, "--out", out, "--json")
    assert json.loads(again.stdout)["made_now"] == 4
    assert out.read_bytes() == made.read_bytes()
    assert "is there already" in command(*args, "--out", out).stderr


@pytest.mark.long
def test_houses_that_cannot_host_are_skipped_and_told(tmp_path: Path, command: Command) -> None:
    # Only one of the two is large enough.
    args = ("episodes", "PointNav", "--count", "2", "--set", "min_distance_m=12")
    done = command(
        *args, "--houses", "builtin:studio", "builtin:apartment", "--out", tmp_path / "a", "--json"
    )
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert [*summary["skipped"]] == ["builtin:studio"]
    assert "cannot be played in house" in done.stderr
    assert {one.scene_id for one in dwell.episodes.read(tmp_path / "a")} == {"builtin:apartment"}
    none = command(*args, "--houses", "builtin:studio", "--out", tmp_path / "b")
    assert none.returncode == 1
    assert "PointNav can be played in no house of these" in none.stderr
    assert not (tmp_path / "b").exists()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ("PointNav --count 0", "expected a whole number from 1"),
        ("Pointnav --count 1", "did you mean PointNav"),
        ("PointNav --count 1 --set far=1", "no argument 'far'"),
        ("PointNav --count 1 --set far", "expected FIELD=VALUE"),
        ("PointNav --count 1 --settings [1]", "expected a JSON object"),
        ("PointNav --count 1 --shard 2/2", "expected K/N"),
    ],
)
def test_what_cannot_be_made_is_refused_at_once(
    options: str, told: str, tmp_path: Path, command: Command
) -> None:
    out = tmp_path / "x.jsonl"
    done = command("episodes", *options.split(), "--houses", "builtin:studio", "--out", out)
    assert done.returncode in (1, 2)
    assert told in done.stderr
    assert [*tmp_path.iterdir()] == []


def test_the_expert_of_an_episode_is_counted(tmp_path: Path) -> None:
    maker = EpisodeMaker("PointNav", "builtin:studio", count=1, seed=2, expert=True)
    (one,) = maker.episodes()
    env = DwellEnv("PointNav", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=0, options={"episode_id": one.episode_id})
    count, is_over, info = 0, False, {}
    while not is_over:
        _, _, is_over, _, info = env.step(env.expert_action())
        count += 1
    assert (one.expert_actions, one.expert_success) == (count, info["success"])
    assert one.expert_path_length == pytest.approx(info["path_length"])


def change(name: str, value: object) -> Callable[[list[Any]], None]:
    def changed(lines: list[Any]) -> None:
        lines[2][name] = value

    return changed


def of_header(name: str, value: object) -> Callable[[list[Any]], None]:
    def changed(lines: list[Any]) -> None:
        lines[0][name] = value

    return changed


def without(name: str) -> Callable[[list[Any]], None]:
    return lambda lines: lines[2].pop(name)


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda lines: lines.pop(0), "line 1: format: no header"),
        (lambda lines: lines.clear(), "line 1: the file is empty"),
        (of_header("version", 2), "line 1: version is 2; this dwell reads 1"),
        (of_header("task", "PointNaw"), "line 1: task is 'PointNaw'; did you mean PointNav"),
        (of_header("count", 9), "line 9: the file ends after 8 of 9 episodes"),
        (of_header("count", 7), "line 9: one episode more than the 7"),
        (of_header("shard", [2, 2]), "line 1: shard[0] is 2"),
        (of_header("colour", 1), "line 1: 'colour': no field of a header"),
        (change("seed", -1), "line 3: seed is -1; allowed are whole numbers from 0"),
        (change("seed", 1.5), "line 3: seed is 1.5"),
        (change("seed", 7), "line 3: episode_id is "),
        (change("instruction", 3), "line 3: instruction is 3; expected text"),
        (change("start_position", [1, 2]), "line 3: start_position: expected three numbers"),
        (change("goal_objects", [True]), "line 3: goal_objects[0] is True"),
        (change("start_distance_to_goal", -2.0), "line 3: start_distance_to_goal is -2"),
        (change("expert_succes", True), "line 3: 'expert_succes': no field of an episode; did"),
        (without("scene_id"), "line 3: scene_id: missing"),
        (lambda lines: lines.__setitem__(2, [1]), "line 3: found [1]; expected an episode"),
        (lambda lines: lines.__setitem__(2, lines[1]), "line 3: episode_id"),
        (change("instruction", "x" * 2**21), "line 3: a line: "),
    ],
)
def test_a_bad_file_is_told_by_line_and_field(
    damage: Callable[[list[Any]], None], told: str, made: Path, tmp_path: Path
) -> None:
    lines = rows(made)
    damage(lines)
    path = put(tmp_path / "bad.jsonl", lines)
    with pytest.raises(dwell.MeasuredDataError) as refused:
        DwellEnv("PointNav", episodes=path, sensors=["gps"])
    assert f"{path} {told}" in str(refused.value)


@pytest.mark.parametrize(
    ("cut", "told"),
    [
        (lambda text: text[:-20], "line 9: the line has no end, the file was cut: "),
        (lambda text: text.replace(b"{", b"", 2), "line 1: no episode: no JSON"),
        (lambda text: text.replace(b"\n", b"\n\n", 2), "line 2: no episode: no JSON"),
        (lambda text: text.replace(b"Go", b"\xff", 1), "line 2: no episode: no JSON: byte"),
    ],
)
def test_a_damaged_file_is_told_by_line(
    cut: Callable[[bytes], bytes], told: str, made: Path, tmp_path: Path
) -> None:
    path = tmp_path / "bad.jsonl"
    path.write_bytes(cut(made.read_bytes()))
    with pytest.raises(dwell.MeasuredDataError) as refused:
        DwellEnv("PointNav", episodes=path, sensors=["gps"])
    assert f"{path} {told}" in str(refused.value)


def test_what_contradicts_a_file_is_refused(made: Path, tmp_path: Path) -> None:
    def env(**settings: object) -> DwellEnv:
        usual: dict[str, Any] = {"task": "PointNav", "episodes": made, "sensors": ["gps"]}
        return DwellEnv(**usual | settings)

    for settings, told in (
        ({"task": "RoomNav"}, "the file is of the task PointNav, this environment of 'RoomNav'"),
        ({"houses": "builtin:studio"}, "houses: an episode of the file is in 'seed:0?home=studio'"),
        ({"task_settings": {"min_distance_m": 3.0}}, "task_settings.min_distance_m is 3.0"),
        ({"task_settings": {"near": 3.0}}, "near"),
        ({"episodes": []}, "episodes is []"),
        ({"episodes": {"a"}}, "keeps no order"),
    ):
        with pytest.raises(dwell.ConfigError) as refused:
            env(**settings)
        assert told in str(refused.value)
    lines = rows(made)
    lines[0]["task_version"] = 4
    with pytest.raises(dwell.ConfigError, match="the file is of version 4 of PointNav"):
        env(episodes=put(tmp_path / "other.jsonl", lines))
    lines = rows(made)
    lines[0]["task_settings"]["max_distance_m"] = 20.0
    with pytest.raises(dwell.ConfigError, match="files that are played together have the same"):
        env(episodes=[made, put(tmp_path / "other.jsonl", lines)])
    # What does not choose episodes may differ, and houses that hold all of them may be given.
    paid = env(task_settings={"reward": {"step": -1.0, "distance": 0.0}}, houses=[*HOUSES[::-1]])
    paid.reset(seed=1)
    assert paid.step(6)[1] == -1.0
    with pytest.raises(dwell.ConfigError, match="give episode_id"):
        paid.reset(options={"house": 0})
    with pytest.raises(dwell.ConfigError, match="expected one of the 8 episodes"):
        paid.reset(options={"episode_id": "builtin:studio#1"})


def test_a_house_that_cannot_be_opened_is_told_with_file_and_line(
    made: Path, tmp_path: Path
) -> None:
    lines = rows(made)
    for line in lines[2:4]:
        line |= {"scene_id": "no.glb", "episode_id": f"no.glb#{line['seed']}"}
    path = put(tmp_path / "other.jsonl", lines)
    env = DwellEnv("PointNav", episodes=path, sensors=["gps"])
    told = f"^{path} line 3: scene_id: no.glb: "
    with pytest.raises(dwell.HouseNotFoundError, match=told):
        env.reset(options={"episode_id": lines[3]["episode_id"]})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("instruction", "Go away."),
        ("goal_kind", "room"),
        ("start_distance_to_goal", 2.0),
        ("start_position", [1.5, 0.0, 1.5]),
        ("start_yaw_deg", 12.5),
    ],
)
def test_an_episode_that_is_not_as_the_file_states_is_refused(
    field: str, value: object, made: Path, tmp_path: Path
) -> None:
    lines = rows(made)
    lines[2][field] = value
    path, asked = put(tmp_path / "other.jsonl", lines), {"episode_id": lines[2]["episode_id"]}
    env = DwellEnv("PointNav", episodes=path, sensors=["gps"])
    with pytest.raises(dwell.MeasuredDataError, match="made by something else") as refused:
        env.reset(seed=1, options=asked)
    assert f"{path} line 3: {field}: the file states {value!r}, played it is" in str(refused.value)
    env.reset(options={"episode_id": lines[1]["episode_id"]})
    many = DwellVectorEnv(2, "PointNav", episodes=path, sensors=["gps"])
    with pytest.raises(dwell.MeasuredDataError, match=field):
        many.reset(seed=1, options={"episode_id": [None, asked["episode_id"]]})


def test_environments_of_files_keep_the_contract(made: Path) -> None:
    env = gymnasium.make(ENV_ID, episodes=str(made), sensors=["gps"], disable_env_checker=True)
    check_env(env.unwrapped)
    ids = {line["episode_id"] for line in rows(made)[1:]}
    first = [env.reset(seed=123)[1]["episode_id"], env.reset()[1]["episode_id"]]
    assert first == [env.reset(seed=123)[1]["episode_id"], env.reset()[1]["episode_id"]]
    assert {env.reset()[1]["episode_id"] for _ in range(60)} == ids
    again = pickle.loads(pickle.dumps(env))
    assert again.reset(seed=123)[1]["episode_id"] == first[0]


def test_vector_environments_play_what_single_ones_do(made: Path) -> None:
    many = gymnasium.make_vec(
        ENV_ID, num_envs=2, episodes=made, sensors=["gps"], autoreset_mode="SameStep"
    )
    alone = [DwellEnv("PointNav", episodes=made, sensors=["gps"]) for _ in range(2)]
    _, infos = many.reset(seed=4)
    singles = [env.reset(seed=4 + k)[1] for k, env in enumerate(alone)]
    for _ in range(4):
        assert [*infos["episode_id"]] == [info["episode_id"] for info in singles]
        assert many.unwrapped.state_hashes() == [env.state_hash() for env in alone]
        _, _, _, _, infos = many.step(np.zeros(2, np.int64))
        singles = [env.reset()[1] for env in alone]
    many.close()


def test_environments_of_other_processes_play_files(made: Path) -> None:
    many = gymnasium.make_vec(
        ENV_ID, num_envs=2, vectorization_mode="async", episodes=str(made), sensors=["gps"]
    )
    _, infos = many.reset(seed=4)
    alone = DwellEnv("PointNav", episodes=made, sensors=["gps"])
    assert infos["episode_id"][0] == alone.reset(seed=4)[1]["episode_id"]
    many.close()


def test_a_snapshot_goes_on_in_an_environment_of_the_same_file(made: Path) -> None:
    env, other = (DwellEnv("PointNav", episodes=made, sensors=["gps"]) for _ in range(2))
    env.reset(seed=2)
    env.step(1)
    other.restore(env.snapshot())
    assert other.step(1)[4] == env.step(1)[4]
    assert other.state_hash() == env.state_hash()


def test_what_is_no_episode_is_not_written(made: Path, tmp_path: Path) -> None:
    file, out = dwell.episodes.read(made), tmp_path / "out.jsonl"
    for header, some, told in (
        (file.header, [], "there are none"),
        (file.header, [{"seed": 1}], r"episodes\[0\] is"),
        (None, [*file], "header is None"),
    ):
        with pytest.raises(dwell.ConfigError, match=told):
            dwell.episodes.write(out, header, some)  # type: ignore[arg-type]
    assert [*tmp_path.iterdir()] == []


def test_an_index_takes_little_memory_for_many_episodes(made: Path, tmp_path: Path) -> None:
    header, line, *_ = rows(made)
    path = tmp_path / "many.jsonl"
    with path.open("w") as file:
        file.write(json.dumps({**header, "count": 5000}) + "\n")
        for seed in range(5000):
            own = {"seed": seed, "episode_id": f"{line['scene_id']}#{seed}"}
            file.write(json.dumps({**line, **own}) + "\n")
    env = DwellEnv("PointNav", episodes=path, sensors=["gps"])
    index = env._shelf._index  # type: ignore[attr-defined]
    assert len(index) == 5000
    assert sum(part.nbytes for part in (index._houses, index._seeds, index._digests)) == 100_000


def test_who_cannot_open_doors_plays_the_episodes_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "all.jsonl"
    maker = EpisodeMaker("PointNav", "builtin:apartment", count=4, seed=1)
    dwell.episodes.write(file, maker.header, maker.episodes())
    four = ["stop", "move_forward", "turn_left", "turn_right"]
    for settings in ({"actions": four}, {"action_mode": "velocity"}):
        env = DwellEnv("PointNav", episodes=file, sensors=["gps"], **settings)  # type: ignore[arg-type] # of one
        for _ in range(4):
            env.reset()
