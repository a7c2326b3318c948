"""What strumming could do at worst: a result solved again with more drag on its cables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from calm.errors import NoEquilibrium
from calm.solve import Solution, Status, solve_mooring, solve_tow

if TYPE_CHECKING:
    from calm.case.mooring import Mooring
    from calm.case.tow import Tow
    from calm.physics.line import Line

FACTOR = 1.5
"""Factor on the Cn of every cable: about what is measured on mooring lines that strum."""


@dataclass(frozen=True)
class StrummingBand:
    """The same line with Cn × `factor` on all its cables, None where that has no equilibrium.

    Attributes
    ----------
    factor : [-]
    status : of that line
    depth : of the top of a mooring, or of a towed body [m]
    knockdown : of the top of a mooring, where still water has a shape of its own [m]
    tension : on the anchor or the ship [N]
    """

    factor: float
    status: str
    depth: float | None = None
    knockdown: float | None = None
    tension: float | None = None


def mooring_band(mooring: Mooring, still_depth: float | None) -> StrummingBand | None:
    """The band of a mooring that is `still_depth` deep in still water [m].

    None where nothing can strum or a law of strumming is already in use.
    """
    return _band(
        mooring,
        lambda line: solve_mooring(line, mooring.water, mooring.settings),
        still_depth,
    )


def tow_band(tow: Tow) -> StrummingBand | None:
    """The band of a tow; None as for `mooring_band`."""
    return _band(tow, lambda line: solve_tow(line, tow.water, tow.towing, tow.settings))


def _band(
    case: Mooring | Tow, solve: Callable[[Line], Solution], still_depth: float | None = None
) -> StrummingBand | None:
    line = _strumming(case.line)
    if line is None or case.file.solver.strumming is not None:
        return None
    try:
        solution = solve(line)
    except NoEquilibrium as failure:
        return StrummingBand(FACTOR, failure.status)
    node = solution.body_node if solution.line.towed else 0
    depth = -float(solution.position[node, 2])
    return StrummingBand(
        FACTOR,
        Status.CONVERGED.label,
        depth,
        None if still_depth is None else depth - still_depth,
        float(solution.tension[-1]),
    )


def _strumming(line: Line) -> Line | None:
    cables = line.diameter > 0.0
    if not (line.normal_drag[cables] > 0.0).any():
        return None
    return replace(line, normal_drag=np.where(cables, FACTOR, 1.0) * line.normal_drag)
