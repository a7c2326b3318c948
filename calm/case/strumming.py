"""Strumming of cables: frequency and drag in a solution, and results with strumming drag."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calm.case.leg import Leg
from calm.errors import NoEquilibrium
from calm.files import Solver
from calm.physics.drag import line_drag
from calm.physics.strumming import shedding_frequency
from calm.solve import Solution, Status
from calm.solve.audit import amplification, flow_across


@dataclass(frozen=True)
class Strumming:
    """Strumming of the cables: frequency [Hz], and range of the normal drag coefficient Cn.

    All segments of a towed cable strum at one frequency. The `frequency` of a mooring is the
    highest shedding frequency of the cables.
    """

    frequency: float
    cn_min: float
    cn_max: float


def strumming_of(solver: Solver, solution: Solution) -> Strumming | None:
    """Return the frequency and the range of Cn over the cables.

    Return None if no strumming law is set or the line has no cable.
    """
    line, piece = solution.line, solution.element_piece
    cables = (line.diameter[piece] > 0.0) & (solution.element_clamp < 0) & (solution.cut > 0.0)
    if solver.strumming is None or not cables.any():
        return None
    diameter = line.diameter[piece[cables]]
    unit, _ = line_drag(1.0, 1.0, 0.0)
    cn = line.normal_drag[piece[cables]] / (unit * diameter) * amplification(solution)[cables]
    frequency = solution.frequency
    if not frequency:
        speeds = flow_across(solution)[cables].tolist()
        frequency = max(map(shedding_frequency, speeds, diameter.tolist()))
    return Strumming(frequency, float(cn.min()), float(cn.max()))


FACTOR = 1.5
"""Factor on the normal drag coefficient of every cable, about the value measured on strumming
mooring lines.
"""


@dataclass(frozen=True)
class StrummingBand:
    """Results for the line with the drag coefficient Cn of all cables multiplied by a factor.

    Without an equilibrium, depth, knockdown and tension are None.

    Attributes
    ----------
    factor : factor on Cn [-]
    depth : depth of the top of a mooring, or of a towed body [m]
    knockdown : knockdown of the top [m]; None for a tow, or if the shape in still water is not
        unique
    tension : tension at the anchor or the ship [N]
    """

    factor: float
    status: str
    depth: float | None = None
    knockdown: float | None = None
    tension: float | None = None


def band_of(leg: Leg, still_depth: float | None = None) -> StrummingBand | None:
    """Solve a line with increased drag on its cables.

    The depth of the top in still water is `still_depth` [m]. Return None if no cable can strum, or
    if the file sets a strumming law.
    """
    line, cables = leg.line, leg.line.diameter > 0.0
    if leg.file.solver.strumming is not None or not (line.normal_drag[cables] > 0.0).any():
        return None
    try:
        raised = np.where(cables, FACTOR, 1.0) * line.normal_drag
        solution = leg.solved(replace(line, normal_drag=raised))
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
