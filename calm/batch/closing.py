"""Closing the lines of a block: sixteen roots sought together, each by its own steps.

The miss, its brackets and the order of the search are those of `calm.solve`: the highest root
below the surface, else the share of the buoyancy that a float at the surface uses. A lane's
unknown is the depth of its free end [m] where that is not negative, else the share less one.
"""

from __future__ import annotations

from math import inf, isfinite, nan, sqrt

import numpy as np

from calm.batch.compiled import compiled
from calm.batch.kernel import (
    EVEN_U,
    EVEN_V,
    EVEN_W,
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
    X,
    Y,
    Z,
    FX,
    FY,
    FZ,
    march,
)
from calm.batch.outcome import blend, write_case
from calm.batch.profile import growth_below, lay_profile, read_profile

# how a case ended
SOLVED, NO_DATA, LEVELS_COINCIDE, STILL, AT_SURFACE, LOST, TURNS_BACK, UNCLOSED = range(8)
OUT_OF_WATER, ON_SEABED, COMPRESSED, TOO_COARSE = range(8, 12)

# what a lane is about to learn from its next march
FIRST, UNLOADED, TOP, AWASH, FALL, SCAN, DEEPEST, ROOT, DONE = range(9)

SCANNED = 16
FINEST = 6
MOST_MARCHES = 60
MOST_CORRECTIONS = 12


@compiled
def place_free_end(s, i, y, riding, rigid):
    """Put a lane's free end where its unknown has it."""
    s[FREE_END + i], s[SHARE + i], s[OUT + i] = y, 1.0, 0.0
    s[WET + i], s[HELD + i], s[WIND_EAST + i], s[WIND_NORTH + i] = 1.0, 1.0, 0.0, 0.0
    if y < 0.0:
        share = 1.0 + y
        s[FREE_END + i], s[SHARE + i] = 0.0, share
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
def solve_block(plan, parts, mooring, riding, rigid, shares, fixed, depth, u, v, w, cases, results, reasons):
    """Solve up to sixteen cases; their results and reasons go to their rows."""
    span, goal, upright, floats, rides, lies, first_grid = mooring
    kinds = plan[0]
    nodes_size, forces_size = STATE * LANES * (kinds.size + 1), 3 * LANES * plan[6].shape[0]
    levels = depth.shape[1] + fixed.shape[0]
    s = np.zeros(SCRATCH)
    level = np.zeros(LANES, np.int64)
    bounds = np.zeros((LANES, levels + 2))
    rows = np.zeros((LANES, levels + 1, 9))
    read, joined = np.zeros((levels, 4)), np.zeros((levels, 5))
    nodes, forces = np.zeros(nodes_size), np.zeros(forces_size)
    old_nodes, old_forces = np.zeros(nodes_size), np.zeros(forces_size)
    new_nodes, new_forces = np.zeros(nodes_size), np.zeros(forces_size)
    joints, axes = np.zeros(nodes_size), np.zeros(nodes_size)
    blended, scratch = np.zeros(forces_size), np.zeros(3)
    task = np.full(LANES, DONE)
    reason = np.zeros(LANES, np.int64)
    growth = np.zeros(LANES)
    used = 0
    # lanes that have nothing to do repeat the first case that has
    for i in range(LANES):
        if i >= cases.size:
            continue
        case = cases[i]
        count = read_profile(depth[case if depth.shape[0] > 1 else 0], u[case], v[case], w[case], read)
        if count <= 0:
            reason[i] = NO_DATA if count == 0 else LEVELS_COINCIDE
            continue
        total = lay_profile(read, count, fixed, bounds[i], rows[i], joined)
        growth[i], greatest, moving = growth_below(joined, total, upright)
        s[EVEN_U + i], s[EVEN_V + i], s[EVEN_W + i] = joined[greatest, 1], joined[greatest, 2], joined[greatest, 3]
        if not moving:
            reason[i] = STILL
            continue
        task[i] = FIRST
    for i in range(LANES):
        if task[i] == DONE:
            bounds[i, 0], bounds[i, 1] = -inf, inf
            rows[i, 0, :] = 0.0
            rows[i, 0, 7] = 1025.0
            s[EVEN_U + i], s[EVEN_V + i], s[EVEN_W + i] = 0.0, 0.0, 0.0

    y = np.full(LANES, upright)
    miss = np.zeros(LANES)
    above, above_miss = np.full(LANES, nan), np.full(LANES, nan)
    below, below_miss = np.full(LANES, nan), np.full(LANES, nan)
    last, last_miss = np.full(LANES, nan), np.full(LANES, nan)
    older_miss = np.full(LANES, nan)
    slope = np.full(LANES, -1.0)
    turn = np.zeros(LANES, np.int64)
    stuck = np.zeros(LANES, np.int64)
    end_of_scan = np.zeros(LANES)
    fall = np.zeros(LANES)
    rough = 1e-5 * span
    for march_number in range(MOST_MARCHES):
        busy = even = False
        for i in range(LANES):
            busy |= task[i] != DONE
            even |= task[i] == FALL
        if not busy:
            break
        for i in range(LANES):
            place_free_end(s, i, y[i], riding, rigid)
        if even:
            # those who wait for nothing else
            march(s, level, bounds, rows, plan, 0, True, nodes, forces)
            for i in range(LANES):
                if task[i] == FALL:
                    fall[i] = max(s[Z + i] - goal, 1e-7 * span)
                    if fall[i] * growth[i] > 0.25:
                        end_of_scan[i] = min(y[i] + 1.02 * fall[i], span)
                        task[i], turn[i] = SCAN, 0
                        last[i] = y[i]
                        y[i] += (end_of_scan[i] - y[i]) / SCANNED
                        last_miss[i], older_miss[i] = above_miss[i], nan
                    else:
                        task[i] = ROOT
                        last[i], last_miss[i] = y[i], above_miss[i]
                        y[i] = min(y[i] + above_miss[i], span)
            continue
        march(s, level, bounds, rows, plan, 0, False, nodes, forces)
        for i in range(LANES):
            if task[i] == DONE:
                continue
            m = s[Z + i] - goal
            miss[i] = m
            if not isfinite(m):
                task[i], reason[i] = DONE, UNCLOSED
            elif task[i] == FIRST:
                if m < 0.0:
                    below[i], below_miss[i] = y[i], m
                    if upright > 0.0:
                        task[i], y[i] = TOP, 0.0
                    elif floats:
                        task[i], y[i] = UNLOADED, -1.0
                    else:
                        task[i], reason[i] = DONE, AT_SURFACE
                else:
                    above[i], above_miss[i] = y[i], m
                    if upright == 0.0 and rides:
                        task[i], turn[i], y[i] = AWASH, 0, shares[0] - 1.0
                        last[i], last_miss[i] = nan, nan
                    else:
                        seek_below(i, task, y, growth, last, last_miss, m, span)
            elif task[i] == TOP:
                if m < 0.0:
                    task[i], reason[i] = DONE, AT_SURFACE
                else:
                    above[i], above_miss[i] = 0.0, m
                    last[i], last_miss[i] = below[i], below_miss[i]
                    task[i] = ROOT
                    slope[i] = (m - below_miss[i]) / (0.0 - below[i])
                    y[i] = between_brackets(above[i], m, below[i], below_miss[i])
                    last[i], last_miss[i] = 0.0, m
            elif task[i] == UNLOADED:
                if m <= 0.0:
                    task[i], reason[i] = DONE, AT_SURFACE
                else:
                    above[i], above_miss[i] = y[i], m
                    task[i] = ROOT
                    last[i], last_miss[i] = y[i], m
                    y[i] = between_brackets(above[i], m, below[i], below_miss[i])
            elif task[i] == AWASH:
                if last_miss[i] > 0.0 and m <= 0.0:
                    above[i], above_miss[i] = last[i], last_miss[i]
                    below[i], below_miss[i] = y[i], m
                    task[i] = ROOT
                    y[i] = between_brackets(above[i], above_miss[i], below[i], below_miss[i])
                    last[i], last_miss[i] = below[i], below_miss[i]
                else:
                    turn[i] += 1
                    last[i], last_miss[i] = y[i], m
                    if turn[i] < shares.size:
                        y[i] = shares[turn[i]] - 1.0
                    elif m <= 0.0:  # it rises again before it goes under
                        task[i], reason[i] = DONE, TURNS_BACK
                    else:
                        y[i] = 0.0
                        seek_below(i, task, y, growth, last, last_miss, above_miss[i], span)
            elif task[i] == SCAN or task[i] == DEEPEST:
                if m < 0.0:
                    above[i], above_miss[i] = last[i], last_miss[i]
                    below[i], below_miss[i] = y[i], m
                    task[i] = ROOT
                    stuck[i] = 0
                    last[i], last_miss[i] = y[i], m
                    y[i] = between_brackets(above[i], above_miss[i], below[i], m)
                elif older_miss[i] > last_miss[i] and m > last_miss[i] and last_miss[i] > 0.0:
                    task[i], reason[i] = DONE, TURNS_BACK
                elif task[i] == DEEPEST or y[i] >= span:
                    task[i], reason[i] = DONE, LOST
                else:
                    older_miss[i], last_miss[i] = last_miss[i], m
                    step = y[i] - last[i]
                    last[i] = y[i]
                    turn[i] += 1
                    if turn[i] < SCANNED:
                        y[i] = min(y[i] + step, span)
                    else:
                        task[i], y[i] = DEEPEST, span
            elif task[i] == ROOT:
                if m >= 0.0:
                    above[i], above_miss[i] = y[i], m
                else:
                    below[i], below_miss[i] = y[i], m
                if y[i] != last[i]:
                    slope[i] = (m - last_miss[i]) / (y[i] - last[i])
                if abs(m) <= rough or abs(above[i] - below[i]) <= 1e-9 * span:
                    task[i] = DONE
                    if slope[i] < 0.0:
                        y[i] -= m / slope[i]
                    continue
                stuck[i] = stuck[i] + 1 if abs(m) > 0.5 * abs(last_miss[i]) else 0
                following = y[i] - m / slope[i] if slope[i] < 0.0 else nan
                if below[i] == below[i] and above[i] == above[i]:
                    if not above[i] < following < below[i] or stuck[i] > 2:
                        following = 0.5 * (above[i] + below[i])
                        stuck[i] = 0
                elif y[i] >= span:
                    task[i], reason[i] = DONE, LOST
                else:
                    furthest = y[i] + 4.0 * max(m, y[i] - last[i])
                    following = min(following if following > y[i] else furthest, furthest, span)
                last[i], last_miss[i] = y[i], m
                y[i] = following
    for i in range(LANES):
        if task[i] != DONE:
            reason[i] = UNCLOSED

    # the same roots on finer and finer cuts, until halving them makes no difference that matters
    deepest_grid = FINEST
    root = y.copy()
    older_root, newer_root = np.zeros(LANES), np.zeros(LANES)
    settled = np.zeros(LANES, np.bool_)
    finished = np.zeros(LANES, np.bool_)
    for i in range(LANES):
        finished[i] = i >= cases.size or reason[i] != SOLVED
        newer_root[i] = y[i]
    for grid in range(1, deepest_grid + 1):
        ongoing = False
        for i in range(LANES):
            settled[i] = finished[i]
            ongoing |= not finished[i]
            older_root[i] = newer_root[i]
            turn[i] = 0
        if not ongoing:
            break
        for k in range(nodes_size):
            old_nodes[k] = new_nodes[k]
        for k in range(forces_size):
            old_forces[k] = new_forces[k]
        for attempt in range(MOST_CORRECTIONS):
            ongoing = False
            for i in range(LANES):
                ongoing |= not settled[i]
            if not ongoing:
                break
            for i in range(LANES):
                place_free_end(s, i, y[i], riding, rigid)
            march(s, level, bounds, rows, plan, grid, False, nodes, forces)
            for i in range(LANES):
                if settled[i]:
                    continue
                m = s[Z + i] - goal
                if not isfinite(m):
                    settled[i] = finished[i] = True
                    reason[i] = UNCLOSED
                    continue
                if turn[i] > 0 and y[i] != last[i]:
                    steeper = (m - last_miss[i]) / (y[i] - last[i])
                    if steeper < 0.0:
                        slope[i] = steeper
                small = 5e-7 * span
                if y[i] < 0.0:
                    small = min(small, -1e-5 * slope[i])
                if abs(m) <= small:
                    settled[i] = True
                    newer_root[i] = y[i] - m / slope[i]
                    for k in range(STATE * (kinds.size + 1)):
                        new_nodes[k * LANES + i] = nodes[k * LANES + i]
                    for k in range(3 * plan[6].shape[0]):
                        new_forces[k * LANES + i] = forces[k * LANES + i]
                    miss[i] = m
                    continue
                turn[i] += 1
                last[i], last_miss[i] = y[i], m
                y[i] = min(max(y[i] - m / slope[i], -1.0), span)
                if y[i] < 0.0 and (upright > 0.0 or not floats):
                    y[i] = 0.0
            for i in range(LANES):
                if not settled[i] and turn[i] == MOST_CORRECTIONS:
                    settled[i] = finished[i] = True
                    reason[i] = UNCLOSED
        if grid >= first_grid:
            blend(plan, old_nodes, new_nodes, old_forces, new_forces, joints, axes, blended)
        for i in range(LANES):
            if finished[i]:
                continue
            if grid >= first_grid:
                error = worst_error(old_nodes, new_nodes, i, kinds.size, span)
                if error <= 1.0:
                    used = 1.0 + min((4.0 * newer_root[i] - older_root[i]) / 3.0, 0.0)
                    write_case(
                        plan, parts, joints, axes, blended, i, used, error, results, cases[i],
                        scratch,
                    )  # fmt: skip
                    if s[LEAST_PULL + i] < 0.0:
                        reason[i] = COMPRESSED
                    elif s[LOWEST + i] < goal - 1e-5 * span - lies[0]:
                        reason[i] = ON_SEABED
                    elif lies[1] > 0.0 and s[LIGHTEST + i] <= 0.0:
                        reason[i] = ON_SEABED
                    elif s[HIGHEST + i] > 1e-6 * span:
                        reason[i] = OUT_OF_WATER
                    finished[i] = True
                    continue
            older = newer_root[i]
            y[i] = older + 0.25 * (older - older_root[i]) if grid > 1 else older
            if grid == deepest_grid:
                reason[i] = TOO_COARSE
    for i in range(LANES):
        if i < cases.size:
            reasons[cases[i]] = reason[i]


@compiled
def seek_below(i, task, y, growth, last, last_miss, m, span):
    """Begin the search below the surface, from a miss that is not negative."""
    if growth[i] > 0.0 and m > 1e-7 * span:
        task[i] = FALL
    else:
        task[i] = ROOT
        last[i], last_miss[i] = y[i], m
        y[i] = min(y[i] + max(m, 1e-7 * span), span)


@compiled
def between_brackets(a, fa, b, fb):
    """Where the chord between two points of different sign crosses nothing."""
    return a + (b - a) * fa / (fa - fb)


@compiled
def worst_error(old, new, i, stages, span):
    """What halving the cuts changed, over what it may change: a third of it is the error."""
    end = stages * STATE * LANES + i
    place = tension = greatest = 0.0
    for n in range(stages + 1):
        at = n * STATE * LANES + i
        fx, fy, fz = new[at + FX], new[at + FY], new[at + FZ]
        greatest = max(greatest, sqrt(fx * fx + fy * fy + fz * fz))
    for n in range(stages + 1):
        at = n * STATE * LANES + i
        for c in (X, Y):
            place = max(place, abs(new[at + c] - new[end + c] - old[at + c] + old[end + c]))
        place = max(place, abs(new[at + Z] - old[at + Z]))
        fx, fy, fz = new[at + FX], new[at + FY], new[at + FZ]
        ox, oy, oz = old[at + FX], old[at + FY], old[at + FZ]
        pull, before = sqrt(fx * fx + fy * fy + fz * fz), sqrt(ox * ox + oy * oy + oz * oz)
        tension = max(tension, abs(pull - before) / max(pull, 1e-3 * greatest, 1e-300))
    return max(place / (3.0 * 4e-5 * span), tension / (3.0 * 1.6e-4))
