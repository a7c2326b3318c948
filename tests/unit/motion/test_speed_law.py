"""What is assumed of currents that nobody measured: the shapes of a record that is given."""

from types import SimpleNamespace

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion.measurements import CurrentMeasurements
from calm.motion.unknown_currents import ALL, OTHER, assumed_law, shaped_law

KNOTS = np.array([50.0, 150.0, 300.0, 500.0, 800.0, 1200.0])
MEASURED = SimpleNamespace(level_depth=KNOTS[None, :])
TIMES = 60


def record(speed, depth, label=None):
    """A record of so many profiles, all towards the north-east."""
    shape = (len(speed), len(depth))
    u = np.broadcast_to(speed, shape) / np.sqrt(2.0)
    time = np.datetime64("2026-01-01", "ns") + np.arange(shape[0]) * np.timedelta64(1, "h")
    return CurrentMeasurements(
        time, np.broadcast_to(depth, shape).copy(), label or ("",) * shape[1], u, u,
        np.zeros(shape, np.int8), "prior.nc",
    )  # fmt: skip


def strengths():
    return np.exp(0.3 * np.random.default_rng(2).standard_normal((TIMES, 1)))


def test_one_shape_of_any_strength_is_that_shape():
    """All profiles proportional to one another: nothing is left but their strength."""
    shape = 0.3 * np.exp(-KNOTS / 400.0) + 0.2
    for factor in (1.0, 3.0):
        mean, covariance = shaped_law(MEASURED, [record(factor * strengths() * shape, KNOTS)], {})
        assert np.diff(mean) == pytest.approx(np.diff(np.log(shape)), abs=1e-9)
        assert mean.mean() == pytest.approx(assumed_law(MEASURED)[0].mean())
        assert covariance == pytest.approx(ALL**2 + OTHER**2 * np.eye(6), abs=1e-9)


def test_knots_below_its_levels_keep_what_is_assumed():
    mean, covariance = shaped_law(MEASURED, [record(strengths() * np.ones(4), KNOTS[:4])], {})
    assumed, wide = assumed_law(MEASURED)
    assert mean[4:] == pytest.approx(assumed[4:])
    assert np.diff(mean[:4]) == pytest.approx(np.zeros(3), abs=1e-9)
    assert covariance[4:, 4:] == pytest.approx(wide[4:, 4:])
    assert (np.linalg.eigvalsh(covariance) > 0.0).all()


def test_levels_that_hang_on_the_line_are_at_rest_there():
    given = record(strengths() * np.ones(6), np.full(6, np.nan), tuple("abcdef"))
    places = dict(zip("abcdef", KNOTS.tolist(), strict=True))
    assert np.diff(shaped_law(MEASURED, [given], places)[0]) == pytest.approx(np.zeros(5), abs=1e-9)


def test_a_record_without_a_shape_is_refused():
    with pytest.raises(UsageError, match="--prior: its profiles show no shape"):
        shaped_law(MEASURED, [record(strengths(), KNOTS[:1])], {})
