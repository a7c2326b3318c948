"""The march for many current profiles of one mooring, sixteen cases at a time.

Every case has its lane. A lane's state lies in one flat scratch array, a row of sixteen numbers
for each quantity, so that the compiler sees that the rows do not overlap and computes all lanes
at once. What a lane yields depends on its own case alone: once settled it is frozen.

The balance of an element is that of `calm.physics.element`, whose functions are compiled in here.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any

from calm.batch.compiled import compilable, compiled
from calm.physics.element import axis_along, drag_force, drag_share, share_step
from calm.physics.line import REFERENCE_DENSITY, Floats, Integers

LANES = 16

Tables = tuple[Integers, Integers, Floats, Floats]
"""For every lane the slot of its profile and the interval it is in; for every slot the bounds of
the intervals, and value at no depth and slope of u, v, w and density in each."""

for formula in (share_step, axis_along, drag_force, drag_share):
    compilable(formula)

# rows of the scratch array
(
    # place, force above, axis: these are recorded
    X, Y, Z, FX, FY, FZ, TX, TY, TZ,
    # load per metre of the last segment; pull at its middle; where to look up
    QX, QY, QZ, PULL, DEPTH,
    # current and density there
    U, V, W, DENSITY,
    # what turns an element and its drag, see `calm.physics.element`
    AX, AY, AZ, K, GX, GY, GZ, C, DOUBT,
    # extremes of heights, of the vertical force low down, of the pull
    LOWEST, HIGHEST, LIGHTEST, LEAST_PULL,
    # how the free end is placed
    FREE_END, SHARE, OUT, WET, HELD, WIND_EAST, WIND_NORTH,
    # axis of a rod, its rise where its loads are looked up, its last change
    NX, NY, NZ, TRIED, CHANGE,
    # a load as it is in each lane
    L_BUOYANCY, L_VOLUME, L_NORMAL, L_TANGENTIAL, L_LIFT, L_EAST, L_NORTH,
    # sums of loads, and of what turns a rod
    SX, SY, SZ, MX, MY, MZ,
) = (row * LANES for row in range(56))  # fmt: skip
SCRATCH = 56 * LANES

ROD, CABLE, CLAMP = 0, 1, 2
AT, LEVER, BUOYANCY, VOLUME, NORMAL, TANGENTIAL, LIFT, DIRECTIONAL, AFLOAT = range(9)
C_BUOYANCY, C_VOLUME, C_NORMAL, C_TANGENTIAL, C_COMPLIANCE, C_THINNING = range(6)
STATE = 9  # numbers of a recorded node: place, force, axis
PER_DENSITY = 1.0 / REFERENCE_DENSITY
FAR = 1e8
CLOSE = 1e-6
MOST_PASSES = 30
ITSELF, ABOVE_IT = 1.0, 2.0


@compiled
def look_up(s: Floats, water: Tables) -> None:
    """Current and density of every lane at its depth, in the profile of its slot."""
    slots, level, bounds, rows = water
    for i in range(LANES):
        depth = s[DEPTH + i]
        if not abs(depth) < FAR:
            depth = 0.0
        slot, j = slots[i], level[i]
        while depth >= bounds[slot, j + 1]:
            j += 1
        while depth < bounds[slot, j]:
            j -= 1
        level[i] = j
        s[U + i] = rows[slot, j, 0] + rows[slot, j, 1] * depth
        s[V + i] = rows[slot, j, 2] + rows[slot, j, 3] * depth
        s[W + i] = rows[slot, j, 4] + rows[slot, j, 5] * depth
        s[DENSITY + i] = rows[slot, j, 6] + rows[slot, j, 7] * depth


@compiled
def exact_shares(s: Floats) -> None:
    """Solve the share of every lane whose Newton steps have not settled."""
    for i in range(LANES):
        if not s[DOUBT + i] < CLOSE:
            s[C + i] = drag_share(
                s[AX + i], s[AY + i], s[AZ + i], s[K + i], s[GX + i], s[GY + i], s[GZ + i]
            )


@compiled
def pass_segments(
    s: Floats, water: Tables, cable: Floats, cuts: Floats, halvings: int, gravity: float
) -> None:
    """Take all lanes down a stretch of cable; each cut is halved so many times."""
    buoyancy, volume, kn, kt = (
        cable[C_BUOYANCY],
        cable[C_VOLUME],
        cable[C_NORMAL],
        cable[C_TANGENTIAL],
    )
    compliance, thinning = cable[C_COMPLIANCE], cable[C_THINNING]
    parts = 1 << halvings
    for j in range(cuts.size):
        cut = cuts[j] / parts
        half = 0.5 * cut
        for _ in range(parts):
            for i in range(LANES):
                gx, gy, gz = (
                    s[FX + i] + half * s[QX + i],
                    s[FY + i] + half * s[QY + i],
                    s[FZ + i] + half * s[QZ + i],
                )
                pull = sqrt(gx * gx + gy * gy + gz * gz)
                s[PULL + i] = pull
                s[DEPTH + i] = -s[Z + i] + half * (1.0 + compliance * pull) * gz / pull
            look_up(s, water)
            for i in range(LANES):
                u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
                pull = s[PULL + i]
                area = cut * density * PER_DENSITY
                area *= 1.0 + thinning * (sqrt(1.0 + compliance * pull) - 1.0)
                lift = cut * (buoyancy + (density - REFERENCE_DENSITY) * gravity * volume)
                ax, ay, az = s[FX + i], s[FY + i], s[FZ + i] + 0.5 * lift
                k = 0.5 * kn * area
                aa = ax * ax + ay * ay + az * az
                av = ax * u + ay * v + az * w
                vv = u * u + v * v + w * w
                cx, cy, cz = ay * w - az * v, az * u - ax * w, ax * v - ay * u
                target = k * sqrt(cx * cx + cy * cy + cz * cz)
                first = target / pull
                _, c = share_step(aa, av, vv, target, first)
                step = c - first
                doubt = step * step * vv / aa
                s[AX + i], s[AY + i], s[AZ + i] = ax, ay, az
                s[K + i], s[C + i], s[DOUBT + i] = k, c, doubt
                s[GX + i], s[GY + i], s[GZ + i] = u, v, w
            exact_shares(s)
            for i in range(LANES):
                u, v, w = s[GX + i], s[GY + i], s[GZ + i]
                k = 2.0 * s[K + i]
                tx, ty, tz = axis_along(s[AX + i], s[AY + i], s[AZ + i], s[C + i], u, v, w)
                qx, qy, qz = drag_force(k, kt / kn * k, u, v, w, tx, ty, tz)
                qz += 2.0 * (s[AZ + i] - s[FZ + i])
                fx, fy, fz = s[FX + i], s[FY + i], s[FZ + i]
                pull = -((fx + 0.5 * qx) * tx + (fy + 0.5 * qy) * ty + (fz + 0.5 * qz) * tz)
                stretched = cut * (1.0 + compliance * pull)
                s[LEAST_PULL + i] = pull if pull < s[LEAST_PULL + i] else s[LEAST_PULL + i]
                s[X + i] += stretched * tx
                s[Y + i] += stretched * ty
                z = s[Z + i] + stretched * tz
                s[Z + i] = z
                s[LOWEST + i] = z if z < s[LOWEST + i] else s[LOWEST + i]
                s[HIGHEST + i] = z if z > s[HIGHEST + i] else s[HIGHEST + i]
                s[FX + i], s[FY + i], s[FZ + i] = fx + qx, fy + qy, fz + qz
                s[TX + i], s[TY + i], s[TZ + i] = tx, ty, tz
                s[QX + i], s[QY + i], s[QZ + i] = qx / cut, qy / cut, qz / cut


@compiled
def load_of_every_lane(s: Floats, load: Floats, gravity: float) -> None:
    """Lay out a load in the lanes; what is at the surface, by how much of it is in use."""
    for i in range(LANES):
        s[L_BUOYANCY + i] = load[BUOYANCY]
        s[L_VOLUME + i] = load[VOLUME]
        s[L_NORMAL + i] = load[NORMAL]
        s[L_TANGENTIAL + i] = load[TANGENTIAL]
        s[L_LIFT + i] = load[LIFT]
        s[L_EAST + i] = 0.0
        s[L_NORTH + i] = 0.0
    if load[AFLOAT] == ITSELF:
        for i in range(LANES):
            s[L_BUOYANCY + i] *= s[SHARE + i]
            s[L_VOLUME + i] *= s[SHARE + i]
            s[L_NORMAL + i] *= s[HELD + i]
            s[L_TANGENTIAL + i] *= s[HELD + i]
            s[L_EAST + i] = s[WIND_EAST + i]
            s[L_NORTH + i] = s[WIND_NORTH + i]
    elif load[AFLOAT] == ABOVE_IT:
        for i in range(LANES):
            wet = s[WET + i]
            s[L_BUOYANCY + i] -= (1.0 - wet) * REFERENCE_DENSITY * gravity * load[VOLUME]
            s[L_VOLUME + i] *= wet
            s[L_NORMAL + i] *= wet
            s[L_TANGENTIAL + i] *= wet
            s[L_LIFT + i] *= wet


@compiled
def gather_load(s: Floats, load: Floats, gravity: float, several: bool) -> None:
    """Add a load's part in the moments: what turns the rod by itself, and its normal drag."""
    lever, directional = load[LEVER], load[DIRECTIONAL]
    for i in range(LANES):
        u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
        scale = lever * density * PER_DENSITY
        vv = u * u + v * v + w * w
        kn = scale * s[L_NORMAL + i]
        drag = (1.0 - directional) * kn * sqrt(vv)
        excess = (density - REFERENCE_DENSITY) * gravity
        s[AX + i] += lever * s[L_EAST + i] + drag * u
        s[AY + i] += lever * s[L_NORTH + i] + drag * v
        s[AZ + i] += (
            lever * (s[L_BUOYANCY + i] + excess * s[L_VOLUME + i])
            + scale * s[L_LIFT + i] * vv
            + drag * w
        )
        share = directional * kn
        if several:
            cx = v * s[NZ + i] - w * s[NY + i]
            cy = w * s[NX + i] - u * s[NZ + i]
            cz = u * s[NY + i] - v * s[NX + i]
            share *= sqrt(cx * cx + cy * cy + cz * cz)
        s[K + i] += share
        weight = share if several else directional
        s[GX + i] += weight * u
        s[GY + i] += weight * v
        s[GZ + i] += weight * w


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
def add_load(s: Floats, load: Floats, gravity: float) -> None:
    """Force of a load in the current looked up: in QX, QY, QZ, added to the sums."""
    lever, directional = load[LEVER], load[DIRECTIONAL]
    for i in range(LANES):
        u, v, w, density = s[U + i], s[V + i], s[W + i], s[DENSITY + i]
        scale = density * PER_DENSITY
        vv = u * u + v * v + w * w
        kn = scale * s[L_NORMAL + i]
        drag = (1.0 - directional) * kn * sqrt(vv)
        qx, qy, qz = drag_force(
            directional * kn, directional * scale * s[L_TANGENTIAL + i],
            u, v, w, s[NX + i], s[NY + i], s[NZ + i],
        )  # fmt: skip
        excess = (density - REFERENCE_DENSITY) * gravity
        qx += drag * u + s[L_EAST + i]
        qy += drag * v + s[L_NORTH + i]
        qz += drag * w + s[L_BUOYANCY + i] + excess * s[L_VOLUME + i] + scale * s[L_LIFT + i] * vv
        s[QX + i], s[QY + i], s[QZ + i] = qx, qy, qz
        s[SX + i] += qx
        s[SY + i] += qy
        s[SZ + i] += qz
        s[MX + i] += lever * qx
        s[MY + i] += lever * qy
        s[MZ + i] += lever * qz


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


@compiled
def pass_clamp(s: Floats, water: Tables, loads: Floats, gravity: float, record: Floats) -> None:
    """Add an instrument clamped on a cable."""
    for i in range(LANES):
        s[DEPTH + i] = -s[Z + i]
        s[SX + i], s[SY + i], s[SZ + i] = 0.0, 0.0, 0.0
    look_up(s, water)
    load_of_every_lane(s, loads[0], gravity)
    for i in range(LANES):
        s[AX + i], s[AY + i], s[AZ + i] = s[QX + i], s[QY + i], s[QZ + i]
    add_load(s, loads[0], gravity)
    for i in range(LANES):
        s[FX + i] += s[SX + i]
        s[FY + i] += s[SY + i]
        s[FZ + i] += s[SZ + i]
        s[QX + i], s[QY + i], s[QZ + i] = s[AX + i], s[AY + i], s[AZ + i]


@compiled
def march(
    s: Floats, water: Tables, plan: Any, halvings: int, nodes: Floats, forces: Floats
) -> None:
    """March all lanes from their free ends; their states at every joint go to `nodes`."""
    kinds, firsts, counts, lengths, cables, cuts, loads, gravity, limit, landing = plan
    for i in range(LANES):
        s[X + i], s[Y + i], s[Z + i] = 0.0, 0.0, -s[FREE_END + i]
        s[FX + i], s[FY + i], s[FZ + i] = 0.0, 0.0, 0.0
        s[TX + i], s[TY + i], s[TZ + i] = 0.0, 0.0, -1.0
        s[QX + i], s[QY + i], s[QZ + i] = 0.0, 0.0, 0.0
        s[LOWEST + i], s[HIGHEST + i] = inf, -inf
        s[LIGHTEST + i], s[LEAST_PULL + i] = inf, inf
    cable = 0
    for n in range(kinds.size):
        first, count = firsts[n], counts[n]
        if kinds[n] == CABLE:
            pass_segments(
                s, water, cables[cable], cuts[first : first + count],
                halvings, gravity,
            )  # fmt: skip
            cable += 1
        else:
            mine, written = loads[first : first + count], forces[3 * LANES * first :]
            if kinds[n] == ROD and count == 1 and n > 0:
                pass_piece(s, water, loads, first, lengths[n], gravity, limit)
            elif kinds[n] == ROD:
                pass_rod(s, water, mine, lengths[n], gravity, limit, n == 0, written)
            else:
                pass_clamp(s, water, mine, gravity, written)
        if n >= landing:
            for i in range(LANES):
                fz = s[FZ + i]
                s[LIGHTEST + i] = fz if fz < s[LIGHTEST + i] else s[LIGHTEST + i]
        if n == 0:
            note(s, nodes, 0)
            for i in range(LANES):
                nodes[X + i] = 0.0
                nodes[Y + i] = 0.0
                nodes[Z + i] = s[Z + i] - lengths[0] * s[TZ + i]
                nodes[FX + i], nodes[FY + i], nodes[FZ + i] = 0.0, 0.0, 0.0
        note(s, nodes, n + 1)


@compiled
def note(s: Floats, nodes: Floats, n: int) -> None:
    """Record the state of all lanes."""
    base = n * STATE * LANES
    for i in range(STATE * LANES):
        nodes[base + i] = s[i]
    for i in range(LANES):
        z = s[Z + i]
        s[LOWEST + i] = z if z < s[LOWEST + i] else s[LOWEST + i]
        s[HIGHEST + i] = z if z > s[HIGHEST + i] else s[HIGHEST + i]
