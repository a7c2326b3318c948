"""CALM against the referee on random moorings with a float at its draft: 48 that are afloat.

The moorings of `test_random_moorings` that are made for the surface, with a hull on the first
float, wind, and now and then a given drag afloat or a given area in the wind. The same limits:
depths and offsets within 5e-5 of the water depth and tensions within 2e-4 at an angle step of 1°,
2e-6 and 1e-5 at 0.1°; forces close to 1e-6, recomputed here. Draft and freeboard are the hull's.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, radians, sin
from random import Random

import pytest

from calm.errors import NoEquilibrium
from calm.physics.hull import Floating, cylindrical_hull, spherical_hull, tabulated_hull
from calm.physics.line import Line, Water
from calm.solve import Settings, solve_mooring
from tests.property.strategies import mooring
from tests.validation.afloat import Hull, ball, first_float, spar, tabulated
from tests.validation.agreement import closure, difference
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous

AFLOAT = 3
BLOCKS = [
    0,
    pytest.param(1, marks=pytest.mark.thorough),
    *(pytest.param(block, marks=pytest.mark.slow) for block in range(2, 16)),
]


@pytest.mark.parametrize("block", BLOCKS)
def test_calm_agrees_with_the_referee(block) -> None:
    """Three moorings afloat a block; a failure names the number that draws its mooring."""
    number, afloat = 10_000 + 1000 * block, 0
    while afloat < AFLOAT:
        number += 1
        line, water, hull = surface_mooring(Random(number))
        try:
            referee = solve_continuous(line, water, hull)
        except Folded:
            continue
        except NoContinuousSolution:
            with pytest.raises(NoEquilibrium):
                pytest.fail(f"mooring {number}: {solve_mooring(line, water).position[0]}")
            continue
        afloat += referee.surface
        for degrees, near, close in [(1.0, 5e-5, 2e-4), (0.1, 2e-6, 1e-5)]:
            case = f"mooring {number} at {degrees}°"
            solution = solve_mooring(line, water, Settings(radians(degrees)))
            found = difference(solution, referee)
            assert solution.surface == referee.surface, case
            assert found.place <= near, case
            assert found.tension <= close, case
            assert closure(solution) <= 1e-6, case
        if solution.riding is None:
            continue
        used = referee.share[first_float(line)]
        draft, _ = hull((line.floating.weight + used * line.floating.lift) / displacement(line))
        height = line.floating.hull.height
        # its share of the volume is as good as the shape: 1e-5
        assert solution.riding.draft == pytest.approx(draft * height, abs=1e-4 * height), case
        assert solution.riding.draft + solution.riding.freeboard == pytest.approx(height), case


def displacement(line: Line) -> float:
    """Weight of the water that the whole first float displaces [N]."""
    return line.floating.weight + line.floating.lift


def surface_mooring(random: Random) -> tuple[Line, Water, Hull]:
    """A line made for the surface, its water, and the form of its first float."""
    line, water = mooring(random, surface=True)
    first = first_float(line)
    height, volume = float(line.length[first]), float(line.volume[first])
    rows = [(0.0, 0.0, 0.0), (0.3, 0.2, 0.4), (0.6, 0.7, 0.7), (1.0, 1.0, 1.0)]
    rows = [(d * height, v * volume, a * height**2) for d, v, a in rows]
    hull, form = random.choice(
        [
            (spherical_hull(height), ball),
            (cylindrical_hull(0.8 * height, height), spar),
            (tabulated_hull(rows), tabulated(rows)),
        ]
    )
    excess = (float(water.density[0]) - 1025.0) * water.gravity * volume
    wind, toward = random.choice([0.0, random.uniform(2.0, 30.0)]), random.uniform(0.0, 2.0 * pi)
    floating = Floating(
        hull=hull,
        weight=1025.0 * water.gravity * volume - float(line.buoyancy[first]),
        lift=float(line.buoyancy[first]) + excess,
        surface_drag=random.choice([None, None, random.uniform(0.5, 2.0)]),
        wind=(wind * cos(toward), wind * sin(toward)),
        wind_area=random.choice([None, None, random.uniform(0.1, 2.0) * height**2]),
        wind_cd=random.uniform(0.5, 1.2),
    )
    return replace(line, floating=floating), water, form
