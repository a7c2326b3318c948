"""Knots of currents that were not measured."""

from types import SimpleNamespace

import numpy as np
import pytest

from calm.motion import unknown_currents
from calm.motion.measurements import MooringMeasurements
from calm.motion.unknown_currents import with_knots


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
