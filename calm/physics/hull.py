"""A float at the surface: how deep it sits, and how much of it current and wind see."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import acos, asin, hypot, nan, pi, sin, sqrt

AIR_DENSITY = 1.225
"""Of the air above the water [kg/m³]: the standard atmosphere at sea level."""

AWASH = 0.02
"""Share of the buoyancy in reserve below which a float goes awash: what stands out of it goes under
with the rest, so that nothing jumps when the line pulls it under."""

Curve = Callable[[float], tuple[float, float]]
"""From the share of a hull's volume that is immersed, 0 to 1, to its draft and its immersed area
seen from the side, as shares of the whole."""


@dataclass(frozen=True)
class Hull:
    """A hull afloat and upright.

    Attributes
    ----------
    height : keel to top [m]
    area : of all of it, seen from the side [m²]
    curve : see `Curve`
    """

    height: float
    area: float
    curve: Curve


def spherical_hull(diameter: float) -> Hull:
    """A sphere of a diameter [m]: a draft of x diameters immerses x² (3 - 2x) of its volume."""

    def curve(share: float) -> tuple[float, float]:
        x = 0.5 - sin(asin(1.0 - 2.0 * share) / 3.0)
        cosine = 1.0 - 2.0 * x
        return x, (acos(cosine) - 2.0 * cosine * sqrt(max(x * (1.0 - x), 0.0))) / pi

    return Hull(diameter, pi * diameter**2 / 4, curve)


def cylindrical_hull(diameter: float, length: float) -> Hull:
    """An upright cylinder, a spar, of a diameter and length [m]."""
    return Hull(length, diameter * length, lambda share: (share, share))


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
    drafts, volumes, areas = (list(column) for column in zip(*keel, *rows, strict=True))
    for name, column in (("draft", drafts), ("volume", volumes)):
        if any(b <= a for a, b in pairwise(column)):
            raise ValueError(f"the {name} must grow from row to row")
    if any(b < a for a, b in pairwise(areas)) or len(drafts) < 2:
        raise ValueError("the area must not fall from row to row, and one row is not enough")

    def curve(share: float) -> tuple[float, float]:
        volume = volumes[0] + share * (volumes[-1] - volumes[0])
        i = min(bisect_right(volumes, volume), len(volumes) - 1)
        way = (volume - volumes[i - 1]) / (volumes[i] - volumes[i - 1])
        draft = drafts[i - 1] + way * (drafts[i] - drafts[i - 1])
        area = areas[i - 1] + way * (areas[i] - areas[i - 1])
        return draft / drafts[-1], area / areas[-1] if areas[-1] > 0.0 else share

    return Hull(drafts[-1], areas[-1], curve)


@dataclass(frozen=True)
class Riding:
    """How a float rides at the surface.

    Attributes
    ----------
    draft, freeboard : [m]; NaN where its hull is not known
    standing : share of the float's length out of the water
    above : share of what is rigid with the float above it that is out of the water
    drag : there over that below the surface
    push : of the wind to the east and north [N]
    """

    draft: float
    freeboard: float
    standing: float
    above: float
    drag: float
    push: tuple[float, float]


@dataclass(frozen=True)
class Floating:
    """What a float is besides its buoyancy, for when it is at the surface.

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
        """Whether there is any wind."""
        return self.wind != (0.0, 0.0)

    def riding(self, used: float) -> Riding:
        """How it rides with a share of its net buoyancy in use, 0 to 1.

        The displaced water carries the weight and what the line pulls, so the share of the volume
        immersed is (weight + used lift)/(weight + lift).
        """
        above = min((1.0 - used) / AWASH, 1.0)
        draft, seen, height, area = 1.0, 1.0, nan, 0.0
        if self.hull is not None:
            immersed = (self.weight + used * self.lift) / (self.weight + self.lift)
            draft, seen = self.hull.curve(min(max(immersed, 0.0), 1.0))
            height, area = self.hull.height, self.hull.area * (1.0 - seen)
        if self.surface_drag is not None:
            seen = 1.0 + (self.surface_drag - 1.0) * above
        if self.wind_area is not None:
            area = self.wind_area * above
        east, north = self.wind
        pressure = 0.5 * AIR_DENSITY * self.wind_cd * area * hypot(east, north)
        return Riding(
            draft=draft * height,
            freeboard=(1.0 - draft) * height,
            standing=1.0 - draft,
            above=above,
            drag=seen,
            push=(pressure * east, pressure * north),
        )
