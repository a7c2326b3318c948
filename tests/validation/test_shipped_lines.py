"""Every shipped mooring and tow against the continuous solution.

The limits are CALM's promises: depths and offsets within 5e-5 of the water depth (in a tow, of the
line out) and tensions within 2e-4 at the default angle step of 1°; 2e-6 and 1e-5 at 0.1°. Forces
close to 1e-6, recomputed here from the final coordinates.
"""

from __future__ import annotations

from functools import cache
from math import radians
from pathlib import Path
from typing import Any

import pytest

import calm
from calm.solve import Settings, solve_mooring, solve_tow
from tests.validation.agreement import closure, difference
from tests.validation.closing import Equilibrium, solve_continuous
from tests.validation.towed import Passing, Towed, solve_continuous_tow

LINES = sorted((Path(__file__).parents[2] / "lines").glob("*.yaml"))
TOWS = [path for path in LINES if "\ntow:" in path.read_text(encoding="utf-8")]
MOORINGS = [path for path in LINES if path not in TOWS]
OF_EVERY_DAY = (
    "braconnot-buoy", "s1000", "taut-nylon-surface", "veering-current",
    "a-frame-sheared-tow", "bourget-marichal-sphere",
)  # fmt: skip


def _cases(paths: list[Path]) -> list[Any]:
    often = {path: path.stem in OF_EVERY_DAY for path in paths}
    return [
        pytest.param(path, id=path.stem, marks=() if often[path] else pytest.mark.thorough)
        for path in paths
    ]


@cache
def referee_of(path: Path) -> Equilibrium | Towed:
    """The continuous solution of a shipped line, which two tests look at."""
    if path in TOWS:
        tow = calm.load(path)
        return solve_continuous_tow(tow.line, tow.water, tow.leg.towing)
    mooring = calm.load(path)
    return solve_continuous(mooring.line, mooring.water)


def test_there_are_shipped_lines() -> None:
    assert len(MOORINGS) >= 10
    assert len(TOWS) >= 4


@pytest.mark.parametrize("path", _cases(TOWS))
def test_calm_agrees_with_the_referee_on_tows(path) -> None:
    tow = calm.load(path)
    referee = referee_of(path)
    for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
        solution = solve_tow(tow.line, tow.water, tow.leg.towing, Settings(radians(degrees)))
        found = difference(solution, referee)
        assert found.place <= near, f"at {degrees}°"
        assert found.tension <= close, f"at {degrees}°"
        assert solution.frequency == pytest.approx(referee.frequency, rel=close)
        assert closure(solution, Passing(tow.water, tow.leg.towing)) <= 1e-6


@pytest.mark.parametrize("path", _cases(MOORINGS))
def test_calm_agrees_with_the_referee(path) -> None:
    mooring = calm.load(path)
    referee = referee_of(path)
    for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
        solution = solve_mooring(mooring.line, mooring.water, Settings(radians(degrees)))
        found = difference(solution, referee)
        assert found.place <= near, f"at {degrees}°"
        assert found.tension <= close, f"at {degrees}°"
        assert solution.marches <= 60
        assert closure(solution) <= 1e-6
        assert solution.surface == referee.surface


@pytest.mark.parametrize("path", _cases(MOORINGS))
def test_the_accuracy_it_states_holds(path) -> None:
    """What the result says of its own error, against its error; half of it is the allowance."""
    mooring = calm.load(path)
    result = mooring.solve()
    referee = referee_of(path)
    solution = solve_mooring(mooring.line, mooring.water)
    error = difference(solution, referee).place * mooring.water.depth
    assert error <= 1.5 * result.accuracy.depth + 1e-7 * mooring.water.depth


@pytest.mark.parametrize("path", _cases(TOWS))
def test_the_accuracy_a_tow_states_holds(path) -> None:
    tow = calm.load(path)
    referee = referee_of(path)
    length = tow.line.length.sum()
    error = difference(solve_tow(tow.line, tow.water, tow.leg.towing), referee).place * length
    assert error <= 1.5 * tow.solve().accuracy.depth + 1e-7 * length
