"""Values of a law in LLVM's language, and instructions to read, write and convert values."""

import builtins
import struct
from typing import Any, NamedTuple

from calm.physics.law_kinds import (
    BY_NAME,
    NOTHING,
    REAL,
    TRUTH,
    WHOLE,
    Array,
    Row,
    places_of,
    size_of,
)


class Number(NamedTuple):
    """A number in LLVM's notation. For a constant, `known` is the value."""

    kind: str
    text: str
    known: Any = None


class Held(NamedTuple):
    """A row or a sequence in memory, given by its address.

    If `passing` is true, the memory may be overwritten later.
    """

    kind: Any
    address: str
    passing: bool = False


class Made(NamedTuple):
    """A tuple that is not in memory, given by the values of its members."""

    kind: Row
    members: tuple[Any, ...]


class ArrayView(NamedTuple):
    """A sequence, given by the address of its data and by its shape."""

    kind: Array
    data: str
    shape: tuple[str, ...]


class Global(NamedTuple):
    """A function, class or module to which the source of a law refers.

    If a law receives a function as an argument, the law is translated separately for each function.
    """

    value: Any

    @property
    def kind(self) -> "Global":
        """The object itself, which serves as the kind of an argument."""
        return self


def number_of(value: Any) -> Number:
    """Convert a Python number to a constant in LLVM's notation."""
    if isinstance(value, bool):
        return Number(TRUTH, str(value).lower(), value)
    if isinstance(value, int):
        return Number(WHOLE, str(value), value)
    return Number(REAL, f"0x{struct.unpack('>Q', struct.pack('>d', value))[0]:016X}", value)


def row_of(members: Any, named: Any = None) -> Made:
    """Combine values into a tuple of the class `named`, or into a plain tuple."""
    members = tuple(members)
    return Made(Row(named, tuple(each.kind for each in members)), members)


MOST_COPIED_ONE_BY_ONE = 8
"""Largest count of numbers that are copied without a call."""


class Instructions:
    """A sequence of instructions, and the memory that the instructions reserve."""

    def __init__(self, program: Any) -> None:
        self.program = program
        self.lines: list[Any] = []
        self.reserved: list[str] = []
        self.count = 0

    def emit(self, text: str) -> None:
        """Append an instruction."""
        self.lines.append(text)

    def fresh(self) -> str:
        """Return a name that no other value has."""
        self.count += 1
        return f"%t{self.count}"

    def value(self, kind: str, text: str) -> Number:
        """Append an instruction that computes a number, and return this number."""
        name = self.fresh()
        self.lines.append(f"{name} = {text}")
        return Number(kind, name)

    def reserve(self, kind: Any) -> str:
        """Reserve memory for a value, and return its address."""
        name = self.fresh()
        self.reserved.append(f"{name} = alloca [{size_of(kind)} x i64], align 8")
        return name

    def at(self, address: str, place: int | str, unit: int = 1) -> str:
        """Return an address plus an offset.

        The offset is `place` times `unit`, in words of eight bytes.
        """
        if place in (0, "0"):
            return address
        name = self.fresh()
        step = "i64" if unit == 1 else f"[{unit} x i64]"
        self.lines.append(f"{name} = getelementptr {step}, ptr {address}, i64 {place}")
        return name

    def read(self, kind: Any, address: str, passing: bool = False) -> Any:
        """Return the value of a given kind at an address. A row is not copied."""
        if isinstance(kind, Row):
            return Held(kind, address, passing)
        if isinstance(kind, Array):
            if not passing:
                return Held(kind, address)
            return self.viewed(Held(kind, address))
        if kind == TRUTH:
            whole = self.value(WHOLE, f"load i64, ptr {address}")
            return self.value(TRUTH, f"icmp ne i64 {whole.text}, 0")
        return self.value(kind, f"load {kind}, ptr {address}")

    def write(self, value: Any, address: str, kind: Any) -> None:
        """Convert a value to a kind, and write the value to an address."""
        if isinstance(kind, Row):
            if isinstance(value, Held) and value.kind.members == kind.members:
                size = size_of(kind)
                if size > MOST_COPIED_ONE_BY_ONE:
                    self.emit(
                        f"call void @llvm.memcpy.p0.p0.i64(ptr align 8 {address}, "
                        f"ptr align 8 {value.address}, i64 {8 * size}, i1 false)"
                    )
                    return
            members = [self.member(value, i) for i in range(len(kind.members))]
            for member, own, place in zip(members, kind.members, places_of(kind), strict=True):
                self.write(member, self.at(address, place), own)
        elif isinstance(kind, Array):
            view = self.viewed(value)
            self.emit(f"store ptr {view.data}, ptr {address}")
            for k, length in enumerate(view.shape, 1):
                self.emit(f"store i64 {length}, ptr {self.at(address, k)}")
        else:
            number = self.as_kind(value, kind)
            if kind == TRUTH:
                number = self.as_kind(number, WHOLE)
            self.emit(f"store {number.kind} {number.text}, ptr {address}")

    def member(self, row: Any, i: int) -> Any:
        """Return member number i of a tuple."""
        if isinstance(row, Made):
            return row.members[i]
        address = self.at(row.address, places_of(row.kind)[i])
        return self.read(row.kind.members[i], address, row.passing)

    def viewed(self, array: Any) -> ArrayView:
        """Return a sequence as an `ArrayView`."""
        if isinstance(array, ArrayView):
            return array
        data = self.value("ptr", f"load ptr, ptr {array.address}").text
        shape = [
            self.value(WHOLE, f"load i64, ptr {self.at(array.address, k)}").text
            for k in range(1, array.kind.dimensions + 1)
        ]
        return ArrayView(array.kind, data, tuple(shape))

    def kept(self, value: Any) -> Any:
        """Return a value, copied if necessary so that it is not overwritten later."""
        if isinstance(value, Held) and value.passing:
            address = self.reserve(value.kind)
            self.write(value, address, value.kind)
            return Held(value.kind, address)
        if isinstance(value, Made):
            return Made(value.kind, tuple(map(self.kept, value.members)))
        return value

    def as_kind(self, value: Any, kind: Any) -> Any:
        """Convert a value to a kind, for example a whole number to a real number."""
        if value.kind == kind:
            return value
        if isinstance(kind, Row):
            members = (
                self.as_kind(self.member(value, i), own) for i, own in enumerate(kind.members)
            )
            return Made(kind, tuple(members))
        if not isinstance(value, Number):
            raise TypeError(f"{value.kind} is not {kind}")
        if value.known is not None and kind in (REAL, WHOLE):
            return number_of(float(value.known) if kind == REAL else int(value.known))
        how = {(TRUTH, WHOLE): "zext", (TRUTH, REAL): "uitofp", (WHOLE, REAL): "sitofp"}
        if (value.kind, kind) not in how:
            raise TypeError(f"{value.kind} is not {kind}")
        return self.value(kind, f"{how[value.kind, kind]} {value.kind} {value.text} to {kind}")

    def address_of(self, row: Any) -> str:
        """Return the address of a tuple, which is written to memory if necessary."""
        if isinstance(row, Held):
            return row.address
        address = self.reserve(row.kind)
        self.write(row, address, row.kind)
        return address

    def call_law(self, law: Any, given: list[Any]) -> tuple[Any, Any]:
        """Append the call of a law. Return the kind of the result, and the result."""
        names = law.__code__.co_varnames[: law.__code__.co_argcount]
        for i, name in enumerate(names):
            hint = law.__annotations__.get(name)
            wanted = BY_NAME.get(getattr(builtins, hint, None) if isinstance(hint, str) else hint)
            if wanted:
                given[i] = self.as_kind(given[i], wanted)
        kinds = tuple(each.kind for each in given)
        symbol, kind = self.program.translated(law, kinds)
        words = []
        for each in given:
            if isinstance(each, Global):
                continue
            if isinstance(each.kind, Row):
                words.append(f"ptr {self.address_of(each)}")
            elif isinstance(each.kind, Array):
                view = self.viewed(each)
                words += [f"ptr {view.data}", *(f"i64 {length}" for length in view.shape)]
            else:
                words.append(f"{each.kind} {each.text}")
        if isinstance(kind, str):
            return kind, self.value(kind, f"call {kind} {symbol}({', '.join(words)})")
        address = "null" if kind == NOTHING else self.reserve(kind)
        self.emit(f"call void {symbol}({', '.join([f'ptr {address}', *words])})")
        return kind, self.read(kind, address)
