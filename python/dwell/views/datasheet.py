"""The datasheet of a data set of views: counts, words, what guesses reach."""

from __future__ import annotations

import itertools
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from dwell.views.blind import blind_scores
from dwell.views.stored import records

_WORD = re.compile(r"[a-z0-9'-]+")
_LENGTHS = ("short", "normal", "long")


class _Texts:
    """Statistics of texts of one kind."""

    def __init__(self) -> None:
        self.texts = 0
        self.words: Counter[str] = Counter()
        self.pairs: Counter[tuple[str, str]] = Counter()
        self.unique: set[int] = set()
        self.longest = 0

    def add(self, text: str) -> None:
        words = _WORD.findall(text.lower())
        self.texts += 1
        self.words.update(words)
        self.pairs.update(itertools.pairwise(words))
        self.unique.add(hash(text))
        self.longest = max(self.longest, len(words))

    def row(self, name: str) -> str:
        """A row of the table of texts."""
        words, pairs = self.words.total(), self.pairs.total()
        cells = (
            name,
            f"{self.texts:,}",
            f"{words / max(self.texts, 1):.1f}",
            f"{self.longest}",
            f"{len(self.words):,}",
            f"{100.0 * len(self.unique) / max(self.texts, 1):.1f} %",
            f"{len(self.pairs) / max(pairs, 1):.4f}",
        )
        return "| " + " | ".join(cells) + " |\n"


def datasheet(folder: Path) -> str:
    """What a data set holds, as Markdown.

    Counts of views, houses and lights by part; lengths in words, vocabulary, share of different
    texts and distinct-2 (different pairs of words over all pairs; J. Li et al., NAACL 2016); the
    most frequent kinds of things; questions by template with the share that who sees no picture
    answers right (:func:`dwell.views.blind.blind_scores`); and known biases.
    """
    views: Counter[str] = Counter()
    lights: Counter[str] = Counter()
    things: Counter[str] = Counter()
    houses: dict[str, set[str]] = {}
    texts = {name: _Texts() for name in (*_LENGTHS, "references", "questions")}
    counted = 0
    for row, _ in records(folder):
        views[row["split"]] += 1
        lights[row["light"]] += 1
        houses.setdefault(row["split"], set()).add(row["house"])
        things.update(thing["category"] for thing in row["things"])
        counted += len(row["things"])
        for length in _LENGTHS:
            texts[length].add(row["captions"][length]["text"])
        for reference in row["references"]:
            texts["references"].add(reference["text"])
        for asked in row["questions"]:
            texts["questions"].add(asked["text"])
    parts = "".join(
        f"| {split} | {len(houses[split]):,} | {count:,} |\n"
        for split, count in sorted(views.items())
    )
    lit = ", ".join(f"{count:,} {light}" for light, count in sorted(lights.items()))
    common = ", ".join(f"{name} {count:,}" for name, count in things.most_common(20))
    return (
        "# Views of houses\n\n"
        "Made by dwell: pictures of generated or given houses with captions, referring "
        "expressions, relations and questions, all computed from the scene.\n\n"
        "## Views\n\n| part | houses | views |\n| --- | --- | --- |\n" + parts + "\n"
        f"Light: {lit}. {counted / max(views.total(), 1):.1f} things a view; the most frequent: "
        f"{common}.\n\n"
        "## Texts\n\n"
        "| text | number | words | longest | vocabulary | different | distinct-2 |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n"
        + "".join(own.row(name) for name, own in texts.items())
        + "\n## Questions\n\n"
        "Each is asked twice, of two views of one house in the same words, with different answers: "
        "who sees no picture answers half of them right at most. Right answers in %, learned from "
        "the other half of the houses:\n\n" + _blind_table(blind_scores(folder)) + "\n"
        "## Known biases\n\n"
        "- Houses come from one generator, or from what was given; furniture stands as its rules "
        "put it, and nobody is at home.\n"
        "- Texts are made by one grammar of English: few words, regular sentences, no mistakes.\n"
        "- Cameras are at the eyes of standing adults, level or tilted down by 20 degrees at most, "
        "of 90 degrees field of view.\n"
        "- Questions are those whose answers differ among the views of a house; what is the same "
        "in all of them is not asked.\n"
    )


def _blind_table(scores: Iterable[dict[str, float | str | None]]) -> str:
    rows = "".join("| " + " | ".join(_cell(row[key]) for key in _BLIND) + " |\n" for row in scores)
    head = "| " + " | ".join(name.replace("_", " ") for name in _BLIND) + " |\n"
    return head + "| " + " | ".join("---" for _ in _BLIND) + " |\n" + rows


_BLIND = ("template", "questions", "chance", "majority", "bag_of_words")


def _cell(value: float | str | None) -> str:
    if value is None:
        return "-"
    return f"{100.0 * value:.1f}" if isinstance(value, float) else f"{value}"
