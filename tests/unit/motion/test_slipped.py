"""Where sensors hang, against normal densities written out over all readings at once."""

from dataclasses import fields

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from calm.motion import common_unknowns
from calm.motion.common_unknowns import (
    MISHUNG,
    ROBUST,
    LinearLaw,
    fall,
    moved_by,
    step_times,
)

TIMES, SENSORS = 12, 3
RANDOM = np.random.default_rng(3)
DRAG = RANDOM.uniform(0.0, 30.0, (TIMES, SENSORS)) * [1.0, 0.6, 0.1]
FALL = RANDOM.uniform(0.6, 1.0, (TIMES, SENSORS))
SEEN = np.concatenate(
    [DRAG[:, :, None], np.ones((TIMES, SENSORS, 1)), np.tile(np.eye(SENSORS), (TIMES, 1, 1))], 2
)  # a factor, the datum, three offsets
SHARE = np.linspace(0.0, 1.0, TIMES)
RAMPS = {-2: SHARE, -3: np.minimum(SHARE / 0.3, 1.0)}
ERROR = np.array([[2.0, 0.8, 0.3], [0.8, 1.5, 0.2], [0.3, 0.2, 1.0]])
BEFORE = np.square([0.15, 8.0, 1.0, 1.0, 1.0])


def law_of(raw, known=None, weight=1.0):
    """The law of such readings; each time has the misfit that gives it its weight."""
    known = np.ones((TIMES, SENSORS), bool) if known is None else known
    misfit = (ROBUST + SENSORS) / np.broadcast_to(weight, TIMES) - ROBUST
    left = np.sqrt(misfit / SENSORS)[:, None] * (np.linalg.cholesky(ERROR) @ np.ones(SENSORS))
    error = np.tile(ERROR, (TIMES, 1, 1))
    return LinearLaw(np.arange(TIMES), SHARE, known, raw, left, error, SEEN, FALL)


def read(slipped=None, by=0.0, start=0):
    random = np.random.default_rng(8)
    left = random.multivariate_normal(np.zeros(SENSORS), ERROR, TIMES)
    left += SEEN @ [0.1, 5.0, 0.6, -0.4, 0.3]
    if slipped is not None:
        left[start:, slipped] += by * FALL[start:, slipped]
    return left


def of_sensor(j):
    return FALL * (np.arange(SENSORS) == j)


@pytest.mark.parametrize("start", [0, 5, 8])
@pytest.mark.parametrize("sensor", [0, 2])
def test_the_time_from_which_on_a_sensor_hangs_elsewhere_is_found(sensor, start):
    given = law_of(read(sensor, 15.0, start))
    assert step_times(given, np.diag(BEFORE), [of_sensor(sensor)]) == [start]


def test_an_offset_a_slip_and_a_drift_move_a_reading():
    assert moved_by(0, FALL[:, 1], SHARE) == pytest.approx(np.ones(TIMES))
    assert moved_by(MISHUNG, FALL[:, 1], SHARE) == pytest.approx(FALL[:, 1])
    slipped = np.append(np.zeros(5), FALL[5:, 1])
    assert moved_by(5, FALL[:, 1], SHARE) == pytest.approx(slipped)
    for code, ramp in RAMPS.items():
        assert moved_by(code, FALL[:, 1], SHARE) == pytest.approx(ramp)


def test_the_time_is_the_likeliest_of_all_by_the_densities_written_out():
    random = np.random.default_rng(11)
    before, nothing = np.diag(BEFORE), np.zeros(TIMES * SENSORS)
    weight = random.uniform(0.5, 1.5, TIMES)
    slopes, wide = SEEN.reshape(-1, 5), common_unknowns.ELSEWHERE**2
    error = np.kron(np.diag(1.0 / weight), ERROR)
    known = slopes @ before @ slopes.T + error
    found = []
    for _ in range(60):
        start, by = random.choice([0, 4, 5, 6, 7, 8]), 4.0 * random.standard_normal()
        left = random.multivariate_normal(nothing, known).reshape(TIMES, SENSORS)
        left[start:, 1] += by * FALL[start:, 1]
        likely = {}
        for first in (0, 4, 5, 6, 7, 8):  # four readings on either side
            move = np.where(np.arange(TIMES)[:, None] >= first, of_sensor(1), 0.0).ravel()
            whole = known + wide * np.outer(move, move)
            chance = np.log(common_unknowns.SLIPPED / TIMES if first else common_unknowns.MISPLACED)
            likely[first] = chance + multivariate_normal(nothing, whole).logpdf(left.ravel())
        found += step_times(law_of(left, weight=weight), before, [of_sensor(1)])
        assert found[-1] == max(likely, key=likely.get)
    assert {*found} == {0, 4, 5, 6, 7, 8}


def test_a_sensor_with_few_readings_on_one_side_has_slipped_at_none_of_them():
    known = np.ones((TIMES, SENSORS), bool)
    known[:9, 1], known[:, 2] = False, False
    given = law_of(np.where(known, read(0, 15.0, 10), 0.0), known)
    first = step_times(given, np.diag(BEFORE), [of_sensor(j) for j in range(SENSORS)])
    assert first[0] in range(4, 9) and first[1:] == [0, 0]


def test_a_sensor_that_has_moved_falls_with_the_slope_of_the_line_there():
    still = np.array([100.0, 200.0, 202.0, 300.0])
    depth = np.array([[150.0, 230.0, 231.0, 310.0], [100.0, 200.0, 202.0, 300.0]])
    found = fall(depth, still, np.array([1, 3]))
    # between the nearest points that are 5 m away at least; at an end, from there to the next
    assert found[0] == pytest.approx([(310.0 - 150.0) / 200.0, (310.0 - 231.0) / 98.0])
    assert found[1] == pytest.approx([1.0, 1.0])


def test_the_slope_is_that_between_points_five_metres_away_or_more():
    still = np.array([100.0, 104.9, 105.0, 110.0, 115.0])
    depth = 2.0 * still + np.array([0.0, 9.0, 0.0, 9.0, 0.0])
    middle = fall(depth[None], still, np.array([2]))
    assert middle[0, 0] == pytest.approx((depth[3] - depth[0]) / 10.0)
    assert fall(depth[None, :1], still[:1], np.array([0]))[0, 0] == 1.0


@pytest.mark.parametrize("start", [4, 6, 8])
def test_a_step_of_all_sensors_is_found_at_its_time(start):
    """Also where one reading of each time is lacking."""
    left = read()
    left[start:] += 9.0
    known = np.ones((TIMES, SENSORS), bool)
    known[np.arange(TIMES), np.arange(TIMES) % SENSORS] = False
    for there in (np.ones_like(known), known):
        given = law_of(np.where(there, left, 0.0), there)
        assert step_times(given, np.diag(BEFORE), [np.ones((TIMES, SENSORS))]) == [start]
    few = LinearLaw(*(getattr(given, one.name)[:7] for one in fields(given)))
    assert step_times(few, np.diag(BEFORE), [np.ones((7, SENSORS))]) == [0]
