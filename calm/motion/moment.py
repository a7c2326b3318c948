"""The state of the line at each time: what the currents say, corrected by what sensors measured.

Every time is estimated for itself. Unknown are the logarithm of a factor on the current of each
group of levels, the height of the sea, and what is common to the record, whose values and
covariance are given. The posterior is found by Gauss-Newton steps on the march; beside the
currents as measured, they are tried with one level or two taken from its neighbours instead, and
each sensor left out, and all are weighed by how well they explain the pressures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.motion import prior
from calm.motion.filled import filled
from calm.motion.forward import Forward
from calm.motion.measured import FREE, Measured
from calm.physics.line import Floats

STEP = 0.05
"""Of the logarithms by which the derivatives are found."""
FURTHEST = 0.7
"""Of a logarithm of a current's factor, at most."""
APART = 1e-6
"""Between levels of instruments that hang in one place [m]."""
UNMEASURED = 1e4
"""Of a sensor that measured nothing at a time [m]."""


@dataclass(frozen=True)
class Common:
    """What is common to the whole record, as far as it is known.

    The q columns of the covariance are the logarithms of the factors, the datum [m], the offsets
    of the sensors [m].

    Attributes
    ----------
    factors : names of the estimated factors and their values
    datum : what is added to the depths of the line [m]
    offset : (s,) of the sensors [m]
    covariance : (q, q)
    scale : of the errors of the currents, on those of `calm.motion.prior`
    gap : (g, g) error of the logarithm of the factor on a group of levels whose currents are taken
        from the others, another group left out besides; see `calm.motion.filled.gap_errors`
    """

    factors: Mapping[str, float]
    datum: float
    offset: Floats
    covariance: Floats
    scale: float
    gap: Floats


@dataclass(frozen=True)
class Way:
    """One way to read the currents of some times, and where it puts the line.

    Attributes
    ----------
    level : (n, k) depths of the levels [m]
    u, v : (n, k) [m/s]
    spread : (n, g, g) prior covariance of the logarithms
    """

    level: Floats
    u: Floats
    v: Floats
    spread: Floats


class Moments:
    """The times of a block, with a mooring to ask."""

    def __init__(
        self, measured: Measured, forward: Forward, shifted: Mapping[str, Forward]
    ) -> None:
        self.measured, self.forward, self.shifted = measured, forward, shifted
        self.group = measured.group
        self.groups = int(self.group.max()) + 1 if len(self.group) else 0

    # --- currents

    def levels(self, depths: Floats) -> Floats:
        """(n, k) depths of the levels, of those that hang by the depths of the points.

        A current whose sensor is used hangs where that was measured.
        """
        one = self.measured
        level = one.level_depth.copy()
        for k, (point, sensor) in enumerate(zip(one.level_point, one.level_sensor, strict=True)):
            if point == FREE:
                continue
            level[:, k] = depths[:, point]
            if sensor != FREE:
                known = np.isfinite(one.depth[:, sensor])
                level[known, k] = one.depth[known, sensor]
        apart: Floats = np.maximum(level, 0.0) + APART * np.arange(level.shape[1])
        return apart

    def read(
        self, level: Floats, without: tuple[int, ...] = ()
    ) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """(n, k) u and v [m/s] at these levels, and whether each was measured.

        Parameters
        ----------
        without : groups that are taken from the others, as is what was not measured
        """
        one = self.measured
        known = np.isfinite(one.u) & np.isfinite(one.v) & np.isfinite(level)
        known &= ~np.isin(self.group, without)
        return filled(level, one.u, known), filled(level, one.v, known), known

    def way(self, level: Floats, common: Common, without: tuple[int, ...] = ()) -> Way:
        """The currents at these levels with their errors; some groups taken from the others."""
        u, v, known = self.read(level, without)
        speed = np.maximum(np.hypot(u, v), 1e-3)
        own = np.hypot(prior.by_flag(prior.LEVEL, self.measured.flag), prior.STEADY / speed)
        gap = common.gap[:, [*without]].max(axis=1) if without else np.diag(common.gap)
        own = np.minimum(np.where(known, own, gap[self.group]), prior.LARGEST)
        spread = np.zeros((len(u), self.groups, self.groups))
        place = np.linspace(-1.0, 1.0, self.groups) if self.groups > 1 else np.zeros(1)
        spread += prior.CURRENT**2 + prior.SHEAR**2 * np.outer(place, place)
        for g in range(self.groups):
            mine = own[:, self.group == g]
            spread[:, g, g] += (mine**2).mean(axis=1)
        return Way(level, u, v, common.scale**2 * spread)

    def depths(self, way: Way, logs: Floats, forward: Forward | None = None) -> Floats:
        """(n, p) depths of the points with factors on the currents."""
        factor = np.exp(logs[:, self.group])
        return (forward or self.forward).depths(way.level, way.u * factor, way.v * factor)

    def slopes(self, way: Way, logs: Floats, there: Floats) -> Floats:
        """(n, p, g) change of the depths with the logarithm of each group's factor [m]."""
        columns = np.zeros((*there.shape, self.groups))
        for g in range(self.groups):
            ahead = logs.copy()
            ahead[:, g] += STEP
            columns[:, :, g] = (self.depths(way, ahead) - there) / STEP
        return np.nan_to_num(columns)

    def common_slopes(self, way: Way, there: Floats) -> Floats:
        """(n, p, f) change of the depths with the logarithm of each common factor [m]."""
        none = np.zeros((len(there), self.groups))
        columns = [
            (self.depths(way, none, forward) - there) / STEP for forward in self.shifted.values()
        ]
        return np.nan_to_num(np.stack(columns, -1)) if columns else np.zeros((*there.shape, 0))


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
        """At another state, the slopes such that they lead from the one to the other (Broyden)."""
        step = logs - self.logs
        size = (step**2).sum(axis=1)[:, None]
        miss = depth - self.depth - np.einsum("npg,ng->np", self.slope, step)
        share = np.divide(step, size, out=np.zeros_like(step), where=size > 1e-6)
        slope = self.slope + np.nan_to_num(miss)[:, :, None] * share[:, None, :]
        return Linear(logs, depth, slope, self.common)


@dataclass(frozen=True)
class Posterior:
    """What the pressures make of the currents.

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
    one: Measured, at: Linear, spread: Floats, common: Common, still: Floats, spike: int = -1
) -> Posterior:
    """The best state by a linear law, and what is known of all depths then.

    Parameters
    ----------
    spread : (n, g, g) prior covariance of the logarithms
    still : (p,) depths in still water [m]
    spike : a sensor whose pressures are taken for spikes
    """
    n, p, g = at.slope.shape
    s, f = len(one.point), at.common.shape[2]
    # columns of the state: currents, sea, common factors, datum, offsets
    free = g + 1
    q = free + f + 1 + s
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
    base = there + common.datum + tide[:, None]
    base = base - np.einsum("npg,ng->np", at.slope, at.logs)
    known = np.isfinite(one.depth)
    innovation = np.where(known, one.depth - base[:, one.point] - common.offset, 0.0)
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
class Settled:
    """The currents as measured, at the levels where the line has them.

    Attributes
    ----------
    way : the currents
    begin, before : the line in them as they are, and what the pressures make of it by its slopes
    at, found : the same at the best state
    """

    way: Way
    begin: Linear
    before: Posterior
    at: Linear
    found: Posterior


def settled(moments: Moments, common: Common) -> Settled:
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
    return Settled(way, begin, before, at, found)


def between(one: Measured, depth: Floats, still: Floats) -> Floats:
    """(n, p) depths with what the sensors measure beside them, linear by the height in still water.

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
