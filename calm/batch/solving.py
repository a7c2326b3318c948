"""Solution of successive profiles with the search of `calm.solve`, and calculation of the results.

The tolerance is about a millionth of the depth. The results are extrapolated from two solutions.
The segments of the second solution have half the length.
"""

from math import atan2, inf, isfinite, nan, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from calm.physics.compiled import optimised, set_row
from calm.physics.law_kinds import record_type
from calm.physics.line import BETTER, NO_ROOM, Floats, Integers, Water
from calm.physics.passing import FAILURE
from calm.physics.passing import NODES as MARCHED
from calm.physics.profile import Interval, Sea, find_bends
from calm.physics.referee import RefereeShape, find_ends
from calm.solve.closing import miss_at
from calm.solve.mooring import (
    FIRST_OTHER,
    GOAL,
    HANGING,
    LANDS,
    NODES,
    RIDES,
    SHARE_IN_USE,
    SOUGHT,
    STAGES,
    UNKNOWN_VALUE,
    run_search,
)
from calm.solve.problem import BELOW, CHOSEN, FINE, About, Limits, LineProblem, Unknown
from calm.solve.search import Referee
from calm.solve.solution import FOLDED, FOUND, MARCH_STOPPED, SUPPORTED, TOO_HEAVY, UNSUPPORTED
from calm.solve.starts import fill_starts

DEPTH, EAST, NORTH, TENSION_TOP, TENSION_BOTTOM, TILT = range(6)
OF_PIECE = ("depth_top", "x_top", "y_top", "tension_top", "tension_bottom", "tilt")
OF_CLAMP = ("depth", "x", "y", "tension", "tilt")
OF_ENDS = (
    "top_depth", "anchor_vertical", "anchor_horizontal", "used_buoyancy", "end_depth",
    "other_used_buoyancy",
)  # fmt: skip

NO_CURRENT, LEVELS_COINCIDE, LIES_ON_SEABED, LACKS_ROOM = range(100, 104)
"""Outcomes of a profile in addition to the outcomes in `calm.solve.solution`.

- `NO_CURRENT`: no level has a value.
- `LEVELS_COINCIDE`: two levels have the same depth.
- `LIES_ON_SEABED`: a sub-surface line has a piece other than chain on the seabed.
- `LACKS_ROOM`: the work arrays are too small for the number of segments.
"""


SLOPE_STEP = 0.001
"""Change in a current component for the finite-difference slopes [m/s]."""
NUDGE = 1e-4
"""Change in the unknown of the search for the finite-difference slopes.

The change is a fraction of the range of the unknown.
"""


class Results(NamedTuple):
    """Results of n profiles for a line with p pieces and m clamps.

    Attributes
    ----------
    pieces : (n, 6, p) the six quantities `OF_PIECE` of each piece
    clamps : (n, 5, m) the five quantities `OF_CLAMP` of each clamp
    ends : (n, 6) the quantities `OF_ENDS`
    slopes : (n, m + p, 2 k) derivatives of the depths of clamps and pieces with respect to u and v
        at each level [s]; (n, 0, 0) if no derivatives are required
    """

    pieces: Floats
    clamps: Floats
    ends: Floats
    slopes: Floats


class ProfileLevels(NamedTuple):
    """Work arrays for the levels of a profile.

    Attributes
    ----------
    read : levels of the profile
    joined : levels of the profile merged with the fixed levels, see `lay_profile`
    levels, intervals, bends : as in `Sea`
    fixed : (f, 4) levels of the mooring's water: depth, u and v added to the profile, density
    """

    read: Floats
    joined: Floats
    levels: Any
    intervals: Any
    bends: Any
    fixed: Floats


def levels_for(count: int, water: Water) -> ProfileLevels:
    """Create work arrays for profiles of up to `count` levels in the water of a mooring."""
    most = count + len(water.level)
    intervals: Any = np.zeros(most + 2, record_type(Interval))
    fixed = np.column_stack([water.level, water.u, water.v, water.density])
    return ProfileLevels(
        np.zeros((most, 4)),
        np.zeros((most, 5)),
        np.zeros(most + 2),
        intervals,
        np.zeros(most + 2),
        fixed,
    )


class ProfileArrays(NamedTuple):
    """Work arrays for a profile, and properties of the line.

    Attributes
    ----------
    on : work arrays for the levels of a profile
    may_lie : (p,) whether each piece may lie on the seabed in a sub-surface mooring
    depths : (3, m + p) work array for `measure_slopes`: depths of clamps and pieces, derivatives of
        these depths with respect to the unknown of the search, and depths in a changed current
    """

    on: ProfileLevels
    may_lie: Integers
    depths: Floats


@optimised
def solve_rows(
    given: LineProblem,
    referee: Referee,
    arrays: ProfileArrays,
    first: bool,
    depth: Floats,
    u: Floats,
    v: Floats,
    w: Floats,
    results: Results,
    endings: Integers,
) -> None:
    """Solve profiles, and write the results to the rows of these profiles.

    Parameters
    ----------
    first : whether to compute the starting values of the search, for the first profiles of a
        mooring
    depth : (1 or n, k) depth of the levels [m]
    u, v, w : (n, k) current [m/s]; NaN for missing values
    endings : (n,) outcome of each profile
    """
    if first:
        fill_starts(given)
    for case in range(endings.size):
        endings[case], sea = sea_of(arrays.on, depth, u, v, w, case, given.sea)
        if endings[case] != FOUND:
            continue
        problem = in_current(given, arrays.on, sea)
        ending = refused_at_once(problem.limits)
        if ending == FOUND:
            ending = run_search(problem, referee)
            if ending == MARCH_STOPPED and problem.work.left[FAILURE] == NO_ROOM:
                ending = LACKS_ROOM
        endings[case] = ending
        if ending == FOUND:
            if lies_on_seabed(problem, arrays):
                endings[case] = LIES_ON_SEABED
            measure(problem, referee, arrays, results, case)
            if results.slopes.shape[1] > 0:
                measure_slopes(problem, referee, arrays, depth, u, v, w, results.slopes, case)


def sea_of(
    on: ProfileLevels, depth: Floats, u: Floats, v: Floats, w: Floats, case: int, still: Sea
) -> tuple[int, Sea]:
    """Return the outcome and the water of a profile.

    The outcome is FOUND, NO_CURRENT or LEVELS_COINCIDE. Gravity and viscosity are those of the
    water `still`. For `depth`, `u`, `v` and `w`, see `solve_rows`.
    """
    at = depth[case if depth.shape[0] > 1 else 0]
    found, ending, total = read_profile(at, u[case], v[case], w[case], on.read), FOUND, 0
    if found > 0:
        total = lay_profile(on.read, found, on.fixed, on.levels, on.intervals, on.joined)
    else:
        ending = NO_CURRENT if found == 0 else LEVELS_COINCIDE
    levels, intervals = on.levels[: total + 2], on.intervals[: total + 1]
    bends = on.bends[: total + 2]
    if ending == FOUND:
        find_bends(intervals, bends)
    return ending, Sea(levels, intervals, bends, still.gravity, still.strata)


def in_current(problem: LineProblem, on: ProfileLevels, sea: Sea) -> LineProblem:
    """Return a copy of a problem in the water `sea` of a profile.

    `on` has the levels of the profile.
    """
    given = problem.limits
    moving = False
    for k in range(len(sea.intervals) - 1):
        moving |= on.joined[k, 1] != 0.0 or on.joined[k, 2] != 0.0 or on.joined[k, 3] != 0.0
    limits = Limits(
        given.span, given.depth, given.anchor_height,
        given.angle_step, given.coarse_step, given.allowed, given.share_allowed, given.bed,
        given.near, given.length, given.standing, given.lift, given.rides,
        not (moving or given.blown), given.blown, given.refused, given.refused_at_rest,
    )  # fmt: skip
    return LineProblem(
        problem.course, sea, problem.loads, problem.flexible, problem.surfacing, problem.afloat,
        problem.hull, limits, problem.starts, problem.work,
    )  # fmt: skip


def refused_at_once(limits: Limits) -> int:
    """Return the outcome for a line that is rejected without a search, or FOUND if a search is
    needed.
    """
    refused = limits.refused_at_rest if limits.at_rest else limits.refused
    if refused == SUPPORTED:
        return FOUND
    return UNSUPPORTED if refused == TOO_HEAVY else FOLDED


def lies_on_seabed(problem: LineProblem, arrays: ProfileArrays) -> bool:
    """Return whether a sub-surface line has a piece other than chain on the seabed."""
    found, record = problem.work.found, problem.work.records[FINE]
    if found[SOUGHT] != BELOW:
        return False
    heap = False
    for n in range(int(found[HANGING]) + 1, int(found[NODES])):
        heap |= arrays.may_lie[int(record[6][n])] == 0
    return heap


def tilt_of(x: float, y: float, z: float) -> float:
    """Return the angle between a vector and the vertical [degrees]; it is 0 for a zero vector."""
    return atan2(sqrt(x * x + y * y), z) * 180.0 / pi


def measure(
    problem: LineProblem, referee: Referee, arrays: ProfileArrays, results: Results, case: int
) -> None:
    """Compute the results from the shape of the line, and write them to row `case`."""
    found, record = problem.work.found, problem.work.records[FINE]
    nodes = int(found[NODES])
    find_ends(RefereeShape(record, nodes, nodes - 1, referee.first, referee.last))
    pieces, _, ends, _ = results
    head = referee.moored.head
    for p in range(len(referee.first)):
        x, y, z, fx, fy, fz = node_of(record, nodes, referee.first[p])
        i, j, k, gx, gy, gz = node_of(record, nodes, referee.last[p])
        row = pieces[case]
        row[DEPTH, p], row[EAST, p], row[NORTH, p] = -z, x, y
        row[TENSION_TOP, p] = sqrt(fx * fx + fy * fy + fz * fz)
        row[TENSION_BOTTOM, p] = sqrt(gx * gx + gy * gy + gz * gz)
        dx, dy, dz = x - i, y - j, z - k
        if dx == 0.0 and dy == 0.0 and dz == 0.0:
            dx, dy, dz = fx + gx, fy + gy, fz + gz
        row[TILT, p] = tilt_of(dx, dy, dz)
        if p == len(referee.first) - 1:
            ends[case, 1], ends[case, 2] = gz, sqrt(gx * gx + gy * gy)
            ends[case, 4] = -k
    ends[case, 0] = pieces[case, DEPTH, 0]
    ends[case, 3] = used_buoyancy(problem)
    ends[case, 5] = found[FIRST_OTHER + 2] if found[FIRST_OTHER] >= 0.0 else nan
    if head > 1:
        lean_of_head(problem, referee, results, case, head)
    measure_clamps(problem, results, case)


def lean_of_head(
    problem: LineProblem, referee: Referee, results: Results, case: int, head: int
) -> None:
    """Set the tilt of the pieces at the head of the line; together, these pieces form one rod."""
    fine = problem.work.records[FINE]
    end = referee.last[head - 1]
    dx, dy, dz = fine[0][0] - fine[0][end], fine[1][0] - fine[1][end], fine[2][0] - fine[2][end]
    if dx == 0.0 and dy == 0.0 and dz == 0.0:
        return
    for p in range(head):
        results.pieces[case, TILT, p] = tilt_of(dx, dy, dz)


def measure_slopes(
    problem: LineProblem,
    referee: Referee,
    arrays: ProfileArrays,
    depth: Floats,
    u: Floats,
    v: Floats,
    w: Floats,
    slopes: Floats,
    case: int,
) -> None:
    """Write the derivatives of the depths with respect to the current components to row `case`.

    The derivatives are finite differences between two shapes with the same segments. The implicit
    function theorem gives the change in the unknown of the search, so that the search is not
    repeated. Only a line with several floats at the surface is solved again for each component.
    """
    found, row = problem.work.found, slopes[case]
    unknown = Unknown(
        found[GOAL], int(found[SOUGHT]), found[RIDES] > 0.0, found[LANDS] > 0.0, int(found[STAGES])
    )
    at_once, step, x = unknown.sought <= 0, problem.limits.angle_step, found[UNKNOWN_VALUE]
    base, moved, ahead = arrays.depths[0], arrays.depths[1], arrays.depths[2]
    missed, slope = 0.0, -1.0
    if at_once:
        nudge = NUDGE * (problem.limits.span if unknown.sought == BELOW else 1.0)
        about = About(problem, unknown, step, CHOSEN, True, FINE)
        above = miss_at(about, x - nudge)
        depths_of(problem, referee, True, moved)
        missed = miss_at(about, x)
        depths_of(problem, referee, True, base)
        slope = (missed - above) / nudge
        for n in range(base.size):
            moved[n] = (base[n] - moved[n]) / nudge
    else:
        depths_of(problem, referee, False, base)
    levels = u.shape[1]
    for column in range(2 * levels):
        flow, k = (u, column) if column < levels else (v, column - levels)
        kept = flow[case, k]
        flow[case, k] = kept + SLOPE_STEP
        ending, sea = sea_of(arrays.on, depth, u, v, w, case, problem.sea)
        flow[case, k] = kept
        near, change = in_current(problem, arrays.on, sea), nan
        if ending == FOUND and at_once:
            about = About(near, unknown, step, CHOSEN, True, FINE)
            change = (missed - miss_at(about, x)) / slope
        elif ending == FOUND:
            change = 0.0 if run_search(near, referee) == FOUND else nan
        depths_of(near, referee, at_once, ahead)
        for n in range(base.size):
            shift = change * moved[n] if at_once else change
            row[n, column] = (ahead[n] + shift - base[n]) / SLOPE_STEP


def depths_of(problem: LineProblem, referee: Referee, marched: bool, depths: Floats) -> None:
    """Write the depths of clamps and pieces to `depths` (m + p,).

    If `marched` is set, the depths are those of the last integration along the line, otherwise
    those of the extrapolated shape.
    """
    record, work = problem.work.records[FINE], problem.work
    nodes = int(work.left[MARCHED] if marched else work.found[NODES])
    height, row = (2 if marched else BETTER + 2), 0
    for n in range(1, nodes):
        if record[7][n] >= 0.0:
            depths[row] = -record[height][n - 1]
            row += 1
    find_ends(RefereeShape(record, nodes, nodes - 1, referee.first, referee.last))
    for p in range(len(referee.first)):
        depths[row] = -record[height][referee.first[p]]
        row += 1


def node_of(record: Any, nodes: int, n: int) -> tuple[float, float, float, float, float, float]:
    """Return the extrapolated position [m] and the force [N] at a node.

    x and y are relative to the last node.
    """
    x, y, z = record[BETTER], record[BETTER + 1], record[BETTER + 2]
    fx, fy, fz = record[BETTER + 3], record[BETTER + 4], record[BETTER + 5]
    end = nodes - 1
    return x[n] - x[end], y[n] - y[end], z[n], fx[n], fy[n], fz[n]


def measure_clamps(problem: LineProblem, results: Results, case: int) -> None:
    """Write the results of the clamps to row `case`, in order down the line."""
    record = problem.work.records[FINE]
    nodes, row = int(problem.work.found[NODES]), 0
    for n in range(1, nodes):
        if record[7][n] < 0.0:
            continue
        x, y, z, fx, fy, fz = node_of(record, nodes, n - 1)
        _, _, _, gx, gy, gz = node_of(record, nodes, n)
        clamp = results.clamps[case]
        upper, lower = sqrt(fx * fx + fy * fy + fz * fz), sqrt(gx * gx + gy * gy + gz * gz)
        clamp[0, row], clamp[1, row], clamp[2, row] = -z, x, y
        clamp[3, row] = max(upper, lower)
        piece = int(record[6][n])
        tilt = tilt_of(fx + gx, fy + gy, fz + gz)
        if not problem.flexible[piece]:
            tilt = results.pieces[case, TILT, piece]
        clamp[4, row] = tilt
        row += 1


def used_buoyancy(problem: LineProblem) -> float:
    """Return the fraction of the surface floats' buoyancy that is in use."""
    found = problem.work.found
    sought = int(found[SOUGHT])
    if sought == BELOW:
        return 1.0
    total = used = 0.0
    for k in range(sought + 1):
        share = found[SHARE_IN_USE] if k == sought else problem.work.shares[0][k]
        lift = problem.surfacing[k].surface_lift
        total += lift
        used += share * lift
    return used / total


def read_profile(depth: Floats, u: Floats, v: Floats, w: Floats, read: Floats) -> int:
    """Copy the valid levels of a profile to `read`, sorted by depth.

    Levels above the surface are omitted. Return the number of copied levels, or −1 if two levels
    have the same depth.
    """
    count = 0
    for j in range(depth.size):
        if not (isfinite(u[j]) and isfinite(v[j]) and isfinite(w[j]) and depth[j] >= 0.0):
            continue
        if not isfinite(depth[j]):
            continue
        k = count
        while k > 0 and read[k - 1, 0] > depth[j]:
            for c in range(4):
                read[k, c] = read[k - 1, c]
            k -= 1
        read[k, 0], read[k, 1], read[k, 2], read[k, 3] = depth[j], u[j], v[j], w[j]
        count += 1
    for j in range(1, count):
        if read[j, 0] == read[j - 1, 0]:
            return -1
    return count


def between(table: Floats, count: int, k: int, depth: float, c: int) -> float:
    """Interpolate column `c` of a table linearly at a depth; `k` is the index of the first deeper
    level.
    """
    if k == 0:
        return float(table[0, c])
    if k == count:
        return float(table[count - 1, c])
    share = (depth - table[k - 1, 0]) / (table[k, 0] - table[k - 1, 0])
    return float(table[k - 1, c] + share * (table[k, c] - table[k - 1, c]))


def lay_profile(
    read: Floats, count: int, fixed: Floats, levels: Any, intervals: Any, joined: Floats
) -> int:
    """Merge a profile with the fixed levels, and return the number of merged levels.

    Parameters
    ----------
    read : depth, u, v, w of the profile's levels
    fixed : (f, 4) depth, u and v added to the profile, and density of each fixed level
    levels, intervals : receive the merged levels and the intervals between them, as in `Sea`
    joined : receives depth, u, v, w, density of the merged levels
    """
    total = i = j = 0
    given = fixed.shape[0]
    while i < count or j < given:
        of_profile = j == given or (i < count and read[i, 0] <= fixed[j, 0])
        depth = read[i, 0] if of_profile else fixed[j, 0]
        if i < count and read[i, 0] == depth:
            i += 1
        if j < given and fixed[j, 0] == depth:
            j += 1
        # at a level itself, the interval above reproduces the value to rounding
        k = i - 1 if i > 0 and read[i - 1, 0] == depth else i
        f = j - 1 if j > 0 and fixed[j - 1, 0] == depth else j
        joined[total, 0] = depth
        for c in range(1, 4):  # there is no current in the air
            joined[total, c] = value_at(read, count, k, depth, c) if depth >= 0.0 else 0.0
        joined[total, 1] += value_at(fixed, given, f, depth, 1)
        joined[total, 2] += value_at(fixed, given, f, depth, 2)
        joined[total, 4] = value_at(fixed, given, f, depth, 3)
        total += 1
    levels[0], levels[total + 1] = -inf, inf
    for k in range(total + 1):
        upper, lower = max(k - 1, 0), min(k, total - 1)
        depth = joined[upper, 0]
        thickness = joined[lower, 0] - depth if lower > upper else inf
        u, v, w, density = joined[upper, 1], joined[upper, 2], joined[upper, 3], joined[upper, 4]
        row = Interval(
            depth, u, (joined[lower, 1] - u) / thickness, v, (joined[lower, 2] - v) / thickness,
            w, (joined[lower, 3] - w) / thickness, density,
            (joined[lower, 4] - density) / thickness,
        )  # fmt: skip
        set_row(intervals, k, row)
        if k < total:
            levels[k + 1] = joined[k, 0]
    return total


def value_at(table: Floats, count: int, k: int, depth: float, c: int) -> float:
    """Return column `c` of a table at a depth.

    If level `k` is at this depth, return the value in the table. Otherwise, interpolate with
    `between`.
    """
    if k < count and table[k, 0] == depth:
        return float(table[k, c])
    return between(table, count, k, depth, c)
