"""Sounds played in a world."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from dwell import ConfigError, UsageError, _native
from dwell.arguments import (
    boolean,
    choice,
    finite_number,
    integer_in_range,
    path,
    point,
    quoted,
    sequence_items,
    text,
)
from dwell.language_api import LanguageApi

#: What the names of sound files end with.
_ENDINGS = (".wav", ".flac", ".ogg", ".oga")


def _played(
    sound: str | os.PathLike[str],
    at: str | int | Sequence[float],
    *,
    level_db: float | None,
    loop: bool,
) -> dict[str, Any]:
    """The native side's request for ``World.play``.

    Raises:
        ConfigError: For what is no name, place, level or flag.
    """
    name = path("sound", sound)
    kind = "file" if name.lower().endswith(_ENDINGS) else "signal"
    if kind == "signal" and os.path.splitext(name)[1]:
        raise ConfigError(
            f"sound is {quoted(name)}; allowed are files that end with {', '.join(_ENDINGS)}, and "
            "the names of signals, as dwell.sounds.signals() lists them"
        )
    place: dict[str, object]
    if isinstance(at, str):
        place = {"object": text("at", at)}
    elif isinstance(at, int | np.integer):
        place = {"agent": integer_in_range("at", at)}
    else:
        place = {"position": point("at", at)}
    return {
        "sound": {kind: name},
        "at": place,
        "level_db": None if level_db is None else finite_number("level_db", level_db),
        "loops": boolean("loop", loop),
    }


def emitter_sound(
    signal: str | None,
    sound: str | os.PathLike[str] | None,
    level_db: float | None,
    *,
    loop: bool,
    start_s: float,
) -> dict[str, Any]:
    """An edit's description of a sound: a signal or a file, its level, and when it sounds.

    Raises:
        ConfigError: For neither or both of them, and a file without a level.
    """
    told: dict[str, Any] = {}
    if (signal is None) == (sound is None):
        found = "neither" if signal is None else "both"
        raise ConfigError(f"signal, sound: found {found}; expected one of them")
    if signal is not None:
        rows = {row["name"]: row for row in _native.signals()}
        told["signal"] = choice("signal", signal, list(rows))
        level_db = rows[signal]["usual_level_db"] if level_db is None else level_db
    elif sound is not None:
        told["file"] = path("sound", sound)
        if level_db is None:
            raise ConfigError("level_db: a sound file needs one, dB SPL at 1 m")
    told["level_db"] = finite_number("level_db", level_db)
    # What every sound does anyway is not noted.
    if not boolean("loop", loop):
        told["loops"] = False
    if finite_number("start_s", start_s) != 0.0:
        told["start_s"] = start_s
    return told


class SoundApi(LanguageApi):
    """The sounds of a world."""

    def play(
        self,
        sound: str | os.PathLike[str],
        *,
        at: str | int | Sequence[float],
        level_db: float | None = None,
        loop: bool = False,
    ) -> int:
        """Plays a sound from the next step on, until it is over or stopped.

        Args:
            sound: The name of a signal, as :func:`dwell.sounds.signals` lists them, or the path of
                a WAV, FLAC or Ogg Vorbis file below the world's ``sound_root``: what ends with
                ``.wav``, ``.flac``, ``.ogg`` or ``.oga``. Channels are mixed, any rate is taken.
            at: A point in m, the name of an object (the sound moves with it), or the number of an
                agent, at whose mouth it sounds.
            level_db: Level at 1 m in the free field, dB SPL (RMS over the whole sound); without it
                the usual one of a signal. Files need one.
            loop: Whether it begins again when it is over.

        Returns:
            A handle for :meth:`stop_sound` and kin. No other sound of the world has it.

        Raises:
            ConfigError: There is no such signal, object or agent, a number is out of range, a file
                is asked for without ``sound_root`` or outside of it, or it is no sound.
            OSError: The system refuses to read the file, as where there is none.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> bell = world.play("phone", at=(2.0, 1.0, 2.0), level_db=70.0, loop=True)
            >>> world.step()
            >>> [row["on"] for row in world.sounds() if row["handle"] == bell]
            [True]
            >>> world.stop_sound(bell)
        """
        return self._native.play(_played(sound, at, level_db=level_db, loop=loop))

    def stop_sound(self, handle: int) -> None:
        """Silences a sound within 5 ms of the next step.

        What was played is then forgotten; the sound of an object can be started again.

        Raises:
            UsageError: No sound has the handle, as when it is over.
        """
        self._native.stop_sound(integer_in_range("handle", handle))

    def start_sound(self, handle: int) -> None:
        """Starts the sound of an object again that was stopped.

        Raises:
            UsageError: No sound has the handle, or its object is switched off and stays silent:
                somebody must switch it on, as with ``act("toggle", object)``.
        """
        handle = integer_in_range("handle", handle)
        switched_off = {row["name"] for row in self.objects() if row["on"] is False}
        for row in self.sounds():
            if row["handle"] == handle and row["object"] in switched_off:
                name = row["object"]
                raise UsageError(
                    f"start_sound: {name} is switched off and stays silent; switch it on, as with "
                    f"act('toggle', {name!r}) by an agent that reaches it"
                )
        self._native.start_sound(handle)

    def set_sound_level(self, handle: int, level_db: float) -> None:
        """Sets the level of a sound at 1 m, dB SPL, from the next step on."""
        self._native.set_sound_level(
            integer_in_range("handle", handle), finite_number("level_db", level_db)
        )

    def say(self, agent: int, words: str | Sequence[int], *, effort: str = "normal") -> bool:
        """Lets an agent say something from the next step on, with its voice, at its mouth.

        Its sound is speech-like and wordless: a token sounds the same whenever an agent says it.
        Who listens (an agent with open ears, as by the sensor ``heard_tokens``) understands each
        token with the probability that its level, all other sounds and the room give it.

        Args:
            agent: The number of the agent.
            words: A text of at most 8 words of the vocabulary, or their numbers, counted from 1.
            effort: ``whisper``, ``normal``, ``raised``, ``loud`` or ``shout``.

        Returns:
            Whether it does: not while it speaks already, nor in a world that is ``muted``.

        Raises:
            ConfigError: There is no such agent, word or effort, or there are too many words.

        Examples:
            >>> import dwell
            >>> world = dwell.World("builtin:apartment")
            >>> world.say(0, "the blue mug", effort="loud")
            True
            >>> world.speaks(0)
            True
        """
        said: str | list[int]
        if isinstance(words, str):
            said = text("words", words)
        else:
            rows = sequence_items("words", words, "expected text, or numbers of words")
            last = len(_native.vocabulary())
            said = [
                integer_in_range(f"words[{k}]", row, low=1, high=last) for k, row in enumerate(rows)
            ]
        effort = choice("effort", effort, _native.vocal_efforts())
        return _native.world_say(self._native, integer_in_range("agent", agent), said, effort)

    def speaks(self, agent: int) -> bool:
        """Returns whether an agent's voice sounds in the next step."""
        return _native.world_speaks(self._native, integer_in_range("agent", agent))

    def heard(self, agent: int) -> list[dict[str, Any]]:
        """What an agent understood in the last step of what others say, the loudest first.

        Each has ``speaker`` (the agent's number), ``token`` (as it was understood; ``None``: not),
        ``word``, ``direction`` (of its first sound, in the head's frame: X right, Y up, -Z ahead; 0
        where only echoes arrive), ``level_db`` (dB SPL at the head) and ``sti``, the speech
        transmission index. Of an agent without open ears it is empty.
        """
        known = _native.vocabulary()
        rows = _native.world_heard(self._native, integer_in_range("agent", agent))
        return [
            {**row, "word": None if row["token"] is None else known[row["token"] - 1]}
            for row in rows
        ]

    def sounds(self) -> list[dict[str, Any]]:
        """Every source: the sounds of objects, then those played on request.

        Each has handle, sound (``{"signal": name}`` or ``{"file": path}``), position, level_db,
        loops, on and object (whose own sound it is, or None).
        """
        sounds = self._native.sounds()
        return sounds
