"""Guesses about impulse responses of a room."""

from __future__ import annotations

from pathlib import Path

from dwell.measured import names
from dwell.measured.guesses import UNKNOWN, Guess, start
from dwell.measured.survey import Survey

_SIDES = ("floor", "ceiling", "west", "east", "north", "south")


def guess_responses(tables: list[Survey], sounds: list[Path]) -> Guess:
    """A map of responses."""
    guess = start("impulse_response")
    guess.say("axes", "z_up", "as in most files of rooms; SOFA's z is up")
    guess.say(
        "origin",
        [0.0, 0.0, 0.0],
        "the corner of the room that is least along the engine's "
        "axes, in your axes: with z up, the corner of least x and z and largest y",
    )
    guess.say("environment.temperature_c", None, UNKNOWN)
    guess.say("room.size_m", None, f"{UNKNOWN}: lengths along the engine's x, y (up) and z")
    guess.say(
        "room.surfaces",
        {side: {"substance": "plaster"} for side in _SIDES},
        "plaster is in no file: say what each side is",
    )
    files = [path.name for path in sounds if path.suffix.lower() == ".sofa"]
    if files:
        guess.say("sofa.file", files if len(files) > 1 else files[0], "its suffix")
        guess.say("sofa.episode", "measurement", "'receiver' makes an episode of each response")
        return guess
    for survey in tables:
        for column, cells in survey.texts.items():
            if cells and all(cell.lower().endswith(".wav") for cell in cells):
                _guess_table(guess, survey, tables, column)
                return guess
    for key in ("file", "wav", "source", "receiver"):
        guess.say(
            f"table.{key}",
            None,
            "a table with a row for each WAV file is needed: its name, "
            "and where source and receiver were",
        )
    return guess


def _guess_table(guess: Guess, survey: Survey, tables: list[Survey], wav: str) -> None:
    guess.say("table.file", survey.file, f"its column {wav!r} names WAV files")
    guess.say("table.wav", wav, "its cells end in .wav")
    guess.say("table.episode", wav, "a file an episode")
    others = [column for column in survey.columns if column != wav]
    for key, words in (
        ("source", ("source", "src", "speaker", "loudspeaker", "emitter")),
        ("receiver", ("receiver", "mic", "microphone", "listener", "rec")),
    ):
        found = [t for t in names.triples(others) if any(word in t[0].lower() for word in words)]
        named = names.first_named(others, words)
        if found:
            guess.say(f"table.{key}", found[0], "three columns that differ in x, y and z")
            for column in found[0]:
                guess.mapping["table"].setdefault("units", {})[column] = (
                    names.unit_in(column) or "m"
                )
        elif named is not None:
            guess.say(f"table.{key}", named, "its name; places by name are needed")
            _guess_places(guess, tables, survey, key, named)
        else:
            guess.say(
                f"table.{key}",
                "{channel}" if key == "receiver" else None,
                f"no column tells of it; a place for each channel of the {key}: fill it in",
            )
            guess.say(f"places.{key}s", {"1": None}, UNKNOWN)
    if isinstance(guess.mapping["table"].get("source"), str):
        guess.say(
            "table.split_group",
            guess.mapping["table"]["source"],
            "a source's are held out together",
        )
    for key, other in (("channel", "channels"), ("gain", "scale")):
        named = names.first_named(others, (key, other))
        if named is not None:
            guess.say(f"table.{key}", named, "its name")


def _guess_places(guess: Guess, tables: list[Survey], own: Survey, key: str, column: str) -> None:
    for survey in tables:
        triple = names.triples([c for c in survey.columns if c in survey.numbers])
        if survey is own or not triple:
            continue
        label = names.first_named(survey.columns, (names.bare(column), "id", "name"))
        guess.say(
            f"places.{key}s",
            {"file": survey.file, "name": label, "position": triple[0]},
            "it has three coordinates",
        )
        return
    told = own.texts.get(column) or [f"{v:g}" for v in own.numbers[column].tolist()]
    guess.say(f"places.{key}s", {name: None for name in sorted({*told})}, UNKNOWN)
