"""Sixteen cases at a time: where each lane's numbers stand, and the water it is in.

Every case has its lane. A lane's state lies in one flat scratch array, a row of sixteen numbers
for each quantity, so that the compiler sees that the rows do not overlap and computes all lanes
at once: the force of lane i is ``s[lane.FX + i]``. What a lane yields depends on its own case
alone: once settled it is frozen.

The laws are those of `calm.physics`, compiled into the lanes' loops.
"""

from __future__ import annotations

from math import nan
from typing import Any, NamedTuple

from calm.physics.element import drag_share
from calm.physics.line import Floats, Integers
from calm.physics.profile import Sea, water_at
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.state import State

LANES = 16

SINGLY = True
"""Whether laws are compiled that each lane takes by itself: the compiler sets it False for moorings
without any, where it is looked at as a bare name."""

(
    # place, force above, axis: these are recorded
    X, Y, Z, FX, FY, FZ, TX, TY, TZ,
    # load per metre of the last segment; pull at its middle; where to look up; length of the next
    # and the number of them to a metre
    QX, QY, QZ, PULL, DEPTH, CUT, PER_METRE,
    # current and density there
    U, V, W, DENSITY,
    # what turns an element, and how its drag shares in it: see `calm.physics.element`
    AX, AY, AZ, K, GX, GY, GZ, C, DOUBT, AREA,
    # extremes of heights, of the vertical force low down, of the pull
    LOWEST, HIGHEST, LIGHTEST, LEAST_PULL,
    # how the free end is placed, and whether there is a case in the lane
    FREE_END, SHARE, OUT, WET, HELD, WIND_EAST, WIND_NORTH, BUSY,
    # axis of a rod, its rise where its loads are looked up, its last change
    NX, NY, NZ, TRIED, CHANGE,
    # sums of loads, and of what turns a rod
    SX, SY, SZ, MX, MY, MZ,
    # the length on the seabed, below 0 where none is; how much hangs of the stage that came down,
    # and which it is; before a segment the vertical force, the lowest height, and how much of the
    # stage is above it; what a cut turned; turn times length of the worst corner;
    # shares in use of the floats at the surface above the one that is sought
    RESTING, HANGING, LANDED_AT, CARRIED, LOWEST_BEFORE, PASSED, TURNED, SHARPEST, UPPER,
) = (row * LANES for row in range(62))  # fmt: skip
MOST_UPPER = 3
"""Floats at the surface above the one that is sought."""
KEPT = UPPER + MOST_UPPER * LANES
"""What is kept of a stage, and its extremes."""
EXTREMES = 4
STATE = 9  # numbers of a recorded node: place, force, axis
SCRATCH = KEPT + (STATE + EXTREMES) * LANES

PER_DENSITY = 1.0 / REFERENCE_DENSITY
FAR = 1e8
CLOSE = 1e-6
MOST_PASSES = 30


class Tables(NamedTuple):
    """The water of the lanes.

    Attributes
    ----------
    slot, interval : (LANES,) the slot of every lane's profile, and the interval it is in
    sea : all slots, one after the other; as the levels of each go from -inf to inf, a search in
        one does not leave it
    width : how many intervals a slot has
    """

    slot: Integers
    interval: Integers
    sea: Sea
    width: int


class Desk(NamedTuple):
    """What the solving of a chunk of cases writes on: none of it is made anew meanwhile.

    Attributes
    ----------
    scratch, water : of the lanes
    nodes, forces : what a march records, of every joint and of every load
    own : cuts of every case, see `calm.batch.kernel.bends`
    loads : those of one rod in one lane
    task, marches : (LANES,) what a lane is about, and how many marches it took
    afloat : (2, cases, floats) of `Afloat`: the search for every float at the surface, of a line
        clear of the seabed and of one that may lie there
    pending, there, again : (cases,) cases to be closed, and how they end on the seabed, and clear
        of it after all
    read, joined : levels of a profile, and with those that every profile gets
    spread : (4, k) what cuts are dealt out from
    """

    scratch: Floats
    water: Tables
    nodes: Floats
    forces: Floats
    own: Floats
    loads: Any
    task: Integers
    marches: Integers
    afloat: Any
    pending: Integers
    there: Integers
    again: Integers
    read: Floats
    joined: Floats
    spread: Floats


def look_up(s: Floats, water: Tables) -> None:
    """Current and density of every lane at its depth."""
    for i in range(LANES):
        depth = s[DEPTH + i]
        if not abs(depth) < FAR:
            depth = 0.0
        u, v, w, density, at = water_at(water.sea, depth, water.interval[i])
        water.interval[i] = at
        s[U + i], s[V + i], s[W + i], s[DENSITY + i] = u, v, w, density


def state_of(s: Floats, water: Tables, i: int) -> State:
    """Where a lane stands."""
    at = water.interval[i]
    return s[X + i], s[Y + i], s[Z + i], s[FX + i], s[FY + i], s[FZ + i], s[TZ + i], at


def take(s: Floats, water: Tables, i: int, state: State) -> None:
    """Put a lane where a segment of its own has brought it."""
    x, y, z, fx, fy, fz, tz, at = state
    s[X + i], s[Y + i], s[Z + i], s[TZ + i] = x, y, z, tz
    s[FX + i], s[FY + i], s[FZ + i] = fx, fy, fz
    water.interval[i] = at
    s[LOWEST + i], s[HIGHEST + i] = min(s[LOWEST + i], z), max(s[HIGHEST + i], z)


def lost(s: Floats, i: int) -> bool:
    """Whether a lane is nowhere; from then on it is left alone."""
    if abs(s[X + i]) + abs(s[Y + i]) + abs(s[Z + i]) < FAR:
        return False
    s[Z + i] = nan
    return True


def exact_shares(s: Floats) -> None:
    """Solve the share of every lane whose Newton steps have not settled."""
    for i in range(LANES):
        if not s[DOUBT + i] < CLOSE:
            s[C + i] = drag_share(
                s[AX + i], s[AY + i], s[AZ + i], s[K + i], s[GX + i], s[GY + i], s[GZ + i]
            )
