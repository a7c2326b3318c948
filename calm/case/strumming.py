"""What a solution gives for the strumming of its cables."""

from __future__ import annotations

from calm.case.result import Strumming
from calm.files import Solver
from calm.physics.drag import line_drag
from calm.physics.strumming import shedding_frequency
from calm.solve import Solution
from calm.solve.audit import amplification, flow_across


def strumming_of(solver: Solver, solution: Solution) -> Strumming | None:
    """Frequency and range of Cn over the cables; None where none strums or is asked to."""
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
