"""Hidden cases: the worlds against closed forms, d' against a fit, no trace of causes, scores."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import dwell
from dwell.challenge import (
    Case,
    ChallengeSettings,
    calibrated_verdict,
    case,
    least_squares,
    make,
    one_at_a_time,
    run,
    score,
)
from dwell.challenge.cases import STRATA, WORLDS, _kind_of, name_of
from dwell.challenge.detection import Detector
from dwell.challenge.noise import Noise
from dwell.challenge.rows import read_answers, read_verdicts
from dwell.challenge.scores import wilson_interval
from dwell.challenge.writing import bundle_of

FLIGHTS, SERVOS = WORLDS["flights"], WORLDS["servos"]


def throws(seed: int = 3) -> Any:  # noqa: ANN401
    """Throws of a table-tennis ball."""
    known = FLIGHTS.conditions(np.random.default_rng(seed))
    return dataclasses.replace(known, mass_kg=0.0027, radius_m=0.02)


def ramps(slope: float) -> Any:  # noqa: ANN401
    """Runs of a servo whose command rises, or is one step."""
    known = SERVOS.conditions(np.random.default_rng(6))
    t = np.arange(known.commands.shape[1]) / 100.0
    commands = np.tile(0.3 + slope * t, (len(known.commands), 1))
    return dataclasses.replace(known, commands=commands, rate_hz=100.0, samples=np.full(8, 300))


def seen_of(known: Any, values: dict[str, tuple[float, ...]]) -> Any:  # noqa: ANN401
    return SERVOS.observe(known, known.starts, values)[0, :, 0]


def first_of(kind: str, seed: int = 0) -> Case:
    number = next(k for k in range(100) if _kind_of(k) == kind)
    return case(number, ChallengeSettings(cases=100, seed=seed))


def test_linear_drag_and_tilt_follow_their_closed_forms() -> None:
    known = throws()
    rate, lean, scale = 0.3, 0.05, 1.02
    seen = FLIGHTS.observe(
        known,
        known.starts,
        {"viscous_damping": (rate,), "frame_tilt": (lean,), "length_scale": (scale,)},
    )
    t = np.arange(seen.shape[1])[None, :, None] / known.rate_hz
    place, velocity = known.starts[:, None, :3], known.starts[:, None, 3:]
    terminal = np.array([0.0, -9.80665 / rate, 0.0])
    exact = place + terminal * t + (velocity - terminal) * (1.0 - np.exp(-rate * t)) / rate
    x, y, z = np.moveaxis(exact, 2, 0)
    leaning = np.stack(
        [np.cos(lean) * x - np.sin(lean) * y, np.sin(lean) * x + np.cos(lean) * y, z], axis=2
    )
    assert np.abs(seen - scale * leaning).max() < 1e-9


def test_quadratic_drag_loses_the_energy_that_its_force_takes() -> None:
    known = throws(4)
    c_d = 0.8
    seen = FLIGHTS.observe(known, known.starts, {"drag": (c_d,)})
    velocity = np.gradient(seen, 1.0 / known.rate_hz, axis=1)[:, 2:-2]
    speed = np.linalg.norm(velocity, axis=2)
    energy = 0.5 * speed**2 + 9.80665 * seen[:, 2:-2, 1]
    power = np.gradient(energy, 1.0 / known.rate_hz, axis=1)[:, 1:-1]
    area = np.pi * known.radius_m**2
    expected = -0.5 * 1.2041 * c_d * area / known.mass_kg * speed[:, 1:-1] ** 3
    assert np.abs(power - expected).max() < 0.02 * np.abs(expected).max()


def test_a_step_of_a_servo_is_that_of_a_damped_oscillator() -> None:
    known = ramps(0.0)
    t = np.arange(300) / 100.0
    frequency = np.sqrt(known.stiffness_n_m_rad / known.inertia_kg_m2)
    ratio = known.damping_n_m_s_rad / 2.0 / np.sqrt(known.inertia_kg_m2 * known.stiffness_n_m_rad)
    damped = frequency * np.sqrt(1.0 - ratio**2)
    fade = np.exp(-ratio * frequency * t)
    swing = np.cos(damped * t) + ratio * frequency / damped * np.sin(damped * t)
    exact = 0.3 * (1.0 - fade * swing)
    assert np.abs(seen_of(known, {}) - exact).max() < 1e-9


def test_faults_of_servos_do_what_their_names_say() -> None:
    rising = ramps(0.5)
    plain = seen_of(rising, {})
    # Late by a whole number of samples; scaled; a play that is pushed all the way.
    assert np.abs(seen_of(rising, {"latency": (0.05,)})[5:] - plain[:-5]).max() < 1e-12
    assert np.abs(seen_of(rising, {"command_scale": (1.1,)}) - 1.1 * plain).max() < 1e-12
    less = dataclasses.replace(rising, commands=rising.commands - 0.02)
    assert np.abs(seen_of(rising, {"backlash": (0.02,)}) - seen_of(less, {})).max() < 1e-12
    # At rest where the servo pulls less than friction holds, and late by a lag's time on a ramp.
    still = ramps(0.0)
    holds = 0.31 * still.stiffness_n_m_rad
    assert np.abs(seen_of(still, {"joint_friction": (holds,)})).max() == 0.0
    # Less than that: it slides until the pull is the friction, half of it in the end.
    slid = seen_of(still, {"joint_friction": (0.5 * holds,)})
    rest = slid[-1]
    pull = still.stiffness_n_m_rad * (0.3 - rest)
    assert slid[-50:].min() == rest
    assert abs(pull) <= 0.5 * holds
    behind = plain[-1] - seen_of(rising, {"first_order_lag": (0.04,)})[-1]
    assert behind == pytest.approx(0.5 * 0.04, rel=0.02)
    quarter = seen_of(still, {"eccentric_encoder": (0.01,)}) - seen_of(still, {})
    assert quarter[-1] == pytest.approx(0.01 * np.sin(0.3), rel=1e-3)


def test_d_prime_is_that_of_a_fit_of_parabolas() -> None:
    """Unknown starts of flights without drag are all straight lines, which a fit takes away."""
    known = throws()
    noise_sd = 0.002
    found = Detector(FLIGHTS, known, noise_sd).d_prime({"gravity": (9.9,)})
    power = 0.0
    for count in known.samples:
        t = np.arange(count) / known.rate_hz
        fall = -0.5 * (9.9 - 9.80665) * t**2
        line = np.polynomial.Polynomial.fit(t, fall, 1)
        power += float(((fall - line(t)) ** 2).sum())
    assert found == pytest.approx(np.sqrt(power) / noise_sd, rel=1e-3)


def test_strengths_have_the_d_prime_that_was_asked() -> None:
    detector = Detector(FLIGHTS, throws(), 0.002)
    drag = next(effect for effect in FLIGHTS.effects if effect.id == "drag")
    strength = detector.strength(drag, 150.0, 1.0)
    assert strength is not None
    assert detector.d_prime({"drag": (strength,)}) == pytest.approx(150.0, rel=0.011)
    assert detector.strength(drag, 1e7, 1.0) is None


def test_flights_do_not_tell_gravity_from_scales() -> None:
    detector = Detector(FLIGHTS, throws(), 0.0005)
    by_id = {effect.id: effect for effect in FLIGHTS.effects}
    hidden = {"gravity": (9.82,)}
    for rival in ("length_scale", "clock_scale"):
        assert detector.distance(hidden, by_id[rival]) < 0.5
    for rival in ("frame_tilt", "magnus"):
        assert detector.distance(hidden, by_id[rival]) > 5.0


def test_kinds_have_their_shares() -> None:
    counts = dict.fromkeys(STRATA, 0)
    for k in range(800):
        counts[_kind_of(k)] += 1
    assert all(abs(counts[kind] - share) <= 2 for kind, share in STRATA.items()), counts


def test_a_case_is_the_same_whatever_their_number_and_no_other(tmp_path: Path) -> None:
    few, many = ChallengeSettings(cases=3, seed=4), ChallengeSettings(cases=90, seed=4)
    assert case(2, few).answer() == case(2, many).answer()
    assert case(2, few).name != case(2, dataclasses.replace(few, seed=5)).name
    made = [folder for _, folder, is_new in make(tmp_path, few) if is_new]
    texts = {path: path.read_bytes() for folder in made for path in folder.iterdir()}
    assert len(texts) in range(9, 13)
    # What is there stays; what is gone is made again to the same bytes.
    for path in made[1].iterdir():
        path.unlink()
    made[1].rmdir()
    assert [is_new for *_, is_new in make(tmp_path, few)] == [False, True, False]
    assert {path: path.read_bytes() for folder in made for path in folder.iterdir()} == texts


@pytest.mark.parametrize("kind", ["one", "two", "outside", "fault"])
def test_a_bundle_has_no_trace_of_its_cause(tmp_path: Path, kind: str) -> None:
    """But for numbers that were measured, it is the bundle of the same case without a cause."""
    from dwell.challenge.writing import _write

    hidden = first_of(kind, seed=8)
    rows = {}
    for name, one in {"hidden": hidden, "plain": dataclasses.replace(hidden, values={})}.items():
        folder = tmp_path / name
        folder.mkdir()
        _write(folder, one, seed=8)
        table = [
            row.split(",") for row in (folder / "trajectory.csv").read_text("utf-8").splitlines()
        ]
        places = [row for row in table if not row[3].startswith("w")]
        # Measured spins and all that says which, when and where are the same.
        rows[name] = [
            (folder / "manifest.json").read_bytes(),
            (folder / "episodes.csv").read_bytes(),
            [row[:4] for row in table],
            [row for row in table if row[3].startswith("w")],
            (folder / "command.csv").exists() and (folder / "command.csv").read_bytes(),
            [os.stat(folder / file).st_mtime for file in sorted(os.listdir(folder))],
        ]
        rows[f"{name} values"] = [row[4] for row in places]
    assert rows["hidden"] == rows["plain"]
    assert rows["hidden values"] != rows["plain values"]
    words = (tmp_path / "hidden/manifest.json").read_text("utf-8")
    effects = (*FLIGHTS.effects, *SERVOS.effects)
    assert not any(effect.id in words for effect in effects)


def perfect(answer: dict[str, Any]) -> dict[str, Any]:
    """The verdict of who knows."""
    ids = [one["id"] for one in answer["hidden"]]
    if answer["kind"] == "nothing":
        return {"kind": "nothing", "sets": [], "parameters": {}}
    if answer["kind"] == "outside":
        return {"kind": "unexplained", "sets": [], "parameters": {}}
    alike = [[id] for id, value in answer["rivals"].items() if value < 1.0 and len(ids) == 1]
    parameters = {
        one["id"]: {name: [v, v - abs(v), v + abs(v)] for name, v in one["parameters"].items()}
        for one in answer["hidden"]
    }
    kind = "one_of" if alike else "named"
    return {"kind": kind, "sets": [ids, *alike], "parameters": {} if alike else parameters}


def answer(number: int, kind: str, rivals: dict[str, float], **hidden: float) -> dict[str, Any]:
    """An answer in which each effect has a first parameter of 0.5 and a d'."""
    names = {"drag": "c_d", "gravity": "gravity_m_s2"}
    return {
        "case": f"{number:012x}",
        "kind": kind,
        "hidden": [
            {"id": id, "parameters": {names.get(id, "value"): 0.5}, "d_prime": d_prime}
            for id, d_prime in hidden.items()
        ],
        "rivals": rivals,
    }


ANSWERS = [
    answer(0, "nothing", {}),
    answer(1, "nothing", {}),
    answer(2, "one", {"viscous_damping": 9.0}, drag=30.0),
    answer(3, "one", {"viscous_damping": 6.0}, drag=7.0),
    answer(4, "one", {"length_scale": 0.1}, gravity=12.0),
    answer(5, "two", {"drag": 20.0, "magnus": 8.0}, drag=30.0, magnus=10.0),
    answer(6, "two", {"drag": 2.0}, drag=30.0, magnus=2.0),
    answer(7, "outside", {"drag": 8.0}, fan=20.0),
    answer(8, "fault", {"drag": 11.0}, frame_tilt=11.0),
]


def test_who_knows_has_full_scores_and_who_guesses_has_not() -> None:
    found = score(ANSWERS, [{"case": row["case"], **perfect(row)} for row in ANSWERS])
    assert found["judged"] == 9
    assert (found["false_alarms"]["hits"], found["false_alarms"]["of"]) == (0, 2)
    assert found["wrong_names_of_faults"]["hits"] == 0
    of = {"top_1_from_10": 1, "top_1_5_to_10": 1, "set": 3, "inseparable": 1, "both_of_two": 1}
    beyond = {"outside_unnamed": 1, "outside_apart_unnamed": 1, "outside_seen": 1}
    for name, count in {**of, **beyond}.items():
        assert (found[name]["hits"], found[name]["of"]) == (count, count), name
    assert found["coverage"]["share"] == 1.0
    assert found["median_error"] == 0.0
    assert found["mean_set_size"] == pytest.approx(4.0 / 3.0)
    drag = {"kind": "named", "sets": [["drag"]], "parameters": {"drag": {"c_d": [0.6, 0.55, 0.7]}}}
    found = score(ANSWERS, [{"case": row["case"], **drag} for row in ANSWERS])
    assert found["false_alarms"]["share"] == found["wrong_names_of_faults"]["share"] == 1.0
    assert found["outside_unnamed"]["hits"] == found["both_of_two"]["hits"] == 0
    assert found["single_name_of_two"]["share"] == 1.0
    assert (found["set"]["hits"], found["set"]["of"]) == (1, 3)
    assert (found["coverage"]["hits"], found["coverage"]["of"]) == (0, 2)
    assert found["median_error"] == pytest.approx(0.2)


def test_baselines_name_what_is_strong_and_nothing_where_nothing_is(tmp_path: Path) -> None:
    from dwell.challenge.writing import _write

    known = throws(11)
    noise = Noise("gaussian", 0.002, correlation=0.0, step=0.0, lost=0.02, gross=0.0)
    plain = dataclasses.replace(
        first_of("nothing"), world="flights", known=known, noise=noise, noise_is_known=True
    )
    for name, hidden in {"drag": {"drag": (0.5,)}, "nothing": {}}.items():
        folder = tmp_path / f"{name}.measured"
        folder.mkdir()
        _write(folder, dataclasses.replace(plain, values=hidden), seed=1)
    for method in (least_squares, one_at_a_time):
        assert method(tmp_path / "nothing.measured")["kind"] == "nothing"
        found = method(tmp_path / "drag.measured")
        assert "drag" in found["sets"][0]
        assert found["parameters"]["drag"]["c_d"][0] == pytest.approx(0.5, rel=0.1)


def test_intervals_are_those_of_wilson() -> None:
    # R. Newcombe, Statistics in Medicine 17 (1998), table I: 81 of 263, 15 of 148, 0 of 20.
    for hits, count, low, high in [
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
    ]:
        assert wilson_interval(hits, count) == pytest.approx([low, high], abs=5e-5)
    assert wilson_interval(0, 0) is None


def test_a_run_goes_on_where_it_was_killed(tmp_path: Path) -> None:
    list(make(tmp_path / "cases", ChallengeSettings(cases=3, seed=2)))
    asked = []

    def method(bundle: Path) -> dict[str, Any]:
        asked.append(bundle.name)
        return {"kind": "nothing", "sets": [], "parameters": {}}

    verdicts = tmp_path / "verdicts.jsonl"
    list(run(tmp_path / "cases", verdicts, method))
    whole = verdicts.read_bytes()
    # The last row was cut.
    verdicts.write_bytes(whole[:-5])
    assert [new for _, new in run(tmp_path / "cases", verdicts, method)] == [False, False, True]
    assert verdicts.read_bytes() == whole
    assert len(asked) == 4
    assert len(list(read_verdicts(verdicts))) == 3


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("[]", "expected an object with a case"),
        ('{"case": "a", "sets": [], "parameters": {}}', "kind is None; expected one of nothing"),
        ('{"case": "a", "kind": "named", "sets": ["drag"], "parameters": {}}', "sets is"),
        (
            '{"case": "a", "kind": "named", "sets": [["x"]], "parameters": {"x": {"y": [1, 2]}}}',
            r"parameters is .*\[value, low, high\]",
        ),
    ],
)
def test_rows_that_are_no_verdicts_are_told_with_file_line_and_field(
    tmp_path: Path, row: str, told: str
) -> None:
    path = tmp_path / "rows.jsonl"
    path.write_text('{"case": "b", "kind": "nothing", "sets": [], "parameters": {}}\n' + row + "\n")
    with pytest.raises(ValueError, match=rf"rows\.jsonl line 2: {told}"):
        list(read_verdicts(path))
    with pytest.raises(ValueError, match=r"rows\.jsonl line 1: hidden is None"):
        list(read_answers(path))


def test_a_full_disk_is_told_with_the_file_of_verdicts(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    settings = ChallengeSettings(cases=2, worlds=("flights",))
    assert len([*make(tmp_path / "set", settings)]) == 2
    verdicts = tmp_path / "v.jsonl"

    def nothing(bundle: Path) -> dict[str, Any]:
        del bundle
        return {"kind": "nothing", "sets": [], "parameters": {}}

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (150, before[1]))
    try:
        with pytest.raises(OSError, match=r"v\.jsonl"):
            list(run(tmp_path / "set", verdicts, nothing))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert [is_new for _, is_new in run(tmp_path / "set", verdicts, nothing)] == [False, True]


def test_a_method_that_says_nothing_is_told(tmp_path: Path) -> None:
    list(make(tmp_path / "cases", ChallengeSettings(cases=1, seed=2)))
    verdicts = tmp_path / "verdicts.jsonl"
    with pytest.raises(ValueError, match=r"the verdict on .*: kind is None"):
        list(run(tmp_path / "cases", verdicts, lambda _: {}))
    assert not verdicts.exists()


def test_a_file_of_verdicts_is_of_one_method_and_one_process(tmp_path: Path) -> None:
    """It went on with the verdicts of any, and two at once wrote each case twice."""
    list(make(tmp_path / "cases", ChallengeSettings(cases=2, seed=2)))
    verdicts = tmp_path / "new/verdicts.jsonl"
    said = {"kind": "nothing", "sets": [], "parameters": {}}
    first = run(tmp_path / "cases", verdicts, lambda _: said, name="a")
    next(first)
    with pytest.raises(ValueError, match=r"verdicts\.jsonl is being written by another process"):
        list(run(tmp_path / "cases", verdicts, lambda _: said, name="a"))
    first.close()
    with pytest.raises(ValueError, match="keeps verdicts of another method: 'a', not 'b'"):
        list(run(tmp_path / "cases", verdicts, lambda _: said, name="b"))
    assert [row["method"] for row in read_verdicts(verdicts)] == ["a"]
    verdicts.write_text(json.dumps({"case": "0", **said}) + "\n")
    with pytest.raises(ValueError, match="of another method: one that is not named, not 'perfect'"):
        list(run(tmp_path / "cases", verdicts, perfect))


def test_scores_are_of_one_verdict_on_each_case_and_of_one_method(tmp_path: Path) -> None:
    """Of two the last counted, and of none of the cases a score was made."""
    rows = [{"case": row["case"], **perfect(row)} for row in ANSWERS]
    with pytest.raises(ValueError, match=f"two on case '{ANSWERS[0]['case']}'"):
        score(ANSWERS, [rows[0], *rows])
    with pytest.raises(ValueError, match=f"case '{ANSWERS[0]['case']}' has two that differ"):
        score([*ANSWERS, {**ANSWERS[0], "kind": "one"}], rows)
    assert score([*ANSWERS, ANSWERS[0]], rows)["judged"] == 9
    methods = [{**row, "method": "ab"[k % 2]} for k, row in enumerate(rows)]
    with pytest.raises(ValueError, match="of the methods 'a', 'b'; scores are of one"):
        score(ANSWERS, methods)
    with pytest.raises(ValueError, match="none of the 9 is on one of the 1 cases of the answers"):
        score([{**ANSWERS[0], "case": "other"}], rows)
    found = score(ANSWERS[1:], rows)
    assert (found["judged"], found["unanswered"]) == (8, 1)
    path = tmp_path / "verdicts.jsonl"
    path.write_text("".join(json.dumps(row) + "\n" for row in [*rows, rows[2]]))
    with pytest.raises(ValueError, match=r"line 10: case '000000000002' stands in line 3, too"):
        list(read_verdicts(path))


def test_cases_of_other_settings_have_other_names() -> None:
    settings = [
        ChallengeSettings(cases=1, seed=seed, worlds=worlds)
        for seed in (0, 1)
        for worlds in (("flights", "servos"), ("servos", "flights"), ("flights",), ("servos",))
    ]
    assert len({name_of(0, one) for one in settings}) == len(settings)
    assert name_of(0, settings[0]) == case(0, settings[0]).name == "a30febcfd9c2"
    assert name_of(0, settings[2]) == case(0, settings[2]).name


def test_other_cases_are_not_mixed_with_those_of_a_folder_or_an_answers_file(
    tmp_path: Path, command: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    """Bundles of two seeds stood side by side, and the first answers were gone."""
    out, answers = tmp_path / "cases", tmp_path / "answers.jsonl"

    def said(*options: object, out: Path = out) -> str:
        done = command("challenge", "make", "--out", out, "--answers", answers, *options)
        assert (done.returncode == 1) == bool(done.stderr)
        return done.stderr

    # Cases 0 and 2, in which nothing is hidden, are made fast.
    assert not said("--cases", "2", "--shard", "0/2")
    kept = answers.read_bytes(), sorted(os.listdir(out))
    assert "was begun with seed (a hash)" in said("--seed", "1")
    assert "was begun with worlds ['flights', 'servos']" in said("--worlds", "servos")
    lost = "answers.jsonl keeps 1 answers to cases that are not made now, as"
    assert lost in said("--worlds", "servos", out=tmp_path / "others")
    assert lost in said("--shard", "1/2")
    assert not (tmp_path / "others").exists()
    assert (answers.read_bytes(), sorted(os.listdir(out))) == kept
    # More of the same go on.
    assert not said("--cases", "3", "--shard", "0/2")
    assert len(list(read_answers(answers))) == 2
    answers.write_text("my notes\n")
    assert "answers.jsonl line 1: no JSON" in said("--cases", "3")


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"cases": 0}, "cases"),
        ({"seed": -1}, "seed"),
        ({"worlds": ()}, "worlds is empty"),
        ({"worlds": ("pendulums",)}, "'pendulums'; expected some of flights, servos"),
    ],
)
def test_settings_say_what_is_allowed(settings: dict[str, Any], told: str) -> None:
    with pytest.raises(dwell.ConfigError, match=told):
        ChallengeSettings(**settings)


def test_the_commands_make_and_score(
    tmp_path: Path, command: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    out, answers = tmp_path / "cases", tmp_path / "answers.jsonl"
    done = command("challenge", "make", "--cases", "2", "--out", out, "--answers", answers)
    assert done.returncode == 0, done.stderr
    assert "2 of 2 bundles written" in done.stdout
    rows = [json.loads(line) for line in answers.read_text("utf-8").splitlines()]
    assert all(bundle_of(out, row["case"]).is_dir() for row in rows)
    verdicts = tmp_path / "verdicts.jsonl"
    verdicts.write_text("".join(json.dumps({"case": r["case"], **perfect(r)}) + "\n" for r in rows))
    done = command("challenge", "score", verdicts, "--answers", answers)
    assert done.returncode == 0, done.stderr
    assert "2 cases judged" in done.stdout
    answers.write_text(answers.read_text("utf-8").replace(rows[0]["case"], "0" * 12), "utf-8")
    done = command("challenge", "score", verdicts, "--answers", answers)
    assert "1 cases judged; 1 verdicts on other cases left out" in done.stdout
    done = command("challenge", "make", "--out", out, "--answers", out / "answers.jsonl")
    assert done.returncode == 1
    assert "outside of" in done.stderr
    done = command("challenge", "run", tmp_path / "none", "--out", verdicts)
    assert done.returncode == 1
    assert "no bundles" in done.stderr


@pytest.mark.long
def test_a_strong_drag_is_named_and_nothing_is_not(tmp_path: Path) -> None:
    """The whole chain once: bundles of the reference, judged by the engine."""
    from dwell.challenge.writing import _write

    known = throws(11)
    detector = Detector(FLIGHTS, known, 0.002)
    drag = next(effect for effect in FLIGHTS.effects if effect.id == "drag")
    strength = detector.strength(drag, 150.0, 1.0)
    assert strength is not None
    noise = Noise("gaussian", 0.002, correlation=0.0, step=0.0, lost=0.02, gross=0.0)
    plain = dataclasses.replace(
        first_of("nothing"), world="flights", known=known, noise=noise, noise_is_known=True
    )
    values: dict[str, tuple[float, ...]] = {"drag": drag.value(strength)}
    for name, hidden in {"drag": values, "nothing": {}}.items():
        folder = tmp_path / f"{name}.measured"
        folder.mkdir()
        _write(folder, dataclasses.replace(plain, values=hidden), seed=1)
        verdict = calibrated_verdict(folder)
        if name == "nothing":
            assert verdict["kind"] == "nothing"
        else:
            assert verdict["sets"] == [["drag"]]
            value, *_ = verdict["parameters"]["drag"]["c_d"]
            assert value == pytest.approx(strength, rel=0.05)
