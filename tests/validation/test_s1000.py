"""S1000: 1000 m of stretchy cable in a sheared current, and the order of the march.

Water 1100 m, 1025 kg/m³; current 1.0, 0.6, 0.2, 0.05 m/s at 0, 200, 500, 1100 m. Float of 4000 N
and 0.6 m² of drag area × Cd at the line's top; cable 10 mm, 2 N/m, Cn 1.3, Ct 0.01, EA 4 MN.
Known to seven digits from a solution by initial-value integration and bracketing: float at
131.4256 m, offset 237.3218 m, anchor tension 2068.154 N, knockdown 32.1756 m.
"""

from __future__ import annotations

from itertools import pairwise
from math import radians

import numpy as np
import pytest

from calm.solve import Settings, solve_mooring
from tests.validation.agreement import difference
from tests.validation.closing import solve_continuous
from tests.validation.pieces import HALF_DENSITY, cable, line_of, point, profile, stream

LINE = line_of(point(4000.0, HALF_DENSITY * 0.6), cable(1000.0, 0.01, 2.0, 1.3, 0.01, 1.0 / 4e6))
SEA = profile(1100.0, [(0.0, 1.0), (200.0, 0.6), (500.0, 0.2), (1100.0, 0.05)])


@pytest.fixture(scope="module")
def referee():
    return solve_continuous(LINE, SEA)


def test_referee_has_the_known_digits(referee) -> None:
    assert referee.depth == pytest.approx(131.4256, abs=5e-5)
    assert referee.shape.top[0, 0] == pytest.approx(237.3218, abs=5e-5)
    assert np.linalg.norm(referee.shape.force_bottom[-1]) == pytest.approx(2068.154, abs=5e-4)
    upright = solve_continuous(LINE, stream(1100.0, 0.0)).depth
    assert referee.depth - upright == pytest.approx(32.1756, abs=1e-4)


@pytest.mark.parametrize(
    ("degrees", "near", "close"), [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5), (0.02, 5e-8, 2e-7)]
)
def test_calm_agrees(referee, degrees, near, close) -> None:
    """The first two rows are what CALM promises; the third holds it to the digits above."""
    found = difference(solve_mooring(LINE, SEA, Settings(radians(degrees), 1e-9)), referee)
    assert found.place <= near
    assert found.tension <= close


def test_halving_the_angle_step_quarters_the_error(referee) -> None:
    """Second order: ratios of 4, met within a quarter while cuts at levels shift the segments."""
    errors = [
        difference(solve_mooring(LINE, SEA, Settings(radians(degrees), 1e-9)), referee)
        for degrees in (2.0, 1.0, 0.5, 0.25)
    ]
    for coarse, fine in pairwise(errors):
        assert 3.0 <= coarse.place / fine.place <= 5.0
        assert 3.0 <= coarse.tension / fine.tension <= 5.0


def test_the_accuracy_it_states_is_its_error(referee) -> None:
    """A solution estimates its own error; it must not be flattering, nor idle."""
    solution = solve_mooring(LINE, SEA)
    worst = difference(solution, referee).place * SEA.depth
    assert worst <= 1.5 * solution.depth_error
    assert solution.depth_error <= 5.0 * worst
