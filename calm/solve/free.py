"""Steady motion of a line that rises after release from its anchor.

The whole line moves at the velocity at which weight, buoyancy and drag balance in the water where
the rise begins. If the current is uniform over depth, the line is vertical and drifts with the
water. Otherwise the line is inclined, and its drift is also unknown.

A part that is pushed down by the line above overtakes that line. The line then doubles back and may
tangle.
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
from calm.solve.solution import Settings, Solution, Status, nodes_of
from calm.solve.two_speeds import runs_compiled


@dataclass(frozen=True)
class FreeMotion:
    """Steady motion of a free line.

    Attributes
    ----------
    velocity : (3,) velocity over the ground: east, north, up [m/s]
    solution : shape and forces in the flow relative to the line, with x and y from the lower end;
        error estimates are NaN
    tangles : indices of the pieces that have partly or wholly overtaken the line above
    """

    velocity: Floats
    solution: Solution
    tangles: tuple[int, ...]


def solve_rise(
    line: Line, water: Water, depth: float, settings: Settings | None = None
) -> FreeMotion:
    """Find the steady motion of a free line, which sinks if its net buoyancy is negative.

    The seabed and the surface are ignored.

    Parameters
    ----------
    depth : depth of the line's upper end [m]

    Returns
    -------
    FreeMotion : at an angle step of 1° (the default), the error of the velocity is at most 1e-4 of
        the vertical speed

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` if no drag limits the speed; ``not-converged`` if no motion passes the
        checks.
    """
    settings = settings or Settings()
    rising = Rising(line, water, runs_compiled(settings, line), depth)
    try:
        place, cuts = terminal(rising, settings.angle_step)
        return _recorded(rising, place, cuts, settings)
    except MarchError as error:
        raise Status.NOT_CONVERGED.because(
            f"The integration along the line stopped: {error}."
        ) from error


def _recorded(rising: Rising, place: FreePlace, cuts: Cuts, settings: Settings) -> FreeMotion:
    """Repeat the march at the motion found, audit the recorded shape and return the motion."""
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
            f"The loads on the moving line do not balance (relative error {closure:.1e})."
        )
    return FreeMotion(place.velocity, replace(solution, closure=closure), _tangles(solution))


def _tangles(solution: Solution) -> tuple[int, ...]:
    """Find looped pieces: pieces partly upside down, and short pieces in compression."""
    line, piece = solution.line, solution.element_piece
    first, last = solution.piece_nodes.T
    pushed = (solution.force[first] + solution.force[last])[:, 2] < 0.0
    rise = np.diff(solution.position[:, 2])
    return looped(line, piece, rise, pushed & (line.length == 0.0))


SHORTEST_LOOP = 2.0
"""Length of the shortest loop that may tangle [m], a default of CALM. A shorter loop is usually a
shackle that touches the float below.
"""


def looped(
    line: Line, piece: Integers, rise: Floats, pushed: Booleans | None = None
) -> tuple[int, ...]:
    """Return the indices of the pieces that form loops in a line.

    Loops with a total height of less than `SHORTEST_LOOP` are ignored.

    Parameters
    ----------
    piece, rise : (k,) piece of every element, and height of the element's second end above its
        first end [m]
    pushed : (n,) whether a piece of zero length is compressed; such a piece belongs to a loop
    """
    up = np.zeros(len(line.length))
    np.add.at(up, piece, np.maximum(rise, 0.0))
    back = up > 0.0 if pushed is None else (up > 0.0) | pushed
    back[: head_count(line)] = False  # the free end has no line above it to overtake
    loops = up[back].sum() >= SHORTEST_LOOP
    return tuple(np.flatnonzero(back).tolist()) if loops else ()


def part_of(line: Line, first: int, stop: int) -> Line:
    """Return the pieces `first` to `stop` − 1 of a line, with their clamps."""
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
