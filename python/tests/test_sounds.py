"""Sound files: pressure that comes back as it was, and what is refused."""

from __future__ import annotations

import os
import struct
import wave
from pathlib import Path

import numpy as np
import pytest

import dwell
from dwell.envs import DwellEnv
from dwell.sounds import read_wav, signals, synthesize, write_wav

SOUND = np.random.default_rng(0).normal(0.0, 3.0, (3, 401)).astype(np.float32)


def test_a_preset_or_folder_that_there_is_not_is_refused_at_once(tmp_path: Path) -> None:
    with pytest.raises(
        dwell.ConfigError, match=r"sound_preset is 'loud'.*'rl', 'full', 'reference'"
    ):
        dwell.World("builtin:studio", sound_preset="loud")  # type: ignore[arg-type] # what is tested
    with pytest.raises(dwell.ConfigError, match=r"sound_root is .*nowhere.*No such file"):
        DwellEnv("Free", sensors=["gps"], world={"sound_root": str(tmp_path / "nowhere")})


def test_pressure_comes_back_to_the_bit(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    write_wav(path, SOUND, 48_000)
    found, rate_hz = read_wav(path)
    assert rate_hz == 48_000
    assert found.dtype == np.float32
    assert np.array_equal(found, SOUND)
    write_wav(path, SOUND[:, :0], 16_000)
    assert read_wav(path)[0].shape == (3, 0)


def test_what_a_head_says_wrongly_is_told(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    write_wav(path, SOUND, 16_000)
    whole = path.read_bytes()
    at = whole.index(b"data") + 4
    path.write_bytes(whole[:at] + bytes(4) + whole[at + 4 :])
    with pytest.raises(dwell.MeasuredDataError, match=r"0 bytes of sound, and 4812 follow"):
        read_wav(path)
    path.write_bytes(whole[:24] + bytes(4) + whole[28:])
    with pytest.raises(dwell.MeasuredDataError, match=r"a\.wav: its head says 0 samples a second"):
        read_wav(path)


def test_numbers_beyond_32_bits_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    sound = np.array([0.5, 1e300]).tobytes()
    layout = struct.pack("<HHIIHH", 3, 1, 16_000, 128_000, 8, 64)
    body = b"WAVEfmt " + struct.pack("<I", 16) + layout + b"data" + struct.pack("<I", 16) + sound
    path.write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)
    with pytest.raises(dwell.MeasuredDataError, match=r"sample 1 of channel 0 is 1e\+300"):
        read_wav(path)


@pytest.mark.parametrize("kind", ["<f4", "<f8"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_samples_that_are_no_finite_numbers_are_refused(
    tmp_path: Path, kind: str, value: float
) -> None:
    path = tmp_path / "a.wav"
    width = np.dtype(kind).itemsize
    sound = np.array([0.5, 0.0, 1.0, value], kind).tobytes()
    layout = struct.pack("<HHIIHH", 3, 2, 16_000, 16_000 * 2 * width, 2 * width, 8 * width)
    body = b"WAVEfmt " + struct.pack("<I", 16) + layout
    body += b"data" + struct.pack("<I", len(sound)) + sound
    path.write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)
    told = rf"a\.wav: sample 1 of channel 1 is {value}; allowed are finite numbers, Pa"
    with pytest.raises(dwell.MeasuredDataError, match=told):
        read_wav(path)


def test_a_snapshot_whose_sound_is_gone_is_refused(tmp_path: Path) -> None:
    write_wav(tmp_path / "a.wav", SOUND[:1], 16_000)
    world = dwell.World("builtin:studio", sound_root=tmp_path)
    world.play("a.wav", at=(1.0, 1.0, 1.0), level_db=60.0)
    saved, before = world.snapshot(), world.state_hash()
    (tmp_path / "a.wav").unlink()
    with pytest.raises(FileNotFoundError) as refused:
        world.restore(saved)
    assert os.fspath(refused.value.filename) == str(tmp_path / "a.wav")
    assert world.state_hash() == before


def test_files_are_those_of_the_format(tmp_path: Path) -> None:
    """IEEE float has an extension of the format and counts its samples in a chunk of its own."""
    path = tmp_path / "a.wav"
    write_wav(path, SOUND, 48_000)
    file = path.read_bytes()
    assert file[:4] == b"RIFF"
    assert int.from_bytes(file[4:8], "little") == len(file) - 8
    assert file[8:16] == b"WAVEfmt "
    numbers = np.frombuffer(file[16:38], "<u2")
    assert list(numbers[2:4]) == [3, 3], "float, three channels"
    assert list(numbers[8:11]) == [12, 32, 0]
    assert file[38:50] == b"fact" + (4).to_bytes(4, "little") + (401).to_bytes(4, "little")
    # The engine reads it, too.
    world = dwell.World("builtin:studio", sound_root=tmp_path)
    world.play("a.wav", at=(1.0, 1.0, 1.0), level_db=60.0)
    world.step()


def test_a_file_that_was_written_anew_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"

    def heard(house: dwell.House) -> bytes:
        world = dwell.World(house, sound_root=tmp_path)
        x, y, z = world.agents()[0]["position"]
        world.play("a.wav", at=(x, y + 1.5, z + 0.5), level_db=80.0)
        world.listen(1)
        blocks = []
        for _ in range(3):
            world.step()
            blocks.append(world.listen(world.samples_a_step).tobytes())
        return b"".join(blocks)

    house = dwell.House.open("builtin:studio")
    write_wav(path, SOUND[:1], 16_000)
    first = heard(house)
    assert heard(house) == first
    write_wav(path, SOUND[1:, :300], 16_000)
    second = heard(house)
    assert second != first
    assert second == heard(dwell.House.open("builtin:studio")), "as a house that never read it"


def test_sixteen_bits_have_the_scale_that_was_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    write_wav(path, SOUND, 16_000, full_scale_pa=20.0)
    with wave.open(str(path)) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getnframes()) == (3, 2, 401)
    found, _ = read_wav(path, full_scale_pa=20.0)
    assert float(np.abs(found - SOUND).max()) <= 0.5 * 20.0 / 32767.0 + 1e-6
    write_wav(path, SOUND, 16_000, full_scale_pa=1.0)
    assert float(np.abs(read_wav(path)[0]).max()) == 1.0, "louder samples are clipped"


def test_what_is_no_sound_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.wav"
    for full_scale_pa in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(dwell.ConfigError, match="full_scale_pa"):
            write_wav(path, SOUND, 16_000, full_scale_pa=full_scale_pa)
    with pytest.raises(dwell.ConfigError, match="shape"):
        write_wav(path, SOUND[0], 16_000)
    for rate_hz in (0, -1, 8000.5, float("nan"), 2**33):
        with pytest.raises(dwell.ConfigError, match=r"rate_hz is .*; allowed are whole numbers"):
            write_wav(path, SOUND, rate_hz)  # type: ignore[arg-type] # the fault
    hidden = np.ma.masked_array(SOUND, SOUND > 0.0)
    for sound, said in (
        (np.zeros((70_000, 1)), "70000 channels; a WAV file of such samples holds 16383"),
        (np.full((1, 2), 1e300), r"found 1e\+300 Pa"),
        (np.full((1, 2), np.nan), "allowed are finite numbers"),
        (np.zeros((1, 2), complex), "expected real numbers"),
        (hidden, "masked elements"),
    ):
        with pytest.raises(dwell.ConfigError, match=said):
            write_wav(path, sound, 16_000)
    assert not path.exists()
    path.write_bytes(b"RIFF")
    with pytest.raises(dwell.MeasuredDataError, match=r"a\.wav: no WAV file"):
        read_wav(path)
    path.write_bytes(b"RIFF\4\0\0\0WAVE")
    with pytest.raises(dwell.MeasuredDataError, match="fmt and data"):
        read_wav(path)
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(1)
        file.setframerate(8000)
        file.writeframes(b"abcabc")
    with pytest.raises(dwell.MeasuredDataError, match="8 bits"):
        read_wav(path)


def test_laws_that_change_no_sound_are_told(caplog: pytest.LogCaptureFixture) -> None:
    house = dwell.House.shoebox((4.0, 2.5, 3.0))
    dwell.AcousticScene(house, laws={"drag": {"c_d": 0.5}, "source_gain": {"gain_db": 3.0}})
    assert caplog.messages == ["laws: drag: no law of sound; an AcousticScene is as without"]


def dead_room(height_m: float | None = None) -> dwell.House:
    """A room without reflections; with a mug on a pillar of this height, 1 m before the agent."""
    plan = dwell.House.shoebox((12.0, 12.0, 12.0), absorption=1.0).edit()
    if height_m is not None:
        plan.add_box((0.5, height_m, 0.5), at=(6.0, 0.0, 5.0), name="pillar")
        plan.add("mug", on="pillar", name="mug")
    return plan.done()


def heard_db(world: dwell.World, steps: int = 20) -> float:
    """The level at the ears, dB, after the first steps."""
    blocks = []
    for _ in range(steps):
        world.step()
        blocks.append(world.listen(800))
    return float(20.0 * np.log10(np.concatenate(blocks[8:], axis=1).std() / 2e-5))


@pytest.mark.parametrize("height_m", [0.6, 1.2, 1.6])
def test_what_is_played_at_a_vessel_is_heard_over_its_rim(height_m: float) -> None:
    house = dead_room(height_m)

    def level_db(at: str | tuple[float, float, float]) -> float:
        world = dwell.World(house)
        world.place_agent((6.0, 0.0, 6.0))
        world.play("white", at=at, level_db=80.0, loop=True)
        return heard_db(world)

    mug = dwell.World(house, agents=0).object("mug")
    x, y, z = mug["center"]
    above = level_db((x, y + 0.5 * mug["size"][1] + 0.1, z))
    # A mug above the ears shades a little; from within it, it would be 30 dB.
    assert level_db("mug") == pytest.approx(above, abs=3.0)


def test_sixteen_sources_are_heard_and_more_are_told(caplog: pytest.LogCaptureFixture) -> None:
    """Each has the same samples, so that pressures add up."""
    house = dead_room()

    def level_db(count: int) -> float:
        world = dwell.World(house)
        world.place_agent((6.0, 0.0, 6.0))
        for _ in range(count):
            world.play("white", at=(6.0, 1.25, 4.0), level_db=50.0, loop=True)
        return heard_db(world)

    one = level_db(1)
    assert level_db(16) == pytest.approx(one + 20.0 * np.log10(16.0), abs=0.2)
    assert "more sources than the sound preset follows" not in caplog.text
    assert level_db(17) == pytest.approx(one + 20.0 * np.log10(16.0), abs=0.2)
    assert "more sources than the sound preset follows" in caplog.text


def test_a_signal_begins_again_after_its_period() -> None:
    for row in signals():
        period = synthesize(row["name"], rate_hz=8000)
        assert period.shape == (round(row["loop_s"] * 8000),)
        assert abs(float(np.sqrt(np.mean(period.astype(np.float64) ** 2))) - 1.0) < 0.02
        more = synthesize(row["name"], rate_hz=8000, seconds=row["loop_s"] + 0.5)
        assert np.array_equal(more, np.concatenate([period, period[:4000]]))
    for wrong in ({"signal": "gong"}, {"rate_hz": 0}, {"seconds": -1.0}, {"seconds": np.nan}):
        with pytest.raises(dwell.ConfigError):
            synthesize(**{"signal": "phone", **wrong})
