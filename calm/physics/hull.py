"""A float at the surface: how deep it sits, and how much of it current and wind see."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import acos, asin, isnan, nan, pi, sin, sqrt
from typing import NamedTuple

AIR_DENSITY = 1.225
"""Of the air above the water [kg/m³]: the standard atmosphere at sea level."""

AWASH = 0.02
"""Share of the buoyancy in reserve below which a float goes awash: what stands out of it goes under
with the rest, so that nothing jumps when the line pulls it under."""

SPHERE, SPAR, TABULATED = range(3)
"""The forms of a hull."""


class HullRow(NamedTuple):
    """A row of a hull's table: draft [m], displaced volume [m³] and immersed area [m²]."""

    draft: float
    volume: float
    area: float


@dataclass(frozen=True)
class Hull:
    """A hull afloat and upright.

    Attributes
    ----------
    height : keel to top [m]
    area : of all of it, seen from the side [m²]
    form : SPHERE, SPAR or TABULATED
    rows : of a tabulated one
    """

    height: float
    area: float
    form: int
    rows: tuple[HullRow, ...] = ()

    def curve(self, share: float) -> tuple[float, float]:
        """Draft and immersed area, as shares of the whole, by the share of the volume immersed."""
        return immersed_shares(self.form, self.rows, share)


def spherical_hull(diameter: float) -> Hull:
    """A sphere of a diameter [m]: a draft of x diameters immerses x² (3 - 2x) of its volume."""
    return Hull(diameter, pi * diameter**2 / 4, SPHERE)


def cylindrical_hull(diameter: float, length: float) -> Hull:
    """An upright cylinder, a spar, of a diameter and length [m]."""
    return Hull(length, diameter * length, SPAR)


def tabulated_hull(rows: Sequence[tuple[float, float, float]]) -> Hull:
    """A hull by rows of draft [m], displaced volume [m³] and immersed area [m²], all growing.

    Linear between the rows and from nothing to the first; the last is the whole hull.

    Raises
    ------
    ValueError
        Drafts or volumes that do not grow, areas that fall.
    """
    if not rows:
        raise ValueError("the table of a hull has no rows")
    keel = () if rows[0][0] == 0.0 else ((0.0, 0.0, 0.0),)
    table = tuple(HullRow(*map(float, row)) for row in (*keel, *rows))
    for name in ("draft", "volume"):
        if any(getattr(b, name) <= getattr(a, name) for a, b in pairwise(table)):
            raise ValueError(f"the {name} must grow from row to row")
    if any(b.area < a.area for a, b in pairwise(table)) or len(table) < 2:
        raise ValueError("the area must not fall from row to row, and one row is not enough")
    return Hull(table[-1].draft, table[-1].area, TABULATED, table)


def immersed_shares(form: int, rows: Sequence[HullRow], share: float) -> tuple[float, float]:
    """Draft and immersed area of a hull, as shares of the whole.

    Parameters
    ----------
    form, rows : as in `Hull`
    share : of the hull's volume that is immersed, 0 to 1
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
    way = (volume - rows[i - 1].volume) / (rows[i].volume - rows[i - 1].volume)
    draft = rows[i - 1].draft + way * (rows[i].draft - rows[i - 1].draft)
    area = rows[i - 1].area + way * (rows[i].area - rows[i - 1].area)
    whole = rows[last].area
    return draft / rows[last].draft, area / whole if whole > 0.0 else share


class Riding(NamedTuple):
    """Tell how a float rides at the surface.

    Attributes
    ----------
    draft, freeboard : [m]; NaN where its hull is not known
    standing : share of the float's length out of the water
    above : share of what is rigid with the float above it that is out of the water
    drag : there over that below the surface
    push_east, push_north : of the wind [N]
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
        """Both parts of the push of the wind [N]."""
        return self.push_east, self.push_north


@dataclass(frozen=True)
class Floating:
    """Hold what a float is besides its buoyancy, for when it is at the surface.

    Attributes
    ----------
    hull : its form; None where it is not known, and then its draft is not either
    weight : in air [N]
    lift : net force when it is all immersed [N]
    surface_drag : drag afloat over drag below, where it is given; else that of the immersed area
    wind : to the east and north [m/s]
    wind_area : in the air [m²], where it is given; else what of the hull is not immersed
    wind_cd : drag coefficient of that area
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
        """Return whether there is any wind."""
        return self.wind != (0.0, 0.0)

    def riding(self, used: float) -> Riding:
        """Return how it rides with a share of its net buoyancy in use, 0 to 1."""
        return riding_of(self.as_numbers, self.hull.rows if self.hull else (), used)

    @property
    def as_numbers(self) -> SurfaceFloat:
        """Return the same as the solver takes it."""
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
    """A `Floating` as numbers: `form` is that of its hull, and what is not given is NaN."""

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


NEVER_AFLOAT = SurfaceFloat(UNKNOWN_HULL, nan, 0.0, 0.0, 1.0, nan, 0.0, 0.0, nan, 1.0)
"""In place of a float of which nothing is known."""


def riding_of(floats: SurfaceFloat, rows: Sequence[HullRow], used: float) -> Riding:
    """Return how a float rides with a share of its net buoyancy in use, 0 to 1.

    The displaced water carries the weight and what the line pulls, so the share of the volume
    immersed is (weight + used lift)/(weight + lift). `rows` are those of its hull.
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
