"""The cases of a batch, chunk by chunk: clear of the seabed, or lying on it.

The order in which the two are tried is that of `calm.solve.mooring`, but that a line is first
looked for clear of the seabed: there, where it carries its lower end all the way, the two are one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.batch.kernel.bends import as_planned
from calm.batch.kernel.closing import (
    HEAP,
    ON_SEABED,
    WRITTEN,
    Desk,
    Shapes,
    close_all,
    find_roots,
)
from calm.batch.kernel.compiled import compiled, entry
from calm.batch.kernel.contact import LIKELY, NEVER
from calm.batch.kernel.lanes import LANES, SCRATCH, STATE
from calm.batch.kernel.profile import growth_below, lay_profile, read_profile
from calm.batch.kernel.search import (
    COLUMNS,
    FALL,
    FOUND,
    GROWTH,
    LEAST_CARRIED,
    LOWER_MISS,
    LYING,
    SLOPE,
    SOLVED,
    SPEED,
    TURNS_BACK,
    Y,
    begin,
)
from calm.physics.line import Floats, Integers

# how a case ended, besides
NO_DATA, LEVELS_COINCIDE, STILL = 1, 2, 3
SAGS, LIFTED, NOT_TRIED = 14, 15, 16

CHUNK = 256
"""Cases that are laid out at once: enough to keep the lanes busy, and to fit a cache."""
EITHER_WAY = 1e-4
"""How near to the longest length that has barely landed another is either way, as a share of the
water depth."""


@compiled
def read_case(
    c: int, plan: Any, tables: Any, seek: Floats, depth: Floats, u: Floats, v: Floats, w: Floats
) -> int:
    """Lay a profile out in a slot and set out on its case; returns why it needs no search."""
    bounds, rows, read, joined = tables
    _, _, mooring, _, chances, fixed = plan
    found = read_profile(depth, u, v, w, read)
    if found <= 0:
        return NO_DATA if found == 0 else LEVELS_COINCIDE
    total = lay_profile(read, found, fixed, bounds[c], rows[c], joined)
    growth, speed = growth_below(joined, total, mooring[2])
    begin(seek, c, growth, speed, mooring[2], chances[1])
    return SOLVED if speed > 0.0 else STILL


@compiled
def as_on_seabed(seek: Floats, c: int, mooring: Any) -> int:
    """Whether a line found clear of the seabed is what the search for one that lies there finds.

    That one brings the line's end down to the seabed: a float that just reaches the surface then
    is under water, where there may be another root.
    """
    if seek[c, LEAST_CARRIED] <= 0.0:
        return SAGS
    dips = seek[c, Y] < 0.0 and seek[c, LOWER_MISS] >= -mooring[5]
    return TURNS_BACK if dips and seek[c, FALL] > 0.0 else SOLVED


@compiled
def look_on_seabed(
    desk: Desk, plans: Any, seek: Floats, shapes: Shapes, ends: Integers, start: int, results: Any
) -> None:
    """Look on the seabed for the cases that have not been closed clear of it."""
    clear, lying, contact = plans
    mooring, chances = lying[2], lying[4]
    there = np.full(ends.size, WRITTEN)
    aloft = seek.copy()
    for c in range(ends.size):
        if ends[c] == ON_SEABED or (contact == LIKELY and ends[c] > STILL and ends[c] != WRITTEN):
            there[c] = SOLVED
            begin(seek, c, seek[c, GROWTH], seek[c, SPEED], mooring[2], chances[1])
            as_planned(desk[4], c, lying[0])
    find_roots(desk, lying, seek, there)
    for c in range(ends.size):
        if there[c] == SOLVED and seek[c, LYING] < 0.0:
            there[c] = LIFTED
    tried = there != WRITTEN
    close_all(desk, lying, seek, shapes, there, start, results)
    again = np.full(ends.size, WRITTEN)
    limit, margin = mooring[7], EITHER_WAY * mooring[0]
    for c in range(ends.size):
        if not tried[c]:
            continue
        closed = there[c] == WRITTEN or there[c] == HEAP
        beyond = seek[c, LYING] - limit
        if closed and beyond > margin:
            ends[c] = there[c]
        elif closed and (there[c] == HEAP or (limit > 0.0 and beyond > -margin)):
            ends[c] = LIFTED
        elif ends[c] == SAGS and (closed or there[c] == LIFTED):
            again[c] = SOLVED
            for column in (Y, SLOPE, FOUND):
                seek[c, column] = aloft[c, column]
        elif ends[c] == ON_SEABED and closed:
            ends[c] = WRITTEN
        else:
            ends[c] = LIFTED if closed else there[c]
    retried = again == SOLVED
    close_all(desk, clear, seek, shapes, again, start, results)
    for c in range(ends.size):
        if retried[c]:
            lies = again[c] == ON_SEABED and there[c] == WRITTEN
            ends[c] = WRITTEN if lies else again[c]


@entry
def solve_cases(
    plans: Any, depth: Floats, u: Floats, v: Floats, w: Floats, results: Any, reasons: Integers
) -> None:
    """Solve cases; what they lead to goes to their rows of the results, how they ended to reasons.

    Parameters
    ----------
    plans : the arrays of `calm.batch.kernel.plan.Plan`
    depth : (1 or n, k) of the levels [m]
    u, v, w : (n, k) current [m/s]; NaN where there is none
    results : see `calm.batch.kernel.outcome`
    reasons : (n,)
    """
    clear, lying, contact = plans
    stages, fixed = clear[0], clear[5]
    kinds, loads = stages[0], stages[6]
    levels = depth.shape[1] + fixed.shape[0]
    bounds, rows = np.zeros((CHUNK, levels + 2)), np.zeros((CHUNK, levels + 1, 8))
    tables = (bounds, rows, np.zeros((levels, 4)), np.zeros((levels, 5)))
    water = (np.zeros(LANES, np.int64), np.zeros(LANES, np.int64), bounds, rows)
    nodes = np.zeros(STATE * LANES * (kinds.size + 1))
    forces = np.zeros(3 * LANES * loads.shape[0])
    own = np.zeros((3, CHUNK, lying[0][5].size))
    desk = (np.zeros(SCRATCH), water, nodes, forces, own)
    size = (nodes.size + forces.size) // LANES
    shapes = (np.zeros((CHUNK, size)), np.zeros((CHUNK, size)), np.zeros(CHUNK), np.zeros(size))
    seek, all_ends = np.zeros((CHUNK, COLUMNS)), np.zeros(CHUNK, np.int64)
    for start in range(0, reasons.size, CHUNK):
        ends = all_ends[: min(CHUNK, reasons.size - start)]
        for c in range(ends.size):
            case = start + c
            levels_at = depth[case if depth.shape[0] > 1 else 0]
            ends[c] = read_case(c, clear, tables, seek, levels_at, u[case], v[case], w[case])
        find_roots(desk, clear, seek, ends)
        if contact == LIKELY:
            for c in range(ends.size):
                if ends[c] == SOLVED:
                    ends[c] = as_on_seabed(seek, c, clear[2])
        close_all(desk, clear, seek, shapes, ends, start, results)
        if contact != NEVER:
            look_on_seabed(desk, plans, seek, shapes, ends, start, results)
        for c in range(ends.size):
            reasons[start + c] = SOLVED if ends[c] == WRITTEN else ends[c]
