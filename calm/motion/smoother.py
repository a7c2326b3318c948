"""Kalman filter and fixed-interval smoother, with one forward and one backward pass.

The model of the states x and the readings y is x(t+1) = f x(t) + e, with diagonal f, and
y = H x + noise. All errors are independent.

Source of the backward recursion: Durbin and Koopman, Time Series Analysis by State Space Methods,
2012, section 4.4.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats

BLOCK = 256  # number of times per stored block


@dataclass(frozen=True)
class StateSpace:
    """A linear state-space model of n times, q states and m readings."""

    # (n, q) factor by which each state decays since the previous time; the first is unused
    fade: Floats
    steady: Floats  # (q, q) stationary covariance of the states that decay
    stepped: Floats  # (n, q) variance added to each persistent state since the previous time
    first: Floats  # (q, q) covariance of the states at the first time; their prior mean is always 0
    seen: Floats  # (n, m, q) derivatives of the readings with respect to the states
    read: Floats  # (n, m) readings; NaN if missing
    noise: Floats  # (n, m) variances of the errors of the readings

    def added(self, time: int) -> Floats:
        """Return the (q, q) covariance of the state noise since the previous time."""
        fade = self.fade[time]
        result = self.steady * (1.0 - np.outer(fade, fade))
        result.flat[:: len(result) + 1] += self.stepped[time]
        return result


@dataclass(frozen=True)
class _Filtered:
    """Filter result at one time: the predicted state, and the innovation of the readings."""

    mean: Floats
    spread: Floats
    seen: Floats
    gain: Floats
    left: Floats
    inverse: Floats


@dataclass(frozen=True)
class Smoothed:
    """Smoothed states at b successive times, given all readings of the record."""

    times: slice
    mean: Floats  # (b, q) mean of the states
    covariance: Floats  # (b, q, q) covariance of the states
    # vector r (b, q) and matrix N (b, q, q) of Durbin and Koopman: the state noise before each
    # time, of prior covariance Q, has the mean Q r and the covariance Q - Q N Q
    pull: Floats
    hold: Floats


def _filter(
    law: StateSpace, start: int, stop: int, mean: Floats, spread: Floats
) -> Iterator[_Filtered]:
    """Yield the filter result at each time; `mean` and `spread` are predictions for `start`."""
    for time in range(start, stop):
        if time > start:
            fade = law.fade[time]
            mean = fade * mean
            spread = fade[:, None] * spread * fade + law.added(time)
        there = np.isfinite(law.read[time])
        seen = law.seen[time, there]
        across = spread @ seen.T
        expected = seen @ across
        expected.flat[:: len(expected) + 1] += law.noise[time, there]
        inverse = np.linalg.inv(expected)
        gain = across @ inverse
        left = law.read[time, there] - seen @ mean
        yield _Filtered(mean, spread, seen, gain, left, inverse)
        mean = mean + gain @ left
        spread = spread - gain @ across.T
        spread = 0.5 * (spread + spread.T)


def smoothed(law: StateSpace) -> Iterator[Smoothed]:
    """Yield the smoothed states block by block, from the last block of times to the first."""
    count = len(law.read)
    starts = range(0, count, BLOCK)
    # to save memory, store the filter only at the start of each block
    begun = [(np.zeros(len(law.first)), law.first)]
    for start in starts[:-1]:
        for one in _filter(law, start, start + BLOCK, *begun[-1]):
            last = one
        after, fade = start + BLOCK, law.fade[start + BLOCK]
        mean = last.mean + last.gain @ last.left
        spread = last.spread - last.gain @ (last.seen @ last.spread)
        spread = fade[:, None] * (0.5 * (spread + spread.T)) * fade + law.added(after)
        begun.append((fade * mean, spread))
    pull, hold = np.zeros(len(law.first)), np.zeros_like(law.first)
    for start, known in zip(reversed(starts), reversed(begun), strict=True):
        stop, rows = min(start + BLOCK, count), []
        block = [*_filter(law, start, stop, *known)]
        for time, one in zip(reversed(range(start, stop)), reversed(block), strict=True):
            if time + 1 < count:
                fade = law.fade[time + 1]
                pull, hold = fade * pull, fade[:, None] * hold * fade
            # (1 - gain seen)' of later times, plus the information of this time
            kept = pull - one.seen.T @ (one.gain.T @ pull)
            pull = kept + one.seen.T @ (one.inverse @ one.left)
            half = hold - one.seen.T @ (one.gain.T @ hold)
            hold = half - (half @ one.gain) @ one.seen + one.seen.T @ one.inverse @ one.seen
            hold = 0.5 * (hold + hold.T)
            covariance = one.spread - one.spread @ hold @ one.spread
            rows.append((one.mean + one.spread @ pull, covariance, pull, hold))
        yield Smoothed(slice(start, stop), *map(np.array, zip(*reversed(rows), strict=True)))
