"""Unknowns that are common to a whole record.

The unknowns are factors on the line (drag, buoyancy, lengths), the datum, and the sensor offsets.
The datum is a depth error that all sensors share. The linear model of the readings is also used to
find sensor faults: slips, drifts and common steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from calm.motion.currents_law import SpeedLaw
from calm.physics.line import Floats, Integers

FURTHEST = 1.0  # limit on the logarithm of a factor
REACH = 5.0  # least distance from a sensor to the points that determine the slope of the line [m]


@dataclass(frozen=True)
class Common:
    """Estimate of the q unknowns common to a whole record.

    The order is: logarithms of the factors, datum [m], offsets [m].
    """

    factors: Mapping[str, float]  # names of the estimated factors and their values
    datum: float  # correction added to the depths of the line [m]
    offset: Floats  # (s,) offset of each sensor [m]
    covariance: Floats  # (q, q) covariance of the unknowns
    # error of the line that remains after all corrections, as a share of the knockdown
    worst: float = 0.07
    # prior distribution of the inferred current speeds; None if currents were measured
    law: SpeedLaw | None = None

    @property
    def inferred(self) -> bool:
        """Whether the currents are inferred from the pressures."""
        return self.law is not None

    @property
    def value(self) -> Floats:
        """Values (q,) of the unknowns."""
        logs = np.log(list(self.factors.values()))
        return np.concatenate([logs, [self.datum], self.offset])

    def at(self, value: Floats) -> Common:
        """Return a copy with new values (q,) of the unknowns; extreme factors are clipped."""
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
    """Return the prior of the common unknowns.

    The datum has the mean `mean` and the standard deviation `datum` [m]; offsets have the mean 0.
    """
    known = [FACTORS[name] for name in factors]
    spread = [*known, datum, *[OFFSET] * sensors]
    return Common(factors, mean, np.zeros(sensors), np.diag(np.square(spread)))


def fixed_slopes(common: Floats) -> Floats:
    """Return the derivatives (n, s, q) by all common unknowns, from those by factors (n, s, f)."""
    n, s, _ = common.shape
    offsets = np.broadcast_to(np.eye(s), (n, s, s))
    return np.concatenate([common, np.ones((n, s, 1)), offsets], axis=2)


def fall(depth: Floats, still: Floats, point: Integers) -> Floats:
    """Return the increase (n, s) in the depth of each sensor per metre of slip down the line.

    `depth` (n, p) and `still` (p,) are depths of points [m], `point` (s,) the points of the
    sensors.
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


LONGEST_MEMORY = 25  # maximum number of times over which the error correlation is summed


def repeated(pull: Floats) -> float:
    """Return the number of successive times that share an error, for a series `pull`."""
    one = pull - pull.mean()
    whole = float(one @ one)
    total, chance = 1.0, 2.0 / np.sqrt(max(len(one), 1))
    for lag in range(1, min(LONGEST_MEMORY, len(one) // 4)):
        share = float(one[lag:] @ one[:-lag]) / whole if whole > 0.0 else 0.0
        if share < chance:
            break
        total += 2.0 * share
    return total


FEWEST = 4  # least number of readings of a sensor before and after a slip of its clamp


ROBUST = 4.0  # degrees of freedom of Student's t distribution for the misfit at one time


@dataclass(frozen=True)
class LinearLaw:
    """Linear model of the readings at n times, for the unknowns of the whole record."""

    time: NDArray[np.datetime64]  # (n,) times
    share: Floats  # (n,) share of the record that has elapsed, 0 to 1
    known: NDArray[np.bool_]  # (n, s) whether a reading exists
    raw: Floats  # (n, s) measured minus computed depths [m] if all unknowns are zero
    left: Floats  # (n, s) as `raw`, but with the unknowns at the state of linearisation
    expected: Floats  # (n, s, s) expected covariance of `left` [m²]
    fixed: Floats  # (n, s, q) derivatives of the readings with respect to the unknowns of `Common`
    # (n, s) increase in the depth of each sensor per metre that it slips down the line
    fall: Floats

    @cached_property
    def inverse(self) -> Floats:
        """Inverse (n, s, s) of the covariance `expected` of the residuals."""
        return np.asarray(np.linalg.inv(self.expected), np.float64)

    @cached_property
    def weight(self) -> Floats:
        """Weight (n,) of each time under Student's t distribution, low if the misfit is large."""
        misfit = np.einsum("ns,nst,nt->n", self.left, self.inverse, self.left)
        return np.asarray((ROBUST + self.known.sum(axis=1)) / (ROBUST + misfit))

    def pulls(self, seen: Floats, left: Floats) -> Floats:
        """Return log-likelihood gradients (n, q) for derivatives (n, s, q) and residuals (n, s)."""
        return np.asarray(np.einsum("n,nsq,nst,nt->nq", self.weight, seen, self.inverse, left))

    def normal(self, seen: Floats) -> Floats:
        """Return the (q, q) information matrix of all readings, for derivatives (n, s, q)."""
        heavy = self.weight[:, None, None] * self.inverse
        return np.asarray(np.einsum("nsq,nsr->qr", seen, heavy @ seen))


MISHUNG = -1  # code, instead of a time, of a sensor at a wrong place for the whole record
RAMPS: Mapping[int, float] = {-2: 1.0, -3: 0.3}  # duration of each drift, as a share of the record


def moved_by(code: int, fall: Floats, share: Floats) -> Floats:
    """Return the change (n,) in the readings of a sensor due to a fault of 1 m.

    `fall` and `share` (n,) are as in `LinearLaw`. `code` is 0 for an offset, `MISHUNG` for a wrong
    position on the line, a key of `RAMPS` for a drift, or the time index of a slip.
    """
    if code in RAMPS:
        return np.minimum(share / RAMPS[code], 1.0)
    return np.where(np.arange(len(fall)) >= code, fall if code else 1.0, 0.0)


def chance_of(code: int, times: int) -> tuple[float, float]:
    """Return the log prior probability of the fault `code`, and the deviation of its size [m]."""
    if code in RAMPS:
        return float(np.log(DRIFTS / len(RAMPS))), DRIFT
    return float(np.log(SLIPPED / times if code > 0 else MISPLACED / 2.0)), ELSEWHERE


def step_times(law: LinearLaw, covariance: Floats, columns: Sequence[Floats]) -> list[int]:
    """Return the most likely start of each possible step in the readings, as the index of a time.

    A step lasts to the end of the record. At least `FEWEST` times with readings of the affected
    sensors lie before the start, and as many after it; otherwise, the index is 0.

    Parameters
    ----------
    covariance : (q, q) prior covariance of the common unknowns
    columns : for each possible step, the effect (n, s) of 1 m on the readings
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


NORMAL = 1.4826  # ratio of the standard deviation of a normal variable to its median absolute value
FACTORS: Mapping[str, float] = {
    "cable_drag": 0.15, "rigid_drag": 0.15, "buoyancy": 0.02, "length": 0.003
}  # fmt: skip
"""Factors that may be estimated for a whole record, and the prior deviation of their logarithms.

The factors multiply the drag of cables and chains; the drag of rigid pieces and clamped
instruments; the net buoyancy of all buoyant pieces; and the lengths of cables and chains.
"""
DATUM = 0.01  # prior deviation of the error common to all depths, as a share of the water depth
OFFSET = 1.0  # prior deviation of the offset of a sensor [m]
ELSEWHERE = 20.0  # prior deviation of the displacement of a slipped or misplaced sensor [m]
MISPLACED, SLIPPED = 0.01, 0.01  # prior probabilities of a misplaced sensor and of a slip
MOVED = 0.01  # probability that the whole mooring is moved to another depth during the record
# probability that a current is false in direction or size, by its quality flag
FALSE: Mapping[int, float] = {0: 0.01, 1: 0.01, 2: 0.03, 3: 0.10, 4: 0.30, 8: 0.10}
DRIFT, DRIFTS = 5.0, 0.01  # prior deviation of a drift over the record [m], and its probability
TIDE = 1.0  # deviation of tide and air pressure [m]
# deviation of tide and air pressure that remains if the sea level is given [m]
RESIDUAL_TIDE = 0.15
NOISE = 0.2  # standard deviation of the error of a single depth, measured by a pressure sensor [m]
