"""The pages of the mooring diagram: which entry stands where, so that no text is cut."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import count
from typing import TYPE_CHECKING

from calm.report.schematic.figures import figure_of
from calm.report.schematic.widths import wrapped

if TYPE_CHECKING:
    from calm.report.deck.entries import Entry

FONT = 7.5
"""Size of the texts [pt]; nothing on a diagram is smaller than 7 pt."""
SMALL = 7.0
LEADING = 9.4
"""Distance of two lines of text [pt]."""
SYMBOL_SCALE = 0.6
CLAMP_SCALE = 0.42
MARGIN = 34.0
PICTURE = 58.0
"""Width of the picture, left of the texts."""
INDENT = 10.0
FIGURES = (46.0, 42.0, 40.0, 40.0)
"""Widths of the columns of figures."""
HEAD = 52.0
"""Title and headings."""
CONTINUED = 16.0
"""Height of a continuation mark."""
_GAP, _PAD = 20.0, 5.0
_LEAST_CABLE = 24.0
_SEA, _SEABED = 18.0, 20.0
_NEAR_THE_END = 0.45  # of a column: where a break is looked for


class Paper(StrEnum):
    """What the sheets are printed on."""

    A4 = "a4"
    A3 = "a3"
    LETTER = "letter"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height [pt]."""
        return {"a4": (595.28, 841.89), "a3": (1190.55, 841.89), "letter": (612.0, 792.0)}[self]

    @property
    def columns(self) -> int:
        """How many columns stand side by side."""
        return 2 if self is Paper.A3 else 1

    @property
    def column_width(self) -> float:
        """Width of one [pt]."""
        room = self.size[0] - 2 * MARGIN - (self.columns - 1) * _GAP
        return room / self.columns

    def left(self, column: int) -> float:
        """Left edge of a column [pt]."""
        return MARGIN + (column % self.columns) * (self.column_width + _GAP)


@dataclass(frozen=True)
class Placed:
    """An entry on its column: from where to where, and its texts in lines."""

    entry: Entry
    top: float
    height: float
    label: tuple[str, ...]
    name: tuple[str, ...]


@dataclass(frozen=True)
class ColumnOf:
    """A column of a page.

    Attributes
    ----------
    entries : from its top down
    above, below : the marks at which the line goes on; "" at its ends
    end : where the entries end
    """

    entries: tuple[Placed, ...]
    above: str
    below: str
    end: float


def text_width_of(paper: Paper) -> float:
    """Room for label and name [pt]."""
    return paper.column_width - PICTURE - sum(FIGURES) - _PAD


def columns_of(entries: Sequence[Entry], paper: Paper, foot: float) -> tuple[ColumnOf, ...]:
    """The columns in reading order; `foot` is the height of the title block [pt]."""
    room = paper.size[1] - MARGIN - foot - MARGIN - HEAD - 2 * CONTINUED - _SEA - _SEABED
    measured = [_measured(entry, paper) for entry in entries]
    found: list[ColumnOf] = []
    marks, above = _marks(), ""
    for group in _broken(measured, room):
        top = MARGIN + HEAD + (CONTINUED if above else _SEA)
        placed = []
        for one in group:
            placed.append(Placed(one.entry, top, one.height, one.label, one.name))
            top += one.height
        last = group[-1] is measured[-1]
        below = "" if last else next(marks)
        found.append(ColumnOf(tuple(placed), above, below, top))
        above = below
    return tuple(found)


def _measured(entry: Entry, paper: Paper) -> Placed:
    room = text_width_of(paper) - (INDENT if entry.clamped else 0.0)
    label = tuple(wrapped(entry.label, room, FONT, bold=entry.strong))
    name = tuple(wrapped(entry.name, room, FONT))
    height = (len(label) + len(name)) * LEADING + _PAD
    if entry.clamped:
        height = max(height, CLAMP_SCALE * figure_of(entry.sign).height + 3.0)
    elif entry.cable is not None:
        height = max(height, _LEAST_CABLE)
    else:
        height = max(height, SYMBOL_SCALE * figure_of(entry.sign).height + 4.0)
    return Placed(entry, 0.0, height, label, name)


def _broken(entries: Sequence[Placed], room: float) -> Iterator[list[Placed]]:
    """Groups that fit a column, parted at a junction near its end where there is one."""
    rest = [*entries]
    while rest:
        height, fits = 0.0, 0
        while fits < len(rest) and (fits == 0 or height + rest[fits].height <= room):
            height += rest[fits].height
            fits += 1
        if fits < len(rest):
            fits = _break(rest, fits, room)
        yield rest[:fits]
        rest = rest[fits:]


def _break(rest: Sequence[Placed], fits: int, room: float) -> int:
    """Before which entry to part: a junction, else a piece, else a clamp, as low as can be."""
    height = sum(one.height for one in rest[:fits])
    best = fits, 3
    for number in range(fits, 0, -1):
        entry = rest[number].entry
        quality = 0 if entry.junction else 2 if entry.clamped else 1
        if height < (1.0 - _NEAR_THE_END) * room and best[1] < 3:
            break
        if quality < best[1]:
            best = number, quality
        height -= rest[number - 1].height
    return best[0]


def _marks() -> Iterator[str]:
    """A, B … Z, A1, B1 …"""
    for turn in count():
        for number in range(26):
            yield chr(ord("A") + number) + (str(turn) if turn else "")
