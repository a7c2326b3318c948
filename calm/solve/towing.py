"""The marches of a tow, and its root on fixed segments."""

from collections.abc import Callable
from math import isnan, sqrt

import numpy as np
from numpy.typing import NDArray

from calm.errors import NoEquilibrium
from calm.physics.compiled import outcome
from calm.physics.drag import Vector
from calm.physics.line import FAILURES, Line, MarchError, Trace, Water
from calm.physics.passing import FAILURE, FX, FY, FZ, NODES
from calm.physics.track import Track
from calm.solve.accuracy import Errors, bent, extrapolate, take_as_marched
from calm.solve.audit import referee_of
from calm.solve.closing import (
    Closed,
    Root,
    coarse_root,
    coarser,
    halve,
    miss_now,
    planned,
    polish,
    whole_line,
)
from calm.solve.finish import closing_refusal
from calm.solve.mooring import MORE_ROOM, lacks_room, search_of
from calm.solve.problem import (
    CHOSEN,
    COARSE,
    FINE,
    HALVED,
    KEPT,
    NOT_RECORDED,
    ROOM,
    About,
    Search,
    problem_of,
)
from calm.solve.refine import MOST_ROUNDS, MOST_SEGMENTS, Refined, excess_of
from calm.solve.search import Referee
from calm.solve.solution import FOUND, MARCH_STOPPED, Settings, Status, runs_compiled


class Towed:
    """A towed line, from its free end, in the water as the ship sees it.

    Attributes
    ----------
    span : the line out, by which lengths are measured [m]
    allowed : the greatest miss of a solution [m]
    compiled : whether its laws are compiled
    frequency : of the cables that strum [Hz]
    root : the last that was found
    closed : the same on fixed segments
    """

    def __init__(self, line: Line, water: Water, settings: Settings, height: float) -> None:
        self.line, self.water, self.settings = line, water, settings
        self.span = float(line.length.sum())
        self.allowed = settings.tolerance * self.span
        self.frequency = 0.0
        self._height = height
        self.compiled = runs_compiled(settings, line)
        self.search: Search
        self.referee: Referee
        self._lay_out(ROOM)
        self.root = Root(False, whole_line(self.search.problem, False), 0.0, 0.0, 0.0)
        self.closed: Closed

    @property
    def coarse_step(self) -> float:
        """Angle step of the marches that look for the neighbourhood of a root [rad]."""
        return self.search.problem.limits.coarse_step

    @property
    def force(self) -> Vector:
        """The force at the end of the last march [N]."""
        left = self.search.problem.work.left
        return float(left[FX]), float(left[FY]), float(left[FZ])

    def coarse_miss(self, x: float) -> float:
        """The miss with the free end at a depth, at the coarse step [m].

        Raises
        ------
        MarchError
        """
        return self._marched(x, self.coarse_step, NOT_RECORDED)

    def miss(self, x: float) -> float:
        """The miss with the free end at a depth, at the angle step [m].

        Raises
        ------
        MarchError
        """
        return self._marched(x, self.settings.angle_step, NOT_RECORDED)

    def shape_at(self, x: float, step: float) -> Trace:
        """The shape with the free end at a depth, closed or not.

        Raises
        ------
        MarchError
        """
        self._marched(x, step, KEPT)
        work = self.search.problem.work
        return Trace.of(work.records[KEPT], int(work.left[NODES]))

    def coarse_root(self, a: float, miss_a: float, b: float, miss_b: float) -> Root:
        """Root of the coarse miss between two depths [m]."""
        unknown = self.root.unknown
        root: Root = outcome(coarse_root, self.compiled, self.search, unknown, a, miss_a, b, miss_b)
        self._refuse_stopped(root.miss)
        return root

    def find_coarser(self) -> None:
        """Seek the coarse root near the last one."""
        self.root = outcome(coarser, self.compiled, self.search, self.root)
        self._refuse_stopped(self.root.miss)

    def strum(self, frequency: float) -> None:
        """Let the cables strum at a frequency [Hz]."""
        self.frequency = frequency
        track = Track.of(self.line, frequency)
        course = track.packed if self.compiled else track.course
        problem = self.search.problem._replace(course=course, loads=course.loads)
        self.search = self.search._replace(problem=problem)
        moored = self.referee.moored._replace(frequency=frequency)
        self.referee = self.referee._replace(moored=moored)

    def polish(self, cuts: int, record: int) -> None:
        """Close the line on its cuts, from the last root.

        Raises
        ------
        NoEquilibrium, MarchError
        """
        self.closed = outcome(polish, self.compiled, self.search, self.root, cuts, record)
        if self.closed.ending == MARCH_STOPPED:
            self._refuse_stopped(self.closed.root.miss)
        if self.closed.ending != FOUND:
            raise closing_refusal(self.closed, True)
        self.root = self.closed.root

    def refine(self, polish: Callable[[int, int], None]) -> Refined:
        """As `calm.solve.refine`, where closing the line on cuts in a record takes more.

        Raises
        ------
        NoEquilibrium, MarchError
        """
        step, problem = self.settings.angle_step, self.search.problem
        for _ in range(MOST_ROUNDS):
            self.root = self._planned(2.0 * step)
            segments: int = outcome(halve, self.compiled, self.search.problem)
            polish(CHOSEN, COARSE)
            coarse = self.closed
            polish(HALVED, FINE)
            problem = self.search.problem
            records = problem.work.records
            errors: Errors = outcome(
                extrapolate, self.compiled, records[COARSE], coarse, records[FINE], self.closed, 0.0
            )
            excess = excess_of(problem, errors)
            if excess <= 1.0 or segments > MOST_SEGMENTS:
                break
            step *= max(0.8 / sqrt(excess), 0.2)
        kinked, errors = outcome(bent, self.compiled, problem, self.closed, errors)
        if kinked:
            outcome(take_as_marched, self.compiled, records[FINE], self.closed.nodes)
        return Refined(self.closed, segments, errors, self.closed.root.x, 0.0)

    def _planned(self, step: float) -> Root:
        root: Root = outcome(planned, self.compiled, self.search, self.root, step)
        if self._gets_room():
            return self._planned(step)
        self._refuse_stopped(root.miss)
        return root

    def _marched(self, x: float, step: float, record: int) -> float:
        miss = self._miss(x, step, record)
        if self._gets_room():
            return self._marched(x, step, record)
        self._refuse_stopped(miss)
        return miss

    def _miss(self, x: float, step: float, record: int) -> float:
        about = About(self.search.problem, self.root.unknown, step, CHOSEN, False, record)
        miss: float = outcome(miss_now, self.compiled, self.search.miss, about, x)
        return miss

    def _lay_out(self, room: int) -> None:
        compiled = self.compiled
        problem = problem_of(
            self.line, self.water, self.settings, compiled=compiled, frequency=self.frequency,
            tow_height=self._height, room=room,
        )  # fmt: skip
        self.search = search_of(problem, compiled)
        self.referee = referee_of(self.line, self.water, self.frequency, compiled)

    def _gets_room(self) -> bool:
        """Lay the line out anew where the last march needed more room; whether it did."""
        problem = self.search.problem
        if lacking := lacks_room(problem):
            self._lay_out(MORE_ROOM * len(problem.work.chosen))
        return lacking

    def _refuse_stopped(self, miss: float) -> None:
        if isnan(miss):
            raise MarchError(FAILURES[int(self.search.problem.work.left[FAILURE])])


MOST_MOVES = 6
WIDEST_JUMP = 0.02
"""How far from a root that does not close its jump is sought, as a share of the line out."""
NARROW_JUMP = 1e-9
RIDE_CLEAR = "Pay out or take in some line, so that it is clear of the surface."


class Waterline:
    """Brings the node that is nearest to the surface there, shape after shape, by secants.

    A segment both in water and in air would count for one of them alone, and the same on coarse
    and on halved segments: an error that their difference does not show.

    Parameters
    ----------
    near : what is near enough [m]
    """

    def __init__(self, tow: Towed, near: float) -> None:
        self._tow, self._near = tow, near
        self._shift = self._height = 0.0
        self._moves = 0

    def moves(self, cuts: int, record: int) -> bool:
        """Shift that node along its cable, where it need and can be; whether it was."""
        tow, work = self._tow, self._tow.search.problem.work
        trace = Trace.of(work.records[record], tow.closed.nodes)
        heights, cut = trace.position[:, 2], trace.cut
        node = int(np.argmin(np.abs(heights)))
        height = float(heights[node])
        cable = tow.line.flexible[trace.piece] & (trace.clamp < 0)
        if abs(height) <= self._near or not 0 < node < len(cable) or self._moves == MOST_MOVES:
            return False
        if not (cable[node - 1] and cable[node]):
            return False
        here = slice(node - 1, node + 1)
        rise = float(heights[node + 1] - heights[node - 1]) / float(cut[here].sum())
        if self._shift and height != self._height:
            rise = (height - self._height) / self._shift
        shift = -height / rise if rise else 0.0
        if not -cut[node - 1] < shift < cut[node]:
            return False
        self._shift, self._height = shift, height
        self._moves += 1
        segment = int(cable[: node - 1].sum())
        if segment + 1 in np.cumsum(work.counts[cuts]):
            return False  # the next segment is another cable's
        lengths = work.halved if cuts == HALVED else work.chosen
        lengths[segment] += shift
        lengths[segment + 1] -= shift
        return True


def half_out(tow: Towed) -> NoEquilibrium | None:
    """Return why a tow does not close at a root where its miss jumps; None where it does not jump
    there.

    A rigid piece or a clamp is in the water or out of it, by its middle. Where the line is too
    high with one in the water and too low with it out, it would ride half out: no equilibrium.
    """
    root, span = tow.root, tow.span
    try:
        reach = 1e-4 * span
        while tow.miss(root.x - reach) < 0.0 or tow.miss(root.x + reach) > 0.0:
            reach *= 2.0
            if reach > WIDEST_JUMP * span:
                return None
        high, low = root.x - reach, root.x + reach
        while low - high > NARROW_JUMP * span:
            middle = 0.5 * (high + low)
            high, low = (middle, low) if tow.miss(middle) > 0.0 else (high, middle)
        jump = tow.miss(high), tow.miss(low)
        shapes = [tow.shape_at(x, tow.settings.angle_step) for x in (high, low)]
    except MarchError:
        return None
    above, below = (_middles(tow.line.flexible, shape) for shape in shapes)
    for (piece, clamp), height in above.items():
        if (height > 0.0) is not (below[piece, clamp] > 0.0):
            what = "{piece}" if clamp < 0 else "a clamp on {piece}"
            return Status.NO_EQUILIBRIUM.because(
                f"The line closes neither with {what} in the water nor with it out: its upper end "
                f"would be {jump[0]:.2g} m above the tow point or {-jump[1]:.2g} m below. It would "
                "ride half out of the water, which CALM does not solve.",
                piece,
                RIDE_CLEAR,
            )
    return None


def _middles(flexible: NDArray[np.bool_], shape: Trace) -> dict[tuple[int, int], float]:
    """Heights of the middles of rigid pieces and clamps [m], by piece and clamp."""
    single = np.flatnonzero(~flexible[shape.piece] | (shape.clamp >= 0))
    heights = 0.5 * (shape.position[single, 2] + shape.position[single + 1, 2])
    keys = zip(shape.piece[single].tolist(), shape.clamp[single].tolist(), strict=True)
    return dict(zip(keys, heights.tolist(), strict=True))
