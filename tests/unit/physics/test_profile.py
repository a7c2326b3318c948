"""Current and density by depth: the march's look-up against numpy's interpolation."""

import numpy as np
import pytest

from calm.physics.line import Water
from calm.physics.profile import Profile, distance_to_level, viscosity_at, water_at

WATER = Water(
    depth=1000,
    level=[10.0, 200.0, 900.0],
    u=[1.0, 0.4, -0.2],
    v=[0.0, 0.3, 0.1],
    w=[0.01, 0.0, 0.0],
    density=[1024.0, 1026.0, 1031.0],
)


@pytest.mark.parametrize("start", [0, 1, 2, 3])
def test_agrees_with_linear_interpolation_wherever_the_search_starts(start):
    sea = Profile(WATER).sea
    for depth in (-5.0, 0.0, 10.0, 57.3, 200.0, 640.0, 900.0, 1000.0):
        current, density = WATER.current_at(np.array(depth)), WATER.density_at(np.array(depth))
        *found, _ = water_at(sea, depth, start)
        assert found == pytest.approx((*current, density), rel=1e-14)


def test_viscosity_is_linear_between_levels_of_its_own_and_held_outside():
    water = Water(
        depth=1000, level=[0], u=[0], v=[0], w=[0], density=[1025],
        viscosity_level=[0, 100, 400], viscosity=[1.0e-6, 1.4e-6, 1.7e-6],
    )  # fmt: skip
    sea, depths = Profile(water).sea, np.array([-3.0, 0.0, 25.0, 100.0, 250.0, 400.0, 900.0])
    expected = [1.0e-6, 1.0e-6, 1.1e-6, 1.4e-6, 1.55e-6, 1.7e-6, 1.7e-6]
    assert [viscosity_at(sea, depth) for depth in depths] == pytest.approx(expected, rel=1e-14)
    assert water.viscosity_at(depths) == pytest.approx(expected, rel=1e-14)


def test_a_single_level_is_uniform():
    sea = Profile(Water(depth=50, level=[0.0], u=[0.5], v=[0], w=[0], density=[1025])).sea
    assert water_at(sea, -1, 0) == (0.5, 0, 0, 1025, 0)
    assert water_at(sea, 0, 0) == water_at(sea, 49, 1) == (0.5, 0, 0, 1025, 1)


def test_distance_to_the_next_level_either_way():
    levels = Profile(WATER).sea.levels
    assert distance_to_level(levels, 100, 0.5, 0, 0.0) == pytest.approx(200)
    assert distance_to_level(levels, 100, -0.9, 0, 0.0) == pytest.approx(100)
    assert distance_to_level(levels, 100, 0.0, 0, 0.0) == np.inf
    assert distance_to_level(levels, 950, 1.0, 0, 0.0) == np.inf


def test_arrays_are_refused_when_they_cannot_be():
    with pytest.raises(ValueError, match="levels must rise"):
        Water(depth=50, level=[0, 0], u=[0, 0], v=[0, 0], w=[0, 0], density=[1025, 1025])
    with pytest.raises(ValueError, match="finite"):
        Water(depth=50, level=[0], u=[np.nan], v=[0], w=[0], density=[1025])
    with pytest.raises(ValueError, match="differ in length"):
        Water(depth=50, level=[0, 1], u=[0], v=[0, 0], w=[0, 0], density=[1025, 1025])
