"""Gaussian-process model of a quantity over depth and time, with scales fitted to the record.

The field is a mean profile plus an anomaly. The correlation of the anomaly is a Matérn function of
order 3/2 along depth, and an exponential function in time. A share of the variance is uncorrelated.

A depth error of an instrument causes an error in its values: depth error times gradient. Such
errors may be the same for all instruments, so the standard deviation of the result includes them in
full. In addition, half of their variance is treated as independent noise of each instrument.

Source: Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, eq. 4.17 and 4.18
(correlation), eq. 2.25 and 2.26 (mean and variance).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError
from calm.gridding.samples import Floats, Samples

NODES = 60  # number of depths of the mean profile
TIMES_FOR_SCALES = 60  # number of times used to fit the scales
TIMES_LEFT_OUT = 240  # number of times at which sensors are left out in turn
BLOCK = 128  # number of times solved together, which limits the memory
SAMPLES_FOR_PROFILE = 30_000  # maximum number of samples used for the mean profile
OWN_SHARE = 0.5  # share of the variance of depth errors that is independent between instruments
REMAINING = 0.5  # share of variance remaining at a level, above which a value is poorly constrained
HALF_WIDTH = 1.96  # half the width of an interval of 95 %, in standard deviations

INTERPOLATED, DOUBTFUL, MISSING = 8, 3, 9  # OceanSITES quality flags of the output


class Scales(NamedTuple):
    """Correlation scales in depth [m] and time [s], and share of uncorrelated variance."""

    depth: float
    time: float
    share: float


@dataclass(frozen=True)
class RecordProfile:
    """Mean and standard deviation of a record, linear between the depths `node` [m]."""

    node: Floats
    mean: Floats
    deviation: Floats

    def mean_at(self, depth: Floats) -> Floats:
        """Interpolate the mean to given depths [m], constant beyond the ends of the record."""
        return np.interp(depth, self.node, self.mean)

    def deviation_at(self, depth: Floats) -> Floats:
        """Interpolate the standard deviation to given depths [m]."""
        return np.interp(depth, self.node, self.deviation)


@dataclass(frozen=True)
class GriddedQuantity:
    """Samples of a quantity, and the parameters of the field fitted to the samples."""

    samples: Samples
    profile: RecordProfile
    scales: Scales
    noise: float  # standard deviation of sensor noise, in the unit of the quantity
    # whether the estimate at a time also uses the samples at the neighbouring times
    in_time: bool = True
    # factor on the standard deviations above the uppermost and below the lowest sensor, from
    # withholding each sensor in turn
    beyond: float = 1.0


class LevelPosterior(NamedTuple):
    """Posterior mean and standard deviation at levels, and the remaining share of the variance."""

    mean: Floats
    deviation: Floats
    left: Floats


class LevelValues(NamedTuple):
    """Values, standard deviations and quality flags, each (n, k) for n times and k levels."""

    value: Floats
    deviation: Floats
    flag: NDArray[np.int8]


def field_of(samples: Samples, noise: float, *, in_time: bool = True) -> GriddedQuantity:
    """Fit a field to the samples of a quantity, with the most likely correlation scales.

    `noise` is the standard deviation of sensor noise; `in_time` is as in `GriddedQuantity`.
    """
    known = np.isfinite(samples.value)
    if int(known.any(axis=0).sum()) < 2:
        raise UsageError("fewer than two instruments of the line have good values")
    profile = profile_of(samples, noise)
    rough = GriddedQuantity(samples, profile, Scales(1.0, 1.0, 0.5), noise, in_time)
    most = np.argsort(-known.sum(axis=1), kind="stable")[: max(len(known) // 2, TIMES_FOR_SCALES)]
    few = np.linspace(0, len(most) - 1, min(TIMES_FOR_SCALES, len(most))).astype(int)
    found = replace(rough, scales=_likeliest(rough, np.unique(np.sort(most)[few])))
    every = max(len(known) // TIMES_LEFT_OUT, 1)
    return replace(found, beyond=_beyond(found, np.arange(0, len(known), every)))


def profile_of(samples: Samples, noise: float) -> RecordProfile:
    """Return the mean and standard deviation of a record as functions of depth.

    The mean is a local linear fit. The standard deviation is at least `noise`.
    """
    known = np.isfinite(samples.value)
    depth, value = samples.depth[known], samples.value[known]
    every = max(len(depth) // SAMPLES_FOR_PROFILE, 1)
    depth, value = depth[::every], value[::every]
    node = np.linspace(depth.min(), depth.max() + 1e-6, NODES)
    width = max(spacing(samples), (node[-1] - node[0]) / NODES)
    off = depth[None, :] - node[:, None]
    far = (off / width) ** 2
    weight = np.exp(-0.5 * (far - far.min(axis=1, keepdims=True)))
    mean, _ = _local_line(weight, off, value[None, :], width)
    square = (value - np.interp(depth, node, mean)) ** 2
    deviation = np.sqrt((weight * square).sum(axis=1) / weight.sum(axis=1))
    return RecordProfile(node, mean, np.maximum(deviation, noise))


def spacing(samples: Samples) -> float:
    """Return the median vertical spacing of the instruments [m], ignoring very small spacings."""
    place = np.sort(np.nanmean(samples.depth[:, np.isfinite(samples.value).any(axis=0)], axis=0))
    apart = np.diff(place)
    wide = apart[apart > 0.2 * (place[-1] - place[0]) / max(len(apart), 1)]
    return float(np.median(wide)) if len(wide) else 1.0


def _local_line(weight: Floats, off: Floats, value: Floats, width: float) -> tuple[Floats, Floats]:
    """Fit weighted straight lines along the last axis; return their values at 0 and slopes."""
    total = np.maximum(weight.sum(axis=-1), 1e-300)
    centre = (weight * off).sum(axis=-1) / total
    mean = (weight * value).sum(axis=-1) / total
    spread = (weight * (off - centre[..., None]) ** 2).sum(axis=-1) / total
    slope = (weight * (off - centre[..., None]) * value).sum(axis=-1) / total
    slope = np.where(spread > (0.1 * width) ** 2, slope / np.maximum(spread, 1e-12), 0.0)
    return mean - slope * centre, slope


class _Block(NamedTuple):
    """For each of n times, the m observations at this time and at the neighbouring times."""

    depth: Floats
    anomaly: Floats
    known: NDArray[np.bool_]
    lag: Floats
    covariance: Floats


def _block(field: GriddedQuantity, times: NDArray[np.int64]) -> _Block:
    samples, profile, scales = field.samples, field.profile, field.scales
    count, sensors = samples.value.shape
    lags = np.array([-1, 0, 1] if field.in_time and count > 1 else [0])
    index = times[:, None] + lags[None, :]
    inside = (index >= 0) & (index < count)
    index = np.clip(index, 0, count - 1)
    shape = len(times), len(lags) * sensors
    since = (samples.time - samples.time[0]) / np.timedelta64(1, "s")
    lag = np.repeat(since[index] - since[times][:, None], sensors, axis=1)
    value, depth, error = (
        table[index].reshape(shape) for table in (samples.value, samples.depth, samples.deviation)
    )
    known = np.isfinite(value) & np.isfinite(depth) & np.repeat(inside, sensors, axis=1)
    depth = np.where(known, depth, profile.node[0])
    whole, place = np.unique(index, return_inverse=True)
    slope, _ = _slopes(samples, whole, samples.depth[whole])
    slope = slope[place.reshape(index.shape)].reshape(shape)
    wrong = np.where(known, np.abs(slope * np.nan_to_num(error)), 0.0)
    spread = profile.deviation_at(depth)
    anomaly = np.where(known, value - profile.mean_at(depth), 0.0)
    both = known[:, :, None] & known[:, None, :]
    matrix = _correlation(depth, depth, lag, lag, scales) * spread[:, :, None] * spread[:, None, :]
    matrix *= both
    own = scales.share * spread**2 + OWN_SHARE * wrong**2 + field.noise**2
    diagonal = np.arange(shape[1])
    matrix[:, diagonal, diagonal] += np.where(known, own, 1.0)
    return _Block(depth, anomaly, known, lag, matrix)


def _slopes(samples: Samples, times: NDArray[np.int64], at: Floats) -> tuple[Floats, Floats]:
    """Estimate gradients and depth errors [m] at depths `at` (n, k), from nearby sensors."""
    depth, value, error = (
        table[times][:, None, :] for table in (samples.depth, samples.value, samples.deviation)
    )
    known = np.isfinite(value) & np.isfinite(depth)
    off = np.where(known, depth, 0.0) - np.nan_to_num(at)[:, :, None]
    width = spacing(samples)
    far = np.where(known, (off / width) ** 2, np.inf)
    nearest = far.min(axis=-1, keepdims=True)
    weight = np.exp(-0.5 * (far - np.where(np.isfinite(nearest), nearest, 0.0)))
    _, slope = _local_line(weight, off, np.where(known, value, 0.0), width)
    wrong = (weight * np.nan_to_num(error)).sum(axis=-1) / np.maximum(weight.sum(axis=-1), 1e-300)
    return slope, wrong


def _correlation(a: Floats, b: Floats, s: Floats, t: Floats, scales: Scales) -> Floats:
    """Return the correlations (n, i, j) between two sets of points in depth and time.

    The first set has depths a and times s, each (n, i). The second set has depths b and times t,
    each (n, j). The correlations are multiplied by the correlated share of the variance.
    """
    far = 3.0**0.5 / scales.depth * np.abs(a[:, :, None] - b[:, None, :])
    apart = np.abs(s[:, :, None] - t[:, None, :]) / scales.time
    return np.asarray((1.0 - scales.share) * (1.0 + far) * np.exp(-far - apart))


def posterior(field: GriddedQuantity, times: NDArray[np.int64], levels: Floats) -> LevelPosterior:
    """Compute the posterior (n, k) at levels (k,) or (n, k) [m], for the n time indices `times`."""
    block = _block(field, times)
    level = np.broadcast_to(np.atleast_2d(levels), (len(times), np.atleast_2d(levels).shape[1]))
    spread = field.profile.deviation_at(level)
    across = _correlation(level, block.depth, np.zeros_like(level), block.lag, field.scales)
    across *= spread[:, :, None] * field.profile.deviation_at(block.depth)[:, None, :]
    across *= block.known[:, None, :]
    sides = np.concatenate([block.anomaly[:, :, None], across.transpose(0, 2, 1)], axis=2)
    found = np.asarray(np.linalg.solve(block.covariance, sides), np.float64)
    mean = field.profile.mean_at(level) + (across @ found[:, :, :1])[..., 0]
    explained = np.einsum("nkm,nmk->nk", across, found[:, :, 1:])
    rest = np.maximum(spread**2 - explained, 0.0)
    slope, wrong = _slopes(field.samples, times, level)
    deviation = np.sqrt(np.maximum(rest, field.noise**2) + (slope * wrong) ** 2)
    return LevelPosterior(mean, deviation, rest / spread**2)


def estimate(field: GriddedQuantity, levels: Floats, times: NDArray[np.int64]) -> LevelValues:
    """Estimate the values of a quantity at levels (k,) [m], for the n time indices `times`.

    A value is flagged as doubtful if it is beyond the sensors or poorly constrained. If both are
    true, the value is missing.
    """
    known = np.isfinite(field.samples.value[times])
    depth = np.where(known, field.samples.depth[times], np.nan)
    upper, lower = (f.reduce(depth, axis=1)[:, None] for f in (np.fmin, np.fmax))
    mean, deviation, left = posterior(field, times, levels)
    between = (levels >= upper) & (levels <= lower)
    little = (left > REMAINING) & (field.profile.deviation_at(levels) > 3.0 * field.noise)
    flag = np.where(between & ~little, INTERPOLATED, DOUBTFUL)
    nothing = little & ~between
    flag = np.where(nothing, MISSING, flag).astype(np.int8)
    deviation = deviation * np.where(between, 1.0, field.beyond)
    value, deviation = (np.where(nothing, np.nan, one) for one in (mean, deviation))
    return LevelValues(value, deviation, flag)


def _likeliest(field: GriddedQuantity, times: NDArray[np.int64]) -> Scales:
    """Find the most likely correlation scales, from the samples at the given time indices.

    The scales have a weak prior. Its medians are a quarter of the depth range of the samples, six
    time steps, and 2 % uncorrelated variance. Its standard deviation is a factor of five for each
    scale.
    """
    from scipy.optimize import minimize

    depth = field.samples.depth[np.isfinite(field.samples.value)]
    step = np.median(np.diff(field.samples.time)) / np.timedelta64(1, "s")
    first = np.log([max(np.ptp(depth) / 4.0, 1.0), 6.0 * step, 0.02])

    def scales_of(at: Floats) -> Scales:
        length, time, share = np.exp(np.clip(at, first - 6.0, first + 6.0))
        return Scales(float(length), float(time), float(share / (1.0 + share)))

    def unlikely(at: Floats) -> float:
        block = _block(replace(field, scales=scales_of(at)), times)
        try:
            root = np.linalg.cholesky(block.covariance)
        except np.linalg.LinAlgError:
            return 1e12
        weighted = np.linalg.solve(block.covariance, block.anomaly[:, :, None])[..., 0]
        fit = 0.5 * (block.anomaly * weighted).sum()
        fit += np.log(np.diagonal(root, axis1=1, axis2=2)).sum()
        return float(fit + 0.5 * (((at - first) / 1.6) ** 2).sum())

    simplex = first + np.vstack([np.zeros(3), 0.7 * np.eye(3)])
    best = minimize(
        unlikely, first, method="Nelder-Mead",
        options={"maxiter": 90, "xatol": 0.03, "fatol": 0.1, "initial_simplex": simplex},
    )  # fmt: skip
    return scales_of(np.asarray(best.x))


def left_out(field: GriddedQuantity, times: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Predict each sensor's values from the other sensors, at the n time indices `times`.

    Return measured minus predicted values (n, s) for s sensors, and their standard deviations. Both
    results are NaN if the sensor has no value at the time, or if no other sensor has a value. The
    values of the predicted sensor at neighbouring times are withheld, too.

    Source: Rasmussen and Williams, eq. 5.12, extended to blocks.
    """
    block = _block(field, times)
    sensors = field.samples.value.shape[1]
    count = block.depth.shape[1] // sensors
    inverse = np.linalg.inv(block.covariance)
    weighted = (inverse @ block.anomaly[:, :, None])[..., 0]
    residual, spread = np.full((2, len(times), sensors), np.nan)
    here = count // 2
    for j in range(sensors):
        own = np.arange(count) * sensors + j
        part = np.linalg.inv(inverse[:, own[:, None], own[None, :]])
        others = block.known.sum(axis=1) > block.known[:, own].sum(axis=1)
        known = block.known[:, own[here]] & others
        off = np.einsum("ni,ni->n", part[:, here], weighted[:, own])
        residual[:, j] = np.where(known, off, np.nan)
        spread[:, j] = np.where(known, np.sqrt(np.maximum(part[:, here, here], 0.0)), np.nan)
    return residual, spread


MIN_RESIDUALS = 20  # minimum number of residuals from which a factor is estimated


def _beyond(field: GriddedQuantity, times: NDArray[np.int64]) -> float:
    """Return the factor with which bands beyond the outermost sensors hold 95 % of predictions."""
    residual, spread = left_out(field, times)
    place = np.where(np.isfinite(residual), field.samples.depth[times], np.nan)
    upper, lower = (f.reduce(place, axis=1)[:, None] for f in (np.fmin, np.fmax))
    off = np.abs(residual / spread) / HALF_WIDTH
    outside = np.isfinite(off) & ((place <= upper) | (place >= lower))
    each = [off[out, j] for j, out in enumerate(outside.T) if out.sum() >= MIN_RESIDUALS]
    return max([1.0, *(float(np.percentile(one, 95.0)) for one in each)])
