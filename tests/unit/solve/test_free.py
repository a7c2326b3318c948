"""Lines that rise, by hand: at terminal speed drag is as much as the net buoyancy."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.drag import Friction
from calm.physics.line import Water
from calm.physics.reynolds import DragCurve, sphere_coefficient
from calm.solve import part_of, solve_rise
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


def tensions(motion):
    """At the upper and the lower end of every piece [N]."""
    return motion.solution.tension[motion.solution.piece_nodes]


def test_ten_glass_balls_that_lift_80_kg():
    """17 in balls of 25.4 kgf each, Cd A 2.4 m² together: 1.18 m/s."""
    balls = line(rigid(0.0, (254.0 - 80.0) * 9.80665, drag=0.5 * 1025.0 * 2.4))
    assert solve_rise(balls, STILL, 100.0).velocity[2] == pytest.approx(1.18, abs=0.005)


def test_a_rise_begins_where_it_is_told():
    motion = solve_rise(MOORING, SHEARED, 120.0)
    assert motion.solution.position[0, 2] == pytest.approx(-120.0)
    assert motion.solution.position[-1, 2] < -120.0 - 800.0
    assert motion.solution.force[-1] == pytest.approx(np.zeros(3))


def test_in_a_uniform_current_a_line_drifts_with_it():
    still = solve_rise(MOORING, STILL, 100.0)
    sea = water(1000.0, (0.0, 0.4, -0.3, 0.05), (700.0, 0.4, -0.3, 0.05))
    drifting = solve_rise(MOORING, sea, 100.0)
    assert drifting.velocity == pytest.approx(np.add(still.velocity, [0.4, -0.3, 0.05]), rel=CLOSED)
    assert tensions(drifting) == pytest.approx(tensions(still), rel=1e-7, abs=1e-5)
    assert not drifting.solution.position[:, :2].any()


def test_the_motion_turns_with_the_current():
    turn = np.radians(110.0)
    u, v = np.cos(turn), np.sin(turn)
    turned = replace(SHEARED, u=u * SHEARED.u - v * SHEARED.v, v=v * SHEARED.u + u * SHEARED.v)
    east, north, up = solve_rise(MOORING, SHEARED, 100.0).velocity
    assert up != pytest.approx(
        solve_rise(MOORING, STILL, 100.0).velocity[2], rel=1e-4
    )  # the shear matters
    expected = [u * east - v * north, v * east + u * north, up]
    # the segments are chosen for a current, and not quite the same for one that is turned
    assert solve_rise(MOORING, turned, 100.0).velocity == pytest.approx(expected, abs=1e-5)


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
    plumb = [solve_rise(mooring, STILL, 100.0).velocity[2] for mooring in (MOORING, along)]
    assert plumb[0] == pytest.approx(plumb[1], rel=CLOSED)


def test_without_any_drag_nothing_limits_the_speed():
    with pytest.raises(NoEquilibrium, match="rise speed of the line is unlimited") as refusal:
        solve_rise(line(rigid(0.0, 100.0)), STILL, 100.0)
    assert refusal.value.status == "no-equilibrium"


def test_a_part_of_a_line_keeps_its_clamps():
    part = part_of(MOORING, 1, 4)
    assert part.length == pytest.approx([500.0, 0.8, 300.0])
    assert (part.clamp_piece.tolist(), part.clamp_at.tolist()) == ([0], [200.0])
    assert len(part_of(MOORING, 2, 6).clamp_piece) == 0
