"""What is assumed of currents that nobody measured: the shapes of a record that is given."""

from types import SimpleNamespace

import numpy as np
import pytest

from calm.errors import UsageError
from calm.motion import unknown_currents
from calm.motion.measurements import CurrentMeasurements, MooringMeasurements
from calm.motion.unknown_currents import ALL, OTHER, assumed_law, shaped_law, with_knots

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


def test_the_uppermost_knot_is_where_the_top_is_in_strong_currents(monkeypatch):
    """A top at 40 m at rest and a sensor 20 m below it, down by 0 to 100 m: by 90 m nine times of
    ten; the lower sensor, which is down by less, is not asked."""
    line = SimpleNamespace(still=np.array([60.0, 500.0, 40.0]))
    monkeypatch.setattr(unknown_currents, "Forward", lambda mooring, factors: line)
    down = np.linspace(0.0, 100.0, 101)
    depth = np.column_stack([500.0 + 0.1 * down, 60.0 + down])
    depth[7, 1] = np.nan
    nothing = np.zeros((len(down), 0))
    one = MooringMeasurements(
        time=np.arange(len(down)).astype("M8[h]").astype("M8[ns]"), label=("low", "high"),
        point=np.array([1, 0]), depth=depth, level_depth=nothing,
        level_point=np.zeros(0, np.int64), u=nothing,
        v=nothing, flag=nothing.astype(np.int8),
    )  # fmt: skip
    mooring = SimpleNamespace(water=SimpleNamespace(depth=1000.0))
    knots = with_knots(one, mooring).level_depth
    assert knots[0, [0, -1]] == pytest.approx([130.0, 1000.0], abs=0.2)
    assert (knots == knots[0]).all()
    at_rest = with_knots(unknown_currents.replace(one, depth=0.0 * depth + [500.0, 60.0]), mooring)
    assert at_rest.level_depth[0, 0] == pytest.approx(40.0)
