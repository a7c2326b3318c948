"""The environment of a mooring file as one table of levels."""

from __future__ import annotations

import numpy as np

from calm.files import DensityTable, Environment
from calm.files.definition import STANDARD_GRAVITY
from calm.physics.line import Water


def assemble_water(environment: Environment) -> Water:
    """Current and density on the union of their levels; both are linear between levels."""
    current, density = environment.current, environment.density
    levels = np.array(current.depth, dtype=np.float64) if current else np.zeros(1)
    if isinstance(density, DensityTable):
        levels = np.union1d(levels, density.depth)
        densities = np.interp(levels, density.depth, density.density)
    else:
        densities = np.full(len(levels), density)
    if current:
        u, v, w = (np.interp(levels, current.depth, c) for c in (current.u, current.v, current.w))
    else:
        u = v = w = np.zeros(len(levels))
    return Water(
        depth=environment.depth,
        level=levels,
        u=u,
        v=v,
        w=w,
        density=densities,
        gravity=STANDARD_GRAVITY if environment.gravity is None else environment.gravity,
    )
