"""Float at the surface: its draft, and the areas exposed to current and wind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import acos, asin, isnan, nan, pi, sin, sqrt
from typing import NamedTuple

AIR_DENSITY = 1.225
"""Density of the air above the water [kg/m³], from the standard atmosphere at sea level."""

AWASH = 0.02
"""Fraction of unused buoyancy at which the parts above the surface begin to submerge.

The parts submerge gradually as the unused buoyancy falls to zero. This avoids a jump of the drag
when the line pulls the float under.
"""

SPHERE, SPAR, TABULATED = range(3)
"""Kinds of hulls."""


class HullRow(NamedTuple):
    """One row of a hull table: draft [m], displaced volume [m³] and immersed area [m²]."""

    draft: float
    volume: float
    area: float


@dataclass(frozen=True)
class Hull:
    """Hull of a float that is upright at the surface.

    Attributes
    ----------
    height : height from keel to top [m]
    area : lateral area of the whole hull [m²]
    form : SPHERE, SPAR or TABULATED
    rows : hull table of a TABULATED hull
    """

    height: float
    area: float
    form: int
    rows: tuple[HullRow, ...] = ()

    def curve(self, share: float) -> tuple[float, float]:
        """Return draft and immersed lateral area, as fractions of the values for the whole hull.

        `share` is the immersed fraction of the volume.
        """
        return immersed_shares(self.form, self.rows, share)


def spherical_hull(diameter: float) -> Hull:
    """Return a spherical hull with a given diameter [m].

    A draft of x diameters immerses the fraction x² (3 - 2x) of the volume.
    """
    return Hull(diameter, pi * diameter**2 / 4, SPHERE)


def cylindrical_hull(diameter: float, length: float) -> Hull:
    """Return the hull of a spar (an upright cylinder) with a given diameter and length [m]."""
    return Hull(length, diameter * length, SPAR)


def tabulated_hull(rows: Sequence[tuple[float, float, float]]) -> Hull:
    """Return a hull from rows of draft [m], displaced volume [m³] and immersed area [m²].

    Values are interpolated linearly between zero, the first row, and the following rows. The last
    row describes the completely immersed hull.

    Raises
    ------
    ValueError
        Drafts or volumes do not increase from row to row, or areas decrease.
    """
    if not rows:
        raise ValueError("the table of a hull has no rows")
    keel = () if rows[0][0] == 0.0 else ((0.0, 0.0, 0.0),)
    table = tuple(HullRow(*map(float, row)) for row in (*keel, *rows))
    for name in ("draft", "volume"):
        if any(getattr(b, name) <= getattr(a, name) for a, b in pairwise(table)):
            raise ValueError(f"the {name} must increase from row to row")
    if any(b.area < a.area for a, b in pairwise(table)) or len(table) < 2:
        raise ValueError(
            "the area must not decrease from row to row, and at least two rows are needed"
        )
    return Hull(table[-1].draft, table[-1].area, TABULATED, table)


def immersed_shares(form: int, rows: Sequence[HullRow], share: float) -> tuple[float, float]:
    """Return draft and immersed lateral area, as fractions of the values for the whole hull.

    Parameters
    ----------
    form, rows : as in `Hull`
    share : immersed fraction of the hull's volume, 0 to 1
    """
    if form == SPHERE:
        x = 0.5 - sin(asin(1.0 - 2.0 * share) / 3.0)
        cosine = 1.0 - 2.0 * x
        return x, (acos(cosine) - 2.0 * cosine * sqrt(max(x * (1.0 - x), 0.0))) / pi
    if form == SPAR:
        return share, share
    last = len(rows) - 1
    volume = rows[0].volume + share * (rows[last].volume - rows[0].volume)
    i = 1
    while i < last and rows[i].volume <= volume:
        i += 1
    part = (volume - rows[i - 1].volume) / (rows[i].volume - rows[i - 1].volume)
    draft = rows[i - 1].draft + part * (rows[i].draft - rows[i - 1].draft)
    area = rows[i - 1].area + part * (rows[i].area - rows[i - 1].area)
    whole = rows[last].area
    return draft / rows[last].draft, area / whole if whole > 0.0 else share


class Riding(NamedTuple):
    """Draft of a float at the surface, and the forces on the float there.

    Attributes
    ----------
    draft, freeboard : draft and freeboard [m]; NaN if the hull is unknown
    standing : fraction of the float's height above the water
    above : emerged fraction of the pieces that are rigidly connected above the float, 0 to 1
    drag : drag at the surface divided by the drag when fully immersed
    push_east, push_north : wind force [N]
    """

    draft: float
    freeboard: float
    standing: float
    above: float
    drag: float
    push_east: float
    push_north: float

    @property
    def push(self) -> tuple[float, float]:
        """East and north component of the wind force [N]."""
        return self.push_east, self.push_north


@dataclass(frozen=True)
class Floating:
    """Surface properties of a float, in addition to its buoyancy.

    Attributes
    ----------
    hull : hull of the float; None if the draft is unknown
    weight : weight in air [N]
    lift : net buoyancy when fully immersed [N]
    surface_drag : drag at the surface divided by the drag when fully immersed; if None, the
        immersed fraction of the lateral area
    wind : wind velocity to the east and north [m/s]
    wind_area : area exposed to the wind [m²]; if None, the emerged lateral area of the hull
    wind_cd : drag coefficient of the area exposed to the wind
    """

    hull: Hull | None
    weight: float
    lift: float
    surface_drag: float | None = None
    wind: tuple[float, float] = (0.0, 0.0)
    wind_area: float | None = None
    wind_cd: float = 1.0

    @property
    def blown(self) -> bool:
        """Whether the wind speed is not zero."""
        return self.wind != (0.0, 0.0)

    def riding(self, used: float) -> Riding:
        """Compute the draft of the float at the surface, and the forces on the float.

        `used` is as in `riding_of`.
        """
        return riding_of(self.as_numbers, self.hull.rows if self.hull else (), used)

    @property
    def as_numbers(self) -> SurfaceFloat:
        """The float as a `SurfaceFloat`, which holds plain numbers for the solver."""
        form, height, area = UNKNOWN_HULL, nan, 0.0
        if self.hull is not None:
            form, height, area = self.hull.form, self.hull.height, self.hull.area
        return SurfaceFloat(
            form=form,
            height=height,
            area=area,
            weight=self.weight,
            lift=self.lift,
            surface_drag=nan if self.surface_drag is None else self.surface_drag,
            wind_east=self.wind[0],
            wind_north=self.wind[1],
            wind_area=nan if self.wind_area is None else self.wind_area,
            wind_cd=self.wind_cd,
        )


UNKNOWN_HULL = -1


class SurfaceFloat(NamedTuple):
    """A `Floating` in the form of plain numbers.

    `form` is the form of the hull. Values that are not specified are NaN.
    """

    form: int
    height: float
    area: float
    weight: float
    lift: float
    surface_drag: float
    wind_east: float
    wind_north: float
    wind_area: float
    wind_cd: float


UNKNOWN_FLOAT = SurfaceFloat(UNKNOWN_HULL, nan, 0.0, 0.0, 1.0, nan, 0.0, 0.0, nan, 1.0)
"""Placeholder for a float with unknown properties."""


def riding_of(floats: SurfaceFloat, rows: Sequence[HullRow], used: float) -> Riding:
    """Compute the draft of a float at the surface, and the forces on the float.

    The immersed fraction of the hull's volume is (weight + used · lift)/(weight + lift).

    Parameters
    ----------
    rows : rows of the hull table of the float
    used : downward pull of the line divided by the net buoyancy of the immersed float, 0 to 1
    """
    above = min((1.0 - used) / AWASH, 1.0)
    draft, seen, height, area = 1.0, 1.0, nan, 0.0
    if floats.form != UNKNOWN_HULL:
        immersed = (floats.weight + used * floats.lift) / (floats.weight + floats.lift)
        draft, seen = immersed_shares(floats.form, rows, min(max(immersed, 0.0), 1.0))
        height, area = floats.height, floats.area * (1.0 - seen)
    if not isnan(floats.surface_drag):
        seen = 1.0 + (floats.surface_drag - 1.0) * above
    if not isnan(floats.wind_area):
        area = floats.wind_area * above
    east, north = floats.wind_east, floats.wind_north
    pressure = 0.5 * AIR_DENSITY * floats.wind_cd * area * sqrt(east * east + north * north)
    return Riding(
        draft * height,
        (1.0 - draft) * height,
        1.0 - draft,
        above,
        seen,
        pressure * east,
        pressure * north,
    )
