"""What may be changed to size a mooring: ``LABEL.buoyancy``, ``.length`` or ``.count``.

A change is made in the models of the file, as if it had been written there; everything else follows
from them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar

from calm.case.parts import all_parts
from calm.case.targets import pointed
from calm.errors import UsageError, unknown
from calm.files import Anchor, Cable, Chain, Clamp, Component, Flexible, MooringFile, Piece, Place
from calm.files.definition import STANDARD_GRAVITY
from calm.files.mooring_file import numbered, placed
from calm.units import DIMENSIONS, QuantityError, parse_quantity, with_unit

MOST_BUOYANCY = 100.0
"""Largest factor on the buoyancy of a float, unless a range is given."""
MOST_LENGTH = 2.0
"""Greatest length of a piece in water depths, unless a range is given."""
LEAST_LENGTH = 0.01
"""Least length of a cable or chain [m]."""
MOST_COUNT = 1000
"""Greatest count of a component, unless a range is given."""


@dataclass(frozen=True)
class Adjustment(ABC):
    """One number of a mooring file that may be changed.

    Attributes
    ----------
    text : as it was written, e.g. ``top float.buoyancy``
    file : the mooring before the change
    parts : those that change together, before the change
    """

    text: str
    file: MooringFile = field(repr=False)
    parts: tuple[Piece | Clamp, ...] = field(repr=False)

    whole: ClassVar[bool] = False
    note: ClassVar[str] = ""

    @property
    def dimension(self) -> str:
        """Dimension of the number, a key of `calm.units.DIMENSIONS`."""
        return "length"

    @property
    def unit(self) -> str:
        """SI unit of the number."""
        return DIMENSIONS[self.dimension].unit

    @property
    @abstractmethod
    def now(self) -> float:
        """The number before the change."""

    @property
    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Its range where none is given: least and greatest value."""

    @abstractmethod
    def to(self, value: float) -> MooringFile:
        """The mooring with another number."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the parts that change."""
        return tuple(part.label for part in self.parts)

    @cached_property
    def _places(self) -> frozenset[Place]:
        return frozenset(part.place for part in self.parts)


class Buoyancy(Adjustment):
    """Net force in water of a rigid piece or clamped instrument [N], or of a cable [N/m]."""

    note = (
        "Only the net force in water changes; size, drag and mass do not. A real part "
        "with this buoyancy has a different drag: put it in the file and run that."
    )

    @property
    def dimension(self) -> str:
        return "force per length" if isinstance(self._component, Cable) else "force"

    @property
    def now(self) -> float:
        return self._component.net_buoyancy

    @property
    def range(self) -> tuple[float, float]:
        most = MOST_BUOYANCY * self.now
        mass = self._component.mass
        if most < 0.0 and mass is not None:
            most = max(most, -mass * STANDARD_GRAVITY)
        return min(most, 0.0), max(most, 0.0)

    def to(self, value: float) -> MooringFile:
        pieces = tuple(
            replace(
                piece,
                component=self._lifted(piece, value),
                clamps=tuple(
                    replace(clamp, component=self._lifted(clamp, value)) for clamp in piece.clamps
                ),
            )
            for piece in self.file.pieces
        )
        return replace(self.file, pieces=pieces)

    @property
    def _component(self) -> Component:
        return self.parts[0].component

    def _lifted(self, part: Piece | Clamp, value: float) -> Component:
        component = part.component
        if part.place not in self._places:
            return component
        # what else the net force could follow from goes, as in an override on the line
        other = "weight" if isinstance(component, Cable) else "volume"
        return component.model_copy(update={"buoyancy": value, other: None})


class Length(Adjustment):
    """Unstretched length of a cable or chain [m]; its clamps stay where they are from its top."""

    @property
    def now(self) -> float:
        first = self.parts[0]
        assert isinstance(first, Piece) and first.length is not None
        return first.length

    @property
    def range(self) -> tuple[float, float]:
        clamps = [clamp for part in self.parts if isinstance(part, Piece) for clamp in part.clamps]
        lowest = max((clamp.at for clamp in clamps), default=0.0)
        depth = self.file.environment.depth
        assert depth is not None  # a mooring stands on the seabed
        return max(lowest, LEAST_LENGTH), MOST_LENGTH * depth

    def to(self, value: float) -> MooringFile:
        pieces = tuple(
            replace(piece, length=value) if piece.place in self._places else piece
            for piece in self.file.pieces
        )
        return replace(self.file, pieces=pieces)


class Count(Adjustment):
    """Describe how many times a component stands in line, with its own clamps each time."""

    whole = True

    @property
    def dimension(self) -> str:
        return "number"

    @property
    def now(self) -> float:
        return float(len(self.parts))

    @property
    def range(self) -> tuple[float, float]:
        return 1.0, float(MOST_COUNT)

    def to(self, value: float) -> MooringFile:
        pieces, group = self.file.pieces, self.parts
        one, last = group[0], group[-1]
        assert isinstance(one, Piece) and isinstance(last, Piece)
        if len(group) > 1:  # labels of several are numbered
            clamps = tuple(replace(c, label=_unnumbered(c.label)) for c in one.clamps)
            one = replace(one, label=_unnumbered(one.label), clamps=clamps)
        repeats = (placed(one, replace(one.place, repeat=number)) for number in range(int(value)))
        line = (*pieces[: one.index], *repeats, *pieces[last.index + 1 :])
        legs = tuple(leg.grown(one.index, len(line) - len(pieces)) for leg in self.file.legs)
        return replace(self.file, pieces=numbered(line), legs=legs)


def _unnumbered(label: str) -> str:
    return label.rpartition(" ")[0]


Parts = tuple[Piece | Clamp, ...]


def parse_change(text: str, file: MooringFile) -> Adjustment:
    """Read what is to be changed, e.g. ``top float.buoyancy``.

    Parameters
    ----------
    text : the label of a part of the line, or of several without their numbers; a point;
        ``buoyancy``, ``length`` or ``count``
    file : the mooring, in which the label is looked up

    Raises
    ------
    UsageError
        With a caret under what is wrong, and the nearest right thing.
    """
    text = " ".join(text.split())
    name, point, field = text.rpartition(".")
    if not point or field not in _FIELDS:
        what = f"unknown field `{field}`" if point else "there is no field to change"
        message = unknown(what, field if point else "", _FIELDS)
        raise pointed("--change", text, len(name) + 1 if point else len(text), message)
    try:
        return _FIELDS[field](text, file, all_parts(file.pieces, name))
    except LookupError as error:
        raise pointed("--change", text, 0, str(error.args[0])) from None


def parse_range(texts: tuple[str, str] | None, change: Adjustment) -> tuple[float, float]:
    """The range of a change: as given, each end with its unit, or that of the adjustment.

    UsageError: an end is no such quantity, or they are in the wrong order.
    """
    if texts is None:
        low, high = change.range
        if low == high:
            raise UsageError(f"{change.text} is 0; give its range with --between")
        return low, high
    ends = []
    for text in texts:
        try:
            ends.append(parse_quantity(text, change.dimension))
        except QuantityError as error:
            raise UsageError(f"--between: `{text}` {error}") from None
    low, high = ends
    if not low < high:
        raise UsageError(f"--between: {texts[0]} is not below {texts[1]}")
    least = change.range[0] if isinstance(change, Length | Count) else low
    if low < least:
        limit = with_unit(least, change.unit)
        raise UsageError(f"--between: `{texts[0]}` must be at least {limit}")
    if change.whole and (low % 1 or high % 1):
        raise UsageError("--between: a count is a whole number")
    return low, high


def _buoyancy(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    components = [part.component for part in parts]
    for component in components:
        if isinstance(component, Chain | Anchor):
            raise LookupError(f"{_article(component)} has a weight and no buoyancy to change")
    if any(component != components[0] for component in components):
        raise LookupError("these parts differ; name one")
    return Buoyancy(text, file, parts)


def _length(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts) or not isinstance(pieces[0].component, Flexible):
        raise LookupError("only cables and chains are cut to length")
    if any(piece.length is None for piece in pieces):
        raise LookupError("it is cut to fit (`length: fit`); give it a length in the file first")
    _refuse_several_items(pieces)
    return Length(text, file, parts)


def _count(text: str, file: MooringFile, parts: Parts) -> Adjustment:
    pieces = [part for part in parts if isinstance(part, Piece)]
    if len(pieces) < len(parts):
        raise LookupError("clamped instruments are not counted; only pieces in line are")
    if isinstance(pieces[0].component, Anchor):
        raise LookupError("a line has one anchor")
    _refuse_several_items(pieces)
    item = tuple(one for one in file.pieces if one.place.item == pieces[0].place.item)
    if any((one.use, one.component) != (item[0].use, item[0].component) for one in item):
        raise LookupError("it is part of an assembly, which is counted as a whole")
    if any(one.length is None for one in item):
        raise LookupError("it is cut to fit (`length: fit`), which only one piece can be")
    return Count(text, file, item)


_FIELDS = {"buoyancy": _buoyancy, "length": _length, "count": _count}


def _refuse_several_items(pieces: Sequence[Piece]) -> None:
    if len({piece.place.item for piece in pieces}) > 1:
        named = pieces[0].label
        raise LookupError(f"several items of the line have this label; name one: {named} …")


def _article(component: Component) -> str:
    return "an anchor" if isinstance(component, Anchor) else f"a {component.kind}"
