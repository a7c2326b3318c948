"""The friction laws of cables on random moorings: CALM against the referee, as in
`test_random_moorings`, with Hoerner's law and the constant one in place of Berteaux's.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from random import Random

import pytest

from calm.errors import NoEquilibrium
from calm.physics.friction import Friction
from calm.solve import Settings, solve_mooring
from tests.property.strategies import mooring
from tests.validation.agreement import closure, difference
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous


@pytest.mark.parametrize("wanted", [5, pytest.param(15, marks=pytest.mark.slow)])
@pytest.mark.parametrize("law", [Friction.HOERNER, Friction.CONSTANT])
def test_calm_agrees_with_the_referee(law, wanted) -> None:
    """So many that stand; a failure names the number that draws its mooring."""
    number, standing = 50_000, 0
    while standing < wanted:
        number += 1
        line, water = mooring(Random(number))
        line = replace(line, friction=law)
        try:
            referee = solve_continuous(line, water)
        except Folded:
            continue
        except NoContinuousSolution:
            with pytest.raises(NoEquilibrium):
                pytest.fail(f"mooring {number}: {solve_mooring(line, water).position[0]}")
            continue
        standing += 1
        for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
            case = f"mooring {number} at {degrees}°"
            solution = solve_mooring(line, water, Settings(radians(degrees)))
            found = difference(solution, referee)
            assert found.place <= near, case
            assert found.tension <= close, case
            assert closure(solution) <= 1e-6, case
