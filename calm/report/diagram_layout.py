"""What the mooring diagram shows from the top down, and on which page each entry stands."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import count, groupby
from typing import TYPE_CHECKING

from calm.drawing.schematic.pen import wrapped
from calm.drawing.schematic.shown_parts import one_line, place_text
from calm.drawing.schematic.sign import LINES, Sign, Symbol, sign_of
from calm.drawing.schematic.symbols import figure_of
from calm.files.file_differences import own_labels
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from calm.deck import Deck
    from calm.deck.deck_items import DeckItem

    pass


_SIZED = re.compile(r"(shackle|ring|swivel|link)(?:-[a-z]+)?-(\d+)\b.*")


@dataclass(frozen=True)
class DiagramEntry:
    """A row of the diagram.

    Attributes
    ----------
    sign : its symbol
    cable : the symbol of the cable that it is, or is clamped on; None of what is rigid
    label, name : in words; the name with the serial number after it
    cells : cut length or place on the wire, stretched length, depth, height
    clamped : whether it is clamped on the entry above it
    junction : whether pages may end above it without parting what belongs together
    strong : whether a reader looks for it
    """

    sign: Sign
    cable: Symbol | None
    label: str
    name: str
    cells: tuple[str, str, str, str]
    clamped: bool = False
    junction: bool = False
    strong: bool = False


def entries_of(deck: Deck) -> tuple[DiagramEntry, ...]:
    """Down the line; connectors that follow one another make one junction."""
    own = _own_labels(deck.parts)
    found: list[DiagramEntry] = []
    for joins, group in groupby(deck.parts, key=_is_connector):
        parts = [*group]
        if joins:
            found.append(_junction(parts, own))
        else:
            found += _pieces(parts)
    return tuple(found)


def _own_labels(parts: Sequence[DeckItem]) -> dict[int, str]:
    """Of each part, by its identity: its label where a person gave it, else nothing."""
    labels = own_labels([one.label for one in parts])
    return {
        id(one): "" if label == one.part.use else one.label
        for one, label in zip(parts, labels, strict=True)
    }


def _is_connector(one: DeckItem) -> bool:
    clamps = getattr(one.part, "clamps", ())
    return one.role == "connector" and one.on is None and one.is_rigid and not clamps


def _pieces(parts: Sequence[DeckItem]) -> Iterator[DiagramEntry]:
    cable: Symbol | None = None
    for one in parts:
        sign = sign_of(one.part.use, one.label, one.part.component)
        if one.on is None:
            cable = sign.symbol if sign.symbol in LINES else None
        name = one_line(one.name)
        serial = "" if one.serial is None else f"no. {one_line(one.serial)}"
        label = one_line(one.label)
        yield DiagramEntry(
            sign=sign,
            cable=cable,
            label=label,
            name=" · ".join(filter(None, ("" if name == label else name, serial))),
            cells=_cells(one),
            clamped=one.on is not None,
            strong=one.role != "line",
        )


def _junction(parts: Sequence[DeckItem], own: dict[int, str]) -> DiagramEntry:
    words = [_said(one, own[id(one)]) for one in parts]
    joined = " – ".join(
        word if count == 1 else f"{count} × {word}"
        for word, count in ((word, len([*same])) for word, same in groupby(words))
    )
    signs = [sign_of(one.part.use, one.label, one.part.component) for one in parts]
    swivel = next((sign for sign in signs if sign.symbol is Symbol.SWIVEL), signs[0])
    lengths = (
        sum(one.cut_length or 0.0 for one in parts),
        sum(one.stretched or 0.0 for one in parts),
    )
    first = parts[0]
    figures = {"cut_length": lengths[0], "length": lengths[1],
               "depth": first.depth, "height": first.height}  # fmt: skip
    texts = [QUANTITIES[name].format(value) for name, value in figures.items()]
    return DiagramEntry(
        sign=swivel,
        cable=None,
        label=joined,
        name="",
        cells=(texts[0], texts[1], texts[2], texts[3]),
        junction=True,
    )


def _said(one: DeckItem, own: str) -> str:
    """A connector as people write it, 13 shackle, with its own label and serial number."""
    sized = _SIZED.fullmatch(one.part.use)
    hardware = f"{sized[2]} {sized[1]}" if sized else one_line(one.name)
    text = f"{one_line(own)} ({hardware})" if own else hardware
    return text if one.serial is None else f"{text} no. {one_line(one.serial)}"


def _cells(one: DeckItem) -> tuple[str, str, str, str]:
    depth, height = (QUANTITIES["depth"].format(value) for value in (one.depth, one.height))
    if one.on is not None:
        return place_text(one.at or 0.0), "", depth, height
    cut, stretched = (QUANTITIES["length"].format(value) for value in
                      (one.cut_length, one.stretched))  # fmt: skip
    return cut, stretched, depth, height


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
        """Return how many columns stand side by side."""
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
class PlacedEntry:
    """An entry on its column: from where to where, and its texts in lines."""

    entry: DiagramEntry
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

    entries: tuple[PlacedEntry, ...]
    above: str
    below: str
    end: float


def text_width_of(paper: Paper) -> float:
    """Room for label and name [pt]."""
    return paper.column_width - PICTURE - sum(FIGURES) - _PAD


def columns_of(entries: Sequence[DiagramEntry], paper: Paper, foot: float) -> tuple[ColumnOf, ...]:
    """The columns in reading order; `foot` is the height of the title block [pt]."""
    room = paper.size[1] - MARGIN - foot - MARGIN - HEAD - 2 * CONTINUED - _SEA - _SEABED
    measured = [_measured(entry, paper) for entry in entries]
    found: list[ColumnOf] = []
    marks, above = _marks(), ""
    for group in _broken(measured, room):
        top = MARGIN + HEAD + (CONTINUED if above else _SEA)
        placed = []
        for one in group:
            placed.append(PlacedEntry(one.entry, top, one.height, one.label, one.name))
            top += one.height
        last = group[-1] is measured[-1]
        below = "" if last else next(marks)
        found.append(ColumnOf(tuple(placed), above, below, top))
        above = below
    return tuple(found)


def _measured(entry: DiagramEntry, paper: Paper) -> PlacedEntry:
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
    return PlacedEntry(entry, 0.0, height, label, name)


def _broken(entries: Sequence[PlacedEntry], room: float) -> Iterator[list[PlacedEntry]]:
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


def _break(rest: Sequence[PlacedEntry], fits: int, room: float) -> int:
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
