"""CALM's march against the closed forms of `calm.analytic`, which share nothing with it.

The march is of second order in its angle step: along every line below, at every node looked at, it
stays within 1e-5 (step/1°)² of the line's length and of the tension. At 1° it comes to 7e-6. The
order itself is a case of `calm.verification.march_properties`.
"""

from __future__ import annotations

from math import atan2, hypot, radians

import numpy as np
import pytest

from calm.analytic.catenary import Catenary
from calm.analytic.uniform import critical_angle, heavy_line, neutral_line
from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, solve_mooring
from tests.validation.pieces import Piece, cable, line_of, point, sphere_drag, stream

FLOAT = point(4905.0, sphere_drag(1.0, 0.65))
LENGTH, DIAMETER, CN = 1000.0, 0.0127, 1.3

steps = pytest.mark.parametrize("step", [1.0, 0.25], ids=lambda step: f"{step}°")
speeds = pytest.mark.parametrize("speed", [0.3, 0.5, 1.0, 1.4], ids=lambda speed: f"{speed} m/s")


def allowed(step: float) -> float:
    return 1e-5 * step**2


def solved(line: Line, water: Water, step: float) -> Solution:
    return solve_mooring(line, water, Settings(radians(step), 1e-9))


def along(solution: Solution) -> tuple[np.ndarray, ...]:
    """Seven nodes of a line's last piece: unstretched arc and upstream distance from its top,
    height above its top, tension."""
    first, last = solution.piece_nodes[-1]
    arc = np.concatenate([[0.0], np.cumsum(solution.cut[first:last])])
    chosen = np.linspace(0, last - first, 7).astype(int)
    place = solution.position[first + chosen]
    top = solution.position[first]
    return arc[chosen], top[0] - place[:, 0], place[:, 2] - top[2], solution.tension[first + chosen]


@steps
@speeds
def test_neutral_line(speed, step) -> None:
    rope = cable(LENGTH, DIAMETER, 0.0, CN, 0.0)
    solution = solved(line_of(FLOAT, rope), stream(1010.0, speed), step)
    arc, upstream, height, tension = along(solution)
    drag, normal_drag = FLOAT.normal_drag * speed**2, rope.normal_drag * speed**2
    pull = hypot(FLOAT.buoyancy, drag)
    exact = neutral_line(-arc, pull, atan2(FLOAT.buoyancy, -drag), normal_drag)
    assert upstream == pytest.approx(exact.x, abs=LENGTH * allowed(step))
    assert height == pytest.approx(exact.z, abs=LENGTH * allowed(step))
    # constant whatever the step; extrapolated forces keep their size to the fourth order
    assert along(solution.as_marched)[3] == pytest.approx(pull, rel=1e-13)
    assert tension == pytest.approx(pull, rel=1e-7)


@steps
@speeds
@pytest.mark.parametrize("ct", [0.0, 0.01])
def test_heavy_line_below_its_float(ct, speed, step) -> None:
    rope = cable(LENGTH, DIAMETER, 2.0, CN, ct)
    arc, upstream, height, tension = along(
        solved(line_of(FLOAT, rope), stream(1010.0, speed), step)
    )
    drag = FLOAT.normal_drag * speed**2
    normal, tangential = rope.normal_drag * speed**2, rope.tangential_drag * speed**2
    pull, angle = hypot(FLOAT.buoyancy, drag), atan2(FLOAT.buoyancy, -drag)
    exact = heavy_line(-arc, pull, angle, 2.0, normal, tangential)
    assert upstream == pytest.approx(exact.x, abs=LENGTH * allowed(step))
    assert height == pytest.approx(exact.z, abs=LENGTH * allowed(step))
    assert tension == pytest.approx(exact.tension, rel=allowed(step))


@steps
@speeds
@pytest.mark.parametrize("ct", [0.0, 0.01])
def test_buoyant_line_is_a_towed_cable_upside_down(ct, speed, step) -> None:
    """The float is the towed body, the anchor the ship: angles below 90°."""
    rope = cable(LENGTH, DIAMETER, -1.0, CN, ct)
    arc, upstream, height, tension = along(
        solved(line_of(FLOAT, rope), stream(1010.0, speed), step)
    )
    drag = FLOAT.normal_drag * speed**2
    normal, tangential = rope.normal_drag * speed**2, rope.tangential_drag * speed**2
    pull, angle = hypot(FLOAT.buoyancy, drag), atan2(FLOAT.buoyancy, drag)
    exact = heavy_line(arc, pull, angle, 1.0, normal, tangential)
    assert upstream == pytest.approx(exact.x, abs=LENGTH * allowed(step))
    assert -height == pytest.approx(exact.z, abs=LENGTH * allowed(step))
    assert tension == pytest.approx(exact.tension, rel=allowed(step))


@pytest.mark.parametrize("speed", [0.2, 0.5, 1.0])
def test_buoyant_line_without_float_is_straight_at_the_critical_angle(speed) -> None:
    rope = cable(200.0, 0.02, -1.5, CN, 0.0)
    arc, upstream, height, tension = along(solved(line_of(rope), stream(210.0, speed), 1.0))
    angle = float(critical_angle(1.5 / (rope.normal_drag * speed**2)))
    # a straight line is exact whatever the step; rounding grows along a thousand segments
    assert upstream == pytest.approx(arc * np.cos(angle), abs=1e-9)
    assert -height == pytest.approx(arc * np.sin(angle), abs=1e-9)
    assert tension == pytest.approx(1.5 * np.sin(angle) * arc, abs=1e-9)


@steps
@pytest.mark.parametrize("stiffness", [np.inf, 3e4], ids=["rigid", "elastic"])
def test_catenary(stiffness, step) -> None:
    """The current pushes the float alone: the line has no drag."""
    rope = Piece(LENGTH, True, -4.0, compliance=1.0 / stiffness, thinning=0.5)
    float_drag = point(4905.0, 1200.0)
    arc, upstream, height, tension = along(
        solved(line_of(float_drag, rope), stream(1200.0, 1.0), step)
    )
    exact = Catenary(1200.0, 4905.0, LENGTH, 4.0, stiffness)
    x, z = exact.position(LENGTH - arc)
    assert upstream == pytest.approx(x[0] - x, abs=LENGTH * allowed(step))
    assert height == pytest.approx(z - z[0], abs=LENGTH * allowed(step))
    assert tension == pytest.approx(np.hypot(1200.0, 4905.0 - 4.0 * arc), rel=1e-12)


@steps
@pytest.mark.parametrize("stiffness", [np.inf, 3e4], ids=["rigid", "elastic"])
def test_catenary_that_touches_down(stiffness, step) -> None:
    """A float at the surface is pulled by 1200 N and must lift 4905 N of a line of 20 N/m."""
    rope = Piece(LENGTH, True, -20.0, compliance=1.0 / stiffness, thinning=0.5)
    exact = Catenary(1200.0, 4905.0, LENGTH, 20.0, stiffness, seabed=True)
    x, depth = exact.end
    assert exact.grounded == pytest.approx(LENGTH - 4905.0 / 20.0)
    solution = solved(line_of(point(9000.0, 1200.0), rope), stream(float(depth), 1.0), step)
    assert solution.buoyancy_used * 9000.0 == pytest.approx(4905.0, rel=allowed(step))
    assert solution.grounded_length == pytest.approx(exact.grounded, abs=LENGTH * allowed(step))
    assert solution.position[0, 0] == pytest.approx(x, abs=LENGTH * allowed(step))
    assert solution.tension[-1] == pytest.approx(exact.tension_bottom, rel=1e-12)
