"""Closing the lines of many cases: their roots sought in lanes, each by its own steps.

The miss and the order of the search are those of `calm.solve`: the highest root below the
surface, else the share of the buoyancy that a float at the surface uses. The unknown of a case is
the depth of its free end [m] where that is not negative, else the share less one. A lane takes up
the next case as soon as it is done with one.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from calm.batch.kernel.compiled import compiled, entry
from calm.batch.kernel.lanes import (
    FREE_END,
    HELD,
    HIGHEST,
    LANES,
    LEAST_PULL,
    LIGHTEST,
    LOWEST,
    OUT,
    SCRATCH,
    SHARE,
    STATE,
    WET,
    WIND_EAST,
    WIND_NORTH,
    Tables,
    Z,
)
from calm.batch.kernel.march import march
from calm.batch.kernel.outcome import blend, greatest_change, write_case
from calm.batch.kernel.profile import growth_below, lay_profile, read_profile
from calm.batch.kernel.search import (
    AWAY,
    COLUMNS,
    DONE,
    FIRST,
    NOWHERE,
    SOLVED,
    THERE,
    TURN,
    UNCLOSED,
    Y,
    advance,
    begin,
    correct,
)  # fmt: skip
from calm.physics.line import Floats, Integers

# how a case ended; those of the search are there
NO_DATA, LEVELS_COINCIDE, STILL = 1, 2, 3
OUT_OF_WATER, ON_SEABED, COMPRESSED, TOO_COARSE, WRITTEN, NOT_TRIED = range(8, 14)

CHUNK = 256
"""Cases that are laid out at once: enough to keep the lanes busy, and to fit a cache."""
FEWEST_HALVINGS, FINEST = 2, 6
"""How often the cuts are halved at least, and at most."""
PLACE_CHANGE, TENSION_CHANGE = 4e-5, 5e-5
"""What the last halving may change, as shares of the water depth and of the tension. The shape is
then blended from the last two, so that it is off by less; by about as much where currents are
ragged."""
MOST_MARCHES = 60

Desk = tuple[Floats, Tables, Floats, Floats]
"""What a march writes on: scratch, tables, recorded nodes and forces."""


@compiled
def place_free_end(s: Floats, i: int, y: float, riding: Floats, rigid: tuple[float, float]) -> None:
    """Put a lane's free end where its unknown has it."""
    s[FREE_END + i], s[SHARE + i], s[OUT + i] = y, 1.0, 0.0
    s[WET + i], s[HELD + i], s[WIND_EAST + i], s[WIND_NORTH + i] = 1.0, 1.0, 0.0, 0.0
    if y < 0.0:
        s[FREE_END + i], s[SHARE + i] = 0.0, 1.0 + y
        last = riding.shape[0] - 1
        at = (1.0 - sqrt(-y)) * last
        j = min(max(int(at), 0), last - 1)
        left = at - j
        standing = riding[j, 0] + left * (riding[j + 1, 0] - riding[j, 0])
        above = riding[j, 1] + left * (riding[j + 1, 1] - riding[j, 1])
        s[OUT + i] = above * rigid[0] + standing * rigid[1]
        s[WET + i] = 1.0 - above
        s[HELD + i] = riding[j, 2] + left * (riding[j + 1, 2] - riding[j, 2])
        s[WIND_EAST + i] = riding[j, 3] + left * (riding[j + 1, 3] - riding[j, 3])
        s[WIND_NORTH + i] = riding[j, 4] + left * (riding[j + 1, 4] - riding[j, 4])


@compiled
def find_roots(desk: Desk, plan: Any, seek: Floats, reasons: Integers) -> None:
    """Find the coarse root of every case whose reason is `SOLVED` so far: in its row of `seek`.

    Parameters
    ----------
    seek : (cases, COLUMNS) see `calm.batch.kernel.search`
    reasons : (cases,)
    """
    s, water, nodes, forces = desk
    stages, _, mooring, floating, chances, _ = plan
    slots, level = water[0], water[1]
    task = np.full(LANES, DONE)
    marches = np.zeros(LANES, np.int64)
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if task[i] == DONE:
                while upcoming < reasons.size and reasons[upcoming] != SOLVED:
                    upcoming += 1
                if upcoming < reasons.size:
                    slots[i], task[i], marches[i] = upcoming, FIRST, 0
                    level[i] = 0  # the last profile may have had more
                    upcoming += 1
            busy |= task[i] != DONE
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not busy:
            return
        march(s, water, stages, 0, nodes, forces)
        for i in range(LANES):
            if task[i] != DONE:
                c = slots[i]
                miss = s[Z + i] - mooring[1]
                task[i], reasons[c] = advance(seek, c, task[i], miss, mooring, chances[0])
                marches[i] += 1
                if marches[i] == MOST_MARCHES and task[i] != DONE:
                    task[i], reasons[c] = DONE, UNCLOSED


@compiled
def close_on(
    grid: int, desk: Desk, plan: Any, seek: Floats, pending: Integers, reasons: Integers,
    refusals: Integers, kept: Floats,
) -> None:  # fmt: skip
    """Close pending cases on cuts halved `grid` times; their shapes go to their rows of `kept`."""
    s, water, nodes, forces = desk
    stages, _, mooring, floating, _, _ = plan
    slots, level = water[0], water[1]
    numbers, after = nodes.size // LANES, forces.size // LANES
    closing = np.zeros(LANES, np.bool_)
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if not closing[i] and upcoming < pending.size:
                slots[i], level[i], closing[i] = pending[upcoming], 0, True
                seek[slots[i], TURN] = 0.0
                upcoming += 1
            busy |= closing[i]
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not busy:
            return
        march(s, water, stages, grid, nodes, forces)
        for i in range(LANES):
            if not closing[i]:
                continue
            c = slots[i]
            near = correct(seek, c, s[Z + i] - mooring[1], mooring)
            closing[i] = near == AWAY
            if near == NOWHERE:
                reasons[c] = UNCLOSED
            elif near == THERE:
                refusals[c] = refused(s, i, mooring)
                for k in range(numbers):
                    kept[c, k] = nodes[k * LANES + i]
                for k in range(after):
                    kept[c, numbers + k] = forces[k * LANES + i]


@compiled
def refused(s: Floats, i: int, mooring: Any) -> int:
    """Why the lane's shape is not to be had by this march alone; `SOLVED` where it is."""
    span, goal, anchor_height, lies = mooring[0], mooring[1], mooring[5], mooring[6]
    if s[LEAST_PULL + i] < 0.0:
        return COMPRESSED
    if s[LOWEST + i] < goal - anchor_height - 1e-6 * span or (lies and s[LIGHTEST + i] <= 0.0):
        return ON_SEABED
    return OUT_OF_WATER if s[HIGHEST + i] > 1e-6 * span else SOLVED


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


@entry
def solve_cases(
    plan: Any, depth: Floats, u: Floats, v: Floats, w: Floats, results: Any, reasons: Integers
) -> None:
    """Solve cases; what they lead to goes to their rows of the results, how they ended to reasons.

    Parameters
    ----------
    plan : the arrays of `calm.batch.kernel.plan.Plan`
    depth : (1 or n, k) of the levels [m]
    u, v, w : (n, k) current [m/s]; NaN where there is none
    results : see `calm.batch.kernel.outcome`
    reasons : (n,)
    """
    stages, parts, mooring, _, _, fixed = plan
    kinds, loads = stages[0], stages[6]
    levels = depth.shape[1] + fixed.shape[0]
    bounds, rows = np.zeros((CHUNK, levels + 2)), np.zeros((CHUNK, levels + 1, 8))
    tables = (bounds, rows, np.zeros((levels, 4)), np.zeros((levels, 5)))
    water = (np.zeros(LANES, np.int64), np.zeros(LANES, np.int64), bounds, rows)
    nodes = np.zeros(STATE * LANES * (kinds.size + 1))
    forces = np.zeros(3 * LANES * loads.shape[0])
    desk = (np.zeros(SCRATCH), water, nodes, forces)
    size = (nodes.size + forces.size) // LANES
    older, newer, shape = np.zeros((CHUNK, size)), np.zeros((CHUNK, size)), np.zeros(size)
    seek, earlier = np.zeros((CHUNK, COLUMNS)), np.zeros(CHUNK)
    refusals, all_ends = np.zeros(CHUNK, np.int64), np.zeros(CHUNK, np.int64)
    for start in range(0, reasons.size, CHUNK):
        ends = all_ends[: min(CHUNK, reasons.size - start)]
        for c in range(ends.size):
            case = start + c
            levels_at = depth[case if depth.shape[0] > 1 else 0]
            ends[c] = read_case(c, plan, tables, seek, levels_at, u[case], v[case], w[case])
        find_roots(desk, plan, seek, ends)
        for grid in range(1, FINEST + 1):
            pending = np.flatnonzero(ends == SOLVED)
            older, newer = newer, older
            for k in range(pending.size):
                # where the root has gone by the last halving, it goes a quarter as far by this one
                c = pending[k]
                y = seek[c, Y]
                seek[c, Y] = y + (0.25 * (y - earlier[c]) if grid > 1 else 0.0)
                earlier[c] = y
            close_on(grid, desk, plan, seek, pending, ends, refusals, newer)
            if grid < FEWEST_HALVINGS:
                continue
            for k in range(pending.size):
                c = pending[k]
                if ends[c] != SOLVED:
                    continue
                place, tension = greatest_change(older[c], newer[c], kinds.size, mooring[0])
                if place <= PLACE_CHANGE and tension <= TENSION_CHANGE:
                    blend(stages, older[c], newer[c], shape)
                    used = 1.0 + min((4.0 * seek[c, Y] - earlier[c]) / 3.0, 0.0)
                    write_case(stages, parts, shape, used, results, start + c)
                    ends[c] = WRITTEN if refusals[c] == SOLVED else refusals[c]
                elif grid == FINEST:
                    ends[c] = TOO_COARSE
        for c in range(ends.size):
            reasons[start + c] = SOLVED if ends[c] == WRITTEN else ends[c]
