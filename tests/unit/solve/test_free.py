"""Lines that fall and rise, by hand: at terminal speed drag is as much as the net weight."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.drag import Friction
from calm.physics.line import Water
from calm.physics.reynolds import DragCurve, sphere_coefficient
from calm.solve import FallingAnchor, part_of, solve_fall, solve_rise
from tests.unit.solve.simple import line, rigid, rope, water

CLOSED = 1e-8  # ten times what is left of the forces, as a share of the net weight

STILL = water(1000.0)
SHEARED = water(1000.0, (0.0, 0.8, 0.1, 0.0), (300.0, 0.2, 0.3, 0.0), (1000.0, 0.05, 0.0, 0.0))
MOORING = line(
    rigid(1.0, 3000.0, drag=250.0, tangential=250.0),
    rope(500.0, weight=0.8, diameter=0.008, ct=0.01),
    rigid(0.8, -150.0, drag=40.0, tangential=10.0, directional=True),
    rope(300.0, weight=-0.1, diameter=0.014, ct=0.013, stiffness=2e5),
    rigid(0.0, 500.0, drag=60.0),
    rope(50.0, weight=2.0, diameter=0.02, ct=0.005),
    clamps=[(1, 200.0, -80.0, 12.0)],
)
ANCHOR = FallingAnchor(weight=9000.0, drag=500.0)


def tensions(motion):
    """At the upper and the lower end of every piece [N]."""
    return motion.solution.tension[motion.solution.piece_nodes]


@pytest.mark.parametrize(("area", "speed"), [(4.0, 3.53), (2.0, 5.00)])
def test_an_anchor_of_three_tonnes_of_steel(area, speed):
    """Cd A of 4 m² and 2 m², 25.6 kN in water: V = sqrt(2 F / (ρ Cd A))."""
    nothing = line(rigid(0.0, 0.0))
    motion = solve_fall(nothing, STILL, FallingAnchor(25.6e3, 0.5 * 1025.0 * area))
    assert -motion.velocity[2] == pytest.approx(speed, abs=0.005)  # two digits are published


@pytest.mark.parametrize("density", [1000.0, 1200.0])
def test_an_anchor_falls_by_the_density_of_the_water_at_the_seabed(density):
    """K is that in reference water: V = sqrt(W 1025 / (K ρ))."""
    fall = solve_fall(line(rigid(0.0, 0.0)), water(1000.0, density=density), ANCHOR)
    speed = sqrt(9000.0 * 1025.0 / (500.0 * density))
    assert fall.velocity == pytest.approx([0.0, 0.0, -speed], rel=CLOSED)


def test_ten_glass_balls_that_lift_80_kg():
    """17 in balls of 25.4 kgf each, Cd A 2.4 m² together: 1.18 m/s."""
    balls = line(rigid(0.0, (254.0 - 80.0) * 9.80665, drag=0.5 * 1025.0 * 2.4))
    assert solve_rise(balls, STILL, 100.0).velocity[2] == pytest.approx(1.18, abs=0.005)


def test_a_plumb_line_falls_by_the_sum_of_its_drags():
    """Friction along the rope, the face of the cylinder, all of what has no direction."""
    lift = 3000.0 - 400.0 - 150.0 - 80.0
    drag = 250.0 + 512.5 * np.pi * 0.01 * 0.008 * 500.0 + 10.0 + 12.0 + 500.0
    motion = solve_fall(part_of(MOORING, 0, 3), STILL, ANCHOR)
    assert motion.velocity == pytest.approx([0.0, 0.0, -sqrt((9000.0 - lift) / drag)], rel=CLOSED)


def test_what_a_falling_line_bears():
    """Below the float its lift and its drag; at the anchor what its own drag does not carry."""
    motion = solve_fall(MOORING, STILL, ANCHOR)
    squared, tension = float(motion.velocity[2]) ** 2, motion.solution.tension
    first, last = motion.solution.piece_nodes.T
    assert tension[first[0]] == 0.0
    assert tension[last[0]] == pytest.approx(3000.0 + 250.0 * squared, rel=CLOSED)
    along = 512.5 * np.pi * 0.01 * 0.008 * 500.0 + 12.0
    assert tension[last[1]] - tension[first[1]] == pytest.approx(along * squared - 480.0, rel=1e-7)
    assert tension[-1] == pytest.approx(9000.0 - 500.0 * squared, rel=1e-7)
    assert motion.tangles == ()


def test_a_falling_line_is_followed_to_the_seabed():
    motion = solve_fall(replace(MOORING, anchor_height=0.7), SHEARED, ANCHOR)
    assert motion.solution.position[-1] == pytest.approx([0.0, 0.0, -999.3], abs=1e-5)


def test_a_line_that_stretches_has_its_upper_end_higher():
    elastic = line(rigid(0.0, 2000.0, drag=100.0), rope(400.0, stiffness=1e5))
    motion = solve_fall(elastic, STILL, FallingAnchor(6000.0, 300.0))
    tension = float(motion.solution.tension[-1])
    expected = -1000.0 + 400.0 * (1.0 + tension / 1e5)
    assert motion.solution.position[0, 2] == pytest.approx(expected, abs=1e-5)


def test_a_rise_begins_where_it_is_told():
    motion = solve_rise(MOORING, SHEARED, 120.0)
    assert motion.solution.position[0, 2] == pytest.approx(-120.0)
    assert motion.solution.position[-1, 2] < -120.0 - 800.0
    assert motion.solution.force[-1] == pytest.approx(np.zeros(3))


@pytest.mark.parametrize("solve", [lambda w: solve_fall(MOORING, w, ANCHOR),
                                   lambda w: solve_rise(MOORING, w, 100.0)])  # fmt: skip
def test_in_a_uniform_current_a_line_drifts_with_it(solve):
    still = solve(STILL)
    drifting = solve(water(1000.0, (0.0, 0.4, -0.3, 0.05), (700.0, 0.4, -0.3, 0.05)))
    assert drifting.velocity == pytest.approx(np.add(still.velocity, [0.4, -0.3, 0.05]), rel=CLOSED)
    assert tensions(drifting) == pytest.approx(tensions(still), rel=1e-7, abs=1e-5)
    assert not drifting.solution.position[:, :2].any()


@pytest.mark.parametrize("solve", [lambda w: solve_fall(MOORING, w, ANCHOR),
                                   lambda w: solve_rise(MOORING, w, 100.0)])  # fmt: skip
def test_the_motion_turns_with_the_current(solve):
    turn = np.radians(110.0)
    u, v = np.cos(turn), np.sin(turn)
    turned = replace(SHEARED, u=u * SHEARED.u - v * SHEARED.v, v=v * SHEARED.u + u * SHEARED.v)
    east, north, up = solve(SHEARED).velocity
    assert up != pytest.approx(solve(STILL).velocity[2], rel=1e-4)  # the shear matters
    expected = [u * east - v * north, v * east + u * north, up]
    # the segments are chosen for a current, and not quite the same for one that is turned
    assert solve(turned).velocity == pytest.approx(expected, abs=1e-5)


def test_a_faster_drift_makes_no_difference_to_the_shape():
    moved = replace(SHEARED, u=SHEARED.u + 1.5, v=SHEARED.v - 0.5)
    one, other = (solve_rise(MOORING, sea, 100.0) for sea in (SHEARED, moved))
    assert other.velocity == pytest.approx(np.add(one.velocity, [1.5, -0.5, 0.0]), abs=1e-6)
    assert tensions(other) == pytest.approx(tensions(one), rel=1e-5, abs=1e-3)


def test_a_part_that_overtakes_what_is_above_it_doubles_the_line_back():
    """1100 N on 500 N/(m/s)²; 880 N drag the upper float down, 780 N more than it lifts."""
    looped = line(rigid(0.0, 100.0, drag=400.0), rope(50.0), rigid(1.0, 1000.0, drag=100.0))
    motion = solve_rise(looped, STILL, 200.0)
    assert motion.velocity[2] == pytest.approx(sqrt(1100.0 / 500.0), rel=CLOSED)
    assert motion.tangles == (1, 2)
    assert motion.solution.force[motion.solution.piece_nodes[1], 2] == pytest.approx([-780.0] * 2)
    assert motion.solution.position[-1, 2] == pytest.approx(-200.0 + 51.0)


def test_what_pushes_without_length_is_told_too():
    pushed = line(rigid(0.0, 100.0, drag=400.0), rope(50.0), rigid(0.0, 1000.0, drag=100.0))
    assert solve_rise(pushed, STILL, 200.0).tangles == (1, 2)


def test_a_beacon_above_its_float_tangles_with_nothing():
    beacon = line(rigid(0.5, -50.0, drag=5.0), rigid(1.0, 2000.0, drag=200.0), rope(100.0, 2.0))
    assert solve_rise(beacon, SHEARED, 100.0).tangles == ()


def test_a_line_that_is_too_heavy_sinks():
    heavy = line(rigid(0.0, 500.0, drag=100.0), rigid(0.0, -900.0, drag=60.0))
    assert solve_rise(heavy, STILL, 100.0).velocity[2] == pytest.approx(-sqrt(400.0 / 160.0))


def test_drag_and_lift_go_with_the_density_at_their_depth():
    sea = Water(1000.0, [0.0, 1000.0], *np.zeros((3, 2)), [1000.0, 1050.0])
    motion = solve_rise(line(rigid(0.0, 800.0, drag=100.0, volume=0.2)), sea, 400.0)
    lift = 800.0 + (1020.0 - 1025.0) * 9.80665 * 0.2
    assert motion.velocity[2] == pytest.approx(sqrt(lift / (100.0 * 1020.0 / 1025.0)), rel=CLOSED)


def test_a_smooth_sphere_rises_by_its_curve():
    curve = DragCurve(0.3)
    ball = replace(line(rigid(0.0, 60.0, drag=18.0)), drag_curve=(curve,))
    speed = float(solve_rise(ball, STILL, 100.0).velocity[2])
    drag = 18.0 * sphere_coefficient(speed * 0.3 / STILL.viscosity[0]) / 0.5
    assert drag * speed**2 == pytest.approx(60.0, rel=1e-6)


def test_friction_by_pode_is_that_of_the_whole_speed():
    along = replace(MOORING, friction=Friction.CONSTANT)
    plumb = [solve_fall(mooring, STILL, ANCHOR).velocity[2] for mooring in (MOORING, along)]
    assert plumb[0] == pytest.approx(plumb[1], rel=CLOSED)


def test_a_line_more_buoyant_than_its_anchor_is_heavy_does_not_fall():
    with pytest.raises(NoEquilibrium, match="does not pull the line down") as refusal:
        solve_fall(MOORING, STILL, FallingAnchor(1000.0))
    assert refusal.value.status == "anchor-lifts"


def test_without_any_drag_nothing_limits_the_speed():
    with pytest.raises(NoEquilibrium, match="Nothing limits the speed") as refusal:
        solve_fall(line(rigid(0.0, 100.0)), STILL, FallingAnchor(1000.0))
    assert refusal.value.status == "no-equilibrium"


def test_a_part_of_a_line_keeps_its_clamps():
    part = part_of(MOORING, 1, 4)
    assert part.length == pytest.approx([500.0, 0.8, 300.0])
    assert (part.clamp_piece.tolist(), part.clamp_at.tolist()) == ([0], [200.0])
    assert len(part_of(MOORING, 2, 6).clamp_piece) == 0
