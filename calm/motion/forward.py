"""The depths of a mooring in many currents, with factors on what of it is not known well."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property

import numpy as np

from calm.batch.profiles import Batch, Profiles
from calm.case import Mooring
from calm.physics.line import Floats, Line

FACTORS = ("cable_drag", "rigid_drag", "buoyancy", "length")
"""What may be estimated for the whole record: drag of cables and chains; drag of rigid pieces and
clamped instruments; net force of all that floats; lengths of cables and chains."""


def with_factors(line: Line, factors: Mapping[str, float]) -> Line:
    """A line with factors on its drags, on the net force of its floats, on its lengths."""
    cable, rigid, lift, length = (factors.get(name, 1.0) for name in FACTORS)
    drag = np.where(line.flexible, cable, rigid)
    cut = np.where(line.flexible, length, 1.0)
    return replace(
        line,
        length=line.length * cut,
        clamp_at=line.clamp_at * cut[line.clamp_piece],
        normal_drag=line.normal_drag * drag,
        tangential_drag=line.tangential_drag * drag,
        clamp_drag=line.clamp_drag * rigid,
        lift=line.lift * drag,
        clamp_lift=line.clamp_lift * rigid,
        buoyancy=np.where(line.buoyancy > 0.0, lift, 1.0) * line.buoyancy,
        clamp_buoyancy=np.where(line.clamp_buoyancy > 0.0, lift, 1.0) * line.clamp_buoyancy,
    )


class Forward:
    """A mooring that is asked for its depths in many currents.

    A point is a clamped instrument or the upper end of a component: the clamps down the line come
    first, then the components in the order of the file.
    """

    def __init__(self, mooring: Mooring, factors: Mapping[str, float]) -> None:
        line = with_factors(mooring.line, factors)
        self.mooring = Mooring(mooring.file, line=line, water=mooring.water)
        self._batch = Batch(self.mooring)

    @cached_property
    def still(self) -> Floats:
        """(p,) depths of the points in still water [m]."""
        nothing = np.zeros((1, 1))
        depths: Floats = points(self.solve(nothing, nothing, nothing))[0]
        return depths

    def solve(self, depth: Floats, u: Floats, v: Floats) -> Profiles:
        """The mooring in currents (n, k) at levels (n, k), on one thread."""
        return self._batch.solve(u, v, depth, workers=1)

    def depths(self, depth: Floats, u: Floats, v: Floats) -> Floats:
        """(n, p) depths of the points [m], NaN where there is no equilibrium."""
        return points(self.solve(depth, u, v))


def points(profiles: Profiles) -> Floats:
    """(n, p) depths of all points [m]."""
    return np.hstack([profiles.clamp_depth, profiles.depth_top])
