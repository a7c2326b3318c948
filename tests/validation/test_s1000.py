"""S1000 along its whole length, against the referee.

The figures known of it are cases of `calm.verification.solved_moorings`; here the referee, which
shares nothing with CALM, has them too, and judges every other place and tension.
"""

from __future__ import annotations

from itertools import pairwise
from math import radians

import numpy as np
import pytest

from calm.solve import Settings, solve_mooring
from calm.verification import solved_moorings
from calm.verification.solved_moorings import S1000_SEA
from tests.validation.agreement import difference
from tests.validation.closing import solve_continuous

LINE = solved_moorings.s1000_mooring()


@pytest.fixture(scope="module")
def referee():
    return solve_continuous(LINE, S1000_SEA)


def test_referee_has_the_known_digits(referee) -> None:
    assert referee.depth == pytest.approx(solved_moorings.DEPTH, abs=5e-5)
    assert referee.shape.top[0, 0] == pytest.approx(solved_moorings.OFFSET, abs=5e-5)
    assert np.linalg.norm(referee.shape.force_bottom[-1]) == pytest.approx(
        solved_moorings.TENSION, abs=5e-4
    )
    upright = solve_continuous(LINE, S1000_SEA.still()).depth
    assert referee.depth - upright == pytest.approx(solved_moorings.KNOCKDOWN, abs=1e-4)


@pytest.mark.parametrize(
    ("degrees", "near", "close"), [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5), (0.02, 5e-8, 2e-7)]
)
def test_calm_agrees(referee, degrees, near, close) -> None:
    """The first two rows are what CALM promises; the third holds it to the digits above."""
    found = difference(solve_mooring(LINE, S1000_SEA, Settings(radians(degrees), 1e-9)), referee)
    assert found.place <= near
    assert found.tension <= close


def test_halving_the_angle_step_quarters_the_error(referee) -> None:
    """The march is of second order: ratios of 4, met within a quarter, as cuts at levels shift."""
    errors = [
        difference(
            solve_mooring(LINE, S1000_SEA, Settings(radians(degrees), 1e-9)).as_marched, referee
        )
        for degrees in (2.0, 1.0, 0.5, 0.25)
    ]
    for coarse, fine in pairwise(errors):
        assert 3.0 <= coarse.place / fine.place <= 5.0
        assert 3.0 <= coarse.tension / fine.tension <= 5.0


def test_the_accuracy_it_states_is_its_error(referee) -> None:
    """A solution states the error of its marched shape; what it reports errs far less."""
    solution = solve_mooring(LINE, S1000_SEA)
    worst = difference(solution.as_marched, referee).place * S1000_SEA.depth
    assert worst <= 1.5 * solution.depth_error
    assert solution.depth_error <= 5.0 * worst
    assert difference(solution, referee).place * S1000_SEA.depth <= 1e-3 * worst
