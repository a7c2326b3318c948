"""Current and density by depth: the march's look-up against numpy's interpolation."""

import numpy as np
import pytest

from calm.physics.line import Water
from calm.physics.profile import Profile, distance_to_bend, viscosity_at, water_at

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
    sea = Profile(WATER).sea
    assert distance_to_bend(sea, 100, 0.5, 0, 10.0, 1e-3) == pytest.approx(200)
    assert distance_to_bend(sea, 100, -0.9, 0, 10.0, 1e-3) == pytest.approx(100)
    assert distance_to_bend(sea, 100, 0.0, 0, 10.0, 1e-3) == np.inf
    assert distance_to_bend(sea, 950, 1.0, 0, 10.0, 1e-3) == np.inf


def flowing(*rows):
    level, u, v = np.array(rows).T
    still = np.zeros(len(level))
    return Profile(Water(depth=1000, level=level, u=u, v=v, w=still, density=still + 1025)).sea


@pytest.mark.parametrize("side", [0.2, 0.0])
def test_the_flow_that_all_but_vanishes_between_levels_is_met(side):
    """From 1 to -1 m/s over 200 m it is least in the middle, whichever way the path leads."""
    sea = flowing((0.0, 1.0, side), (200.0, -1.0, side))
    assert distance_to_bend(sea, 60, 0.5, 0, 90.0, 1e-3) == pytest.approx(80)
    assert distance_to_bend(sea, 140, -1.0, 0, 90.0, 1e-3) == pytest.approx(40)
    assert distance_to_bend(sea, 100, 1.0, 0, 90.0, 1e-3) == pytest.approx(100)


def test_a_flow_that_turns_slowly_is_not():
    """It is still 0.5 m/s where it is least, and changes by 0.2 m/s over a segment."""
    sea = flowing((0.0, 1.0, 0.5), (200.0, -1.0, 0.5))
    assert distance_to_bend(sea, 90, 1.0, 0, 20.0, 1e-3) == pytest.approx(110)


def test_a_thin_layer_is_met_where_the_flow_changes_in_it():
    """5 cm, of a segment of 10 m: by 1 m/s it counts, by 1 mm/s the level behind it does."""
    for change, expected in ((1.0, 0.05), (1e-3, 100.0)):
        sea = flowing((0.0, 0.5, 0.0), (50.0, 0.5, 0.0), (50.05, 0.5 + change, 0.0),
                      (150.0, 0.5 + change, 0.0))  # fmt: skip
        assert distance_to_bend(sea, 50.0, 1.0, 0, 10.0, 3e-3) == pytest.approx(expected)


def test_arrays_are_refused_when_they_cannot_be():
    with pytest.raises(ValueError, match="levels must increase"):
        Water(depth=50, level=[0, 0], u=[0, 0], v=[0, 0], w=[0, 0], density=[1025, 1025])
    with pytest.raises(ValueError, match="finite"):
        Water(depth=50, level=[0], u=[np.nan], v=[0], w=[0], density=[1025])
    with pytest.raises(ValueError, match="differ in length"):
        Water(depth=50, level=[0, 1], u=[0], v=[0, 0], w=[0, 0], density=[1025, 1025])
