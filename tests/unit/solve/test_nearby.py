from dataclasses import replace
from math import radians

import numpy as np
import pytest

from calm.physics.line import Line, Water
from calm.solve import Settings, solve_mooring
from calm.solve.mooring import Nearby

SETTINGS = Settings(radians(2.0), 1e-10)


def line(**given):
    usual = {
        "length": [1.0, 150.0],
        "flexible": [False, True],
        "buoyancy": [2000.0, -0.5],
        "volume": [0.0, 0.0],
        "normal_drag": [200.0, 8.0],
        "tangential_drag": [200.0, 0.2],
        "directional": [False, True],
        "compliance": [0.0, 1e-5],
        "thinning": [0.0, 0.5],
        "clamp_piece": [1],
        "clamp_at": [40.0],
        "clamp_buoyancy": [-30.0],
        "clamp_volume": [0.0],
        "clamp_drag": [20.0],
    }
    return Line(**{name: np.array(value) for name, value in (usual | given).items()})


def water(depth=300.0):
    return Water(
        depth=depth,
        level=np.array([0.0, depth]),
        u=np.array([0.8, 0.2]),
        v=np.zeros(2),
        w=np.zeros(2),
        density=np.full(2, 1025.0),
    )


def test_the_line_itself_comes_back():
    nearby = Nearby(line(), water(), SETTINGS)
    solution = solve_mooring(line(), water(), SETTINGS).as_marched
    position, used = nearby.shape(line())
    assert used == 1.0
    # the first has segments of half the length: some 1e-5 of the depth
    assert position[0] == pytest.approx(solution.position[0], abs=3e-3)
    assert nearby.node(0) == 0
    clamp = nearby.node(1, clamp=0)
    level = -position[clamp, 2]
    assert level == pytest.approx(-solution.position[solution.element_clamp.tolist().index(0), 2],
                                  abs=3e-3)  # fmt: skip


def test_tiny_changes_are_told_apart():
    # a millionth more drag on the float: the change is a millionth of the derivative
    nearby = Nearby(line(), water(), SETTINGS)

    def depth(factor):
        drag = [200.0 * factor, 8.0]
        other = replace(line(), normal_drag=drag, tangential_drag=[200.0 * factor, 0.2])
        return -nearby.shape(other)[0][0, 2]

    coarse = (depth(1.01) - depth(0.99)) / 0.02
    fine = (depth(1.0 + 1e-6) - depth(1.0)) / 1e-6
    # closed to 1e-11 of 300 m: 3e-9/1e-6 = 3e-3 of a derivative near 5 m
    assert fine == pytest.approx(coarse, rel=1e-3)


def test_derivatives_are_those_of_independent_solves():
    nearby = Nearby(line(), water(), SETTINGS)
    fine = Settings(radians(0.1), 1e-9)

    def more(drag):
        return line(clamp_drag=[drag])

    near = nearby.shape(more(22.0))[0][0, 2] - nearby.shape(more(18.0))[0][0, 2]
    far = (
        solve_mooring(more(22.0), water(), fine).position[0, 2]
        - solve_mooring(more(18.0), water(), fine).position[0, 2]
    )
    # the truncation error of coarse segments is a share of the derivative itself
    assert near == pytest.approx(far, rel=2e-3)


def test_a_line_afloat_uses_more_buoyancy_for_more_drag():
    nearby = Nearby(line(), water(depth=140.0), SETTINGS)
    _, used = nearby.shape(line())
    _, more = nearby.shape(line(clamp_drag=[22.0]))
    there = solve_mooring(line(clamp_drag=[22.0]), water(depth=140.0), Settings(radians(0.2), 1e-9))
    here = solve_mooring(line(), water(depth=140.0), Settings(radians(0.2), 1e-9))
    assert more - used == pytest.approx(there.buoyancy_used - here.buoyancy_used, rel=1e-2)
