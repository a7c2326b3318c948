"""Estimate of unmeasured currents from pressures, independently at each time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats


@dataclass(frozen=True)
class Posterior:
    """Posterior of the currents, given the pressures."""

    logs: Floats  # (n, g) logarithms of the factors on the currents, relative to the prior mean
    sea: Floats  # (n,) height of the sea surface above its mean [m]
    depth: Floats  # (n, p) depths of the points [m] and their variances [m²]
    variance: Floats
    evidence: Floats  # (n,) log probability density of the measured depths
    innovation: Floats  # (n, s) measured minus predicted depths [m], and covariance (n, s, s)
    expected: Floats


def posterior(
    one: MooringMeasurements, at: Linear, spread: Floats, common: Common, still: Floats
) -> Posterior:
    """Return the posterior of currents and depths, linearised at a state of the currents.

    The factors on the currents have the prior covariance `spread` (g, g) of their logarithms;
    `still` are the depths (p,) in still water [m].
    """
    n, p, g = at.slope.shape
    s, f = len(one.point), at.common.shape[2]
    # columns of the state: currents, sea, common factors, datum, offsets
    free = g + 1
    q = free + f + 1 + s
    state = np.zeros((n, q, q))
    state[:, :g, :g] = spread
    state[:, g, g] = one.tide_deviation**2
    state[:, free:, free:] = common.covariance
    slope = np.zeros((n, p, q))
    slope[:, :, :g], slope[:, :, g] = at.slope, 1.0
    slope[:, :, free : free + f], slope[:, :, free + f] = at.common, 1.0
    seen = slope[:, one.point, :].copy()
    seen[:, np.arange(s), free + f + 1 + np.arange(s)] = 1.0
    surface = one.surface
    lost: Any = ~np.isfinite(at.depth).all(axis=1)  # no current or no equilibrium
    there = np.where(lost[:, None], still, at.depth)
    base = there + common.datum + surface[:, None]
    base = base - np.einsum("npg,ng->np", at.slope, at.logs)
    known = np.isfinite(one.depth)
    innovation = np.where(known, one.depth - base[:, one.point] - common.offset, 0.0)
    noise = np.where(known, common_unknowns.NOISE**2, line_response.UNMEASURED**2)
    own = common.worst**2 * line_response.own_errors(at.depth, still, common.inferred)
    bent = own[:, :, one.point]
    spread_of = slope @ state
    turned = seen.transpose(0, 2, 1)
    beside = spread_of @ turned + bent
    expected = seen @ state @ turned + bent[:, one.point, :]
    expected[:, np.arange(s), np.arange(s)] += noise
    inverse = np.linalg.inv(expected)
    solved = (inverse @ innovation[:, :, None])[:, :, 0]
    gain = (state @ (turned @ solved[:, :, None]))[:, :, 0]
    # residuals that the state cannot explain are spread along the line like its own errors
    depth = base + (beside @ solved[:, :, None])[:, :, 0]
    whole = (spread_of * slope).sum(axis=2) + np.einsum("npp->np", own)
    taken = ((beside @ inverse) * beside).sum(axis=2)
    _, size = np.linalg.slogdet(expected)
    misfit = (innovation * solved).sum(axis=1)
    depth[lost] = np.nan
    return Posterior(
        gain[:, :g],
        gain[:, g] + surface,
        depth,
        np.maximum(whole - taken, 0.0),
        np.where(lost, -np.inf, -0.5 * (misfit + size)),
        innovation,
        expected,
    )


@dataclass(frozen=True)
class CurrentsState:
    """Currents at several times, with the linearised line and the posterior at these currents."""

    read: ReadCurrents
    at: Linear
    found: Posterior
