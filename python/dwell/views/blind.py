"""Who sees no picture: how well questions are answered from their words alone."""

from __future__ import annotations

import re
import zlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dwell.views.stored import records

__all__ = ["blind_scores"]

_WORD = re.compile(r"[a-z0-9'-]+")
#: Words that are told apart; rarer ones share a place.
_MOST_WORDS = 4096


def blind_scores(folder: Path) -> list[dict[str, Any]]:
    """Right answers of who knows many questions, and no picture.

    It learns from the houses of even check sums and is asked of the others.

    Returns:
        By template and for ``all``: ``template``, ``questions`` that were asked, ``chance``
        (guesses between the answers of a pair), ``majority`` (the most frequent answer of the
        template) and ``bag_of_words`` (multinomial naive Bayes over the words; A. McCallum and
        K. Nigam, AAAI-98 workshop on text categorization), 0 to 1; ``None`` where nothing was
        learned.
    """
    learned: dict[str, list[tuple[str, str]]] = {}
    asked: dict[str, list[tuple[str, str]]] = {}
    for record, _ in records(folder):
        to = asked if zlib.crc32(record["house"].encode()) % 2 else learned
        for one in record["questions"]:
            to.setdefault(one["template"], []).append((one["text"], one["answer"]))
    rows = []
    right: Counter[str] = Counter()
    for template in sorted(asked):
        questions = asked[template]
        known = learned.get(template, [])
        row: dict[str, Any] = {"template": template, "questions": len(questions), "chance": 0.5}
        row["majority"] = row["bag_of_words"] = None
        if known:
            majority = Counter(answer for _, answer in known).most_common(1)[0][0]
            row["majority"] = _share(answer == majority for _, answer in questions)
            guessed = NaiveBayes(known).answers([text for text, _ in questions])
            hits = [word == own for word, (_, own) in zip(guessed, questions, strict=True)]
            row["bag_of_words"] = _share(hits)
            right.update({name: row[name] * len(questions) for name in _SCORES})
            right["questions"] += len(questions)
        rows.append(row)
    whole: dict[str, Any] = {"template": "all", "questions": int(right["questions"]), "chance": 0.5}
    for name in _SCORES:
        whole[name] = right[name] / right["questions"] if right["questions"] else None
    return [*rows, whole]


_SCORES = ("majority", "bag_of_words")


def _share(hits: Any) -> float:  # noqa: ANN401 - flags in a row
    return float(np.mean(list(hits)))


class NaiveBayes:
    """Answers by the words of questions, each counted."""

    def __init__(self, known: Sequence[tuple[str, str]]) -> None:
        """Learns questions with their answers; at least one."""
        words = Counter(word for text, _ in known for word in _words(text))
        names = [word for word, _ in words.most_common(_MOST_WORDS - 1)]
        self._places = {word: k for k, word in enumerate(names)}
        self.answers_known = sorted({answer for _, answer in known})
        of = {answer: k for k, answer in enumerate(self.answers_known)}
        counts = np.ones((len(of), len(names) + 1))
        priors = np.zeros(len(of))
        for text, answer in known:
            priors[of[answer]] += 1
            for word in _words(text):
                counts[of[answer], self._place(word)] += 1
        self._log_word = np.log(counts / counts.sum(axis=1, keepdims=True))
        self._log_prior = np.log(priors / priors.sum())

    def _place(self, word: str) -> int:
        return self._places.get(word, len(self._places))

    def answers(self, texts: Sequence[str]) -> list[str]:
        """The likeliest answer to each question."""
        found = []
        for text in texts:
            places: NDArray[np.int64] = np.array([self._place(w) for w in _words(text)], np.int64)
            scores = self._log_prior + self._log_word[:, places].sum(axis=1)
            found.append(self.answers_known[int(np.argmax(scores))])
        return found


def _words(text: str) -> list[str]:
    return _WORD.findall(text.lower())
