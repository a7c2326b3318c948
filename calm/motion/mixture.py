"""Several explanations of the same pressures, each weighed by its prior and its evidence."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats

if TYPE_CHECKING:
    from calm.motion.estimate import Estimate
    from calm.motion.moment import Moments, Way
    from calm.motion.posterior import Posterior

    Explanation = tuple[NDArray[np.int64], Floats, Way, Posterior, tuple[int, ...]]


class Mixture:
    """The explanations of a block of times; the first holds at all of them."""

    def __init__(self, moments: Moments, way: Way, first: Posterior) -> None:
        self.moments, self.first = moments, first
        every = np.arange(len(first.evidence))
        self._found: list[Explanation] = [(every, _log(first.evidence), way, first, ())]

    def add(
        self,
        times: NDArray[np.int64],
        way: Way,
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
        """(n,) greatest weight so far, its logarithm."""
        best = np.full(len(self.first.evidence), -np.inf)
        for times, log, *_ in self._found:
            best[times] = np.maximum(best[times], log)
        return best

    def estimate(self) -> Estimate:
        """The mean over all explanations, and the deviation about it."""
        from calm.motion.estimate import Estimate
        from calm.motion.moment import Way

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
                Way(level, u, v, measured.spread),
            )


def _log(evidence: Floats) -> Floats:
    return np.where(np.isfinite(evidence), evidence, -np.inf)
