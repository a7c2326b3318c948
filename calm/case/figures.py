"""The few figures by which two solutions of a mooring are compared."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING

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


def spot_of(result: Result, label: str) -> Spot:
    """What a result says of the piece or clamp of this label."""
    components, clamps = result.components, result.clamps
    if label in components.label:
        row = components[components.label.index(label)]
        depth, x, y = row.depth_top, row.x_top, row.y_top
    else:
        row = clamps[clamps.label.index(label)]
        depth, x, y = row.depth, row.x, row.y
    known = row.knockdown == row.knockdown
    return Spot(depth, hypot(x, y), row.knockdown if known else None, row.tilt, row.tension)


@dataclass(frozen=True)
class Figures:
    """A mooring in eight numbers: lengths [m], forces [N].

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


def figures_of(result: Result, label: str | None = None) -> Figures:
    """The figures of a result, those of the line for the part of this label (the top)."""
    spot = spot_of(result, label or result.components.label[0])
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
