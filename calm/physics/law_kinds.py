"""Kinds of the values of compiled laws, and their layout in memory.

Every number takes eight bytes. A sequence is represented by the address of its first number and by
its shape. A named tuple is a row of numbers.
"""

import ctypes
import struct
from collections.abc import Iterator
from functools import cache
from typing import Any, NamedTuple, get_args, get_type_hints

import numpy as np

REAL, WHOLE, TRUTH = "double", "i64", "i1"
"""Kinds of single numbers, by their names in LLVM."""
BY_NAME: dict[Any, str] = {float: REAL, int: WHOLE, bool: TRUTH}


class Row(NamedTuple):
    """Kind of a tuple.

    Attributes
    ----------
    named : class of a named tuple; None for any other tuple
    members : kinds of the members
    """

    named: Any
    members: tuple[Any, ...]


class Array(NamedTuple):
    """Kind of a sequence, with the kind of its elements and its number of dimensions."""

    item: Any
    dimensions: int


NOTHING = Row(None, ())


@cache
def size_of(kind: Any) -> int:
    """Return the number of eight-byte words that a value of a given kind takes."""
    if isinstance(kind, Row):
        return sum(map(size_of, kind.members))
    return 1 + kind.dimensions if isinstance(kind, Array) else 1


@cache
def places_of(row: Row) -> tuple[int, ...]:
    """Return the offset of each member from the start of its row, in words of eight bytes."""
    return tuple(sum(map(size_of, row.members[:i])) for i in range(len(row.members)))


@cache
def wanted_by(named: Any) -> tuple[Any, ...]:
    """Return the kind of number that a named tuple declares for each member.

    The kind is None for a member that is not a number.
    """
    return tuple(BY_NAME.get(hint) for hint in get_type_hints(named).values())


def common(one: Any, other: Any) -> Any:
    """Return the kind of a variable to which values of two kinds are assigned."""
    if one == other:
        return one
    if isinstance(one, Row) and isinstance(other, Row) and len(one.members) == len(other.members):
        pairs = zip(one.members, other.members, strict=True)
        return Row(one.named or other.named, tuple(common(a, b) for a, b in pairs))
    numbers = (TRUTH, WHOLE, REAL)
    if one in numbers and other in numbers:
        return max(one, other, key=numbers.index)
    raise TypeError(f"a value cannot be both {one} and {other}")


FROM_MATH = ("log", "pow", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "floor")
"""Functions that CPython and compiled laws take from the C library."""


@cache
def record_type(named: type) -> np.dtype[Any]:
    """Return the NumPy record type for a class of named tuples of numbers."""
    fields = get_type_hints(named).items()
    record = np.dtype([(name, np.int64 if kind is int else np.float64) for name, kind in fields])
    _records[record] = named
    return record


_records: dict[np.dtype[Any], type] = {}


def kind_of(value: Any, hint: Any = None) -> Any:
    """Return the kind of a Python value, as `calm.physics.law_compiler` uses it."""
    if hint in BY_NAME:
        return BY_NAME[hint]
    if value is None:
        return NOTHING
    if isinstance(value, tuple):
        named = type(value) if hasattr(value, "_fields") else None
        hints = get_type_hints(named).values() if named else [None] * len(value)
        return Row(named, tuple(kind_of(a, b) for a, b in zip(value, hints, strict=True)))
    if isinstance(value, np.ndarray):
        fields = value.dtype.fields
        if fields is None:
            return Array(_number_kind(value.dtype), value.ndim)
        kinds = tuple(_number_kind(own[0]) for own in fields.values())
        return Array(Row(_records[value.dtype], kinds), value.ndim)
    return BY_NAME[type(value)]


def _number_kind(of: Any) -> str:
    return {np.dtype(np.float64): REAL, np.dtype(np.int64): WHOLE}[of]


def kind_asked(hint: Any) -> Any:
    """Return the kind of result that a type hint declares."""
    if hint in BY_NAME:
        return BY_NAME[hint]
    if hint in (None, type(None)):
        return NOTHING
    named = hint if hasattr(hint, "_fields") else None
    hints = get_type_hints(named).values() if named else get_args(hint)
    return Row(named, tuple(map(kind_asked, hints)))


class Layout:
    """Conversion between Python values of one kind and their bytes in memory."""

    def __init__(self, kind: Any) -> None:
        self.kind, self.size = kind, 8 * size_of(kind)
        codes, words = _layout_of(kind, "given")
        self._struct = struct.Struct(codes)
        self._numbers = eval(f"lambda given: ({''.join(word + ', ' for word in words)})", _NAMES)

    def written(self, value: Any) -> bytes:
        """Return the bytes of a value; arrays are written as their addresses."""
        return self._struct.pack(*self._numbers(value))

    def read(self, data: bytes) -> Any:
        """Return the value that the bytes represent."""
        return _built(self.kind, iter(self._struct.unpack(data)))


def _layout_of(kind: Any, given: str) -> tuple[str, list[str]]:
    """Return the `struct` format of a value, and a Python expression for each of its numbers.

    `given` is the expression for the whole value.
    """
    if isinstance(kind, Row):
        parts = [_layout_of(each, f"{given}[{i}]") for i, each in enumerate(kind.members)]
        return "".join(codes for codes, _ in parts), [word for _, words in parts for word in words]
    if isinstance(kind, Array):
        shape = [f"{given}.shape[{k}]" for k in range(kind.dimensions)]
        return "q" * (1 + len(shape)), [f"address_of({given})", *shape]
    return "d" if kind == REAL else "q", [given]


def _address_of_array(array: Any) -> int:
    if not array.flags.c_contiguous:
        raise ValueError("an array for a compiled law must be contiguous")
    return _pointer_at(id(array) + _DATA).value or 0


_pointer_at = ctypes.c_void_p.from_address
_DATA = object.__basicsize__
"""Offset [bytes] of the data address in a NumPy array object.

In NumPy's C interface, this address is the first field of an array. Reading the field is thirty
times as fast as the attribute `ctypes.data`.
"""
_NAMES = {"address_of": _address_of_array}


def _built(kind: Any, numbers: Iterator[Any]) -> Any:
    """Return a value of a kind from its numbers."""
    if isinstance(kind, Row):
        members = [_built(each, numbers) for each in kind.members]
        return tuple(members) if kind.named is None else kind.named(*members)
    return bool(next(numbers)) if kind == TRUTH else next(numbers)
