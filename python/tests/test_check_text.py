"""Texts of others judged claim by claim: our own agree, a swapped word is found."""

from __future__ import annotations

import json
import os
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import dwell
from dwell import cli

ALL = bool(os.environ.get("DWELL_TEST_ALL"))
HOUSES = ["builtin:studio"] + [f"seed:{seed}?home=studio" for seed in range(1 + 5 * ALL)]
Claim = dict[str, Any]


def viewers(world: dwell.World) -> Iterator[dict[str, Any]]:
    for room in world.house.rooms():
        yield {"position": room["eye"], "yaw_deg": room["yaw_deg"]}


def own_texts(world: dwell.World) -> Iterator[tuple[str, dict[str, Any] | None]]:
    """Captions of all levels; of views with who looks."""
    for seed in (None, 1):
        for text in world.describe("object", length="normal", seed=seed)[: 400 if ALL else 25]:
            yield text, None
        for text in world.describe("room", length="long", seed=seed):
            yield text, None
        yield world.describe("house", length="normal", seed=seed)[0], None
    for viewer in viewers(world):
        for length in ("short", "long"):
            yield world.describe("view", length=length, viewer=viewer)[0], viewer


@pytest.mark.parametrize("name", HOUSES)
def test_own_captions_agree(name: str) -> None:
    world = dwell.World(name, agents=0)
    claims = 0
    for text, viewer in own_texts(world):
        scope = "house" if viewer is None else "view"
        found = world.check_text(text, viewer=viewer, scope=scope)
        wrong = [(one["text"], one["status"]) for one in found["claims"] if one["status"] != "true"]
        assert wrong == [], text
        claims += len(found["claims"])
    assert claims > 30


def test_a_route_claims_nothing_and_changes_are_true() -> None:
    world = dwell.World("builtin:studio", agents=0)
    before = world.snapshot()
    joint = world.joints()[0]["id"]
    world.set_joints({joint: (0.8, 0.0)})
    (text,) = world.describe("changes", since=before)
    assert text
    assert {one["status"] for one in world.check_text(text)["claims"]} == {"true"}
    viewer = next(viewers(world))
    goal = f"room:{world.house.rooms()[-1]['name']}"
    for route in world.describe("route", viewer=viewer, to=goal):
        found = world.check_text(route, viewer=viewer)
        assert found["counts"]["false"] == found["counts"]["not_understood"] == 0


COLOR = re.compile(r"\b(?:white|gray|black|brown|green|blue|red|beige)\b")
NUMBER = re.compile(r"\b(?:two|three|four)\b")
#: Words that make a true claim false, whatever it is about, where a house lacks what they name.
OPPOSITES = {"open": "closed", "closed": "open", "left": "right", "right": "left"}


def swaps(world: dwell.World, text: str, claim: Claim, rng: random.Random) -> Iterator[str]:
    """A claim of a text with one word swapped, so that it cannot be true any more."""
    words = text[claim["start"] : claim["end"]]
    shown = {word for row in world.objects() for word, _ in attributes(world, row["name"])}
    lacking = [word for word in ("purple", "pink", "orange", "yellow") if word not in shown]
    kinds = {row["category"] for row in world.objects()}
    absent = [noun for noun in ("piano", "bathtub", "guitar", "aquarium") if noun not in kinds]
    for color in COLOR.findall(words)[:1]:
        if lacking and not re.search(rf"{color}-|-{color}|(?:light|pale|dark) {color}", words):
            yield words.replace(color, rng.choice(lacking), 1)
    nouns = {world.attributes(row["name"])["noun"] for row in world.objects()}
    # A piano leads to no room: of doors other words are swapped.
    known = [noun for noun in nouns if re.search(rf"\b{noun}\b(?! stand| paper| bottle)", words)]
    known = [] if re.search("door|window", words) else known
    if known and absent:
        # The longest one is no part of another.
        noun = max(known, key=lambda noun: (len(noun), noun))
        yield re.sub(rf"\b{noun}\b", rng.choice(absent), words, count=1)
    for number in NUMBER.findall(words)[:1]:
        if "metre" not in words:
            yield words.replace(number, "nine", 1)
    relation = re.search(r"\bto the (left|right) of\b", words)
    if relation:
        yield words.replace(relation[1], OPPOSITES[relation[1]], 1)
    state = re.search(r"\bis (open|closed)\b", words)
    if state:
        yield words.replace(state[1], OPPOSITES[state[1]], 1)


def attributes(world: dwell.World, name: str) -> list[tuple[str, float]]:
    return world.attributes(name)["colors"]


def test_one_swapped_word_is_found() -> None:
    rng = random.Random(5)
    tried, missed = 0, []
    for name in HOUSES:
        world = dwell.World(name, agents=0)
        for text, viewer in own_texts(world):
            scope = "house" if viewer is None else "view"
            for claim in world.check_text(text, viewer=viewer, scope=scope)["claims"]:
                if rng.random() > (0.3 if ALL else 0.06):
                    continue
                for other in swaps(world, text, claim, rng):
                    whole = text[: claim["start"]] + other + text[claim["end"] :]
                    found = world.check_text(whole, viewer=viewer, scope=scope)
                    tried += 1
                    if found["counts"]["false"] == 0:
                        missed.append((other, found["counts"]))
    assert tried > 40
    assert len(missed) <= 0.01 * tried, missed


def test_parts_of_a_sentence_are_judged_on_their_own() -> None:
    world = dwell.World("builtin:apartment", agents=0)
    found = world.check_text(
        "There are two beds, and there are nine sofas. It glimmers. Go to the kitchen!"
    )
    statuses = [(one["text"], one["status"]) for one in found["claims"]]
    assert statuses == [
        ("There are two beds", "true"),
        ("there are nine sofas.", "false"),
        ("It glimmers.", "not_understood"),
        ("Go to the kitchen!", "no_claim"),
    ]
    assert found["false_share"] == 0.5
    assert found["claims"][0]["witnesses"][0]["things"][0]["name"] == "double_bed_1"
    assert "glimmers" in found["claims"][2]["reason"]
    with pytest.raises(dwell.ConfigError, match="without a viewer"):
        world.check_text("There is a bed.", scope="view")
    with pytest.raises(dwell.ConfigError, match="allowed are 65536"):
        world.check_text("a " * 40_000)


def test_what_is_out_of_sight_is_none_of_a_view() -> None:
    world = dwell.World("builtin:apartment", agents=0)
    rooms = {room["name"]: room for room in world.house.rooms()}
    kitchen = rooms["kitchen"]
    viewer = {"position": kitchen["eye"], "yaw_deg": kitchen["yaw_deg"]}
    (claim,) = world.check_text("There is a toilet.", viewer=viewer, scope="view")["claims"]
    assert (claim["status"], claim["holds_elsewhere"]) == ("false", True)
    (claim,) = world.check_text("There is a toilet.", viewer=viewer)["claims"]
    assert (claim["status"], claim["holds_elsewhere"]) == ("true", False)
    (claim,) = world.check_text("There is no toilet.", viewer=viewer, scope="view")["claims"]
    assert claim["status"] == "true"


def test_the_walls_are_those_of_the_room_of_who_looks() -> None:
    world = dwell.World("builtin:studio", agents=0)
    rooms = [row for row in world.house.rooms() if row["kinds"][0] != "storage"]
    assert len(rooms) == 4
    for room in rooms:
        noun, viewer = room["kinds"][0], {"position": room["eye"], "yaw_deg": room["yaw_deg"]}
        for color in ("white", "brown"):
            answer = world.check(f"Every wall of the {noun} is {color}.")["answer"]["truth"]
            (claim,) = world.check_text(f"The walls are {color}.", viewer=viewer)["claims"]
            assert claim["status"] == {True: "true", False: "false", None: "undecided"}[answer]


def test_the_page_has_the_counts_of_its_run(capsys: pytest.CaptureFixture[str]) -> None:
    root = Path(__file__).parents[2]
    rows = root / "examples" / "captions" / "captions.jsonl"
    cli.main(["check-text", "builtin:apartment", "--json", "--file", str(rows)])
    found = json.loads(capsys.readouterr().out)
    counts = [found["counts"][key] for key in ("true", "false", "undecided", "not_understood")]
    page = (root / "docs" / "scoring-captions.md").read_text("utf-8")
    assert f"| {' | '.join(map(str, (sum(counts), *counts)))} |" in page


def test_the_command_judges_files_and_views(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = tmp_path / "captions.txt"
    texts.write_text("There is a bed.\n\nThere are nine beds.\n", "utf-8")
    assert cli.main(["check-text", "builtin:apartment", "--file", str(texts)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("There is a bed. true (double_bed_1")
    assert lines[1].startswith("There are nine beds. false")
    assert lines[2] == "2 claims: 1 true, 1 false"
    rows = tmp_path / "captions.jsonl"
    row = {"text": "There is a bed.", "viewer": {"position": [4.0, 1.6, 3.0], "yaw_deg": 0.0}}
    rows.write_text(json.dumps(row) + "\n", "utf-8")
    assert cli.main(["check-text", "builtin:apartment", "--json", "--file", str(rows)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["rows"][0]["scope"] == "view"
    assert cli.main(["check-text", "builtin:apartment"]) == 2
    assert "TEXT" in capsys.readouterr().err
    assert cli.main(["check-text", "builtin:apartment", "--view", "x", "A bed."]) == 1
    assert "expected the number of a room" in capsys.readouterr().err
    rows.write_text('{"words": 1}\n', "utf-8")
    assert cli.main(["check-text", "builtin:apartment", "--file", str(rows)]) == 1
    assert "line 1: expected an object with a text" in capsys.readouterr().err


STUDIO = ["check-text", "builtin:studio"]


@pytest.mark.parametrize("name", ["texts.txt", "texts.jsonl"])
def test_files_in_utf_8_may_have_a_mark_and_others_are_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The mark was a word of the text, and other encodings were read as strange letters."""
    is_json, file = name.endswith("jsonl"), tmp_path / name
    text = "There is a bed, étoile."
    written = json.dumps({"text": text}, ensure_ascii=False) if is_json else text
    file.write_bytes((written.replace(", étoile", "") + "\n").encode("utf-8-sig"))
    assert cli.main([*STUDIO, "--file", str(file)]) == 0
    assert capsys.readouterr().out.startswith("There is a bed. true")
    plain = written.replace("étoile", "star")
    for other, told in [
        (written.encode("latin-1"), "byte 0xe9 at"),
        (plain.encode("utf-16"), "byte 0xff at 0 is no UTF-8"),
        (plain.encode("utf-16-le"), "NUL is in no text"),
    ]:
        file.write_bytes(other)
        assert cli.main([*STUDIO, "--file", str(file)]) == 1
        said = capsys.readouterr().err
        assert f"{name} line 1: {told}" in said
        assert "save the file as UTF-8" in said


@pytest.mark.parametrize(
    ("field", "told"),
    [
        ({"viewer": {"position": [1]}}, "viewer position: expected three numbers"),
        ({"viewer": {"position": [1, 1, 1], "yaw": 3}}, "viewer is {'position': [1, 1, 1], 'yaw'"),
        ({"house": 5}, "house is 5; expected text or a path"),
        ({"house": "builtin:nope"}, 'no built-in house "nope"'),
        ({"text": "a " * 40_000}, "the text has 80000 bytes"),
    ],
)
def test_a_row_that_cannot_be_judged_is_told_with_its_line(
    field: dict[str, Any], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = tmp_path / "bad.jsonl"
    good = {"text": "There is a bed."}
    rows.write_text("".join(json.dumps(row) + "\n" for row in (good, {**good, **field})), "utf-8")
    assert cli.main([*STUDIO, "--file", str(rows)]) == 1
    assert f"bad.jsonl line 2: {told}" in capsys.readouterr().err


def test_a_text_or_a_file_is_needed_and_has_words(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(STUDIO) == 2
    assert "HOUSE [TEXT ...] [--file FILE]" in (said := capsys.readouterr().err)
    assert "required: TEXT (or --file FILE)" in said
    assert cli.main([*STUDIO, "A bed.", " "]) == 1
    assert capsys.readouterr() == ("", "dwell check-text: TEXT is ' '; expected a sentence\n")
    empty = tmp_path / "empty.txt"
    empty.write_text("\n\n")
    assert cli.main([*STUDIO, "--file", str(empty)]) == 1
    assert "empty.txt: no text; expected one a line" in capsys.readouterr().err
