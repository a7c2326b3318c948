"""Static equilibrium of a moored line, and of lines that differ slightly from a solved line.

The slightly different lines have the segments of the solved line. Truncation errors therefore
hardly change, and differences between the shapes are derivatives.
"""

from collections.abc import MutableSequence, Sequence
from dataclasses import replace
from math import nan

import numpy as np

from calm.physics.compiled import outcome
from calm.physics.line import NO_ROOM, Floats, Line, Trace, Water
from calm.physics.passing import FAILURE
from calm.solve.accuracy import Errors, take_as_marched
from calm.solve.audit import referee_of
from calm.solve.closing import Closed, Root, not_closed, planned, polish, whole_line
from calm.solve.finish import closing_refusal, solution_found
from calm.solve.line_shape import FoundShape, not_audited
from calm.solve.locate import locate
from calm.solve.problem import (
    BELOW,
    CHOSEN,
    FINE,
    ROOM,
    LineProblem,
    Unknown,
    problem_of,
)
from calm.solve.search import Referee, audited, find_shape
from calm.solve.solution import (
    FOUND,
    MISSES,
    SLACK_ON_DIGITS,
    OtherEquilibrium,
    Settings,
    Solution,
    Status,
    refuse_unsupported,
)
from calm.solve.two_speeds import CompiledPart, runs_compiled

MOST_DEPTHS = 500
"""Largest line length in water depths, since segments are at most a hundredth of the depth."""
MORE_ROOM = 8
"""Factor by which the work arrays grow if they hold too few segments for a line."""


SLACK_LINE_CURRENT = 1e-3
"""Speed of a weak current [m/s] that gives a slack line a direction and has no other effect."""


def stirred(water: Water) -> Water | None:
    """Return the water with a weak current at all still levels, or None if no level is still.

    The current gives a direction to a slack line, which would hang in a vertical fold in still
    water.
    """
    still = np.hypot(water.u, water.v) < SLACK_LINE_CURRENT
    return replace(water, u=np.where(still, SLACK_LINE_CURRENT, water.u)) if still.any() else None


def solve_mooring(line: Line, water: Water, settings: Settings | None = None) -> Solution:
    """Solve for the static equilibrium of a moored line.

    Parameters
    ----------
    settings : angle step (1° by default) and tolerance (1e-7 of the water depth by default)

    Returns
    -------
    Solution : the highest equilibrium found. At an angle step of 1°, errors of positions are at
        most 5e-5 of the water depth, and relative errors of tensions 2e-4.

    Raises
    ------
    NoEquilibrium
        No shape passed every check; the exception has one of the `Status` labels.
    """
    settings = settings or Settings()
    refuse_endless(line, water)
    refuse_unsupported(line, water)
    compiled = runs_compiled(settings, line)
    room = ROOM
    while True:
        problem = problem_of(line, water, settings, compiled=compiled, room=room)
        referee = referee_of(line, water, 0.0, compiled)
        found = find_compiled(problem, referee) if compiled else find_shape(problem, referee)
        if not lacks_room(problem):
            break
        room *= MORE_ROOM
    slack_in_a_current = found.closed.ending == SLACK_ON_DIGITS and water.moving
    if slack_in_a_current and (moving := stirred(water)):
        return solve_mooring(line, moving, settings)
    return solution_found(found, problem, line, water, settings)


def find_compiled(problem: LineProblem, referee: Referee) -> FoundShape:
    """Run `find_shape` in compiled code."""
    outcome(run_search, True, problem, referee)
    return read_found(list(problem.work.found))


def lacks_room(problem: LineProblem) -> bool:
    """Return whether a search ended because the work arrays are too small for the segments."""
    return bool(problem.work.left[FAILURE] == NO_ROOM)


def refuse_endless(line: Line, water: Water) -> None:
    """Raise NoEquilibrium if a line is far longer than the water depth."""
    out = float(line.length.sum())
    if out > MOST_DEPTHS * water.depth:
        raise Status.NOT_CONVERGED.because(
            f"The line is {out:.0f} m long, {out / water.depth:.0f} times the water depth; the "
            f"limit is {MOST_DEPTHS} times.",
            advice="Shorten the line; the part on the seabed hardly affects the anchor load.",
        )


def run_search(problem: LineProblem, referee: Referee) -> int:
    """Run a search, write its result to the work arrays of the problem, and return the outcome."""
    found = find_shape(problem, referee)
    write_found(found, problem.work.found)
    return found.closed.ending


ENDING, VALUE, PIECE, GOAL, SOUGHT, RIDES, LANDS, STAGES, UNKNOWN_VALUE, MISS, SLOPE = range(11)
NODES, HANGING, LANDED, GROUNDED, SEGMENTS, FIRST_ERROR = range(11, 17)
CLOSURE, MOMENT, SHARE_IN_USE, LIES, FIRST_OTHER = range(22, 27)
"""Indices into the result array of a search, which holds the fields of a `FoundShape`.

- CLOSURE, MOMENT: `closure` and `moment`
- SHARE_IN_USE: `share`
- LIES: `grounded`
- FIRST_OTHER: first of the five values of `other`

The five values of `errors` begin at `FIRST_ERROR`.
"""


def write_found(found: FoundShape, values: MutableSequence[float]) -> None:
    """Write a shape, or the reason why no shape was found, to the result array."""
    closed, errors = found.closed, found.errors
    root = closed.root
    unknown = root.unknown
    values[ENDING], values[VALUE], values[PIECE] = closed.ending, closed.value, closed.piece
    values[GOAL], values[SOUGHT] = unknown.goal, unknown.sought
    values[RIDES], values[LANDS], values[STAGES] = unknown.rides, unknown.lands, unknown.stages
    values[UNKNOWN_VALUE], values[MISS], values[SLOPE] = root.x, root.miss, root.slope
    values[NODES], values[HANGING] = closed.nodes, closed.hanging
    values[LANDED], values[GROUNDED] = closed.landed, closed.grounded
    values[SEGMENTS] = closed.segments
    values[FIRST_ERROR], values[FIRST_ERROR + 1] = errors.depth, errors.tension
    values[FIRST_ERROR + 2] = errors.relative
    values[FIRST_ERROR + 3], values[FIRST_ERROR + 4] = errors.lift, errors.pull
    values[SHARE_IN_USE], values[LIES] = found.share, found.grounded
    values[CLOSURE], values[MOMENT] = found.closure, found.moment
    other = found.other
    values[FIRST_OTHER], values[FIRST_OTHER + 1] = other.depth, other.grounded_length
    values[FIRST_OTHER + 2], values[FIRST_OTHER + 3] = other.used_buoyancy, other.anchor_vertical
    values[FIRST_OTHER + 4] = other.anchor_horizontal


def read_found(values: Sequence[float]) -> FoundShape:
    """Read a shape, or the reason why no shape was found, from the result array."""
    ending, piece, sought, rides, lands, stages, nodes, hanging, landed, segments = (
        int(values[i]) for i in WHOLE
    )
    unknown = Unknown(values[GOAL], sought, bool(rides), bool(lands), stages)
    root = Root(True, unknown, values[UNKNOWN_VALUE], values[MISS], values[SLOPE])
    value = float(values[VALUE])
    closed = Closed(
        ending, value, piece, root, nodes, hanging, bool(landed), float(values[GROUNDED]), segments
    )
    errors = Errors(*(float(error) for error in values[FIRST_ERROR : FIRST_ERROR + 5]))
    other = OtherEquilibrium(*(float(figure) for figure in values[FIRST_OTHER : FIRST_OTHER + 5]))
    share, lies = float(values[SHARE_IN_USE]), float(values[LIES])
    return FoundShape(
        closed, errors, share, lies, float(values[CLOSURE]), float(values[MOMENT]), other
    )


WHOLE = (ENDING, PIECE, SOUGHT, RIDES, LANDS, STAGES, NODES, HANGING, LANDED, SEGMENTS)


class Nearby:
    """A solved moored line, from which slightly different lines are solved.

    Parameters
    ----------
    line, water, settings : as in `solve_mooring`; a tight `tolerance` resolves small changes

    Attributes
    ----------
    solution : solution of the original line

    Raises
    ------
    NoEquilibrium
        As in `solve_mooring`.
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        self.solution = solve_mooring(line, water, settings)
        self._water, self._settings = water, settings
        self._room = 2 * len(self.solution.cut) + 64
        self._compiled = compiled = runs_compiled(settings, line, CompiledPart.NEARBY)
        problem = problem_of(line, water, settings, compiled=compiled, room=self._room)
        none = Root(False, whole_line(problem, self.solution.landed), nan, nan, nan)
        closed: Closed = outcome(close_again, compiled, problem, none)
        if closed.ending != FOUND:
            raise closing_refusal(closed)
        self._root, work = closed.root, problem.work
        self._counts = np.array(work.counts)
        self._cuts = np.array(work.chosen[: int(self._counts.sum())])
        self._shares = np.array(work.shares)
        self._trace = Trace.of(work.records[FINE], closed.nodes)

    def node(self, piece: int, clamp: int = -1) -> int:
        """Return the number of the node at the top of a piece, or at a clamp.

        The number holds for all lines solved with this object.
        """
        if clamp >= 0:
            return int(np.argmax(self._trace.clamp == clamp))
        return int(np.argmax(self._trace.piece == piece))

    def shape(self, line: Line) -> tuple[Floats, float]:
        """Return the node positions and the used buoyancy fraction of a slightly different line.

        The positions (k+1, 3) are east and north of the anchor and up from the surface [m]. The
        fraction is 1 without floats at the surface.

        Raises
        ------
        NoEquilibrium
            The status is ``not-converged`` or ``slack``.
        """
        problem, closed = self._closed(line, self._water)
        trace = Trace.of(problem.work.records[FINE], closed.nodes)
        position = trace.position
        position[:, :2] -= position[-1, :2]
        return position, _used(problem, closed, line)

    def solved(self, line: Line, water: Water) -> Solution:
        """Solve a different line on the segments of the original line.

        The error estimates remain those of the original line.

        Parameters
        ----------
        line : a line of the same pieces, with all cable lengths scaled by one factor

        Raises
        ------
        NoEquilibrium
            No shape passes every check, or the line gains or loses a touchdown.
        """
        problem, closed = self._closed(line, water)
        base, compiled = self.solution, self._compiled
        if closed.landed != base.landed:
            raise Status.NOT_CONVERGED.because(
                "Either the solved line or the changed line has a part on the seabed, but not both."
            )
        errors = Errors(base.depth_error, base.tension_error, 0.0, base.lift_error, base.pull_error)
        referee = referee_of(line, water, 0.0, compiled)
        found = not_audited(closed, errors, closed.root.x, closed.grounded)
        record = problem.work.records[FINE]
        outcome(take_as_marched, compiled, record, closed.nodes)
        found = outcome(audited, compiled, problem, referee, found)
        return solution_found(found, problem, line, water, self._settings)

    def _closed(self, line: Line, water: Water) -> tuple[LineProblem, Closed]:
        compiled = self._compiled
        problem = problem_of(line, water, self._settings, compiled=compiled, room=self._room)
        given, cables = self.solution.line, line.flexible
        longer = line.length[cables].sum() / given.length[cables].sum() if cables.any() else 1.0
        work = problem.work
        work.chosen[: len(self._cuts)] = (longer * self._cuts).tolist()
        work.counts[:] = self._counts.tolist()
        for row in range(2):
            work.shares[row][:] = self._shares[row].tolist()
        moved = self._moved(water, problem)
        closed: Closed = outcome(close_again, compiled, problem, moved)
        if closed.ending != FOUND:
            raise closing_refusal(closed)
        return problem, closed

    def _moved(self, water: Water, problem: LineProblem) -> Root:
        """Return the equilibrium of the original line, shifted to water of another depth."""
        root, deeper = self._root, water.depth - self._water.depth
        was, x = root.unknown, root.x
        unknown = Unknown(was.goal - deeper, was.sought, was.rides, was.lands, was.stages)
        if unknown.sought == BELOW:
            x = max(x + deeper, 0.0)
        return Root(True, unknown, x, root.miss, root.slope)


def close_again(problem: LineProblem, root: Root) -> Closed:
    """Close a line near an approximate equilibrium, on the segments in the work arrays.

    The shape is written to the record `FINE`.

    Parameters
    ----------
    root : approximate equilibrium; if `root.found` is false, the segments are chosen anew
    """
    if root.found:
        return polish(problem, root, CHOSEN, FINE)
    located = locate(problem, root.unknown.lands, False)
    step = problem.limits.angle_step
    if located.ending != FOUND:
        return not_closed(located.ending, located.value, located.root)
    closed = polish(problem, planned(problem, located.root, step), CHOSEN, FINE)
    if closed.ending == MISSES and located.other.found:  # as in `calm.solve.search.highest`
        closed = polish(problem, planned(problem, located.other, step), CHOSEN, FINE)
    return closed


def _used(problem: LineProblem, closed: Closed, line: Line) -> float:
    """Return the used fraction of the surface floats' buoyancy in reference water."""
    sought = closed.root.unknown.sought
    if sought == BELOW:
        return 1.0
    lifts = [float(line.buoyancy[each[0]]) for each in problem.surfacing[: sought + 1]]
    shares = [*problem.work.shares[0][:sought], closed.root.x]
    return float(sum(a * b for a, b in zip(shares, lifts, strict=True)) / sum(lifts))
