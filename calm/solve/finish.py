"""From a closed line to a solution that has passed every check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calm.physics.hull import Riding
from calm.physics.line import REFERENCE_DENSITY, Line
from calm.solve import audit
from calm.solve.closing import Closed, Closing
from calm.solve.refine import Refined
from calm.solve.solution import Solution, nodes_of
from calm.solve.status import Status


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
    shares = fine.root.unknown.shares(fine.root.x)
    riding = fine.root.unknown.riding(fine.root.x)
    used, reserve = _buoyancy_in_use(closing, fine)
    solution = Solution(
        line=closing.line,
        water=closing.water,
        settings=closing.settings,
        position=position,
        force=force,
        element_piece=np.array(fine.trace.piece, dtype=np.int64),
        element_clamp=np.array(fine.trace.clamp, dtype=np.int64),
        landed=fine.end.landing is not None,
        hanging=fine.hanging,
        grounded_length=fine.grounded_length,
        cut=np.array(fine.trace.cut),
        strain=np.array(fine.trace.strain),
        afloat=tuple(shares),
        buoyancy_used=used,
        reserve=reserve,
        carried=_carried(closing.line, shares, riding),
        riding=riding,
        marches=closing.marches,
        segments=fine.end.segments,
        miss=fine.miss,
        depth_error=refined.depth_error + abs(fine.miss),
        tension_error=refined.tension_error,
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
    _, density = closing.water.at(np.zeros(1))
    excess = (float(density[0]) - REFERENCE_DENSITY) * closing.water.gravity
    lift = {p: float(closing.line.buoyancy[p] + excess * closing.line.volume[p]) for p in shares}
    total = sum(lift.values())
    used = sum(shares[p] * lift[p] for p in shares)
    return used / total, total - used


def _carried(line: Line, shares: dict[int, float], riding: Riding | None) -> Line:
    """The line as it is loaded: floats at the surface lift and drag by what is in use of them."""
    share, drag = np.ones(len(line.length)), np.ones(len(line.length))
    push = np.zeros((2, len(line.length)))
    for piece, used in shares.items():
        share[piece] = used
        if riding is not None:
            drag[piece], push[:, piece] = riding.drag, riding.push
    return replace(
        line,
        buoyancy=line.buoyancy * share,
        volume=line.volume * share,
        normal_drag=line.normal_drag * drag,
        tangential_drag=line.tangential_drag * drag,
        push_east=push[0],
        push_north=push[1],
    )


def _audited(solution: Solution) -> Solution:
    """The solution with its closure and moment residual; refused where a check fails."""
    solution = replace(
        solution,
        closure=audit.closure(solution),
        moment_residual=audit.moment_residual(solution),
    )
    if not solution.closure <= audit.LARGEST_CLOSURE:
        raise Status.NOT_CONVERGED.because(
            "The loads do not sum to the force at the line's end: they are "
            f"{solution.closure:.1e} off."
        )
    if not solution.moment_residual <= audit.LARGEST_MOMENT:
        raise Status.NOT_CONVERGED.because(
            f"A piece is {solution.moment_residual:.1e} rad out of balance."
        )
    return solution
