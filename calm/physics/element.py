"""The balance of one element: scalar functions on floats, written once for every march.

An element of axis t, load q = (0, 0, B) + drag at its middle and force F above hangs along the
mean of the forces at its ends, t = -(F + q/2)/|F + q/2|. The parts of q along t do not turn it,
and the normal drag Kn|Vn|Vn differs from Kn|Vn|V only along t. So, with A = F + (0, 0, B)/2 and
k = Kn/2,

    t is parallel to A + c V,     c = k |Vn| = k |V × t| = k |V × A| / |A + c V|,

one scalar equation for c, solved here exactly however strong the drag is.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt

Vector = tuple[float, float, float]

_SCAN = 16


def drag_share(ax: float, ay: float, az: float, k: float, vx: float, vy: float, vz: float) -> float:
    """Solve c |A + c V| = k |V × A| for its smallest root c ≥ 0.

    Parameters
    ----------
    ax, ay, az : force A that turns the element besides its normal drag [N]
    k : half its normal drag coefficient, Kn/2 [N/(m/s)²]
    vx, vy, vz : relative current V [m/s]

    Returns
    -------
    c [N/(m/s)], so that the axis lies along A + c V. It lies between 0 and k|V|. Where A points
    against V to within 19.5° there may be three roots; the smallest is the one reached when the
    current grows from rest.
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
        # c |A + c V| rises, falls and rises again: keep to the first rise where it gets there
        crest = (-3.0 * av - sqrt(discriminant)) / (4.0 * vv)
        trough = (-3.0 * av + sqrt(discriminant)) / (4.0 * vv)
        if crest * sqrt(aa + crest * (2.0 * av + crest * vv)) >= target:
            high = min(high, crest)
        else:
            low = min(trough, high)
    c = min(max(target / sqrt(aa), low), high)
    for _ in range(100):
        excess, following = share_step(aa, av, vv, target, c)
        if excess > 0.0:
            high = c
        else:
            low = c
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - c) <= 1e-14 * following:
            return following
        c = following
    return c


def share_step(aa: float, av: float, vv: float, target: float, c: float) -> tuple[float, float]:
    """How far c |A + c V| is above a target, and the next c by Newton; inf where it has no slope.

    `aa`, `av` and `vv` are the products A·A, A·V and V·V.
    """
    root = sqrt(aa + c * (2.0 * av + c * vv))
    excess = c * root - target
    slope = root + c * (av + c * vv) / root if root > 0.0 else 0.0
    return excess, (c - excess / slope if slope > 0.0 else inf)


def amplified_share(
    ax: float,
    ay: float,
    az: float,
    k: float,
    amplified: Callable[[float], float],
    vx: float,
    vy: float,
    vz: float,
) -> tuple[float, float]:
    """`drag_share` for a coefficient that grows as the element leans: k f(sin φ).

    Parameters
    ----------
    k : half its normal drag coefficient at rest [N/(m/s)²]
    amplified : f ≥ 1 of the sine of the angle φ between axis and current, falling with it

    Returns
    -------
    c [N/(m/s)], the smallest root of c |A + c V| = k f |V × A|, and f there. Putting f(c) back
    climbs to it from below and never past it; the climb is extrapolated as long as that stays
    below, too.
    """
    speed = sqrt(vx * vx + vy * vy + vz * vz)
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    if k == 0.0 or across == 0.0:
        return 0.0, 1.0

    def factor(c: float) -> float:
        x, y, z = ax + c * vx, ay + c * vy, az + c * vz
        return amplified(min(across / (speed * sqrt(x * x + y * y + z * z)), 1.0))

    def climbed(c: float) -> float:
        return drag_share(ax, ay, az, k * factor(c), vx, vy, vz)

    c, above = drag_share(ax, ay, az, k, vx, vy, vz), inf
    first = climbed(c)
    for _ in range(100):
        second = climbed(first)
        gain = second - first
        if gain <= 1e-14 * second:
            return second, factor(second)
        ratio = gain / (first - c)
        trial = second + gain * ratio / (1.0 - ratio) if ratio < 1.0 else inf
        if trial >= above:
            trial = 0.5 * (second + above) if above < inf else 2.0 * second
        following = climbed(trial)
        if following >= trial:
            c, first = trial, following
        else:
            c, first, above = first, second, trial
    return first, factor(first)


def varying_share(
    ax: float,
    ay: float,
    az: float,
    k: float,
    varied: Callable[[float], float],
    vx: float,
    vy: float,
    vz: float,
) -> float:
    """`drag_share` for a coefficient that varies with the speed across the element: k f(|Vn|).

    Parameters
    ----------
    k : half its normal drag coefficient where f = 1 [N/(m/s)²]
    varied : f > 0, continuous, of |Vn| [m/s]

    Returns
    -------
    c = k f(s) s [N/(m/s)] for the smallest root s = |Vn| of s |A + k f(s) s V| = |V × A|, told
    apart from others to |V|/16. In the drag crisis, where less speed makes more drag, an element
    may lean in the slow flow along it or stand in the fast flow across it; the smallest root, the
    more drag, is the one reached when the current grows from rest.
    """
    speed = sqrt(vx * vx + vy * vy + vz * vz)
    cx, cy, cz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    if k == 0.0 or across == 0.0:
        return 0.0

    def excess(s: float) -> float:
        c = k * varied(s) * s
        x, y, z = ax + c * vx, ay + c * vy, az + c * vz
        return s * sqrt(x * x + y * y + z * z) - across

    low, below, side = 0.0, -across, 0
    for i in range(1, _SCAN + 1):
        high = speed * i / _SCAN
        above = excess(high)
        if above >= 0.0:
            break
        if i < _SCAN:
            low, below = high, above
    above = max(above, 0.0)  # at |V| it may be below by rounding
    for _ in range(100):
        s = (low * above - high * below) / (above - below)
        found = excess(s)
        if abs(found) <= 1e-14 * across:
            break
        # the secant keeps to one side of the root unless the other side is made light of
        if found > 0.0:
            high, above, below = s, found, below * (0.5 if side > 0 else 1.0)
            side = 1
        else:
            low, below, above = s, found, above * (0.5 if side < 0 else 1.0)
            side = -1
    return k * varied(s) * s


def axis_along(
    ax: float, ay: float, az: float, c: float, vx: float, vy: float, vz: float
) -> Vector:
    """Unit axis, from the free end towards the fixed end, against the force A + c V.

    Where the force vanishes the element trails with the current, or hangs plumb in still water.
    """
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    size = sqrt(x * x + y * y + z * z)
    if size == 0.0:
        x, y, z = vx, vy, vz
        size = sqrt(x * x + y * y + z * z)
        if size == 0.0:
            return 0.0, 0.0, -1.0
    return -x / size, -y / size, -z / size


def drag_force(
    kn: float,
    kt: float,
    vx: float,
    vy: float,
    vz: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Kn |Vn| Vn + Kt |Vt| Vt [N] for the axis t and the relative current V [m/s]."""
    along = vx * tx + vy * ty + vz * tz
    nx, ny, nz = vx - along * tx, vy - along * ty, vz - along * tz
    normal = kn * sqrt(nx * nx + ny * ny + nz * nz)
    tangential = kt * abs(along) * along
    return (
        normal * nx + tangential * tx,
        normal * ny + tangential * ty,
        normal * nz + tangential * tz,
    )
