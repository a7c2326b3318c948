"""A line that comes down on the seabed, in the lanes: `calm.physics.seabed`.

A lane that has come down marches on with the others, to no effect: below each stage it is put
back to where it was, and what of the stage lies is laid out from there.
"""

from __future__ import annotations

from math import inf, sqrt

from calm.batch.kernel import lane
from calm.batch.kernel.bends import DOWN
from calm.batch.kernel.cable import cable_of, is_packed, pass_packed, pass_singly, set_cut
from calm.batch.kernel.lane import EXTREMES, LANES, SINGLY, STATE, Tables
from calm.batch.kernel.layout import Way
from calm.physics.cable import strain_at
from calm.physics.line import Floats
from calm.physics.seabed import held_back, lying_strain
from calm.physics.track import CABLE, ROD, Course

MOST_TURN = 0.2
"""What a segment may turn, and its arc be told from it [rad]; beyond, it is a corner."""


def keep(s: Floats) -> None:
    """Keep the state of all lanes, and its extremes."""
    for i in range(STATE * LANES):
        s[lane.KEPT + i] = s[i]
    for i in range(EXTREMES * LANES):
        s[lane.KEPT + STATE * LANES + i] = s[lane.LOWEST + i]


def put_back(s: Floats, i: int) -> None:
    """Put a lane back to where it was kept, in no current."""
    for row in range(STATE):
        s[row * LANES + i] = s[lane.KEPT + row * LANES + i]
    for row in range(EXTREMES):
        s[lane.LOWEST + row * LANES + i] = s[lane.KEPT + (STATE + row) * LANES + i]
    s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = 0.0, 0.0, 0.0


def land(s: Floats, i: int, hanging: float, stage: int) -> None:
    """A lane comes down where it is, below so much of a stage; what follows lies straight on."""
    fx, fy = s[lane.FX + i], s[lane.FY + i]
    tension = sqrt(fx * fx + fy * fy)
    s[lane.FZ + i] = 0.0
    s[lane.TX + i] = -fx / tension if tension > 0.0 else 1.0
    s[lane.TY + i] = -fy / tension if tension > 0.0 else 0.0
    s[lane.TZ + i] = 0.0
    s[lane.HANGING + i], s[lane.RESTING + i], s[lane.LANDED_AT + i] = hanging, 0.0, stage
    for row in range(STATE):
        s[lane.KEPT + row * LANES + i] = s[row * LANES + i]
    for row in range(EXTREMES):
        s[lane.KEPT + (STATE + row) * LANES + i] = s[lane.LOWEST + row * LANES + i]


def pass_to_seabed(
    s: Floats, water: Tables, way: Way, stage: int, halvings: int, own: Floats
) -> None:
    """Take all lanes down a stretch of cable by their own cuts, and see where they come down.

    How much each cut turns is noted in `own`, see `calm.batch.kernel.bends`.
    """
    course, slot = way.course, water.slot
    cable = course.stages[stage].first
    packed, stretch = is_packed(course, stage), cable_of(course, stage)
    may_land = stage >= course.landing
    parts = 1 << halvings
    one = min(parts, 1)  # a constant would have the compiler make a segment of its own for it
    for i in range(LANES):
        s[lane.PASSED + i] = 0.0
    for j in range(way.first_cut[cable], way.first_cut[cable + 1]):
        hanging = False
        for i in range(LANES):
            set_cut(s, i, own[0, slot[i], j] / parts)
            s[lane.TURNED + i] = DOWN if s[lane.RESTING + i] >= 0.0 else 0.0
            hanging |= s[lane.RESTING + i] < 0.0
        if not hanging:
            for i in range(LANES):
                own[2, slot[i], j] = DOWN
            continue
        for _ in range(parts):
            for i in range(LANES):
                s[lane.CARRIED + i] = s[lane.FZ + i]
                s[lane.LOWEST_BEFORE + i] = s[lane.LOWEST + i]
                s[lane.NX + i], s[lane.NY + i] = s[lane.TX + i], s[lane.TY + i]
                s[lane.NZ + i], s[lane.CHANGE + i] = s[lane.TZ + i], s[lane.RESTING + i]
            if packed:
                pass_packed(s, water, stretch, one)
            elif SINGLY:
                pass_singly(s, water, course, stage)
            landing = False
            for i in range(LANES):
                landing |= s[lane.CARRIED + i] > 0.0 and s[lane.FZ + i] <= 0.0
            if landing and may_land:
                for i in range(LANES):
                    lands = s[lane.CARRIED + i] > 0.0 and s[lane.FZ + i] <= 0.0
                    if s[lane.RESTING + i] < 0.0 and lands:
                        touch_down(s, i, course, stage)
            add_turn(s)
        for i in range(LANES):
            own[2, slot[i], j] = s[lane.TURNED + i]


def add_turn(s: Floats) -> None:
    """Add what the last segment turned, unless it is the first of its stretch, or lies."""
    for i in range(LANES):
        axis = lane.KEPT + lane.TX if s[lane.RESTING + i] >= 0.0 else lane.TX
        x = s[axis + i] - s[lane.NX + i]
        y = s[axis + lane.TY - lane.TX + i] - s[lane.NY + i]
        z = s[axis + lane.TZ - lane.TX + i] - s[lane.NZ + i]
        turn = sqrt(x * x + y * y + z * z)
        if not (s[lane.PASSED + i] > 0.0 and s[lane.CHANGE + i] < 0.0):
            turn = 0.0
        s[lane.TURNED + i] += turn
        corner = turn * s[lane.CUT + i] if turn > MOST_TURN else 0.0
        s[lane.SHARPEST + i] = corner if corner > s[lane.SHARPEST + i] else s[lane.SHARPEST + i]
        s[lane.PASSED + i] += s[lane.CUT + i]


def touch_down(s: Floats, i: int, course: Course, stage: int) -> None:
    """Take a lane back up its last segment, to where nothing was left to carry.

    The load of a metre there is that of the segment: the touchdown is off by a share of it that
    shrinks with the segment, where the line is level.
    """
    cable = course.cables[course.stages[stage].first]
    qx, qy, qz, cut = s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i], s[lane.CUT + i]
    half = 0.5 * cut
    gx, gy, gz = s[lane.FX + i] - half * qx, s[lane.FY + i] - half * qy, s[lane.FZ + i] - half * qz
    pull = sqrt(gx * gx + gy * gy + gz * gz)
    stretched = cut * (1.0 + strain_at(cable, course.knots, pull))
    s[lane.X + i] -= stretched * s[lane.TX + i]
    s[lane.Y + i] -= stretched * s[lane.TY + i]
    s[lane.Z + i] -= stretched * s[lane.TZ + i]
    hanging = cut * s[lane.CARRIED + i] / (s[lane.CARRIED + i] - s[lane.FZ + i])
    left = half - 0.5 * hanging
    gx, gy, gz = gx - left * qx, gy - left * qy, gz - left * qz
    pull = sqrt(gx * gx + gy * gy + gz * gz)
    rise = 0.0
    if pull > 0.0:
        rise = -hanging * (1.0 + strain_at(cable, course.knots, pull)) / pull
    s[lane.X + i] += rise * gx
    s[lane.Y + i] += rise * gy
    s[lane.Z + i] += rise * gz
    s[lane.FX + i] -= (cut - hanging) * qx
    s[lane.FY + i] -= (cut - hanging) * qy
    s[lane.LOWEST + i] = s[lane.LOWEST_BEFORE + i]
    land(s, i, s[lane.PASSED + i] + hanging, stage)


def come_down(s: Floats, kind: int, stage: int) -> None:
    """See which lanes a rod or clamp lets down: it stands on the seabed, or tips over and lies."""
    for i in range(LANES):
        carried = s[lane.KEPT + lane.FZ + i]
        if s[lane.RESTING + i] < 0.0 and carried > 0.0 and s[lane.FZ + i] <= 0.0:
            if kind == ROD and s[lane.NZ + i] >= 0.0:
                put_back(s, i)
                land(s, i, 0.0, stage)
            else:
                land(s, i, inf, stage + 1)


def lie_down(s: Floats, way: Way, stage: int) -> None:
    """Lay out, in the lanes that have come down, what lies of a stage."""
    course = way.course
    here = course.stages[stage]
    per_metre, whole = way.seabed.grips[stage, 0], way.seabed.grips[stage, 1]
    for i in range(LANES):
        if s[lane.RESTING + i] >= 0.0:
            put_back(s, i)
            length = here.length - s[lane.HANGING + i]
            if s[lane.HANGING + i] < inf:
                fx, fy = s[lane.FX + i], s[lane.FY + i]
                tension = sqrt(fx * fx + fy * fy)
                pulled, left = held_back(tension, per_metre * length + whole)
                strain = 0.0
                if here.kind == CABLE:
                    cable = course.cables[here.first]
                    strain = lying_strain(cable, course.knots, pulled, tension, left)
                s[lane.X + i] += length * (1.0 + strain) * s[lane.TX + i]
                s[lane.Y + i] += length * (1.0 + strain) * s[lane.TY + i]
                s[lane.FX + i] = -left * s[lane.TX + i]
                s[lane.FY + i] = -left * s[lane.TY + i]
                s[lane.RESTING + i] += length
            s[lane.HANGING + i] = 0.0


def lie_loads(s: Floats, way: Way, stage: int, record: Floats) -> None:
    """Record what every load of a rod that lies takes off the tension [N].

    Where the line comes down on it, or the tension does not get past it, that is not to be had.
    """
    rod, holds = way.course.stages[stage], way.seabed.holds
    hold = 0.0
    for j in range(rod.first, rod.first + rod.size):
        hold += holds[j]
    for i in range(LANES):
        if s[lane.RESTING + i] >= 0.0:
            fx = s[lane.KEPT + lane.FX + i] - s[lane.FX + i]
            fy = s[lane.KEPT + lane.FY + i] - s[lane.FY + i]
            taken = sqrt(fx * fx + fy * fy)
            left = s[lane.FX + i] != 0.0 or s[lane.FY + i] != 0.0
            if s[lane.LANDED_AT + i] >= stage or (taken > 0.0 and not left):
                s[lane.LEAST_PULL + i] = -1.0
            for j in range(rod.first, rod.first + rod.size):
                share = taken / hold * holds[j] if hold > 0.0 else 0.0
                record[(3 * j) * LANES + i] = share * s[lane.TX + i]
                record[(3 * j + 1) * LANES + i] = share * s[lane.TY + i]
                record[(3 * j + 2) * LANES + i] = 0.0
