"""A rigid body in the lanes: the laws of `calm.physics.rod`, all lanes at once.

Where a drag follows a curve each lane takes the rod by itself.
"""

from __future__ import annotations

from math import inf, sqrt

from calm.batch.kernel import lane
from calm.batch.kernel.lane import (
    LANES,
    MOST_PASSES,
    SINGLY,
    Desk,
    Tables,
    exact_shares,
    look_up,
    lost,
    state_of,
)
from calm.batch.kernel.layout import Way
from calm.batch.kernel.loads import (
    IN_WATER,
    add_load,
    gather_load,
    in_registers,
    load_in_lane,
)
from calm.physics.element import axis_against, few_steps_share
from calm.physics.line import Floats
from calm.physics.load import force_at, load_force, load_lift, speed_across
from calm.physics.rod_axis import next_axis
from calm.physics.track import Load, Stage


def pass_rod(desk: Desk, way: Way, stage: int) -> None:
    """Take all lanes down a rod; the forces of its loads go to the desk's."""
    s, water, record = desk.scratch, desk.water, desk.forces
    rod, loads = way.course.stages[stage], way.course.loads
    curved = False
    for j in range(rod.first, rod.first + rod.size):
        curved |= loads[j].diameter > 0.0
    for i in range(LANES):
        s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i] = 0.0, 0.0, s[lane.TZ + i]
        s[lane.TRIED + i], s[lane.CHANGE + i] = s[lane.TZ + i], inf
    if SINGLY and curved:
        turn_singly(desk, way, stage)
    elif rod.size == 1 and stage > 0 and way.places[rod.first] == IN_WATER:
        pass_piece(s, water, in_registers(loads[rod.first]), rod.length, way.near)
        return
    else:
        turn_together(s, water, way, stage)
    for i in range(LANES):
        s[lane.SX + i], s[lane.SY + i], s[lane.SZ + i] = 0.0, 0.0, 0.0
        s[lane.MX + i], s[lane.MY + i], s[lane.MZ + i] = (
            s[lane.FX + i],
            s[lane.FY + i],
            s[lane.FZ + i],
        )
        if not s[lane.CHANGE + i] <= way.near:
            s[lane.LEAST_PULL + i] = -1.0
    for j in range(rod.first, rod.first + rod.size):
        load = in_registers(loads[j])
        if SINGLY and curved:
            add_singly(s, water, load, way.places[j])
        else:
            if rod.size > 1:
                look_up_load(s, water, load.at, lane.NZ)
            add_load(s, load, way.places[j], water.sea.gravity)
        for i in range(LANES):
            record[(3 * j) * LANES + i] = s[lane.QX + i]
            record[(3 * j + 1) * LANES + i] = s[lane.QY + i]
            record[(3 * j + 2) * LANES + i] = s[lane.QZ + i]
    for i in range(LANES):
        tx, ty, tz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
        turning = s[lane.MX + i] * tx + s[lane.MY + i] * ty + s[lane.MZ + i] * tz
        least = s[lane.LEAST_PULL + i]
        s[lane.LEAST_PULL + i] = -turning if -turning < least else least
    come_below(s, rod.length)


def come_below(s: Floats, length: float) -> None:
    """Take the lanes to the lower end of a rod of axis N and load S."""
    for i in range(LANES):
        tx, ty, tz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
        s[lane.X + i] += length * tx
        s[lane.Y + i] += length * ty
        s[lane.Z + i] += length * tz
        s[lane.FX + i] += s[lane.SX + i]
        s[lane.FY + i] += s[lane.SY + i]
        s[lane.FZ + i] += s[lane.SZ + i]
        s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = 0.0, 0.0, 0.0
    if length > 0.0:
        for i in range(LANES):
            s[lane.TX + i], s[lane.TY + i] = s[lane.NX + i], s[lane.NY + i]
            s[lane.TZ + i] = s[lane.NZ + i]


def look_up_load(s: Floats, water: Tables, at: float, rise: int) -> None:
    """Look up the current of a load some way down a rod, of the rise in a row."""
    for i in range(LANES):
        s[lane.DEPTH + i] = -s[lane.Z + i] - at * s[rise + i]
    look_up(s, water)


def turn_together(s: Floats, water: Tables, way: Way, stage: int) -> None:
    """Find the axis of a rod of constant drags; the first hangs on nothing, and may float."""
    rod, loads, heads = way.course.stages[stage], way.course.loads, stage == 0
    normals = 0
    for j in range(rod.first, rod.first + rod.size):
        normals += 1 if loads[j].directional else 0
    many = normals > 1
    for _ in range(MOST_PASSES):
        for i in range(LANES):
            settled = s[lane.CHANGE + i] <= way.near
            s[lane.TRIED + i] = s[lane.TRIED + i] if settled else s[lane.NZ + i]
        if heads:
            for i in range(LANES):
                bring_to_waterline(s, i, s[lane.TRIED + i])
        for i in range(LANES):
            s[lane.AX + i], s[lane.AY + i] = s[lane.FX + i], s[lane.FY + i]
            s[lane.AZ + i], s[lane.K + i] = s[lane.FZ + i], 0.0
            s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i] = 0.0, 0.0, 0.0
        for j in range(rod.first, rod.first + rod.size):
            load = in_registers(loads[j])
            look_up_load(s, water, load.at, lane.TRIED)
            gather_load(s, load, way.places[j], water.sea.gravity, many)
        if many:
            mean_current(s)
        for i in range(LANES):
            ax, ay, az = s[lane.AX + i], s[lane.AY + i], s[lane.AZ + i]
            s[lane.C + i], s[lane.DOUBT + i] = few_steps_share(
                ax, ay, az, s[lane.K + i], sqrt(ax * ax + ay * ay + az * az),
                s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i], 2,
            )  # fmt: skip
        exact_shares(s)
        for i in range(LANES):
            nx, ny, nz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
            tx, ty, tz = axis_in_lane(s, i)
            settled = s[lane.CHANGE + i] <= way.near
            sideways = abs(tx - nx) + abs(ty - ny)
            change = (rod.length + (s[lane.OUT + i] if heads else 0.0)) * (
                abs(tz - nz) + (sideways if many else 0.0)
            )
            s[lane.NX + i] = nx if settled else tx
            s[lane.NY + i] = ny if settled else ty
            s[lane.NZ + i] = nz if settled else tz
            s[lane.CHANGE + i] = s[lane.CHANGE + i] if settled else change
        if all_settled(s, way.near):
            break


def bring_to_waterline(s: Floats, i: int, tz: float) -> None:
    """Put a lane's free end where its length out of the water has it, at a rise of the head."""
    s[lane.Z + i] = -s[lane.FREE_END + i] - (s[lane.OUT + i] * tz if tz < 0.0 else 0.0)


def axis_in_lane(s: Floats, i: int) -> tuple[float, float, float]:
    """Axis along what turns a lane's element."""
    c = s[lane.C + i]
    return axis_against(
        s[lane.AX + i] + c * s[lane.GX + i],
        s[lane.AY + i] + c * s[lane.GY + i],
        s[lane.AZ + i] + c * s[lane.GZ + i],
    )


def all_settled(s: Floats, near: float) -> bool:
    """Whether no lane's axis changes any more; one that has failed does."""
    settling = False
    for i in range(LANES):
        settling |= not s[lane.CHANGE + i] <= near
    return not settling


def mean_current(s: Floats) -> None:
    """One current and coefficient that reproduce the sum of several normal drags."""
    for i in range(LANES):
        total = s[lane.K + i]
        divisor = total if total > 0.0 else 1.0
        gx, gy, gz = s[lane.GX + i] / divisor, s[lane.GY + i] / divisor, s[lane.GZ + i] / divisor
        across = speed_across(gx, gy, gz, s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i])
        s[lane.K + i] = total / across if across > 0.0 else 0.0
        s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i] = gx, gy, gz


def pass_piece(s: Floats, water: Tables, load: Load, length: float, near: float) -> None:
    """Take all lanes down a rod of one load: as `pass_rod`, in fewer steps."""
    gravity, lever = water.sea.gravity, load.lever
    turning = lever * load.normal_drag if load.directional else 0.0
    steady = 0.0 if load.directional else lever * load.normal_drag
    for _ in range(MOST_PASSES):
        look_up_load(s, water, load.at, lane.TRIED)
        for i in range(LANES):
            u, v, w, density = s[lane.U + i], s[lane.V + i], s[lane.W + i], s[lane.DENSITY + i]
            squared = u * u + v * v + w * w
            drag = density * lane.PER_DENSITY * steady * sqrt(squared)
            lift = lever * load_lift(load, squared, density, gravity)
            ax, ay = s[lane.FX + i] + drag * u, s[lane.FY + i] + drag * v
            az = s[lane.FZ + i] + lift + drag * w
            k = density * lane.PER_DENSITY * turning
            size = sqrt(ax * ax + ay * ay + az * az)
            c, doubt = few_steps_share(ax, ay, az, k, size, u, v, w, 1)
            s[lane.AX + i], s[lane.AY + i], s[lane.AZ + i] = ax, ay, az
            s[lane.K + i], s[lane.C + i], s[lane.DOUBT + i] = k, c, doubt
            s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i] = u, v, w
        exact_shares(s)
        for i in range(LANES):
            tx, ty, tz = axis_in_lane(s, i)
            settled = s[lane.CHANGE + i] <= near
            nx, ny, nz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
            change = length * abs(tz - nz)
            tx, ty, tz = nx if settled else tx, ny if settled else ty, nz if settled else tz
            change = s[lane.CHANGE + i] if settled else change
            s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i] = tx, ty, tz
            s[lane.CHANGE + i] = change
            s[lane.TRIED + i] = s[lane.TRIED + i] if change <= near else tz
        if all_settled(s, near):
            break
    for i in range(LANES):
        tx, ty, tz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
        u, v, w, density = s[lane.GX + i], s[lane.GY + i], s[lane.GZ + i], s[lane.DENSITY + i]
        qx, qy, qz = load_force(load, 1.0, u, v, w, density, gravity, tx, ty, tz)
        fx, fy, fz = s[lane.FX + i], s[lane.FY + i], s[lane.FZ + i]
        pull = -((fx + lever * qx) * tx + (fy + lever * qy) * ty + (fz + lever * qz) * tz)
        least = s[lane.LEAST_PULL + i]
        pull = pull if s[lane.CHANGE + i] <= near else -1.0
        s[lane.LEAST_PULL + i] = pull if pull < least else least
        s[lane.SX + i], s[lane.SY + i], s[lane.SZ + i] = qx, qy, qz
    come_below(s, length)


def turn_singly(desk: Desk, way: Way, stage: int) -> None:
    """Find the axis of a rod in each lane that has a case, by the plain march's passes."""
    s, water, mine = desk.scratch, desk.water, desk.loads
    rod, heads = way.course.stages[stage], stage == 0
    here = Stage(rod.kind, 0, rod.size, rod.length)
    for i in range(LANES):
        if s[lane.BUSY + i] == 0.0 or lost(s, i):
            continue
        for j in range(rod.size):
            mine[j] = way.course.loads[rod.first + j]
            load = way.course.loads[rod.first + j]
            loaded = load_in_lane(s, i, load, way.places[rod.first + j], water.sea.gravity)
            mine[j].buoyancy, mine[j].volume, mine[j].lift = (
                loaded.buoyancy, loaded.volume, loaded.lift,
            )  # fmt: skip
            mine[j].normal_drag, mine[j].tangential_drag = (
                loaded.normal_drag, loaded.tangential_drag,
            )  # fmt: skip
            mine[j].push_east, mine[j].push_north = loaded.push_east, loaded.push_north
        pace = 1.0
        for _ in range(MOST_PASSES):
            if s[lane.CHANGE + i] <= way.near:
                break
            x, y, z = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
            if heads:
                bring_to_waterline(s, i, z)
            tx, ty, tz = next_axis(here, mine, water.sea, state_of(s, water, i), x, y, z)
            tx, ty, tz = x + pace * (tx - x), y + pace * (ty - y), z + pace * (tz - z)
            size = sqrt(tx * tx + ty * ty + tz * tz)
            tx, ty, tz = tx / size, ty / size, tz / size
            reach = rod.length + (s[lane.OUT + i] if heads else 0.0)
            change = reach * (abs(tx - x) + abs(ty - y) + abs(tz - z)) / pace
            if change > 0.7 * s[lane.CHANGE + i]:
                pace *= 0.5
            s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i] = tx, ty, tz
            s[lane.CHANGE + i] = change


def add_singly(s: Floats, water: Tables, load: Load, place: int) -> None:
    """As `add_load`, of a load whose drag follows a curve."""
    for i in range(LANES):
        if s[lane.BUSY + i] == 0.0 or lost(s, i):
            continue
        mine = load_in_lane(s, i, load, place, water.sea.gravity)
        tx, ty, tz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
        depth = -s[lane.Z + i] - load.at * tz
        qx, qy, qz = force_at(mine, water.sea, depth, water.interval[i], tx, ty, tz)
        s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = qx, qy, qz
        s[lane.SX + i] += qx
        s[lane.SY + i] += qy
        s[lane.SZ + i] += qz
        s[lane.MX + i] += load.lever * qx
        s[lane.MY + i] += load.lever * qy
        s[lane.MZ + i] += load.lever * qz
