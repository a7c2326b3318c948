"""How long the pieces of a schematic are cut, and at what depth they hang."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from typing import TYPE_CHECKING

from calm.files import Place, Rigid

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.files import MooringFile

_NOT_TO_SCALE = "Not to scale. Depth and height: of the upper end,"
_SOLVED = f"{_NOT_TO_SCALE} as solved in the current."
_UPRIGHT = f"{_NOT_TO_SCALE} upright and unstretched."
_UNKNOWN = "Not to scale. Depths are known once the line is solved."


@dataclass(frozen=True)
class Levels:
    """Where the pieces are; NaN where that is unknown.

    Attributes
    ----------
    lengths, depths : tuple of float
        Cut length of each piece, and depth of its upper end [m].
    clamps : mapping
        Depth of each clamped instrument [m].
    surface : bool
        Whether the first piece floats at the surface.
    note : str
        What the depths are.
    """

    lengths: tuple[float, ...]
    depths: tuple[float, ...]
    clamps: Mapping[Place, float]
    surface: bool
    note: str


def levels_of(file: MooringFile, result: Result | TowResult | None) -> Levels:
    """Levels as solved; else of the upright, unstretched line.

    Without a result they are unknown in a tow, and where the line reaches the surface.
    """
    if result is not None:
        return Levels(
            tuple(float(length) for length in result.components.cut_length),
            tuple(float(depth) for depth in result.components.depth_top),
            {clamp.place: clamp.depth for clamp in result.clamps},
            result.type == "surface",
            _SOLVED,
        )
    lengths = _cut_lengths(file)
    depths = _upright(file, lengths)
    surface = file.tow is None and (depths[0] <= 0.0 or _has_a_hull(file))
    if surface:
        depths = (math.nan,) * len(depths)
    clamps = {
        clamp.place: depth + clamp.at
        for piece, depth in zip(file.pieces, depths, strict=True)
        for clamp in piece.clamps
    }
    note = _UNKNOWN if math.isnan(depths[0]) else _UPRIGHT
    return Levels(lengths, depths, clamps, surface, note)


def _cut_lengths(file: MooringFile) -> tuple[float, ...]:
    """As the file gives them; of a piece cut to fit, what is left for it."""
    known = sum(piece.length for piece in file.pieces if piece.length is not None)
    rest = math.nan
    for piece in file.pieces:
        if piece.fit_top_depth is not None and file.environment.depth is not None:
            rest = file.environment.depth - piece.fit_top_depth - known
    return tuple(rest if piece.length is None else piece.length for piece in file.pieces)


def _upright(file: MooringFile, lengths: tuple[float, ...]) -> tuple[float, ...]:
    """Depths of the upper ends above an anchor on the seabed."""
    if file.tow is not None or file.environment.depth is None:
        return (math.nan,) * len(lengths)
    heights = list(accumulate(reversed(lengths)))
    return tuple(file.environment.depth - height for height in reversed(heights))


def _has_a_hull(file: MooringFile) -> bool:
    """Whether the first piece is made to float at the surface."""
    top = file.pieces[0].component
    return isinstance(top, Rigid) and not (top.hull is None and top.wind_area is None)
