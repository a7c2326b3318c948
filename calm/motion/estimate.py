"""The depths at each time, over all ways to read the currents and the sensors.

What the pressures make of one way is found by Gauss-Newton steps on the march.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.line_response import LineResponse
from calm.motion.measurements import MooringMeasurements
from calm.physics.line import Floats

NEGLIGIBLE = 0.02
"""An explanation is not tried that would not reach this share of the first one's weight if it left
the pressures no more misfit than is expected of them."""


@dataclass(frozen=True)
class Estimate:
    """Hold what is known of a block of times.

    Attributes
    ----------
    depth, deviation : (n, p) of the points [m]
    sea : (n,) what stands over the mean surface [m]
    current : (n,) factor on the current
    doubt : (n, k) probability that the current of a level is false
    likely : the most likely reading of the currents, whose levels, u and v have their factors
    """

    depth: Floats
    deviation: Floats
    sea: Floats
    current: Floats
    doubt: Floats
    likely: ReadCurrents


def estimated(
    moments: LineResponse,
    common: Common,
    known: CurrentsState | None = None,
    neighbours: tuple[Floats, Floats] | None = None,
) -> Estimate:
    """Return the posterior of all ways to read the currents and the sensors.

    Parameters
    ----------
    known : the best state of all currents as they are; that of `best_state` where it is None
    neighbours : see `calm.motion.measurements.by_neighbours`; None of times that stand alone
    """
    one, still = moments.measured, moments.forward.still
    known = best_state(moments, common) if known is None else known
    furthest = np.inf if common.inferred else FURTHEST
    first, at = known.found, known.at
    every = np.arange(len(one.time))
    mixture = Mixture(moments, known.way, first)
    if not len(one.label):
        return mixture.estimate()
    own = line_response.own_errors(at.depth, still, common.inferred)
    for sensor in range(len(one.label)):
        spike = posterior(one, at, known.way.spread, common, still, sensor, furthest, own)
        chance = np.full(len(every), np.log(common_unknowns.SPIKES))
        if neighbours is not None:
            beside = (part[:, sensor] for part in neighbours)
            chance += _excuse(moments, common, at, spike, sensor, *beside)
        mixture.add(every, known.way, spike, chance, ())
    if common.inferred:  # no current was measured that may be false
        return mixture.estimate()
    odds, worse = _odds(moments), np.full(len(every), np.log(common_unknowns.ALL_WORSE))
    count = np.isfinite(one.depth).sum(axis=1)
    fair = -0.5 * (count + np.linalg.slogdet(first.expected)[1])
    level = moments.levels(first.depth)
    for sets in _sets(moments.groups):
        best = mixture.best
        for without in sets:
            chance = odds[:, list(without)].sum(axis=1) if without else worse
            likely = chance + fair > best + np.log(NEGLIGIBLE)
            tried = np.flatnonzero(likely & np.isfinite(best))
            if len(tried):
                part = LineResponse(one.at(tried), moments.forward, {})
                other = part.way(level[tried], common, without)
                if not without:
                    other = replace(other, spread=common_unknowns.WORSE**2 * other.spread)
                found = _tried(part, other, at, common, tried)
                mixture.add(tried, other, found, chance[tried], without)
    return mixture.estimate()


def _excuse(
    moments: LineResponse, common: Common, at: Linear, spike: Posterior, sensor: int,
    expected: Floats, deviation: Floats,
) -> Floats:  # fmt: skip
    """Return (n,) logarithms by which a reading is less likely a spike than by its own time alone.

    The readings before and after it expect the one as measured, or the one that the line has
    without it: weather moves the neighbours as well.

    Parameters
    ----------
    spike : what is known without the sensor
    expected, deviation : (n,) of the sensor by its neighbours [m]
    """
    one, point = moments.measured, moments.measured.point[sensor]
    fall = common.fall(one.time, at.depth, moments.forward.still, one.point) * common.moved
    there = spike.depth[:, point] + (common.offset + fall)[:, sensor]
    wide = deviation**2 + spike.variance[:, point]
    with np.errstate(invalid="ignore"):
        as_line = (there - expected) ** 2 / wide + np.log(wide)
        as_read = ((one.depth[:, sensor] - expected) / deviation) ** 2 + 2.0 * np.log(deviation)
    return np.nan_to_num(np.minimum(0.5 * (as_read - as_line), 0.0))


def _odds(moments: LineResponse) -> Floats:
    """Return (n, g) logarithms of the odds that the current of a group is false.

    None without one.
    """
    one = moments.measured
    known = np.isfinite(one.u) & np.isfinite(one.v)
    false = np.where(known, line_response.by_flag(common_unknowns.FALSE, one.flag), 0.0)
    odds = np.full((len(one.time), moments.groups), -np.inf)
    for g in range(moments.groups):
        mine = moments.group == g
        count = known[:, mine].sum(axis=1)
        mean = false[:, mine].sum(axis=1) / np.maximum(count, 1)
        odds[count > 0, g] = np.log(mean[count > 0] / (1.0 - mean[count > 0]))
    return odds


def _tried(
    part: LineResponse, other: ReadCurrents, at: Linear, common: Common, tried: NDArray[np.int64]
) -> Posterior:
    """Return the posterior of another way, whose slopes begin with those of the currents as
    measured.
    """
    none, still = np.zeros((len(tried), part.groups)), part.forward.still
    there = part.depths(other, none)
    before = np.maximum(at.depth[tried] - still, 1.0)
    # without equilibrium in these currents the slopes stay as they are: it is left out
    ratio = np.nan_to_num(np.clip(np.maximum(there - still, 1.0) / before, 0.2, 5.0), nan=1.0)
    ratio = ratio[:, :, None]
    state = Linear(none, there, at.slope[tried] * ratio, at.common[tried] * ratio)
    found = posterior(part.measured, state, other.spread, common, still)
    for _ in range(2):
        state = state.moved(found.logs, part.depths(other, found.logs))
        found = posterior(part.measured, state, other.spread, common, still)
    return found


def _sets(groups: int) -> Iterator[Iterable[tuple[int, ...]]]:
    """Yield no group, for all of them worse, one group or two, never all of them."""
    yield [()]
    for size in (1, 2):
        if size < groups:
            yield combinations(range(groups), size)


class Mixture:
    """The explanations of a block of times; the first holds at all of them."""

    def __init__(self, moments: LineResponse, way: ReadCurrents, first: Posterior) -> None:
        self.moments, self.first = moments, first
        every = np.arange(len(first.evidence))
        self._found: list[
            tuple[NDArray[np.int64], Floats, ReadCurrents, Posterior, tuple[int, ...]]
        ] = [(every, _log(first.evidence), way, first, ())]

    def add(
        self,
        times: NDArray[np.int64],
        way: ReadCurrents,
        found: Posterior,
        odds: Floats,
        without: tuple[int, ...],
    ) -> None:
        """One more, at some times.

        Parameters
        ----------
        odds : (m,) logarithms of its prior odds against the first
        without : the groups of levels that it takes for false
        """
        self._found.append((times, _log(odds + found.evidence), way, found, without))

    @property
    def best(self) -> Floats:
        """Return (n,) greatest weight so far, its logarithm."""
        best = np.full(len(self.first.evidence), -np.inf)
        for times, log, *_ in self._found:
            best[times] = np.maximum(best[times], log)
        return best

    def estimate(self) -> Estimate:
        """Return the mean over all explanations, and the deviation about it."""
        moments, first = self.moments, self.first
        n, p = first.depth.shape
        best = np.full(n, -np.inf)
        measured = self._found[0][2]
        level, u, v = measured.level.copy(), measured.u.copy(), measured.v.copy()
        for times, log, way, found, _ in self._found:
            ahead = log > best[times]
            here, mine = times[ahead], np.flatnonzero(ahead)
            best[here] = log[mine]
            factor = np.exp(found.logs[mine][:, moments.group])
            level[here] = way.level[mine]
            u[here], v[here] = way.u[mine] * factor, way.v[mine] * factor
        total, current, sea = np.zeros(n), np.zeros(n), np.zeros(n)
        depth, square = np.zeros((n, p)), np.zeros((n, p))
        doubt = np.zeros((n, moments.groups))
        for times, log, _, found, without in self._found:
            usable = np.isfinite(log)
            here = times[usable]
            weight = np.exp(log[usable] - best[here])
            off = found.depth[usable] - first.depth[here]
            total[here] += weight
            depth[here] += weight[:, None] * off
            square[here] += weight[:, None] * (off**2 + found.variance[usable])
            current[here] += weight * found.current[usable]
            sea[here] += weight * found.sea[usable]
            for g in without:
                doubt[here, g] += weight
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = depth / total[:, None]
            variance = square / total[:, None] - mean**2
            return Estimate(
                first.depth + mean,
                np.sqrt(np.maximum(variance, 0.0)),
                sea / total,
                np.exp(current / total),
                (doubt / total[:, None])[:, moments.group],
                ReadCurrents(level, u, v, measured.spread),
            )


def _log(evidence: Floats) -> Floats:
    return np.where(np.isfinite(evidence), evidence, -np.inf)


FURTHEST = 0.7
"""Of a logarithm of a current's factor, at most."""
UNMEASURED = 1e4
"""Of a sensor that measured nothing at a time [m]."""


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
    furthest: float = FURTHEST,
    own: Floats | None = None,
) -> Posterior:
    """Return the best state by a linear law, and what is known of all depths then.

    Parameters
    ----------
    spread : (n, g, g) prior covariance of the logarithms
    still : (p,) depths in still water [m]
    spike : a sensor whose pressures are taken for spikes
    furthest : of a logarithm, at most
    own : `own_errors` of the state, where they are known
    """
    n, p, g = at.slope.shape
    s, f = len(one.point), at.common.shape[2]
    # columns of the state: currents, sea, common factors, datum, offsets, moves
    free = g + 1
    q = free + f + 1 + s + s
    state = np.zeros((n, q, q))
    state[:, :g, :g] = spread
    state[:, g, g] = (
        common_unknowns.TIDE if one.tide is None else common_unknowns.RESIDUAL_TIDE
    ) ** 2
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
    noise = np.where(known, common_unknowns.NOISE**2, UNMEASURED**2)
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
    logs = np.clip(gain[:, :g], -furthest, furthest)
    # what the state cannot take up is spread along the line as its own errors are
    depth = base + (beside @ solved[:, :, None])[:, :, 0]
    whole = (spread_of * slope).sum(axis=2) + np.einsum("npp->np", own)
    taken = ((beside @ inverse) * beside).sum(axis=2)
    _, size = np.linalg.slogdet(expected)
    misfit = (innovation * solved).sum(axis=1)
    depth[lost] = np.nan
    return Posterior(
        logs,
        gain[:, g] + tide,
        depth,
        np.maximum(whole - taken, 0.0),
        np.where(lost, -np.inf, -0.5 * (misfit + size)),
        innovation,
        expected,
        logs.sum(axis=1) / max(g, 1),
    )


@dataclass(frozen=True)
class CurrentsState:
    """Some currents, the line in them, and what the pressures make of it by its slopes there."""

    way: ReadCurrents
    at: Linear
    found: Posterior


def measured_state(moments: LineResponse, common: Common) -> CurrentsState:
    """Hang the currents where the line is, and take them as they were measured."""
    one, still = moments.measured, moments.forward.still
    none = np.zeros((len(one.time), moments.groups))
    there = line_response.between(one, np.tile(still, (len(one.time), 1)), still)
    there = moments.depths(moments.way(moments.levels(there), common), none)
    way = moments.way(moments.levels(line_response.between(one, there, still)), common)
    at = moments.linear(way, none)
    return CurrentsState(way, at, posterior(one, at, way.spread, common, still))


def best_state(moments: LineResponse, common: Common) -> CurrentsState:
    """Return the best state of currents that were measured."""
    state = measured_state(moments, common)
    way, at, found = state.way, state.at, state.found
    for _ in range(2):
        at = at.moved(found.logs, moments.depths(way, found.logs))
        found = posterior(moments.measured, at, way.spread, common, moments.forward.still)
    return CurrentsState(way, at, found)
