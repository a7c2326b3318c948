"""Cases that the lanes leave: solved one by one, as `calm run` does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from calm.batch.kernel.layout import Results
from calm.batch.kernel.outcome import OF_CLAMP, OF_PIECE
from calm.case import Mooring
from calm.case.measure import clamps_of, components_of
from calm.physics.line import Floats, Water


def known_levels(depth: Floats, u: Floats, v: Floats, w: Floats) -> NDArray[np.intp]:
    """Indices of the levels with a value, at or below the surface, from it down."""
    known = np.isfinite(u) & np.isfinite(v) & np.isfinite(w) & np.isfinite(depth) & (depth >= 0.0)
    return np.flatnonzero(known)[np.argsort(depth[known])]


def water_of(base: Water, depth: Floats, u: Floats, v: Floats, w: Floats) -> Water:
    """The water with a profile's current; levels without a value, or above the water, left out.

    Parameters
    ----------
    base : see `Plan`
    depth, u, v, w : (k,) [m], [m/s]
    """
    order = known_levels(depth, u, v, w)
    levels = np.union1d(base.level, depth[order])
    added = [np.interp(levels, depth[order], part[order]) for part in (u, v, w)]
    current, density = base.at(levels)
    u, v, w = (part + current[:, i] for i, part in enumerate(added))
    return replace(base, level=levels, u=u, v=v, w=w, density=density)


def solve_one(mooring: Mooring, water: Water, rows: Results) -> None:
    """Solve the mooring in some water, and write what comes of it to the rows of the case.

    Raises
    ------
    NoEquilibrium
        Where there is none.
    """
    solution = mooring.equilibrium(water)
    pieces, clamps, ends = rows
    components = components_of(mooring.file.pieces[:-1], solution)
    for row, name in zip(pieces, OF_PIECE, strict=True):
        row[:] = getattr(components, name)
    clamped = clamps_of(mooring.file.pieces[:-1], solution)
    for row, name in zip(clamps, OF_CLAMP, strict=True):
        row[:] = getattr(clamped, name)
    east, north, up = solution.force[-1]
    ends[:] = (
        components.depth_top[0],
        up,
        np.hypot(east, north),
        solution.buoyancy_used,
        components.depth_bottom[-1],
    )
