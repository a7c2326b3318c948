"""Terminal motion of a line that rises without its anchor.

All of the line moves alike, at the velocity at which weight, buoyancy and drag cancel. It is taken
to have reached that velocity in the water where the rise begins.

In still water, and in a current that is the same at all depths, the line drifts with the water and
is plumb; only its vertical speed is unknown. Where the horizontal current changes with depth the
drift is unknown too, and the line leans. It is then sought from the plumb line's motion, if need be
by way of weaker shear.

Where the force above a part points downward, that part overtakes what is above it and the line
doubles back: the balance holds there as elsewhere, but the line may tangle.
"""

from dataclasses import dataclass, fields, replace
from itertools import compress
from math import nan
from typing import Any

import numpy as np

from calm.physics.line import Booleans, Floats, Integers, Line, MarchError, Water
from calm.physics.march import Cuts
from calm.physics.track import head_count
from calm.solve.audit import loads_of
from calm.solve.free_march import Rising
from calm.solve.free_search import FreePlace, terminal
from calm.solve.search import LARGEST_CLOSURE
from calm.solve.solution import Settings, Solution, Status, nodes_of, runs_compiled


@dataclass(frozen=True)
class FreeMotion:
    """A line that moves steadily.

    Attributes
    ----------
    velocity : (3,) over the ground, to the east, to the north, upward [m/s]
    solution : its shape and forces in the water as it flows past the line; x and y from the lower
        end. Its errors are not estimated, nan, and its marches not counted, 0.
    tangles : the pieces that have, or part of which has, overtaken what was above
    """

    velocity: Floats
    solution: Solution
    tangles: tuple[int, ...]


def solve_rise(
    line: Line, water: Water, depth: float, settings: Settings | None = None
) -> FreeMotion:
    """The motion of a line that nothing holds; one that is too heavy sinks.

    Parameters
    ----------
    line, water : see `calm.physics.line`; the seabed stops nothing. Parts above the surface are
        treated as submerged
    depth : of the line's upper end [m]
    settings : angle step; 1° by default

    Returns
    -------
    FreeMotion : at 1° its velocity is within 1e-4 of the vertical speed of the continuous line's

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` where no drag limits the speed, ``not-converged`` where no motion passes
        the checks.
    """
    settings = settings or Settings()
    rising = Rising(line, water, runs_compiled(settings, line), depth)
    try:
        place, cuts = terminal(rising, settings.angle_step)
        return _recorded(rising, place, cuts, settings)
    except MarchError as error:
        raise Status.NOT_CONVERGED.because(f"The march stopped: {error}.") from error


def _recorded(rising: Rising, place: FreePlace, cuts: Cuts, settings: Settings) -> FreeMotion:
    """The motion at a place, marched once more, audited."""
    flow = rising.flow(place.velocity)
    meeting = rising.meet(flow, place.depth, settings.angle_step, cuts, record=True)
    trace = meeting.trace
    assert trace is not None
    position, force = nodes_of(trace)
    solution = Solution(
        line=rising.line,
        water=flow,
        settings=settings,
        position=position,
        force=force,
        element_piece=trace.piece,
        element_clamp=trace.clamp,
        landed=False,
        hanging=len(trace.piece),
        grounded_length=0.0,
        cut=trace.cut,
        strain=trace.strain,
        afloat=(),
        buoyancy_used=1.0,
        reserve=0.0,
        carried=rising.line,
        marches=0,
        segments=len(meeting.cuts.lengths),
        miss=meeting.gap,
        depth_error=nan,
        tension_error=nan,
        lift_error=nan,
        pull_error=nan,
    )
    closure = float(np.linalg.norm(loads_of(solution).sum(axis=0))) / rising.weight
    if not closure <= LARGEST_CLOSURE:
        raise Status.NOT_CONVERGED.because(
            f"The loads on the moving line do not cancel: they are {closure:.1e} off."
        )
    return FreeMotion(place.velocity, replace(solution, closure=closure), _tangles(solution))


def _tangles(solution: Solution) -> tuple[int, ...]:
    """The pieces with a part whose lower end is up; without length, on which the line pushes."""
    line, piece = solution.line, solution.element_piece
    first, last = solution.piece_nodes.T
    pushed = (solution.force[first] + solution.force[last])[:, 2] < 0.0
    rise = np.diff(solution.position[:, 2])
    return looped(line, piece, rise, pushed & (line.length == 0.0))


SHORTEST_LOOP = 2.0
"""Way up of a line that doubles back from which it may tangle [m]: less is a shackle that leans on
the float below it."""


def looped(
    line: Line, piece: Integers, rise: Floats, pushed: Booleans | None = None
) -> tuple[int, ...]:
    """The pieces of a line that doubles back, from `SHORTEST_LOOP` on, down the line.

    Parameters
    ----------
    piece, rise : (k,) piece of every element, and its lower end above its upper one [m]
    pushed : (n,) pieces without length that are pushed at; they belong to a loop
    """
    up = np.zeros(len(line.length))
    np.add.at(up, piece, np.maximum(rise, 0.0))
    back = up > 0.0 if pushed is None else (up > 0.0) | pushed
    back[: head_count(line)] = False  # nothing is ahead of the free end
    loops = up[back].sum() >= SHORTEST_LOOP
    return tuple(np.flatnonzero(back).tolist()) if loops else ()


def part_of(line: Line, first: int, stop: int) -> Line:
    """The pieces from `first` up to, not including, `stop`, with their clamps."""
    index = np.arange(len(line.length))
    pieces = (first <= index) & (index < stop)
    clamps = pieces[line.clamp_piece]
    columns: dict[str, Any] = {}
    for field in fields(line):
        column, kept = getattr(line, field.name), pieces
        if field.name.startswith("clamp_"):
            kept = clamps
        if isinstance(column, np.ndarray):
            columns[field.name] = column[kept]
        elif isinstance(column, tuple):
            columns[field.name] = tuple(compress(column, kept))
    columns["clamp_piece"] = columns["clamp_piece"] - first
    return replace(line, **columns)
