"""The cases of a batch, chunk by chunk: clear of the seabed, or lying on it.

The order in which the two are tried is that of `calm.solve.mooring`, but that a line is first
looked for clear of the seabed: there, where it carries its lower end all the way, the two are one.
"""

from __future__ import annotations

from calm.batch.kernel.bends import as_planned
from calm.batch.kernel.closing import CloseAll, FindRoots, March, Shapes
from calm.batch.kernel.contact import LIKELY, NEVER
from calm.batch.kernel.endings import (
    HEAP,
    LEVELS_COINCIDE,
    LIFTED,
    NO_DATA,
    ON_SEABED,
    SAGS,
    SOLVED,
    STILL,
    TURNS_BACK,
    WRITTEN,
)
from calm.batch.kernel.lane import Desk
from calm.batch.kernel.layout import Aim, Results, Way
from calm.batch.kernel.profile import growth_below, lay_profile, read_profile
from calm.batch.kernel.search import Searches, begin
from calm.physics.line import Floats, Integers

CHUNK = 256
"""Cases that are laid out at once: enough to keep the lanes busy, and to fit a cache."""
EITHER_WAY = 1e-4
"""How near to the longest length that has barely landed another is either way, as a share of the
water depth."""


def read_case(
    c: int, way: Way, desk: Desk, seek: Searches, depth: Floats, u: Floats, v: Floats, w: Floats
) -> int:
    """Lay a profile out in a slot and set out on its case; returns why it needs no search."""
    read, joined = desk.read, desk.joined
    found = read_profile(depth, u, v, w, read)
    if found <= 0:
        return NO_DATA if found == 0 else LEVELS_COINCIDE
    sea, width = desk.water.sea, desk.water.width
    here = slice(c * width, (c + 1) * width)
    levels, intervals = sea.levels[here], sea.intervals[here]
    total = lay_profile(read, found, way.fixed, levels, intervals, joined)
    growth, speed = growth_below(joined, total, way.aim.upright)
    begin(seek, c, growth, speed, way)
    return SOLVED if speed > 0.0 else STILL


def as_on_seabed(seek: Searches, c: int, aim: Aim, several: bool) -> int:
    """Whether a line found clear of the seabed is what the search for one that lies there finds.

    That one brings the line's end down to the seabed: a float that just reaches the surface then
    is under water, where there may be another root. `several` of them may not close the line then.
    """
    if seek[c].least_carried <= 0.0:
        return SAGS
    dips = seek[c].unknown < 0.0 and seek[c].lower_miss >= -aim.anchor_height
    return TURNS_BACK if dips and (seek[c].fall > 0.0 or several) else SOLVED


def look_on_seabed(
    find: FindRoots, close: CloseAll, march: March, desk: Desk, clear: Way, lying: Way,
    contact: int, seek: Searches, shapes: Shapes, ends: Integers, start: int, results: Results,
) -> None:  # fmt: skip
    """Look on the seabed for the cases that have not been closed clear of it."""
    there, again = desk.there[: ends.size], desk.again[: ends.size]
    for c in range(ends.size):
        case = seek[c]
        there[c] = again[c] = WRITTEN
        case.tried = 0
        case.aloft, case.aloft_slope, case.aloft_found = case.unknown, case.slope, case.found
        if ends[c] == ON_SEABED or (contact == LIKELY and ends[c] > STILL and ends[c] != WRITTEN):
            there[c], case.tried = SOLVED, 1
            begin(seek, c, seek[c].growth, seek[c].speed, lying)
            as_planned(desk.own, c, lying)
    find(march, desk, lying, seek, there)
    for c in range(ends.size):
        if there[c] == SOLVED and seek[c].lying < 0.0:
            there[c] = LIFTED
    close(march, desk, lying, seek, shapes, there, start, results)
    limit, margin = lying.aim.barely, EITHER_WAY * lying.aim.span
    for c in range(ends.size):
        if seek[c].tried == 0:
            continue
        closed = there[c] == WRITTEN or there[c] == HEAP
        beyond = seek[c].lying - limit
        if closed and beyond > margin:
            ends[c] = there[c]
        elif closed and (there[c] == HEAP or (limit > 0.0 and beyond > -margin)):
            ends[c] = LIFTED
        elif ends[c] == SAGS and (closed or there[c] == LIFTED):
            again[c], seek[c].tried = SOLVED, 2
            seek[c].unknown, seek[c].slope = seek[c].aloft, seek[c].aloft_slope
            seek[c].found = seek[c].aloft_found
        elif ends[c] == ON_SEABED and closed:
            ends[c] = WRITTEN
        elif closed:
            ends[c] = LIFTED
        elif there[c] != LIFTED:
            ends[c] = there[c]
    close(march, desk, clear, seek, shapes, again, start, results)
    for c in range(ends.size):
        if seek[c].tried == 2:
            lies = again[c] == ON_SEABED and there[c] == WRITTEN
            ends[c] = WRITTEN if lies else again[c]


def solve_chunks(
    find: FindRoots, close: CloseAll, march: March, clear: Way, lying: Way, contact: int,
    desk: Desk, shapes: Shapes, seek: Searches, depth: Floats, u: Floats, v: Floats, w: Floats,
    results: Results, reasons: Integers,
) -> None:  # fmt: skip
    """Solve cases, as many at a time as there are slots: see `calm.batch.kernel.solve.Kernel`."""
    chunk = seek.size
    for start in range(0, reasons.size, chunk):
        ends = reasons[start : start + chunk]
        for c in range(ends.size):
            case = start + c
            levels_at = depth[case if depth.shape[0] > 1 else 0]
            ends[c] = read_case(c, clear, desk, seek, levels_at, u[case], v[case], w[case])
        find(march, desk, clear, seek, ends)
        if contact == LIKELY:
            for c in range(ends.size):
                if ends[c] == SOLVED:
                    ends[c] = as_on_seabed(seek, c, clear.aim, clear.joints.size > 0)
        close(march, desk, clear, seek, shapes, ends, start, results)
        if contact != NEVER:
            look_on_seabed(
                find, close, march, desk, clear, lying, contact, seek, shapes, ends, start, results
            )
        for c in range(ends.size):
            ends[c] = SOLVED if ends[c] == WRITTEN else ends[c]
