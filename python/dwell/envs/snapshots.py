"""Snapshots of environments, alone or many at once: all that an episode needs to go on."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from typing import Any

import numpy as np

from dwell import ConfigError
from dwell.arguments import boolean, mapping, quoted, text, to_json

#: What the bytes of one of several environments begin with, and the number of their form.
_HEAD = b"dwvec2"


@dataclasses.dataclass(frozen=True)
class EnvSnapshot:
    """An environment as it was at a moment."""

    episode_id: str
    #: Whether the episode has ended.
    done: bool
    #: Whence the houses and seeds of the following episodes come.
    stream: np.random.Generator
    #: What its parts in Python remember.
    parts: bytes
    #: World and episode, as the engine wrote them.
    world: bytes

    def to_bytes(self) -> bytes:
        """All of it as bytes, behind a check sum."""
        told = {
            "episode_id": self.episode_id,
            "done": self.done,
            "stream": self.stream.bit_generator.state,
        }
        return with_checksum(b"\0".join((to_json(told).encode(), self.parts, self.world)))

    def to_vector_bytes(self) -> bytes:
        """The bytes of one of several environments, which no environment alone takes."""
        return b"\0".join((_HEAD, self.to_bytes()))

    @classmethod
    def of_bytes(cls, name: str, snapshot: object) -> EnvSnapshot:
        """The snapshot that :meth:`to_bytes` wrote; ``name``: what errors begin with.

        Raises:
            ConfigError: It is something else.
        """
        if not isinstance(snapshot, bytes):
            raise ConfigError(f"{name} is {quoted(snapshot, 60)}; expected bytes of snapshot()")
        return cls._of(f"{name} refused", snapshot)

    @classmethod
    def of_vector_bytes(cls, name: str, snapshot: object) -> EnvSnapshot:
        """The snapshot that :meth:`to_vector_bytes` wrote; ``name``: its name for errors.

        Raises:
            ConfigError: It is something else.
        """
        if not isinstance(snapshot, bytes):
            raise ConfigError(f"{name} is {quoted(snapshot, 60)}; expected bytes of snapshot()")
        head, _, rest = snapshot.partition(b"\0")
        at = f"{name}: snapshot refused"
        if not snapshot:
            raise ConfigError(f"{at}: it is empty")
        if head != _HEAD:
            raise ConfigError(f"{at}: it is none of a vector environment of this version")
        return cls._of(at, rest)

    @classmethod
    def _of(cls, at: str, sealed: bytes) -> EnvSnapshot:
        about, _, rest = check_and_strip(at, sealed).partition(b"\0")
        parts, _, world = rest.partition(b"\0")
        try:
            told = mapping(at, json.loads(about))
            return cls(
                episode_id=text(f"{at}: episode_id", told["episode_id"]),
                done=boolean(f"{at}: done", told["done"]),
                stream=_stream(told["stream"]),
                parts=parts,
                world=world,
            )
        except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
            if isinstance(error, ConfigError):
                raise
            raise ConfigError(f"{at}: it is none of this version: {quoted(error)}") from None


def with_checksum(content: bytes) -> bytes:
    """Content with its check sum, which detects damage, but no forgery."""
    return b"\0".join((_sum(content), content))


def check_and_strip(at: str, sealed_content: bytes) -> bytes:
    """The content of :func:`with_checksum`.

    Raises:
        ConfigError: It is something else, or was damaged.
    """
    if not sealed_content:
        raise ConfigError(f"{at}: it is empty")
    found, _, content = sealed_content.partition(b"\0")
    if found != _sum(content):
        raise ConfigError(
            f"{at}: its check sum does not fit its {len(sealed_content)} bytes: it was cut short "
            "or damaged, or is none of this version"
        )
    return content


def _sum(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=8).hexdigest().encode()


def _stream(state: Any) -> np.random.Generator:  # noqa: ANN401 - numpy says what it takes
    stream = np.random.default_rng(0)
    stream.bit_generator.state = state
    return stream
