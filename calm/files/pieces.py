"""The pieces of a line and what is clamped on them: each with its place, and a label of its own."""

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
"""Id of what holds a line whose anchor is yet to be chosen, or a leg that has none."""


@dataclass(frozen=True, order=True)
class Place:
    """Hold where a piece or a clamp stands in the line as read, by which it is known from there on.

    A row of the file is the place of what it gives: `Place(3)` its fourth item, whatever the count
    of that, `Place(3, clamp=0)` the first clamp of it.

    Attributes
    ----------
    item : of the `line:` of the file, from 0
    repeat : which of the `count` of the item, from 0
    part : which piece of an assembly, from 0; -1 where the item is a component
    clamp : which clamp of the piece, from 0; -1 where the piece itself is meant
    """

    item: int
    repeat: int = 0
    part: int = -1
    clamp: int = -1

    @property
    def is_clamp(self) -> bool:
        """Return whether it is that of a clamp."""
        return self.clamp >= 0

    @property
    def row(self) -> Place:
        """Return the row of the file that gives it: of what stands in an assembly, its item."""
        return Place(self.item) if self.part >= 0 else Place(self.item, clamp=self.clamp)


class LinePart(Protocol):
    """Represent a piece or a clamp, or what was found for one."""

    @property
    def place(self) -> Place:
        """Return which one it is."""

    @property
    def label(self) -> str:
        """Return what people call it."""


@dataclass(frozen=True)
class Clamp:
    """Represent an instrument fixed to a piece, `at` metres (unstretched) from the piece's top.

    A profiler travels over `travel`, the same distance of its upper and its lower stop; inf is the
    end of the piece. It is taken to be `at` its upper one. `named` is its label as the file
    gives it, "" where it gives none.
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
        """Return the serial number of this instrument, where the file gives it."""
        return _serial(self.equipment)

    @property
    def planned_depth(self) -> float | None:
        """Depth it is planned to hang at in still water [m]; None without a plan."""
        return self.equipment.planned_depth


@dataclass(frozen=True)
class Piece:
    """Represent one piece of the expanded line.

    Attributes
    ----------
    index : position in the line, 0 at the top (in a tow, at the ship)
    use, label : id of the component; the label is unique in the line
    component : its definition with the overrides of the line applied
    length : unstretched length [m]; None where it is to be cut to fit
    fit_top_depth : depth wanted for the top of the line in still water [m], on the piece cut to fit
    clamps : tuple of Clamp
    line, column : the item in the mooring file, counted from 1
    place : Place
    fit_body_depth : depth wanted for the lower end of the piece at the tow's speed [m], where it is
        cut to fit
    equipment : what the file says of this individual piece
    measured_load : load under which its length is measured [N], `length` being without load all the
        same
    named : label as the file gives it, "" where it gives none
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
        """Return the serial number of this piece, where the file gives it."""
        return _serial(self.equipment)

    @property
    def planned_depth(self) -> float | None:
        """Depth its upper end is planned to hang at in still water [m]; None without a plan."""
        return self.equipment.planned_depth

    def with_clamps(self, changed: Callable[[Clamp], Clamp], **own: Any) -> Piece:
        """Return the piece with each of its clamps changed, and with other fields of its own."""
        return replace(self, clamps=tuple(map(changed, self.clamps)), **own)


def _serial(equipment: Equipment) -> str | None:
    assert not isinstance(equipment.serial, tuple)  # one was chosen as the item was expanded
    return equipment.serial


def placed(piece: Piece, place: Place) -> Piece:
    """Put a piece, with its clamps and the serial numbers there, at a place of the line."""

    def moved(clamp: Clamp) -> Clamp:
        own = replace(place, clamp=clamp.place.clamp)
        return replace(clamp, place=own, equipment=clamp.equipment.of(place.repeat))

    return piece.with_clamps(moved, place=place, equipment=piece.equipment.of(place.repeat))


def unplanned(piece: Piece) -> Piece:
    """Take the planned depths from a piece and its clamps."""

    def without(clamp: Clamp) -> Clamp:
        return replace(clamp, equipment=clamp.equipment.planned_for(None))

    return piece.with_clamps(without, equipment=piece.equipment.planned_for(None))


def numbered(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """Give the pieces their index, and number labels that occur more than once down the line."""
    pieces = tuple(pieces)
    labels = iter(numbered_labels(labels_of(pieces)))

    def relabelled(clamp: Clamp) -> Clamp:
        return replace(clamp, label=next(labels))

    return tuple(
        piece.with_clamps(relabelled, index=index, label=next(labels))
        for index, piece in enumerate(pieces)
    )


def numbered_labels(texts: Sequence[str]) -> list[str]:
    """Number labels that occur more than once down a line, clamps below their piece."""
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
    """Every piece of a line, each with its clamps after it."""
    parts: list[Piece | Clamp] = []
    for piece in pieces:
        parts += (piece, *piece.clamps)
    return parts


def clamps_in(pieces: Iterable[Piece]) -> list[Clamp]:
    """List the clamps of a line in the order of the file, which is that of the solver."""
    return [clamp for piece in pieces for clamp in piece.clamps]


def clamps_down(pieces: Iterable[Piece]) -> list[Clamp]:
    """List the clamps of a mooring's line from its top to its anchor, the order of its results."""
    return [clamp for piece in pieces for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)]


def labels_of(pieces: Iterable[Piece]) -> list[str]:
    """Return the labels of pieces and clamps, down the line."""
    return [part.label for part in parts_of(pieces)]


def travelling(pieces: Sequence[Piece], top: SourceMapping) -> tuple[Piece, ...]:
    """Give each profiler the way that it travels, by the labels of its stops."""
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
        unknown(f"`{label}` is no stop on `{piece.label}`, nor a piece beside it", label, stops)
        for label in between
        if label not in stops
    ]
    if not messages and between and not stops[between[0]] < stops[between[1]]:
        messages = [f"`{between[0]}` is not above `{between[1]}`: give the upper stop first"]
    for message in messages:
        top.refuse(row, message, lacks=lacks)
    if messages or not between:
        return clamp
    upper, lower = (stops[label] for label in between)
    return replace(clamp, at=upper, travel=(upper, lower))


def check_one_fit(pieces: Sequence[Piece], top: SourceMapping) -> None:
    """Check that one piece at most is to be cut to fit."""
    fits = [piece for piece in pieces if piece.length is None]
    for piece in fits[1:]:
        message = f"only one piece can be cut to fit; line {fits[0].line} has one already"
        top.refuse_at(piece.line, piece.column, message)
