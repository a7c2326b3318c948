"""What is common to a record, by closed forms: its memory, its times, its factors."""

from dataclasses import replace

import numpy as np
import pytest

from calm.motion.common_unknowns import repeated
from calm.motion.line_response import with_factors
from calm.motion.measurements import MOST_TIMES, MooringMeasurements, chosen_times
from calm.physics.line import Line


@pytest.mark.parametrize(("memory", "lags"), [(0.6, 24), (0.95, 24), (0.0, 0)])
def test_errors_that_repeat_count_as_one_plus_twice_the_sum_of_their_autocorrelation(memory, lags):
    random = np.random.default_rng(2)
    pull = np.zeros(40_000)
    for step, noise in enumerate(random.standard_normal(len(pull) - 1)):
        pull[step + 1] = memory * pull[step] + noise
    expected = 1.0 + 2.0 * sum(memory**lag for lag in range(1, lags + 1))
    assert repeated(pull + 5.0) == pytest.approx(expected, rel=0.08)


def test_a_constant_pull_and_a_short_one_have_no_memory():
    assert repeated(np.full(50, 3.0)) == 1.0
    assert repeated(np.array([1.0, 2.0, 3.0])) == 1.0
    # of four times as many as a lag it is taken, down to two over the root of their number
    assert repeated(np.repeat([1.0, -1.0], 4)) == pytest.approx(1.0)
    slow = np.repeat([1.0, -1.0], 50)
    assert repeated(slow) == pytest.approx(
        1.0 + 2.0 * sum(1.0 - 0.03 * lag for lag in range(1, 25))
    )


def test_times_with_a_current_and_a_pressure_are_taken_evenly():
    count = 3 * MOST_TIMES
    u = np.full((count, 1), 0.2)
    depth = np.full((count, 2), np.nan)
    depth[:, 1] = 50.0
    u[0], depth[-1] = np.nan, np.nan
    one = MooringMeasurements(
        np.arange(count).astype("M8[s]"), ("a", "b"), np.array([0, 1]), depth, u,
        np.array([-1]), u, 0.0 * u, np.ones(u.shape, np.int8),
    )  # fmt: skip
    taken = chosen_times(one)
    assert (taken[0], taken[-1], len(taken)) == (1, count - 2, MOST_TIMES)
    assert {*np.diff(taken).tolist()} == {3} or {*np.diff(taken).tolist()} == {2, 3}
    few = chosen_times(one.at(slice(0, 5)))
    assert few.tolist() == [1, 2, 3, 4]
    half = replace(one, v=np.full_like(u, np.nan))
    assert not len(chosen_times(half))


def test_a_factor_is_of_what_it_says():
    float_, rope, ballast = 0, 1, 2
    line = Line(
        [1.0, 100.0, 1.0], [False, True, False], [900.0, 0.5, -50.0], [0.0, 0.0, 0.0],
        [20.0, 3.0, 6.0], [10.0, 0.1, 2.0], [False, True, True], [0.0, 1e-6, 0.0], [0.0, 0.5, 0.0],
        [rope, rope], [40.0, 60.0], [-8.0, 12.0], [0.0, 0.0], [5.0, 7.0],
        lift=[2.0, 0.0, 1.0], clamp_lift=[0.5, 0.0],
    )  # fmt: skip
    known = with_factors(
        line, {"cable_drag": 1.1, "rigid_drag": 1.3, "buoyancy": 1.02, "length": 1.003}
    )
    assert known.normal_drag == pytest.approx([20.0 * 1.3, 3.0 * 1.1, 6.0 * 1.3])
    assert known.tangential_drag == pytest.approx([10.0 * 1.3, 0.1 * 1.1, 2.0 * 1.3])
    assert known.lift == pytest.approx([2.0 * 1.3, 0.0, 1.0 * 1.3])
    assert known.clamp_drag == pytest.approx([5.0 * 1.3, 7.0 * 1.3])
    assert known.clamp_lift == pytest.approx([0.5 * 1.3, 0.0])
    assert known.buoyancy == pytest.approx([900.0 * 1.02, 0.5 * 1.02, -50.0])
    assert known.clamp_buoyancy == pytest.approx([-8.0, 12.0 * 1.02])
    assert known.length == pytest.approx([1.0, 100.3, 1.0])
    assert known.clamp_at == pytest.approx([40.0 * 1.003, 60.0 * 1.003])
    assert (with_factors(line, {}).length[[float_, ballast]] == 1.0).all()
