"""Start values for the profiles of a batch, from solutions in uniform currents.

A start depends on its profile alone, so that the order of the profiles does not affect the results.
"""

from collections.abc import Sequence
from math import isnan, nan, sqrt

from calm.physics.profile import Sea
from calm.physics.track import CABLE, Course
from calm.solve.closing import Root, coarse_miss, whole_line, with_sought
from calm.solve.locate import growth_below, in_even_current, locate, turns_back
from calm.solve.problem import BELOW, FASTEST, STARTS, LineProblem
from calm.solve.solution import FOUND

IMMERSION_SHARE = 0.97
"""Used fraction of a surface float's buoyancy above which the float may also have an immersed
equilibrium.
"""
DROPS = 3
"""Largest number of iterations for the depth of the free end after knockdown.

The current that acts on the line depends on this depth.
"""
LEAN_ROW = 6
"""Row of `LineProblem.starts` with the knockdowns from `lean_of`."""
LOOKED_AT, SURE = 6, 0.3
"""Parameters of the test for a higher equilibrium (`is_highest`).

LOOKED_AT is the number of shallower free-end depths for which the knockdown is estimated. The
estimate must exceed the knockdown at that depth by the fraction SURE of the distance to the
equilibrium.
"""
LEAST_CURRENT_GROWTH = 0.25
"""Relative growth of the current over the largest knockdown that needs no further test.

If the current grows more, the line is tested for a higher equilibrium.
"""


def fill_starts(problem: LineProblem) -> int:
    """Solve a line in uniform currents, and return the number of solutions found.

    The solutions are written to `LineProblem.starts`. For a line clear of the seabed, the rows hold

    - 0: depth of the free end [m] or, if negative, used buoyancy fraction minus 1
    - 1: derivative of the height error with respect to this unknown
    - 2: knockdown [m]

    Rows 3 to 5 hold the same values for a line with a touchdown, and row 6 the results of
    `lean_of`.
    """
    found = 0
    limits, starts = problem.limits, problem.starts
    for kind in range(2):
        lands = kind == 1
        unknown = whole_line(problem, lands)
        upright = max(-limits.standing - unknown.goal, 0.0)
        for k in range(STARTS):
            speed = FASTEST * max(k, 1e-3) / (STARTS - 1)
            evenly = in_even_current(problem, speed, 0.0, 0.0)
            fall = coarse_miss(evenly, unknown, upright)
            starts[3 * kind + 2][k] = limits.depth if isnan(fall) else max(fall, limits.allowed)
            starts[3 * kind][k] = starts[3 * kind + 1][k] = nan
            starts[LEAN_ROW][k] = lean_of(
                problem.course, evenly.sea, upright, limits.depth, upright > 0.0
            )
            if limits.lift <= 0.0 and not lands:
                continue
            located = locate(evenly, lands, True)
            root = located.root
            if located.ending != FOUND or root.unknown.sought > 0:
                continue
            found += 1
            starts[3 * kind][k] = root.x if root.unknown.sought == BELOW else root.x - 1.0
            starts[3 * kind + 1][k] = root.slope
    return found


def start_of(problem: LineProblem, lands: bool) -> Root:
    """Return an approximate equilibrium at which a search can start.

    `found` of the result is false if the complete search is needed.
    """
    limits = problem.limits
    unknown = whole_line(problem, lands)
    nowhere = Root(False, unknown, nan, nan, nan)
    if len(problem.starts[0]) == 0 or limits.at_rest:
        return nowhere
    row = 3 if lands else 0
    upright = max(-limits.standing - unknown.goal, 0.0)
    x, slope = expected(problem, row, upright, upright)
    if isnan(x) or not slope < 0.0:
        return nowhere
    if upright > 0.0:  # knockdown may take a line out of the strongest current
        before, fell = upright, x - upright
        for _ in range(DROPS):
            below, slope = expected(problem, row, upright, x)
            change = (below - x) - fell
            if isnan(below) or not change < 0.0:
                break
            before, fell, x = x, below - x, min(x - (below - x) * (x - before) / change, below)
    if x >= 0.0:
        return Root(upright > 0.0, unknown, x, 0.0, slope)
    if x > IMMERSION_SHARE - 1.0:
        return nowhere
    return Root(True, with_sought(unknown, 0, unknown.rides), 1.0 + x, 0.0, slope)


def is_highest(problem: LineProblem, root: Root) -> bool:
    """Return whether an equilibrium near its start value is surely the highest equilibrium."""
    limits, starts = problem.limits, problem.starts
    if root.unknown.sought != BELOW:
        return root.x < IMMERSION_SHARE and not turns_back(problem.sea)
    row = 3 if root.unknown.lands else 0
    upright = max(-limits.standing - root.unknown.goal, 0.0)
    at = min(greatest_speed(problem.sea) / FASTEST, 1.0) * (STARTS - 1)
    k = min(int(at), STARTS - 2)
    if (
        growth_below(problem.sea, upright) * between(starts[row + 2], k, at - k)
        <= LEAST_CURRENT_GROWTH
    ):
        return root.x > 0.0
    # compare the knockdown with those estimated for shallower free ends
    fell, there = root.x - upright, expected(problem, row, upright, root.x)[0] - upright
    if not fell > 0.0:
        return root.x > 0.0
    for k in range(LOOKED_AT):
        drop = fell * k / LOOKED_AT
        falls = expected(problem, row, upright, upright + drop)[0] - upright
        if not falls * fell > (drop + SURE * (fell - drop)) * there:
            return False
    return there > 0.0


def expected(problem: LineProblem, row: int, upright: float, top: float) -> tuple[float, float]:
    """Estimate a line's free-end depth or used buoyancy from its solutions in uniform currents.

    Parameters
    ----------
    row : 0 for a line clear of the seabed, 3 for a line with a touchdown
    upright, top : depth of the free end in still water, and after knockdown [m]

    Returns
    -------
    Depth or buoyancy fraction, coded as in row 0 of `fill_starts`, and derivative of the height
    error.
    """
    # the uniform current that inclines the line as much as the actual current does
    starts = problem.starts
    lean = lean_of(problem.course, problem.sea, top, problem.limits.depth, upright > 0.0)
    at = sqrt(sqrt(lean / starts[LEAN_ROW][STARTS - 1])) * (STARTS - 1)
    k = min(int(min(at, STARTS)), STARTS - 2)
    share = min((lean - starts[LEAN_ROW][k]) / (starts[LEAN_ROW][k + 1] - starts[LEAN_ROW][k]), 1.0)
    return between(starts[row], k, share), between(starts[row + 1], k, share)


def greatest_speed(sea: Sea) -> float:
    """Return the maximum speed of the current [m/s]."""
    greatest = 0.0
    for k in range(1, len(sea.intervals)):
        here = sea.intervals[k]
        greatest = max(greatest, here.u * here.u + here.v * here.v + here.w * here.w)
    return sqrt(greatest)


def between(row: Sequence[float], k: int, share: float) -> float:
    """Interpolate linearly in a row of `starts`, between the uniform currents k and k + 1."""
    return row[k] + share * (row[k + 1] - row[k])


def lean_of(course: Course, sea: Sea, top: float, depth: float, taut: bool) -> float:
    """Return the approximate knockdown [m] of a line that the current inclines slightly.

    The inclination at a point is the drag on the part above, divided by the tension. The knockdown
    in a uniform current is proportional to the fourth power of the speed.

    Parameters
    ----------
    top, depth : depth of the top of the line, and water depth [m]
    taut : whether all buoyancy is in use; otherwise only cable drag counts, and the result is
        correct up to a constant factor
    """
    length = 0.0
    for i in range(len(course.stages)):
        length += course.stages[i].length
    scale = (depth - top) / length
    east = north = lean = 0.0
    tension = 0.0 if taut else 1.0
    level, at = 1, top
    for i in range(len(course.stages)):
        stage = course.stages[i]
        drag = lift = 0.0
        if stage.kind == CABLE:
            cable = course.cables[stage.first]
            drag, lift = cable.normal_drag * stage.length, cable.buoyancy * stage.length
        else:
            for k in range(stage.first, stage.first + stage.size):
                drag += course.loads[k].normal_drag
                lift += course.loads[k].buoyancy
        if not taut:
            lift, drag = 0.0, drag if stage.kind == CABLE else 0.0
        whole = left = scale * stage.length
        while True:
            while level < len(sea.intervals) - 1 and sea.levels[level + 1] <= at:
                level += 1
            thick, here = min(left, sea.levels[level + 1] - at), sea.intervals[level]
            below = at + 0.5 * thick - here.origin
            u, v = here.u + here.du * below, here.v + here.dv * below
            share = thick / whole if whole > 0.0 else 1.0
            half = 0.5 * share * drag * sqrt(u * u + v * v)
            east, north, tension = east + half * u, north + half * v, tension + 0.5 * share * lift
            if tension > 0.0:
                long = share * stage.length
                lean += 0.5 * long * (east * east + north * north) / (tension * tension)
            east, north, tension = east + half * u, north + half * v, tension + 0.5 * share * lift
            at, left = at + thick, left - thick
            if not left > 1e-9 * whole:
                break
    return lean
