"""A line that comes down on the seabed, in the lanes: `calm.physics.seabed`.

A lane that has come down marches on with the others, to no effect: below each stage it is put
back to where it was, and what of the stage lies is laid out from there.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from calm.batch.kernel.bends import DOWN
from calm.batch.kernel.cable import pass_own_segments
from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    C_COMPLIANCE,
    CARRIED,
    CHANGE,
    CUT,
    DONE,
    EXTREMES,
    FX,
    FY,
    FZ,
    HANGING,
    KEPT,
    LANDED_AT,
    LANES,
    LEAST_PULL,
    LOWEST,
    LOWEST_BEFORE,
    NX,
    NY,
    NZ,
    QX,
    QY,
    QZ,
    RESTING,
    ROD,
    SHARPEST,
    STATE,
    TURNED,
    TX,
    TY,
    TZ,
    Tables,
    X,
    Y,
    Z,
)
from calm.physics.line import Floats

MOST_TURN = 0.2
"""What a segment may turn, and its arc be told from it [rad]; beyond, it is a corner."""

Stretch = tuple[int, int, int]
"""Which stage a stretch of cable is, its first cut and how many it has."""


@compiled
def keep(s: Floats) -> None:
    """Keep the state of all lanes, and its extremes."""
    for i in range(STATE * LANES):
        s[KEPT + i] = s[i]
    for i in range(EXTREMES * LANES):
        s[KEPT + STATE * LANES + i] = s[LOWEST + i]


@compiled
def put_back(s: Floats, i: int) -> None:
    """Put a lane back to where it was kept, in no current."""
    for row in range(STATE):
        s[row * LANES + i] = s[KEPT + row * LANES + i]
    for row in range(EXTREMES):
        s[LOWEST + row * LANES + i] = s[KEPT + (STATE + row) * LANES + i]
    s[QX + i], s[QY + i], s[QZ + i] = 0.0, 0.0, 0.0


@compiled
def land(s: Floats, i: int, hanging: float, stage: int) -> None:
    """A lane comes down where it is, below so much of a stage; what follows lies straight on."""
    fx, fy = s[FX + i], s[FY + i]
    tension = sqrt(fx * fx + fy * fy)
    s[FZ + i] = 0.0
    s[TX + i] = -fx / tension if tension > 0.0 else 1.0
    s[TY + i] = -fy / tension if tension > 0.0 else 0.0
    s[TZ + i] = 0.0
    s[HANGING + i], s[RESTING + i], s[LANDED_AT + i] = hanging, 0.0, stage
    for row in range(STATE):
        s[KEPT + row * LANES + i] = s[row * LANES + i]
    for row in range(EXTREMES):
        s[KEPT + (STATE + row) * LANES + i] = s[LOWEST + row * LANES + i]


@compiled
def pass_to_seabed(
    s: Floats, water: Tables, cable: Floats, own: Floats, stretch: Stretch, halvings: int,
    gravity: float, may_land: bool,
) -> None:  # fmt: skip
    """Take all lanes down a stretch of cable by their own cuts, and see where they come down.

    How much each cut turns is noted in `own`, see `calm.batch.kernel.bends`.
    """
    stage, first, count = stretch
    slots = water[0]
    one = np.zeros(1)
    parts = 1 << halvings
    for i in range(LANES):
        s[DONE + i] = 0.0
    for j in range(first, first + count):
        hanging = False
        for i in range(LANES):
            s[CUT + i] = own[0, slots[i], j] / parts
            s[TURNED + i] = DOWN if s[RESTING + i] >= 0.0 else 0.0
            hanging |= s[RESTING + i] < 0.0
        if not hanging:
            for i in range(LANES):
                own[2, slots[i], j] = DOWN
            continue
        for _ in range(parts):
            for i in range(LANES):
                s[CARRIED + i], s[LOWEST_BEFORE + i] = s[FZ + i], s[LOWEST + i]
                s[NX + i], s[NY + i], s[NZ + i] = s[TX + i], s[TY + i], s[TZ + i]
                s[CHANGE + i] = s[RESTING + i]
            pass_own_segments(s, water, cable, one, 0, gravity)
            landing = False
            for i in range(LANES):
                landing |= s[CARRIED + i] > 0.0 and s[FZ + i] <= 0.0
            if landing and may_land:
                for i in range(LANES):
                    if s[RESTING + i] < 0.0 and s[CARRIED + i] > 0.0 and s[FZ + i] <= 0.0:
                        touch_down(s, i, cable[C_COMPLIANCE], stage)
            add_turn(s)
        for i in range(LANES):
            own[2, slots[i], j] = s[TURNED + i]


@compiled
def add_turn(s: Floats) -> None:
    """Add what the last segment turned, unless it is the first of its stretch, or lies."""
    for i in range(LANES):
        axis = KEPT + TX if s[RESTING + i] >= 0.0 else TX
        x, y, z = (
            s[axis + i] - s[NX + i],
            s[axis + TY - TX + i] - s[NY + i],
            s[axis + TZ - TX + i] - s[NZ + i],
        )
        turn = sqrt(x * x + y * y + z * z)
        if not (s[DONE + i] > 0.0 and s[CHANGE + i] < 0.0):
            turn = 0.0
        s[TURNED + i] += turn
        corner = turn * s[CUT + i] if turn > MOST_TURN else 0.0
        s[SHARPEST + i] = corner if corner > s[SHARPEST + i] else s[SHARPEST + i]
        s[DONE + i] += s[CUT + i]


@compiled
def touch_down(s: Floats, i: int, compliance: float, stage: int) -> None:
    """Take a lane back up its last segment, to where nothing was left to carry.

    The load of a metre there is that of the segment: the touchdown is off by a share of it that
    shrinks with the segment, where the line is level.
    """
    qx, qy, qz, cut = s[QX + i], s[QY + i], s[QZ + i], s[CUT + i]
    half = 0.5 * cut
    gx, gy, gz = s[FX + i] - half * qx, s[FY + i] - half * qy, s[FZ + i] - half * qz
    stretched = cut * (1.0 + compliance * sqrt(gx * gx + gy * gy + gz * gz))
    s[X + i] -= stretched * s[TX + i]
    s[Y + i] -= stretched * s[TY + i]
    s[Z + i] -= stretched * s[TZ + i]
    hanging = cut * s[CARRIED + i] / (s[CARRIED + i] - s[FZ + i])
    left = half - 0.5 * hanging
    gx, gy, gz = gx - left * qx, gy - left * qy, gz - left * qz
    pull = sqrt(gx * gx + gy * gy + gz * gz)
    rise = -hanging * (1.0 / pull + compliance) if pull > 0.0 else 0.0
    s[X + i] += rise * gx
    s[Y + i] += rise * gy
    s[Z + i] += rise * gz
    s[FX + i] -= (cut - hanging) * qx
    s[FY + i] -= (cut - hanging) * qy
    s[LOWEST + i] = s[LOWEST_BEFORE + i]
    land(s, i, s[DONE + i] + hanging, stage)


@compiled
def come_down(s: Floats, kind: int, stage: int) -> None:
    """See which lanes a rod or clamp lets down: it stands on the seabed, or tips over and lies."""
    for i in range(LANES):
        carried = s[KEPT + FZ + i]
        if s[RESTING + i] < 0.0 and carried > 0.0 and s[FZ + i] <= 0.0:
            if kind == ROD and s[NZ + i] >= 0.0:
                put_back(s, i)
                land(s, i, 0.0, stage)
            else:
                land(s, i, inf, stage + 1)


@compiled
def lie_down(s: Floats, length: float, grip: Floats, compliance: float) -> None:
    """Lay out, in the lanes that have come down, what lies of a stage.

    `grip` is the friction on a metre of cable, and on a whole rod or clamp [N].
    """
    for i in range(LANES):
        if s[RESTING + i] >= 0.0:
            put_back(s, i)
            lying = length - s[HANGING + i]
            if s[HANGING + i] < inf:
                rest(s, i, lying, grip[0] * lying + grip[1], compliance)
            s[HANGING + i] = 0.0


@compiled
def rest(s: Floats, i: int, length: float, hold: float, compliance: float) -> None:
    """Lay a lane's line out along a length that friction holds by so much [N]."""
    fx, fy = s[FX + i], s[FY + i]
    tension = sqrt(fx * fx + fy * fy)
    left, pulled = tension - hold, 1.0
    if not hold <= tension:
        left, pulled = 0.0, tension / hold
    stretched = length * (1.0 + pulled * compliance * 0.5 * (tension + left))
    s[X + i] += stretched * s[TX + i]
    s[Y + i] += stretched * s[TY + i]
    s[FX + i], s[FY + i] = -left * s[TX + i], -left * s[TY + i]
    s[RESTING + i] += length


@compiled
def lie_loads(s: Floats, holds: Floats, stage: int, record: Floats) -> None:
    """Record what every load of a rod that lies takes off the tension [N].

    Where the line comes down on it, or the tension does not get past it, that is not to be had.
    """
    hold = holds.sum()
    for i in range(LANES):
        if s[RESTING + i] >= 0.0:
            fx, fy = s[KEPT + FX + i] - s[FX + i], s[KEPT + FY + i] - s[FY + i]
            taken = sqrt(fx * fx + fy * fy)
            left = s[FX + i] != 0.0 or s[FY + i] != 0.0
            if s[LANDED_AT + i] >= stage or (taken > 0.0 and not left):
                s[LEAST_PULL + i] = -1.0
            for j in range(holds.size):
                share = taken / hold * holds[j] if hold > 0.0 else 0.0
                record[(3 * j) * LANES + i] = share * s[TX + i]
                record[(3 * j + 1) * LANES + i] = share * s[TY + i]
                record[(3 * j + 2) * LANES + i] = 0.0
