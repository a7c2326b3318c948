"""Estimate of the error share of each stretch of the line, `next_shares`."""

import numpy as np
import pytest

from calm.motion.measured_currents import SHARE, SHARE_STEP, next_shares

PLACE = np.linspace(0.0, 1.0, 5)
ALIKE = np.exp(-np.abs(PLACE[:, None] - PLACE) / 0.4)
LONG = 1e6  # hours


def estimated(product, hours=LONG):
    """Shares after many steps, if the errors are known, and `product` (5, 5) is their mean."""
    shares = np.full(len(PLACE), SHARE)
    for _ in range(60):
        square = product / np.outer(shares, shares)
        shares = next_shares(shares, ALIKE, square, np.zeros_like(ALIKE), hours)
    return shares


def test_known_errors_of_a_long_record_give_their_shares():
    true = np.array([0.3, 0.2, 0.15, 0.05, 0.02])
    assert estimated(np.outer(true, true) * ALIKE) == pytest.approx(true, rel=1e-3)


def test_errors_of_a_short_record_stay_nearer_to_the_prior():
    true = np.array([0.3, 0.2, 0.15, 0.05, 0.02])
    few = np.log(estimated(np.outer(true, true) * ALIKE, hours=12.0) / SHARE)
    known = np.log(true / SHARE)
    assert np.ptp(few) < 0.8 * np.ptp(known)
    assert (np.diff(few) < 0.0).all()


def test_pressures_that_say_nothing_leave_the_prior():
    shares = np.full(len(PLACE), SHARE)
    nothing = np.zeros_like(ALIKE)
    assert next_shares(shares, ALIKE, nothing, ALIKE, 100.0) == pytest.approx(shares)


def test_a_step_is_limited():
    shares = np.full(len(PLACE), SHARE)
    grown = next_shares(shares, ALIKE, 1e3 * ALIKE, np.zeros_like(ALIKE), 100.0)
    assert np.abs(np.log(grown / SHARE)).max() == pytest.approx(SHARE_STEP)
