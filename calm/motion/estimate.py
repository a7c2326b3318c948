"""The depths at each time, over all ways to read the currents and the sensors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.motion import prior
from calm.motion.common_unknowns import Common
from calm.motion.line_response import LineResponse, ReadCurrents
from calm.motion.posterior import Linear, Posterior, best_state, posterior
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


def estimated(moments: LineResponse, common: Common) -> Estimate:
    """Return the posterior of all ways to read the currents and the sensors."""
    one, still = moments.measured, moments.forward.still
    known = best_state(moments, common)
    first, at = known.found, known.at
    every = np.arange(len(one.time))
    mixture = Mixture(moments, known.way, first)
    if not len(one.label):
        return mixture.estimate()
    for sensor in range(len(one.label)):
        spike = posterior(one, at, known.way.spread, common, still, sensor)
        mixture.add(every, known.way, spike, np.full(len(every), np.log(prior.SPIKES)), ())
    odds, worse = _odds(moments), np.full(len(every), np.log(prior.ALL_WORSE))
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
                    other = replace(other, spread=prior.WORSE**2 * other.spread)
                found = _tried(part, other, at, common, tried)
                mixture.add(tried, other, found, chance[tried], without)
    return mixture.estimate()


def _odds(moments: LineResponse) -> Floats:
    """Return (n, g) logarithms of the odds that the current of a group is false.

    None without one.
    """
    one = moments.measured
    known = np.isfinite(one.u) & np.isfinite(one.v)
    false = np.where(known, prior.by_flag(prior.FALSE, one.flag), 0.0)
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
    """No group but all of them worse, one group or two, never all of them."""
    yield [()]
    for size in (1, 2):
        if size < groups:
            yield combinations(range(groups), size)


if TYPE_CHECKING:
    pass
    from calm.motion.line_response import LineResponse, ReadCurrents
    from calm.motion.posterior import Posterior

    Explanation = tuple[NDArray[np.int64], Floats, ReadCurrents, Posterior, tuple[int, ...]]


class Mixture:
    """The explanations of a block of times; the first holds at all of them."""

    def __init__(self, moments: LineResponse, way: ReadCurrents, first: Posterior) -> None:
        self.moments, self.first = moments, first
        every = np.arange(len(first.evidence))
        self._found: list[Explanation] = [(every, _log(first.evidence), way, first, ())]

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
        pass
        from calm.motion.line_response import ReadCurrents

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
