"""MCAP, the log of ROS 2: messages of a topic, encoded as JSON or CDR, by the package mcap.

Times are seconds since the file's first message: ``log_time`` and ``publish_time`` of the logger,
and ``header.stamp`` where messages have one, which is the time of the measurement.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from dwell.files import open_file, parse_json
from dwell.measured.readers.form import (
    MAX_COLUMNS,
    OpenTable,
    Row,
    TableReader,
    flattened,
    missing_package,
)

#: Bytes of a file, of a record, and of a chunk that was packed.
_MAX_BYTES = 16 * 2**30
_MAX_RECORD_BYTES = 256 * 2**20
_NS = 1e-9

Decode = Callable[[bytes], Row]
#: What decoders raise of bytes that are no message.
_DAMAGE = (
    ValueError,
    LookupError,
    EOFError,
    OverflowError,
    MemoryError,
    RecursionError,
    NotImplementedError,
    struct.error,
)


def _open(path: Path, part: str | None) -> OpenTable:
    if part is None:
        raise ValueError(f"{path}: which topic? Write one of {_parts(path)} as 'part' in the map")
    first = next(_rows(path, part), None)
    if first is None:
        raise ValueError(f"{path}: no messages of topic {part!r}; it has {_parts(path)}")
    return OpenTable(list(first[1]), _rows(path, part))


def _parts(path: Path) -> list[str]:
    """Topics with messages."""
    topics = {channel.topic for channel, _, _ in _messages(path)}
    return sorted(topics)


def _rows(path: Path, topic: str) -> Iterator[tuple[int, Row]]:
    """The messages of a topic, in the file's order."""
    decoders: dict[int, Decode] = {}
    zero_ns, number = None, 0
    for channel, schema, message in _messages(path):
        zero_ns = message.log_time if zero_ns is None else zero_ns
        if channel.topic != topic:
            continue
        number += 1
        at = f"{path} message {number} of {topic}"
        if channel.id not in decoders:
            decoders[channel.id] = _decoder(path, channel, schema)
        try:
            decoded = decoders[channel.id](message.data)
        except _DAMAGE as error:
            raise ValueError(f"{at}: cannot be decoded: {error}") from None
        row: Row = {
            "log_time": (message.log_time - zero_ns) * _NS,
            "publish_time": (message.publish_time - zero_ns) * _NS,
        }
        stamp = (decoded.get("header") or {}).get("stamp")
        if isinstance(stamp, dict):
            nanoseconds = stamp.get("nanosec", stamp.get("nsec", 0))
            since_ns = int(stamp.get("sec", 0)) * 1_000_000_000 + int(nanoseconds or 0) - zero_ns
            row["header.stamp"] = since_ns * _NS
        row.update(flattened("", decoded))
        if len(row) > MAX_COLUMNS:
            raise ValueError(f"{at}: {len(row)} numbers; at most {MAX_COLUMNS} are read")
        yield number, row


def _messages(path: Path) -> Iterator[tuple[Any, Any, Any]]:
    """Channel, schema and message of all messages, in the file's order."""
    try:
        import mcap.stream_reader as stream
        from mcap.exceptions import McapError
        from mcap.records import Channel, Chunk, Message, Schema
    except ModuleNotFoundError:
        raise missing_package(path, "mcap", "mcap") from None
    schemas: dict[int, Any] = {}
    channels: dict[int, Any] = {}
    try:
        with open_file(path, _MAX_BYTES) as file:
            reader = stream.StreamReader(
                file, emit_chunks=True, record_size_limit=_MAX_RECORD_BYTES
            )
            for outer in reader.records:
                inner = [outer]
                if isinstance(outer, Chunk):
                    inner = stream.breakup_chunk(_unpacked(path, outer))
                for record in inner:
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        channels[record.id] = record
                    elif isinstance(record, Message) and record.channel_id in channels:
                        channel = channels[record.channel_id]
                        yield channel, schemas.get(channel.schema_id), record
    except (McapError, struct.error, UnicodeDecodeError, MemoryError) as error:
        told = str(error) or type(error).__name__
        raise ValueError(f"{path}: no MCAP, or cut short: {told}") from None


def _unpacked(path: Path, chunk: Any) -> Any:  # noqa: ANN401 - of an extra without types
    """A chunk without compression: no more is unpacked than is read."""
    told = chunk.uncompressed_size
    data = b""
    if told <= _MAX_RECORD_BYTES:
        if chunk.compression == "lz4":
            import lz4.frame

            unpack = lz4.frame.LZ4FrameDecompressor()
            try:
                data = unpack.decompress(chunk.data, max_length=told + 1)
            except (RuntimeError, EOFError) as error:
                raise ValueError(f"{path}: a damaged chunk: {error}") from None
        elif chunk.compression == "zstd":
            import zstandard

            try:
                with zstandard.ZstdDecompressor().stream_reader(chunk.data) as unpacked:
                    data = unpacked.read(told + 1)
            except zstandard.ZstdError as error:
                raise ValueError(f"{path}: a damaged chunk: {error}") from None
        else:
            data = chunk.data
    if len(data) != told:
        raise ValueError(f"{path}: a chunk is not of the {told} bytes that it says")
    chunk.data, chunk.compression = data, ""
    return chunk


def _decoder(path: Path, channel: Any, schema: Any) -> Decode:  # noqa: ANN401
    """What makes a row of a message."""
    if channel.message_encoding == "json":
        return lambda data: _object(parse_json(data, "JSON", keep_constants=True))
    if channel.message_encoding == "cdr" and schema is not None and schema.encoding == "ros2msg":
        try:
            from mcap_ros2.decoder import DecoderFactory
        except ModuleNotFoundError:
            raise missing_package(path, "mcap-ros2-support", "mcap") from None
        decode = DecoderFactory().decoder_for("cdr", schema)
        if decode is not None:
            return lambda data: _object(_plain(decode(data)))
    encoding = schema.encoding if schema is not None else "no schema"
    raise ValueError(
        f"{path}: topic {channel.topic!r} is encoded as {channel.message_encoding!r} with "
        f"{encoding!r}; 'json', and 'cdr' with 'ros2msg' are read"
    )


def _object(value: object) -> Row:
    if not isinstance(value, dict):
        raise ValueError("no object with named fields")
    return value


def _plain(value: Any) -> Any:  # noqa: ANN401 - any message
    """A decoded message as objects and lists; pictures and other bytes are left out."""
    slots = getattr(value, "__slots__", None)
    if slots is not None and not isinstance(value, str | bytes | int | float):
        return {name: _plain(getattr(value, name)) for name in slots}
    if isinstance(value, bytes | bytearray | memoryview):
        return None
    if isinstance(value, list | tuple) or hasattr(value, "tolist"):
        return [_plain(item) for item in value][: MAX_COLUMNS + 1]
    return value


READER = TableReader("MCAP", (".mcap",), _open, _parts)
