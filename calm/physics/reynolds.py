"""Drag coefficients of smooth shapes against Reynolds number, drag crisis included.

They hold for clean, smooth bodies in smooth flow. Paint, fittings and growth move the crisis or
remove it: a 1 m float in 0.5 m/s comes out at Cx = 0.1 as a smooth sphere, where 0.5 to 0.65 is
used for real ones. So nothing takes these curves unless it is declared smooth.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from math import log, pow

from calm.physics import drag


class _Curve:
    """Points joined by straight lines over the logarithm of x, and held beyond both ends."""

    __slots__ = ("_logarithms", "_values")

    def __init__(self, *points: tuple[float, float]) -> None:
        self._logarithms = [log(x) for x, _ in points]
        self._values = [y for _, y in points]

    def __call__(self, x: float) -> float:
        values, logarithms = self._values, self._logarithms
        position = log(x) if x > 0.0 else logarithms[0]
        if position <= logarithms[0]:
            return values[0]
        if position >= logarithms[-1]:
            return values[-1]
        i = bisect_right(logarithms, position) - 1
        share = (position - logarithms[i]) / (logarithms[i + 1] - logarithms[i])
        return values[i] + share * (values[i + 1] - values[i])


# fmt: off
_CYLINDER = _Curve(
    # Wieselsberger, as measured
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
    # DNV, as recommended
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01), (3.62e5, 0.894),
    (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327), (6.38e5, 0.284),
    (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539), (2.26e6, 0.584),
    (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
)
_KAPPA_ABOVE = _Curve(
    (2, 0.80), (5, 0.80), (10, 0.82), (20, 0.90), (40, 0.98), (50, 0.99), (100, 1.00)
)
# fmt: on
_KAPPA_CHANGES = (1.8e5, 2.2e5)
_CHANGE = log(_KAPPA_CHANGES[1] / _KAPPA_CHANGES[0])

_CREEPING = 0.1

LARGEST_SPHERE, LARGEST_CYLINDER = 1e6, 4.94e6
"""Reynolds numbers where the curves end; beyond, they are held."""


def cylinder_coefficient(reynolds: float) -> float:
    """Cn of a long smooth cylinder in flow across its axis.

    Parameters
    ----------
    reynolds : |Vn| D/ν [-]; held below 3.18, where drag no longer matters, and above 4.94e6

    Wieselsberger's measurements (NACA report 121) up to 1.61e5, where Cn is 1.18, DNV's
    recommendation (DNV-RP-C205, figure 6-6, smooth) from 2.1e5, where it is 1.21, joined linearly
    in log Re. From 3e4 to 1.61e5 the measurements lie 2 to 4 % below the recommendation. In the
    crisis the latter falls later, to the safe side, and goes on to higher Re, so there it is the
    one taken. Roshko (1961) found 0.7 above 3.5e6, where this comes to 0.65 to 0.68.
    """
    return _CYLINDER(reynolds)


def sphere_coefficient(reynolds: float) -> float:
    """Cx of a smooth sphere.

    Parameters
    ----------
    reynolds : |V| D/ν [-], up to 1e6; held above it, and below 0.1, where drag no longer matters

    Source: F. A. Morrison, Data correlation for drag coefficient for sphere (Michigan
    Technological University, 2016), whose author advises Re < 1e6.
    """
    re = min(max(reynolds, _CREEPING), LARGEST_SPHERE)
    intermediate, crisis, beyond = re / 5.0, re / 2.63e5, re / 1e6
    return (
        24.0 / re
        + 2.6 * intermediate / (1.0 + pow(intermediate, 1.52))
        # crisis^-7.94 / (1 + crisis^-8), free of overflow at small Re
        + 0.411 * pow(crisis, 0.06) / (1.0 + crisis**8)
        + 0.25 * beyond / (1.0 + beyond)
    )


@dataclass(frozen=True)
class DragCurve:
    """How the drag of a smooth sphere or cylinder goes with the Reynolds number.

    Attributes
    ----------
    diameter : [m]
    slenderness : length over diameter of a cylinder [-]; None of a sphere
    """

    diameter: float
    slenderness: float | None = None

    @property
    def largest_reynolds(self) -> float:
        """The Reynolds number up to which the curve is known."""
        return LARGEST_SPHERE if self.slenderness is None else LARGEST_CYLINDER

    def factor(self, reynolds: float) -> float:
        """Drag across the axis over that by the constant coefficient, Cx = 0.5 or Cn = 1.2 κ."""
        if self.slenderness is None:
            return sphere_coefficient(reynolds) / drag.SPHERE_CX
        return cylinder_coefficient(reynolds) / drag.LONG_CYLINDER_CN * self._lengthening(reynolds)

    def _lengthening(self, reynolds: float) -> float:
        """κ over that below the crisis."""
        if reynolds <= _KAPPA_CHANGES[0]:
            return 1.0
        if reynolds >= _KAPPA_CHANGES[1]:
            return self._lengthened
        return 1.0 + (self._lengthened - 1.0) * log(reynolds / _KAPPA_CHANGES[0]) / _CHANGE

    @cached_property
    def _lengthened(self) -> float:
        assert self.slenderness is not None
        below = drag.finite_length_factor(self.slenderness)
        return finite_length_factor_above(self.slenderness) / below


def finite_length_factor_above(slenderness: float) -> float:
    """κ above the crisis, from Re = 2.2e5; up to 1.8e5 `drag.finite_length_factor` holds.

    Parameters
    ----------
    slenderness : length over diameter [-]; linear in its logarithm between the table's points,
        constant below 2 and above 100

    Source: DNV-RP-C205, table 6-2, whose columns change at 2e5. Between the two κ is linear in
    log Re here, so that drag has no step.
    """
    return _KAPPA_ABOVE(slenderness)
