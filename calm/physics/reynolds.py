"""Drag coefficients of smooth shapes against Reynolds number, drag crisis included.

They hold for clean, smooth bodies in smooth flow. Paint, fittings and growth move the crisis or
remove it: a 1 m float in 0.5 m/s comes out at Cx = 0.1 as a smooth sphere, where 0.5 to 0.65 is
used for real ones. So nothing takes these curves unless it is declared smooth.
"""

from __future__ import annotations

from bisect import bisect_right
from math import log, pow


class _Curve:
    """Points joined by straight lines over the logarithm of x, and held beyond both ends."""

    __slots__ = ("_first", "_last", "_logarithms", "_values")

    def __init__(self, *points: tuple[float, float]) -> None:
        self._first, self._last = points[0][0], points[-1][0]
        self._logarithms = [log(x) for x, _ in points]
        self._values = [y for _, y in points]

    def __call__(self, x: float) -> float:
        values = self._values
        if x <= self._first:
            return values[0]
        if x >= self._last:
            return values[-1]
        position, logarithms = log(x), self._logarithms
        i = bisect_right(logarithms, position, 1, len(logarithms) - 1) - 1
        share = (position - logarithms[i]) / (logarithms[i + 1] - logarithms[i])
        return values[i] + share * (values[i + 1] - values[i])


# fmt: off
_WIESELSBERGER_BELOW_THE_CRISIS = (
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
)
_WIESELSBERGER_CRISIS = (
    (2.20e5, 1.06), (2.93e5, 0.910), (3.65e5, 0.726), (4.27e5, 0.547), (4.90e5, 0.337),
    (5.03e5, 0.302), (6.28e5, 0.318), (8.10e5, 0.355),
)
_DNV_CRISIS = (
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01), (3.62e5, 0.894),
    (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327), (6.38e5, 0.284),
    (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539), (2.26e6, 0.584),
    (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
)
_KAPPA_BELOW = _Curve(
    (1, 0.52), (2, 0.58), (5, 0.62), (10, 0.68), (20, 0.74), (40, 0.82), (50, 0.87), (100, 0.98)
)
_KAPPA_ABOVE = _Curve(
    (2, 0.80), (5, 0.80), (10, 0.82), (20, 0.90), (40, 0.98), (50, 0.99), (100, 1.00)
)
# fmt: on
_WIESELSBERGER = _Curve(*_WIESELSBERGER_BELOW_THE_CRISIS, *_WIESELSBERGER_CRISIS)
_DNV = _Curve((1e4, 1.21), *_DNV_CRISIS)
_CYLINDER = _Curve(*_WIESELSBERGER_BELOW_THE_CRISIS, *_DNV_CRISIS)

_KAPPA_CHANGES = (1.8e5, 2.2e5)
_CHANGE = log(_KAPPA_CHANGES[1] / _KAPPA_CHANGES[0])

_CREEPING = 0.1
_MORRISON_END = 1e6


def wieselsberger_cylinder(reynolds: float) -> float:
    """Cn of a long smooth cylinder, as measured: Re 3.18 to 8.1e5, held outside.

    Source: Wieselsberger's measurements (NACA report 121), 24 points read from his curve, joined
    linearly in log Re.
    """
    return _WIESELSBERGER(reynolds)


def dnv_cylinder(reynolds: float) -> float:
    """Cn of a long smooth cylinder, as recommended: Re 1e4 to 4.94e6, held outside.

    Source: DNV-RP-C205, figure 6-6, smooth curve, read at 19 points and flat below 2.1e5, joined
    linearly in log Re. Roshko (1961) found 0.7 above 3.5e6, where this comes to 0.65 to 0.68.
    """
    return _DNV(reynolds)


def cylinder_coefficient(reynolds: float) -> float:
    """Cn of a long smooth cylinder in flow across its axis.

    Parameters
    ----------
    reynolds : |Vn| D/ν [-]; held below 3.18, where drag no longer matters, and above 4.94e6

    Wieselsberger's measurements up to 1.61e5 (Cn 1.18), DNV's recommendation from 2.1e5 (1.21), a
    straight join between. From 3e4 to 1.61e5 the measurements lie 2 to 4 % below the
    recommendation. In the crisis the latter falls later, to the safe side, and goes on to higher
    Re, so there it is the one taken.
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
    re = min(max(reynolds, _CREEPING), _MORRISON_END)
    intermediate, crisis, beyond = re / 5.0, re / 2.63e5, re / 1e6
    return (
        24.0 / re
        + 2.6 * intermediate / (1.0 + pow(intermediate, 1.52))
        # crisis^-7.94 / (1 + crisis^-8), free of overflow at small Re
        + 0.411 * pow(crisis, 0.06) / (1.0 + crisis**8)
        + 0.25 * beyond / (1.0 + beyond)
    )


def finite_length_factor(slenderness: float, reynolds: float = 0.0) -> float:
    """κ, by which a finite cylinder's drag falls short of the long one's.

    Parameters
    ----------
    slenderness : length over diameter [-]; linear in its logarithm between the table's points,
        constant below 1 (above the crisis: below 2) and above 100
    reynolds : |Vn| D/ν [-]; below 1.8e5 the table's column for Re < 2e5, above 2.2e5 that for
        Re > 2e5, linear in log Re between them so that drag has no step

    Source: DNV-RP-C205, table 6-2; Wieselsberger (NACA report 121) below L/D = 2 and Re = 2e5.
    """
    below = _KAPPA_BELOW(slenderness)
    if reynolds <= _KAPPA_CHANGES[0]:
        return below
    above = _KAPPA_ABOVE(slenderness)
    if reynolds >= _KAPPA_CHANGES[1]:
        return above
    return below + (above - below) * log(reynolds / _KAPPA_CHANGES[0]) / _CHANGE
