"""Unknowns common to a whole record: factors on the line, the datum, and sensor offsets.

The linear law of this module also weighs faults of sensors (slips, drifts and common steps) by the
evidence of many times.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from calm.motion.currents_law import SpeedLaw
from calm.physics.line import Floats, Integers

FURTHEST = 1.0
"""Limit on the logarithm of a factor."""
REACH = 5.0
"""Least distance between a sensor and the points that give the slope of the line there [m]."""


@dataclass(frozen=True)
class Common:
    """Estimate of the unknowns common to a whole record.

    The q columns of the covariance are the logarithms of the factors, the datum [m] and the offsets
    of the sensors [m].

    Attributes
    ----------
    factors : names of the estimated factors and their values
    datum : correction added to the depths of the line [m]
    offset : (s,) of the sensors [m]
    covariance : (q, q)
    worst : error of the line itself, as a share of the knockdown, after all other corrections
    law : law of inferred currents; None for measured currents
    """

    factors: Mapping[str, float]
    datum: float
    offset: Floats
    covariance: Floats
    worst: float = 0.07
    law: SpeedLaw | None = None

    @property
    def inferred(self) -> bool:
        """Whether the currents are inferred from the pressures."""
        return self.law is not None

    @property
    def value(self) -> Floats:
        """Values (q,) of the unknowns, in the order of the covariance."""
        logs = np.log(list(self.factors.values()))
        return np.concatenate([logs, [self.datum], self.offset])

    def at(self, value: Floats) -> Common:
        """Return a copy with new values (q,) of the unknowns."""
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
    """Return the common unknowns before the fit, with all sensors at their places in the file.

    The covariance is that of the prior.

    Parameters
    ----------
    factors : initial values of the factors, by name
    datum : standard deviation of the correction to the depths of the line [m]
    sensors : number of sensors
    mean : mean of the correction to the depths of the line [m]
    """
    known = [FACTORS[name] for name in factors]
    spread = [*known, datum, *[OFFSET] * sensors]
    return Common(factors, mean, np.zeros(sensors), np.diag(np.square(spread)))


def fixed_slopes(common: Floats) -> Floats:
    """Return (n, s, q) slopes for factors, datum and offsets, from (n, s, f) slopes for factors."""
    n, s, _ = common.shape
    offsets = np.broadcast_to(np.eye(s), (n, s, s))
    return np.concatenate([common, np.ones((n, s, 1)), offsets], axis=2)


def fall(depth: Floats, still: Floats, point: Integers) -> Floats:
    """Return (n, s) change in the depth of each sensor per metre of slip down the line.

    Parameters
    ----------
    depth, still : (n, p), (p,) of the points, at these times and in still water [m]
    point : (s,) points of the sensors, from the file
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
    return np.nan_to_num(result, nan=1.0)


LONGEST_MEMORY = 25
"""Maximum number of times over which the error correlation is summed."""


def repeated(pull: Floats) -> float:
    """Return the number of successive times with a common error, from the autocorrelation."""
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
"""Least number of readings of a sensor before and after a slip of its clamp."""


ROBUST = 4.0
"""Degrees of freedom of Student's law for the misfit of a time."""


@dataclass(frozen=True)
class LinearLaw:
    """Linear model of n times for the unknowns of the whole record, with slopes at one state.

    Attributes
    ----------
    time, share : (n,) times, and the elapsed share of the record
    known : (n, s) whether a reading exists
    raw, left : (n, s) measured less computed depths, for zero unknowns and at the state [m]
    expected : (n, s, s) covariance of `left`
    fixed : (n, s, q) slopes for factors, datum and offsets
    fall : (n, s) change in the depth of each sensor per metre of displacement along the line
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
        """Inverse (n, s, s) of the covariance of the residuals."""
        return np.asarray(np.linalg.inv(self.expected), np.float64)

    @cached_property
    def weight(self) -> Floats:
        """Weight (n,) of each time by Student's law, lower for a large misfit."""
        misfit = np.einsum("ns,nst,nt->n", self.left, self.inverse, self.left)
        weight: Floats = (ROBUST + self.known.sum(axis=1)) / (ROBUST + misfit)
        return weight

    def pulls(self, seen: Floats, left: Floats) -> Floats:
        """Return (n, q) gradients of the log-likelihood of each time."""
        return np.asarray(np.einsum("n,nsq,nst,nt->nq", self.weight, seen, self.inverse, left))

    def normal(self, seen: Floats) -> Floats:
        """Return (q, q) information matrix of all times."""
        heavy = self.weight[:, None, None] * self.inverse
        return np.asarray(np.einsum("nsq,nsr->qr", seen, heavy @ seen))


MISHUNG = -1
"""Code of a sensor that hangs elsewhere throughout, in place of a time."""
RAMPS: Mapping[int, float] = {-2: 1.0, -3: 0.3}
"""Codes of drifts, in place of a time, with the share of the record over which they last."""


def moved_by(code: int, fall: Floats, share: Floats) -> Floats:
    """Return (n,) change in the reading of a sensor per metre of offset, slip or drift.

    Parameters
    ----------
    code : 0 for a wrong zero, the time of a slip, `MISHUNG`, or a code of `RAMPS`
    fall : (n,) change in its depth per metre of displacement along the line
    share : (n,) elapsed share of the record at each time, 0 to 1
    """
    if code in RAMPS:
        return np.minimum(share / RAMPS[code], 1.0)
    return np.where(np.arange(len(fall)) >= code, fall if code else 1.0, 0.0)


def chance_of(code: int, times: int) -> tuple[float, float]:
    """Return the log prior probability of a fault, and the prior deviation of its size [m].

    `code` is that of `moved_by`, and `times` the number of times at which a clamp may slip.
    """
    if code in RAMPS:
        return float(np.log(DRIFTS / len(RAMPS))), DRIFT
    return float(np.log(SLIPPED / times if code > 0 else MISPLACED / 2.0)), ELSEWHERE


def step_times(law: LinearLaw, covariance: Floats, columns: Sequence[Floats]) -> list[int]:
    """Return the most likely time at which each of several changes in the readings begins.

    Each change lasts to the end, and is fitted jointly with the common unknowns. 0 stands for a
    change that is likelier throughout, or with too few readings on either side of all times.

    Parameters
    ----------
    law : linear law of the times
    covariance : (q, q) prior of the unknowns, with zero mean
    columns : (n, s) change in the readings per metre of its size, each
    """
    inverse = np.linalg.inv(law.normal(law.fixed) + np.linalg.inv(covariance))
    left = law.raw - law.fixed @ (inverse @ law.pulls(law.fixed, law.raw).sum(axis=0))
    heavy = law.weight[:, None, None] * law.inverse
    pull = (heavy @ left[:, :, None])[:, :, 0]
    found = []
    for column in columns:
        moved = (heavy @ column[:, :, None])[:, :, 0]
        crossed = np.einsum("nsq,ns->nq", law.fixed, moved)
        there = (law.known & (column != 0.0)).any(axis=1)
        parts = (column * pull).sum(axis=1), crossed, (column * moved).sum(axis=1), there
        own, cross, alone, after = (np.cumsum(part[::-1], axis=0)[::-1] for part in parts)
        size = np.maximum(alone - np.einsum("nq,qr,nr->n", cross, inverse, cross), 0.0)
        gain = 0.5 * own**2 / (size + ELSEWHERE**-2) - 0.5 * np.log1p(ELSEWHERE**2 * size)
        gain[1:] += np.log(SLIPPED / MISPLACED / len(gain))
        can = (after >= FEWEST) & (there.sum() - after >= FEWEST)
        can[0] = True
        found.append(int(np.where(can, gain, -np.inf).argmax()))
    return found


NORMAL = 1.4826
"""Standard deviation of a normal law over the median of its size."""
FACTORS: Mapping[str, float] = {
    "cable_drag": 0.15, "rigid_drag": 0.15, "buoyancy": 0.02, "length": 0.003
}  # fmt: skip
"""Factors that may be estimated for a whole record, and the prior deviation of their logarithms.

They apply to the drag of cables and chains; the drag of rigid pieces and clamped instruments; the
net force of all buoyant pieces; and the lengths of cables and chains.
"""
DATUM = 0.01
"""Prior deviation of the datum, an error common to all depths, as a share of the water depth."""
OFFSET = 1.0
"""Prior deviation of the offset of a sensor [m]."""
ELSEWHERE, MISPLACED, SLIPPED = 20.0, 0.01, 0.01
"""Prior deviation of the displacement of a slipped or misplaced sensor [m], the probability that it
is misplaced from the start, and the probability that its clamp slips during the record.
"""
MOVED = 0.01
"""Probability that the whole mooring is moved to another depth during the record."""
FALSE: Mapping[int, float] = {0: 0.01, 1: 0.01, 2: 0.03, 3: 0.10, 4: 0.30, 8: 0.10}
"""Probability that a current is false in direction or size, by its quality flag."""
DRIFT, DRIFTS = 5.0, 0.01
"""Prior deviation of the drift over the record [m], and the probability of a drift."""
TIDE = 1.0
"""Deviation of tide and air pressure [m], unless the sea level is given: `RESIDUAL_TIDE`."""
RESIDUAL_TIDE = 0.15
NOISE = 0.2
"""Deviation of a depth from pressure at one time [m]."""
