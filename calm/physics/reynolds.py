"""Drag coefficients of smooth shapes against Reynolds number, including the drag crisis.

The curves hold for clean, smooth bodies in smooth flow, and CALM uses the curves only for
components declared smooth. Paint, fittings and biofouling shift or remove the crisis. At 0.5 m/s, a
1 m float has Cx = 0.5 to 0.65 in practice, and 0.1 as a smooth sphere.
"""

from dataclasses import dataclass
from functools import cached_property
from math import log, pow, sqrt
from typing import NamedTuple

from calm.physics.drag import LONG_CYLINDER_CN, SPHERE_CX, finite_length_factor, interpolated

# fmt: off
_CYLINDER = (
    # measurements by Wieselsberger; from 3e4 on, 2 to 4 % below DNV's recommendation
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
    # recommendation by DNV; Roshko (1961) found 0.7 above 3.5e6
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01), (3.62e5, 0.894),
    (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327), (6.38e5, 0.284),
    (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539), (2.26e6, 0.584),
    (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
)
_KAPPAS = ((2, 0.80), (5, 0.80), (10, 0.82), (20, 0.90), (40, 0.98), (50, 0.99), (100, 1.00))
# fmt: on
_CYLINDER_AT, _CYLINDER_CN = (
    tuple(log(re) for re, _ in _CYLINDER),
    tuple(cn for _, cn in _CYLINDER),
)
_KAPPA_AT, _KAPPA = (
    tuple(log(slenderness) for slenderness, _ in _KAPPAS),
    tuple(k for _, k in _KAPPAS),
)
# DNV's table of κ has a step at 2e5; CALM interpolates in log Re, so that the drag has no step
_KAPPA_BELOW, _KAPPA_ABOVE = 1.8e5, 2.2e5
_CHANGE = log(_KAPPA_ABOVE / _KAPPA_BELOW)

_CREEPING, _SLOWEST = 0.1, 1.0
_SCAN = 16

LARGEST_SPHERE, LARGEST_CYLINDER = 1e6, 4.94e6
"""Reynolds numbers at the upper ends of the curves; above these, the coefficients are constant."""


def cylinder_coefficient(reynolds: float) -> float:
    """Return the drag coefficient Cn of a long smooth cylinder in flow normal to its axis.

    Parameters
    ----------
    reynolds : Reynolds number |Vn| D/ν [-]; Cn is constant below 3.18 and above 4.94e6

    Source: Wieselsberger's measurements (NACA report 121) up to Re = 1.61e5; DNV-RP-C205, figure
    6-6, smooth, from Re = 2.1e5; linear in log Re from 1.61e5 to 2.1e5.
    """
    return interpolated(_CYLINDER_AT, _CYLINDER_CN, log(max(reynolds, _SLOWEST)))


def sphere_coefficient(reynolds: float) -> float:
    """Return the drag coefficient Cx of a smooth sphere.

    Parameters
    ----------
    reynolds : Reynolds number |V| D/ν [-]; Cx is constant below 0.1 and above 1e6

    Source: F. A. Morrison, Data correlation for drag coefficient for sphere, Michigan Technological
    University, 2016.
    """
    re = min(max(reynolds, _CREEPING), LARGEST_SPHERE)
    intermediate, crisis, beyond = re / 5.0, re / 2.63e5, re / 1e6
    squared = crisis * crisis
    eighth = squared * squared * squared * squared
    return (
        24.0 / re
        + 2.6 * intermediate / (1.0 + pow(intermediate, 1.52))
        # crisis^-7.94 / (1 + crisis^-8), free of overflow at small Re
        + 0.411 * pow(crisis, 0.06) / (1.0 + eighth)
        + 0.25 * beyond / (1.0 + beyond)
    )


class Smooth(NamedTuple):
    """Properties that determine the drag of a smooth sphere or cylinder in water.

    Attributes
    ----------
    reynolds : Reynolds number at 1 m/s [-]
    lengthening : for a cylinder, ratio of the length factors κ above and below the drag crisis; 0
        for a sphere
    """

    reynolds: float
    lengthening: float


def drag_variation(smooth: Smooth, speed: float) -> float:
    """Return the ratio of the drag at a normal speed [m/s] to the drag with a constant coefficient.

    The constant coefficient is Cx = 0.5 for a sphere and Cn = 1.2 κ for a cylinder.
    """
    reynolds = smooth.reynolds * speed
    if smooth.lengthening == 0.0:
        return sphere_coefficient(reynolds) / SPHERE_CX
    factor = cylinder_coefficient(reynolds) / LONG_CYLINDER_CN
    if reynolds <= _KAPPA_BELOW:
        return factor
    if reynolds >= _KAPPA_ABOVE:
        return factor * smooth.lengthening
    fraction = log(reynolds / _KAPPA_BELOW) / _CHANGE
    return factor * (1.0 + (smooth.lengthening - 1.0) * fraction)


def varying_share(
    ax: float, ay: float, az: float, k: float, smooth: Smooth, vx: float, vy: float, vz: float
) -> float:
    """Return the factor c of `drag_share` for a smooth element, whose drag varies with speed.

    c = k f(s) s [N/(m/s)], where the normal speed s is the smallest root of
    s |A + k f(s) s V| = |V × A|. This root applies to a current that increases from rest. Roots
    less than |V|/16 apart are not distinguished.

    Parameters
    ----------
    k : half the normal drag factor of the element for f = 1 [N/(m/s)²]
    smooth : properties of the element, from which `drag_variation` gives f > 0
    """
    speed = sqrt(vx * vx + vy * vy + vz * vz)
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    if k == 0.0 or across == 0.0:
        return 0.0
    low, below, side = 0.0, -across, 0
    high, above = speed, 0.0
    for i in range(1, _SCAN + 1):
        high = speed * i / _SCAN
        above = _turned(ax, ay, az, k * drag_variation(smooth, high), high, vx, vy, vz) - across
        if above >= 0.0:
            break
        if i < _SCAN:
            low, below = high, above
    above = max(above, 0.0)  # at |V| it may be below by rounding
    s = low
    for _ in range(100):
        s = (low * above - high * below) / (above - below)
        found = _turned(ax, ay, az, k * drag_variation(smooth, s), s, vx, vy, vz) - across
        if abs(found) <= 1e-14 * across:
            break
        # the secant stays on one side of the root unless the value at the other end is reduced
        if found > 0.0:
            high, above, below = s, found, below * (0.5 if side > 0 else 1.0)
            side = 1
        else:
            low, below, above = s, found, above * (0.5 if side < 0 else 1.0)
            side = -1
    return k * drag_variation(smooth, s) * s


def _turned(
    ax: float, ay: float, az: float, k: float, s: float, vx: float, vy: float, vz: float
) -> float:
    c = k * s
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    return s * sqrt(x * x + y * y + z * z)


@dataclass(frozen=True)
class DragCurve:
    """Drag of a smooth sphere or cylinder as a function of Reynolds number.

    Attributes
    ----------
    diameter : diameter of the body [m]
    slenderness : length over diameter of a cylinder [-]; None for a sphere
    """

    diameter: float
    slenderness: float | None = None

    @property
    def largest_reynolds(self) -> float:
        """Largest Reynolds number of the curve."""
        return LARGEST_SPHERE if self.slenderness is None else LARGEST_CYLINDER

    def factor(self, reynolds: float) -> float:
        """Return the drag at a Reynolds number divided by the drag with a constant coefficient."""
        return drag_variation(Smooth(reynolds, self.lengthening), 1.0)

    @cached_property
    def lengthening(self) -> float:
        """Ratio of the length factor κ above the drag crisis to κ below the crisis."""
        if self.slenderness is None:
            return 0.0
        below = finite_length_factor(self.slenderness)
        return finite_length_factor_above(self.slenderness) / below


def finite_length_factor_above(slenderness: float) -> float:
    """Return the length factor κ of a cylinder above the drag crisis, for Re of at least 2.2e5.

    κ is linear in log(L/D) between the points of a table, and constant for L/D below 2 and above
    100. `slenderness` is L/D.

    Source: DNV-RP-C205, table 6-2, for Re above 2e5.
    """
    return interpolated(_KAPPA_AT, _KAPPA, log(max(slenderness, 1.0)))
