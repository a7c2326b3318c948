"""Unknowns common to a whole record: factors on the line, the datum, and where its sensors hang.

The normal prior of an offset, a metre, cannot believe in a clamp that sits ten metres lower: it
would bend the factors and the datum instead. So every way the sensors may hang is a normal prior of
its own: all as the file says, or one or two of them elsewhere, throughout or from the time on at
which their record says so most clearly. The pressures weigh these ways, and the mean and the
covariance of the mixture are taken. Where two sensors cannot tell which of them it is, the
covariance is as wide as that. A sensor may drift instead: its error grows over the record, or
settles early in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, combinations

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

    The q columns of the covariance are the logarithms of the factors, the datum [m], the offsets
    of the sensors [m], and how far down the line they have moved [m].

    Attributes
    ----------
    factors : names of the estimated factors and their values
    datum : what is added to the depths of the line [m]
    offset : (s,) of the sensors [m]
    moved : (s,) how far below its place in the file a sensor hangs, along the line at rest [m]
    since : (s,) the first time at which it does; NaT where it never does
    until : (s,) the time up to which it drifts by `moved`, no clamp having slipped; NaT of others
    covariance : (q, q)
    scale : of the errors of the currents, on those of `calm.motion.common_unknowns`
    gap : (g, g) error of the logarithm of the factor on a group of levels whose currents are taken
        from the others, another group left out besides; see `calm.motion.line_response.gap_errors`
    widened : factor on the deviations of depths, where the pressures miss by more than all errors
    worst : share of the knockdown that the line itself may be wrong by, after all else
    law : of currents that nobody measured; None of measured ones
    """

    factors: Mapping[str, float]
    datum: float
    offset: Floats
    moved: Floats
    since: NDArray[np.datetime64]
    covariance: Floats
    scale: float
    gap: Floats
    widened: float = 1.0
    worst: float = 0.07
    law: SpeedLaw | None = None
    until: NDArray[np.datetime64] | None = None

    @property
    def inferred(self) -> bool:
        """Return whether the currents are inferred from the pressures."""
        return self.law is not None

    @property
    def value(self) -> Floats:
        """Return (q,) as the columns of the covariance stand."""
        logs = np.log(list(self.factors.values()))
        return np.concatenate([logs, [self.datum], self.offset, self.moved])

    @property
    def unmoved(self) -> tuple[Floats, Floats]:
        """Return mean and covariance of all but the moves."""
        fixed = len(self.value) - len(self.moved)
        return self.value[:fixed], self.covariance[:fixed, :fixed]

    def at(self, value: Floats) -> Common:
        """Return the same with other values (q,) of its unknowns, or (q - s,) without moves."""
        count, sensors = len(self.factors), len(self.offset)
        factors = np.exp(np.clip(value[:count], -FURTHEST, FURTHEST)).tolist()
        moved = value[count + 1 + sensors :]
        return replace(
            self,
            factors=dict(zip(self.factors, factors, strict=True)),
            datum=float(value[count]),
            offset=value[count + 1 : count + 1 + sensors],
            moved=moved if len(moved) else self.moved,
        )

    def fall(
        self, time: NDArray[np.datetime64], depth: Floats, still: Floats, point: Integers
    ) -> Floats:
        """Return (n, s) change of the depth of each sensor with how far it has moved; 0 before it
        has.

        Parameters
        ----------
        time : (n,)
        depth, still : (n, p), (p,) of the points, at these times and in still water [m]
        point : (s,) where the sensors are by the file
        """
        result = np.zeros((len(time), len(point)))
        for j, (one, since) in enumerate(zip(point.tolist(), self.since, strict=True)):
            if np.isnat(since):
                continue
            if self.until is not None and not np.isnat(self.until[j]):
                result[:, j] = np.clip((time - since) / (self.until[j] - since), 0.0, 1.0)
                continue
            below = still - still[one]
            upper = int(np.where(below <= -REACH, below, -np.inf).argmax())
            lower = int(np.where(below >= REACH, below, np.inf).argmin())
            upper = upper if below[upper] <= -REACH else one
            lower = lower if below[lower] >= REACH else one
            apart = still[lower] - still[upper]
            share = (depth[:, lower] - depth[:, upper]) / apart if apart > 0.0 else 1.0
            result[:, j] = np.where(time >= since, share, 0.0)
        return result


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
    expected, currents : (n, s, s) covariance of `left`, and that part of it which is the currents'
    fixed : (n, s, q) slopes with factors, datum and offsets
    fall : (n, s) change of the depth of each sensor with how far it has moved throughout
    bent : (n, s, s) covariance of the errors of the line itself, of a share of 1
    """

    time: NDArray[np.datetime64]
    share: Floats
    known: NDArray[np.bool_]
    raw: Floats
    left: Floats
    expected: Floats
    currents: Floats
    fixed: Floats
    fall: Floats
    bent: Floats

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
    mean, covariance : (q,), (q, q) of the unknowns beforehand, without moves
    """
    fall, count = law.fall, len(law.time)
    if not count:
        return np.full(fall.shape[1], NEVER)
    before = np.linalg.inv(covariance)
    inverse = np.linalg.inv(law.normal(law.fixed) + before)
    pull = law.pulls(law.fixed, law.raw).sum(axis=0)
    left = law.raw - law.fixed @ (inverse @ (pull + before @ mean))
    heavy = law.weight[:, None, None] * law.inverse
    pulls = (heavy @ left[:, :, None])[:, :, 0]
    crossed = law.fixed.transpose(0, 2, 1) @ heavy
    single = np.einsum("nss->ns", heavy)

    def gained(own: Floats, cross: Floats, alone: Floats, wide: float) -> Floats:
        size = np.maximum(alone - np.einsum("nqs,qr,nrs->ns", cross, inverse, cross), 0.0)
        gain: Floats = 0.5 * own**2 / (size + wide**-2) - 0.5 * np.log1p(wide**2 * size)
        return gain

    steps = _from_there_on(fall * pulls), _from_there_on(crossed * fall[:, None, :])
    gain = gained(*steps, _from_there_on(fall**2 * single), ELSEWHERE)
    gain[1:] += np.log(SLIPPED / count)
    gain[0] += np.log(MISPLACED)
    after = _from_there_on(law.known.astype(float))
    can = (after >= FEWEST) & (after[:1] - after >= FEWEST)
    can[0] = after[0] >= FEWEST
    gain = np.where(can, gain, -np.inf)
    first: Integers = np.where(can.any(axis=0), gain.argmax(axis=0), NEVER)
    best = gain.max(axis=0) + np.where(first > 0, np.log(count), 0.0)  # of a slip at any time
    for code, part in RAMPS.items():
        ramp = np.minimum(law.share / part, 1.0)[:, None]
        own, cross = (ramp * pulls).sum(axis=0), (crossed * ramp[:, :, None]).sum(axis=0)
        alone = (ramp**2 * single).sum(axis=0)
        chance, wide = chance_of(code, count)
        drift = gained(own[None], cross[None], alone[None], wide)[0]
        better = (drift + chance > best) & (after[0] >= 2 * FEWEST)
        first, best = np.where(better, code, first), np.where(better, drift + chance, best)
    return first


def fits(law: LinearLaw, mean: Floats, covariance: Floats) -> Iterator[tuple[bool, Floats, float]]:
    """Yield the best fits where no sensor hangs elsewhere, and then where one does.

    A slip that is taken for errors of the currents makes these so large, and the times that show
    it so light, that it is never found: so the errors are sought beside each of these.

    Parameters
    ----------
    law, mean, covariance : as of `first_time`

    Yields
    ------
    Whether one does; (n, s) what is left [m]; the logarithm of how likely this is besides.
    """
    count, sensors, fixed = law.fixed.shape
    first = first_time(law, mean, covariance)
    move = moves(first, law.fall, law.share)
    for sensor in (None, *np.flatnonzero(first != NEVER).tolist()):
        seen, spread, odds = law.fixed, covariance, 0.0
        if sensor is not None:
            alone = move * (np.arange(sensors) == sensor)
            seen = np.concatenate([seen, alone[:, :, None]], axis=2)
            spread = np.pad(spread, (0, 1))
            odds, wide = chance_of(int(first[sensor]), count)
            spread[fixed, fixed] = wide**2
        before = np.linalg.inv(spread)
        matrix, pull = law.normal(seen) + before, law.pulls(seen, law.raw)
        found = np.linalg.solve(matrix, pull.sum(axis=0) + before[:, :fixed] @ mean)
        off = found - np.pad(mean, (0, len(found) - fixed))
        odds -= 0.5 * (off @ before @ off + np.linalg.slogdet(matrix @ spread)[1])
        rest = np.where(law.known, law.raw - seen @ found, 0.0)
        yield sensor is not None, rest, float(odds)


def hanging_sensors(
    normal: Floats, pull: Floats, mean: Floats, covariance: Floats, first: Integers,
    times: int, alike: float,
) -> tuple[Floats, Floats]:  # fmt: skip
    """Return mean (q,) and covariance (q, q) over all ways the sensors may hang.

    Parameters
    ----------
    normal, pull : (q, q), (q,) information of the record on the unknowns, moves included
    mean, covariance : (q,), (q, q) beforehand, where every sensor hangs as the file says
    first : (s,) of `first_time`
    times : number of times at which a clamp may slip
    alike : by how much less than `normal` says the record tells where a sensor hangs
    """
    sensors, count = len(first), len(mean)
    offset, moved = count - 2 * sensors, count - sensors
    told = []
    possible = np.flatnonzero(first != NEVER).tolist()
    for way in chain.from_iterable(combinations(possible, size) for size in range(3)):
        spread = covariance.copy()
        chance = 0.0
        for sensor in way:
            likely, wide = chance_of(int(first[sensor]), times)
            spread[moved + sensor, moved + sensor] = wide**2
            chance += likely
            if not first[sensor]:  # its zero may be wrong as well as its place
                spread[offset + sensor, offset + sensor] += ELSEWHERE**2
        free = np.flatnonzero(np.diag(spread) > 0.0)
        part = np.ix_(free, free)
        before = np.linalg.inv(spread[part])
        centre = before @ mean[free]
        known = np.linalg.inv(normal[part] / alike + before)
        drawn = pull[free] / alike + centre
        log = chance + 0.5 * (drawn @ known @ drawn - mean[free] @ centre)
        log += 0.5 * (np.linalg.slogdet(known)[1] + np.linalg.slogdet(before)[1])
        found, whole = np.zeros(count), np.zeros((count, count))
        whole[part] = np.linalg.inv(normal[part] + before)
        found[free] = whole[part] @ (pull[free] + centre)
        told.append((log, found, whole))
    weights = np.exp([log - max(one[0] for one in told) for log, *_ in told])
    weights /= weights.sum()
    centre = np.sum([w * one[1] for w, one in zip(weights, told, strict=True)], axis=0)
    spread = np.zeros((count, count))
    for weight, (_, found, whole) in zip(weights, told, strict=True):
        off = found - centre
        spread += weight * (whole + np.outer(off, off))
    return centre, spread


def _from_there_on(values: Floats) -> Floats:
    """Sums over the first axis from each place to the end."""
    sums: Floats = np.cumsum(values[::-1], axis=0)[::-1]
    return sums


NORMAL = 1.4826
"""Standard deviation of a normal law over the median of its size."""
CURRENT = 0.05
"""Of the factor on the whole current at one time."""
SHEAR = 0.05
"""Of the factor that grows from -1 at the lowest level to 1 at the highest."""
LEVEL: Mapping[int, float] = {0: 0.05, 1: 0.05, 2: 0.07, 3: 0.15, 4: 0.30, 8: 0.20}
"""Of the factor on a single level, by its quality flag."""
STEADY = 0.01
"""What a weak current is wrong by besides [m/s]."""
GAP = 0.25
"""Of the factor on a level whose current is taken from its neighbours, where the record does not
say how alike these are."""
LARGEST = 0.5
"""Of the factor on a single level, at most."""
FALSE: Mapping[int, float] = {0: 0.01, 1: 0.01, 2: 0.03, 3: 0.10, 4: 0.30, 8: 0.10}
"""Probability that a current is false in direction or size, by its quality flag."""
WORSE, ALL_WORSE = 3.0, 0.01
"""All currents of a time are so many times worse than this, and the probability that they are."""

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
DRIFT, DRIFTS = 5.0, 0.01
"""Of what a sensor drifts by over the record [m], and the probability that it does."""
TIDE = 1.0
"""Of tide and air pressure [m]; where the sea level is given, `RESIDUAL_TIDE`."""
RESIDUAL_TIDE = 0.15
NOISE = 0.2
"""Of a depth by pressure at one time [m]."""
SPIKE, SPIKES = 30.0, 1e-5
"""Of a depth that is a spike [m], and the probability that one is."""
