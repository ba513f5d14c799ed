"""Recordings with labels: against geometry, the engine's own directions, and theory of noise."""

from __future__ import annotations

import dataclasses
import json
import math
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv
from dwell.localization.dataset import DatasetMaker, labels_of
from dwell.localization.draws import Draws
from dwell.localization.labels import angles_deg, read_labels
from dwell.localization.layouts import PRESETS, Layout, layout
from dwell.localization.noise import diffuse_noise
from dwell.localization.pool import Pool, Sound, resampled
from dwell.localization.rendering import Recording, Renderer
from dwell.localization.rooms import OpenHouse, house_list
from dwell.localization.scenes import Scene, SceneSource, draw_scene
from dwell.localization.settings import Settings
from dwell.localization.trajectory import Trajectory, seen_from
from dwell.sounds import read_wav, write_wav

Command = Callable[..., subprocess.CompletedProcess[str]]
RATE_HZ = 16_000
SETTINGS = Settings(duration_s=2.0, rate_hz=RATE_HZ, arrays=("tetrahedral", "foa", "binaural"))


@pytest.fixture(scope="module")
def room() -> OpenHouse:
    return OpenHouse(dwell.House.shoebox((7.0, 3.0, 6.0), substance="plaster"), SETTINGS)


def scene(listener: Trajectory, way: Trajectory, samples: int = 24_000) -> Scene:
    """White noise from 0.25 s on."""
    source = SceneSource(Sound("white", 0, 70.0), 4_000, samples, 0.3, way, "none")
    return Scene(0, "box", listener, (source,), 20.0, 5)


def walk(
    start: tuple[float, ...], goal: tuple[float, ...], speed: float, **turn: float
) -> Trajectory:
    return Trajectory.along(np.array([start, goal]), speed, 0.25, **turn)


LISTENER = walk((3.0, 1.6, 3.6), (3.6, 1.6, 3.0), 0.4, yaw_deg=25.0, yaw_rate_deg_s=15.0)
SOURCE = walk((1.0, 1.1, 1.2), (5.0, 1.1, 1.5), 1.2)


@pytest.fixture(scope="module")
def moving(room: OpenHouse) -> dict[str, Recording]:
    names = ("tetrahedral", "foa")
    found = Renderer(room, SETTINGS, Pool("signals")).record(
        scene(LISTENER, SOURCE), [PRESETS[name] for name in names]
    )
    return dict(zip(names, found, strict=True))


def windows() -> list[tuple[slice, float]]:
    """Frames of 100 ms while the source sounds, and their middles, s."""
    step = RATE_HZ // 10
    return [(slice(k * step, (k + 1) * step), 0.1 * (k + 0.5)) for k in range(4, 16, 2)]


def test_labels_of_a_moving_source_and_array_are_where_the_sound_comes_from(
    moving: dict[str, Recording],
) -> None:
    # The engine's own first-order ambisonics tell the direction: the acoustic intensity.
    heard = moving["foa"].direct
    rows = {row.frame: row for row in labels_of(scene(LISTENER, SOURCE), SETTINGS)}
    assert sorted(rows) == list(range(3, 18))
    for window, middle_s in windows():
        piece = heard[:, window] * np.hanning(RATE_HZ // 10)
        left, up, front = (piece[0] * piece[1:]).sum(axis=1)
        row = rows[int(middle_s * 10)]
        azimuth = math.degrees(math.atan2(left, front))
        elevation = math.degrees(math.atan2(up, math.hypot(front, left)))
        assert row.azimuth_deg == pytest.approx(azimuth, abs=0.5)
        assert row.elevation_deg == pytest.approx(elevation, abs=0.5)


def test_labels_are_the_state_of_a_world_in_which_the_same_moves() -> None:
    # One agent turns and walks, another walks by: a world's own steps, 20 a second.
    world = dwell.World(dwell.House.shoebox((8.0, 3.0, 8.0)), agents=2)
    world.place_agent((4.0, 0.0, 5.0), yaw_deg=30.0)
    world.place_agent((2.0, 0.0, 2.0), yaw_deg=-100.0, agent=1)
    told = [row["position"] for row in world.agents()]
    eye = world.agents()[0]["body"]["eye_height_m"]
    # Legs have their velocities at once: 0.5 m/s ahead and 20 degrees a second; 1.2 m/s.
    turn = math.radians(20.0)
    controls = np.array([[0.0, 0.0, turn, 0.0], [1.2, 0.0, 0.0, 0.0]], np.float32)
    start, heading = np.array(told[1]) + np.array((0.0, eye, 0.0)), math.radians(-100.0)
    goal = start + 3.0 * np.array((-math.sin(heading), 0.0, -math.cos(heading)))
    way = Trajectory.along(np.array([start, goal]), 1.2, 0.0)
    x, y, z = told[0]
    listener = Trajectory(((x, y + eye, z),), (0.0,), 30.0, 20.0)
    source = SceneSource(Sound("white", 0, 70.0), 0, 2 * RATE_HZ, 0.0, way, "none")
    rows = labels_of(Scene(0, "box", listener, (source,), 20.0, 5), SETTINGS)
    for step in range(1, 40):
        world.step(controls)
        if step % 2 == 0:
            continue  # frames have their middles at 50, 150 ms and so on
        (first, second), frame = world.agents(), step // 2
        east, south = (second["position"][k] - first["position"][k] for k in (0, 2))
        # Bearings from -Z to the left, and what the agent faces itself.
        azimuth = math.degrees(math.atan2(-east, -south)) - first["yaw_deg"]
        row = next(row for row in rows if row.frame == frame)
        off = (row.azimuth_deg - azimuth + 180.0) % 360.0 - 180.0
        assert abs(off) < 0.5
        assert row.distance_m == pytest.approx(math.hypot(east, south), abs=0.02)


def test_labels_are_what_the_task_of_the_engine_takes_for_right() -> None:
    env = DwellEnv("SoundLocalization", houses="builtin:studio", sensors=["gps"])
    env.reset(seed=1)
    for action in (2, 2, 1, 3, 1):
        answer = env.expert_action()["answer"]
        agent = env.world.agents()[0]
        x, y, z = agent["position"]
        ear = (x, y + agent["body"]["eye_height_m"], z)
        sound = next(row for row in env.world.sounds() if row["object"] is None)
        way = Trajectory((tuple(sound["position"]),), (0.0,))
        seen = seen_from(Trajectory((ear,), (0.0,), agent["yaw_deg"]), way, [0.0])[0]
        azimuth, elevation = angles_deg(seen)
        assert azimuth / 180.0 == pytest.approx(float(answer["azimuth"][0]), abs=1e-4)
        assert elevation / 90.0 == pytest.approx(float(answer["elevation"][0]), abs=1e-4)
        assert np.linalg.norm(seen) / 50.0 == pytest.approx(float(answer["distance"][0]), abs=1e-4)
        env.step({"action": action, "answer": answer})
    env.close()


def test_direct_sound_of_what_moves_reaches_microphones_in_their_times(
    moving: dict[str, Recording],
) -> None:
    array = PRESETS["tetrahedral"]
    for window, middle_s in windows():
        spectra = np.fft.rfft(moving["tetrahedral"].direct[:, window] * np.hanning(RATE_HZ // 10))
        cycles = np.arange(spectra.shape[1]) / (RATE_HZ // 10)
        here = LISTENER.positions(np.array([middle_s]))[0]
        yaw = math.radians(float(LISTENER.yaws_deg(np.array([middle_s]))[0]))
        ears = [
            here
            + np.array(
                [
                    x * math.cos(yaw) + z * math.sin(yaw),
                    y,
                    -x * math.sin(yaw) + z * math.cos(yaw),
                ]
            )
            for x, y, z in array.microphones
        ]
        away = np.linalg.norm(SOURCE.positions(np.array([middle_s]))[0] - here)
        # Where the source was when what is heard now left it.
        then = SOURCE.positions(np.array([middle_s - away / 343.2]))[0]
        delays = [float(np.linalg.norm(ear - then)) / 343.2 * RATE_HZ for ear in ears]
        for other in (1, 2, 3):
            expected = delays[other] - delays[0]
            cross = spectra[0] * spectra[other].conj() * np.exp(-2j * np.pi * cycles * expected)
            used = (cycles > 0.01) & (cycles < 0.33)
            weight = np.abs(cross[used]) * cycles[used]
            slope = np.sum(weight * np.angle(cross[used])) / np.sum(weight * cycles[used])
            assert abs(slope) / (2.0 * np.pi) < 0.05


def test_what_hardly_moves_sounds_as_what_stands(room: OpenHouse) -> None:
    still = Trajectory(((3.0, 1.6, 3.6),), (0.0,), 25.0)
    creeps = Trajectory(((3.0, 1.6, 3.6), (3.0, 1.6, 3.6001)), (0.0, 2.0), 25.0)
    source = Trajectory(((1.0, 1.1, 1.2),), (0.0,))
    renderer = Renderer(room, SETTINGS, Pool("signals"))
    one, other = (
        renderer.record(scene(way, source, 8_000), [PRESETS["foa"]])[0] for way in (still, creeps)
    )
    for name in ("direct", "early"):
        first, second = getattr(one, name), getattr(other, name)
        assert np.sum((first - second) ** 2) < 1e-3 * np.sum(first**2)
    # Late sound is drawn anew a hair further on: its energy is the same.
    ratio = np.sum(one.late**2) / np.sum(other.late**2)
    assert 0.7 < ratio < 1.4


def test_the_louder_ear_is_on_the_side_of_the_label(room: OpenHouse) -> None:
    listener = Trajectory(((3.0, 1.6, 3.0),), (0.0,), 0.0)
    renderer = Renderer(room, SETTINGS, Pool("signals"))
    for place, azimuth in (((1.5, 1.6, 3.0), 90.0), ((4.5, 1.6, 3.0), -90.0)):
        one = scene(listener, Trajectory((place,), (0.0,)), 8_000)
        left, right = (renderer.record(one, [PRESETS["binaural"]])[0].direct ** 2).sum(axis=1)
        assert labels_of(one, SETTINGS)[0].azimuth_deg == pytest.approx(azimuth)
        assert (left > 2.0 * right) if azimuth > 0 else (right > 2.0 * left)


def test_sound_arrives_in_its_sample(room: OpenHouse) -> None:
    listener, place = Trajectory(((3.0, 1.6, 3.0),), (0.0,)), (3.0, 1.6, 3.0 - 3.432)
    place = (3.0, 1.6, 1.284)  # 1.716 m: 5 ms, 80 samples
    one = scene(listener, Trajectory((place,), (0.0,)), 8_000)
    alone = Layout("one", "array", ((0.0, 0.0, 0.0),))
    impulse = dataclasses.replace(
        one.sources[0], sound=Sound("impulse", 0, 70.0), onset=1_000, start=0.0
    )
    heard = Renderer(room, SETTINGS, Pool("signals")).record(
        dataclasses.replace(one, sources=(impulse,)), [alone]
    )[0]
    emitted = Pool("signals").samples(impulse.sound, RATE_HZ, impulse.samples, 0.0)
    at = int(np.argmax(np.abs(emitted)))
    assert int(np.argmax(np.abs(heard.direct[0]))) == 1_000 + at + 80


def test_diffuse_noise_is_as_coherent_as_cook_says() -> None:
    array = PRESETS["tetrahedral"]
    noise = diffuse_noise(array, RATE_HZ, 16 * RATE_HZ, 1)
    spectra = np.fft.rfft(noise.reshape(4, -1, 512), axis=2)
    cross = (spectra[0] * spectra[1].conj()).sum(axis=0)
    power = (np.abs(spectra) ** 2).sum(axis=1)
    coherence = cross / np.sqrt(power[0] * power[1])
    apart = math.dist(array.microphones[0], array.microphones[1])
    hz = np.fft.rfftfreq(512, 1 / RATE_HZ)
    expected = np.sinc(2.0 * hz * apart / 343.2)
    # 500 blocks: a standard error of 1 / sqrt(500) = 0.045, four of them; leakage at 0 Hz.
    assert np.abs(coherence[3:-3] - expected[3:-3]).max() < 0.18
    assert np.sqrt(np.mean(np.abs(coherence[3:-3] - expected[3:-3]) ** 2)) < 0.06
    # Of a diffuse field W has three times the power of X, Y, Z in SN3D.
    foa = (diffuse_noise(PRESETS["foa"], RATE_HZ, 4 * RATE_HZ, 1) ** 2).mean(axis=1)
    assert foa[1:] / foa[0] == pytest.approx(np.full(3, 1 / 3), rel=0.05)


def test_draws_are_those_of_their_key() -> None:
    draws = Draws("a", 1)
    # Raw bits of Philox by its published definition stay; these are the first of this key.
    assert draws.uniforms(3) == pytest.approx(Draws("a", 1).uniforms(3), abs=0)
    assert not np.allclose(Draws("a", 2).uniforms(3), Draws("a", 1).uniforms(3))
    normals = Draws("b").normals(20_001)
    assert len(normals) == 20_001
    assert abs(normals.mean()) < 0.03
    assert abs(normals.std() - 1.0) < 0.03


def test_a_tone_at_another_rate_is_the_same_tone() -> None:
    tone = np.sin(2 * np.pi * 440.0 * np.arange(44_100) / 44_100.0)
    there = resampled(tone, 44_100, 16_000)
    expected = np.sin(2 * np.pi * 440.0 * np.arange(16_000) / 16_000.0)
    assert np.abs(there[500:-500] - expected[500:-500]).max() < 1e-3


SMALL = dataclasses.replace(
    SETTINGS, duration_s=1.0, arrays=("foa",), moving=0.5, parts=True, distance_m=(0.5, 3.0)
)
HOUSES = ["shoebox:0..2"]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("whole")
    maker = DatasetMaker(HOUSES, SMALL, count=4)
    assert [is_new for _, is_new in maker.make(out)] == [True] * 4
    return out


def files(folder: Path) -> dict[str, bytes]:
    rows = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in rows}


def test_a_shard_has_the_bits_of_the_whole(made: Path, tmp_path: Path) -> None:
    maker = DatasetMaker(HOUSES, SMALL, count=4, shard=(1, 2))
    assert [clip for clip, is_new in maker.make(tmp_path) if is_new] == [2, 3]
    found = files(tmp_path)
    assert len(found) == 2 * 7  # sound, labels, details, four parts
    whole = files(made)
    assert found == {name: whole[name] for name in found}


def test_a_run_goes_on_where_it_stopped(made: Path, tmp_path: Path) -> None:
    out = tmp_path / "stopped"
    shutil.copytree(made, out)
    maker = DatasetMaker(HOUSES, SMALL, count=4)
    # Stopped before the clip was whole: its sound is there, what is known of it is not.
    maker.details(out, 1).unlink()
    (out / "metadata_dev" / maker.part_of(1) / f"{maker.name_of(1)}.csv").unlink()
    assert [is_new for _, is_new in maker.make(out)] == [False, True, False, False]
    assert files(out) == files(made)


def test_parts_add_up_to_the_clip_and_have_the_stated_ratio(made: Path) -> None:
    maker = DatasetMaker(HOUSES, SMALL, count=4)
    for clip in range(4):
        details = json.loads(maker.details(made, clip).read_text())
        told = details["recordings"]["foa"]
        whole, _ = read_wav(made / told["file"], full_scale_pa=told["full_scale_pa"])
        name = maker.name_of(clip)
        parts = {
            part: read_wav(made / "foa_dev_parts" / f"{name}_{part}.wav")[0].astype(float)
            for part in ("direct", "early", "late", "noise")
        }
        step = told["full_scale_pa"] / 32767.0
        assert np.abs(whole - sum(parts.values())).max() < 0.6 * step
        sounds = np.zeros(whole.shape[1], bool)
        for source in details["sources"]:
            first = source["onset_sample"]
            sounds[first : first + source["samples"]] = True
        signal = (parts["direct"] + parts["early"] + parts["late"])[:, sounds]
        ratio = 10.0 * math.log10(np.mean(signal**2) / np.mean(parts["noise"] ** 2))
        assert ratio == pytest.approx(details["snr_db"], abs=0.01)


def test_labels_in_files_are_those_of_the_scenes(made: Path) -> None:
    maker = DatasetMaker(HOUSES, SMALL, count=4)
    room = OpenHouse("shoebox:1", SMALL)
    scene = draw_scene(room, SMALL, maker.pool, 3)
    path = made / "metadata_dev" / maker.part_of(3) / f"{maker.name_of(3)}.csv"
    for found, row in zip(read_labels(path), labels_of(scene, SMALL), strict=True):
        assert (found.frame, found.class_index, found.source) == (
            row.frame,
            row.class_index,
            row.source,
        )
        assert found.azimuth_deg == pytest.approx(row.azimuth_deg, abs=0.051)
        assert found.distance_m == pytest.approx(row.distance_m, abs=0.0006)


def test_splits_are_by_house_and_by_array() -> None:
    settings = dataclasses.replace(
        SETTINGS, arrays=("foa", "phone"), held_out_arrays=("phone",), test_share=0.3
    )
    maker = DatasetMaker(["shoebox:0..400"], settings, count=800)
    parts = {maker.houses[maker.house_number(k)]: maker.part_of(k) for k in maker.clips}
    share = sum(part == "dev-test" for part in parts.values()) / len(parts)
    assert 0.2 < share < 0.4
    # A house is of one part, whatever list it is in.
    alone = DatasetMaker(["shoebox:7"], settings, count=1)
    assert alone.part_of(0) == parts["shoebox:7"]


def test_arrays_of_files(tmp_path: Path) -> None:
    path = tmp_path / "pair.json"
    path.write_text("[[-0.1, 0, 0], [0.1, 0, 0]]")
    pair = layout(str(path))
    assert (pair.name, pair.channels, pair.radius_m) == ("pair", 2, 0.1)
    assert PRESETS["eigenmike"].channels == 32
    # On a ball: each microphone is as far from the centre as the datasheet says.
    assert PRESETS["eigenmike"].radius_m == pytest.approx(0.042)
    radii = [math.dist(place, (0, 0, 0)) for place in PRESETS["eigenmike"].microphones]
    assert min(radii) == pytest.approx(0.042)
    assert [PRESETS[name].channels for name in ("foa", "hoa2", "hoa3")] == [4, 9, 16]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[[0,0,0]," * 0 + json.dumps([[0, 0, 0]] * 200), "1 to 128 microphones"),
        ("[]", "found none"),
        ("[[0, 0, 2.5]]", "2.5 m from the centre"),
        ("{}", "1 to 128 microphones"),
        ("[[0, 0]]", "three"),
        ("nonsense", "no JSON"),
    ],
)
def test_wrong_arrays_are_refused(tmp_path: Path, content: str, said: str) -> None:
    path = tmp_path / "own.json"
    path.write_text(content)
    with pytest.raises(dwell.ConfigError, match=said):
        layout(str(path))


@pytest.mark.parametrize(
    "wrong",
    [
        {"snr_db": (float("nan"), 3.0)},
        {"snr_db": (9.0, 3.0)},
        {"rate_hz": 44_100},
        {"max_sources": 5},
        {"arrays": ()},
        {"arrays": ("foa", "foa")},
        {"arrays": ("nosuch",)},
        {"held_out_arrays": ("phone",)},
        {"moving": 1.5},
        {"duration_s": 0.0},
    ],
)
def test_wrong_settings_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(dwell.ConfigError):
        dataclasses.replace(SETTINGS, **wrong)  # type: ignore[arg-type] # of the test's own


def test_sounds_of_a_folder_and_what_is_none(tmp_path: Path) -> None:
    (tmp_path / "dog").mkdir()
    tone = np.sin(np.arange(4_000) * 0.3)[None]
    write_wav(tmp_path / "dog" / "one.wav", tone, 8_000)
    pool = Pool(str(tmp_path))
    assert pool.classes == ["dog"]
    sound = pool.samples(pool.sounds[0], RATE_HZ, 5_000, 0.5)
    # 65 dB SPL at 1 m.
    assert np.sqrt(np.mean(sound**2)) == pytest.approx(2e-5 * 10 ** (65 / 20), rel=0.02)
    (tmp_path / "dog" / "two.wav").write_bytes(b"RIFF nothing")
    with pytest.raises(dwell.DwellError, match=r"two\.wav: no WAV file"):
        Pool(str(tmp_path))
    with pytest.raises(dwell.ConfigError, match="allowed are signals, household"):
        Pool(str(tmp_path / "nowhere"))


def test_a_clip_whose_source_was_in_its_pause_sounds(tmp_path: Path) -> None:
    """A telephone of which 1.3 s of its pause were drawn was a clip of residues, with labels."""
    settings = Settings(duration_s=2.0, rate_hz=RATE_HZ, max_sources=1)
    maker = DatasetMaker(["shoebox:0..1"], settings, count=1)
    assert [is_new for _, is_new in maker.make(tmp_path)] == [True]
    details = json.loads(maker.details(tmp_path, 0).read_text())
    assert details["sources"][0]["class"] == "phone"
    assert details["recordings"]["foa"]["full_scale_pa"] > 0.01


@pytest.mark.parametrize("duration_s", [1.0, 2.0, 5.0])
def test_every_source_of_a_clip_sounds_in_it(duration_s: float) -> None:
    settings = dataclasses.replace(SETTINGS, duration_s=duration_s)
    maker = DatasetMaker(["shoebox:0..2"], settings, count=60)
    rooms = [OpenHouse(name, settings) for name in maker.houses]
    classes = set()
    for clip in maker.clips:
        found = draw_scene(rooms[maker.house_number(clip)], settings, maker.pool, clip)
        for source in found.sources:
            classes.add(maker.pool.classes[source.sound.class_index])
            samples = (source.sound, RATE_HZ, source.samples, source.start)
            sound = maker.pool.samples(*samples)
            place, ear = source.way.points[0], found.listener.points[0]
            late = int(math.dist(place, ear) / 343.2 * RATE_HZ)
            heard = sound[: settings.samples - source.onset - late]
            level_pa = 2e-5 * 10.0 ** (source.sound.level_db / 20.0)
            assert np.mean(heard**2) > 0.09 * level_pa**2, samples
    assert {"phone", "doorbell", "alarm"} <= classes


def test_a_stretch_stays_where_it_sounds_and_is_drawn_evenly_where_it_does_not() -> None:
    pool = Pool("signals")
    phone = next(sound for sound in pool.sounds if sound.name == "phone")
    drawn = (np.arange(600) + 0.5) / 600
    found = np.array([pool.stretch(phone, RATE_HZ, 16_000, 16_000, start)[0] for start in drawn])
    kept = found == drawn
    assert 0.4 < kept.mean() < 0.6
    # What was silent is spread over the same starts as evenly.
    shares = [
        np.histogram(own, 20, (0.0, 1.0))[0] / len(own) for own in (found[kept], found[~kept])
    ]
    assert np.abs(shares[0] - shares[1]).max() < 0.01
    steady = next(sound for sound in pool.sounds if sound.name == "vacuum_cleaner")
    assert pool.stretch(steady, RATE_HZ, 16_000, 16_000, 0.3) == (0.3, 16_000)


def test_stretches_of_files_sound_and_are_no_longer_than_the_file(tmp_path: Path) -> None:
    (tmp_path / "dog").mkdir()
    barks = np.zeros((1, 40_000))
    barks[0, 30_000:32_000] = np.sin(np.arange(2_000) * 0.3)
    write_wav(tmp_path / "dog" / "long.wav", barks, 8_000)
    write_wav(tmp_path / "dog" / "short.wav", barks[:, 30_000:32_000], 8_000)
    pool = Pool(str(tmp_path))
    long, short = pool.sounds
    for drawn in np.linspace(0.0, 0.999, 20):
        start, count = pool.stretch(long, RATE_HZ, 16_000, 12_000, float(drawn))
        assert count == 16_000
        heard = pool.samples(long, RATE_HZ, count, start)[:12_000]
        assert np.mean(heard**2) > 0.09 * (2e-5 * 10 ** (65 / 20)) ** 2
    assert pool.stretch(short, RATE_HZ, 16_000, 16_000, 0.4) == (0.4, 4_000)
    room, settings = OpenHouse("shoebox:1", SMALL), dataclasses.replace(SMALL, max_sources=1)
    for clip in range(6):
        found = draw_scene(room, settings, pool, clip)
        (source,) = found.sources
        if source.sound == short:
            assert source.samples == 4_000
            assert len(labels_of(found, settings)) <= 4
    (tmp_path / "dog" / "long.wav").write_bytes(b"RIFF nothing")
    with pytest.raises(dwell.MeasuredDataError, match="it was a sound when the run began"):
        pool.stretch(long, RATE_HZ, 16_000, 16_000, 0.5)


def test_places_in_walls_and_arrays_larger_than_the_room_are_refused(room: OpenHouse) -> None:
    room.check_free("a source", (3.0, 1.2, 3.0))
    for place in ((-0.1, 1.2, 3.0), (3.0, 5.0, 3.0), (3.0, 1.2, 5.99)):
        with pytest.raises(dwell.ConfigError, match="in a wall, within a thing, or outside"):
            room.check_free("a source", place)
    inside = scene(LISTENER, Trajectory(((7.1, 1.2, 3.0),), (0.0,)))
    with pytest.raises(dwell.ConfigError, match="source 0 at"):
        Renderer(room, SETTINGS, Pool("signals")).record(inside, [PRESETS["foa"]])
    with pytest.raises(dwell.ConfigError, match=r"an array needs a free radius of 0\.14 m"):
        OpenHouse(dwell.House.shoebox((0.2, 2.5, 0.2)), Settings(arrays=("eigenmike",)))


def test_ranges_of_rooms() -> None:
    assert [*house_list(["shoebox:3..5", "builtin:studio"])] == [
        "shoebox:3",
        "shoebox:4",
        "builtin:studio",
    ]
    with pytest.raises(dwell.ConfigError, match="0 rooms"):
        house_list(["shoebox:5..5"])


def test_the_command_skips_a_bad_house_and_goes_on(command: Command, tmp_path: Path) -> None:
    words = ["localize", "make", "nosuch.glb", "shoebox:0", "--count", "2", "--duration-s", "1"]
    words += ["--rate-hz", "16000", "--out", str(tmp_path / "set"), "--json"]
    done = command(*words)
    assert done.returncode == 1
    assert "skipped nosuch.glb" in done.stderr
    said = json.loads(done.stdout)
    assert (said["clips"], said["made_now"]) == (2, 1)
    again = command(*words)
    assert json.loads(again.stdout)["made_now"] == 0
    other = command(*words, "--seed", "1")
    assert other.returncode == 1
    assert "was begun with seed 0" in other.stderr
    refused = command("localize", "make", "shoebox:0", "--count", "1", "--out", str(tmp_path / "x"),
                      "--snr-db", "nan", "3")  # fmt: skip
    assert refused.returncode == 2
    assert "finite number" in refused.stderr
