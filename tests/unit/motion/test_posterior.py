"""What pressures make of the currents, against the same law written out in full."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion import common_unknowns
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear
from calm.motion.estimate import posterior
from calm.motion.line_response import LineResponse, between, own_errors
from calm.motion.measurements import MooringMeasurements

STILL = np.array([50.0, 100.0, 180.0])  # of three points; the first and the last have sensors
THERE = np.array([80.0, 120.0, 185.0])
SLOPE = np.array([[30.0, 15.0], [12.0, 14.0], [1.0, 4.0]])
COMMON = np.array([[20.0], [15.0], [4.0]])
SPREAD = np.array([[0.02, 0.004], [0.004, 0.01]])
READ = np.array([93.0, 186.5])
FALL = (185.0 - 120.0) / (180.0 - 100.0)  # of the line at the second sensor
SINCE = "2026-02-28"  # it has moved before the time


def given(tide=None):
    one = MooringMeasurements(
        np.array(["2026-03-01"], "M8[ns]"), ("a", "c"), np.array([0, 2]), READ[None],
        np.zeros((1, 2)), np.array([-1, -1]), np.zeros((1, 2)),
        np.zeros((1, 2)), np.zeros((1, 2), np.int8), tide,
    )  # fmt: skip
    covariance = np.diag([0.1, 0.8, 0.5, 0.6, 0.0, 0.9]) ** 2  # factor, datum, offsets, steps
    common = Common(
        {"cable_drag": 1.1}, 0.4, np.array([0.3, -0.2]), np.array([0.0, 0.7]),
        np.array(["NaT", SINCE], "M8[ns]"), covariance, 1.0, np.eye(2),
    )  # fmt: skip
    at = Linear(np.array([[0.05, -0.02]]), THERE[None], SLOPE[None], COMMON[None])
    return one, at, common


@pytest.mark.parametrize("tide", [None, np.array([0.7])])
def test_the_posterior_is_that_of_all_unknowns_written_out(tide):
    one, at, common = given(tide)
    found = posterior(one, at, SPREAD[None], common, STILL)
    # unknowns: two logarithms, sea, factor, datum, two offsets, two steps, three errors of the line
    sea = common_unknowns.TIDE if tide is None else common_unknowns.RESIDUAL_TIDE
    down = 0.07 * (THERE - STILL)
    alike = np.exp(-np.abs(STILL[:, None] - STILL[None]) / (0.25 * np.ptp(STILL)))
    # the law is of the exponential kind only between a point and a sensor
    bent = np.outer(down, down) * alike
    covariance = np.zeros((12, 12))
    covariance[:2, :2], covariance[2, 2] = SPREAD, sea**2
    covariance[3:9, 3:9], covariance[9:, 9:] = common.covariance, bent
    depth = np.hstack(
        [SLOPE, np.ones((3, 1)), COMMON, np.ones((3, 1)), np.zeros((3, 4)), np.eye(3)]
    )
    seen = depth[[0, 2]].copy()
    seen[:, 5:7], seen[1, 8] = np.eye(2), FALL
    level = THERE - SLOPE @ at.logs[0] + common.datum + (0.0 if tide is None else tide[0])
    expected = seen @ covariance @ seen.T + common_unknowns.NOISE**2 * np.eye(2)
    innovation = READ - level[[0, 2]] - common.offset - [0.0, 0.7 * FALL]
    gain = covariance @ seen.T @ np.linalg.inv(expected)
    state, left = gain @ innovation, covariance - gain @ seen @ covariance
    assert found.innovation[0] == pytest.approx(innovation)
    assert found.expected[0] == pytest.approx(expected)
    assert found.logs[0] == pytest.approx(state[:2])
    assert found.sea[0] == pytest.approx(state[2] + (0.0 if tide is None else tide[0]))
    assert found.depth[0] == pytest.approx(level + depth @ state)
    assert found.variance[0] == pytest.approx(np.diag(depth @ left @ depth.T))
    density = innovation @ np.linalg.solve(expected, innovation) + np.linalg.slogdet(expected)[1]
    assert found.evidence[0] == pytest.approx(-0.5 * density)
    assert found.current[0] == pytest.approx(state[:2].mean())


def test_a_spike_has_its_own_noise_and_what_was_not_measured_says_nothing():
    one, at, common = given()
    plain = posterior(one, at, SPREAD[None], common, STILL)
    spike = posterior(one, at, SPREAD[None], common, STILL, spike=1)
    more = np.diag([0.0, common_unknowns.SPIKE**2 - common_unknowns.NOISE**2])
    assert spike.expected[0] == pytest.approx(plain.expected[0] + more)
    lost = replace(one, depth=np.array([[READ[0], np.nan]]))
    upper = replace(one, label=("a",), point=np.array([0]), depth=READ[None, :1])
    kept = [0, 1, 2, 4]  # without the offset and the move of the lower sensor
    first = {name: getattr(common, name)[:1] for name in ("offset", "moved", "since")}
    alone = replace(common, covariance=common.covariance[np.ix_(kept, kept)], **first)
    half = posterior(lost, at, SPREAD[None], common, STILL)
    whole = posterior(upper, at, SPREAD[None], alone, STILL)
    for name in ("logs", "sea", "depth", "variance"):
        assert getattr(half, name) == pytest.approx(getattr(whole, name), rel=1e-5)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_current_is_wrong_by_a_factor_of_two_at_most(sign):
    one, at, common = given()
    far = replace(one, depth=READ[None] + sign * np.array([[400.0, 60.0]]))
    found = posterior(far, at, SPREAD[None], common, STILL)
    assert found.logs[0].tolist() == [sign * 0.7, sign * 0.7]


def test_what_sensors_measure_lies_between_them_by_the_height_in_still_water():
    one = replace(given()[0], point=np.array([2, 0]), depth=np.array([[187.0, 83.0]]))
    lower = np.tile(THERE, (2, 1))
    found = between(replace(one, depth=np.array([[187.0, 83.0], [np.nan, 84.0]])), lower, STILL)
    share = (100.0 - 50.0) / (180.0 - 50.0)
    assert found[0] == pytest.approx([83.0, 120.0 + 3.0 * (1.0 - share) + 2.0 * share, 187.0])
    assert found[1] == pytest.approx(THERE + 4.0)


def test_a_spike_says_nothing_and_a_lost_line_has_no_depths():
    one, at, common = given()
    alone = posterior(one, at, SPREAD[None], common, STILL, spike=0)
    assert abs(alone.depth[0, 0] - READ[0]) > 5.0 > abs(alone.depth[0, 2] - READ[1])
    lost = Linear(at.logs, np.full((1, 3), np.nan), np.zeros((1, 3, 2)), np.zeros((1, 3, 1)))
    none = posterior(one, lost, SPREAD[None], common, STILL)
    assert np.isnan(none.depth).all() and none.evidence[0] == -np.inf


def test_slopes_lead_from_the_old_state_to_the_new():
    _, at, _ = given()
    logs, depth = np.array([[0.15, 0.08]]), np.array([[86.0, 123.0, 185.9]])
    moved = at.moved(logs, depth)
    back = np.einsum("npg,ng->np", moved.slope, logs - at.logs)
    assert back == pytest.approx(depth - THERE)


def test_the_errors_of_the_currents_are_those_of_the_table():
    one = replace(given()[0], u=np.array([[0.3, 0.4]]), v=np.array([[0.4, np.nan]]),
                  flag=np.array([[3, 1]], np.int8))  # fmt: skip
    common = replace(given()[2], scale=2.0, gap=np.array([[0.11, 0.12], [0.13, 0.14]]))
    way = LineResponse(one, SimpleNamespace(), {}).way(np.array([[10.0, 90.0]]), common)
    whole, shear = common_unknowns.CURRENT**2, common_unknowns.SHEAR**2
    own = [common_unknowns.LEVEL[3] ** 2 + (common_unknowns.STEADY / 0.5) ** 2, 0.14**2]
    expected = whole + shear * np.array([[1.0, -1.0], [-1.0, 1.0]]) + np.diag(own)
    assert way.spread[0] == pytest.approx(4.0 * expected)
    assert way.u.tolist() == [[0.3, 0.3]] and way.v.tolist() == [[0.4, 0.4]]
    other = LineResponse(one, SimpleNamespace(), {}).way(np.array([[10.0, 90.0]]), common, (0,))
    assert np.isnan(other.u).all()  # nothing is left to take it from


def test_of_several_levels_the_shear_is_linear_and_the_worst_gap_counts():
    speed = np.array([[0.3, 0.4, 0.5]])
    one = replace(given()[0], u=speed, v=0.0 * speed, flag=np.ones((1, 3), np.int8),
                  level_point=np.full(3, -1),
                  level_depth=np.array([[20.0, 20.0, 90.0]]))  # fmt: skip
    gap = np.array([[0.11, 0.12, 0.15], [0.13, 0.14, 0.16], [0.17, 0.18, 0.19]])
    moments, common = LineResponse(one, SimpleNamespace(), {}), replace(given()[2], gap=gap)
    level = moments.levels(np.zeros((1, 3)))
    assert (np.diff(level) > 0.0).all() and level[0] == pytest.approx([20.0, 20.0, 90.0], abs=1e-5)
    own = common_unknowns.LEVEL[1] ** 2 + (common_unknowns.STEADY / speed[0]) ** 2
    place = np.array([-1.0, 0.0, 1.0])
    whole = common_unknowns.CURRENT**2 + common_unknowns.SHEAR**2 * np.outer(place, place)
    assert moments.way(level, common).spread[0] == pytest.approx(whole + np.diag(own))
    own[:2] = 0.12**2, 0.14**2  # of a row, with that of a column left out besides: the worst
    assert moments.way(level, common, (0, 1)).spread[0] == pytest.approx(whole + np.diag(own))


def test_a_current_meter_hangs_at_its_pressure_and_else_where_the_line_has_it():
    one = replace(given()[0], depth=np.array([[93.0, np.nan]]), u=np.zeros((1, 3)),
                  level_point=np.array([0, 2, 1]),
                  level_depth=np.full((1, 3), np.nan))  # fmt: skip
    level = LineResponse(one, SimpleNamespace(), {}).levels(THERE[None])
    assert level[0] == pytest.approx([93.0, THERE[2], THERE[1]], abs=1e-5)


def test_slopes_are_those_of_the_line():
    one = replace(given()[0], u=np.array([[0.5, 0.2]]), v=np.array([[0.4, 0.1]]))
    gain = np.array([[40.0, 2.0], [10.0, 8.0]])

    def line(factor):
        return SimpleNamespace(depths=lambda level, u, v: 100.0 + factor * (u + 2.0 * v) @ gain.T)

    moments = LineResponse(one, line(1.0), {"cable_drag": line(np.exp(0.05))})
    way = moments.way(np.array([[10.0, 90.0]]), given()[2])
    logs = np.array([[0.1, -0.1]])
    at = moments.linear(way, logs)
    assert at.depth[0] == pytest.approx(100.0 + gain @ (np.exp([0.1, -0.1]) * [1.3, 0.4]))
    slope = gain * np.exp([0.1, -0.1]) * [1.3, 0.4]
    assert at.slope[0] == pytest.approx(slope, rel=0.03)
    rest = moments.linear(way, 0.0 * logs)
    assert rest.common[0, :, 0] == pytest.approx(gain @ [1.3, 0.4], rel=0.03)


def test_errors_of_the_line_where_currents_are_inferred():
    """Of three stretches, alike by their middles: all below a point, and 0.3 of its own."""
    down = 0.07 * (THERE - STILL)
    part, middle = down - np.append(down[1:], 0.0), 0.5 * (STILL + np.append(STILL[1:], STILL[2]))
    alike = np.exp(-np.abs(middle[:, None] - middle) / (0.25 * np.ptp(STILL)))
    expected = np.triu(np.ones((3, 3))) @ (np.outer(part, part) * alike) @ np.tri(3)
    expected += 0.3**2 * np.outer(down, down) * alike
    found = own_errors(THERE[None], STILL, True)[0]
    assert 0.07**2 * found == pytest.approx(expected)
