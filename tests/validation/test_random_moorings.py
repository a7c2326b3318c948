"""CALM against the referee on random moorings: 240 that have an equilibrium.

What a mooring can be is told in `tests.property.strategies`. The limits are CALM's promises: depths
and offsets within 5e-5 of the water depth and tensions within 2e-4 at the default angle step of 1°,
2e-6 and 1e-5 at 0.1°, in at most 60 marches; its forces close to 1e-6, recomputed here. Where the
referee finds no shape, CALM must find none either; a line that hangs in a sharp fold, where its
tension is a millionth of the greatest, it may solve or refuse.
"""

from __future__ import annotations

from math import radians
from random import Random

import pytest

from calm.errors import NoEquilibrium
from calm.solve import Settings, solve_mooring
from tests.property.strategies import mooring
from tests.validation.agreement import closure, difference
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous

STANDING = 5
BLOCKS = [
    0,
    *(pytest.param(block, marks=pytest.mark.thorough) for block in (1, 2, 3)),
    *(pytest.param(block, marks=pytest.mark.slow) for block in range(4, 48)),
]


@pytest.mark.parametrize("block", BLOCKS)
def test_calm_agrees_with_the_referee(block) -> None:
    """Five standing moorings a block; a failure names the number that draws its mooring.

    Each float at the surface is sought on its own, so that marches are counted for each.
    """
    number, standing = 1000 * block, 0
    while standing < STANDING:
        number += 1
        line, water = mooring(Random(number))
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
            assert solution.marches <= 60 * max(1, len(solution.afloat)), case
            assert closure(solution) <= 1e-6, case
