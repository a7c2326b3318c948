"""Closing the lines of many cases: their roots sought in lanes, each by its own steps.

The miss and the order of the search are those of `calm.solve`: the highest root below the
surface, else the share of the buoyancy that a float at the surface uses. The unknown of a case is
the depth of its free end [m] where that is not negative, else the share less one. A lane takes up
the next case as soon as it is done with one.
"""

from __future__ import annotations

from math import isfinite, sqrt
from typing import Any

import numpy as np

from calm.batch.compiled import compiled, entry
from calm.batch.kernel import (
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
    march,
)  # fmt: skip
from calm.batch.outcome import blend, greatest_change, write_case
from calm.batch.profile import growth_below, lay_profile, read_profile
from calm.batch.search import (
    COLUMNS,
    DONE,
    FIRST,
    LAST,
    LAST_MISS,
    SLOPE,
    SOLVED,
    TURN,
    UNCLOSED,
    Y,
    advance,
    begin,
)  # fmt: skip
from calm.physics.line import Floats, Integers

# how a case ended; those of the search are there
NO_DATA, LEVELS_COINCIDE, STILL = 1, 2, 3
OUT_OF_WATER, ON_SEABED, COMPRESSED, TOO_COARSE, WRITTEN, NOT_TRIED = range(8, 14)

CHUNK = 256
"""Cases that are laid out at once: what fits a processor's cache."""
FINEST = 6
MOST_MARCHES = 60
MOST_CORRECTIONS = 12
PLACE_CHANGE, TENSION_CHANGE = 4e-5, 5e-5
SMALL = 5e-7
SMALL_SHARE = 3e-6


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
def find_roots(
    s: Floats,
    water: Tables,
    plan: Any,
    mooring: Any,
    floating: Any,
    chances: Any,
    seek: Floats,
    reasons: Integers,
    nodes: Floats,
    forces: Floats,
) -> None:
    """Find the coarse root of every case whose reason is `SOLVED` so far: in its row of `seek`.

    Parameters
    ----------
    seek : (cases, COLUMNS) see `calm.batch.search`
    reasons : (cases,)
    """
    goal, slots = mooring[1], water[0]
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
                    upcoming += 1
            busy |= task[i] != DONE
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not busy:
            return
        march(s, water, plan, 0, nodes, forces)
        for i in range(LANES):
            if task[i] != DONE:
                c = slots[i]
                task[i], reasons[c] = advance(seek, c, task[i], s[Z + i] - goal, mooring, chances)
                marches[i] += 1
                if marches[i] == MOST_MARCHES and task[i] != DONE:
                    task[i], reasons[c] = DONE, UNCLOSED


@compiled
def close_on(
    grid: int,
    s: Floats,
    water: Tables,
    plan: Any,
    mooring: Any,
    floating: Any,
    seek: Floats,
    pending: Integers,
    reasons: Integers,
    misses: Integers,
    kept: Floats,
    nodes: Floats,
    forces: Floats,
) -> None:
    """Close pending cases on cuts halved `grid` times; their shapes go to their rows of `kept`."""
    span, goal, upright, floats = mooring[0], mooring[1], mooring[2], mooring[3]
    slots = water[0]
    numbers, after = nodes.size // LANES, forces.size // LANES
    busy = np.zeros(LANES, np.bool_)
    upcoming = 0
    while True:
        any_busy = False
        for i in range(LANES):
            if not busy[i] and upcoming < pending.size:
                slots[i], busy[i] = pending[upcoming], True
                seek[slots[i], TURN] = 0.0
                upcoming += 1
            any_busy |= busy[i]
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not any_busy:
            return
        march(s, water, plan, grid, nodes, forces)
        for i in range(LANES):
            if not busy[i]:
                continue
            c = slots[i]
            y, m = seek[c, Y], s[Z + i] - goal
            if not isfinite(m) or seek[c, TURN] == MOST_CORRECTIONS:
                busy[i], reasons[c] = False, UNCLOSED
                continue
            if seek[c, TURN] > 0.0 and y != seek[c, LAST]:
                slope = (m - seek[c, LAST_MISS]) / (y - seek[c, LAST])
                if slope < 0.0:
                    seek[c, SLOPE] = slope
            small = SMALL * span
            if y < 0.0:
                small = min(small, -SMALL_SHARE * seek[c, SLOPE])
            following = y - m / seek[c, SLOPE]
            if abs(m) <= small:
                busy[i] = False
                seek[c, Y] = following
                for k in range(numbers):
                    kept[c, k] = nodes[k * LANES + i]
                for k in range(after):
                    kept[c, numbers + k] = forces[k * LANES + i]
                misses[c] = refused(s, i, mooring)
                continue
            seek[c, TURN] += 1.0
            seek[c, LAST], seek[c, LAST_MISS] = y, m
            seek[c, Y] = min(max(following, -1.0 if floats and upright == 0.0 else 0.0), span)


@compiled
def refused(s: Floats, i: int, mooring: Any) -> int:
    """Why the lane's shape is not to be had by this march alone; `SOLVED` where it is."""
    span, goal, anchor_height, lies = mooring[0], mooring[1], mooring[5], mooring[6]
    if s[LEAST_PULL + i] < 0.0:
        return COMPRESSED
    if s[LOWEST + i] < goal - anchor_height - 1e-6 * span or (lies and s[LIGHTEST + i] <= 0.0):
        return ON_SEABED
    return OUT_OF_WATER if s[HIGHEST + i] > 1e-6 * span else SOLVED


@entry
def solve_cases(
    plan: Any,
    parts: Any,
    mooring: Any,
    floating: Any,
    chances: Any,
    fixed: Floats,
    depth: Floats,
    u: Floats,
    v: Floats,
    w: Floats,
    results: Any,
    reasons: Integers,
) -> None:
    """Solve cases; what they lead to goes to their rows of the results, how they ended to reasons.

    Parameters
    ----------
    plan, parts, mooring, floating, chances, fixed : see `calm.batch.plan`
    depth : (1 or n, k) of the levels [m]
    u, v, w : (n, k) current [m/s]; NaN where there is none
    results : see `calm.batch.outcome`
    reasons : (n,)
    """
    kinds, loads = plan[0], plan[6]
    levels = depth.shape[1] + fixed.shape[0]
    nodes = np.zeros(STATE * LANES * (kinds.size + 1))
    forces = np.zeros(3 * LANES * loads.shape[0])
    s = np.zeros(SCRATCH)
    bounds, rows = np.zeros((CHUNK, levels + 2)), np.zeros((CHUNK, levels + 1, 8))
    water = (np.zeros(LANES, np.int64), np.zeros(LANES, np.int64), bounds, rows)
    read, joined = np.zeros((levels, 4)), np.zeros((levels, 5))
    seek = np.zeros((CHUNK, COLUMNS))
    ends = np.zeros(CHUNK, np.int64)
    refusals = np.zeros(CHUNK, np.int64)
    size = (nodes.size + forces.size) // LANES
    older, newer, joints = np.zeros((CHUNK, size)), np.zeros((CHUNK, size)), np.zeros(size)
    earlier = np.zeros(CHUNK)
    for start in range(0, reasons.size, CHUNK):
        count = min(CHUNK, reasons.size - start)
        for c in range(count):
            case = start + c
            found = read_profile(
                depth[case if depth.shape[0] > 1 else 0], u[case], v[case], w[case], read
            )
            ends[c] = SOLVED
            if found <= 0:
                ends[c] = NO_DATA if found == 0 else LEVELS_COINCIDE
                continue
            total = lay_profile(read, found, fixed, bounds[c], rows[c], joined)
            growth, speed = growth_below(joined, total, mooring[2])
            if speed == 0.0:
                ends[c] = STILL
            begin(seek, c, growth, speed, mooring[2], chances[1])
        mine = ends[:count]
        find_roots(s, water, plan, mooring, floating, chances[0], seek, mine, nodes, forces)
        for grid in range(1, FINEST + 1):
            pending = np.flatnonzero(mine == SOLVED)
            if pending.size == 0:
                break
            older, newer = newer, older
            for c in pending:
                earlier[c], seek[c, Y] = (
                    seek[c, Y],
                    seek[c, Y] + (0.25 * (seek[c, Y] - earlier[c]) if grid > 1 else 0.0),
                )
            close_on(
                grid,
                s,
                water,
                plan,
                mooring,
                floating,
                seek,
                pending,
                mine,
                refusals,
                newer,
                nodes,
                forces,
            )
            for c in pending:
                if mine[c] != SOLVED or grid < mooring[7]:
                    continue
                place, tension = greatest_change(older[c], newer[c], kinds.size, mooring[0])
                if place > PLACE_CHANGE or tension > TENSION_CHANGE:
                    if grid == FINEST:
                        mine[c] = TOO_COARSE
                    continue
                blend(plan, older[c], newer[c], joints)
                used = 1.0 + min((4.0 * seek[c, Y] - earlier[c]) / 3.0, 0.0)
                write_case(plan, parts, joints, used, results, start + c)
                mine[c] = WRITTEN if refusals[c] == SOLVED else refusals[c]
        for c in range(count):
            reasons[start + c] = SOLVED if mine[c] == WRITTEN else mine[c]
