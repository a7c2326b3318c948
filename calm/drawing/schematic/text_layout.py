"""The layout of a schematic on the page, in which no two texts meet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate

from calm.drawing.schematic.pen import text_width
from calm.drawing.schematic.shown_parts import HEADINGS, Schematic, ShownPart, TextRow
from calm.drawing.schematic.sign import LINES
from calm.drawing.schematic.symbols import SymbolFigure, figure_of

# The unit of the page is a quarter of a millimetre in print, less where a line is long.

FONT = 10.5
LINE = 15.0
"""Size of the texts, and the least distance between two lines of them."""

SMALL = 9.0
"""Size of headings and notes."""

PICTURE = 124.0
"""Width of the picture, left of the texts."""

LINE_AT = 64.0
"""Where the line hangs in the picture."""

_LEAST_WIDTH, _GREATEST_WIDTH = 480.0, 708.0
_TEXTS = PICTURE + 18.0
_GAP = 14.0
_INDENT = 12.0
_SHARE_OF_LABELS = 0.6  # where names want more room than there is
_SHORTEST, _LONGEST, _PER_DECADE = 26.0, 46.0, 6.0
_PAD = 4.0

SHEAVE = 26.0
"""Height of a ship's sheave above the water."""

_HEAD = 86.0  # title and headings
_MAST, _SHIP, _HELICOPTER, _SKY = 42.0, 38.0, 42.0, 10.0
_SUBMERGED = 24.0  # from the surface to the first part
_BELOW_BODY, _SEABED, _FOOT = 24.0, 24.0, 24.0


@dataclass(frozen=True)
class Columns:
    """Where the columns of text stand.

    Attributes
    ----------
    label, name : tuple of float
        Left edge and width.
    figures : tuple of (float, float)
        Right edge and width of each column of figures.
    width : float
        Of the page.
    """

    label: tuple[float, float]
    name: tuple[float, float]
    figures: tuple[tuple[float, float], ...]
    width: float


@dataclass(frozen=True)
class TextPlace:
    """Where a part is drawn.

    Attributes
    ----------
    top, bottom : float
        What it takes of the line.
    middle : float
        Where its symbol is.
    rows, clamps : tuple of float
        Where its texts are, and its clamped instruments with theirs.
    figure : Figure or None
        The symbol; None of a cable or a chain.
    """

    part: ShownPart
    top: float
    bottom: float
    middle: float
    rows: tuple[float, ...]
    clamps: tuple[float, ...]
    figure: SymbolFigure | None


@dataclass(frozen=True)
class SchematicLayout:
    """Where everything stands, from the top of the page.

    Attributes
    ----------
    columns : Columns
    places : tuple of Place
    hung : float
        Where the line begins: at the ship's sheave, or in the first part.
    surface : float
        The sea surface, or the hook of a helicopter.
    bottom : float
        The seabed, or where the water ends.
    height : float
        Of the page.
    """

    columns: Columns
    places: tuple[TextPlace, ...]
    hung: float
    surface: float
    bottom: float
    height: float


def layout_of(schematic: Schematic) -> SchematicLayout:
    """The layout of a schematic; the page is as high as its parts need."""
    surface = _HEAD + _headroom(schematic)
    floats = schematic.surface or schematic.sea is None
    places = _places(schematic, surface if floats else surface + _SUBMERGED)
    bottom = places[-1].bottom
    hung = places[0].middle
    if schematic.towed_by is not None:
        hung = surface - SHEAVE if schematic.sea else surface
        bottom += _BELOW_BODY
    height = bottom + (_SEABED if schematic.seabed else 0.0) + _FOOT
    return SchematicLayout(_columns(schematic), places, hung, surface, bottom, height)


def _headroom(schematic: Schematic) -> float:
    """Return what stands between the headings and the sea surface."""
    if schematic.towed_by is not None:
        return _SHIP if schematic.sea else _HELICOPTER
    return _MAST if schematic.surface else _SKY


def _columns(schematic: Schematic) -> Columns:
    """Columns as wide as their texts need; where that is too wide, labels and names share."""
    rows = [row for part in schematic.parts for row in part.rows]
    clamped = [clamp.row for part in schematic.parts for clamp in part.clamps]
    ends = [row for row in (schematic.towed_by, schematic.sea, schematic.seabed) if row]
    every = [*rows, *clamped, *ends]
    figures = []
    for number, quantity in enumerate(schematic.columns):
        widths = [text_width(row.cells[number], FONT) for row in every]
        figures.append(max(*widths, *(text_width(word, SMALL) for word in HEADINGS[quantity])))
    labels = [_label_width(row) for row in (*rows, *ends)]
    label = max(*labels, *(_INDENT + _label_width(row) for row in clamped), 0.0)
    name = max(text_width(row.name, FONT) for row in every)

    others = _TEXTS + sum(figures) + _GAP * (len(figures) + 1)
    room = _GREATEST_WIDTH - others
    if label + name > room:
        label = min(label, max(_SHARE_OF_LABELS * room, room - name))
        name = room - label
    said = (text_width(schematic.subtitle, SMALL), text_width(schematic.note, SMALL))
    width = min(max(others + label + name, *said, _LEAST_WIDTH), _GREATEST_WIDTH)
    rights = list(accumulate((each + _GAP for each in reversed(figures)), initial=0.0))
    placed = [(width - right, each) for right, each in zip(rights, reversed(figures), strict=False)]
    return Columns((_TEXTS, label), (_TEXTS + label + _GAP, name), tuple(reversed(placed)), width)


def _label_width(row: TextRow) -> float:
    return text_width(row.label, FONT, bold=row.strong)


def indented(columns: Columns) -> tuple[float, float]:
    """Left edge and width of the label of a clamped instrument."""
    left, width = columns.label
    return left + _INDENT, width - _INDENT


def _places(schematic: Schematic, start: float) -> tuple[TextPlace, ...]:
    """The parts one below the other from `start`; a float at the surface has its middle there."""
    places: list[TextPlace] = []
    for part in schematic.parts:
        if part.sign.symbol in LINES:
            place = _cable(part, start)
        else:
            figure = figure_of(part.sign)
            if schematic.surface and not places:
                start -= _slot(figure) / 2
            place = _rigid(part, figure, start)
        places.append(place)
        start = place.bottom
    return tuple(places)


def _cable(part: ShownPart, top: float) -> TextPlace:
    """A cable, its text in the middle, or above those of its instruments."""
    long = 1.0 if math.isnan(part.length) else max(part.length, 1.0)
    height = min(_SHORTEST + _PER_DECADE * math.log10(long), _LONGEST)
    count = len(part.clamps)
    height = max(height, LINE * (count + 1) + _PAD)
    first = top + height / 2 if not count else top + (height - LINE * count) / 2
    clamps = tuple(first + LINE * (number + 1) for number in range(count))
    return TextPlace(part, top, top + height, top + height / 2, (first,), clamps, None)


def _rigid(part: ShownPart, figure: SymbolFigure, top: float) -> TextPlace:
    """A symbol with its texts beside it, and instruments clamped on it below."""
    slot = _slot(figure)
    middle = top + slot / 2
    count = len(part.rows)
    rows = tuple(middle + LINE * (number - (count - 1) / 2) for number in range(count))
    clamps = tuple(top + slot + LINE * (number + 0.5) for number in range(len(part.clamps)))
    bottom = top + slot + LINE * len(part.clamps)
    return TextPlace(part, top, bottom, middle, rows, clamps, figure)


def _slot(figure: SymbolFigure) -> float:
    return max(LINE, figure.height + (_PAD if figure.height > LINE else 0.0))


# Widths in ems, no less than those of Arial, Helvetica, Liberation Sans and DejaVu Sans.
