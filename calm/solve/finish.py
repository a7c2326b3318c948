"""From a closed line to a solution that has passed every check."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from calm.physics.line import Floats, Line
from calm.physics.track import Load
from calm.solve.audit import LARGEST_CLOSURE, LARGEST_MOMENT, Audit
from calm.solve.closing import Closed, Closing
from calm.solve.refine import Refined
from calm.solve.solution import Solution, nodes_of, sizes
from calm.solve.standing import surface_lift
from calm.solve.status import Status

UNSEEN = 1e-9
"""Error, as a share of the span and of the greatest force, that both step sizes may have alike:
of rounding, of a share of buoyancy, of a node that should be at a level and is just beside it."""

_OF_CLAMP = {
    "clamp_buoyancy": "buoyancy",
    "clamp_volume": "volume",
    "clamp_drag": "normal_drag",
    "clamp_lift": "lift",
}
_OF_PIECE = {
    name: name
    for name in (
        "buoyancy",
        "volume",
        "normal_drag",
        "tangential_drag",
        "lift",
        "push_east",
        "push_north",
    )
}
"""Columns of a line and what of a load of the march stands there."""


def finished(
    closing: Closing,
    refined: Refined,
    other_depth: float | None,
    check: Callable[[Solution], None],
) -> Solution:
    """The solution of a closed line.

    Parameters
    ----------
    other_depth : as in `Solution`
    check : refuses a shape that cannot be where it is

    Raises
    ------
    NoEquilibrium
        Where a check fails, that of the place or one of the audit.
    """
    fine = refined.closed
    position, force = nodes_of(fine.trace)
    unknown = fine.root.unknown
    changed = unknown.placed(fine.root.x, closing.water.gravity).afloat.values()
    used, reserve = _buoyancy_in_use(closing, fine)
    afloat = tuple(unknown.shares(fine.root.x))
    unclosed = abs(fine.miss) / closing.span + UNSEEN
    unseen = _greatest_force(closing, fine, force) * unclosed
    solution = Solution(
        line=closing.line,
        water=closing.water,
        settings=closing.settings,
        position=position,
        force=force,
        element_piece=fine.trace.piece,
        element_clamp=fine.trace.clamp,
        landed=fine.end.landed,
        hanging=fine.hanging,
        grounded_length=fine.grounded_length,
        cut=fine.trace.cut,
        strain=fine.trace.strain,
        afloat=afloat,
        buoyancy_used=used,
        reserve=reserve,
        carried=_carried(closing.line, changed) if afloat else closing.line,
        riding=unknown.riding(fine.root.x),
        marches=closing.marches,
        segments=len(fine.end.cuts.lengths),
        miss=fine.miss,
        depth_error=refined.depth_error + closing.span * unclosed,
        tension_error=refined.tension_error + unseen,
        lift_error=refined.lift_error + unseen,
        pull_error=refined.pull_error + unseen,
        other_depth=other_depth,
        frequency=closing.frequency,
    )
    check(solution)
    return _audited(solution)


def _buoyancy_in_use(closing: Closing, fine: Closed) -> tuple[float, float]:
    """Share in use of the buoyancy of the floats at the surface, and the rest of it [N]."""
    shares = fine.root.unknown.shares(fine.root.x)
    if not shares:
        return 1.0, 0.0
    lift = surface_lift(closing.line, closing.water)
    total = float(sum(lift[p] for p in shares))
    used = float(sum(shares[p] * lift[p] for p in shares))
    return used / total, total - used


def _greatest_force(closing: Closing, fine: Closed, force: Floats) -> float:
    """The greatest tension, or buoyancy of a float whose share in use is sought [N]."""
    lift = closing.line.buoyancy[list(fine.root.unknown.shares(fine.root.x))]
    return max(float(sizes(force).max()), float(lift.max(initial=0.0)))


def _carried(line: Line, changed: Iterable[Load]) -> Line:
    """The line as it is loaded: what is at the surface by what is in the water and in use of it."""
    columns = {name: getattr(line, name).copy() for name in (*_OF_PIECE, *_OF_CLAMP)}
    for load in changed:
        where, names = (load.piece, _OF_PIECE) if load.clamp < 0 else (load.clamp, _OF_CLAMP)
        for column, name in names.items():
            columns[column][where] = getattr(load, name)
    return replace(line, **columns)


def _audited(solution: Solution) -> Solution:
    """The solution with its closure and moment residual; refused where a check fails."""
    audit = Audit(solution)
    closure, moment_residual = audit.closure(), audit.moment_residual()
    solution = replace(solution, closure=closure, moment_residual=moment_residual)
    if not closure <= LARGEST_CLOSURE:
        raise Status.NOT_CONVERGED.because(
            f"The loads do not sum to the force at the line's end: they are {closure:.1e} off."
        )
    if not moment_residual <= LARGEST_MOMENT:
        raise Status.NOT_CONVERGED.because(f"A piece is {moment_residual:.1e} rad out of balance.")
    return solution
