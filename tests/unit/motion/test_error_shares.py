"""Estimate of the error share of each stretch of the line, `share_score` and `next_shares`."""

import numpy as np
import pytest

from calm.motion.measured_currents import SHARE, SHARE_STEP, next_shares, share_score

PLACE = np.linspace(0.0, 1.0, 5)
ALIKE = np.exp(-np.abs(PLACE[:, None] - PLACE) / 0.4)
LONG = 1e6  # independent times
TRUE = np.array([0.3, 0.2, 0.15, 0.05, 0.02])


def estimated(errors, number):
    """Shares after many steps, if the errors (n, 5) are known."""
    shares = np.full(len(PLACE), SHARE)
    nothing = np.zeros((len(errors), *ALIKE.shape))
    for _ in range(60):
        score, information = share_score(errors / shares, nothing, ALIKE)
        shares = next_shares(shares, score / len(errors), information / len(errors), number)
    return shares


def drawn(count):
    """Errors whose products have on average exactly the prior covariance."""
    whole = np.random.default_rng(1).standard_normal((count, len(PLACE)))
    whole = whole @ np.linalg.inv(np.linalg.cholesky(whole.T @ whole / count)).T
    return TRUE * (whole @ np.linalg.cholesky(ALIKE).T)


def test_known_errors_of_a_long_record_give_their_shares():
    assert estimated(drawn(50), LONG) == pytest.approx(TRUE, rel=1e-3)


def test_errors_of_a_short_record_stay_nearer_to_the_prior():
    few, known = np.log(estimated(drawn(50), 2.0) / SHARE), np.log(TRUE / SHARE)
    assert np.ptp(few) < 0.8 * np.ptp(known)
    assert (np.diff(few) < 0.0).all()


def test_pressures_that_say_nothing_leave_the_prior():
    shares = np.full(len(PLACE), SHARE)
    score, information = share_score(np.zeros((3, 5)), np.tile(ALIKE, (3, 1, 1)), ALIKE)
    assert score == pytest.approx(0.0, abs=1e-12)
    assert next_shares(shares, score, information, 10.0) == pytest.approx(shares)


def test_a_step_is_limited():
    shares = np.full(len(PLACE), SHARE)
    score, information = share_score(30.0 * np.ones((1, 5)), np.zeros((1, 5, 5)), ALIKE)
    grown = next_shares(shares, score, information, 10.0)
    assert np.abs(np.log(grown / SHARE)).max() == pytest.approx(SHARE_STEP)


def test_score_and_information_are_those_of_the_likelihood():
    """Two readings of the sum and of the lowest error, at times with weak and strong currents."""
    seen = np.array([[1.0, 1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 0.0, 2.0]])
    read, noise = np.array([[0.4, -0.1], [3.0, 0.5]]), 0.2**2 * np.eye(2)
    strong = np.array([0.2, 5.0])

    def spread(logs, factor):
        bent = factor * seen * np.exp(logs)
        return bent, bent @ ALIKE @ bent.T + noise

    def likelihood(logs):
        total = 0.0
        for y, factor in zip(read, strong, strict=True):
            _, expected = spread(logs, factor)
            total -= 0.5 * (np.linalg.slogdet(expected)[1] + y @ np.linalg.solve(expected, y))
        return total

    logs = np.log(TRUE)
    mean, covariance, information = [], [], np.zeros((5, 5))
    for y, factor in zip(read, strong, strict=True):
        bent, expected = spread(logs, factor)
        gain = ALIKE @ bent.T @ np.linalg.inv(expected)
        mean.append(gain @ y)
        covariance.append(ALIKE - gain @ bent @ ALIKE)
        slopes = []
        for k in range(5):
            ahead, behind = (
                spread(logs + sign * 1e-5 * np.eye(5)[k], factor)[1] for sign in (1, -1)
            )
            slopes.append(np.linalg.solve(expected, (ahead - behind) / 2e-5))
        information += [[0.5 * np.trace(one @ other) for other in slopes] for one in slopes]
    found = share_score(np.array(mean), np.array(covariance), ALIKE)
    slope = [
        (likelihood(logs + step) - likelihood(logs - step)) / 2e-5 for step in 1e-5 * np.eye(5)
    ]
    assert found[0] == pytest.approx(slope, rel=1e-4, abs=1e-6)
    assert found[1] == pytest.approx(information, rel=1e-4, abs=1e-6)
