"""What users say, and what it is read as: one thing."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator

import numpy as np

import dwell
from dwell import ConfigError
from dwell.language import vocabulary
from dwell.teach.person import ROBOT
from dwell.teach.users import UserParameters

#: Words at most, and words of one utterance.
_MOST_WORDS = 14
_WORDS_OF_AN_UTTERANCE = 8
#: Openings that show a thing without naming a relation; the grammar reads the noun phrase behind.
_DEICTIC = ("this is ", "that is ", "here is ")
#: Relations of two and of three things that tell where a thing is, with their words.
_RELATIONS = {
    "left_of": "to the left of",
    "right_of": "to the right of",
    "in_front_of": "in front of",
    "behind": "behind",
    "next_to": "next to",
}


@dataclasses.dataclass(frozen=True)
class Phrase:
    """What is said.

    Attributes:
        text: The words.
        reads_to: The names of the things that it is read as being about.
        relation: The predicate that a phrase about places claims.
        landmarks: The things to which it claims it.
    """

    text: str
    reads_to: tuple[str, ...]
    relation: str | None = None
    landmarks: tuple[str, ...] = ()

    @property
    def words(self) -> list[str]:
        """The words without signs, in lower case."""
        return words_of(self.text)

    @property
    def first_word(self) -> str:
        """The first of them."""
        return self.words[0]

    def utterances(self) -> list[str]:
        """The words in pieces that a voice says at once."""
        words = self.words
        starts = range(0, len(words), _WORDS_OF_AN_UTTERANCE)
        return [" ".join(words[k : k + _WORDS_OF_AN_UTTERANCE]) for k in starts]


def words_of(text: str) -> list[str]:
    """The words of a phrase, without signs and in lower case."""
    return "".join(sign for sign in text.lower() if sign not in ".,!?").split()


def read_phrase(world: dwell.World, text: str) -> tuple[str, ...]:
    """The objects that a phrase is about, by name, as the robot reads it from where it stands.

    "This is", "that is" and "here is" show something; what follows is read by the grammar as a
    noun phrase. All else the grammar reads as a whole, and the first noun phrase is what it is
    about. What it claims must hold.

    Returns:
        The names; empty where the phrase is false or undecided.

    Raises:
        ConfigError: The phrase is not understood.
    """
    lower = text.lower()
    opening = next((words for words in _DEICTIC if lower.startswith(words)), "")
    found = world.check(text[len(opening) :], viewer=ROBOT, agent=ROBOT)
    answer = found["answer"]
    if answer is not None and answer.get("truth", True) is not True:
        return ()
    if not found["phrases"]:
        return ()
    things = found["phrases"][0]["things"]
    return tuple(thing["name"] for thing in things if thing["kind"] == "object")


def deictic_phrase(
    world: dwell.World, target: str, user: UserParameters, random: np.random.Generator
) -> Phrase | None:
    """What is said while pointing and showing: the target, mostly after "this", "that" or so.

    Returns:
        ``None`` where nothing that is said of the target is read as that alone.
    """
    opening = ""
    weights = np.array([*user.openings.values()])
    drawn = str(random.choice([*user.openings], p=weights / weights.sum()))
    if random.uniform() < user.deictic:
        opening = drawn
    named = _named(world, target)
    if named is None:
        return None
    noun = named.removeprefix("the ")
    if opening in ("this is", "that is", "here is", "look at"):
        article = "an" if noun[0] in "aeiou" else "a"
        options = [f"{opening} {article} {noun}", f"{opening} {named}"]
    elif opening:
        options = [f"{opening} {noun}", named]
    else:
        options = [named]
    return _first_that_reads(world, target, (Phrase(_sentence(option), ()) for option in options))


def relation_phrase(
    world: dwell.World, target: str, things: list[str], random: np.random.Generator
) -> Phrase | None:
    """What is said about the place of the target: a relation to others that holds.

    Returns:
        ``None`` where none holds, or its words are not read as the target alone.
    """
    subject = _named(world, target)
    if subject is None:
        return None
    return _first_that_reads(world, target, _relations(world, subject, target, things, random))


def _relations(
    world: dwell.World,
    subject: str,
    target: str,
    things: list[str],
    random: np.random.Generator,
) -> Iterator[Phrase]:
    """Relations that hold, in an order that is drawn."""
    others = [name for name in things if name != target]
    names = {name: _named(world, name) for name in others}
    rows: list[tuple[str, tuple[str, ...]]] = [
        (relation, (other,)) for relation in _RELATIONS for other in others
    ]
    rows += [("between", pair) for pair in itertools.combinations(others, 2)]
    for k in random.permutation(len(rows)):
        relation, landmarks = rows[k]
        said = [names[name] for name in landmarks]
        if not all(said) or world.holds(relation, target, *landmarks, viewer=ROBOT) is not True:
            continue
        words = _RELATIONS.get(relation, relation)
        text = f"{subject} is {words} {' and '.join(filter(None, said))}"
        yield Phrase(_sentence(text), (), relation, landmarks)


def _first_that_reads(world: dwell.World, target: str, phrases: Iterator[Phrase]) -> Phrase | None:
    """The first phrase that voices can say and that is read as the target alone."""
    known = {*vocabulary()}
    for phrase in phrases:
        if len(phrase.words) > _MOST_WORDS or not known.issuperset(phrase.words):
            continue
        try:
            read = read_phrase(world, phrase.text)
        except ConfigError:
            continue
        if read == (target,):
            return dataclasses.replace(phrase, reads_to=read)
    return None


def _named(world: dwell.World, name: str) -> str | None:
    """The shortest words that fit a thing and no other that the robot sees."""
    said = world.refer(name, viewer=ROBOT)
    return None if said is None else str(said)


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}."
