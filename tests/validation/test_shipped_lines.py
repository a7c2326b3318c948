"""Every shipped mooring against the continuous solution.

The limits are CALM's promises: depths and offsets within 5e-5 of the water depth and tensions
within 2e-4 at the default angle step of 1°; 2e-6 and 1e-5 at 0.1°. Forces close to 1e-6, recomputed
here from the final coordinates.
"""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest

import calm
from calm.solve import Settings, solve_mooring
from tests.validation.agreement import closure, difference
from tests.validation.closing import solve_continuous

LINES = sorted((Path(__file__).parents[2] / "lines").glob("*.yaml"))


def test_there_are_shipped_lines() -> None:
    assert len(LINES) >= 10


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
def test_calm_agrees_with_the_referee(path) -> None:
    mooring = calm.load(path)
    referee = solve_continuous(mooring.line, mooring.water)
    for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
        solution = solve_mooring(mooring.line, mooring.water, Settings(radians(degrees)))
        found = difference(solution, referee)
        assert found.place <= near, f"at {degrees}°"
        assert found.tension <= close, f"at {degrees}°"
        assert solution.marches <= 60
        assert closure(solution) <= 1e-6
        assert solution.surface == referee.surface


@pytest.mark.parametrize("path", LINES, ids=lambda path: path.stem)
def test_the_accuracy_it_states_holds(path) -> None:
    """What the result says of its own error, against its error; half of it is the allowance."""
    mooring = calm.load(path)
    result = mooring.solve()
    referee = solve_continuous(mooring.line, mooring.water)
    solution = solve_mooring(mooring.line, mooring.water)
    error = difference(solution, referee).place * mooring.water.depth
    assert error <= 1.5 * result.accuracy.depth + 1e-7 * mooring.water.depth
