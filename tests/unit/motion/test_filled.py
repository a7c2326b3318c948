"""What is taken from neighbours, and how wrong the record says that is."""

import numpy as np
import pytest

from calm.motion import common_unknowns
from calm.motion.line_response import filled, gap_errors

LEVEL = np.array([0.0, 100.0, 200.0, 300.0])


def test_levels_are_linear_between_the_others_and_constant_beyond():
    known = np.array([[False, True, False, True]])
    found = filled(LEVEL[None], np.array([[9.0, 1.0, 9.0, 3.0]]), known)
    assert found == pytest.approx(np.array([[1.0, 1.0, 2.0, 3.0]]))


@pytest.mark.thorough
def test_errors_of_neighbours_are_those_of_the_record():
    # linear in depth but for a factor on the second level, whose logarithm is normal: 0.3
    random = np.random.default_rng(1)
    times = 4000
    profile = random.uniform(0.5, 1.0, (times, 1)) * np.array([1.0, 0.9, 0.8, 0.7])
    profile[:, 1] *= np.exp(0.3 * random.standard_normal(times))
    level, turned = np.tile(LEVEL, (times, 1)), 0.6 * profile
    errors = gap_errors(level, 0.8 * profile, turned, np.arange(4))
    # of the second: itself, also where a third is left out; of the third, half of it
    assert errors[1, [1, 2, 3]] == pytest.approx(0.3, rel=0.08)
    assert errors[2, 2] == pytest.approx(0.17, rel=0.15)
    assert errors[3, 1] == pytest.approx(np.log(0.8 / 0.7) * 1.4826, rel=0.05)


def test_the_median_departure_from_the_neighbours_in_stronger_currents_is_the_error():
    # the second level is off the others by factors of one size, in weak currents by a larger one
    times, offset = 40, common_unknowns.STEADY
    level = np.tile(LEVEL, (times, 1))
    speed = np.where(np.arange(times) < times // 2, 0.8, 0.2)[:, None] * np.ones(4)
    size = np.where(np.arange(times) < times // 2, 0.3, 1.0)
    sign = (-1.0) ** np.arange(times)
    speed[:, 1] = (speed[:, 0] + offset) * np.exp(sign * size) - offset
    errors = gap_errors(level, 0.6 * speed, 0.8 * speed, np.arange(4))
    assert errors.shape == (4, 4)
    assert errors[1] == pytest.approx(1.4826 * 0.3)  # whichever is left out besides
    assert errors[3, 1] == errors[0, 1] == common_unknowns.LEVEL[1]


def test_few_times_say_nothing_and_equal_levels_are_not_without_error():
    same = np.full((19, 4), 0.4)
    level = np.tile(LEVEL, (19, 1))
    assert (gap_errors(level, same, same, np.arange(4)) == common_unknowns.GAP).all()
    many = [np.repeat(one, 2, axis=0) for one in (level, same, same)]
    assert (gap_errors(*many, np.arange(4)) == common_unknowns.LEVEL[1]).all()


@pytest.mark.parametrize("gap", [0, 1, 2])
def test_times_with_a_gap_in_any_of_depth_u_and_v_say_nothing_of_neighbours(gap):
    # every second time would say that the second level is ten times as fast
    speed = np.tile([0.8, 0.7, 0.6, 0.5], (60, 1))
    speed[::2, 1] *= 10.0
    given = [np.tile(LEVEL, (60, 1)), speed, speed.copy()]
    given[gap][::2, 3] = np.nan
    assert gap_errors(*given, np.arange(4))[1, 1] == common_unknowns.LEVEL[1]
