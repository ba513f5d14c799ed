"""Questions about views, balanced by construction.

A question is asked in pairs: of two views of one house, in the same words, with different answers.
Whoever sees no picture can do no better than guess between the answers.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dwell import _native
from dwell.views.forms import Form, phrase
from dwell.views.situations import SITUATIONS
from dwell.views.templates import TEMPLATES, Asked, Thing

if TYPE_CHECKING:
    from dwell.views.record import ViewRecord
    from dwell.world import World

__all__ = ["ask"]

#: Pixels of 256 x 256 from which a thing is clear, and the least part of it that must be seen.
_LEAST_PIXELS, _MOST_HIDDEN = 200, 0.75
#: Of doors and windows, of which a strip is not known as such.
_LEAST_OPENING_PIXELS = 800
#: The share of its surface from which a thing has one colour.
_LEAST_ONE_COLOR = 0.6
#: Openness up to which a thing is closed, and from which it is open.
_CLOSED, _OPEN = 0.02, 0.7
#: The least luma of things that are asked for their colour.
_LEAST_LUMA = 0.06
#: Shares of the picture's width: between things that are told apart, and from the lines between
#: left, ahead and right.
_LEAST_APART, _LEAST_ASIDE = 0.12, 0.06
#: Forms of a template that are tried in one house, and pairs with the same words.
_MOST_FORMS, _MOST_ALIKE = 60, 2
#: The largest number that is an answer.
_MOST_COUNTED = 6


def ask(
    world: World,
    records: Sequence[ViewRecord],
    *,
    most: int,
    seed: int,
    situations: bool = False,
) -> None:
    """Adds questions to the records of one house.

    Args:
        world: The house, in a state that all records share.
        records: Views of it; each gets ``questions`` in its row: ``template``, ``kind``,
            ``evidence`` (``picture``, or ``house`` of situations), ``text``, ``answer``, ``pair``
            (the same of two questions), ``form`` and ``spans`` (the noun phrases with the ids of
            what the image shows of them).
        most: Questions of each template that a view gets.
        seed: Draws forms and pairs.
        situations: Whether ways and failed actions are asked for, too.
    """
    rng = np.random.default_rng([seed, len(records)])
    clear = [_ClearThings(record) for record in records]
    pairs = 0
    chosen = {template: _chosen(forms_of, clear, rng) for template, (_, forms_of) in _TEMPLATES}
    # All at once: what is found out about a view serves every template.
    answers = iter(_answers(world, clear, [asked for of in chosen.values() for asked in of]))
    for template, (kind, _) in _TEMPLATES:
        rows_of = [(asked.form, next(answers)) for asked in chosen[template]]
        pairs = _write_pairs(records, (template, kind, "picture"), rows_of, most, pairs, rng)
    for kind, told in SITUATIONS.items() if situations else ():
        rows_of = [
            (form, {k: {"text": text, "word": word, "spans": []} for k, word in words.items()})
            for form, text, words in told(world, records)
        ]
        pairs = _write_pairs(records, (kind, kind, "house"), rows_of, most, pairs, rng)


_TEMPLATES = tuple(TEMPLATES.items())


def _chosen(
    forms_of: Callable[[Sequence[Thing]], Iterator[Asked]],
    clear: Sequence[_ClearThings],
    rng: np.random.Generator,
) -> list[Asked]:
    """Some of the forms of a template that the views of a house offer."""
    forms: dict[str, Asked] = {}
    for view in clear:
        for asked in forms_of(view.things):
            forms.setdefault(json.dumps(asked.form, sort_keys=True), asked)
    keys = sorted(forms)
    return [forms[keys[k]] for k in rng.permutation(len(keys))[:_MOST_FORMS]]


def _write_pairs(
    records: Sequence[ViewRecord],
    about: tuple[str, str, str],
    rows_of: Sequence[tuple[Form, dict[int, dict[str, Any]]]],
    most: int,
    pairs: int,
    rng: np.random.Generator,
) -> int:
    """Adds pairs of questions of one template to the records; the number of pairs so far."""
    template, kind, evidence = about
    left = Counter({k: most for k in range(len(records))})
    for form, rows in rows_of:
        for both in _matched(rows, left, rng):
            for k in both:
                row = rows[k]
                records[k].row["questions"].append(
                    {
                        "template": template,
                        "kind": kind,
                        "evidence": evidence,
                        "text": row["text"],
                        "answer": row["word"],
                        "pair": pairs,
                        "form": form,
                        "spans": row["spans"],
                    }
                )
                left[k] -= 1
            pairs += 1
    return pairs


#: A description by its noun and colours.
_Kind = tuple[str, ...]


def _kind(description: Form) -> _Kind:
    return (description["noun"]["object"], *description["colors"])


class _ClearThings:
    """The things of a record, and which of them are clear."""

    def __init__(self, record: ViewRecord) -> None:
        row = record.row
        share = (row["camera"]["width"] / 256.0) ** 2
        self.viewer = {name: row["camera"][name] for name in ("position", "yaw_deg", "pitch_deg")}
        self.width = row["camera"]["width"]
        self.pixels = record.pixels_of()
        self.things = [
            thing
            for thing in row["things"]
            if "noun" in thing
            and thing["pixels"]
            >= (_LEAST_OPENING_PIXELS if thing["is_opening"] else _LEAST_PIXELS) * share
            and thing["occlusion"] <= _MOST_HIDDEN
        ]
        self.placed = {
            (subject, other) for subject, name, other in row["relations"] if name in ("on", "in")
        }
        self.nouns = {thing["id"]: thing["noun"] for thing in self.things}
        self.dark = {thing["id"] for thing in self.things if thing["luma"] < _LEAST_LUMA}

    def shows(self, asked: Asked, named: dict[_Kind, frozenset[int]]) -> bool:
        """Returns whether all that a question is about is clear in the picture, or not there."""
        ids: set[int] = set()
        for what in asked.of_all:
            there = {number for number in named[_kind(what)] if number in self.pixels}
            ids |= there
        for what in asked.of_one:
            there = {number for number in named[_kind(what)] if number in self.pixels}
            if len(there) != 1:
                return False
            ids |= there
        if asked.needs_light and ids & self.dark:
            return False
        return all(number in self.nouns for number in ids) and self._is_clear(asked.clear, ids)

    def is_on(self, side: str, asked: Asked) -> bool:
        """Returns whether a thing that is asked for is on a side of the picture."""
        nouns = {what["noun"]["object"] for what in asked.of_all}
        for thing in self.things:
            x = (thing["box"][0] + thing["box"][2] / 2.0) / self.width
            if thing["noun"] in nouns and (x < 1.0 / 3.0 if side == "on_left" else x > 2.0 / 3.0):
                return True
        return False

    def _is_clear(self, what: str, ids: set[int]) -> bool:
        """Returns whether where things are cannot be mistaken."""
        things = [thing for thing in self.things if thing["id"] in ids]
        middles = [(thing["box"][0] + thing["box"][2] / 2.0) / self.width for thing in things]
        if what == "apart":
            return bool(max(middles) - min(middles) >= _LEAST_APART)
        if what == "level":
            lows = [thing["center"][1] - thing["extents"][1] / 2.0 for thing in things]
            highs = [thing["center"][1] + thing["extents"][1] / 2.0 for thing in things]
            is_placed = any((p, q) in self.placed for p in ids for q in ids)
            return bool(max(lows) < min(highs)) and not is_placed
        if what == "side":
            # The middle third is ahead.
            lines = (1.0 / 3.0, 2.0 / 3.0)
            ends = [(thing["box"][0], thing["box"][0] + thing["box"][2]) for thing in things]
            return all(abs(x - line) >= _LEAST_ASIDE for x in middles for line in lines) and all(
                left > 0 and right < self.width for left, right in ends
            )
        if what == "plain":
            return all(
                thing["pattern"] is None and thing["color_share"] >= _LEAST_ONE_COLOR
                for thing in things
            )
        if what == "settled":
            openness = [thing["openness"] for thing in things]
            return all(one is not None and not _CLOSED < one < _OPEN for one in openness)
        return True


def _answers(
    world: World, clear: Sequence[_ClearThings], asked: Sequence[Asked]
) -> list[dict[int, dict[str, Any]]]:
    """For each form its words and its answer in each view where all that it is about is clear."""
    descriptions = [what for one in asked for what in (*one.of_all, *one.of_one)]
    unique = {_kind(what): what for what in descriptions}
    phrases = [{"noun_phrase": phrase(what)} for what in unique.values()]
    found = _native.world_answers(world.native, phrases, None, None, None)
    named = {
        key: frozenset(
            thing["id"]
            for thing in (row or {"answer": {"things": []}})["answer"]["things"]
            if thing["kind"] == "object"
        )
        for key, row in zip(unique, found, strict=True)
    }
    rows: list[dict[int, dict[str, Any]]] = [{} for _ in asked]
    for k, view in enumerate(clear):
        which = [n for n, one in enumerate(asked) if view.shows(one, named)]
        # Each form has its first wording, in all views the same.
        forms: list[Form] = [asked[n].form for n in which]
        said = _native.world_answers(world.native, forms, view.viewer, None, None)
        for n, row in zip(which, said, strict=True):
            word = None if row is None else _word(row["answer"], asked[n], view)
            if row is not None and word is not None:
                spans = [
                    {
                        "start": span["start"],
                        "end": span["end"],
                        "ids": [number for number in span["ids"] if number in view.pixels],
                    }
                    for span in row["spans"]
                ]
                rows[n][k] = {"text": row["text"], "word": word, "spans": spans}
    return rows


def _word(answer: dict[str, Any] | None, asked: Asked, view: _ClearThings) -> str | None:
    """An answer as one word; ``None`` where it is undecided, several, or not to be seen."""
    if answer is None or ("reason" in answer and answer.get("truth") is None):
        return None
    if "truth" in answer:
        # The middle of what is seen of a thing may be elsewhere than that of the whole.
        if asked.side and view.is_on(asked.side, asked) is not answer["truth"]:
            return None
        return "yes" if answer["truth"] else "no"
    if "number" in answer:
        return str(answer["number"]) if answer["number"] <= _MOST_COUNTED else None
    if "words" in answer:
        return answer["words"][0] if len(answer["words"]) == 1 else None
    if "alternatives" in answer:
        numbers = answer["alternatives"]
        return asked.words[numbers[0]] if len(numbers) == 1 else None
    if "things" in answer:
        if asked.clear == "placed" and not _is_placed(answer["things"], asked, view):
            return None
        nouns = {
            view.nouns.get(thing["id"]) if thing["kind"] == "object" else None
            for thing in answer["things"]
        }
        return nouns.pop() if len(nouns) == 1 else None
    return None


def _is_placed(places: Sequence[dict[str, Any]], asked: Asked, view: _ClearThings) -> bool:
    """Returns whether the one thing that is asked for lies in or on all of some places."""
    nouns = {what["noun"]["object"] for what in asked.of_one}
    own = [number for number, noun in view.nouns.items() if noun in nouns]
    return len(own) == 1 and all((own[0], place["id"]) in view.placed for place in places)


def _matched(
    rows: dict[int, dict[str, Any]], left: Counter[int], rng: np.random.Generator
) -> list[tuple[int, int]]:
    """Pairs of views with different answers to one question, each view once."""
    by_answer: dict[str, list[int]] = {}
    for k in rng.permutation(sorted(rows)).tolist():
        if left[k] > 0:
            by_answer.setdefault(rows[k]["word"], []).append(k)
    pairs: list[tuple[int, int]] = []
    while len(pairs) < _MOST_ALIKE:
        most = sorted(by_answer, key=lambda word: (-len(by_answer[word]), word))[:2]
        if len(most) < 2 or not by_answer[most[1]]:
            break
        pairs.append((by_answer[most[0]].pop(), by_answer[most[1]].pop()))
    return pairs
