"""Where sensors hang, against normal densities written out over all readings at once."""

from dataclasses import fields

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from calm.motion import common_unknowns
from calm.motion.common_unknowns import (
    ROBUST,
    Common,
    LinearLaw,
    chance_of,
    first_time,
    fits,
    hanging_sensors,
    moves,
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
    error, none = np.tile(ERROR, (TIMES, 1, 1)), np.zeros((TIMES, SENSORS, SENSORS))
    return LinearLaw(np.arange(TIMES), SHARE, known, raw, left, error, none, SEEN, FALL, none)


def read(slipped=None, by=0.0, start=0):
    random = np.random.default_rng(8)
    left = random.multivariate_normal(np.zeros(SENSORS), ERROR, TIMES)
    left += SEEN @ [0.1, 5.0, 0.6, -0.4, 0.3]
    if slipped is not None:
        left[start:, slipped] += by * FALL[start:, slipped]
    return left


@pytest.mark.parametrize("start", [0, 5, 8])
@pytest.mark.parametrize("sensor", [0, 2])
def test_the_time_from_which_on_a_sensor_hangs_elsewhere_is_found(sensor, start):
    first = first_time(law_of(read(sensor, 15.0, start)), np.zeros(5), np.diag(BEFORE))
    assert first[sensor] == start


@pytest.mark.parametrize("code", RAMPS)
def test_a_sensor_that_drifts_has_not_slipped(code):
    left = read()
    left[:, 1] += 12.0 * RAMPS[code]
    first = first_time(law_of(left), np.zeros(5), np.diag(BEFORE))
    assert first[1] == code
    column = moves(first, FALL, SHARE)[:, 1]
    assert column == pytest.approx(RAMPS[code])


def test_a_drift_goes_on_to_its_end_and_stays():
    time = np.array(["2026-01-01", "2026-01-02", "2026-01-05", "2026-01-09"], "M8[ns]")
    depth, one = np.array([[100.0, 200.0]] * 4), np.ones(1)
    common = Common(
        {}, 0.0, one, one, time[:1], np.eye(3), 1.0, np.eye(1), until=time[2:3]
    )  # fmt: skip
    fall = common.fall(time, depth, depth[0], np.array([1]))
    assert fall[:, 0] == pytest.approx([0.0, 0.25, 1.0, 1.0])


def test_the_time_is_the_likeliest_of_all_by_the_densities_written_out():
    random = np.random.default_rng(11)
    mean, before = np.array([0.05, 2.0, 0.3, -0.2, 0.1]), np.diag(BEFORE)
    weight = random.uniform(0.5, 1.5, TIMES)
    slopes, wide = SEEN.reshape(-1, 5), common_unknowns.ELSEWHERE**2
    error = np.kron(np.diag(1.0 / weight), ERROR)
    known = slopes @ before @ slopes.T + error
    found = []
    for _ in range(60):
        start, by = random.choice([0, 1, 4, 5, 7, 11]), 4.0 * random.standard_normal()
        left = random.multivariate_normal(slopes @ mean, known).reshape(TIMES, SENSORS)
        left[start:, 1] += by * FALL[start:, 1]
        given = law_of(left, weight=weight)
        likely = {}
        for first in (0, 4, 5, 6, 7, 8):  # four readings on either side
            move = np.zeros((TIMES, SENSORS))
            move[first:, 1] = FALL[first:, 1]
            whole = known + wide * np.outer(move.ravel(), move.ravel())
            chance = np.log(common_unknowns.SLIPPED / TIMES if first else common_unknowns.MISPLACED)
            density = multivariate_normal(slopes @ mean, whole).logpdf(left.ravel())
            likely[first] = chance + density
        for code, ramp in RAMPS.items():
            move = np.zeros((TIMES, SENSORS))
            move[:, 1] = ramp
            whole = known + common_unknowns.DRIFT**2 * np.outer(move.ravel(), move.ravel())
            density = multivariate_normal(slopes @ mean, whole).logpdf(left.ravel())
            likely[code] = np.log(common_unknowns.DRIFTS / 2.0) + density
        start = max((one for one in likely if one >= 0), key=likely.get)
        likely[start] += np.log(TIMES) * (start > 0)  # a drift against a slip at any time
        found.append(first_time(given, mean, before)[1])
        assert found[-1] == max((start, *RAMPS), key=likely.get)
    assert {*found} == {0, 4, 5, 6, 7, 8, *RAMPS}
    none = LinearLaw(*(getattr(given, one.name)[:0] for one in fields(given)))
    assert first_time(none, mean, before).tolist() == [-1, -1, -1]


def test_a_sensor_with_few_readings_on_one_side_has_slipped_at_none_of_them():
    known = np.ones((TIMES, SENSORS), bool)
    known[:9, 1], known[:, 2] = False, False
    left = np.where(known, read(0, 15.0, 10), 0.0)
    first = first_time(law_of(left, known), np.zeros(5), np.diag(BEFORE))
    assert first[0] <= 8 and first[1:].tolist() == [-1, -1]


def test_fits_and_their_odds_come_to_the_densities_written_out():
    mean, covariance = np.array([0.05, 2.0, 0.3, -0.2, 0.1]), np.diag(BEFORE)
    left = read(2, 9.0, 5)
    given, slopes = law_of(left), SEEN.reshape(-1, 5)
    error = np.kron(np.eye(TIMES), ERROR)
    known = slopes @ covariance @ slopes.T + error
    first = first_time(given, mean, covariance)
    found = [*fits(given, mean, covariance)]
    assert first[2] == 5 and [one[0] for one in found] == [False, True, True, True]
    for sensor, (_, rest, odds) in enumerate(found, -1):
        whole, chance = known, 0.0
        if sensor >= 0:
            move = moves(first, FALL, SHARE) * (np.arange(SENSORS) == sensor)
            chance, wide = chance_of(int(first[sensor]), TIMES)
            whole = known + wide**2 * np.outer(move.ravel(), move.ravel())
        density = multivariate_normal(slopes @ mean, whole).logpdf(left.ravel()) + chance
        assert multivariate_normal(None, error).logpdf(rest.ravel()) + odds == pytest.approx(
            density
        )
    gone = np.ones((TIMES, SENSORS), bool)
    gone[3, 1] = False
    assert all(rest[3, 1] == 0.0 for _, rest, _ in fits(law_of(left, gone), mean, covariance))


def test_all_ways_the_sensors_may_hang_count_by_their_densities():
    first = np.array([7, 0, -1])  # from the eighth time on; throughout; never
    left = read(0, 4.0, 7)
    fall = np.where(np.arange(TIMES)[:, None] >= first, FALL, 0.0)
    seen = np.concatenate([SEEN, fall[:, :, None] * np.eye(SENSORS)], 2)
    given = law_of(left)
    mean = np.array([0.02, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    covariance = np.diag([*BEFORE, 0.0, 0.0, 0.0])
    found = hanging_sensors(
        given.normal(seen), given.pulls(seen, left).sum(axis=0), mean, covariance, first, TIMES, 1.0
    )
    slopes, wide = seen.reshape(-1, 8), common_unknowns.ELSEWHERE**2
    told = []
    for way in ((), (0,), (1,), (0, 1)):
        spread, chance = covariance.copy(), 1.0
        if 0 in way:
            spread[5, 5] = wide
            chance *= common_unknowns.SLIPPED / TIMES
        if 1 in way:
            spread[6, 6], spread[3, 3] = wide, spread[3, 3] + wide
            chance *= common_unknowns.MISPLACED
        expected = slopes @ spread @ slopes.T + np.kron(np.eye(TIMES), ERROR)
        density = multivariate_normal(slopes @ mean, expected).pdf(left.ravel())
        gain = spread @ slopes.T @ np.linalg.inv(expected)
        at = mean + gain @ (left.ravel() - slopes @ mean)
        told.append((chance * density, at, spread - gain @ slopes @ spread))
    weights = np.array([one[0] for one in told]) / sum(one[0] for one in told)
    assert 0.05 < weights[1] < 0.95  # neither sure of the slip nor of none
    centre = sum(w * one[1] for w, one in zip(weights, told, strict=True))
    whole = sum(
        w * (one[2] + np.outer(one[1] - centre, one[1] - centre))
        for w, one in zip(weights, told, strict=True)
    )
    assert found[0] == pytest.approx(centre, abs=1e-9)
    assert found[1] == pytest.approx(whole, abs=1e-8)


def test_errors_that_repeat_make_it_less_sure_where_a_sensor_hangs():
    left, first = read(1, 7.0, 7), np.array([-1, 7, -1])
    fall = np.where(np.arange(TIMES)[:, None] >= 7, FALL, 0.0) * [0.0, 1.0, 0.0]
    seen = np.concatenate([SEEN, fall[:, :, None] * np.eye(SENSORS)], 2)
    given = law_of(left)
    law = given.normal(seen), given.pulls(seen, left).sum(axis=0)
    before = np.zeros(8), np.diag([*BEFORE, 0.0, 0.0, 0.0])
    moved = np.diag([*BEFORE, 0.0, common_unknowns.ELSEWHERE**2, 0.0])
    certain, _ = hanging_sensors(*law, before[0], moved, np.full(3, -1), TIMES, 1.0)
    sure, less = (
        hanging_sensors(*law, *before, first, TIMES, alike)[0][6] / certain[6]
        for alike in (1.0, 5.0)
    )
    assert sure > 0.9 > 0.3 > less


def test_a_sensor_that_has_moved_falls_with_the_slope_of_the_line_there():
    still = np.array([100.0, 200.0, 202.0, 300.0])
    depth = np.array([[150.0, 230.0, 231.0, 310.0], [100.0, 200.0, 202.0, 300.0]])
    time = np.array(["2026-01-01", "2026-01-02"], "M8[ns]")
    none = np.zeros(4)
    since = np.array(["2026-01-01", "2026-01-02", "NaT", "2026-01-01"], "M8[ns]")
    common = Common({}, 0.0, none, none, since, np.eye(9), 1.0, np.eye(1))
    fall = common.fall(time, depth, still, np.array([1, 1, 1, 3]))
    # between the nearest points that are 5 m away at least; at an end, from there to the next
    assert fall[0] == pytest.approx([(310.0 - 150.0) / 200.0, 0.0, 0.0, (310.0 - 231.0) / 98.0])
    assert fall[1] == pytest.approx([1.0, 1.0, 0.0, 1.0])


def test_the_slope_is_that_between_points_five_metres_away_or_more():
    still = np.array([100.0, 104.9, 105.0, 110.0, 115.0])
    depth = 2.0 * still + np.array([0.0, 9.0, 0.0, 9.0, 0.0])
    time = np.array(["2026-01-01"], "M8[ns]")
    none = np.zeros(1)
    common = Common({}, 0.0, none, none, time, np.eye(3), 1.0, np.eye(1))
    middle = common.fall(time, depth[None], still, np.array([2]))
    assert middle[0, 0] == pytest.approx((depth[3] - depth[0]) / 10.0)
    alone = common.fall(time, depth[None, :1], still[:1], np.array([0]))
    assert alone[0, 0] == 1.0
