"""Lines that rise, by hand: at terminal speed drag is as much as the net buoyancy."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.physics.drag import Friction
from calm.physics.line import Water
from calm.physics.reynolds import DragCurve, sphere_coefficient
from calm.solve import part_of, plumb_speed, solve_rise
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


def trailing(*below):
    """Glass above a steel cable, and what trails from it."""
    ball = rigid(0.5, 225.0, drag=100.0, tangential=100.0)
    return line(ball, ball, rope(18.0, weight=1.8, diameter=0.011, ct=0.005), ball, ball, *below)


TAILS = [
    pytest.param(rope(20.0, weight=-0.0867, diameter=0.013, ct=0.013), id="buoyant"),
    pytest.param(rope(200.0, weight=0.2, diameter=0.019, ct=0.013, stiffness=1e5), id="sinking"),
    pytest.param(rope(300.0, weight=0.0, diameter=0.008, ct=0.01), id="neutral"),
]


@pytest.mark.parametrize("tail", TAILS)
def test_a_rope_tail_rises_where_the_loads_cancel(tail):
    """Summed over the parts by hand, without a march: weight, buoyancy and drag along the line.

    The cable doubles back above a float that is faster than it.
    """
    trail = trailing(tail)
    along = np.where(trail.directional, trail.tangential_drag, trail.normal_drag)
    stretch = 1.001  # of the sinking rope, by which its drag grows
    drag = float((along * np.where(trail.flexible, trail.length, 1.0)).sum())
    expected = sqrt(float(trail.total_buoyancy.sum()) / drag)
    motion = solve_rise(trail, STILL, 30.0)
    assert motion.velocity[2] == pytest.approx(expected, rel=stretch - 1.0)
    assert plumb_speed(trail, STILL, 30.0) == pytest.approx(expected, rel=1e-9)
    assert motion.solution.closure < 1e-8


@pytest.mark.parametrize("lift, ct", [(0.0867, 0.013), (0.0049, 0.0087)])
def test_a_bare_buoyant_rope_rises_at_the_speed_at_which_nothing_pulls_along_it(lift, ct):
    bare = line(rope(322.5, weight=-lift, diameter=0.013, ct=ct))
    friction = 512.5 * np.pi * 0.013 * ct
    assert plumb_speed(bare, STILL, 0.0) == pytest.approx(sqrt(lift / friction), rel=1e-9)


def test_a_plumb_speed_counts_clamps_density_and_lift():
    sea = Water(1000.0, [0.0, 1000.0], *np.zeros((3, 2)), [1000.0, 1050.0])
    mixed = replace(
        line(
            rigid(0.0, 800.0, drag=100.0, volume=0.2),
            rope(100.0),
            clamps=[(1, 50.0, -90.0, 9.0)],
        ),
        lift=[3.0, 0.0],
    )
    share = np.array([1020.0, 1022.5]) / 1025.0
    lift = 800.0 - 90.0 + (1020.0 - 1025.0) * 9.80665 * 0.2
    friction = share @ [100.0 - 3.0, 9.0 + 100.0 * mixed.tangential_drag[1]]
    assert plumb_speed(mixed, sea, 400.0) == pytest.approx(sqrt(lift / friction), rel=1e-9)
    assert solve_rise(mixed, sea, 400.0).velocity[2] == pytest.approx(
        plumb_speed(mixed, sea, 400.0), rel=1e-4
    )


def test_a_plumb_speed_of_smooth_spheres_is_that_of_the_march():
    curve = DragCurve(0.3)
    ball = replace(line(rigid(0.0, 60.0, drag=18.0)), drag_curve=(curve,))
    assert plumb_speed(ball, STILL, 100.0) == pytest.approx(
        float(solve_rise(ball, STILL, 100.0).velocity[2]), rel=1e-8
    )


def test_a_shackle_that_leans_on_the_float_below_it_tangles_with_nothing():
    """Of a chain with glass on it, the part above the first ball falls back; it is short."""
    top = rigid(0.0, -5.0, drag=1.0), rope(1.0, weight=20.0, diameter=0.03)
    float_below = rigid(0.5, 2000.0, drag=200.0), rope(100.0, 2.0)
    assert solve_rise(line(*top, *float_below), STILL, 100.0).tangles == ()
    longer = rigid(0.0, -5.0, drag=1.0), rope(3.0, weight=20.0, diameter=0.03)
    assert 1 in solve_rise(line(*longer, *float_below), STILL, 100.0).tangles
