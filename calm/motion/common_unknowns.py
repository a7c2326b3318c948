"""Unknowns common to a whole record: factors on the line, the datum, and offsets of its sensors.

And the law by which faults of sensors are weighed: slips, drifts and steps of all sensors alike,
by what many times say of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from calm.motion.currents_law import SpeedLaw
from calm.physics.line import Floats, Integers

FURTHEST = 1.0
"""Of the logarithm of a factor, at most."""
REACH = 5.0
"""Between a sensor and the points by which the slope of the line at it is known, at least [m]."""


@dataclass(frozen=True)
class Common:
    """Hold what is common to the whole record, as far as it is known.

    The q columns of the covariance are the logarithms of the factors, the datum [m] and the offsets
    of the sensors [m].

    Attributes
    ----------
    factors : names of the estimated factors and their values
    datum : what is added to the depths of the line [m]
    offset : (s,) of the sensors [m]
    covariance : (q, q)
    worst : share of the knockdown that the line itself may be wrong by, after all else
    law : of currents that nobody measured; None of measured ones
    """

    factors: Mapping[str, float]
    datum: float
    offset: Floats
    covariance: Floats
    worst: float = 0.07
    law: SpeedLaw | None = None

    @property
    def inferred(self) -> bool:
        """Return whether the currents are inferred from the pressures."""
        return self.law is not None

    @property
    def value(self) -> Floats:
        """Return (q,) as the columns of the covariance stand."""
        logs = np.log(list(self.factors.values()))
        return np.concatenate([logs, [self.datum], self.offset])

    def at(self, value: Floats) -> Common:
        """Return the same with other values (q,) of its unknowns."""
        count = len(self.factors)
        factors = np.exp(np.clip(value[:count], -FURTHEST, FURTHEST)).tolist()
        return replace(
            self,
            factors=dict(zip(self.factors, factors, strict=True)),
            datum=float(value[count]),
            offset=value[count + 1 :],
        )


def common_beforehand(
    factors: Mapping[str, float], datum: float, sensors: int, mean: float = 0.0
) -> Common:
    """Return what is common where all sensors hang as the file says, with what is expected of it.

    Parameters
    ----------
    factors : their values
    datum : standard deviation of what is added to the depths of the line [m]
    sensors : how many there are
    mean : of what is added to the depths of the line [m]
    """
    known = [FACTORS[name][1] for name in factors]
    spread = [*known, datum, *[OFFSET] * sensors]
    return Common(factors, mean, np.zeros(sensors), np.diag(np.square(spread)))


def fixed_slopes(common: Floats) -> Floats:
    """Return (n, s, q) slopes with factors, datum and offsets by (n, s, f) those with factors."""
    n, s, _ = common.shape
    offsets = np.broadcast_to(np.eye(s), (n, s, s))
    return np.concatenate([common, np.ones((n, s, 1)), offsets], axis=2)


def fall(depth: Floats, still: Floats, point: Integers) -> Floats:
    """Return (n, s) change of the depth of each sensor with how far it has moved down the line.

    Parameters
    ----------
    depth, still : (n, p), (p,) of the points, at these times and in still water [m]
    point : (s,) where the sensors are by the file
    """
    result = np.zeros((len(depth), len(point)))
    for j, one in enumerate(point.tolist()):
        below = still - still[one]
        upper = int(np.where(below <= -REACH, below, -np.inf).argmax())
        lower = int(np.where(below >= REACH, below, np.inf).argmin())
        upper = upper if below[upper] <= -REACH else one
        lower = lower if below[lower] >= REACH else one
        apart = still[lower] - still[upper]
        result[:, j] = (depth[:, lower] - depth[:, upper]) / apart if apart > 0.0 else 1.0
    return result


LONGEST_MEMORY = 25
"""Times over which errors that repeat are looked for."""


def repeated(pull: Floats) -> float:
    """Return how many times that follow each other have the same error, by its autocorrelation."""
    one = pull - pull.mean()
    whole = float(one @ one)
    total, chance = 1.0, 2.0 / np.sqrt(max(len(one), 1))
    for lag in range(1, min(LONGEST_MEMORY, len(one) // 4)):
        share = float(one[lag:] @ one[:-lag]) / whole if whole > 0.0 else 0.0
        if share < chance:
            break
        total += 2.0 * share
    return total


FEWEST = 4
"""Readings of a sensor before and after its clamp slips, at least."""


ROBUST = 4.0
"""Degrees of freedom of Student's law for the misfit of a time."""


@dataclass(frozen=True)
class LinearLaw:
    """Hold what n times say of the unknowns of the whole record, by the slopes at a state.

    Attributes
    ----------
    time, share : (n,) times, and the share of the record that is over by then
    known : (n, s) whether there is a reading
    raw, left : (n, s) measured less computed depths where the unknowns are 0, and as they are [m]
    expected : (n, s, s) covariance of `left`
    fixed : (n, s, q) slopes with factors, datum and offsets
    fall : (n, s) change of the depth of each sensor with how far it has moved throughout
    """

    time: NDArray[np.datetime64]
    share: Floats
    known: NDArray[np.bool_]
    raw: Floats
    left: Floats
    expected: Floats
    fixed: Floats
    fall: Floats

    @cached_property
    def inverse(self) -> Floats:
        """Return (n, s, s) of the covariance of what is left."""
        return np.asarray(np.linalg.inv(self.expected), np.float64)

    @cached_property
    def weight(self) -> Floats:
        """Return (n,) what a time counts, by Student's law: one of large misfit less."""
        misfit = np.einsum("ns,nst,nt->n", self.left, self.inverse, self.left)
        weight: Floats = (ROBUST + self.known.sum(axis=1)) / (ROBUST + misfit)
        return weight

    def pulls(self, seen: Floats, left: Floats) -> Floats:
        """Return (n, q) slopes of the logarithm of the likelihood of each time."""
        return np.asarray(np.einsum("n,nsq,nst,nt->nq", self.weight, seen, self.inverse, left))

    def normal(self, seen: Floats) -> Floats:
        """Return (q, q) the information of all times."""
        heavy = self.weight[:, None, None] * self.inverse
        return np.asarray(np.einsum("nsq,nsr->qr", seen, heavy @ seen))


NEVER = -1
"""In place of a time, where a sensor has too few readings to hang elsewhere."""
RAMPS: Mapping[int, float] = {-2: 1.0, -3: 0.3}
"""In place of a time, where a sensor drifts: over which share of the record."""


def moves(first: Integers, fall: Floats, share: Floats) -> Floats:
    """Return (n, s) change of what each sensor reads with how far it has moved or drifted.

    Parameters
    ----------
    first : (s,) of `first_time`
    fall : (n, s) change of the depth of each sensor with how far it has moved
    share : (n,) of the record at each time, 0 to 1
    """
    began = (np.arange(len(fall))[:, None] >= first) & (first >= 0)
    result: Floats = np.where(began, fall, 0.0)
    for code, part in RAMPS.items():
        result = np.where(first == code, np.minimum(share / part, 1.0)[:, None], result)
    return result


def chance_of(first: int, times: int) -> tuple[float, float]:
    """Return the logarithm of how likely a sensor moves or drifts so, and the deviation of it [m].

    `first` is of `first_time`; at so many times a clamp may slip.
    """
    if first in RAMPS:
        return float(np.log(DRIFTS / len(RAMPS))), DRIFT
    return float(np.log(SLIPPED / times if first else MISPLACED)), ELSEWHERE


def first_time(law: LinearLaw, mean: Floats, covariance: Floats) -> Integers:
    """Return (s,) the time from which on each sensor most likely hangs elsewhere, if it does.

    0 is throughout; `NEVER` where it has too few readings; one of `RAMPS` where it is likelier to
    drift than to have slipped at any time. Each is weighed beside all that is known beforehand.

    Parameters
    ----------
    law : what the times say
    mean, covariance : (q,), (q, q) of the unknowns beforehand
    """
    count = len(law.time)
    if not count:
        return np.full(law.fall.shape[1], NEVER)
    gained = Gains(law, mean, covariance)
    sensors = np.eye(law.fall.shape[1])
    steps = np.stack([gained.steps(law.fall * one, ELSEWHERE) for one in sensors], axis=1)
    steps[1:] += np.log(SLIPPED / count)
    steps[0] += np.log(MISPLACED)
    after = _from_there_on(law.known.astype(float))
    can = (after >= FEWEST) & (after[:1] - after >= FEWEST)
    can[0] = after[0] >= FEWEST
    steps = np.where(can, steps, -np.inf)
    first: Integers = np.where(can.any(axis=0), steps.argmax(axis=0), NEVER)
    best = steps.max(axis=0) + np.where(first > 0, np.log(count), 0.0)  # of a slip at any time
    for code, part in RAMPS.items():
        ramp = np.minimum(law.share / part, 1.0)[:, None]
        chance, wide = chance_of(code, count)
        drift = np.array([gained.whole(ramp * one, wide) for one in sensors]) + chance
        better = (drift > best) & (after[0] >= 2 * FEWEST)
        first, best = np.where(better, code, first), np.where(better, drift, best)
    return first


def common_step(law: LinearLaw, mean: Floats, covariance: Floats) -> int:
    """Return the time from which on all sensors are most likely deeper or shallower alike.

    `NEVER` where too few times are on either side.
    """
    count = len(law.time)
    if count < 2 * FEWEST:
        return NEVER
    steps = Gains(law, mean, covariance).steps(np.ones_like(law.fall), ELSEWHERE)
    return FEWEST + int(np.argmax(steps[FEWEST : count - FEWEST + 1]))


class Gains:
    """How much likelier the readings are with one more unknown beside those of the record."""

    def __init__(self, law: LinearLaw, mean: Floats, covariance: Floats) -> None:
        before = np.linalg.inv(covariance)
        self.inverse = np.linalg.inv(law.normal(law.fixed) + before)
        pull = law.pulls(law.fixed, law.raw).sum(axis=0)
        left = law.raw - law.fixed @ (self.inverse @ (pull + before @ mean))
        self.heavy = law.weight[:, None, None] * law.inverse
        self.pull = (self.heavy @ left[:, :, None])[:, :, 0]
        self.fixed = law.fixed

    def _parts(self, column: Floats) -> tuple[Floats, Floats, Floats]:
        """Return (n,), (n, q), (n,) what each time says of the size of a column (n, s)."""
        own = (self.heavy @ column[:, :, None])[:, :, 0]
        crossed = np.einsum("nsq,ns->nq", self.fixed, own)
        return (column * self.pull).sum(axis=1), crossed, (column * own).sum(axis=1)

    def _gain(self, own: Floats, cross: Floats, alone: Floats, wide: float) -> Floats:
        size = np.maximum(alone - np.einsum("nq,qr,nr->n", cross, self.inverse, cross), 0.0)
        gain: Floats = 0.5 * own**2 / (size + wide**-2) - 0.5 * np.log1p(wide**2 * size)
        return gain

    def steps(self, column: Floats, wide: float) -> Floats:
        """Return (n,) logarithms of a column that begins at each time, of a deviation `wide`."""
        own, cross, alone = (_from_there_on(part) for part in self._parts(column))
        return self._gain(own, cross, alone, wide)

    def whole(self, column: Floats, wide: float) -> float:
        """Return the logarithm of a column throughout."""
        own, cross, alone = (part.sum(axis=0, keepdims=True) for part in self._parts(column))
        return float(self._gain(own, cross, alone, wide)[0])


def _from_there_on(values: Floats) -> Floats:
    """Sums over the first axis from each place to the end."""
    sums: Floats = np.cumsum(values[::-1], axis=0)[::-1]
    return sums


NORMAL = 1.4826
"""Standard deviation of a normal law over the median of its size."""
FACTORS: Mapping[str, tuple[float, float]] = {
    "cable_drag": (0.0, 0.15),
    "rigid_drag": (0.0, 0.15),
    "buoyancy": (0.0, 0.02),
    "length": (0.0, 0.003),
}
"""Mean and deviation of the logarithms of the common factors."""
DATUM = 0.01
"""Of the depth of the water, as a share of it: what all depths may be wrong by alike."""
OFFSET = 1.0
"""Of the offset of a sensor [m]."""
ELSEWHERE, MISPLACED, SLIPPED = 20.0, 0.01, 0.01
"""How far from its place in the file a sensor is that is not there [m], and the probabilities that
it is so from the beginning, and that its clamp slips during the record."""
MOVED = 0.01
"""Probability that the whole mooring is moved to another depth during the record."""
FALSE: Mapping[int, float] = {0: 0.01, 1: 0.01, 2: 0.03, 3: 0.10, 4: 0.30, 8: 0.10}
"""Probability that a current is false in direction or size, by its quality flag."""
DRIFT, DRIFTS = 5.0, 0.01
"""Of what a sensor drifts by over the record [m], and the probability that it does."""
TIDE = 1.0
"""Of tide and air pressure [m]; where the sea level is given, `RESIDUAL_TIDE`."""
RESIDUAL_TIDE = 0.15
NOISE = 0.2
"""Of a depth by pressure at one time [m]."""
SPIKE, SPIKES = 30.0, 1e-5
"""Of a depth that is a spike [m], and the probability that one is."""
