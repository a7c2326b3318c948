"""A quantity over depth and time: closed forms of a Gaussian process, and oceans that are known."""

import numpy as np
import pytest

from calm.errors import UsageError
from calm.gridding.field import (
    DOUBTFUL,
    INTERPOLATED,
    MISSING,
    GriddedQuantity,
    RecordProfile,
    Scales,
    estimate,
    field_of,
    left_out,
    posterior,
)
from calm.gridding.samples import Samples

HOUR = np.timedelta64(3600, "s")


def times(count):
    return np.datetime64("2026-01-01", "ns") + np.arange(count) * HOUR


def samples(depth, value, deviation=0.0):
    depth, value = np.atleast_2d(depth).astype(float), np.atleast_2d(value).astype(float)
    labels = tuple(f"s{j}" for j in range(depth.shape[1]))
    return Samples(times(len(depth)), labels, depth, np.full(depth.shape, deviation), value)


FLAT = RecordProfile(np.array([0.0, 1000.0]), np.array([5.0, 5.0]), np.array([2.0, 2.0]))


def matern(distance, length):
    far = np.sqrt(3.0) * distance / length
    return (1.0 + far) * np.exp(-far)


def test_two_points_are_as_in_closed_form():
    # prior variance 4, correlation a between the two and b, c with the level, noise n: by hand
    length, share, noise = 80.0, 0.1, 0.05
    field = GriddedQuantity(
        samples([100.0, 180.0], [6.0, 3.0]), FLAT, Scales(length, 3600.0, share), noise
    )
    mean, spread, left = posterior(field, np.array([0]), np.array([130.0]))
    own = 4.0 + noise**2
    a, b, c = (4.0 * 0.9 * matern(d, length) for d in (80.0, 30.0, 50.0))
    determinant = own**2 - a**2
    first, second = (own * b - a * c) / determinant, (own * c - a * b) / determinant
    assert mean[0, 0] == pytest.approx(5.0 + first * 1.0 + second * -2.0, abs=1e-12)
    assert spread[0, 0] == pytest.approx(np.sqrt(4.0 - first * b - second * c), abs=1e-12)
    assert left[0, 0] == pytest.approx(spread[0, 0] ** 2 / 4.0, abs=1e-12)


def test_a_depth_that_is_not_sure_counts_with_the_gradient():
    # at a sensor of a steep and well sampled profile the band is the depth's times the gradient;
    # at most the half that is each sensor's own is added once more, less what neighbours take off
    depth = np.arange(0.0, 1001.0, 20.0)
    gradient, unsure = 0.01, 8.0
    profile = RecordProfile(np.array([0.0, 1000.0]), np.array([5.0, 5.0]), np.array([3.0, 3.0]))
    values = 5.0 + gradient * (depth - 500.0)
    sure, not_sure = (
        posterior(
            GriddedQuantity(
                samples(depth, values, deviation), profile, Scales(400.0, 3600.0, 1e-6), 1e-4
            ),
            np.array([0]),
            np.array([500.0]),
        )[1][0, 0]
        for deviation in (0.0, unsure)
    )
    assert sure < 0.1 * gradient * unsure
    assert gradient * unsure <= not_sure <= np.sqrt(1.5) * gradient * unsure


def test_far_from_all_sensors_the_band_is_that_of_the_record():
    field = GriddedQuantity(
        samples([100.0, 180.0], [6.0, 3.0]), FLAT, Scales(20.0, 3600.0, 0.1), 0.01
    )
    mean, spread, _ = posterior(field, np.array([0]), np.array([900.0]))
    assert mean[0, 0] == pytest.approx(5.0, abs=1e-6)
    assert spread[0, 0] == pytest.approx(2.0, abs=1e-6)


def test_a_sensor_left_out_is_as_if_it_had_not_been_there():
    random = np.random.default_rng(5)
    depth = np.array([100.0, 160.0, 240.0, 300.0]) + random.normal(0.0, 5.0, (5, 4))
    whole = GriddedQuantity(samples(depth, random.normal(5.0, 1.0, (5, 4))), FLAT,
                  Scales(90.0, 7200.0, 0.05), 0.1)  # fmt: skip
    miss, spread = left_out(whole, np.arange(5))
    for j in range(4):
        others = np.arange(4) != j
        rest = samples(depth[:, others], whole.samples.value[:, others])
        rest = GriddedQuantity(rest, FLAT, whole.scales, 0.1)
        mean, deviation, _ = posterior(rest, np.arange(5), depth[:, [j]])
        assert whole.samples.value[:, j] - mean[:, 0] == pytest.approx(miss[:, j], abs=1e-9)
        assert np.sqrt(deviation[:, 0] ** 2 + 0.1**2) == pytest.approx(spread[:, j], abs=1e-9)


def ocean(count=400, sensors=11, seed=2, unsure=2.0):
    """A thermocline that waves lift, and layers of their own, at sensors of a line knocked down.

    Returns what the sensors measure, at depths that are off by `unsure`, and the field as it is.
    """
    random = np.random.default_rng(seed)
    hour = np.arange(count)
    lift = 15.0 * np.sin(2 * np.pi * hour / 12.4) + 10.0 * np.sin(2 * np.pi * hour / 51.0)
    layers = [(random.uniform(0, 6.3), w, p) for w, p in ((150.0, 37.0), (90.0, 23.0), (60.0, 9.0))]

    def truth(depth):
        depth = np.asarray(depth, float)
        whole = 4.0 + 10.0 / (1.0 + np.exp((depth - 300.0 - lift[:, None]) / 60.0))
        for phase, width, period in layers:
            turn = 2 * np.pi * (depth / (4 * width) + hour[:, None] / period) + phase
            whole = whole + 0.15 * np.sin(turn)
        return whole

    down = 60.0 * np.maximum(np.sin(2 * np.pi * hour / 90.0), 0.0) ** 2
    still = np.linspace(100.0, 600.0, sensors)
    share = (700.0 - still) / 600.0
    depth = still + down[:, None] * share
    value = truth(depth) + random.normal(0.0, 0.003, depth.shape)
    common, own = random.normal(size=(count, 1)), random.normal(size=depth.shape)
    told = depth + unsure * (np.sqrt(0.5) * common + np.sqrt(0.5) * own)
    return samples(told, value, unsure), truth


@pytest.mark.parametrize("seed", [2, 7])
def test_bands_hold_what_a_known_ocean_is(seed):
    measured, truth = ocean(seed=seed)
    field = field_of(measured, 0.003)
    levels = np.arange(100.0, 601.0, 25.0)
    found = estimate(field, levels, np.arange(400))
    off = np.abs(found.value - truth(np.broadcast_to(levels, found.value.shape)))
    sure = found.flag == INTERPOLATED
    assert sure.mean() > 0.8
    covered = (off < 1.96 * found.deviation)[sure].mean()
    # of 7 000 values, not independent: 95 % at the nominal, less by chance, more where cautious
    assert 0.93 <= covered <= 0.999
    # and bands are of use: well below the deviation of the record, 3 degrees in the thermocline
    assert np.median(found.deviation[sure]) < 0.25


def test_it_is_closer_than_lines_between_sensors():
    measured, truth = ocean(sensors=8, unsure=0.5)
    levels = np.arange(150.0, 551.0, 25.0)
    real = truth(np.broadcast_to(levels, (400, len(levels))))
    found = estimate(field_of(measured, 0.003), levels, np.arange(400)).value
    lines = np.array(
        [np.interp(levels, z, y) for z, y in zip(measured.depth, measured.value, strict=True)]
    )
    known = np.isfinite(found)
    misses = [np.sqrt(((one - real)[known] ** 2).mean()) for one in (found, lines)]
    assert misses[0] < 0.7 * misses[1]


def test_nothing_beyond_the_sensors_goes_without_a_flag():
    measured, _ = ocean(count=100)
    found = estimate(field_of(measured, 0.003), np.array([20.0, 350.0, 900.0]), np.arange(100))
    assert (found.flag[:, 1] == INTERPOLATED).all()
    assert np.isin(found.flag[:, [0, 2]], [DOUBTFUL, MISSING]).all()
    assert np.isnan(found.value[found.flag == MISSING]).all()
    assert np.isfinite(found.deviation[found.flag != MISSING]).all()


def test_a_gap_in_time_is_filled_from_its_neighbours_with_a_wider_band():
    measured, truth = ocean(count=200, sensors=6, unsure=0.0)
    place = measured.depth[100, 3]
    value = measured.value.copy()
    value[100, 3] = np.nan
    holed = Samples(measured.time, measured.label, measured.depth, measured.deviation, value)
    bands = []
    for in_time in (True, False):
        field = field_of(holed, 0.003, in_time=in_time)
        mean, spread, _ = posterior(field, np.array([100]), np.array([place]))
        assert abs(mean[0, 0] - truth(np.full((200, 1), place))[100, 0]) < 3.0 * spread[0, 0]
        bands.append(spread[0, 0])
    assert bands[0] < bands[1]


def test_one_instrument_is_too_few():
    with pytest.raises(UsageError, match="fewer than two instruments"):
        field_of(samples([[100.0, 200.0]] * 3, [[5.0, np.nan]] * 3), 0.01)
