"""The balance of one element: scalar functions on floats, written once for every march.

An element of axis t, load q = (0, 0, B) + drag at its middle and force F above hangs along the
mean of the forces at its ends, t = -(F + q/2)/|F + q/2|. The parts of q along t do not turn it,
and the normal drag Kn|Vn|Vn differs from Kn|Vn|V only along t. So, with A = F + (0, 0, B)/2 and
k = Kn/2,

    t is parallel to A + c V,     c = k |Vn| = k |V × t| = k |V × A| / |A + c V|,

one scalar equation for c, solved here exactly however strong the drag is.
"""

from __future__ import annotations

from math import inf, sqrt

from calm.physics.compiled import within

Vector = tuple[float, float, float]


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
        near = 1e-9  # whose square is what the next step of Newton's would be
        if not low <= following <= high:
            following, near = 0.5 * (low + high), 1e-14
        if abs(following - c) <= near * following:
            return following
        c = following
    return c


@within
def share_step(aa: float, av: float, vv: float, target: float, c: float) -> Vector:
    """Return how far c |A + c V| is above a target; |A + c V|; and their slope by c times that.

    `aa`, `av` and `vv` are the products A·A, A·V and V·V.
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
    """`drag_share` by so many Newton steps, where drag turns the element but little.

    Parameters
    ----------
    size : about |A| [N]; the first guess is the share if drag did not turn the element
    steps : at least 1

    Returns
    -------
    c [N/(m/s)], and how much the last step turned A + c V, squared [rad²].
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
    """Unit axis, from the free end towards the fixed end, against the force A + c V.

    Where the force vanishes the element trails with the current, or hangs plumb in still water.
    """
    x, y, z = ax + c * vx, ay + c * vy, az + c * vz
    if x * x + y * y + z * z == 0.0:
        x, y, z = vx, vy, vz
        if x * x + y * y + z * z == 0.0:
            return 0.0, 0.0, -1.0
    return axis_against(x, y, z)


@within
def axis_against(x: float, y: float, z: float) -> Vector:
    """Unit axis against a force that does not vanish."""
    size = sqrt(x * x + y * y + z * z)
    return -x / size, -y / size, -z / size


@within
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
