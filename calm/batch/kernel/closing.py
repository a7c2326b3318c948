"""Closing the lines of many cases: their roots sought in lanes, each by its own steps.

The miss and the order of the search are those of `calm.solve`: the highest root below the
surface, else the share of the buoyancy that a float at the surface uses. The unknown of a case is
the depth of its free end [m] where that is not negative, else the share less one. A lane takes up
the next case as soon as it is done with one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from calm.batch.kernel import lane
from calm.batch.kernel.afloat import (
    NO_FLOAT,
    foresee,
    go_back,
    miss_of,
    next_float,
    place_case,
    seek_from_the_top,
    set_out,
    used_of,
)
from calm.batch.kernel.bends import ROUNDS, recut
from calm.batch.kernel.endings import (
    COMPRESSED,
    HEAP,
    ON_SEABED,
    OUT_OF_WATER,
    SOLVED,
    TOO_COARSE,
    UNCLOSED,
    WRITTEN,
)
from calm.batch.kernel.lane import LANES, STATE, Desk
from calm.batch.kernel.layout import Results, Way
from calm.batch.kernel.outcome import blend, greatest_change, write_case
from calm.batch.kernel.search import (
    AWAY,
    DONE,
    FIRST,
    NOWHERE,
    ROOT,
    THERE,
    Searches,
    advance,
    correct,
)
from calm.physics.line import Floats, Integers

FEWEST_HALVINGS, FINEST = 2, 6
"""How often the cuts are halved at least, and at most."""
PLACE_CHANGE, TENSION_CHANGE = 4e-5, 5e-5
"""What the last halving may change, as shares of the water depth and of the tension. The shape is
then blended from the last two, so that it is off by less; by about as much where currents are
ragged."""
PLACE_CHANGE_LYING = 2e-5
"""The same of places where a line may land: its touchdown is not at a joint of the cuts. It is
halved once more than another, too."""
LUCK = 8.0
"""By how many times a halving may lessen the change: four, where the line is smooth."""
CORNER = 3e-6
"""The worst corner of such a line, turn times length of the segment, as a share of the water depth:
where it is more, a halving may change little and yet the bend not be known."""
CERTAIN = 4.0
"""A shape below the seabed by so many times what the last halving changed is there for certain."""
MOST_MARCHES = 60
COARSE = 0
"""How often cuts are halved where a root is looked for."""

March = Callable[[Desk, Way, int], None]
FindRoots = Callable[[March, Desk, Way, Searches, Integers], None]
CloseAll = Callable[[March, Desk, Way, Searches, "Shapes", Integers, int, Results], None]
"""`calm.batch.kernel.march.march`, and the two below, each compiled by itself."""


class Shapes(NamedTuple):
    """Of every case the last two shapes and its unknown of the time before; one shape blended."""

    older: Floats
    newer: Floats
    earlier: Floats
    blended: Floats


def find_roots(march: March, desk: Desk, way: Way, seek: Searches, reasons: Integers) -> None:
    """Find the coarse root of every case whose reason is `SOLVED` so far: in its row of `seek`.

    Parameters
    ----------
    seek : (cases,) of `Search`
    reasons : (cases,)
    """
    s, water = desk.scratch, desk.water
    slot = water.slot
    task, marches = desk.task, desk.marches
    for i in range(LANES):
        task[i] = DONE
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if task[i] == DONE:
                while upcoming < reasons.size and reasons[upcoming] != SOLVED:
                    upcoming += 1
                if upcoming < reasons.size:
                    slot[i], task[i], marches[i] = upcoming, FIRST, 0
                    if way.joints.size:
                        set_out(desk, seek, upcoming, way)
                    water.interval[i] = upcoming * water.width  # the last profile may have had more
                    upcoming += 1
            busy |= task[i] != DONE
            s[lane.BUSY + i] = 1.0 if task[i] != DONE else 0.0
            place_case(desk, i, seek, way)
        if not busy:
            return
        march(desk, way, COARSE)
        for i in range(LANES):
            if task[i] != DONE:
                c = slot[i]
                task[i], reasons[c] = advance(seek, c, task[i], miss_of(desk, i, seek, way), way)
                if task[i] == DONE and reasons[c] == SOLVED and next_float(desk, seek, c, way):
                    task[i], marches[i] = FIRST, 0
                seek[c].least_carried, seek[c].lying = s[lane.LIGHTEST + i], s[lane.RESTING + i]
                marches[i] += 1
                if marches[i] == MOST_MARCHES and task[i] != DONE:
                    task[i], reasons[c] = DONE, UNCLOSED


def close_on(
    march: March, grid: int, desk: Desk, way: Way, seek: Searches, few: int, reasons: Integers,
    kept: Floats, follows: bool,
) -> None:  # fmt: skip
    """Close pending cases on cuts halved `grid` times; their shapes go to their rows of `kept`.

    `few` : how many are pending. `follows`: the cuts of each then follow the bends of its shape.
    """
    s, water, nodes, forces = desk.scratch, desk.water, desk.nodes, desk.forces
    slot = water.slot
    numbers, after = nodes.size // LANES, forces.size // LANES
    task, pending = desk.task, desk.pending
    for i in range(LANES):
        task[i] = DONE
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if task[i] == DONE and upcoming < few:
                c = pending[upcoming]
                slot[i], water.interval[i], task[i] = c, c * water.width, ROOT
                seek[c].turn = 0
                seek_from_the_top(desk, seek, c, way)
                upcoming += 1
            busy |= task[i] != DONE
            s[lane.BUSY + i] = 1.0 if task[i] != DONE else 0.0
            place_case(desk, i, seek, way)
        if not busy:
            return
        march(desk, way, grid)
        for i in range(LANES):
            if task[i] == DONE:
                continue
            c = slot[i]
            near = correct(seek, c, miss_of(desk, i, seek, way), way.aim)
            if near == THERE and next_float(desk, seek, c, way):
                continue
            task[i] = ROOT if near == AWAY else DONE
            if near == NOWHERE and follows:
                go_back(desk, seek, c, way)
            elif near == NOWHERE:
                reasons[c] = UNCLOSED
            elif near == THERE:
                seek[c].corners = s[lane.SHARPEST + i]
                if follows:
                    recut(desk.own, c, way, desk.spread)
                    continue
                seek[c].refusal = refused(desk, i, way)
                seek[c].lying, seek[c].lowest = s[lane.RESTING + i], s[lane.LOWEST + i]
                for k in range(numbers):
                    kept[c, k] = nodes[k * LANES + i]
                for k in range(after):
                    kept[c, numbers + k] = forces[k * LANES + i]


def refused(desk: Desk, i: int, way: Way) -> int:
    """Why the lane's shape is not to be had, by this march alone; `SOLVED` where it is."""
    s, aim = desk.scratch, way.aim
    if s[lane.LEAST_PULL + i] < 0.0:
        return COMPRESSED
    if s[lane.LOWEST + i] < -aim.span - 1e-6 * aim.span:
        return ON_SEABED
    margin = 1e-6 * aim.span
    risen = way.below != NO_FLOAT and desk.nodes[way.below * STATE * LANES + lane.Z + i] > margin
    if risen or s[lane.HIGHEST + i] > margin + way.standing:
        return OUT_OF_WATER
    # a line below the surface is meant to stand: see `calm.case.Mooring`
    chain_lies = s[lane.LANDED_AT + i] >= aim.first_chain
    sunk = s[lane.RESTING + i] >= 0.0 and s[lane.SHARE + i] == 1.0 and not chain_lies
    return HEAP if sunk else SOLVED


def still_open(ends: Integers, pending: Integers) -> int:
    """The cases that ended `SOLVED` so far; how many."""
    few = 0
    for c in range(ends.size):
        if ends[c] == SOLVED:
            pending[few] = c
            few += 1
    return few


def close_all(
    march: March, desk: Desk, way: Way, seek: Searches, shapes: Shapes, ends: Integers, start: int,
    results: Results,
) -> None:  # fmt: skip
    """Close every case that ended `SOLVED` so far, from its coarse root, and write its results.

    The cuts are halved until that changes little. Those written end `WRITTEN`, or as refused.
    """
    span, stages = way.aim.span, len(way.course.stages)
    older, newer, earlier = shapes.older, shapes.newer, shapes.earlier
    pending = desk.pending
    for c in range(ends.size):
        seek[c].place_before = seek[c].tension_before = 0.0
        seek[c].refusal = SOLVED
    rounds = ROUNDS if way.lands else 0
    finest = FINEST + 1 if way.lands else FINEST
    allowed = PLACE_CHANGE_LYING if way.lands else PLACE_CHANGE
    for time in range(1 - rounds, finest + 1):
        grid, follows = max(time, 1), time < 1
        few = still_open(ends, pending)
        if not follows:
            older, newer = newer, older
            for k in range(few):
                foresee(desk, seek, pending[k], way, earlier, grid == 1)
        close_on(march, grid, desk, way, seek, few, ends, newer, follows)
        if follows or grid < FEWEST_HALVINGS:
            continue
        for k in range(few):
            c = pending[k]
            if ends[c] != SOLVED:
                continue
            case = seek[c]
            place, tension = greatest_change(older[c], newer[c], stages, span)
            below = -span - case.lowest
            if seek[c].refusal == ON_SEABED and below > CERTAIN * place * span:
                ends[c] = ON_SEABED
                continue
            if way.lands:
                # after a great change a small one is luck
                before, pull_before = case.place_before, case.tension_before
                case.place_before, case.tension_before = place, tension
                place, tension = max(place, before / LUCK), max(tension, pull_before / LUCK)
            bends = way.lands and case.corners > CORNER * span
            if place <= allowed and tension <= TENSION_CHANGE and not bends:
                ends[c] = WRITTEN if seek[c].refusal == SOLVED else seek[c].refusal
                if ends[c] != WRITTEN:
                    continue
                blend(stages, older[c], newer[c], shapes.blended)
                used = used_of(desk, seek, c, way, earlier[c])
                write_case(way, shapes.blended, used, results, start + c)
            elif grid == finest:
                ends[c] = TOO_COARSE if seek[c].refusal == SOLVED else seek[c].refusal
