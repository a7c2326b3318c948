"""What is common to a whole record: factors on the line, the datum, and where its sensors hang."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats, Integers

REACH = 5.0
"""Between a sensor and the points by which the slope of the line at it is known, at least [m]."""


@dataclass(frozen=True)
class Common:
    """What is common to the whole record, as far as it is known.

    The q columns of the covariance are the logarithms of the factors, the datum [m], the offsets
    of the sensors [m], and how far down the line they have moved [m].

    Attributes
    ----------
    factors : names of the estimated factors and their values
    datum : what is added to the depths of the line [m]
    offset : (s,) of the sensors [m]
    moved : (s,) how far below its place in the file a sensor hangs, along the line at rest [m]
    since : (s,) the first time at which it does; NaT where it never does
    elsewhere : (s,) probability that it does
    covariance : (q, q)
    scale : of the errors of the currents, on those of `calm.motion.prior`
    gap : (g, g) error of the logarithm of the factor on a group of levels whose currents are taken
        from the others, another group left out besides; see `calm.motion.filled.gap_errors`
    """

    factors: Mapping[str, float]
    datum: float
    offset: Floats
    moved: Floats
    since: NDArray[np.datetime64]
    elsewhere: Floats
    covariance: Floats
    scale: float
    gap: Floats

    @property
    def value(self) -> Floats:
        """(q,) as the columns of the covariance stand."""
        logs = np.log(list(self.factors.values()))
        return np.concatenate([logs, [self.datum], self.offset, self.moved])

    def fall(
        self, time: NDArray[np.datetime64], depth: Floats, still: Floats, point: Integers
    ) -> Floats:
        """(n, s) change of the depth of each sensor with how far it has moved; 0 before it has.

        Parameters
        ----------
        time : (n,)
        depth, still : (n, p), (p,) of the points, at these times and in still water [m]
        point : (s,) where the sensors are by the file
        """
        result = np.zeros((len(time), len(point)))
        for j, (one, since) in enumerate(zip(point.tolist(), self.since, strict=True)):
            if np.isnat(since):
                continue
            below = still - still[one]
            upper = int(np.where(below <= -REACH, below, -np.inf).argmax())
            lower = int(np.where(below >= REACH, below, np.inf).argmin())
            upper = upper if below[upper] <= -REACH else one
            lower = lower if below[lower] >= REACH else one
            apart = still[lower] - still[upper]
            share = (depth[:, lower] - depth[:, upper]) / apart if apart > 0.0 else 1.0
            result[:, j] = np.where(time >= since, share, 0.0)
        return result
