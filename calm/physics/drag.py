"""Drag coefficients by shape, independent of Reynolds number, and tangential drag laws of cables.

Functions for shapes return the drag at 1 m/s in sea water of 1025 kg/m³: Kn normal to the axis, Kt
along the axis [N/(m/s)²]. Constant coefficients hold for Reynolds numbers from 1e3 to 2e5
(cylinders 1e4 to 2e5).

In moment balance, the axis t of an element is parallel to A + Kn|Vn|Vn/2. A is the force above the
element, plus half its net buoyancy. Since forces along t do not rotate the element, Kn|Vn|V may
replace Kn|Vn|Vn. With k = Kn/2,

    t is parallel to A + c V,     c = k |Vn| = k |V × t| = k |V × A| / |A + c V|,

which is one scalar equation for c.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from functools import cached_property
from math import copysign, inf, log, pi, sqrt

from calm.physics.compiled import within
from calm.physics.seawater import REFERENCE_DENSITY

SPHERE_CX = 0.5
LONG_CYLINDER_CN = 1.2
CHAIN_CN = 2.75
CHAIN_CT = 0.46
CABLE_CN = 1.3
CABLE_CT = {"smooth": 0.005, "rough": 0.009, "very-rough": 0.013}
"""Tangential drag coefficients of cables, based on the wetted surface. Smooth: parallel fibre in a
sheath, plastic-coated wire; rough: braided; very rough: laid strands.
"""
BLOCK_CD = 1.05
"""Drag coefficient of a cube with one face towards the flow (Hoerner, Fluid-Dynamic Drag, 1965)."""

_HALF_DENSITY = 0.5 * REFERENCE_DENSITY

# Finite length: Wieselsberger's cylinder of L/D = 1, then DNV-RP-C205 table 6-2, Re < 2e5.
_SLENDERNESS = (1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 50.0, 100.0)
_KAPPA = (0.52, 0.58, 0.62, 0.68, 0.74, 0.82, 0.87, 0.98)
# Flow along the axis, on the end face (Kritzinger).
_END_SLENDERNESS = (0.1, 0.6, 0.88, 1.3, 1.8)
_END_CT = (1.17, 1.07, 0.97, 0.86, 0.82)


def interpolated(xs: Sequence[float], ys: Sequence[float], x: float) -> float:
    """Interpolate linearly at x, between points (xs, ys) with increasing x.

    The result is constant beyond the first and the last point.
    """
    if x <= xs[0]:
        return ys[0]
    low, high = 0, len(xs) - 1
    if x >= xs[high]:
        return ys[high]
    while high - low > 1:
        middle = (low + high) // 2
        if xs[middle] <= x:
            low = middle
        else:
            high = middle
    return ys[low] + (ys[high] - ys[low]) * (x - xs[low]) / (xs[high] - xs[low])


def finite_length_factor(slenderness: float) -> float:
    """Return the factor κ ≤ 1 by which the finite length of a cylinder reduces its drag.

    κ is linear in log(L/D) between the points of a table, and constant for L/D below 1 and above
    100. `slenderness` is L/D.

    Source: DNV-RP-C205 table 6-2 (Re < 2e5); for L/D below 2, Wieselsberger (NACA report 121).
    """
    return interpolated([log(x) for x in _SLENDERNESS], _KAPPA, log(max(slenderness, 1.0)))


def end_face_coefficient(slenderness: float) -> float:
    """Return the drag coefficient Ct of a cylinder in axial flow, based on its end-face area.

    Ct is linear in L/D between 0.1 and 1.8, and constant elsewhere. `slenderness` is L/D.

    Source: Kritzinger's measurements.
    """
    return interpolated(_END_SLENDERNESS, _END_CT, slenderness)


def sphere_drag(diameter: float, cx: float | None = None) -> float:
    """Return the drag factor K = ½ρ Cx πD²/4 of a sphere with diameter D [m].

    The default drag coefficient Cx is 0.5.
    """
    return _HALF_DENSITY * (SPHERE_CX if cx is None else cx) * pi * diameter**2 / 4


def cylinder_drag(
    diameter: float, length: float, cn: float | None = None, ct: float | None = None
) -> tuple[float, float]:
    """Return the drag factors Kn = ½ρ Cn D L and Kt = ½ρ Ct πD²/4 of a cylinder.

    Parameters
    ----------
    diameter, length : D and L [m]
    cn, ct : drag coefficients; by default Cn = 1.2 κ(L/D), and Ct as in `end_face_coefficient`
    """
    slenderness = length / diameter
    if cn is None:
        cn = LONG_CYLINDER_CN * finite_length_factor(slenderness)
    if ct is None:
        ct = end_face_coefficient(slenderness)
    return (_HALF_DENSITY * cn * diameter * length, _HALF_DENSITY * ct * pi * diameter**2 / 4)


def line_drag(diameter: float, cn: float, ct: float) -> tuple[float, float]:
    """Return the drag factors of a cable per metre, Kn = ½ρ Cn D and Kt = ½ρ Ct πD.

    The diameter D is in m.
    """
    return _HALF_DENSITY * cn * diameter, _HALF_DENSITY * ct * pi * diameter


def area_drag(area: float, cd: float) -> float:
    """Return the drag factor K = ½ρ Cd A of a body with reference area A [m²].

    Cd is the drag coefficient for this area.
    """
    return _HALF_DENSITY * cd * area


def measured_drag(speeds: Sequence[float], forces: Sequence[float]) -> float:
    """Return the drag factor K = Σ(F/V) / ΣV that fits measured speeds V [m/s] and forces F [N]."""
    return sum(f / v for v, f in zip(speeds, forces, strict=True)) / sum(speeds)


class Friction(Enum):
    """Tangential drag law of a cable or chain; the value is the name of the law in files.

    Drag per metre, with current V, unit vector t along the cable, and Vt = (V·t) t:

    - ``berteaux``: Kt |Vt| Vt, with Kt = ½ρ Ct πD (Berteaux, Buoy Engineering, 1976);
    - ``hoerner``: Kt |V| V, with the same Kt (Hoerner, Fluid-Dynamic Drag, 1965);
    - ``constant``: Kt |V|² in the direction of Vt, with Kt = Ct ½ρ Cn D (Pode, David Taylor Model
      Basin report 687, 1951).
    """

    BERTEAUX = "berteaux"
    HOERNER = "hoerner"
    CONSTANT = "constant"

    @cached_property
    def law(self) -> int:
        """Number that stands for this law in `friction_force`."""
        return list(Friction).index(self)


BERTEAUX, HOERNER, CONSTANT = (friction.law for friction in Friction)


def turning_friction(law: int, kt: float, u: float, v: float, w: float) -> float:
    """Return the coefficient of a tangential drag that acts along the current [N/(m/s)].

    The drag is the coefficient times the current u, v, w [m/s]. The coefficient is 0 for laws whose
    drag acts along the cable. Kt is in N/(m/s)².
    """
    return kt * sqrt(u * u + v * v + w * w) if law == HOERNER else 0.0


def friction_force(
    law: int, kt: float, u: float, v: float, w: float, tx: float, ty: float, tz: float
) -> Vector:
    """Return the tangential drag [N] of the current u, v, w [m/s] on a cable with unit axis t.

    Kt is in N/(m/s)².
    """
    if law == HOERNER:
        pull = turning_friction(law, kt, u, v, w)
        return pull * u, pull * v, pull * w
    along = u * tx + v * ty + w * tz
    pull = kt * abs(along) * along
    if law == CONSTANT:
        pull = copysign(kt * (u * u + v * v + w * w), along) if along != 0.0 else 0.0
    return pull * tx, pull * ty, pull * tz


Vector = tuple[float, float, float]


def drag_share(ax: float, ay: float, az: float, k: float, vx: float, vy: float, vz: float) -> float:
    """Return the factor c for which the axis of a freely rotating element is parallel to A + c V.

    c is the smallest root of c |A + c V| = k |V × A|, from 0 to k|V| [N/(m/s)]. Up to three roots
    exist if the angle between A and -V is less than 19.5°. The smallest root applies to a current
    that increases from rest.

    Parameters
    ----------
    ax, ay, az : force A that rotates the element, without the normal drag [N]
    k : half the normal drag factor, Kn/2 [N/(m/s)²]
    vx, vy, vz : relative current V [m/s]
    """
    vv = vx * vx + vy * vy + vz * vz
    if k == 0.0 or vv == 0.0:
        return 0.0
    aa = ax * ax + ay * ay + az * az
    av = ax * vx + ay * vy + az * vz
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    target = k * sqrt(cx * cx + cy * cy + cz * cz)
    if target == 0.0:
        return 0.0
    low, high = 0.0, k * sqrt(vv)
    discriminant = 9.0 * av * av - 8.0 * aa * vv
    if av < 0.0 and discriminant > 0.0:
        # c |A + c V| rises, falls and rises again: use the first rise if it reaches the target
        crest = (-3.0 * av - sqrt(discriminant)) / (4.0 * vv)
        trough = (-3.0 * av + sqrt(discriminant)) / (4.0 * vv)
        if crest * sqrt(aa + crest * (2.0 * av + crest * vv)) >= target:
            high = min(high, crest)
        else:
            low = min(trough, high)
    c = target / sqrt(aa)
    if c > high:
        c = high
    elif c < low:
        c = low
    for _ in range(100):
        excess, root, rise = share_step(aa, av, vv, target, c)
        following = c - excess * root / rise if rise > 0.0 else inf
        if excess > 0.0:
            high = c
        else:
            low = c
        near = 1e-9  # its square is about the next Newton step
        if not low <= following <= high:
            following, near = 0.5 * (low + high), 1e-14
        if abs(following - c) <= near * following:
            return following
        c = following
    return c


def share_step(aa: float, av: float, vv: float, target: float, c: float) -> Vector:
    """Return three quantities for a Newton step in c towards c |A + c V| = target.

    The quantities are c |A + c V| - target, |A + c V|, and |A + c V| times the derivative of
    c |A + c V|. `aa`, `av` and `vv` are A·A, A·V and V·V.
    """
    square = aa + c * (2.0 * av + c * vv)
    root = sqrt(square)
    return c * root - target, root, square + c * (av + c * vv)


@within
def few_steps_share(
    ax: float,
    ay: float,
    az: float,
    k: float,
    size: float,
    vx: float,
    vy: float,
    vz: float,
    steps: int,
) -> tuple[float, float]:
    """Approximate `drag_share` by a few Newton steps, for an element that drag hardly rotates.

    Parameters
    ----------
    size : approximate |A + c V| [N], for the initial estimate of c

    Returns
    -------
    c [N/(m/s)], and the squared rotation of A + c V in the last step [rad²].
    """
    aa = ax * ax + ay * ay + az * az
    av = ax * vx + ay * vy + az * vz
    vv = vx * vx + vy * vy + vz * vz
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    target = k * sqrt(cx * cx + cy * cy + cz * cz)
    before = c = target / size
    for _ in range(steps):
        before = c
        excess, root, rise = share_step(aa, av, vv, target, c)
        c -= excess * root / rise
    return c, (c - before) * (c - before) * vv / aa


@within
def axis_along(
    ax: float, ay: float, az: float, c: float, vx: float, vy: float, vz: float
) -> Vector:
    """Return the unit axis of an element, opposite to the force A + c V.

    If the force vanishes, the axis is parallel to the current, or points down in still water.
    """
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    if x * x + y * y + z * z == 0.0:
        x, y, z = vx, vy, vz
        if x * x + y * y + z * z == 0.0:
            return 0.0, 0.0, -1.0
    return axis_against(x, y, z)


def axis_against(x: float, y: float, z: float) -> Vector:
    """Return the unit axis opposite to a nonzero force."""
    size = sqrt(x * x + y * y + z * z)
    return -x / size, -y / size, -z / size


def drag_force(
    kn: float, kt: float, vx: float, vy: float, vz: float, tx: float, ty: float, tz: float
) -> Vector:
    """Return the drag Kn |Vn| Vn + Kt |Vt| Vt [N] on an element with unit axis t.

    Vn and Vt are the components of the relative current V normal and parallel to the axis.
    """
    along = vx * tx + vy * ty + vz * tz
    nx, ny, nz = vx - along * tx, vy - along * ty, vz - along * tz
    normal = kn * sqrt(nx * nx + ny * ny + nz * nz)
    tangential = kt * abs(along) * along
    return (
        normal * nx + tangential * tx,
        normal * ny + tangential * ty,
        normal * nz + tangential * tz,
    )
