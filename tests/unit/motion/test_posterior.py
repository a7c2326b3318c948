"""What pressures make of the currents, against the same law written out in full."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion import common_unknowns
from calm.motion.common_unknowns import Common
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.line_response import LineResponse, own_errors
from calm.motion.measurements import MooringMeasurements
from calm.motion.unknown_currents import posterior

STILL = np.array([50.0, 100.0, 180.0])  # of three points; the first and the last have sensors
THERE = np.array([80.0, 120.0, 185.0])
SLOPE = np.array([[30.0, 15.0], [12.0, 14.0], [1.0, 4.0]])
COMMON = np.array([[20.0], [15.0], [4.0]])
SPREAD = np.array([[0.02, 0.004], [0.004, 0.01]])
READ = np.array([93.0, 186.5])


def given(tide=None):
    one = MooringMeasurements(
        np.array(["2026-03-01"], "M8[ns]"), ("a", "c"), np.array([0, 2]), READ[None],
        np.zeros((1, 2)), np.array([-1, -1]), np.zeros((1, 2)),
        np.zeros((1, 2)), np.zeros((1, 2), np.int8), tide,
    )  # fmt: skip
    covariance = np.diag([0.1, 0.8, 0.5, 0.6]) ** 2  # factor, datum, offsets
    common = Common({"cable_drag": 1.1}, 0.4, np.array([0.3, -0.2]), covariance)
    at = Linear(np.array([[0.05, -0.02]]), THERE[None], SLOPE[None], COMMON[None])
    return one, at, common


@pytest.mark.parametrize("tide", [None, np.array([0.7])])
def test_the_posterior_is_that_of_all_unknowns_written_out(tide):
    one, at, common = given(tide)
    found = posterior(one, at, SPREAD[None], common, STILL)
    # unknowns: two logarithms, sea, factor, datum, two offsets, three errors of the line
    sea = common_unknowns.TIDE if tide is None else common_unknowns.RESIDUAL_TIDE
    bent = 0.07**2 * own_errors(THERE[None], STILL, False)[0]
    covariance = np.zeros((10, 10))
    covariance[:2, :2], covariance[2, 2] = SPREAD, sea**2
    covariance[3:7, 3:7], covariance[7:, 7:] = common.covariance, bent
    depth = np.hstack(
        [SLOPE, np.ones((3, 1)), COMMON, np.ones((3, 1)), np.zeros((3, 2)), np.eye(3)]
    )
    seen = depth[[0, 2]].copy()
    seen[:, 5:7] = np.eye(2)
    level = THERE - SLOPE @ at.logs[0] + common.datum + (0.0 if tide is None else tide[0])
    expected = seen @ covariance @ seen.T + common_unknowns.NOISE**2 * np.eye(2)
    innovation = READ - level[[0, 2]] - common.offset
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


def test_what_was_not_measured_says_nothing():
    one, at, common = given()
    lost = replace(one, depth=np.array([[READ[0], np.nan]]))
    upper = replace(one, label=("a",), point=np.array([0]), depth=READ[None, :1])
    kept = [0, 1, 2]  # without the offset of the lower sensor
    alone = replace(
        common, covariance=common.covariance[np.ix_(kept, kept)], offset=common.offset[:1]
    )
    half = posterior(lost, at, SPREAD[None], common, STILL)
    whole = posterior(upper, at, SPREAD[None], alone, STILL)
    for name in ("logs", "sea", "depth", "variance"):
        assert getattr(half, name) == pytest.approx(getattr(whole, name), rel=1e-5)


def test_a_lost_line_has_no_depths():
    one, at, common = given()
    lost = Linear(at.logs, np.full((1, 3), np.nan), np.zeros((1, 3, 2)), np.zeros((1, 3, 1)))
    none = posterior(one, lost, SPREAD[None], common, STILL)
    assert np.isnan(none.depth).all() and none.evidence[0] == -np.inf


def test_slopes_lead_from_the_old_state_to_the_new():
    _, at, _ = given()
    logs, depth = np.array([[0.15, 0.08]]), np.array([[86.0, 123.0, 185.9]])
    moved = at.moved(logs, depth)
    back = np.einsum("npg,ng->np", moved.slope, logs - at.logs)
    assert back == pytest.approx(depth - THERE)


def test_slopes_are_those_of_the_line():
    one = replace(given()[0], u=np.array([[0.5, 0.2]]), v=np.array([[0.4, 0.1]]))
    gain = np.array([[40.0, 2.0], [10.0, 8.0]])

    def line(factor):
        def depths(level, u, v):
            return 100.0 + factor * (u + 2.0 * v) @ gain.T

        slopes = factor * np.hstack([gain, 2.0 * gain])[None]
        return SimpleNamespace(
            depths=depths, slopes=lambda level, u, v: (depths(level, u, v), slopes)
        )

    moments = LineResponse(one, line(1.0), {"cable_drag": line(np.exp(0.05))})
    way = ReadCurrents(np.array([[10.0, 90.0]]), one.u, one.v)
    logs = np.array([[0.1, -0.1]])
    at = moments.linear(way, logs)
    assert at.depth[0] == pytest.approx(100.0 + gain @ (np.exp([0.1, -0.1]) * [1.3, 0.4]))
    slope = gain * np.exp([0.1, -0.1]) * [1.3, 0.4]
    assert at.slope[0] == pytest.approx(slope)
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
