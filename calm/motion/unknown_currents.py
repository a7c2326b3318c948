"""Estimation of unmeasured currents from the pressures of a record.

The unknowns at each time are the speeds at a few depths (interpolation knots). The direction has no
effect on the depths, and is the same at all knots. The logarithms of the speeds have a normal
distribution, learnt from the record by expectation and maximisation (Dempster, Laird and Rubin
1977). Each time is fitted by Gauss-Newton steps under this distribution.

The line itself has an error that varies smoothly along its length, and is a share of the knockdown.
The share is estimated from the pressures.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Design
from calm.errors import UsageError
from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import Common, common_beforehand, fixed_slopes, repeated
from calm.motion.currents_law import Linear, ReadCurrents, SpeedLaw
from calm.motion.line_response import Forward, LineResponse
from calm.motion.measurements import FREE, MooringMeasurements
from calm.physics.line import Floats, Integers

KNOTS, FINER = 6, 2.2  # number of knots, and the exponent of their spacing, finer near the top
DOWN = 0.9  # share of the times at which the top of the line is at or above the uppermost knot
# prior speed: at the top [m/s], decay depth [m] (the scale of the thermocline), constant [m/s]
SURFACE, DECAY, LEAST = 0.3, 400.0, 0.03
# deviations of the logarithm of the prior speed: of the part common to all knots, and of the part
# for each knot; and the share of the knots over which the second part is correlated
ALL, EACH, ALIKE = 0.7, 1.4, 0.5
PRIOR = 20.0  # weight of the prior distribution, as a number of times of the record
MOST_TIMES = 240  # number of times from which the distribution is learnt
# number of iterations, and of first iterations that leave the distribution unchanged
TURNS, FIRST = 12, 2
# share of the learning times from which the distribution is updated: those with the largest
# knockdown, because the tide hides the effect of the currents at the other times
STRONGER = 0.5
LONGEST = 1.0  # maximum step of a logarithm
SHARES = (0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4)  # trial errors of the line
USUAL, WITHIN = 0.07, 0.7  # prior median of the error share, and the deviation of its logarithm
# prior deviation of the datum, as a share of the water depth; small, because without measured
# currents the factor on the length absorbs larger errors
SEABED = 0.0005
LEAST_PART = 5.0  # percentile taken as the shallowest depth of a sensor
# height of a sensor above its still-water depth that counts as an error of the file [m], and the
# uncertainty of this error, as a share
HIGH, HIGH_KNOWN = 3.0, 0.1
AGAIN = 3  # number of iterations for each time, starting from a stored fit


@dataclass(frozen=True)
class Posterior:
    """Posterior of the currents, given the pressures."""

    logs: Floats  # (n, g) logarithms of the factors on the currents, relative to the prior mean
    sea: Floats  # (n,) height of the sea surface above its mean [m]
    depth: Floats  # (n, p) depths of the points [m]
    variance: Floats  # (n, p) variances of these depths [m²]
    evidence: Floats  # (n,) log probability density of the measured depths
    innovation: Floats  # (n, s) measured minus predicted depths [m]
    expected: Floats  # (n, s, s) covariance of the innovation [m²]


@dataclass(frozen=True)
class CurrentsState:
    """Currents at several times, with the linearised line and the posterior at these currents."""

    read: ReadCurrents
    at: Linear
    found: Posterior


def posterior(
    one: MooringMeasurements, at: Linear, spread: Floats, common: Common, still: Floats
) -> Posterior:
    """Return the posterior of currents and depths, given the measured depths in `one`.

    `at` is the linear model of the line. `spread` (g, g) is the prior covariance of the logarithms
    of the g factors on the currents. `still` (p,) are the depths of the points in still water [m].
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
    own = common.worst**2 * line_response.own_errors(at.depth, still, common.inferred)
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
    variance = np.maximum(whole - taken, 0.0)
    evidence = np.where(lost, -np.inf, -0.5 * (misfit + size))
    sea = gain[:, g] + surface
    return Posterior(gain[:, :g], sea, depth, variance, evidence, innovation, expected)


def with_knots(measured: MooringMeasurements, mooring: Design) -> MooringMeasurements:
    """Return the measurements with interpolation knots of unknown current as levels."""
    still, seabed = Forward(mooring, {}).still, float(mooring.water.depth)
    # the uppermost knot is at the top of the line in strong currents, because pressures contain no
    # information on the current above
    sensor = int(np.argmin(still[measured.point]))
    depth = measured.depth[:, sensor] - measured.moved
    down = float(np.nanquantile(depth, DOWN)) - still[measured.point[sensor]]
    top = max(float(still.min()), 0.0) + max(down, 0.0)
    knots = top + (seabed - top) * np.linspace(0.0, 1.0, KNOTS) ** FINER
    shape = len(measured.time), KNOTS
    return replace(
        measured,
        level_depth=np.broadcast_to(knots, shape).copy(),
        level_point=np.full(KNOTS, FREE, np.int64),
        u=np.full(shape, np.nan),
        v=np.full(shape, np.nan),
        flag=np.zeros(shape, np.int8),
    )


def assumed_law(measured: MooringMeasurements) -> tuple[Floats, Floats]:
    """Return prior mean (k,) and covariance (k, k) of the logarithms of speed [m/s] at k knots."""
    knots = measured.level_depth[0]
    mean = np.log(SURFACE * np.exp(-(knots - knots[0]) / DECAY) + LEAST)
    place = np.linspace(0.0, 1.0, len(knots))
    near = np.exp(-np.abs(place[:, None] - place) / ALIKE)
    return mean, ALL**2 + EACH**2 * near


def learn_currents(
    mooring: Design,
    measured: MooringMeasurements,
    names: Sequence[str],
    tell: Callable[[str], None] = lambda _: None,
) -> Common:
    """Estimate the distribution of the current speeds jointly with the common unknowns.

    The levels of `measured` are interpolation knots, `names` are the factors to estimate, and
    `tell` receives progress messages. Raise UsageError if no equilibrium fits the pressures.
    """
    part = measured.at(_chosen(measured))
    mean, covariance = assumed_law(part)
    high = raised(mooring, part)
    datum = max(SEABED * float(mooring.water.depth), HIGH_KNOWN * abs(high))
    begun = common_beforehand(dict.fromkeys(names, 1.0), datum, len(part.label), high)
    begun = replace(begun, worst=USUAL)
    common, logs = begun, np.zeros((len(part.time), KNOTS))
    at = None
    before = covariance.copy()
    nothing = np.zeros_like(begun.covariance)
    reach = np.ones(len(part.time))
    down = np.nansum(part.depth - part.moved[:, None], axis=1)
    used = np.flatnonzero(down >= np.quantile(down, 1.0 - STRONGER))
    for turn in range(TURNS):
        tell(f"inferring the currents from the pressures: {turn + 1} of {TURNS}")
        moments = LineResponse(part, *line_response.forwards_of(mooring, common))
        fit = _Fit(moments, replace(common, covariance=nothing), SpeedLaw(mean, covariance))
        if at is None:
            at = fit.linear(logs)
        else:  # slopes change little
            at = replace(at, logs=logs, depth=moments.depths(fit.read, logs))
        if not np.isfinite(at.depth).any():
            raise UsageError(
                "--pressures: no equilibrium of the line fits the pressures of "
                f"{', '.join(part.label)}. Check the labels of the sensors, the lengths of the "
                "line and the water depth"
            )
        found = fit.posterior(at)
        tried = logs + reach[:, None] * np.clip(found.logs - logs, -LONGEST, LONGEST)
        ahead = fit.linear(tried)
        better = fit.misfit(ahead) <= fit.misfit(at) + 1e-6
        logs = np.where(better[:, None], tried, logs)
        reach = np.where(better, np.minimum(1.0, 2.0 * reach), reach / 3.0)
        at = _either(better, ahead, at)
        found = fit.posterior(at)
        if turn < FIRST:
            continue
        common = _worst(fit, at, common, used)
        common = _placed(begun, replace(common, covariance=nothing), fit, at, found)
        if turn == TURNS - 1:
            break
        mine = logs[used]
        seen = at.slope[used][:, part.point]
        taken = covariance @ seen.transpose(0, 2, 1)
        left = covariance - taken @ np.linalg.solve(found.expected[used], taken.transpose(0, 2, 1))
        centre = mine.mean(axis=0)
        spread = np.einsum("nk,nl->kl", mine - centre, mine - centre) + left.sum(axis=0)
        covariance = (spread + PRIOR * before) / (len(mine) + PRIOR)
        mean, logs = mean + centre, logs - centre
    return replace(common, law=SpeedLaw(mean, covariance, _with_mean(fit, at)))


def raised(mooring: Design, measured: MooringMeasurements) -> float:
    """Return the largest error of a sensor that reads above its depth in still water [m].

    Currents can only lower a line. Such a reading therefore shows that the water depth, a length or
    a position in the mooring file is wrong. The result is negative, or 0 if the error is small.
    """
    depth = measured.depth - measured.moved[:, None]
    known = np.isfinite(depth).any(axis=0)
    least = np.nanpercentile(depth[:, known], LEAST_PART, axis=0)
    high = float((least - Forward(mooring, {}).still[measured.point[known]]).min(initial=0.0))
    return high if high < -HIGH else 0.0


@dataclass(frozen=True)
class _Fit:
    """Posterior of the currents at the times used for learning, with one trial prior, `law`."""

    moments: LineResponse
    common: Common
    law: SpeedLaw

    @property
    def read(self) -> ReadCurrents:
        return self.law.read(self.moments.measured.level_depth)

    def linear(self, logs: Floats) -> Linear:
        return self.moments.linear(self.read, logs)

    def posterior(self, at: Linear, common: Common | None = None) -> Posterior:
        one, still = self.moments.measured, self.moments.forward.still
        return posterior(one, at, self.law.covariance, common or self.common, still)

    def misfit(self, at: Linear) -> Floats:
        """Return (n,) twice the negative logarithm of the posterior density at `at.logs`."""
        one, point = self.moments.measured, self.moments.measured.point
        found = self.posterior(at)
        seen = at.slope[:, point]
        rest = found.expected - seen @ self.law.covariance @ seen.transpose(0, 2, 1)
        there = at.depth[:, point] + self.common.datum + self.common.offset + one.surface[:, None]
        left = np.where(np.isfinite(one.depth), one.depth - there, 0.0)
        size = np.linalg.slogdet(rest)[1]
        bent = np.einsum("ns,ns->n", left, np.linalg.solve(rest, left[:, :, None])[:, :, 0])
        own = np.einsum("nk,kl,nl->n", at.logs, np.linalg.inv(self.law.covariance), at.logs)
        return np.asarray(np.nan_to_num(bent + own + size, nan=np.inf))


def _either(first: NDArray[np.bool_], one: Linear, other: Linear) -> Linear:
    both = zip(vars(one).values(), vars(other).values(), strict=True)
    return Linear(*(np.where(first.reshape(-1, *[1] * (a.ndim - 1)), a, b) for a, b in both))


def _with_mean(fit: _Fit, at: Linear | None) -> Linear:
    assert at is not None
    moments, one = fit.moments, fit.moments.measured.at(slice(0, 1))
    alone = LineResponse(one, moments.forward, moments.shifted)
    first = replace(fit, moments=alone).linear(np.zeros((1, KNOTS)))
    both = zip(vars(first).values(), vars(at).values(), strict=True)
    return Linear(*(np.concatenate(pair) for pair in both))


def _chosen(measured: MooringMeasurements) -> Integers:
    """Return times with the most pressures, spread evenly over the measured depths."""
    known = np.isfinite(measured.depth)
    count = known.sum(axis=1)
    used = np.flatnonzero(count == count.max())
    order = used[np.argsort(measured.depth[used].sum(axis=1, where=known[used]), kind="stable")]
    if len(order) > MOST_TIMES:
        order = order[np.linspace(0, len(order) - 1, MOST_TIMES).round().astype(np.int64)]
    return np.sort(order)


def _worst(fit: _Fit, at: Linear, common: Common, used: Integers) -> Common:
    """Estimate the relative error of the line: root mean square of trial values by probability."""
    now, log = fit.posterior(at), []
    white = np.linalg.solve(np.linalg.cholesky(now.expected), now.innovation[:, :, None])
    alike = max(repeated(column) for column in white[:, :, 0].T)
    for share in SHARES:
        found = fit.posterior(at, replace(fit.common, worst=share))
        beside = -0.5 * (np.log(share / USUAL) / WITHIN) ** 2
        known = found.evidence[used]
        log.append(float(known[np.isfinite(known)].sum()) / alike + beside)
    weight = np.exp(np.array(log) - max(log))
    return replace(common, worst=float(np.sqrt(weight @ np.square(SHARES) / weight.sum())))


def _placed(begun: Common, known: Common, fit: _Fit, at: Linear, found: Posterior) -> Common:
    """Return factors, datum and offsets after a Gauss-Newton step, and their covariance."""
    seen = fixed_slopes(at.common[:, fit.moments.measured.point])
    inverse = np.linalg.inv(found.expected)
    pulls = np.einsum("nsq,nst,nt->nq", seen, inverse, found.innovation)
    alike = repeated(pulls[:, len(begun.factors)])
    before = np.linalg.inv(begun.covariance)
    now = known.value
    normal = np.einsum("nsq,nst,ntr->qr", seen, inverse, seen) / alike + before
    step = np.linalg.solve(normal, pulls.sum(axis=0) / alike - before @ (now - begun.value))
    value = now + np.clip(step, -5.0, 5.0)
    return replace(known.at(value), covariance=np.linalg.inv(normal))


def unknown_state(moments: LineResponse, common: Common) -> CurrentsState:
    """Find the most likely currents at each time, starting from the nearest stored model."""
    law, one = common.law, moments.measured
    assert law is not None and law.kept is not None
    read, kept, still = law.read(one.level_depth), law.kept, moments.forward.still
    offset = common.offset + common.datum
    depth = one.depth - one.moved[:, None]
    off = np.nan_to_num(depth[:, None, :] - offset - kept.depth[None, :, one.point])
    near = np.square(off).sum(axis=2).argmin(axis=1) if len(one.label) else 0
    near = np.where(np.isfinite(one.depth).any(axis=1), near, 0)
    at = Linear(*(part[near] for part in vars(kept).values()))
    found = posterior(one, at, law.covariance, common, still)
    for _ in range(AGAIN):
        logs = at.logs + np.clip(found.logs - at.logs, -LONGEST, LONGEST)
        there = moments.depths(read, logs)
        lost = np.isnan(there).any(axis=1, keepdims=True)
        at = at.moved(np.where(lost, at.logs, logs), np.where(lost, at.depth, there))
        found = posterior(one, at, law.covariance, common, still)
    return CurrentsState(read, at, found)
