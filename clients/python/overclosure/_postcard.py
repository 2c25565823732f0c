"""Postcard, as far as the protocol needs it: positional structs of scalars, texts, lists, options and enums.

A message is a dataclass whose fields carry their wire type as ``Annotated`` metadata (see ``_messages``). Arrays of
numbers become numpy arrays without a copy per element. Reading refuses every input that is not exactly one message.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cache
from typing import Annotated, Any, Generic, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

from ._errors import TransportError

T = TypeVar("T")


class DecodeError(TransportError):
    """The bytes are not the message that was expected."""


class Reader:
    """A position in a buffer."""

    def __init__(self, data: bytes) -> None:
        """Begin at the front."""
        self.data = data
        self.at = 0

    def take(self, count: int) -> int:
        """Move on by so many bytes; the position before."""
        at = self.at
        if count > len(self.data) - at:
            raise DecodeError(f"{count} bytes are announced at {at}, {len(self.data) - at} are there")
        self.at = at + count
        return at

    def varint(self, bits: int) -> int:
        """Read a variable-length unsigned integer of at most so many bits."""
        result = shift = 0
        while True:
            byte = self.data[self.take(1)]
            result |= (byte & 0x7F) << shift
            if byte < 0x80:
                break
            shift += 7
            if shift >= bits:
                raise DecodeError(f"an integer at {self.at} does not end")
        if result >> bits:
            raise DecodeError(f"an integer at {self.at} exceeds {bits} bits")
        return result

    def count(self, smallest: int) -> int:
        """Read the length of a list whose elements take at least so many bytes, before anything is allocated."""
        count = self.varint(64)
        if count * smallest > len(self.data) - self.at:
            raise DecodeError(f"a list of {count} is announced at {self.at}, it cannot fit")
        return count


def write_varint(out: bytearray, value: int, bits: int) -> None:
    """Write a variable-length unsigned integer."""
    if value < 0 or value >> bits:
        raise ValueError(f"{value} does not fit into {bits} bits without a sign")
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)


class Wire(Generic[T]):
    """How one type travels."""

    def read(self, reader: Reader) -> T:
        """Read a value."""
        raise NotImplementedError

    def write(self, out: bytearray, value: T) -> None:
        """Append a value."""
        raise NotImplementedError


class Unsigned(Wire[int]):
    """``u32`` or ``u64``."""

    def __init__(self, bits: int) -> None:
        """Of so many bits."""
        self.bits = bits

    def read(self, reader: Reader) -> int:
        """Read a value."""
        return reader.varint(self.bits)

    def write(self, out: bytearray, value: int) -> None:
        """Append a value."""
        write_varint(out, value, self.bits)


class Float(Wire[float]):
    """``f64``."""

    def read(self, reader: Reader) -> float:
        """Read a value."""
        value: float = struct.unpack_from("<d", reader.data, reader.take(8))[0]
        return value

    def write(self, out: bytearray, value: float) -> None:
        """Append a value."""
        out += struct.pack("<d", value)


class Bool(Wire[bool]):
    """``bool``."""

    def read(self, reader: Reader) -> bool:
        """Read a value."""
        byte = reader.data[reader.take(1)]
        if byte > 1:
            raise DecodeError(f"{byte} is neither true nor false")
        return byte == 1

    def write(self, out: bytearray, value: bool) -> None:
        """Append a value."""
        out.append(1 if value else 0)


class Blob(Wire[bytes]):
    """``Vec<u8>``."""

    def read(self, reader: Reader) -> bytes:
        """Read a value."""
        count = reader.count(1)
        at = reader.take(count)
        return reader.data[at : at + count]

    def write(self, out: bytearray, value: bytes) -> None:
        """Append a value."""
        write_varint(out, len(value), 64)
        out += value


class Text(Wire[str]):
    """``String``."""

    def read(self, reader: Reader) -> str:
        """Read a value."""
        try:
            return BLOB.read(reader).decode("utf-8")
        except UnicodeDecodeError as error:
            raise DecodeError(f"a text is not UTF-8: {error}") from None

    def write(self, out: bytearray, value: str) -> None:
        """Append a value."""
        BLOB.write(out, value.encode("utf-8"))


class Choice(Wire[str]):
    """An enum, as its JSON text."""

    def __init__(self, *names: str) -> None:
        """Variants in wire order."""
        self.names = names

    def read(self, reader: Reader) -> str:
        """Read a value."""
        tag = reader.varint(32)
        if tag >= len(self.names):
            raise DecodeError(f"{tag} is none of the {len(self.names)} known variants")
        return self.names[tag]

    def write(self, out: bytearray, value: str) -> None:
        """Append a value."""
        if value not in self.names:
            raise ValueError(f"{value!r} is none of {', '.join(self.names)}")
        write_varint(out, self.names.index(value), 32)


class Optional(Wire[Any]):
    """``Option<T>``."""

    def __init__(self, inner: Wire[Any]) -> None:
        """Of something."""
        self.inner = inner

    def read(self, reader: Reader) -> Any:  # noqa: ANN401
        """Read a value."""
        return self.inner.read(reader) if BOOL.read(reader) else None

    def write(self, out: bytearray, value: Any) -> None:  # noqa: ANN401
        """Append a value."""
        BOOL.write(out, value is not None)
        if value is not None:
            self.inner.write(out, value)


class Many(Wire[Any]):
    """``Vec<T>`` of anything but numbers."""

    def __init__(self, inner: Wire[Any]) -> None:
        """Of something."""
        self.inner = inner

    def read(self, reader: Reader) -> list[Any]:
        """Read a value."""
        return [self.inner.read(reader) for _ in range(reader.count(1))]

    def write(self, out: bytearray, value: Sequence[Any]) -> None:
        """Append a value."""
        write_varint(out, len(value), 64)
        for item in value:
            self.inner.write(out, item)


class Floats(Wire["np.ndarray[Any, np.dtype[np.float64]]"]):
    """``Vec<f64>``: a view of the buffer, read-only."""

    def read(self, reader: Reader) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Read a value."""
        count = reader.count(8)
        return np.frombuffer(reader.data, "<f8", count, reader.take(8 * count))

    def write(self, out: bytearray, value: Any) -> None:  # noqa: ANN401
        """Append a value: anything that numpy makes a flat array of."""
        array = np.ascontiguousarray(value, "<f8")
        if array.ndim != 1:
            raise ValueError(f"a flat array is needed, this one has {array.ndim} dimensions")
        write_varint(out, array.size, 64)
        out += array.tobytes()


class Labels(Wire["np.ndarray[Any, np.dtype[np.uint32]]"]):
    """``Vec<u32>``: variable-length integers, read all at once."""

    def read(self, reader: Reader) -> np.ndarray[Any, np.dtype[np.uint32]]:
        """Read a value."""
        count = reader.count(1)
        # A label takes five bytes at most; the last byte of each has no high bit.
        window = np.frombuffer(reader.data, np.uint8, min(5 * count, len(reader.data) - reader.at), reader.at)
        ends = np.flatnonzero(window < 0x80)[:count]
        if ends.size < count:
            raise DecodeError(f"a list of {count} integers at {reader.at} does not end")
        starts = np.concatenate(([0], ends[:-1] + 1)) if count else ends
        lengths = ends - starts + 1
        if count and lengths.max() > 5:
            raise DecodeError(f"an integer at {reader.at} does not end")
        result = np.zeros(count, np.uint64)
        for k in range(int(lengths.max()) if count else 0):
            longer = lengths > k
            result[longer] |= (window[starts[longer] + k].astype(np.uint64) & np.uint64(0x7F)) << np.uint64(7 * k)
        if count and int(result.max()) >> 32:
            raise DecodeError(f"an integer at {reader.at} exceeds 32 bits")
        reader.take(int(ends[-1]) + 1 if count else 0)
        return result.astype(np.uint32)

    def write(self, out: bytearray, value: Any) -> None:  # noqa: ANN401
        """Append a value: any sequence of whole numbers."""
        write_varint(out, len(value), 64)
        for label in value:
            write_varint(out, int(label), 32)


class Struct(Wire[T]):
    """A dataclass: its fields in order."""

    def __init__(self, kind: type[T]) -> None:
        """Of this class."""
        self.kind = kind

    @property
    def layout(self) -> tuple[tuple[str, Wire[Any]], ...]:
        """Names and wire types of the fields."""
        kind: Any = self.kind
        return layout(kind)

    def read(self, reader: Reader) -> T:
        """Read a value."""
        return self.kind(**{name: wire.read(reader) for name, wire in self.layout})

    def write(self, out: bytearray, value: T) -> None:
        """Append a value."""
        for name, wire in self.layout:
            wire.write(out, getattr(value, name))


BOOL = Bool()
BLOB = Blob()


@cache
def layout(kind: type[Any]) -> tuple[tuple[str, Wire[Any]], ...]:
    """Names and wire types of a message, in wire order."""
    hints = get_type_hints(kind, include_extras=True)
    return tuple((field.name, _wire(hints[field.name])) for field in fields(kind))


def _wire(hint: Any) -> Wire[Any]:  # noqa: ANN401
    if get_origin(hint) is Annotated:
        wire = get_args(hint)[1]
        assert isinstance(wire, Wire)
        return wire
    return Struct(hint)


@dataclass(frozen=True)
class Schema:
    """Name and version of a message."""

    name: str
    version: int = 1

    def __str__(self) -> str:
        """As the encoding states it."""
        return f"{self.name}/{self.version}"


def encode(message: Any) -> bytes:  # noqa: ANN401
    """Write a message."""
    out = bytearray()
    Struct(type(message)).write(out, message)
    return bytes(out)


def decode(kind: type[T], data: bytes) -> T:
    """Read exactly one message."""
    reader = Reader(data)
    message = Struct(kind).read(reader)
    if reader.at != len(data):
        raise DecodeError(f"{len(data) - reader.at} bytes too many after a {kind.__name__}")
    return message
