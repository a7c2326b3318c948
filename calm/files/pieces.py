"""Pieces of a line and their clamps, each with its position and a unique label."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

from calm.errors import unknown
from calm.files.components import Component
from calm.files.item_keys import NO_EQUIPMENT, Equipment
from calm.files.rigid import Profiler
from calm.files.yaml_document import SourceMapping

STAND_IN = ""
"""Reserved id of the substitute anchor for a line or leg without an anchor."""


@dataclass(frozen=True, order=True)
class Place:
    """Position of a piece or clamp in the file.

    `Place(3)` is the fourth item of the line, and `Place(3, clamp=0)` is its first clamp.

    Attributes
    ----------
    item : index of the item in the `line:` of the file
    repeat : index of the repetition, if the item has a `count`
    part : index of the piece in an assembly; -1 for a component
    clamp : index of the clamp on the piece; -1 for the piece itself
    """

    item: int
    repeat: int = 0
    part: int = -1
    clamp: int = -1

    @property
    def is_clamp(self) -> bool:
        """Whether this is the place of a clamp."""
        return self.clamp >= 0

    @property
    def row(self) -> Place:
        """Place of the item or clamp in the file; for a part of an assembly, place of its item."""
        return Place(self.item) if self.part >= 0 else Place(self.item, clamp=self.clamp)


class LinePart(Protocol):
    """Interface of pieces, clamps and their results, which all have a place and a label."""

    @property
    def place(self) -> Place:
        """Place of the part in the file."""

    @property
    def label(self) -> str:
        """Name of the part in output."""


@dataclass(frozen=True)
class Clamp:
    """An instrument clamped on a piece.

    Attributes
    ----------
    at : unstretched distance from the upper end of the piece [m]; for a profiler, `travel[0]`
    travel : distances of a profiler's upper and lower stop from the upper end of the piece [m];
        infinite for a stop at the lower end
    named : label in the file, or ""
    """

    use: str
    label: str
    component: Component
    at: float
    place: Place
    equipment: Equipment = NO_EQUIPMENT
    travel: tuple[float, float] | None = None
    named: str = ""

    @property
    def serial(self) -> str | None:
        """Serial number of the clamped instrument; None if unknown."""
        return _serial(self.equipment)

    @property
    def serials(self) -> tuple[str, ...]:
        """Serial number of the clamped instrument, as a tuple; empty if unknown."""
        return self.equipment.serials

    @property
    def planned_depth(self) -> float | None:
        """Planned depth in still water [m]; None if none is planned."""
        return self.equipment.planned_depth


@dataclass(frozen=True)
class Piece:
    """A piece of a line, after the expansion of counts and assemblies.

    Attributes
    ----------
    index : index in the line, 0 at the top (in a tow, at the ship)
    use, label : id of the component, and unique label of the piece
    component : definition of the component, including the overrides in the line
    length : unstretched length [m]; None for a piece that is cut to fit
    fit_top_depth : depth of the top of the line in still water, for a piece cut to fit [m]
    line, column : position in the text of the mooring file, from 1
    fit_body_depth : depth of the lower end under tow, for a piece cut to fit [m]
    measured_load : load under which the length in the file was measured [N]
    named : label in the file, or ""
    """

    index: int
    use: str
    label: str
    component: Component
    length: float | None
    fit_top_depth: float | None
    clamps: tuple[Clamp, ...]
    line: int
    column: int
    place: Place
    fit_body_depth: float | None = None
    equipment: Equipment = NO_EQUIPMENT
    measured_load: float = 0.0
    named: str = ""

    @property
    def serial(self) -> str | None:
        """Serial numbers of the items of this piece, separated by commas; None if unknown."""
        return _serial(self.equipment)

    @property
    def serials(self) -> tuple[str, ...]:
        """Known serial numbers of the items of this piece."""
        return self.equipment.serials

    @property
    def planned_depth(self) -> float | None:
        """Planned depth of the upper end in still water [m]; None if none is planned."""
        return self.equipment.planned_depth

    def with_clamps(self, changed: Callable[[Clamp], Clamp], **own: Any) -> Piece:
        """Return a copy of the piece in which each clamp is replaced by `changed(clamp)`.

        Keyword arguments replace other fields of the piece.
        """
        return replace(self, clamps=tuple(map(changed, self.clamps)), **own)


def holds_instrument(part: Piece | Clamp) -> bool:
    """True if a part is an instrument or a release, or holds one, such as a float with an ADCP.

    A part holds an instrument if it has a tilt limit, a calibration date, a sampling scheme or a
    battery date. A float also holds one if it has a serial number.
    """
    component, own = part.component, part.equipment
    data = (component.max_tilt, component.warn_tilt, own.calibrated, own.sampling,
            own.battery_until)  # fmt: skip
    return (
        component.role in ("instrument", "release")
        or any(one is not None for one in data)
        or (component.role == "float" and bool(part.serials))
    )


def _serial(equipment: Equipment) -> str | None:
    return ", ".join(equipment.serials) or None


def placed(piece: Piece, place: Place) -> Piece:
    """Return a copy of a piece at another place in the file.

    The copy and its clamps get the serial numbers that belong to that place.
    """

    def moved(clamp: Clamp) -> Clamp:
        own = replace(place, clamp=clamp.place.clamp)
        return replace(clamp, place=own, equipment=clamp.equipment.of(place.repeat, 1))

    own = piece.equipment.of(place.repeat, piece.component.items or 1)
    return piece.with_clamps(moved, place=place, equipment=own)


def unplanned(piece: Piece) -> Piece:
    """Return a copy of a piece and its clamps without planned depths."""

    def without(clamp: Clamp) -> Clamp:
        return replace(clamp, equipment=clamp.equipment.planned_for(None))

    return piece.with_clamps(without, equipment=piece.equipment.planned_for(None))


def numbered(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """Return the pieces with their indices set and repeated labels numbered from the top down."""
    pieces = tuple(pieces)
    labels = iter(numbered_labels(labels_of(pieces)))

    def relabelled(clamp: Clamp) -> Clamp:
        return replace(clamp, label=next(labels))

    return tuple(
        piece.with_clamps(relabelled, index=index, label=next(labels))
        for index, piece in enumerate(pieces)
    )


def numbered_labels(texts: Sequence[str]) -> list[str]:
    """Append numbers to labels that occur several times, counting from 1 in the given order."""
    total, seen = Counter(texts), Counter[str]()

    def numbered_label(text: str) -> str:
        if total[text] == 1:
            return text
        seen[text] += 1
        while f"{text} {seen[text]}" in total:
            seen[text] += 1
        return f"{text} {seen[text]}"

    return [numbered_label(text) for text in texts]


def parts_of(pieces: Iterable[Piece]) -> list[Piece | Clamp]:
    """Return the pieces of a line, each followed by its clamps."""
    parts: list[Piece | Clamp] = []
    for piece in pieces:
        parts += (piece, *piece.clamps)
    return parts


def clamps_in(pieces: Iterable[Piece]) -> list[Clamp]:
    """Return the clamps of a line in file order, which is also the order in the solver."""
    return [clamp for piece in pieces for clamp in piece.clamps]


def clamps_down(pieces: Iterable[Piece]) -> list[Clamp]:
    """Return the clamps of a mooring line from the top down, which is the order of results."""
    return [clamp for piece in pieces for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)]


def labels_of(pieces: Iterable[Piece]) -> list[str]:
    """Return the labels of pieces and clamps; each piece precedes its clamps."""
    return [part.label for part in parts_of(pieces)]


def travelling(pieces: Sequence[Piece], top: SourceMapping) -> tuple[Piece, ...]:
    """Set the travel range of each profiler from the positions of its two stops.

    Return the changed pieces. Mistakes are recorded in `top`.
    """
    return tuple(piece.with_clamps(partial(_travelling, piece, pieces, top)) for piece in pieces)


def _travelling(piece: Piece, pieces: Sequence[Piece], top: SourceMapping, clamp: Clamp) -> Clamp:
    if not isinstance(clamp.component, Profiler):
        return clamp
    stops = {each.label: 0.0 if each.index < piece.index else math.inf for each in pieces}
    del stops[piece.label]
    stops |= {each.label: each.at for each in piece.clamps if each.travel is None}
    stops.pop(clamp.label, None)
    between = clamp.component.between or ()
    place, lacks = clamp.place, "" if between else f"no stops of {clamp.label}"
    row = ("line", place.item, *(() if place.part >= 0 else ("clamps", place.clamp)))
    messages = [] if between else ["a profiler needs `between: [upper stop, lower stop]`"]
    messages += [
        unknown(f"`{label}` is neither a clamp on `{piece.label}` nor another piece", label, stops)
        for label in between
        if label not in stops
    ]
    if not messages and between and not stops[between[0]] < stops[between[1]]:
        messages = [f"`{between[0]}` must be above `{between[1]}`; give the upper stop first"]
    for message in messages:
        top.refuse(row, message, lacks=lacks)
    if messages or not between:
        return clamp
    upper, lower = (stops[label] for label in between)
    return replace(clamp, at=upper, travel=(upper, lower))


def check_one_fit(pieces: Sequence[Piece], top: SourceMapping) -> None:
    """Check that at most one piece is cut to fit."""
    fits = [piece for piece in pieces if piece.length is None]
    for piece in fits[1:]:
        message = (
            "only one piece can be cut to fit; the file already has one, on its "
            f"line {fits[0].line}"
        )
        top.refuse_at(piece.line, piece.column, message)
