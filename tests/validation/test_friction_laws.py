"""The friction laws of cables on random moorings: CALM against the referee, as in
`test_random_moorings`, with Hoerner's law and the constant one in place of Berteaux's.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians
from random import Random

import numpy as np
import pytest

import calm
from calm.errors import NoEquilibrium
from calm.physics.drag import Friction
from calm.solve import Settings, solve_mooring
from tests.property.strategies import mooring
from tests.validation.agreement import closure, difference
from tests.validation.cables import Folded, NoContinuousSolution
from tests.validation.closing import solve_continuous


@pytest.mark.parametrize("wanted", [2, pytest.param(15, marks=pytest.mark.slow)])
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


TURNING = """
environment:
  depth: 182.2 m
  current:
    columns: [depth m, u m/s, v m/s]
    rows: [[0, 0.79, 0], [54.7, 0.351, 0], [109.3, -0.818, 0], [182.2, -0.595, 0]]
components:
  upper: {kind: sphere, diameter: 1.064 m, buoyancy: 2811.7 N}
  wire: {kind: cable, diameter: 29 mm, weight: 0.986 N/m, cn: 1.02, ct: 0.05}
  lower: {kind: sphere, diameter: 0.312 m, buoyancy: 1856.8 N}
  rope: {kind: cable, diameter: 22.1 mm, weight: 0.376 N/m, cn: 1.04, ct: 0.05}
  block: {kind: anchor, weight: 90 kN, length: 0.5 m}
line:
  - {use: upper}
  - {use: wire, length: 26.34 m}
  - {use: lower}
  - {use: rope, length: 246.51 m}
  - {use: block}
solver: {friction: constant}
"""


def test_a_friction_that_jumps_inside_a_cable_is_within_the_stated_error() -> None:
    """The current turns round at 71 m, the line leans over: there the flow along it turns, too.

    With segments that knew nothing of the jump the depths were off by 5.6 times what was stated,
    the tensions by 3.5 times. At a tenth of the step errors are a hundredth.
    """
    mooring = calm.load("turning.yaml", text=TURNING)
    usual = solve_mooring(mooring.line, mooring.water)
    fine = solve_mooring(mooring.line, mooring.water, Settings(radians(0.1), 1e-10))
    at, finely = usual.piece_nodes, fine.piece_nodes
    off = np.abs(usual.position[at] - fine.position[finely]).max()
    pull = np.abs(usual.tension[at] - fine.tension[finely]).max()
    assert off <= min(1.02 * usual.depth_error, 5e-5 * mooring.water.depth)
    assert pull <= min(1.02 * usual.tension_error, 2e-4 * fine.tension.max())
