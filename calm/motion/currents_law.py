"""Interpreted currents, nearby depths of the line, and the prior law of unmeasured speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats


@dataclass(frozen=True)
class ReadCurrents:
    """One interpretation of the currents at several times, and the resulting depths of the line.

    Attributes
    ----------
    level : (n, k) depths of the levels [m]
    u, v : (n, k) [m/s]
    """

    level: Floats
    u: Floats
    v: Floats


@dataclass(frozen=True)
class Linear:
    """Linearised depths of the points near a state of the currents.

    Attributes
    ----------
    logs : (n, g) logarithms at the state
    depth : (n, p) depths at the state [m]
    slope : (n, p, g) derivatives of the depths by the state
    common : (n, p, f) derivatives of the depths by the logarithms of the common factors
    """

    logs: Floats
    depth: Floats
    slope: Floats
    common: Floats

    def moved(self, logs: Floats, depth: Floats) -> Linear:
        """Return the line at another state, with slopes updated by Broyden's method."""
        step = logs - self.logs
        size = (step**2).sum(axis=1)[:, None]
        miss = depth - self.depth - np.einsum("npg,ng->np", self.slope, step)
        share = np.divide(step, size, out=np.zeros_like(step), where=size > 1e-6)
        slope = self.slope + np.nan_to_num(miss)[:, :, None] * share[:, None, :]
        return Linear(logs, depth, slope, self.common)


@dataclass(frozen=True)
class SpeedLaw:
    """Prior law of the current speeds, and the times from which it was learnt.

    Attributes
    ----------
    mean, covariance : (k,), (k, k) of the logarithms of the speeds [m/s]
    kept : fits of the learning times, the first at the mean; states are relative to the mean
    """

    mean: Floats
    covariance: Floats
    kept: Linear | None = None

    def read(self, level: Floats) -> ReadCurrents:
        """Return currents at levels (n, k) [m], with the same direction at all levels."""
        u = np.tile(np.exp(self.mean), (len(level), 1))
        return ReadCurrents(level, u, np.zeros_like(u))
