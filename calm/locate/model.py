"""Ranges as they should be from a place, and how they change with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.locate.ranges import Survey
from calm.locate.sound import Sound
from calm.physics.ellipsoid import Frame
from calm.physics.line import Floats


@dataclass(frozen=True)
class Model:
    """Ranges from a place: the unknowns are east, north and, where it is not given, the depth."""

    survey: Survey
    sound: Sound
    frame: Frame
    ships: Floats
    depth: float | None

    @property
    def unknowns(self) -> int:
        return 2 if self.depth is not None else 3

    def place(self, x: Floats) -> Floats:
        """(3,) of the unknowns; a given depth is one below the curved surface."""
        if self.depth is None:
            return x
        # the surface is that much below the plane of the frame
        sagging = self.frame.position(np.array([x[0], x[1], 0.0]))[2]
        return np.array([x[0], x[1], sagging - self.depth])

    def mean_speed(self, x: Floats) -> float:
        below = self.frame.position(self.place(x))[2]
        return self.sound.mean(self.survey.transducer, max(below, self.survey.transducer))

    def measured(self, x: Floats) -> Floats:
        """(n,) ranges [m], of times by the speed of sound on the way to the place."""
        if not self.survey.timed:
            return self.survey.measured
        ranges: Floats = 0.5 * self.survey.measured * self.mean_speed(x)
        return ranges

    def residuals(self, x: Floats) -> Floats:
        computed: Floats = np.linalg.norm(self.ships - self.place(x), axis=1)
        found: Floats = self.measured(x) - computed
        return found

    def jacobian(self, x: Floats) -> Floats:
        """(n, unknowns) of the residuals."""
        step = 0.01
        columns = []
        for i in range(self.unknowns):
            ahead, behind = x.copy(), x.copy()
            ahead[i] += step
            behind[i] -= step
            columns.append((self.residuals(ahead) - self.residuals(behind)) / (2.0 * step))
        return np.stack(columns, axis=1)
