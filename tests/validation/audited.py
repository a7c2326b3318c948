"""The audit of a solution, of its coordinates as they stand."""

from __future__ import annotations

import numpy as np

from calm.physics.line import Bed
from calm.physics.referee import worst_moment
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Solution
from calm.solve.audit import loads_of, moored_of, shape_of
from calm.solve.search import closure


def closure_of(solution: Solution) -> float:
    """Relative departure of the sum of the loads from the force at the line's end."""
    excess, water = 0.0, solution.water
    if solution.landed:
        density = water.density_at(np.array(water.depth))
        excess = (float(density) - REFERENCE_DENSITY) * water.gravity
    bed = Bed(water.deeper_east, water.deeper_north, solution.settings.seabed_friction, excess)
    return closure(
        _moored(solution), shape_of(solution), loads_of(solution).T.tolist(), solution.landed,
        bed,
    )  # fmt: skip


def moment_of(solution: Solution) -> float:
    """Largest angle between an element's axis and the mean of the forces at its ends [rad]."""
    loads = loads_of(solution).T.tolist()
    return worst_moment(_moored(solution), shape_of(solution), loads)


def _moored(solution: Solution):
    return moored_of(solution.carried, solution.water, solution.frequency, False)
