"""Estimate of unmeasured currents from pressures, independently at each time.

The line is linearised about a state of the currents. Any single reading may be a spike.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.line_response import LineResponse
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats

NEGLIGIBLE = 0.02
"""Weight of a spike relative to a good reading, below which the spike is not considered."""


@dataclass(frozen=True)
class Estimate:
    """Estimated depths of the line at n times.

    Attributes
    ----------
    depth, deviation : (n, p) depths of the points and their standard deviations [m]
    sea : (n,) height of the sea surface above its mean [m]
    likely : the most likely currents
    """

    depth: Floats
    deviation: Floats
    sea: Floats
    likely: ReadCurrents


def estimated(
    moments: LineResponse,
    common: Common,
    known: CurrentsState,
    neighbours: tuple[Floats, Floats] | None = None,
) -> Estimate:
    """Average the posterior depths over the cases of no spike and of a spike in each sensor.

    Parameters
    ----------
    moments, common : line response at n times, and the common unknowns
    known : the best state of the currents
    neighbours : result of `calm.motion.measurements.by_neighbours`; None to treat the times as
        isolated
    """
    one, still, law = moments.measured, moments.forward.still, common.law
    assert law is not None
    first, at = known.found, known.at
    own = line_response.own_errors(at.depth, still, True)
    logs = [np.where(np.isfinite(first.evidence), 0.0, -np.inf)]
    found, when = [first], [np.arange(len(one.time))]
    inverse = np.linalg.inv(first.expected)
    pulled = np.einsum("nst,nt->ns", inverse, first.innovation)
    gain = 0.5 * pulled**2 / np.einsum("nss->ns", inverse)
    least = np.log(NEGLIGIBLE / common_unknowns.SPIKES)
    for sensor in range(len(one.label)):
        times = np.flatnonzero((gain[:, sensor] > least) & np.isfinite(first.evidence))
        if not len(times):
            continue
        part = Linear(*(each[times] for each in vars(at).values()))
        spike = posterior(one.at(times), part, law.covariance, common, still, sensor, own[times])
        chance = np.full(len(times), np.log(common_unknowns.SPIKES))
        if neighbours is not None:
            expected, deviation = (each[times, sensor] for each in neighbours)
            chance += _excuse(one.at(times), common, spike, sensor, expected, deviation)
        logs.append(chance + spike.evidence - first.evidence[times])
        found.append(spike)
        when.append(times)
    n, p = first.depth.shape
    best = np.zeros(n)
    likely = first.logs.copy()
    for times, log, each in zip(when, logs, found, strict=True):
        ahead = log > best[times]
        best[times[ahead]], likely[times[ahead]] = log[ahead], each.logs[ahead]
    total, sea, depth, square = np.zeros(n), np.zeros(n), np.zeros((n, p)), np.zeros((n, p))
    for times, log, each in zip(when, logs, found, strict=True):
        weight = np.exp(np.where(np.isfinite(log), log, -np.inf) - best[times])
        off = np.nan_to_num(each.depth - first.depth[times])
        total[times] += weight
        sea[times] += weight * np.nan_to_num(each.sea)
        depth[times] += weight[:, None] * off
        square[times] += weight[:, None] * (off**2 + np.nan_to_num(each.variance))
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = depth / total[:, None]
        deviation = np.sqrt(np.maximum(square / total[:, None] - mean**2, 0.0))
        factor = np.exp(likely)
        read = ReadCurrents(known.read.level, known.read.u * factor, known.read.v * factor)
        return Estimate(first.depth + mean, deviation, sea / total, read)


def _excuse(
    one: MooringMeasurements, common: Common, spike: Posterior, sensor: int, expected: Floats,
    deviation: Floats,
) -> Floats:  # fmt: skip
    """Return (n,) corrections, at most 0, to the log-likelihood of a spike in one sensor.

    A reading that agrees with the readings before and after is unlikely to be a spike, unless the
    rest of the line agrees with them as well: strong currents move the whole line.

    Parameters
    ----------
    spike : posterior without the reading of the sensor
    expected, deviation : (n,) depth interpolated between the adjacent readings, and its standard
        deviation [m]
    """
    point = one.point[sensor]
    there = spike.depth[:, point] + common.offset[sensor]
    wide = deviation**2 + spike.variance[:, point]
    with np.errstate(invalid="ignore"):
        as_line = (there - expected) ** 2 / wide + np.log(wide)
        as_read = ((one.depth[:, sensor] - expected) / deviation) ** 2 + 2.0 * np.log(deviation)
    excuse: Floats = np.nan_to_num(np.minimum(0.5 * (as_read - as_line), 0.0))
    return excuse


@dataclass(frozen=True)
class Posterior:
    """Posterior of the currents, given the pressures.

    Attributes
    ----------
    logs : (n, g) changes in the logarithms of the factors on the currents, from the prior mean
    sea : (n,) height of the sea surface above its mean [m]
    depth, variance : (n, p) depths of the points [m] and their variances [m²]
    evidence : (n,) log probability density of the measured depths
    innovation : (n, s) measured depths less their predictions [m]
    expected : (n, s, s) covariance of the innovation
    """

    logs: Floats
    sea: Floats
    depth: Floats
    variance: Floats
    evidence: Floats
    innovation: Floats
    expected: Floats


def posterior(
    one: MooringMeasurements,
    at: Linear,
    spread: Floats,
    common: Common,
    still: Floats,
    spike: int = -1,
    own: Floats | None = None,
) -> Posterior:
    """Return the posterior of the currents and of all depths in the linear model.

    Parameters
    ----------
    one : measurements at n times
    at : depths linearised about a state of the currents
    spread : (g, g) prior covariance of the logarithms of the factors on the currents
    common : common unknowns
    still : (p,) depths in still water [m]
    spike : index of a sensor whose readings are treated as spikes; -1 for none
    own : `own_errors` at the state, if already computed
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
    if spike >= 0:
        noise[:, spike] = np.maximum(noise[:, spike], common_unknowns.SPIKE**2)
    if own is None:
        own = line_response.own_errors(at.depth, still, common.inferred)
    own = common.worst**2 * own
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
    """Currents at several times, with the linearised line and the posterior there."""

    read: ReadCurrents
    at: Linear
    found: Posterior
