"""Cases of a batch solved by the compiled kernel."""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.batch.kernel.cases import CHUNK, solve_chunks
from calm.batch.kernel.closing import Shapes, close_all, find_roots
from calm.batch.kernel.compiled import by_address, entry
from calm.batch.kernel.lane import LANES, SCRATCH, STATE, Desk, Tables
from calm.batch.kernel.layout import Results
from calm.batch.kernel.march import march
from calm.batch.kernel.plan import Plan
from calm.batch.kernel.search import Search
from calm.physics.compiled import record_type
from calm.physics.line import Floats, Integers
from calm.physics.profile import Interval, Sea


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
        scratch=np.zeros(SCRATCH),
        water=water,
        nodes=np.zeros(STATE * LANES * (len(course.stages) + 1)),
        forces=np.zeros(3 * LANES * len(course.loads)),
        own=np.zeros((3, cases, len(plan.lying.cuts))),
        loads=np.zeros_like(course.loads),
        task=np.zeros(LANES, np.int64),
        marches=np.zeros(LANES, np.int64),
        pending=np.zeros(cases, np.int64),
        there=np.zeros(cases, np.int64),
        again=np.zeros(cases, np.int64),
        read=np.zeros((levels, 4)),
        joined=np.zeros((levels, 5)),
        spread=np.zeros((4, most)),
    )


def solve_cases(
    plan: Plan, depth: Floats, u: Floats, v: Floats, w: Floats, results: Results, reasons: Integers
) -> None:
    """Solve cases; what they lead to goes to their rows of the results, how they ended to reasons.

    Parameters
    ----------
    depth : (1 or n, k) of the levels [m]
    u, v, w : (n, k) current [m/s]; NaN where there is none
    reasons : (n,) see `calm.batch.kernel.endings`
    """
    desk = desk_for(plan, depth.shape[1], CHUNK)
    size = (desk.nodes.size + desk.forces.size) // LANES
    shapes = Shapes(
        np.zeros((CHUNK, size)), np.zeros((CHUNK, size)), np.zeros(CHUNK), np.zeros(size)
    )
    seek = np.zeros(CHUNK, record_type(Search))
    marching: Any = by_address(march, desk, plan.clear, 0, singly=plan.singly)
    find: Any = by_address(find_roots, marching, desk, plan.clear, seek, reasons)
    close: Any = by_address(
        close_all, marching, desk, plan.clear, seek, shapes, reasons, 0, results
    )
    entry(solve_chunks)(
        find, close, marching, plan.clear, plan.lying, plan.contact, desk, shapes,
        seek, depth, u, v, w, results, reasons,
    )  # fmt: skip
