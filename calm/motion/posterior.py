"""What the pressures make of the currents of each time, by Gauss-Newton steps on the march."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from calm.motion import prior
from calm.motion.common_unknowns import Common
from calm.motion.line_response import LineResponse, ReadCurrents
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats

FURTHEST = 0.7
"""Of a logarithm of a current's factor, at most."""
UNMEASURED = 1e4
"""Of a sensor that measured nothing at a time [m]."""


@dataclass(frozen=True)
class Linear:
    """The depths of the points near a state of the currents.

    Attributes
    ----------
    logs : (n, g) the state
    depth : (n, p) there [m]
    slope : (n, p, g) with the state
    common : (n, p, f) with the logarithms of the common factors
    """

    logs: Floats
    depth: Floats
    slope: Floats
    common: Floats

    def moved(self, logs: Floats, depth: Floats) -> Linear:
        """Return the line at another state, with slopes that lead there from this one (Broyden)."""
        step = logs - self.logs
        size = (step**2).sum(axis=1)[:, None]
        miss = depth - self.depth - np.einsum("npg,ng->np", self.slope, step)
        share = np.divide(step, size, out=np.zeros_like(step), where=size > 1e-6)
        slope = self.slope + np.nan_to_num(miss)[:, :, None] * share[:, None, :]
        return Linear(logs, depth, slope, self.common)


@dataclass(frozen=True)
class Posterior:
    """Hold what the pressures make of the currents.

    Attributes
    ----------
    logs : (n, g) of the factors on the currents
    sea : (n,) what stands over the mean surface [m]
    depth, variance : (n, p) of the points [m], [m²]
    evidence : (n,) logarithm of the density of the pressures
    innovation : (n, s) of the pressures against what is known without them [m]
    expected : (n, s, s) its covariance
    current : (n,) logarithm of the factor on the whole current
    """

    logs: Floats
    sea: Floats
    depth: Floats
    variance: Floats
    evidence: Floats
    innovation: Floats
    expected: Floats
    current: Floats


def posterior(
    one: MooringMeasurements,
    at: Linear,
    spread: Floats,
    common: Common,
    still: Floats,
    spike: int = -1,
) -> Posterior:
    """Return the best state by a linear law, and what is known of all depths then.

    Parameters
    ----------
    spread : (n, g, g) prior covariance of the logarithms
    still : (p,) depths in still water [m]
    spike : a sensor whose pressures are taken for spikes
    """
    n, p, g = at.slope.shape
    s, f = len(one.point), at.common.shape[2]
    # columns of the state: currents, sea, common factors, datum, offsets, moves
    free = g + 1
    q = free + f + 1 + s + s
    state = np.zeros((n, q, q))
    state[:, :g, :g] = spread
    state[:, g, g] = (prior.TIDE if one.tide is None else prior.RESIDUAL_TIDE) ** 2
    state[:, free:, free:] = common.covariance
    slope = np.zeros((n, p, q))
    slope[:, :, :g], slope[:, :, g] = at.slope, 1.0
    slope[:, :, free : free + f], slope[:, :, free + f] = at.common, 1.0
    seen = slope[:, one.point, :].copy()
    seen[:, np.arange(s), free + f + 1 + np.arange(s)] = 1.0
    tide = np.zeros(n) if one.tide is None else one.tide
    lost: Any = ~np.isfinite(at.depth).all(axis=1)  # without current, or without equilibrium
    there = np.where(lost[:, None], still, at.depth)
    fall = common.fall(one.time, there, still, one.point)
    seen[:, np.arange(s), free + f + 1 + s + np.arange(s)] = fall
    base = there + common.datum + tide[:, None]
    base = base - np.einsum("npg,ng->np", at.slope, at.logs)
    known = np.isfinite(one.depth)
    offset = common.offset + fall * common.moved
    innovation = np.where(known, one.depth - base[:, one.point] - offset, 0.0)
    noise = np.where(known, prior.NOISE**2, UNMEASURED**2)
    if spike >= 0:
        noise[:, spike] = np.maximum(noise[:, spike], prior.SPIKE**2)
    down = np.maximum(there - still, 0.0) * prior.WORST
    length = 0.25 * np.ptp(still)
    alike = np.exp(-np.abs(still[:, None] - still[one.point]) / max(length, 1.0))
    bent = down[:, :, None] * alike * down[:, None, one.point]
    spread_of = slope @ state
    turned = seen.transpose(0, 2, 1)
    beside = spread_of @ turned + bent
    expected = seen @ state @ turned + bent[:, one.point, :]
    expected[:, np.arange(s), np.arange(s)] += noise
    inverse = np.linalg.inv(expected)
    solved = (inverse @ innovation[:, :, None])[:, :, 0]
    gain = (state @ (turned @ solved[:, :, None]))[:, :, 0]
    logs = np.clip(gain[:, :g], -FURTHEST, FURTHEST)
    # what the state cannot take up is spread along the line as its own errors are
    depth = base + (beside @ solved[:, :, None])[:, :, 0]
    whole = (spread_of * slope).sum(axis=2) + down**2
    taken = ((beside @ inverse) * beside).sum(axis=2)
    _, size = np.linalg.slogdet(expected)
    misfit = (innovation * solved).sum(axis=1)
    even = np.full(g, 1.0 / max(g, 1))
    depth[lost] = np.nan
    return Posterior(
        logs,
        gain[:, g] + tide,
        depth,
        np.maximum(whole - taken, 0.0),
        np.where(lost, -np.inf, -0.5 * (misfit + size)),
        innovation,
        expected,
        logs @ even,
    )


@dataclass(frozen=True)
class CurrentsState:
    """The currents as measured, at the levels where the line has them.

    Attributes
    ----------
    way : the currents
    begin, before : the line in them as they are, and what the pressures make of it by its slopes
    at, found : the same at the best state
    """

    way: ReadCurrents
    begin: Linear
    before: Posterior
    at: Linear
    found: Posterior


def best_state(moments: LineResponse, common: Common) -> CurrentsState:
    """Hang the currents where the line is, and find the best state."""
    one, still = moments.measured, moments.forward.still
    none = np.zeros((len(one.time), moments.groups))
    there = between(one, np.tile(still, (len(one.time), 1)), still)
    there = moments.depths(moments.way(moments.levels(there), common), none)
    way = moments.way(moments.levels(between(one, there, still)), common)
    there = moments.depths(way, none)
    slope = moments.slopes(way, none, there)
    begin = at = Linear(none, there, slope, moments.common_slopes(way, there))
    before = found = posterior(one, at, way.spread, common, still)
    for _ in range(2):
        at = at.moved(found.logs, moments.depths(way, found.logs))
        found = posterior(one, at, way.spread, common, still)
    return CurrentsState(way, begin, before, at, found)


def between(one: MooringMeasurements, depth: Floats, still: Floats) -> Floats:
    """Return (n, p) depths with what the sensors measure beside them, linear by the height in still
    water.

    Parameters
    ----------
    depth : (n, p) of the points as far as they are known [m]
    still : (p,) in still water
    """
    order = np.argsort(still[one.point], kind="stable")
    result = depth.copy()
    for i, row in enumerate(one.depth):
        known = order[np.isfinite(row[order])]
        if len(known):
            points = one.point[known]
            result[i] += np.interp(still, still[points], row[known] - depth[i, points])
    return result
