"""What the solver finds and what it refuses, on lines small enough to reason about."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.line import Line, Water
from calm.physics.stretch import ElongationCurve
from calm.solve import Settings, solve_mooring
from tests.unit.solve.simple import line, rigid, rope, water

FLOAT = rigid(1.0, 5000.0, drag=250.0)


def refused(*args):
    with pytest.raises(NoEquilibrium) as caught:
        solve_mooring(*args)
    assert caught.value.message
    assert caught.value.advice
    return caught.value


def depths(solution):
    """Depth of the top of every piece [m]."""
    return -solution.position[solution.piece_nodes[:, 0], 2]


def test_in_still_water_the_line_stands_plumb_and_tension_is_what_hangs_below():
    solution = solve_mooring(
        line(FLOAT, rope(80, weight=2.0), rigid(0.5, -300.0), rope(20, weight=1.0)), water(200)
    )
    assert depths(solution) == pytest.approx([98.5, 99.5, 179.5, 180.0])
    assert np.abs(solution.position[:, :2]).max() == 0
    tension = solution.tension[solution.piece_nodes]
    assert tension == pytest.approx(np.array([[0, 5000], [5000, 4840], [4840, 4540], [4540, 4520]]))


def test_the_anchor_height_lifts_the_whole_line():
    solution = solve_mooring(line(FLOAT, rope(80), anchor_height=0.7), water(200))
    assert depths(solution)[0] == pytest.approx(200 - 0.7 - 81)


def test_a_float_pulled_under_becomes_sub_surface_by_itself():
    """A taut line half a metre too long floats in a weak current and goes under in a strong."""
    taut = line(FLOAT, rope(99.5, weight=0.5))
    weak = solve_mooring(taut, water(100, (0, 0.1, 0, 0)))
    strong = solve_mooring(taut, water(100, (0, 1.0, 0, 0)))
    assert weak.surface
    assert depths(weak)[0] == 0
    assert 0 < weak.buoyancy_used < 1
    assert weak.reserve == pytest.approx((1 - weak.buoyancy_used) * 5000)
    assert not strong.surface
    assert 0.1 < depths(strong)[0] < 1
    assert (strong.buoyancy_used, strong.reserve) == (1, 0)


def test_a_beacon_above_the_float_is_rigid_with_it():
    """The two lean as one, along the moment of all their loads about the lower end."""
    beacon = rigid(2.0, -40.0, drag=60.0, tangential=5.0, directional=True)
    solution = solve_mooring(line(beacon, FLOAT, rope(60)), water(100, (0, 0.8, 0, 0)))
    chord = np.diff(solution.position[solution.piece_nodes[:2, 0]], axis=0)
    below = solution.position[solution.piece_nodes[1]]
    assert np.cross(chord[0], below[1] - below[0]) == pytest.approx(0, abs=1e-9)
    axis = chord[0] / np.linalg.norm(chord[0])
    across = 0.8 - axis[0] * 0.8 * axis[0]
    normal = np.array([0.8, 0, 0]) - axis[0] * 0.8 * axis
    drag = 60.0 * np.linalg.norm(normal) * normal + 5.0 * 0.64 * axis[0] * abs(axis[0]) * axis
    load = drag + np.array([0, 0, -40.0])
    float_load = np.array([250.0 * 0.64, 0, 5000.0])
    # moments about the lower end: the beacon's middle is 2 m up, the float's 0.5 m
    moment = np.cross(-2.0 * axis, load) + np.cross(-0.5 * axis, float_load)
    assert across > 0
    assert moment == pytest.approx(np.zeros(3), abs=1e-6)


def test_a_clamp_on_a_rigid_piece_turns_it_by_its_lever():
    bar = rigid(4.0, -50.0)
    loaded = line(FLOAT, bar, rope(60), clamps=[(1, 1.0, 0.0, 900.0)])
    solution = solve_mooring(loaded, water(100, (0, 0.7, 0, 0)))
    first, last = solution.piece_nodes[1]
    chord = solution.position[last] - solution.position[first]
    drag = 900.0 * 0.49
    mean = solution.force[first] + [0.75 * drag, 0, -25.0]
    assert np.cross(chord, mean) == pytest.approx(np.zeros(3), abs=1e-6)
    clamp = int(np.flatnonzero(solution.element_clamp == 0)[0])
    assert np.linalg.norm(solution.position[clamp] - solution.position[first]) == pytest.approx(1)
    assert solution.position[clamp] == pytest.approx(solution.position[clamp + 1])


def test_two_floats_at_the_surface_share_what_the_line_needs():
    """A heavy wire sags between the top float and a second one at the surface too."""
    solution = solve_mooring(
        line(FLOAT, rope(60, weight=20), rigid(1.0, 6000.0, drag=300.0), rope(108, weight=1.0)),
        water(100, (0, 0.5, 0, 0)),
    )
    assert solution.afloat == (0, 2)
    assert depths(solution)[[0, 2]] == pytest.approx([0, 0], abs=1e-5)
    assert solution.position[:, 2].max() < 1.0
    used = np.array([solution.carried.buoyancy[0], solution.carried.buoyancy[2]])
    assert ((used > 0) & (used < [5000, 6000])).all()
    assert solution.buoyancy_used == pytest.approx(used.sum() / 11000, rel=1e-5)
    assert solution.closure < 1e-9


def test_buoyancy_of_a_known_volume_follows_the_density():
    known = rigid(1.0, 5000.0, drag=250.0, volume=0.8)
    dense = water(200, density=1035.0)
    solution = solve_mooring(line(known, rope(80)), dense)
    assert solution.tension[-1] == pytest.approx(5000 + 10 * 9.80665 * 0.8)


def test_the_highest_of_several_equilibria_is_found_and_another_is_told():
    """An undercurrent that starts 60 m down holds the float there once it has been drawn in."""
    under = water(400, (0, 0, 0, 0), (120, 0, 0, 0), (180, 2.2, 0, 0), (400, 2.2, 0, 0))
    solution = solve_mooring(line(rigid(1.0, 1500.0, drag=700.0), rope(290)), under)
    assert solution.other is None or solution.other.depth > depths(solution)[0]


def test_nothing_lifts_the_line():
    error = refused(line(rigid(1.0, -10.0), rope(50, weight=10)), water(100))
    assert error.status == "no-equilibrium"
    assert "buoyancy of the buoyant pieces is 0 N" in error.message
    assert "510 N" in error.message


def test_too_little_buoyancy_for_what_hangs_above_a_lower_float():
    """The weight would land and the float below it lift the rope off again."""
    sunk = line(rigid(1.0, 100.0), rigid(1.0, -900.0), rope(20), rigid(1.0, 300.0), rope(30))
    error = refused(sunk, water(100))
    assert error.status == "no-equilibrium"
    assert "buoyancy of the buoyant pieces is 400 N" in error.message
    assert "900 N" in error.message


def test_whether_a_line_is_held_up_depends_on_the_water():
    """0.3 m³ lift 74 N less in fresh water: a line with 10 N to spare at 1025 does not stand."""
    ball = rigid(1.0, 70.0, drag=100.0, volume=0.3)
    barely = line(ball, rigid(1.0, -50.0), rope(50, weight=0.2), rigid(1.0, -1.0))
    assert solve_mooring(barely, water(100)).force[-1, 2] > 0
    fresh = refused(barely, water(100, density=1000.0))
    assert fresh.status == "no-equilibrium"


def test_a_slack_surface_line_without_current():
    error = refused(line(FLOAT, rope(120, weight=0.5)), water(100))
    assert error.status == "slack"
    # the length is 121 m in 100 m of water: √(121² − 100²) = 68.1
    assert "121.0 m unstretched" in error.message
    assert "radius of 68.1 m" in error.message


def test_a_tether_folds_where_only_the_water_below_it_moves():
    """The limit of a weak current: nothing pulls the tether sideways, it hangs like an S, plumb.

    Below the surface V of lift is in use. The sinking half of w N/m comes down V / w and turns,
    the floating one of b N/m rises what is left of the sinking half's weight and turns again:
    in all 2 V / w - 35 + 25 - 2 (35 w - V) / b = 39 m lower, from the foot of the float at 1 m.
    """
    tether = rope(35, weight=3.0), rope(25, weight=-4.0)
    below = rigid(1.0, 6000.0, drag=250.0), rope(159, weight=2.0)
    slack = line(rigid(1.0, 3000.0, drag=250.0), *tether, *below)
    currents = (0, 0, 0, 0), (70, 0, 0, 0), (200, 0.2, 0, 0)
    solution = solve_mooring(slack, water(200, *currents))
    lift = (39.0 + 10.0 + 2.0 * 105.0 / 4.0) / (2.0 / 3.0 + 2.0 / 4.0)
    foot = solution.piece_nodes[1]
    # what the wire below leans, and the breath of current, are within a millimetre and 1 mN
    assert solution.tension[foot] == pytest.approx([lift, 105.0 - lift], abs=1e-3)
    assert depths(solution)[2:4] == pytest.approx([1.0 + 2.0 * lift / 3.0 - 35.0, 40.0], abs=1e-3)
    assert np.ptp(solution.position[: solution.piece_nodes[2, 1], :2], axis=0).max() < 1e-4


def test_a_line_that_hangs_on_a_lower_float_at_rest():
    folded = line(rigid(1.0, 100.0), rigid(1.0, -300.0), rope(20), rigid(1.0, 900.0), rope(30))
    error = refused(folded, water(100))
    assert (error.status, error.piece) == ("slack", 1)


def test_a_buoyant_rope_longer_than_the_water_is_deep():
    error = refused(line(FLOAT, rope(200, weight=-0.8)), water(100, (0, 0.3, 0, 0)))
    assert error.status == "above-surface"


def test_a_buoyant_piece_may_not_lie_on_the_seabed():
    low = line(FLOAT, rope(80, weight=0.5), rope(60, weight=60), rigid(0.5, 20.0), rope(9, 10))
    error = refused(low, water(100, (0, 0.5, 0, 0)))
    assert error.status == "grounded"
    assert error.piece is not None


def test_dragged_down_to_the_seabed():
    flat = line(rigid(0.5, 20.0, drag=400.0), rope(50, diameter=0.03))
    solution = solve_mooring(flat, water(60, (0, 2.5, 0, 0)))
    assert 55 < depths(solution)[0] < 60


def test_finer_segments_until_the_estimate_is_good():
    """A light float in a strong shear bends the line over a few metres near the top."""
    bent = line(rigid(0.3, 150.0, drag=20.0), rope(900, weight=0.02, diameter=0.012))
    jet = water(1000, (0, 1.5, 0, 0), (140, 1.2, 0, 0), (200, 0.1, 0, 0), (1000, 0.02, 0, 0))
    solution = solve_mooring(bent, jet)
    reference = solve_mooring(bent, jet, Settings(radians(0.05)))
    assert abs(depths(solution)[0] - depths(reference)[0]) < 5e-5 * 1000
    assert solution.tension[-1] == pytest.approx(reference.tension[-1], rel=2e-4)


def test_settings_have_limits():
    with pytest.raises(ValueError, match="angle_step"):
        Settings(angle_step=0)
    with pytest.raises(ValueError, match="tolerance"):
        Settings(tolerance=1e-3)


def test_a_tolerance_is_kept():
    tight = replace(Settings(), tolerance=1e-11)
    taut = line(FLOAT, rope(80, weight=2.0, stiffness=1e5))
    solution = solve_mooring(taut, water(200, (0, 0.9, 0, 0), (200, 0.1, 0, 0)), tight)
    assert abs(solution.miss) <= 1e-11 * 200


def test_a_segment_in_shear_is_in_balance_with_a_curve_too() -> None:
    """Its current is that of its middle, whatever its tensions are."""
    current = [1.0, 0.2]
    water = Water(100.0, [0.0, 100.0], current, [0.0, 0.0], [0.0, 0.0], [1025.0, 1025.0])
    curve = ElongationCurve([(0.05, 0.05), (0.1, 0.08), (0.2, 0.12)], 3e4, 0.04)
    line = Line(
        length=[0.0, 60.0], flexible=[False, True], buoyancy=[3000.0, -0.5], volume=[0.0, 0.0],
        normal_drag=[200.0, 8.0], tangential_drag=[200.0, 0.1], directional=[False, True],
        compliance=[0.0, 0.0], thinning=[0.0, 0.5], clamp_piece=[], clamp_at=[],
        clamp_buoyancy=[], clamp_volume=[], clamp_drag=[], elongation=(None, curve),
    )  # fmt: skip
    solution = solve_mooring(line, water)  # which refuses loads that do not sum to 1e-6
    assert solution.closure < 1e-9
