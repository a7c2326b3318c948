"""Legs of a net that lie on the seabed longer than the way to their anchors: against closed forms
of stiff chain in still water, and against an independent integration in a current.

A slack leg hangs plumb in still water, as long as its upper end is high, and pulls on nothing else.
"""

from __future__ import annotations

from dataclasses import replace
from math import asinh, hypot

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from calm.errors import NoEquilibrium
from calm.physics.hull import Floating, spherical_hull
from calm.physics.line import Floats, Line, Water
from calm.solve import Settings
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.leg_numbers import end_height
from calm.solve.net import solve_net
from tests.unit.solve.nets import Point, Wire, anchored, line_of, water_of
from tests.validation.cables import Cable, Way, follow
from tests.validation.loads import DOWN, Load, Profile, on_piece
from tests.validation.ropes import strain_law

FREE = LegEnd()
DEPTH = 200.0


def chain(length: float, weight: float = 50.0) -> Wire:
    """Chain too stiff to stretch."""
    return Wire(length, weight, diameter=0.02, stiffness=1e12)


def held_leg(length: float, away: float) -> NetLeg:
    """Chain from the surface to an anchor so far to the east."""
    top = LegEnd(place=(0.0, 0.0, 0.0))
    return NetLeg(line_of(chain(length)), top, anchored(away, 0.0, DEPTH))


@pytest.mark.parametrize("friction", [0.0, 0.6])
@pytest.mark.parametrize("away", [0.0, 60.0, 149.0])
def test_a_slack_leg_hangs_plumb(away: float, friction: float) -> None:
    """Of 350 m 200 m hang; 150 m lie where `away` would do, and pull on nothing."""
    settings = Settings(seabed_friction=friction)
    (leg,) = solve_net([held_leg(350.0, away)], 0, water_of(DEPTH), settings).legs
    assert leg.slack == pytest.approx(150.0 - away, abs=1e-4)
    assert leg.grounded_length == pytest.approx(150.0, abs=1e-4)
    assert leg.tension[0] == pytest.approx(50.0 * DEPTH, rel=1e-7)
    assert (leg.force[-1] == 0.0).all()
    assert leg.position[leg.hanging] == pytest.approx([0.0, 0.0, -DEPTH], abs=1e-4)
    assert leg.position[-1] == pytest.approx([away, 0.0, -DEPTH], abs=1e-9)
    assert float(leg.cut.sum()) == pytest.approx(350.0)


def pull_of(length: float, away: float) -> float:
    """Horizontal pull of such a leg that is not slack [N], and 0 of one that is.

    √(h² + 2 a h) m hang, a asinh(s / a) m reach out, the rest lies straight.
    """

    def gap(a: float) -> float:
        hung = hypot(DEPTH, 0.0) if a == 0.0 else float(np.sqrt(DEPTH**2 + 2.0 * a * DEPTH))
        return (a * asinh(hung / a) if a > 0.0 else 0.0) + length - hung - away

    return 50.0 * float(brentq(gap, 0.0, 1e4)) if gap(0.0) < 0.0 else 0.0


@pytest.mark.parametrize("further", [-1.0, -1e-3, 0.0, 1e-3, 0.1, 1.0, 10.0])
def test_a_leg_comes_taut_where_it_is_as_long_as_its_way(further: float) -> None:
    """About the distance at which 150 m lie straight without a pull."""
    (leg,) = solve_net([held_leg(350.0, 150.0 + further)], 0, water_of(DEPTH)).legs
    assert leg.slack == pytest.approx(max(-further, 0.0), abs=1e-4)
    pull = pull_of(350.0, 150.0 + further)
    # the error of the march is a share of the greatest tension, 10 kN
    assert abs(leg.force[-1, 0]) == pytest.approx(pull, abs=0.1)
    assert leg.tension[0] == pytest.approx(50.0 * DEPTH + pull, rel=1e-5)


@pytest.mark.parametrize(("a", "lift"), [(10.0, 5.0), (30.0, 70.0), (300.0, 40.0)])
def test_a_clump_stands_at_the_touchdown(a: float, lift: float) -> None:
    """The seabed bears a part of its 4000 N. The 210 m of chain above it are an arc of a catenary
    that begins with a pull H to the side and V up; H alone pulls along the 80 m below it.

    Parameters
    ----------
    a, lift : H and V in metres of chain, of 50 N each
    """
    upper = lift + 210.0
    high = hypot(a, upper) - hypot(a, lift)
    away = a * (asinh(upper / a) - asinh(lift / a)) + 80.0
    line = line_of(chain(210.0), Point(-4000.0, 0.3, 1.0), chain(80.0))
    leg = NetLeg(line, LegEnd(place=(0.0, 0.0, 0.0)), anchored(away, 0.0, high))
    (found,) = solve_net([leg], 0, water_of(high)).legs
    assert found.force[-1, 0] == pytest.approx(-50.0 * a, rel=1e-3)
    assert found.force[-1, 2] == 0.0
    assert found.grounded_length == pytest.approx(80.0, abs=1e-9)
    assert found.position[found.hanging, 0] == pytest.approx(away - 80.0, abs=1e-4 * high)
    assert found.tension[0] == pytest.approx(50.0 * hypot(a, upper), rel=1e-4)


def buoy(*legs: NetLeg, down: float = 60.0) -> list[NetLeg]:
    """A float at the surface above a node from which legs lead down."""
    hull = Floating(hull=spherical_hull(2.5), weight=10_000.0, lift=70_000.0)
    head = line_of(Point(70_000.0, 2.5, 0.5), chain(down))
    return [NetLeg(replace(head, floating=hull), FREE, LegEnd(node=0)), *legs]


def to_anchor(length: float, east: float, north: float) -> NetLeg:
    return NetLeg(line_of(chain(length)), LegEnd(node=0), anchored(east, north, DEPTH))


def test_a_slack_leg_beside_two_that_pull_adds_its_weight_alone() -> None:
    """Legs to the east and west are catenaries as if the third, from the north, were not there."""
    two = [to_anchor(250.0, x, 0.0) for x in (-180.0, 180.0)]
    alone = solve_net(buoy(*two), 1, water_of(DEPTH))
    both = solve_net(buoy(*two, to_anchor(300.0, 0.0, 100.0)), 1, water_of(DEPTH))
    assert [leg.slack for leg in alone.legs] == [0.0, 0.0, 0.0]
    assert both.nodes == pytest.approx(alone.nodes, abs=1e-3)
    up = DEPTH + both.nodes[0, 2]
    assert both.legs[3].slack == pytest.approx(300.0 - up - 100.0, abs=1e-3)
    assert both.legs[1].force[-1, 0] == pytest.approx(alone.legs[1].force[-1, 0], rel=1e-4)
    used = [70_000.0 * net.legs[0].buoyancy_used for net in (alone, both)]
    assert used[1] - used[0] == pytest.approx(50.0 * up, rel=1e-5)


def test_where_nothing_holds_a_net_sideways_it_is_slack() -> None:
    """Every leg is longer than its way: in still water the buoy may be anywhere between."""
    legs = buoy(*(to_anchor(300.0, x, 0.0) for x in (-100.0, 100.0)))
    with pytest.raises(NoEquilibrium, match="The net has no horizontal restraint") as refused:
        solve_net(legs, 1, water_of(DEPTH))
    assert refused.value.status == "slack"
    found = solve_net(legs, 1, water_of(DEPTH, (0.0, 0.3, 0.0)))
    assert [leg.slack > 0.0 for leg in found.legs] == [False, False, True]


def test_the_end_of_a_leg_rises_to_the_top_of_its_anchor() -> None:
    """From the seabed, without a jump, as it lifts as much as a piece as long as that is high."""

    class Leg:
        seabed, rise, lifts = -100.0, 0.8, 40.0

    heights = [end_height(Leg, False, pull) for pull in (-1.0, 0.0, 10.0, 40.0, 500.0)]  # type: ignore[arg-type]
    assert end_height(Leg, True, 0.0) == -100.0  # type: ignore[arg-type]
    assert heights == pytest.approx([-100.0, -100.0, -99.8, -99.2, -99.2])


@pytest.mark.parametrize("rise", [0.0, 0.8])
def test_lying_or_hanging_a_leg_is_one_curve(rise: float) -> None:
    """As its anchor is drawn away from under a buoy a leg first lies, then pulls upwards."""
    pulls = []
    for away in np.linspace(150.0, 215.0, 14):
        end = replace(anchored(away, 0.0, DEPTH), place=(away, 0.0, rise - DEPTH))
        leg = NetLeg(line_of(chain(300.0)), LegEnd(place=(0.0, 0.0, 0.0)), end)
        (found,) = solve_net([leg], 0, water_of(DEPTH)).legs
        pulls.append([*np.abs(found.force[-1, [0, 2]]), found.position[-1, 2] + DEPTH])
    side, up, height = np.array(pulls).T
    assert (np.diff(side) > 0.0).all()
    assert up[0] == 0.0 and up[-1] > 50.0 * rise
    assert height[0] == pytest.approx(0.0, abs=1e-9) and height[-1] == pytest.approx(rise)


def lee_net(turn: float = 0.0, mirror: bool = False, backwards: bool = False) -> list[NetLeg]:
    """A submerged float on three legs of wire and chain, one of which a current slackens."""
    head = line_of(Point(5000.0, 1.5, 0.8), Wire(10.0, 3.0, 0.012, 2e5))
    legs = [NetLeg(head, FREE, LegEnd(node=0))]
    for angle in (10.0, 130.0, 250.0):
        east, north = 120.0 * np.cos(np.radians(angle)), 120.0 * np.sin(np.radians(angle))
        north = -north if mirror else north
        at = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ [east, north]
        line = line_of(Wire(80.0, 3.0, 0.012, 2e5), Wire(100.0, 60.0, 0.03, 2e5))
        legs.append(NetLeg(line, LegEnd(node=0), anchored(float(at[0]), float(at[1]), 120.0)))
    return legs[:1] + legs[:0:-1] if backwards else legs


def lee_water(turn: float = 0.0, mirror: bool = False) -> Water:
    flows = []
    for z, u, v in ((0.0, 1.2, 0.2), (120.0, 0.4, 0.0)):
        v = -v if mirror else v
        flows.append((z, np.cos(turn) * u - np.sin(turn) * v, np.sin(turn) * u + np.cos(turn) * v))
    return water_of(120.0, *flows)


def along(line: Line, length: float, pull: Floats, water: Water, height: float) -> Way:
    """The way up the upper `length` [m] of a line from a height [m] and a pull on its lower end, by
    the differential equations of its cables."""
    way, profile = Way(np.array([0.0, 0.0, height]), pull), Profile(water)
    ends = np.cumsum(line.length)
    for piece in reversed(range(int(np.searchsorted(ends, length)) + 1)):
        own = min(length, float(ends[piece])) - float(ends[piece] - line.length[piece])
        load = on_piece(line, piece, water.gravity, 1.0, 0.0)
        cable = Cable(load, own, strain_law(line, piece), float(line.thinning[piece]))
        way = follow(cable, way.position, way.force, profile, 1e-10, False)
    return way


def test_a_net_with_a_slack_leg_agrees_with_differential_equations() -> None:
    """Of each leg the length that hangs and the pull at its touchdown, and the node: where legs end
    at the node, those that are pulled lie straight to their anchors, and forces balance.

    The equations are solved anew from figures of the solution in three digits.
    """
    legs, water = lee_net(), lee_water()
    net = solve_net(legs, 1, water)
    assert [leg.slack > 1.0 for leg in net.legs] == [False, True, False, False]
    head, compliance = legs[0].line, float(legs[1].line.compliance[1])
    top = Load(5000.0, 0.0, float(head.normal_drag[0]), 0.0, False, water.gravity)

    def left(x: Floats) -> Floats:
        node, found, forces = x[:3], [], np.zeros(3)
        for i, leg in enumerate(legs[1:]):
            east, north, hung = x[4 + 3 * i : 7 + 3 * i]
            slack = i == 0
            pull = np.zeros(3) if slack else np.array([east, north, 0.0])
            way = along(leg.line, hung, pull, water, -120.0)
            assert leg.lower.place is not None
            to_anchor = np.array(leg.lower.place)[:2] - node[:2] + way.position[:2]
            lies = (180.0 - hung) * (1.0 + compliance * float(np.hypot(east, north)))
            straight = lies * pull[:2] / max(float(np.hypot(east, north)), 1e-9)
            found += [east, north] if slack else [*(to_anchor - straight)]
            found.append(way.position[2] - node[2])
            forces += way.force
        flow = Profile(water).at(-x[3])
        wire = Cable(on_piece(head, 1, water.gravity, 1.0, 0.0), 10.0, strain_law(head, 1), 0.0)
        begun = np.array([0.0, 0.0, x[3]]), top.force(flow, DOWN)
        down = follow(wire, *begun, Profile(water), 1e-10, False)
        return np.array([*found, down.position[2] - node[2], *(forces + down.force) / 10.0])

    ways = [(*-leg.force[-1, :2], 180.0 - leg.grounded_length) for leg in net.legs[1:]]
    start = [*net.nodes[0], net.legs[0].position[0, 2], *np.ravel(ways)]
    root = fsolve(left, np.round(start, 1), xtol=1e-11, full_output=True)
    x, ending = root[0], root[2]
    assert ending == 1, root[3]
    assert net.nodes[0] == pytest.approx(x[:3], abs=net.depth_error)
    assert net.legs[1].grounded_length == pytest.approx(180.0 - x[6], abs=net.depth_error)
    for leg, east, north in zip(net.legs[2:], x[7::3], x[8::3], strict=True):
        assert leg.force[-1, :2] == pytest.approx([-east, -north], abs=net.tension_error)


@pytest.mark.parametrize(
    ("turn", "mirror", "backwards"),
    [(1.1, False, False), (-2.0, True, False), (0.0, False, True), (0.4, True, True)],
)
def test_a_net_with_a_slack_leg_does_not_depend_on_frame_or_order(
    turn: float, mirror: bool, backwards: bool
) -> None:
    plain = solve_net(lee_net(), 1, lee_water())
    other = solve_net(lee_net(turn, mirror, backwards), 1, lee_water(turn, mirror))
    east, north, up = plain.nodes[0]
    north = -north if mirror else north
    turned = [
        np.cos(turn) * east - np.sin(turn) * north,
        np.sin(turn) * east + np.cos(turn) * north,
    ]
    assert other.nodes[0] == pytest.approx([*turned, up], abs=1e-7 * 120.0)
    assert sum(leg.slack for leg in other.legs) == pytest.approx(
        sum(leg.slack for leg in plain.legs), abs=1e-5
    )


@pytest.mark.thorough  # its laws are compiled first
def test_compiled_a_slack_leg_is_the_same() -> None:
    plain = solve_net(lee_net(), 1, lee_water(), Settings(compiled=False))
    fast = solve_net(lee_net(), 1, lee_water(), Settings(compiled=True))
    assert (fast.nodes == plain.nodes).all()
