"""The few figures by which two solutions of a mooring are compared."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING

from calm.case.columns import ClampRow, ComponentRow
from calm.files import Place

if TYPE_CHECKING:
    from calm.case.result import Result


@dataclass(frozen=True)
class Spot:
    """One piece (its upper end) or clamped instrument of a result.

    Attributes
    ----------
    depth, excursion, knockdown : [m]; knockdown is None where still water has no unique shape
    tilt : from the vertical [degrees]
    tension : the greatest in it [N]
    """

    depth: float
    excursion: float
    knockdown: float | None
    tilt: float
    tension: float


def spot_of(result: Result, place: Place | None = None) -> Spot:
    """What a result says of the part at a place; of the top of the line where none is given."""
    row: ComponentRow | ClampRow = result.components[0]
    if place is not None:
        row = next(row for row in (*result.components, *result.clamps) if row.place == place)
    if isinstance(row, ComponentRow):
        depth, x, y = row.depth_top, row.x_top, row.y_top
    else:
        depth, x, y = row.depth, row.x, row.y
    known = row.knockdown == row.knockdown
    return Spot(depth, hypot(x, y), row.knockdown if known else None, row.tilt, row.tension)


@dataclass(frozen=True)
class Figures:
    """A solved mooring in eight numbers: lengths [m], forces [N].

    Attributes
    ----------
    depth, knockdown, excursion : of the line's top or another part of it
    used_buoyancy : share in use of the buoyancy at the surface, 1 below it
    tension, vertical, horizontal, required_weight : of the anchor
    """

    depth: float
    knockdown: float | None
    excursion: float
    used_buoyancy: float
    tension: float
    vertical: float
    horizontal: float
    required_weight: float


def figures_of(result: Result, place: Place | None = None) -> Figures:
    """The figures of a result; those of the line are of the part at a place, by default the top."""
    spot = spot_of(result, place)
    return Figures(
        depth=spot.depth,
        knockdown=spot.knockdown,
        excursion=spot.excursion,
        used_buoyancy=result.top.used_buoyancy,
        tension=result.anchor.tension,
        vertical=result.anchor.vertical,
        horizontal=result.anchor.horizontal,
        required_weight=result.anchor.required_weight,
    )
