"""Cases of a batch solved by the compiled kernel."""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.batch.kernel.afloat import Afloat
from calm.batch.kernel.cases import CHUNK, solve_chunks
from calm.batch.kernel.closing import Shapes, close_all, find_roots
from calm.batch.kernel.compiled import by_address, entry
from calm.batch.kernel.endings import AT_SURFACE, OUT_OF_WATER, UNCLOSED
from calm.batch.kernel.lane import LANES, MOST_UPPER, SCRATCH, STATE, Desk, Tables
from calm.batch.kernel.layout import Results, Way
from calm.batch.kernel.march import march
from calm.batch.kernel.plan import Plan
from calm.batch.kernel.search import Search, Searches
from calm.physics.compiled import record_type
from calm.physics.line import Floats, Integers
from calm.physics.profile import Interval, Sea

NEEDS_FLOAT = (AT_SURFACE, OUT_OF_WATER, UNCLOSED)
"""How a case ends that may need another float at the surface."""
LINE = 64
"""Bytes of a line of the processor's cache."""


def aligned(count: int) -> Floats:
    """So many zeros, from the beginning of a line of the cache."""
    room = np.zeros(count + LINE // 8)
    first = -room.ctypes.data % LINE // 8
    return room[first : first + count]


def desk_for(plan: Plan, levels: int, cases: int) -> Desk:
    """What marches of so many cases at a time write on, in profiles of so many levels."""
    course = plan.clear.course
    levels += len(plan.clear.fixed)
    most = len(plan.lying.cuts) + 1
    numbers: Any = np.zeros(cases * (levels + 2))
    intervals: Any = np.zeros(cases * (levels + 2), record_type(Interval))
    water = Tables(
        slot=np.zeros(LANES, np.int64),
        interval=np.zeros(LANES, np.int64),
        sea=Sea(
            levels=numbers,
            intervals=intervals,
            gravity=plan.water.gravity,
            strata=plan.strata,
        ),
        width=levels + 2,
    )
    return Desk(
        scratch=aligned(SCRATCH),
        water=water,
        nodes=aligned(STATE * LANES * (len(course.stages) + 1)),
        forces=aligned(3 * LANES * len(course.loads)),
        own=np.zeros((3, cases, len(plan.lying.cuts))),
        loads=np.zeros_like(course.loads),
        task=np.zeros(LANES, np.int64),
        marches=np.zeros(LANES, np.int64),
        afloat=np.zeros((2, cases, MOST_UPPER + 1), record_type(Afloat)),
        pending=np.zeros(cases, np.int64),
        there=np.zeros(cases, np.int64),
        again=np.zeros(cases, np.int64),
        read=np.zeros((levels, 4)),
        joined=np.zeros((levels, 5)),
        spread=np.zeros((4, most)),
    )


class Kernel:
    """The lanes made ready for a mooring: compiled for it, or fetched.

    Numba takes milliseconds to name the types of a plan, in which hundreds of cases are solved:
    here it does so once.
    """

    def __init__(self, plan: Plan) -> None:
        desk, shapes, seek = desk_for(plan, 1, 1), shapes_for(plan, 1), searches(1)
        reasons = np.zeros(1, np.int64)
        results = Results(np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), np.zeros((1, 1)))
        clear = plan.clear
        self.plan = plan
        self.march: Any = by_address(march, desk, clear, 0, singly=plan.singly)
        self.find: Any = by_address(find_roots, self.march, desk, clear, seek, reasons)
        self.close: Any = by_address(
            close_all, self.march, desk, clear, seek, shapes, reasons, 0, results
        )

    def solve(
        self, depth: Floats, u: Floats, v: Floats, w: Floats, results: Results, reasons: Integers
    ) -> None:
        """Solve cases; what they lead to goes to their rows of the results, how they ended to
        reasons.

        Parameters
        ----------
        depth : (1 or n, k) of the levels [m]
        u, v, w : (n, k) current [m/s]; NaN where there is none
        reasons : (n,) see `calm.batch.kernel.endings`
        """
        plan = self.plan
        self._solve(plan.clear, plan.lying, depth, u, v, w, results, reasons)
        for clear, lying in plan.several:
            again = np.flatnonzero(np.isin(reasons, NEEDS_FLOAT))
            if not again.size:
                return
            levels = depth if len(depth) == 1 else depth[again]
            found, ends = Results(*(rows[again] for rows in results)), reasons[again]
            self._solve(clear, lying, levels, u[again], v[again], w[again], found, ends)
            reasons[again] = ends
            for rows, mine in zip(results, found, strict=True):
                rows[again] = mine

    def _solve(
        self, clear: Way, lying: Way, depth: Floats, u: Floats, v: Floats, w: Floats,
        results: Results, reasons: Integers,
    ) -> None:  # fmt: skip
        plan, chunk = self.plan, CHUNK
        entry(solve_chunks)(
            self.find, self.close, self.march, clear, lying, plan.contact,
            desk_for(plan, depth.shape[1], chunk), shapes_for(plan, chunk), searches(chunk),
            depth, u, v, w, results, reasons,
        )  # fmt: skip


def shapes_for(plan: Plan, cases: int) -> Shapes:
    """Room for the shapes of so many cases."""
    course = plan.clear.course
    size = STATE * (len(course.stages) + 1) + 3 * len(course.loads)
    return Shapes(np.zeros((cases, size)), np.zeros((cases, size)), np.zeros(cases), np.zeros(size))


def searches(cases: int) -> Searches:
    """Room for the search of so many cases."""
    return np.zeros(cases, record_type(Search))
