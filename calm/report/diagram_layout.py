"""What the mooring diagram shows from the top down, and on which page each entry stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import count, groupby

from calm.deck import Deck
from calm.deck.deck_items import DeckItem, DeckRow, rows_on_paper
from calm.drawing.schematic.pen import text_width, wrapped
from calm.drawing.schematic.shown_parts import one_line, place_text
from calm.drawing.schematic.sign import LINES, Sign, Symbol, sign_of
from calm.drawing.schematic.symbols import figure_of
from calm.files.file_differences import own_labels
from calm.quantities import QUANTITIES


@dataclass(frozen=True)
class DiagramEntry:
    """A row of the diagram.

    Attributes
    ----------
    sign : its symbol
    cable : the symbol of the cable that it is, or is clamped on; None of what is rigid
    label, name : in words; the name with the serial number and the codes after it
    cells : cut length or place on the wire, stretched length, depth, height, tension, buoyancy
    floats : the symbol of the floats that are clamped on it
    clamped : whether it is clamped on the entry above it
    junction : whether pages may end above it without parting what belongs together
    strong : whether a reader looks for it
    """

    sign: Sign
    cable: Symbol | None
    label: str
    name: str
    cells: tuple[str, ...]
    floats: Sign | None = None
    clamped: bool = False
    junction: bool = False
    strong: bool = False


def entries_of(deck: Deck) -> tuple[DiagramEntry, ...]:
    """Down the line; connectors that follow one another make one junction, like floats an entry."""
    own = _own_labels(deck.parts)
    weights = {one.label: one.wet_weight for one in deck.assessment.inventory}
    codes = {one.serial: " · ".join(one.code_lines) for one in deck.file.releases}
    found: list[DiagramEntry] = []
    joints: list[DeckItem] = []
    cable: Symbol | None = None
    for row in rows_on_paper(deck.parts):
        if _is_connector(row.first):
            joints += (*row.items, *row.joints)
            continue
        if joints:
            found.append(_junction(joints, own, weights))
        joints = [*row.joints] if len(row.items) == 1 else []
        if row.first.on is None:
            sign = _sign(row.first)
            cable = sign.symbol if sign.symbol in LINES else None
        found.append(_piece(row, cable, weights, codes))
    if joints:
        found.append(_junction(joints, own, weights))
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


def _sign(one: DeckItem) -> Sign:
    return sign_of(one.part.use, one.label, one.part.component)


_Weights = Mapping[str, float | None]


def _piece(
    row: DeckRow, cable: Symbol | None, weights: _Weights, codes: Mapping[str | None, str]
) -> DiagramEntry:
    first, label = row.first, one_line(row.label)
    words = [
        "" if (name := one_line(row.name)) == label else name,
        f"on {one_line(first.name)}" if row.floats else "",
        f"with {one_line(row.joined)}" if row.joined and len(row.items) > 1 else "",
        "" if first.serial is None else f"no. {one_line(first.serial)}",
        one_line(codes.get(first.serial, "")) if first.role == "release" else "",
    ]
    if first.on is not None:
        places = dict.fromkeys((row.items[0].at or 0.0, row.items[-1].at or 0.0))
        lengths = " – ".join(place_text(at) for at in places), ""
    elif len(row.items) > 1:
        lengths = "", ""
    else:
        lengths = _said("length", first.cut_length), _said("length", first.stretched)
    return DiagramEntry(
        sign=_sign(first),
        cable=cable,
        label=label,
        name=" · ".join(filter(None, words)),
        cells=(*lengths, *_figures([*row.items, *row.floats], weights)),
        floats=_sign(row.floats[0]) if row.floats else None,
        clamped=first.on is not None,
        strong=first.role != "line" or bool(row.floats),
    )


def _figures(items: Sequence[DeckItem], weights: _Weights) -> tuple[str, ...]:
    """Depth and height of the first, the greatest tension, and the net buoyancy of all."""
    tension = max((one.tension for one in items if one.tension is not None), default=None)
    own = [weights.get(one.label) for one in items]
    known = [one for one in own if one is not None]
    buoyancy = -sum(known) if len(known) == len(own) else None
    return (
        _said("depth", items[0].depth),
        _said("depth", items[0].height),
        "" if tension is None else _said("tension", tension),
        "?" if buoyancy is None else _said("wet_weight", buoyancy),
    )


def _said(name: str, value: float | None) -> str:
    return QUANTITIES[name].format(value)


def _junction(parts: Sequence[DeckItem], own: Mapping[int, str], weights: _Weights) -> DiagramEntry:
    words = [_connector(one, own[id(one)]) for one in parts]
    joined = " – ".join(
        word if count == 1 else f"{count} × {word}"
        for word, count in ((word, len([*same])) for word, same in groupby(words))
    )
    signs = [_sign(one) for one in parts]
    lengths = (sum(one.cut_length or 0.0 for one in parts),
               sum(one.stretched or 0.0 for one in parts))  # fmt: skip
    return DiagramEntry(
        sign=next((sign for sign in signs if sign.symbol is Symbol.SWIVEL), signs[0]),
        cable=None,
        label=joined,
        name="",
        cells=(*(_said("length", length) for length in lengths), *_figures(parts, weights)),
        junction=True,
    )


def _connector(one: DeckItem, own: str) -> str:
    """A connector as people write it, with its own label and serial number."""
    hardware = one_line(one.hardware)
    text = f"{one_line(own)} ({hardware})" if own else hardware
    return text if one.serial is None else f"{text} no. {one_line(one.serial)}"


FONT = 8.0
"""Size of the texts [pt]; nothing on a diagram is smaller."""
LEADING = 10.0
"""Distance of two lines of text [pt]."""
SYMBOL_SCALE = 0.6
CLAMP_SCALE = 0.42
MARGIN = 34.0
PICTURE = 52.0
"""Width of the picture, left of the texts."""
INDENT = 10.0
FIGURES = (50.0, 42.0, 38.0, 38.0, 38.0, 45.0)
"""Widths of the columns of figures."""
HEAD = 48.0
"""Title and headings."""
CONTINUED = 16.0
"""Height of a continuation mark."""
_GAP, _PAD = 20.0, 4.0
_LEAST_CABLE = 18.0
_SEA, _SEABED = 18.0, 20.0
_NEAR_THE_END = 0.3  # of a column: where a break is looked for


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
    """An entry on its column: from where to where, and its texts in lines.

    `abreast` is how far from the label its name stands in the same line [pt], 0 below it.
    """

    entry: DiagramEntry
    top: float
    height: float
    label: tuple[str, ...]
    name: tuple[str, ...]
    abreast: float = 0.0


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
            placed.append(replace(one, top=top))
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
    abreast = text_width(entry.label, FONT, bold=entry.strong) + 6.0
    fits = len(label) == 1 and len(name) == 1 and entry.label.isascii()
    if not fits or abreast + text_width(entry.name, FONT) > room:
        abreast = 0.0
    height = max(len(label) + len(name) - (abreast > 0.0), 1) * LEADING + _PAD
    if entry.clamped:
        height = max(height, CLAMP_SCALE * figure_of(entry.sign).height + 3.0)
    elif entry.cable is not None:
        height = max(height, _LEAST_CABLE)
    else:
        height = max(height, SYMBOL_SCALE * figure_of(entry.sign).height + 3.0)
    return PlacedEntry(entry, 0.0, height, label, name, abreast)


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
