"""How well depths agree, by figures worked out by hand."""

import numpy as np
import pytest

from calm.motion.remarks import agreement, calm_times, coverage, difference, linear, pchip, rms

EVERY = np.ones(20, bool)


def test_the_calm_times_are_the_tenth_with_the_least_knockdown():
    down = np.array([*range(20, 0, -1)], float)
    assert np.flatnonzero(calm_times(down, EVERY)).tolist() == [18, 19]
    down[19] = np.nan
    assert np.flatnonzero(calm_times(down, EVERY)).tolist() == [17, 18]
    assert np.flatnonzero(calm_times(down, EVERY & (down > 15))).tolist() == [4]
    assert not calm_times(down, ~EVERY).any()


def test_a_constant_offset_is_no_error_of_motion():
    measured = np.linspace(100.0, 119.0, 20)
    computed = measured + 3.0
    computed[10:] += 2.0
    calm = np.arange(20) < 2
    off = difference(computed, measured, calm, EVERY)
    assert off[0] == 0.0 and off[-1] == 2.0
    assert rms(off) == pytest.approx(np.sqrt(2.0))
    found = agreement(computed, measured, calm, EVERY)
    assert (found.count, found.bias) == (20, pytest.approx(4.0))
    assert found.rms == pytest.approx(np.sqrt(2.0))
    assert found.slope == pytest.approx(np.polyfit(measured, computed, 1)[0])
    assert found.r == pytest.approx(np.corrcoef(measured, computed)[0, 1])


def test_the_slope_is_that_of_computed_on_measured():
    measured = np.array([1.0, 2.0, 4.0])
    assert agreement(2.0 * measured, measured, measured < 2.0, measured > 0.0).slope == 2.0


def test_times_count_that_have_both():
    measured = np.array([1.0, 2.0, 4.0, np.nan, 7.0, 9.0])
    computed = np.array([1.0, 4.0, 8.0, 5.0, np.nan, 50.0])
    among = np.arange(6) < 5
    found = agreement(computed, measured, measured < 2.0, among)
    assert (found.count, found.bias) == (3, pytest.approx(2.0))
    assert found.rms == pytest.approx(np.sqrt((4.0 + 16.0) / 3.0))


def test_coverage_is_of_the_times_with_a_deviation():
    off, deviation = np.array([0.0, -1.96, 2.0, 5.0, 1.0]), np.array([1.0, 1.0, 1.0, 1.0, np.nan])
    assert coverage(off, deviation) == 0.5
    assert np.isnan(coverage(off[:0], deviation[:0]))


def test_interpolation_is_linear_by_height_between_the_nearest_sensors():
    still = np.array([100.0, 150.0, 200.0, 250.0, 400.0])
    point, depth = np.array([4, 0, 2]), np.array([[402.0, 130.0, 220.0]])
    assert linear(depth, point, still, 1) == 175.0  # half of the way from 130 to 220
    assert linear(depth, point, still, 3) == pytest.approx(220.0 + 0.25 * 182.0)
    assert linear(depth[:, :1], point[:1], still, 1) == 152.0  # one moves all of it alike
    upper = np.array([0, 1, 2]), np.array([[130.0, 170.0, 220.0]])
    assert linear(upper[1], upper[0], still, 4) == pytest.approx(220.0 + 200.0)  # the slope goes on
    assert linear(upper[1][:, 1:], upper[0][1:], still, 0) == pytest.approx(170.0 - 50.0)


def test_pchip_is_of_the_knockdown_and_the_anchor_is_a_point():
    still = np.array([100.0, 300.0, 600.0, 900.0])
    depth = np.array([[150.0, 620.0], [100.0, 600.0], [np.nan, 600.0]])
    found = pchip(depth, np.array([0, 2]), still, 1)
    # Fritsch and Carlson's slopes at 0, 300 and 800 m of height, of knockdowns 0, 20 and 50 m:
    # a weighted harmonic mean inside, at the top a parabola's
    first, second = 20.0 / 300.0, 30.0 / 500.0
    one, two = 2.0 * 500.0 + 300.0, 500.0 + 2.0 * 300.0
    inner = (one + two) / (one / first + two / second)
    top = ((2.0 * 500.0 + 300.0) * second - 500.0 * first) / 800.0
    t = (600.0 - 300.0) / 500.0
    hermite = (
        20.0 * (2 * t**3 - 3 * t**2 + 1) + 50.0 * (3 * t**2 - 2 * t**3)
        + 500.0 * (inner * (t**3 - 2 * t**2 + t) + top * (t**3 - t**2))
    )  # fmt: skip
    assert found[0] == pytest.approx(300.0 + hermite)
    assert found[1] == pytest.approx(300.0) and np.isnan(found[2])
