"""Sentences about a world: read, checked against it, answered."""

from __future__ import annotations

from typing import Any, Literal, overload

from dwell import ConfigError, _native
from dwell.arguments import choice, integer_in_range, quoted
from dwell.arguments import text as checked_text
from dwell.grounded_text import Length, Style, Text, texts
from dwell.relation_api import RelationApi, Thing, Viewer, thing_argument, viewer_argument

#: The arguments of ``describe`` that not every level reads, and the levels that do.
_READ_BY = {
    "viewer": ("view", "route", "changes"),
    "agent": ("view", "route", "changes"),
    "to": ("route",),
    "since": ("changes",),
}
#: What may become of a claim of a text.
CLAIM_STATUSES = ("true", "false", "undecided", "not_understood", "no_claim")
#: The levels that read none of them.
_WITHOUT = ("object", "room", "house", "graph", "instructions")


def _refuse_unread(level: str, given: dict[str, object]) -> None:
    """Refuses arguments of ``describe`` that its level does not read.

    Raises:
        ConfigError: It names the first one, and the levels that read it.
    """
    if level not in _WITHOUT and not any(level in levels for levels in _READ_BY.values()):
        # The engine says which levels there are.
        return
    for name, levels in _READ_BY.items():
        if given[name] is not None and level not in levels:
            raise ConfigError(
                f"{name} is given, and level {level!r} does not read it; levels that do are "
                f"{', '.join(levels)}"
            )


class LanguageApi(RelationApi):
    """Texts about a world, and claims and questions in English, checked by its predicates."""

    @overload
    def describe(
        self,
        level: Literal["object", "room", "house", "view", "route", "changes"] = ...,
        *,
        length: Length = ...,
        style: Style = ...,
        seed: int | None = ...,
        viewer: Viewer | None = ...,
        agent: int | None = ...,
        to: Thing | None = ...,
        since: bytes | None = ...,
    ) -> list[Text]: ...
    @overload
    def describe(
        self,
        level: str,
        *,
        length: Length = ...,
        style: Style = ...,
        seed: int | None = ...,
        viewer: Viewer | None = ...,
        agent: int | None = ...,
        to: Thing | None = ...,
        since: bytes | None = ...,
    ) -> list[str]: ...
    def describe(
        self,
        level: str = "house",
        *,
        length: Length = "normal",
        style: Style = "rich",
        seed: int | None = None,
        viewer: Viewer | None = None,
        agent: int | None = None,
        to: Thing | None = None,
        since: bytes | None = None,
    ) -> list[Text] | list[str]:
        """As :meth:`House.describe`, of the house as it is now.

        Args:
            level: Also ``view``: what is seen, as a person would tell it: floor and walls, the
                things by side, the largest first, how far they are and where to each other, what
                lies on them, and what is seen of other rooms. One text. What covers less than 100
                of 256 x 256 pixels of a picture of 90 degrees, or is hidden to more than three
                quarters, is left out. "The lamp" is the one in sight. ``route``: the way to ``to``
                from where the viewer stands and looks, as requests: turns, doors, what one goes
                past; one text, none where no way leads there. A body that opens doors walks it.
                ``changes``: what is otherwise than in the snapshot ``since``, as claims of the
                present; one text, empty where nothing has changed that can be said.
            length: Of the levels object, room, house, view and route.
            style: Of the levels object, room, house and view.
            seed: Draws the wordings.
            viewer: Of the levels view, route and changes. Whose view: an agent's number or a
                camera, as for :meth:`holds`. Without it the eyes of ``agent``.
            agent: Of the same levels. Who "you" is.
            to: The goal of a route: a thing by name or id, or a room as ``room:NAME``.
            since: Of the level changes. What :meth:`snapshot` gave before, of this world.

        Raises:
            ConfigError: A level without what it needs, or with what it does not read; a goal that
                there is not.
            DwellError: ``since`` is no snapshot of this world.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> room = world.house.rooms()[0]
            >>> viewer = {"position": room["eye"], "yaw_deg": room["yaw_deg"]}
            >>> world.describe("view", viewer=viewer)[0].split(". ")[0]
            'The bedroom has a beige parquet floor and gray-beige walls'
            >>> route = world.describe("route", viewer=viewer, to="room:bathroom", length="short")
            >>> route[0].split(". ")[0]
            'Turn left, then go through the door from the first bedroom to the hallway'
            >>> before = world.snapshot()
            >>> world.set_joints({0: (1.2, 0.0)})
            >>> world.describe("changes", since=before)[0]
            'The door in the hallway is open now.'
        """
        if since is not None and not isinstance(since, bytes):
            raise ConfigError(f"since is {quoted(since)}; expected the bytes of snapshot()")
        level = checked_text("level", level)
        _refuse_unread(level, {"viewer": viewer, "agent": agent, "to": to, "since": since})
        seed = None if seed is None else integer_in_range("seed", seed)
        listener = None if agent is None else integer_in_range("agent", agent, high=2**31 - 1)
        looks = viewer_argument(viewer)
        rows = self._native.describe(
            level,
            (checked_text("length", length), checked_text("style", style), seed),
            looks,
            listener,
            None if to is None else thing_argument("to", to),
            since,
        )
        return texts(level, rows)

    def refer(
        self,
        thing: Thing,
        *,
        viewer: Viewer | None = None,
        strategy: Literal["shortest", "incremental", "relational"] = "shortest",
        seed: int | None = None,
    ) -> Text | None:
        """The words by which a listener finds a thing and nothing else.

        Args:
            thing: Its name, or its id.
            viewer: From where the listener looks, as for :meth:`holds`: where it sees the thing,
                the words need to fit nothing else in sight; places from the left and to the sides
                of other things count. Without it, or out of sight, nothing else in the house.
            strategy: ``shortest``: properties before relations. ``incremental``: colour, material,
                size and room as far as each rules something out (Dale and Reiter 1995).
                ``relational``: by another thing, wherever that tells it apart.
            seed: Draws the wording.

        Returns:
            A noun phrase; ``None`` where no words tell the thing apart. Colours on which people
            divide tell nothing apart.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> for strategy in ("shortest", "incremental", "relational"):
            ...     print(world.refer("vase_1", strategy=strategy))
            the vase in the children's room
            the blue-gray vase
            the blue-gray vase in a bookcase
        """
        seed = None if seed is None else integer_in_range("seed", seed)
        rows = _native.world_refer(
            self._native,
            thing_argument("thing", thing),
            viewer_argument(viewer),
            checked_text("strategy", strategy),
            seed,
        )
        return Text(**rows[0]) if rows else None

    def check(
        self, sentence: str, *, viewer: Viewer | None = None, agent: int | None = None
    ) -> dict[str, Any]:
        """Reads one sentence and checks it against the world as it is now.

        Args:
            sentence: A claim (``"The cup is on the table."``), a question or a request, at most
                80 words. :func:`dwell.language.read` says what is understood.
            viewer: From where left, right, in front and behind are meant: an agent's number or a
                camera, as for :meth:`holds`. Without it the eyes of ``agent``.
            agent: Who "you" is.

        Returns:
            ``form``, the preferred reading, and ``other_forms``; ``said``, the form in the engine's
            own words, and ``phrases`` of that text: ``start``, ``end`` and the ``things`` that
            fit, each with ``kind``, ``id`` (of instance images; a number for rooms and storeys)
            and ``name``; ``ambiguities``, the definite noun phrases that several things fit: the
            ``things`` and the ``question`` that tells them apart. ``answer`` of a claim or a yes-no
            question: ``truth`` (``None`` where it is undecided, with a ``reason``) and the
            ``witnesses`` that decided; of other questions ``things``, ``number``, ``words`` or, of
            "is it A or B?", ``alternatives``: the numbers of those that are true; or the
            ``reason`` why there is none. ``None`` for a request; of several forms in one sentence
            the answer to the last one that has one.

        Raises:
            ConfigError: The sentence is not understood; the message says where, and which words
                could have been meant.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> world.check("There is a sofa in the living room.")["answer"]["truth"]
            True
            >>> world.check("How many beds are there?")["answer"]["number"] > 0
            True
            >>> world.check("Find the sofaa.")  # doctest: +ELLIPSIS
            Traceback (most recent call last):
            ...
            dwell.ConfigError: unknown word "sofaa" (known are sofa, sofas...
        """
        listener = None if agent is None else integer_in_range("agent", agent, high=2**31 - 1)
        sentence = checked_text("sentence", sentence)
        found: dict[str, Any] = _native.world_check_text(
            self._native, sentence, viewer_argument(viewer), listener
        )
        return found

    def check_text(
        self,
        text: str,
        *,
        viewer: Viewer | None = None,
        agent: int | None = None,
        scope: Literal["house", "view"] = "house",
    ) -> dict[str, Any]:
        """Judges each claim of a text that somebody else wrote: a caption, a description.

        A sentence that is not understood as a whole is cut at commas and conjunctions, and what is
        understood of it is judged. "It" stands for the subject of the claim before.

        Args:
            text: At most 65,536 bytes; a sentence has at most 80 words.
            viewer: As of :meth:`check`.
            agent: Who "you" is.
            scope: ``view``: the text tells what ``viewer`` sees: things out of sight are none of
                it, so that "there is a lamp" is false where no lamp is in sight.

        Returns:
            ``claims``, in the order of the text: ``start``, ``end`` and ``text`` (the words that
            say it; the sentence where these cannot be told apart), ``status`` (``true``, ``false``,
            ``undecided``, ``not_understood``, or ``no_claim`` of requests and questions),
            ``reason`` of the last three, ``said``, ``form`` and ``phrases`` as :meth:`check` has
            them, ``witnesses`` (``predicate``, ``things``, ``truth``) that decided, and
            ``holds_elsewhere``: it is true of the house, but not of what is seen. ``counts`` of
            each status; ``false_share``: of the claims that are true or false those that are
            false, 0 to 1, ``None`` where there are none.

        Raises:
            ConfigError: The text is too long; ``scope`` is ``view`` without a viewer.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment", agents=0)
            >>> found = world.check_text("There is a sofa in the living room, and the sofaa barks.")
            >>> [(claim["text"], claim["status"]) for claim in found["claims"]]
            [('There is a sofa in the living room', 'true'), ('the sofaa barks.', 'not_understood')]
        """
        if choice("scope", scope, ("house", "view")) == "view" and viewer is None and agent is None:
            raise ConfigError("scope is 'view' without a viewer; expected viewer or agent")
        listener = None if agent is None else integer_in_range("agent", agent, high=2**31 - 1)
        claims: list[dict[str, Any]] = _native.world_judge_text(
            self._native,
            checked_text("text", text),
            viewer_argument(viewer),
            listener,
            scope == "view",
        )
        counts = {status: 0 for status in CLAIM_STATUSES}
        for claim in claims:
            counts[claim["status"]] += 1
        judged = counts["true"] + counts["false"]
        return {
            "claims": claims,
            "counts": counts,
            "false_share": counts["false"] / judged if judged else None,
        }
