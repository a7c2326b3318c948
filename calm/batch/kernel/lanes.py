"""The march for many current profiles of one mooring, sixteen cases at a time.

Every case has its lane. A lane's state lies in one flat scratch array, a row of sixteen numbers
for each quantity, so that the compiler sees that the rows do not overlap and computes all lanes
at once. What a lane yields depends on its own case alone: once settled it is frozen.

The balance of an element is that of `calm.physics.element`, whose functions are compiled in here.
"""

from __future__ import annotations

from calm.batch.kernel.compiled import compilable, compiled
from calm.physics.element import axis_along, drag_force, drag_share, share_step
from calm.physics.line import REFERENCE_DENSITY, Floats, Integers

for formula in (share_step, axis_along, drag_force, drag_share):
    compilable(formula)

LANES = 16

Tables = tuple[Integers, Integers, Floats, Floats]
"""For every lane the slot of its profile and the interval it is in; for every slot the bounds of
the intervals, and value at no depth and slope of u, v, w and density in each."""


# rows of the scratch array
(
    # place, force above, axis: these are recorded
    X, Y, Z, FX, FY, FZ, TX, TY, TZ,
    # load per metre of the last segment; pull at its middle; where to look up; length of the next
    QX, QY, QZ, PULL, DEPTH, CUT,
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
    # the length on the seabed, below 0 where none is; how much hangs of the stage that came down,
    # and which it is; before a segment the vertical force, the lowest height, and how much of the
    # stage is above it; what a cut turned; turn times length of the worst corner;
    # what is kept of a stage
    RESTING, HANGING, LANDED_AT, CARRIED, LOWEST_BEFORE, DONE, TURNED, SHARPEST, KEPT,
) = (row * LANES for row in range(66))  # fmt: skip
EXTREMES = 4

ROD, CABLE, CLAMP = 0, 1, 2
AT, LEVER, BUOYANCY, VOLUME, NORMAL, TANGENTIAL, LIFT, DIRECTIONAL, AFLOAT = range(9)
C_BUOYANCY, C_VOLUME, C_NORMAL, C_TANGENTIAL, C_COMPLIANCE, C_THINNING = range(6)
STATE = 9  # numbers of a recorded node: place, force, axis
SCRATCH = KEPT + (STATE + EXTREMES) * LANES
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
