"""Estimate of what a record has in common: factors on the line, datum, offsets of sensors."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from calm.case import Design
from calm.motion import common_unknowns, line_response
from calm.motion.common_unknowns import RAMPS, ROBUST, Common, LinearLaw
from calm.motion.estimate import CurrentsState, measured_state
from calm.motion.line_response import LineResponse
from calm.motion.measurements import MooringMeasurements, chosen_times
from calm.physics.line import Floats
from calm.solve import expect_many

TURNS, ENOUGH = 12, 0.02
"""Steps of Gauss and Newton at most; fewer where one moves no unknown by more than this share of
its standard deviation."""
SOLVES = 500
"""Moorings whose solving takes as long as laying out all that are tried here."""
SCALES = (0.5, 2.5)
"""Least and greatest factor on the errors of the currents."""
SHARES = (0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.085, 0.1)
USUAL_SHARE, SHARE_KNOWN = 0.07, 0.3
"""Errors of the line that are tried, as shares of the knockdown, the one that is assumed, and the
standard deviation of its logarithm beforehand."""
USUAL, MISSED = (0.8, 0.95), 1.5
"""Shares of the times, the first of which miss usually, and by so much more than is expected where
bands are widened, by what the second share misses."""
SCALE_KNOWN = 0.15
"""Standard deviation of its logarithm beforehand."""
LONGEST_MEMORY = 25
"""Times over which errors that repeat are looked for."""


def assumed(mooring: Design, measured: MooringMeasurements, names: Sequence[str]) -> Common:
    """Return what is common before any pressure is looked at.

    Parameters
    ----------
    mooring : as its file says
    measured : on common times
    names : of the factors that are estimated
    """
    factors = {name: float(np.exp(common_unknowns.FACTORS[name][0])) for name in names}
    moments = LineResponse(measured, line_response.Forward(mooring, factors), {})
    level = moments.levels(np.tile(moments.forward.still, (len(measured.time), 1)))
    gap = line_response.gap_errors(level, measured.u, measured.v, moments.group)
    return common_beforehand(factors, common_unknowns.DATUM * mooring.water.depth, measured, gap)


def common_beforehand(
    factors: Mapping[str, float], datum: float, measured: MooringMeasurements, gap: Floats
) -> Common:
    """Return what is common where all sensors hang as the file says, with what is expected of it.

    Parameters
    ----------
    factors : their values
    datum : standard deviation of what is added to the depths of the line [m]
    measured : by the sensors
    gap : see `Common`
    """
    sensors = len(measured.label)
    known = [common_unknowns.FACTORS[name][1] for name in factors]
    spread = [*known, datum, *[common_unknowns.OFFSET] * sensors, *[0.0] * sensors]
    none, never = np.zeros(sensors), np.full(sensors, "NaT", "M8[ns]")
    return Common(factors, 0.0, none, none, never, np.diag(np.square(spread)), 1.0, gap)


def estimate_common(mooring: Design, measured: MooringMeasurements, names: Sequence[str]) -> Common:
    """Maximum a posteriori by Gauss-Newton; the covariance by Laplace.

    The currents of each time are integrated over, by the slopes at what was measured; the mean of
    the depths is corrected for their curvature. A time of large misfit counts less, by Student's
    law. Where the errors of times that follow each other are alike, they count as fewer.

    Parameters
    ----------
    names : of `calm.motion.line_response.FACTORS`, those that are estimated
    """
    part = measured.at(chosen_times(measured))
    known = assumed(mooring, part, names)
    if not len(part.time):
        return known
    expect_many(SOLVES)
    common, sensors, span = known, len(part.label), measured.time[[0, -1]]
    for _ in range(TURNS):
        moments = LineResponse(part, *line_response.forwards_of(mooring, common))
        fixed = replace(common, covariance=np.zeros_like(known.covariance))
        law = linear_law(moments, common, measured_state(moments, fixed), span)
        if not len(law.time):
            return known
        left, expected, currents, bent = law.left, law.expected, law.currents, law.bent
        begun = replace(known, since=np.full(sensors, span[0]))
        usual = expected + (USUAL_SHARE**2 - common.worst**2) * bent
        scale, likely = _scale(left, usual, currents, common.scale)
        worst = USUAL_SHARE
        if _widened(left, usual + ((scale / common.scale) ** 2 - 1.0) * currents, law.known) == 1.0:
            # of times that miss by more, most would be left to spikes and false currents
            worst = _worst(left, expected, bent, common.worst)
        expected = expected + (worst**2 - common.worst**2) * bent
        scale, likely = _scale(left, expected, currents, common.scale)
        beside, best = 0.0, 0.0
        for moved, rest, odds in common_unknowns.fits(law, *begun.unmoved):
            other, gained = _scale(rest, expected, currents, common.scale)
            if not moved:
                if gained + odds > likely:
                    likely, beside = gained, odds
                continue
            gain = (gained - likely) / _memory(law, rest) + odds - beside
            if gain > best:
                best, scale, left = gain, other, rest
        expected = expected + ((scale / common.scale) ** 2 - 1.0) * currents
        law = replace(law, left=left, expected=expected)
        alike = repeated(law.pulls(law.fixed, left)[:, 0]) if names else 1.0
        before = common.value
        widened = _widened(left, expected, law.known)
        begun = replace(begun, scale=scale, worst=worst, widened=widened)
        common = _placed(begun, law, alike)
        deviation = np.sqrt(np.diag(common.covariance))
        if (np.abs(common.value - before) <= ENOUGH * deviation).all():
            break
    return common


def linear_law(
    moments: LineResponse, common: Common, state: CurrentsState, span: NDArray[np.datetime64]
) -> LinearLaw:
    """Return what the times at which there is an equilibrium say.

    Parameters
    ----------
    state : of the currents
    span : first and last time of the record
    """
    at, found, spread = state.at, state.found, state.way.spread
    part, still, sensors = moments.measured, moments.forward.still, len(moments.measured.label)
    good = np.isfinite(at.depth).all(axis=1)
    time, depth = part.time[good], at.depth[good]
    slope = at.slope[good][:, part.point]
    currents = slope @ spread[good] @ slope.transpose(0, 2, 1)
    bend = np.zeros(currents.shape[:2])
    if not common.inferred:  # of what is computed at the currents as measured
        down = np.maximum(depth[:, part.point] - still[part.point], 1.0)
        bend = 0.5 * np.einsum("nss->ns", currents) / down
    there = np.isfinite(part.depth[good])
    left: Floats = np.where(there, found.innovation[good] - bend, 0.0)
    fixed = fixed_slopes(at.common[good][:, part.point])
    whole = fixed @ common.value[: fixed.shape[2]]
    whole += common.fall(time, depth, still, part.point) * common.moved
    begun = replace(common, since=np.full(sensors, span[0]), until=None)
    return LinearLaw(
        time,
        (time - span[0]) / max(span[1] - span[0], np.timedelta64(1, "ns")),
        there,
        np.where(there, left + whole, 0.0),
        left,
        found.expected[good],
        currents,
        fixed,
        begun.fall(time, depth, still, part.point),
        line_response.own_errors(depth, still, common.inferred)[:, part.point[:, None], part.point],
    )


def fixed_slopes(common: Floats) -> Floats:
    """Return (n, s, q) slopes with factors, datum and offsets by (n, s, f) those with factors."""
    n, s, _ = common.shape
    offsets = np.broadcast_to(np.eye(s), (n, s, s))
    return np.concatenate([common, np.ones((n, s, 1)), offsets], axis=2)


def _widened(left: Floats, expected: Floats, known: NDArray[np.bool_]) -> float:
    """Return by how much the pressures miss more than is expected; 1 where the usual time does not.

    A few times of large misfit are false currents, which are weighed at each time.
    """
    from scipy.stats import chi2

    solved = np.linalg.solve(expected, left[:, :, None])[:, :, 0]
    misfit, count = (left * solved).sum(axis=1), np.maximum(known.sum(axis=1), 1)
    usual, large = (np.quantile(misfit / chi2.ppf(one, count), one) for one in USUAL)
    return float(np.sqrt(max(large, 1.0))) if usual > MISSED else 1.0


def _memory(law: LinearLaw, left: Floats) -> float:
    """Return over how many times in a row the errors of a sensor are the same, at most."""
    sensors = left.shape[1]
    return max(repeated(column) for column in law.pulls(law.fixed, left)[:, -sensors:].T)


def _placed(known: Common, law: LinearLaw, alike: float) -> Common:
    """Return what is common by the linear law of all times, over all ways the sensors may hang.

    Parameters
    ----------
    known : beforehand
    alike : so many times that follow each other have the same error, as far as factors go
    """
    sensors = law.fall.shape[1]
    first = common_unknowns.first_time(law, *known.unmoved)
    gone = common_unknowns.moves(first, law.fall, law.share)
    seen = np.concatenate([law.fixed, gone[:, :, None] * np.eye(sensors)], axis=2)
    normal, pull = law.normal(seen), law.pulls(seen, law.raw).sum(axis=0)
    free = np.linalg.solve(normal + np.eye(len(normal)) / common_unknowns.ELSEWHERE**2, pull)
    longest = _memory(law, law.raw - seen @ free)
    mean, covariance = common_unknowns.hanging_sensors(
        normal / alike, pull / alike, known.value, known.covariance, first, len(law.time),
        max(longest / alike, 1.0),
    )  # fmt: skip
    since, until = known.since, np.full(sensors, "NaT", "M8[ns]")
    if law.share[-1] > 0.0:
        whole = (law.time[-1] - since) / law.share[-1]
        for code, part in RAMPS.items():
            until = np.where(first == code, since + part * whole, until)
    since = np.where(first > 0, law.time[first], since)
    return replace(known.at(mean), since=since, until=until, covariance=covariance)


def _scale(left: Floats, expected: Floats, currents: Floats, scale: float) -> tuple[float, float]:
    """Return the factor on the errors of the currents under which the pressures are most likely.

    And the logarithm of how likely they then are, but for a constant.
    """
    tried = np.linspace(np.log(SCALES[0]), np.log(SCALES[1]), 41)
    likely = []
    for log in tried:
        covariance = expected + (np.exp(2.0 * log) / scale**2 - 1.0) * currents
        likely.append(_student(left, covariance) - 0.5 * (log / SCALE_KNOWN) ** 2)
    best = int(np.argmax(likely))
    return float(np.exp(tried[best])), likely[best]


def _worst(left: Floats, expected: Floats, bent: Floats, worst: float) -> float:
    """Return the error of the line itself under which the pressures are most likely.

    Parameters
    ----------
    expected : (n, s, s) covariance of what is left (n, s) [m]
    bent : (n, s, s) of the errors of the line, of a share of 1
    worst : the share that is in what is expected
    """
    likely = []
    for share in SHARES:
        log = -0.5 * (np.log(share / USUAL_SHARE) / SHARE_KNOWN) ** 2
        likely.append(_student(left, expected + (share**2 - worst**2) * bent) + log)
    return SHARES[int(np.argmax(likely))]


def _student(left: Floats, covariance: Floats) -> float:
    """Return the logarithm of how likely it is that so much is left, by Student's law."""
    misfit = (left * np.linalg.solve(covariance, left[:, :, None])[:, :, 0]).sum(axis=1)
    fit = np.linalg.slogdet(covariance)[1]
    fit += (ROBUST + left.shape[1]) * np.log1p(misfit / ROBUST)
    return float(-0.5 * fit.sum())


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
