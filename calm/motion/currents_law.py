"""Data types for currents, linearised depths of the line, and the prior of unmeasured speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats


@dataclass(frozen=True)
class ReadCurrents:
    """Currents u to the east and v to the north [m/s] at the depths `level` [m], each (n, k)."""

    level: Floats
    u: Floats
    v: Floats


@dataclass(frozen=True)
class Linear:
    """Linear model of the depths of the points, as functions of factors on the currents."""

    logs: Floats  # (n, g) the state: logarithms of the factors on the currents
    depth: Floats  # (n, p) depths at the state [m]
    slope: Floats  # (n, p, g) derivatives of the depths with respect to the state
    common: Floats  # (n, p, f) derivatives with respect to the logarithms of the common factors

    def moved(self, logs: Floats, depth: Floats) -> Linear:
        """Return the linear model at a new state `logs`, where the depths are `depth`.

        The slopes are updated by Broyden's method.
        """
        step = logs - self.logs
        size = (step**2).sum(axis=1)[:, None]
        miss = depth - self.depth - np.einsum("npg,ng->np", self.slope, step)
        share = np.divide(step, size, out=np.zeros_like(step), where=size > 1e-6)
        slope = self.slope + np.nan_to_num(miss)[:, :, None] * share[:, None, :]
        return Linear(logs, depth, slope, self.common)


@dataclass(frozen=True)
class SpeedLaw:
    """Log-normal prior distribution of the current speeds at k depths (interpolation knots)."""

    mean: Floats  # (k,) mean of the logarithms of the speeds [m/s]
    covariance: Floats  # (k, k) covariance of these logarithms
    # stored models of the line: first at the median speeds, then at the times from which the
    # distribution was learnt; their states are relative to `mean`
    kept: Linear | None = None

    def read(self, level: Floats) -> ReadCurrents:
        """Return eastward currents with the median speeds, at the levels (n, k) [m]."""
        u = np.tile(np.exp(self.mean), (len(level), 1))
        return ReadCurrents(level, u, np.zeros_like(u))
