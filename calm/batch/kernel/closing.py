"""Closing the lines of many cases: their roots sought in lanes, each by its own steps.

The miss and the order of the search are those of `calm.solve`: the highest root below the
surface, else the share of the buoyancy that a float at the surface uses. The unknown of a case is
the depth of its free end [m] where that is not negative, else the share less one. A lane takes up
the next case as soon as it is done with one.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from calm.batch.kernel.bends import LANDS, ROUNDS, recut
from calm.batch.kernel.compiled import compiled
from calm.batch.kernel.lanes import (
    FREE_END,
    HELD,
    HIGHEST,
    LANDED_AT,
    LANES,
    LEAST_PULL,
    LIGHTEST,
    LOWEST,
    OUT,
    RESTING,
    SHARE,
    SHARPEST,
    WET,
    WIND_EAST,
    WIND_NORTH,
    Tables,
    Z,
)
from calm.batch.kernel.march import march
from calm.batch.kernel.outcome import blend, greatest_change, write_case
from calm.batch.kernel.search import (
    AWAY,
    CORNERS,
    DONE,
    FIRST,
    FOUND,
    LEAST_CARRIED,
    LOWEST_PLACE,
    LYING,
    NOWHERE,
    PLACE_BEFORE,
    SOLVED,
    TENSION_BEFORE,
    THERE,
    TURN,
    UNCLOSED,
    Y,
    advance,
    correct,
)  # fmt: skip
from calm.physics.line import Floats, Integers

# how a case ended; those of the search are there
OUT_OF_WATER, ON_SEABED, COMPRESSED, TOO_COARSE, WRITTEN, HEAP = range(8, 14)

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

Desk = tuple[Floats, Tables, Floats, Floats, Floats]
"""What a march writes on: scratch, tables, recorded nodes and forces, the cuts of every case."""

Shapes = tuple[Floats, Floats, Floats, Floats]
"""Of every case the two last shapes and where it closed the time before; one shape blended."""


@compiled
def place_free_end(s: Floats, i: int, y: float, riding: Floats, rigid: tuple[float, float]) -> None:
    """Put a lane's free end where its unknown has it."""
    s[FREE_END + i], s[SHARE + i], s[OUT + i] = y, 1.0, 0.0
    s[WET + i], s[HELD + i], s[WIND_EAST + i], s[WIND_NORTH + i] = 1.0, 1.0, 0.0, 0.0
    if y < 0.0:
        s[FREE_END + i], s[SHARE + i] = 0.0, 1.0 + y
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
def find_roots(desk: Desk, plan: Any, seek: Floats, reasons: Integers) -> None:
    """Find the coarse root of every case whose reason is `SOLVED` so far: in its row of `seek`.

    Parameters
    ----------
    seek : (cases, COLUMNS) see `calm.batch.kernel.search`
    reasons : (cases,)
    """
    s, water, nodes, forces, own = desk
    stages, _, mooring, floating, chances, _ = plan
    slots, level = water[0], water[1]
    task = np.full(LANES, DONE)
    marches = np.zeros(LANES, np.int64)
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if task[i] == DONE:
                while upcoming < reasons.size and reasons[upcoming] != SOLVED:
                    upcoming += 1
                if upcoming < reasons.size:
                    slots[i], task[i], marches[i] = upcoming, FIRST, 0
                    level[i] = 0  # the last profile may have had more
                    upcoming += 1
            busy |= task[i] != DONE
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not busy:
            return
        march(s, water, stages, 0, nodes, forces, own)
        for i in range(LANES):
            if task[i] != DONE:
                c = slots[i]
                miss = s[Z + i] - mooring[1]
                task[i], reasons[c] = advance(seek, c, task[i], miss, mooring, chances[0])
                seek[c, LEAST_CARRIED], seek[c, LYING] = s[LIGHTEST + i], s[RESTING + i]
                marches[i] += 1
                if marches[i] == MOST_MARCHES and task[i] != DONE:
                    task[i], reasons[c] = DONE, UNCLOSED


@compiled
def close_on(
    grid: int, desk: Desk, plan: Any, seek: Floats, pending: Integers, reasons: Integers,
    refusals: Integers, kept: Floats, follows: bool,
) -> None:  # fmt: skip
    """Close pending cases on cuts halved `grid` times; their shapes go to their rows of `kept`.

    `follows`: the cuts of each then follow the bends of its shape.
    """
    s, water, nodes, forces, own = desk
    stages, _, mooring, floating, _, _ = plan
    slots, level = water[0], water[1]
    numbers, after = nodes.size // LANES, forces.size // LANES
    closing = np.zeros(LANES, np.bool_)
    upcoming = 0
    while True:
        busy = False
        for i in range(LANES):
            if not closing[i] and upcoming < pending.size:
                slots[i], level[i], closing[i] = pending[upcoming], 0, True
                seek[slots[i], TURN] = 0.0
                upcoming += 1
            busy |= closing[i]
            place_free_end(s, i, seek[slots[i], Y], floating[0], floating[1])
        if not busy:
            return
        march(s, water, stages, grid, nodes, forces, own)
        for i in range(LANES):
            if not closing[i]:
                continue
            c = slots[i]
            near = correct(seek, c, s[Z + i] - mooring[1], mooring)
            closing[i] = near == AWAY
            if near == NOWHERE and follows:
                seek[c, Y] = seek[c, FOUND]
            elif near == NOWHERE:
                reasons[c] = UNCLOSED
            elif near == THERE:
                seek[c, CORNERS] = s[SHARPEST + i]
                if follows:
                    recut(own, c, stages)
                    continue
                refusals[c] = refused(s, i, mooring)
                seek[c, LYING], seek[c, LOWEST_PLACE] = s[RESTING + i], s[LOWEST + i]
                for k in range(numbers):
                    kept[c, k] = nodes[k * LANES + i]
                for k in range(after):
                    kept[c, numbers + k] = forces[k * LANES + i]


@compiled
def refused(s: Floats, i: int, mooring: Any) -> int:
    """Why the lane's shape is not to be had, by this march alone; `SOLVED` where it is."""
    span, first_chain = mooring[0], mooring[6]
    if s[LEAST_PULL + i] < 0.0:
        return COMPRESSED
    if s[LOWEST + i] < -span - 1e-6 * span:
        return ON_SEABED
    if s[HIGHEST + i] > 1e-6 * span:
        return OUT_OF_WATER
    # a line below the surface is meant to stand: see `calm.case.Mooring`
    sunk = s[RESTING + i] >= 0.0 and s[SHARE + i] == 1.0 and s[LANDED_AT + i] < first_chain
    return HEAP if sunk else SOLVED


@compiled
def close_all(
    desk: Desk, plan: Any, seek: Floats, shapes: Shapes, ends: Integers, start: int, results: Any
) -> None:
    """Close every case that ended `SOLVED` so far, from its coarse root, and write its results.

    The cuts are halved until that changes little. Those written end `WRITTEN`, or as refused.
    """
    stages, parts, mooring = plan[0], plan[1], plan[2]
    older, newer, earlier, shape = shapes
    count = stages[0].size
    refusals = np.zeros(ends.size, np.int64)
    for c in range(ends.size):
        seek[c, PLACE_BEFORE] = seek[c, TENSION_BEFORE] = 0.0
    for _ in range(ROUNDS if stages[LANDS] else 0):
        pending = np.flatnonzero(ends == SOLVED)
        close_on(1, desk, plan, seek, pending, ends, refusals, newer, True)
    finest = FINEST + 1 if stages[LANDS] else FINEST
    allowed = PLACE_CHANGE_LYING if stages[LANDS] else PLACE_CHANGE
    for grid in range(1, finest + 1):
        pending = np.flatnonzero(ends == SOLVED)
        older, newer = newer, older
        for k in range(pending.size):
            # where the root has gone by the last halving, it goes a quarter as far by this one
            c = pending[k]
            y = seek[c, Y]
            seek[c, Y] = y + (0.25 * (y - earlier[c]) if grid > 1 else 0.0)
            earlier[c] = y
        close_on(grid, desk, plan, seek, pending, ends, refusals, newer, False)
        if grid < FEWEST_HALVINGS:
            continue
        for k in range(pending.size):
            c = pending[k]
            if ends[c] != SOLVED:
                continue
            place, tension = greatest_change(older[c], newer[c], count, mooring[0])
            below = -mooring[0] - seek[c, LOWEST_PLACE]
            if refusals[c] == ON_SEABED and below > CERTAIN * place * mooring[0]:
                ends[c] = ON_SEABED
                continue
            if stages[LANDS]:
                # after a great change a small one is luck
                place, tension, seek[c, PLACE_BEFORE], seek[c, TENSION_BEFORE] = (
                    max(place, seek[c, PLACE_BEFORE] / LUCK),
                    max(tension, seek[c, TENSION_BEFORE] / LUCK),
                    place,
                    tension,
                )
            bends = stages[LANDS] and seek[c, CORNERS] > CORNER * mooring[0]
            if place <= allowed and tension <= TENSION_CHANGE and not bends:
                ends[c] = WRITTEN if refusals[c] == SOLVED else refusals[c]
                if ends[c] != WRITTEN:
                    continue
                blend(stages, older[c], newer[c], shape)
                used = 1.0 + min((4.0 * seek[c, Y] - earlier[c]) / 3.0, 0.0)
                write_case(stages, parts, shape, used, results, start + c)
            elif grid == finest:
                ends[c] = TOO_COARSE if refusals[c] == SOLVED else refusals[c]
