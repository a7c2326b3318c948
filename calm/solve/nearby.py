"""Shapes near a solved one, so alike in their segments that their differences are derivatives.

Two independent solves cut a line differently and differ by their truncation errors too, which
drowns a small change. Here every neighbour keeps the cuts of the first shape and starts at its
root: two or three marches close it.
"""

from __future__ import annotations

from math import isnan

import numpy as np

from calm.physics.compiled import entry
from calm.physics.line import Floats, Line, Water
from calm.physics.passing import FAILURE
from calm.physics.state import Trace
from calm.physics.track import Track
from calm.solve.audit import referee_of
from calm.solve.closing import Closed, Root, not_closed, planned, polish
from calm.solve.finish import closing_refusal, solution_found
from calm.solve.locate import locate
from calm.solve.mooring import search_of, solve_mooring
from calm.solve.problem import BELOW, CHOSEN, FINE, LineProblem, Search, Unknown, problem_of
from calm.solve.refine import Errors, Refined
from calm.solve.search import audited
from calm.solve.solution import FOUND, MARCH_STOPPED, Settings, Solution, Status, runs_compiled


class Nearby:
    """A moored line and the lines that differ a little from it.

    Parameters
    ----------
    line, water, settings : as of `solve_mooring`; a tight `tolerance` lets small changes be seen

    Attributes
    ----------
    solution : of the line itself

    Raises
    ------
    NoEquilibrium
        As `solve_mooring` does.
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        self.solution = solve_mooring(line, water, settings)
        self._water, self._settings = water, settings
        self._room = 2 * len(self.solution.cut) + 64
        self._compiled = compiled = runs_compiled(settings, line)
        problem = problem_of(line, water, settings, compiled=compiled, room=self._room)
        search = search_of(problem, compiled)
        close = entry(close_coarsely, search, True) if compiled else close_coarsely
        closed: Closed = close(search, self.solution.landed)
        if closed.ending != FOUND:
            raise closing_refusal(closed, False)
        self._root, work = closed.root, problem.work
        self._counts = np.array(work.counts[CHOSEN])
        self._cuts = np.array(work.chosen[: int(self._counts.sum())])
        self._shares = np.array(work.shares)
        self._trace = Trace.of(work.records[FINE], closed.nodes)

    def node(self, piece: int, clamp: int = -1) -> int:
        """The node at the top of a piece, or at a clamp, in every one of these shapes."""
        if clamp >= 0:
            return int(np.argmax(self._trace.clamp == clamp))
        return int(np.argmax(self._trace.piece == piece))

    def shape(self, line: Line) -> tuple[Floats, float]:
        """Nodes of a line that differs a little, and its buoyancy in use.

        Returns
        -------
        (k+1, 3) east and north of the anchor, up from the surface [m]; and the share in use of
        the buoyancy of the floats at the surface, 1 below it.

        Raises
        ------
        NoEquilibrium
            ``not-converged`` or ``slack``.
        """
        search, closed = self._closed(line, self._water, None)
        trace = Trace.of(search.problem.work.records[FINE], closed.nodes)
        position = trace.position
        position[:, :2] -= position[-1, :2]
        return position, _used(search.problem, closed, line)

    def solved(self, line: Line, water: Water, track: Track | None = None) -> Solution:
        """The solution of a line that differs, on the cuts of this one.

        Its errors are stated as those of this one, whose cuts it has.

        Parameters
        ----------
        line, water : of the same pieces, all cables longer by one factor
        track : the line laid out, where it is known

        Raises
        ------
        NoEquilibrium
            Where there is none that passes every check, or none of the same kind near by.
        """
        search, closed = self._closed(line, water, track)
        base, compiled = self.solution, self._compiled
        if closed.landed != base.landed:
            raise Status.NOT_CONVERGED.because("It lies on the seabed, or hangs, unlike the other.")
        errors = Errors(base.depth_error, base.tension_error, 0.0, base.lift_error, base.pull_error)
        referee = referee_of(line, water, 0.0, compiled)
        refined = Refined(closed, len(self._cuts), errors)
        problem = search.problem
        audit = entry(audited, problem, referee, refined) if compiled else audited
        return solution_found(
            audit(problem, referee, refined), problem, line, water, self._settings
        )

    def _closed(self, line: Line, water: Water, track: Track | None) -> tuple[Search, Closed]:
        compiled = self._compiled
        problem = problem_of(
            line, water, self._settings, compiled=compiled, track=track, room=self._room
        )
        given, cables = self.solution.line, line.flexible
        longer = line.length[cables].sum() / given.length[cables].sum() if cables.any() else 1.0
        work = problem.work
        work.chosen[: len(self._cuts)] = (longer * self._cuts).tolist()
        work.counts[CHOSEN][:] = self._counts.tolist()
        for row in range(2):
            work.shares[row][:] = self._shares[row].tolist()
        search = search_of(problem, compiled)
        close = entry(polish, search, self._root, CHOSEN, FINE) if compiled else polish
        closed: Closed = close(search, self._moved(water, problem), CHOSEN, FINE)
        if closed.ending != FOUND:
            raise closing_refusal(closed, False)
        return search, closed

    def _moved(self, water: Water, problem: LineProblem) -> Root:
        """The root in water of another depth."""
        root, deeper = self._root, water.depth - self._water.depth
        was, x = root.unknown, root.x
        unknown = Unknown(was.goal - deeper, was.sought, was.rides, was.lands, was.stages)
        if unknown.sought == BELOW:
            x = max(x + deeper, 0.0)
        return Root(True, unknown, x, root.miss, root.slope)


def close_coarsely(search: Search, lands: bool) -> Closed:
    """Close a line on the cuts that the march chooses at its angle step, in the record `FINE`."""
    located = locate(search, lands)
    if located.ending != FOUND:
        return not_closed(located.ending, located.value, located.root)
    root = planned(search, located.root, search.problem.limits.angle_step)
    if isnan(root.miss):
        return not_closed(MARCH_STOPPED, search.problem.work.left[FAILURE], root)
    return polish(search, root, CHOSEN, FINE)


def _used(problem: LineProblem, closed: Closed, line: Line) -> float:
    """Share in use of the buoyancy in reference water of the floats at the surface."""
    sought = closed.root.unknown.sought
    if sought == BELOW:
        return 1.0
    lifts = [float(line.buoyancy[each[0]]) for each in problem.surfacing[: sought + 1]]
    shares = [*problem.work.shares[0][:sought], closed.root.x]
    return float(sum(a * b for a, b in zip(shares, lifts, strict=True)) / sum(lifts))
