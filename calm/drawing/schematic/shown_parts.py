"""Parts of a line in a schematic, from the top down, each with its rows of text."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

from calm.case.design import AnyResult
from calm.drawing.line_picture import differ_by_number, together
from calm.drawing.picture import printable
from calm.drawing.schematic.symbols import BALLS, LINES, Sign, Symbol, sign_of
from calm.files import Clamp, MooringFile, Piece, Place, Rigid
from calm.files.pieces import STAND_IN
from calm.quantities import QUANTITIES, say

HEADINGS = {"cut_length": ("cut", "length"), "depth": ("", "depth"), "height": ("above", "seabed")}
"""Quantities next to each part, with the two lines of their headings."""

_JOINED = (*BALLS, Symbol.SHACKLE, Symbol.SWIVEL, Symbol.LINK)


@dataclass(frozen=True)
class TextRow:
    """Row of text next to a part: label, component name, and a cell for each column."""

    label: str
    name: str
    cells: tuple[str, ...] = ()
    strong: bool = False


@dataclass(frozen=True)
class ShownPart:
    """A part with its own symbol: a piece, equal pieces, a junction, or a clamped instrument.

    Attributes
    ----------
    sign : symbol to draw, with the number of the floats on a chain or cable
    rows : rows of text: two for a pair of releases, otherwise one
    labels : labels of the pieces in the part
    cable : symbol of the cable; for a clamped instrument, symbol of the cable under the clamp; None
        for a rigid part
    length : length of a cable [m], NaN if unknown
    clamped : whether the part is clamped on the part above it
    junction : whether a page may end above the part
    """

    sign: Sign
    rows: tuple[TextRow, ...]
    labels: tuple[str, ...] = ()
    cable: Symbol | None = None
    length: float = math.nan
    clamped: bool = False
    junction: bool = False


@dataclass(frozen=True)
class Schematic:
    """Contents of a schematic, from the top of a mooring or from the ship down.

    Attributes
    ----------
    subtitle : depth and position of a mooring, or speed of a tow
    note : explanation of the depths
    columns : names of the columns of values, from `HEADINGS`
    parts : parts from the top, with clamped instruments after their piece
    surface : whether the first part floats at the surface
    towed_by, sea, seabed : rows of text at the ship or helicopter, sea surface and seabed, if
        present
    """

    title: str
    subtitle: str
    note: str
    columns: tuple[str, ...]
    parts: tuple[ShownPart, ...]
    surface: bool
    towed_by: TextRow | None
    sea: TextRow | None
    seabed: TextRow | None


def schematic_of(file: MooringFile, result: AnyResult | None = None) -> Schematic:
    """Build the contents of the schematic of a line.

    If a result is given, the depths are those of the solution.
    """
    levels = levels_of(file, result)
    bottom = file.environment.depth

    def cells(length: str, depth: float) -> tuple[str, ...]:
        heights = [] if bottom is None else [QUANTITIES["height"].format(bottom - depth)]
        return length, QUANTITIES["depth"].format(depth), *heights

    has_anchor = file.pieces[-1].use != STAND_IN
    pieces = file.pieces if has_anchor else file.pieces[:-1]
    water = file.environment.fluid == "water"
    towed_by = None
    if file.tow is not None:
        towed_by = TextRow("ship" if water else "helicopter", "", cells("", -file.tow.height))
    return Schematic(
        title=one_line(file.name),
        subtitle=_subtitle(file),
        note=levels.note,
        columns=tuple(name for name in HEADINGS if name != "height" or bottom is not None),
        parts=tuple(_parts(pieces, cells, levels)),
        surface=levels.surface,
        towed_by=towed_by,
        sea=TextRow("sea surface", "", cells("", 0.0)) if water else None,
        seabed=None
        if bottom is None or not has_anchor
        else TextRow("seabed", "", cells("", bottom)),
    )


def one_line(text: str) -> str:
    """Convert a text to a single line.

    Characters that XML or a terminal cannot show become a replacement character.
    """
    return printable(" ".join(text.split()))


Cells = Callable[[str, float], tuple[str, ...]]
"""Function that returns the values of a row.

The arguments are the text of a length or clamp position, and a depth [m].
"""


def _parts(pieces: Sequence[Piece], cells: Cells, levels: Levels) -> Iterator[ShownPart]:
    run: list[Piece] = []
    for piece in pieces:
        if run and not _joins_run(run, piece, levels):
            yield from _parts_of_run(run, cells, levels)
            run = []
        run.append(piece)
    yield from _parts_of_run(run, cells, levels)


def _joins_run(run: list[Piece], piece: Piece, levels: Levels) -> bool:
    above, sign = run[-1], _sign(piece, levels)
    if piece.clamps or above.clamps or sign != _sign(above, levels):
        return False
    if sign.symbol is Symbol.RELEASE:
        return len(run) == 1
    same = above.use == piece.use and above.component == piece.component
    return sign.symbol in _JOINED and same and differ_by_number(run[0].label, piece.label)


def _sign(of: Piece | Clamp, levels: Levels) -> Sign:
    sign = sign_of(of.use, of.label, of.component)
    return afloat(sign) if levels.surface and of is levels.first else sign


def afloat(sign: Sign) -> Sign:
    """Return the symbol for a float at the surface: spheres remain spheres, others become buoys."""
    return sign if sign.symbol is Symbol.SPHERE else replace(sign, symbol=Symbol.BUOY)


def _parts_of_run(run: list[Piece], cells: Cells, levels: Levels) -> Iterator[ShownPart]:
    first, sign = run[0], _sign(run[0], levels)
    cable = sign.symbol if sign.symbol in LINES else None
    start = first.index - levels.first.index
    length = levels.lengths[start]
    rows = [
        _row(each, cells(QUANTITIES["cut_length"].format(levels.lengths[at]), levels.depths[at]))
        for at, each in enumerate(run, start)
    ]
    labels = tuple(row.label for row in rows)
    if sign.symbol is Symbol.RELEASE and len(run) == 2:
        sign = replace(sign, symbol=Symbol.RELEASE_PAIR)
    elif len(run) > 1:
        sign = replace(sign, count=len(run) * sign.count)
        lengths, *others = rows[0].cells
        figures = f"{len(run)} × {lengths}", *others
        rows = [replace(rows[0], label=together([*labels]), cells=figures)]
    yield ShownPart(sign, tuple(rows), labels, cable, length)
    for clamp in sorted(first.clamps, key=lambda clamp: clamp.at):
        row = _row(clamp, cells(place_text(clamp.at), levels.clamps[clamp.place]))
        yield ShownPart(_sign(clamp, levels), (row,), (row.label,), cable, clamped=True)


def _row(of: Piece | Clamp, cells: tuple[str, ...]) -> TextRow:
    name = one_line(of.component.name or of.use)
    return TextRow(one_line(of.label), name, cells, strong=of.component.role == "instrument")


def _subtitle(file: MooringFile) -> str:
    facts = []
    if file.tow is not None:
        facts.append(f"towed at {say('speed', file.tow.speed)} towards {file.tow.toward:.0f}°")
    if file.environment.depth is not None:
        facts.append(f"{say('depth', file.environment.depth)} of water")
    if file.position is not None:
        latitude, longitude = file.position.latitude, file.position.longitude
        facts.append(f"{abs(latitude):.4f}° {'N' if latitude >= 0.0 else 'S'}")
        facts.append(f"{abs(longitude):.4f}° {'E' if longitude >= 0.0 else 'W'}")
    return " · ".join(facts)


_NOT_TO_SCALE = "Not to scale. Depth and height are given at the upper end of each part,"
_SOLVED = f"{_NOT_TO_SCALE} as solved in the current."
_UPRIGHT = f"{_NOT_TO_SCALE} with the line upright and unstretched."
_UNKNOWN = "Not to scale. Depths are unknown until the line is solved."


@dataclass(frozen=True)
class Levels:
    """Lengths of pieces, and depths of pieces and clamps [m]; NaN if unknown.

    Attributes
    ----------
    lengths, depths : cut length, and depth of the upper end, of each piece
    first : piece at the top of the line
    surface : whether the top piece floats at the surface
    note : explanation of the depths
    """

    lengths: tuple[float, ...]
    depths: tuple[float, ...]
    clamps: Mapping[Place, float]
    first: Piece
    surface: bool
    note: str


def levels_of(file: MooringFile, result: AnyResult | None) -> Levels:
    """Return lengths and depths from a result or, if None, from the upright, unstretched line.

    Without a result, depths are unknown for a tow and for a line that reaches the surface.
    """
    if result is not None:
        return Levels(
            tuple(float(length) for length in result.components.cut_length),
            tuple(float(depth) for depth in result.components.depth_top),
            {clamp.place: clamp.depth for clamp in result.clamps},
            file.pieces[0],
            result.type == "surface",
            _SOLVED,
        )
    known = sum(piece.length for piece in file.pieces if piece.length is not None)
    rest, bottom = math.nan, file.environment.depth
    for piece in file.pieces:
        if piece.fit_top_depth is not None and bottom is not None:
            rest = bottom - piece.fit_top_depth - known
    lengths = tuple(rest if piece.length is None else piece.length for piece in file.pieces)
    depths = (math.nan,) * len(lengths)
    if file.tow is None and bottom is not None:  # upright, above an anchor on the seabed
        heights = list(accumulate(reversed(lengths)))
        depths = tuple(bottom - height for height in reversed(heights))
    top = file.pieces[0].component
    hulled = isinstance(top, Rigid) and not (top.hull is None and top.wind_area is None)
    surface = file.tow is None and (depths[0] <= 0.0 or hulled)
    if surface:
        depths = (math.nan,) * len(depths)
    clamps = {
        clamp.place: depth + clamp.at
        for piece, depth in zip(file.pieces, depths, strict=True)
        for clamp in piece.clamps
    }
    note = _UNKNOWN if math.isnan(depths[0]) else _UPRIGHT
    return Levels(lengths, depths, clamps, file.pieces[0], surface, note)


def place_text(at: float) -> str:
    """Format the distance of a clamp from the upper end of its piece [m] for the length column."""
    return f"at {QUANTITIES['at'].format(at)}"
