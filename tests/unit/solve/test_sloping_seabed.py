"""A line whose lower part lies on a seabed that slopes: by closed form, turned, and level again."""

from dataclasses import replace
from math import asinh, cos, hypot, radians, sin, tan

import numpy as np
import pytest

from calm.errors import NoEquilibrium
from calm.solve import Settings, solve_mooring
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import solve_net
from tests.unit.solve.simple import line, rigid, rope, water

DEPTH, SPEED, WEIGHT, LENGTH = 200.0, 0.5, 60.0, 150.0
FLOAT = rigid(0.0, 5000.0, drag=8000.0)
PULL = 8000.0 * SPEED**2
FINE = Settings(angle_step=radians(0.1))


def sloping(slope, toward, *levels):
    """Water over a seabed that gets deeper towards a direction [degrees]."""
    steep, way = tan(radians(slope)), radians(toward)
    return replace(
        water(DEPTH, *(levels or [(0, SPEED, 0, 0)])),
        deeper_east=steep * sin(way),
        deeper_north=steep * cos(way),
    )


def catenary(slope, friction):
    """The top of a chain pulled by (2000 N, 5000 N) from a bed that falls by `slope` the way of the
    pull: places from the anchor, tension there, and how much lies.

    Where it comes down the force lies in the bed: V - w s = -H tan(slope). Above, tension differs
    by w times height and the rest is the catenary; below, by w sin(slope) per metre less friction.
    """
    steep = radians(slope)
    low = -PULL * tan(steep)
    hung = (5000.0 - low) / WEIGHT
    lying, reached = LENGTH - hung, PULL / cos(steep)
    height = (hypot(PULL, 5000.0) - reached) / WEIGHT
    out = PULL / WEIGHT * (asinh(5000.0 / PULL) - asinh(low / PULL))
    held = reached - (friction * cos(steep) - sin(steep)) * WEIGHT * lying
    east = lying * cos(steep) + out
    return east, height - lying * sin(steep), max(held, 0.0), lying


@pytest.mark.parametrize("slope", [-20.0, -5.0, 0.0, 5.0, 20.0])
@pytest.mark.parametrize("friction", [0.0, 0.4, 2.0])
def test_a_chain_comes_down_on_a_slope_as_the_catenary_does(slope, friction):
    """A chain without drag and stretch below a float whose pull is known.

    Tolerance: the error of segments of 0.1°, 1e-6 of the depth and of the tension.
    """
    chain = line(FLOAT, rope(LENGTH, weight=WEIGHT, cn=0.0))
    settings = replace(FINE, seabed_friction=friction)
    solution = solve_mooring(chain, sloping(abs(slope), 90 if slope >= 0 else 270), settings)
    east, height, held, lying = catenary(slope, friction)
    assert solution.landed
    assert solution.closure < 1e-9
    assert solution.position[0] == pytest.approx([east, 0.0, height - DEPTH], abs=2e-4)
    assert solution.grounded_length == pytest.approx(lying, abs=2e-4)
    assert solution.tension[-1] == pytest.approx(held, abs=0.01)
    assert solution.position[-1, 2] == pytest.approx(-DEPTH, abs=2e-5)
    bed = -DEPTH - tan(radians(slope)) * solution.position[solution.hanging :, 0]
    assert solution.position[solution.hanging :, 2] == pytest.approx(bed, abs=2e-5)


def clamped(weight):
    """A chain with clamps and a rigid piece of a weight, of which it can lift some 1300 N."""
    return line(
        FLOAT, rope(20, weight=5), rope(60, weight=WEIGHT, stiffness=1e6), rigid(1.5, -weight),
        rope(80, weight=WEIGHT), clamps=[(2, 55.0, -80.0, 2.0), (4, 30.0, -80.0, 2.0)],
    )  # fmt: skip


CLAMPED = clamped(900.0)
SHEARED = (0.0, 0.8, 0.1, 0), (DEPTH, 0.2, 0.3, 0)


@pytest.mark.parametrize(
    ("weight", "least", "most"), [(900, 60, 79), (1900, 80, 80.0), (3200, 81.5, 90)]
)
def test_slope_and_current_turn_together(weight, least, most):
    """Turned by 50°, a line whose rigid piece hangs, stands or lies only turns with them."""
    turn = radians(50.0)
    turned = [
        (z, u * cos(turn) + v * sin(turn), v * cos(turn) - u * sin(turn), w)
        for z, u, v, w in SHEARED
    ]
    settings = Settings(seabed_friction=0.3)
    one = solve_mooring(clamped(weight), sloping(12, 30, *SHEARED), settings)
    other = solve_mooring(clamped(weight), sloping(12, 80, *turned), settings)
    east, north, up = other.position.T
    back = np.stack(
        [east * cos(turn) - north * sin(turn), north * cos(turn) + east * sin(turn), up]
    )
    assert one.landed
    assert least <= one.grounded_length <= most
    assert one.closure < 1e-9
    assert np.allclose(back.T, one.position, rtol=0.0, atol=1e-4)
    lying = one.element_clamp[one.hanging :] < 0
    assert (one.cut[one.hanging :][lying] > 0.0).all()
    assert other.tension == pytest.approx(one.tension, rel=1e-6, abs=1e-3)


def test_a_slope_of_nothing_is_level_to_the_last_digit():
    settings = Settings(seabed_friction=0.3)
    level = solve_mooring(CLAMPED, water(DEPTH, *SHEARED), settings)
    none = solve_mooring(CLAMPED, sloping(0, 77, *SHEARED), settings)
    assert level.landed
    assert (level.position == none.position).all()
    assert (level.force == none.force).all()
    near = solve_mooring(CLAMPED, sloping(1e-7, 77, *SHEARED), settings)
    assert near.position == pytest.approx(level.position, abs=1e-3)  # that of 1e-7 of the depth


def test_what_nothing_pulls_lies_across_the_slope():
    """In still water the float's 5000 N lift 83 m of chain; the rest is as deep as its anchor."""
    chain = line(FLOAT, rope(LENGTH, weight=WEIGHT))
    solution = solve_mooring(chain, sloping(15, 30, (0, 0, 0, 0)))
    assert solution.grounded_length == pytest.approx(LENGTH - 5000.0 / WEIGHT)
    assert solution.position[solution.hanging :, 2] == pytest.approx(-DEPTH, abs=1e-5)
    across = solution.position[0, :2] @ [sin(radians(30)), cos(radians(30))]
    assert across == pytest.approx(0.0, abs=1e-9)


def test_a_line_that_comes_below_the_slope_is_refused():
    """Pulled by 1500 N and up by 900 N it rises by 31°, less than the bed does."""
    low = line(rigid(0.0, 900.0, drag=6000.0), rope(60, weight=1.0, cn=0.0))
    assert solve_mooring(low, sloping(40, 90)).position[0, 0] > 50.0
    with pytest.raises(NoEquilibrium, match="would touch the seabed"):
        solve_mooring(low, sloping(40, 270))


@pytest.mark.parametrize("toward", [90, 270, 200])
def test_a_leg_lies_on_the_slope_as_the_line_does(toward):
    """A net of one leg from its free end to its anchor is the single line."""
    sea, settings = sloping(10, toward, *SHEARED), Settings(seabed_friction=0.1)
    single = solve_mooring(CLAMPED, sea, settings)
    deeper = (sea.deeper_east, sea.deeper_north)
    foot = LegEnd(place=(300.0, -40.0, -DEPTH), seabed=-DEPTH, deeper=deeper)
    leg = solve_net([NetLeg(CLAMPED, LegEnd(), foot)], 0, sea, settings).legs[0]
    assert leg.landed
    assert leg.grounded_length == pytest.approx(single.grounded_length, abs=2e-3)
    there = leg.position[leg.piece_nodes[:, 0]] - [300.0, -40.0, 0.0]
    assert there == pytest.approx(single.position[single.piece_nodes[:, 0]], abs=5e-3)
    assert leg.tension[-1] == pytest.approx(single.tension[-1], rel=2e-4)
