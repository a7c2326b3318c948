"""A rigid body in the lanes: `calm.physics.rod`."""

from __future__ import annotations

from math import inf, sqrt

from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    AT,
    AX,
    AY,
    AZ,
    BUOYANCY,
    CHANGE,
    DENSITY,
    DEPTH,
    DIRECTIONAL,
    DOUBT,
    FREE_END,
    FX,
    FY,
    FZ,
    GX,
    GY,
    GZ,
    LANES,
    LEAST_PULL,
    LEVER,
    LIFT,
    MOST_PASSES,
    MX,
    MY,
    MZ,
    NORMAL,
    NX,
    NY,
    NZ,
    OUT,
    PER_DENSITY,
    PULL,
    QX,
    QY,
    QZ,
    SX,
    SY,
    SZ,
    TANGENTIAL,
    TRIED,
    TX,
    TY,
    TZ,
    VOLUME,
    C,
    K,
    Tables,
    U,
    V,
    W,
    X,
    Y,
    Z,
    exact_shares,
    look_up,
)
from calm.batch.kernel.loads import add_load, gather_load, load_of_every_lane
from calm.physics.element import axis_along, drag_force, share_step
from calm.physics.line import REFERENCE_DENSITY, Floats


@compiled
def mean_current(s: Floats) -> None:
    """One current and coefficient that reproduce the sum of several normal drags."""
    for i in range(LANES):
        total = s[K + i]
        divisor = total if total > 0.0 else 1.0
        gx, gy, gz = s[GX + i] / divisor, s[GY + i] / divisor, s[GZ + i] / divisor
        cx = gy * s[NZ + i] - gz * s[NY + i]
        cy = gz * s[NX + i] - gx * s[NZ + i]
        cz = gx * s[NY + i] - gy * s[NX + i]
        across = sqrt(cx * cx + cy * cy + cz * cz)
        s[K + i] = total / across if across > 0.0 else 0.0
        s[GX + i], s[GY + i], s[GZ + i] = gx, gy, gz


@compiled
def turn_rod(s: Floats) -> None:
    """Newton steps for the share of the gathered drag."""
    for i in range(LANES):
        ax, ay, az, k = s[AX + i], s[AY + i], s[AZ + i], s[K + i]
        u, v, w = s[GX + i], s[GY + i], s[GZ + i]
        aa = ax * ax + ay * ay + az * az
        av = ax * u + ay * v + az * w
        vv = u * u + v * v + w * w
        cx, cy, cz = ay * w - az * v, az * u - ax * w, ax * v - ay * u
        target = k * sqrt(cx * cx + cy * cy + cz * cz)
        # the share is less than of the current across, and less than if it did not turn the rod
        first, most = target / sqrt(aa), k * sqrt(vv)
        _, first = share_step(aa, av, vv, target, first if first < most else most)
        _, c = share_step(aa, av, vv, target, first)
        step = c - first
        s[C + i] = c
        s[DOUBT + i] = step * step * vv / aa


@compiled
def pass_rod(
    s: Floats,
    water: Tables,
    loads: Floats,
    length: float,
    gravity: float,
    limit: float,
    heads: bool,
    record: Floats,
) -> None:
    """Take all lanes down a rod; `heads`: it is the first one, which hangs on nothing."""
    count = loads.shape[0]
    several = 0.0
    for j in range(count):
        several += loads[j, DIRECTIONAL]
    many = several > 1.0
    for i in range(LANES):
        s[NX + i], s[NY + i], s[NZ + i] = s[TX + i], s[TY + i], s[TZ + i]
        s[CHANGE + i] = inf
    for _ in range(MOST_PASSES):
        for i in range(LANES):
            s[TRIED + i] = s[TRIED + i] if s[CHANGE + i] <= limit else s[NZ + i]
        if heads:
            for i in range(LANES):
                tz = s[TRIED + i]
                s[Z + i] = -s[FREE_END + i] - (s[OUT + i] * tz if tz < 0.0 else 0.0)
        for i in range(LANES):
            s[AX + i], s[AY + i], s[AZ + i] = s[FX + i], s[FY + i], s[FZ + i]
            s[K + i] = 0.0
            s[GX + i], s[GY + i], s[GZ + i] = 0.0, 0.0, 0.0
        for j in range(count):
            at = loads[j, AT]
            for i in range(LANES):
                s[DEPTH + i] = -s[Z + i] - at * s[TRIED + i]
            look_up(s, water)
            load_of_every_lane(s, loads[j], gravity)
            gather_load(s, loads[j], gravity, many)
        if many:
            mean_current(s)
        turn_rod(s)
        exact_shares(s)
        for i in range(LANES):
            nx, ny, nz = s[NX + i], s[NY + i], s[NZ + i]
            tx, ty, tz = axis_along(
                s[AX + i], s[AY + i], s[AZ + i], s[C + i], s[GX + i], s[GY + i], s[GZ + i]
            )
            settled = s[CHANGE + i] <= limit
            sideways = abs(tx - nx) + abs(ty - ny)
            change = (length + (s[OUT + i] if heads else 0.0)) * (
                abs(tz - nz) + (sideways if many else 0.0)
            )
            s[NX + i] = nx if settled else tx
            s[NY + i] = ny if settled else ty
            s[NZ + i] = nz if settled else tz
            s[CHANGE + i] = s[CHANGE + i] if settled else change
        worst = 0.0
        for i in range(LANES):
            if not s[CHANGE + i] <= worst:
                worst = s[CHANGE + i]
        if worst <= limit:
            break
    for i in range(LANES):
        s[SX + i], s[SY + i], s[SZ + i] = 0.0, 0.0, 0.0
        s[MX + i], s[MY + i], s[MZ + i] = s[FX + i], s[FY + i], s[FZ + i]
        if not s[CHANGE + i] <= limit:
            s[LEAST_PULL + i] = -1.0
    for j in range(count):
        if count > 1:
            at = loads[j, AT]
            for i in range(LANES):
                s[DEPTH + i] = -s[Z + i] - at * s[NZ + i]
            look_up(s, water)
            load_of_every_lane(s, loads[j], gravity)
        add_load(s, loads[j], gravity)
        for i in range(LANES):
            record[(3 * j) * LANES + i] = s[QX + i]
            record[(3 * j + 1) * LANES + i] = s[QY + i]
            record[(3 * j + 2) * LANES + i] = s[QZ + i]
    if length > 0.0:
        for i in range(LANES):
            s[TX + i], s[TY + i], s[TZ + i] = s[NX + i], s[NY + i], s[NZ + i]
    for i in range(LANES):
        tx, ty, tz = s[NX + i], s[NY + i], s[NZ + i]
        s[X + i] += length * tx
        s[Y + i] += length * ty
        s[Z + i] += length * tz
        s[FX + i] += s[SX + i]
        s[FY + i] += s[SY + i]
        s[FZ + i] += s[SZ + i]
        turning = s[MX + i] * tx + s[MY + i] * ty + s[MZ + i] * tz
        s[LEAST_PULL + i] = -turning if -turning < s[LEAST_PULL + i] else s[LEAST_PULL + i]
        s[QX + i], s[QY + i], s[QZ + i] = 0.0, 0.0, 0.0


@compiled
def pass_piece(
    s: Floats, water: Tables, loads: Floats, j: int, length: float, gravity: float, limit: float
) -> None:
    """Take all lanes down a rod of one load: as `pass_rod`, in fewer steps."""
    at, lever, directional = loads[j, AT], loads[j, LEVER], loads[j, DIRECTIONAL]
    buoyancy, volume, lifting = loads[j, BUOYANCY], loads[j, VOLUME], loads[j, LIFT]
    normal, tangential = loads[j, NORMAL], loads[j, TANGENTIAL]
    against = (1.0 - directional) * normal
    normal *= directional
    tangential *= directional
    for i in range(LANES):
        s[NX + i], s[NY + i], s[NZ + i] = s[TX + i], s[TY + i], s[TZ + i]
        s[TRIED + i] = s[TZ + i]
        s[CHANGE + i] = inf
    for _ in range(MOST_PASSES):
        for i in range(LANES):
            s[DEPTH + i] = -s[Z + i] - at * s[TRIED + i]
        look_up(s, water)
        for i in range(LANES):
            u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
            scale = density * PER_DENSITY
            vv = u * u + v * v + w * w
            drag = scale * against * sqrt(vv)
            lift = buoyancy + (density - REFERENCE_DENSITY) * gravity * volume
            lift += scale * lifting * vv
            ax, ay = s[FX + i] + lever * drag * u, s[FY + i] + lever * drag * v
            az = s[FZ + i] + lever * (lift + drag * w)
            k = lever * scale * normal
            aa = ax * ax + ay * ay + az * az
            av = ax * u + ay * v + az * w
            cx, cy, cz = ay * w - az * v, az * u - ax * w, ax * v - ay * u
            target = k * sqrt(cx * cx + cy * cy + cz * cz)
            # the share is less than if it did not turn the rod
            first = target / sqrt(aa)
            _, c = share_step(aa, av, vv, target, first)
            step = c - first
            s[AX + i], s[AY + i], s[AZ + i] = ax, ay, az
            s[K + i], s[C + i], s[DOUBT + i] = k, c, step * step * vv / aa
            s[GX + i], s[GY + i], s[GZ + i] = u, v, w
            s[SX + i], s[SY + i], s[SZ + i] = drag * u, drag * v, lift + drag * w
            s[PULL + i] = scale
        exact_shares(s)
        for i in range(LANES):
            tx, ty, tz = axis_along(
                s[AX + i], s[AY + i], s[AZ + i], s[C + i], s[GX + i], s[GY + i], s[GZ + i]
            )
            settled = s[CHANGE + i] <= limit
            nx, ny, nz = s[NX + i], s[NY + i], s[NZ + i]
            change = length * abs(tz - nz)
            tx, ty, tz = nx if settled else tx, ny if settled else ty, nz if settled else tz
            change = s[CHANGE + i] if settled else change
            s[NX + i], s[NY + i], s[NZ + i], s[CHANGE + i] = tx, ty, tz, change
            s[TRIED + i] = s[TRIED + i] if change <= limit else tz
        settling = False
        for i in range(LANES):
            settling |= not s[CHANGE + i] <= limit
        if not settling:
            break
    for i in range(LANES):
        tx, ty, tz = s[NX + i], s[NY + i], s[NZ + i]
        scale = s[PULL + i]
        qx, qy, qz = drag_force(
            scale * normal, scale * tangential, s[GX + i], s[GY + i], s[GZ + i], tx, ty, tz
        )
        qx, qy, qz = qx + s[SX + i], qy + s[SY + i], qz + s[SZ + i]
        fx, fy, fz = s[FX + i], s[FY + i], s[FZ + i]
        pull = -((fx + lever * qx) * tx + (fy + lever * qy) * ty + (fz + lever * qz) * tz)
        least = s[LEAST_PULL + i]
        pull = pull if s[CHANGE + i] <= limit else -1.0
        s[LEAST_PULL + i] = pull if pull < least else least
        s[X + i] += length * tx
        s[Y + i] += length * ty
        s[Z + i] += length * tz
        s[FX + i], s[FY + i], s[FZ + i] = fx + qx, fy + qy, fz + qz
        s[NX + i], s[NY + i], s[NZ + i] = tx, ty, tz
    if length > 0.0:
        for i in range(LANES):
            s[TX + i], s[TY + i], s[TZ + i] = s[NX + i], s[NY + i], s[NZ + i]
