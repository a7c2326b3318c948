"""Nets of legs: against single lines, closed forms, symmetry, and relaxation.

A leg of a net is passed by the march of a single line, which is tested for itself. Here it is that
legs come together: places and forces of nodes, held ends, free ends, legs on the seabed.
"""

from __future__ import annotations

from dataclasses import replace
from math import asinh, sinh
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import calm.solve.leg_marches as leg_marches
import calm.solve.leg_numbers as leg_numbers
import calm.solve.net as net_module
from calm.errors import NoEquilibrium
from calm.physics.hull import Floating, spherical_hull
from calm.physics.line import Floats
from calm.solve import Settings, solve_mooring
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import NetSolution, solve_net
from tests.unit.solve.nets import Point, Wire, anchored, line_of, relaxed, water_of

FREE = LegEnd()
FLOAT = Point(6000.0, 1.2, 0.8)
SHEAR = ((0.0, 0.6, 0.1), (100.0, 0.3, -0.1), (300.0, 0.1, 0.0))


def y_net(left: float = 80.0, right: float = 60.0) -> list[NetLeg]:
    """Two floats on one anchor, and a weight that hangs from the node."""
    return [
        NetLeg(line_of(FLOAT, Wire(left)), FREE, LegEnd(node=0)),
        NetLeg(line_of(Point(3000.0, 0.9, 0.8), Wire(right)), FREE, LegEnd(node=0)),
        NetLeg(line_of(Wire(12.0), Point(-300.0, 0.2, 1.0)), LegEnd(node=0), FREE),
        NetLeg(line_of(Wire(120.0)), LegEnd(node=0), anchored(0.0, 0.0, 300.0)),
    ]


def test_a_net_of_one_leg_is_the_mooring() -> None:
    """Same march, same search for the depth: they agree within both their stated errors."""
    line, water = line_of(FLOAT, Wire(220.0)), water_of(300.0, *SHEAR)
    net = solve_net([NetLeg(line, FREE, anchored(0.0, 0.0, 300.0))], 0, water)
    alone = solve_mooring(line, water)
    allowed = net.depth_error + alone.depth_error
    assert net.legs[0].position[0] == pytest.approx(alone.position[0], abs=allowed)
    assert net.legs[0].tension[-1] == pytest.approx(
        alone.tension[-1], abs=net.tension_error + alone.tension_error
    )


def test_a_float_at_the_surface_is_that_of_the_mooring() -> None:
    """Rope that is longer than the water is deep; the float rides at its draft in the wind."""
    hull = Floating(hull=spherical_hull(1.2), weight=3000.0, lift=6000.0, wind=(8.0, 0.0))
    line = line_of(Point(6000.0, 1.2, 0.5), Wire(360.0, weight=0.5))
    line = replace(line, floating=hull)
    water = water_of(300.0, *SHEAR)
    net = solve_net([NetLeg(line, FREE, anchored(0.0, 0.0, 300.0))], 0, water)
    alone = solve_mooring(line, water)
    assert alone.surface
    assert net.legs[0].buoyancy_used == pytest.approx(alone.buoyancy_used, rel=1e-4)
    allowed = net.depth_error + alone.depth_error
    assert net.legs[0].position[0] == pytest.approx(alone.position[0], abs=allowed)
    assert net.legs[0].reserve == pytest.approx(alone.reserve, rel=1e-3)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_leg_on_the_seabed_is_that_of_the_mooring(friction: float) -> None:
    """Chain on the bed in a strong current: the same touchdown, the same pull on the anchor."""
    line = line_of(FLOAT, Wire(270.0), Wire(80.0, weight=150.0, diameter=0.03))
    water = water_of(300.0, (0.0, 0.8, 0.0), (300.0, 0.2, 0.0))
    settings = Settings(seabed_friction=friction)
    net = solve_net([NetLeg(line, FREE, anchored(0.0, 0.0, 300.0))], 0, water, settings)
    alone = solve_mooring(line, water, settings)
    assert alone.landed and net.legs[0].landed
    assert net.legs[0].grounded_length == pytest.approx(alone.grounded_length, abs=1e-2)
    assert net.legs[0].position[0] == pytest.approx(alone.position[0], abs=1e-2)
    assert net.legs[0].tension[-1] == pytest.approx(alone.tension[-1], rel=1e-4)


def catenary(span: float, length: float, weight: float) -> float:
    """Horizontal pull of a level inextensible catenary [N]: length = 2 a sinh(span / 2a)."""
    a = brentq(lambda a: 2.0 * a * sinh(span / (2.0 * a)) - length, span / 20.0, 1e4 * span)
    return weight * a


@pytest.mark.parametrize("slack", [1.001, 1.05, 1.5])
def test_between_two_held_ends_hangs_a_catenary(slack: float) -> None:
    """In still water, stiff enough not to stretch: pull, sag and length of the textbook."""
    span, weight = 60.0, 5.0
    wire = Wire(slack * span, weight=weight, stiffness=1e12)
    ends = [LegEnd(place=(x, 0.0, -20.0)) for x in (0.0, span)]
    net = solve_net([NetLeg(line_of(wire), *ends)], 0, water_of(200.0))
    pull = catenary(span, slack * span, weight)
    leg = net.legs[0]
    assert abs(leg.force[-1, 0]) == pytest.approx(pull, rel=1e-4)
    sag = pull / weight * (np.cosh(asinh(0.5 * slack * span * weight / pull)) - 1.0)
    assert leg.position[:, 2].min() == pytest.approx(-20.0 - sag, abs=1e-3 * span)
    assert abs(leg.force[-1, 2]) == pytest.approx(0.5 * weight * slack * span, rel=1e-6)


def test_a_float_at_the_surface_on_two_legs_that_lie_bears_their_catenaries() -> None:
    """In still water, stiff: it uses what 140 m of line and what hangs of both legs weigh.

    Of each leg of S m a length g lies, H / w = a, and s = S - g hangs:
    h = √(a² + s²) - a and x = a asinh(s / a) + g, by the catenary from its lowest point.
    """
    weight, down, length, reach, depth = 5.0, 140.0, 135.0, 90.0, 200.0
    hull = Floating(hull=spherical_hull(1.2), weight=3000.0, lift=6000.0)
    head = replace(line_of(Point(6000.0, 1.2, 0.5), Wire(down, weight, stiffness=1e12)),
                   floating=hull)  # fmt: skip
    leg = line_of(Wire(length, weight, stiffness=1e12))
    legs = [
        NetLeg(head, FREE, LegEnd(node=0)),
        *(NetLeg(leg, LegEnd(node=0), anchored(x, 0.0, depth)) for x in (-reach, reach)),
    ]
    net = solve_net(legs, 1, water_of(depth))
    up = depth + net.nodes[0, 2]

    def gap(a: float) -> float:
        hung = np.sqrt(up * up + 2.0 * a * up)
        return float(a * asinh(hung / a) + length - hung - reach)

    a = brentq(gap, 0.1, 1e4)
    hung = float(np.sqrt(up * up + 2.0 * a * up))
    assert abs(net.legs[1].force[-1, 0]) == pytest.approx(weight * a, rel=1e-3)
    assert net.legs[1].grounded_length == pytest.approx(length - hung, abs=5e-3)
    assert up == pytest.approx(depth - down, abs=1e-2)
    borne = weight * (down + 2.0 * hung)
    assert net.legs[0].buoyancy_used * 6000.0 == pytest.approx(borne, rel=1e-3)


def test_of_two_legs_of_a_bridle_one_is_slack_in_still_water() -> None:
    """It hangs plumb in two folds beside the other, as in the weakest current."""
    legs = [
        NetLeg(line_of(FLOAT, Wire(40.0)), FREE, LegEnd(node=0)),
        NetLeg(line_of(Wire(80.0, stiffness=1e12)), LegEnd(node=0), LegEnd(node=1)),
        NetLeg(line_of(Wire(81.6, stiffness=1e12)), LegEnd(node=0), LegEnd(node=1)),
        NetLeg(line_of(Wire(100.0)), LegEnd(node=1), anchored(0.0, 0.0, 300.0)),
    ]
    net = solve_net(legs, 2, water_of(300.0))
    assert net.nodes[0, 2] - net.nodes[1, 2] == pytest.approx(80.0, abs=1e-4)
    upper, lower = (abs(net.legs[2].force[end, 2]) for end in (0, -1))
    # 80.8 m hang from the upper node and turn, 0.8 m from the lower one
    assert upper == pytest.approx(2.64 * 80.8, rel=1e-4)
    assert lower == pytest.approx(2.64 * 0.8, rel=1e-3)


def at_nodes(net: NetSolution, legs: list[int]) -> list[np.ndarray]:
    """Free ends of some legs, and the nodes, after one another."""
    return [*(net.legs[i].position[0] for i in legs), *net.nodes]


def test_a_leg_cut_in_two_by_a_node_changes_nothing() -> None:
    legs, water = y_net(), water_of(300.0, *SHEAR)
    whole = solve_net(legs, 1, water)
    stem = [
        NetLeg(line_of(Wire(50.0)), LegEnd(node=0), LegEnd(node=1)),
        NetLeg(line_of(Wire(70.0)), LegEnd(node=1), anchored(0.0, 0.0, 300.0)),
    ]
    cut = solve_net([*legs[:3], *stem], 2, water)
    allowed = whole.depth_error + cut.depth_error
    for mine, its in zip(at_nodes(whole, [0, 1, 2]), at_nodes(cut, [0, 1, 2]), strict=False):
        assert its == pytest.approx(mine, abs=allowed)


def test_a_branch_of_no_weight_and_drag_changes_nothing() -> None:
    legs, water = y_net(), water_of(300.0, *SHEAR)
    whole = solve_net(legs, 1, water)
    nothing = Wire(5.0, weight=1e-6, diameter=1e-9)
    more = solve_net([*legs, NetLeg(line_of(nothing), LegEnd(node=0), FREE)], 1, water)
    allowed = whole.depth_error + more.depth_error + 1e-5
    assert more.nodes == pytest.approx(whole.nodes, abs=allowed)


def test_a_y_of_equal_arms_is_symmetric() -> None:
    """Arms to anchors east and west of it in a current to the north."""
    legs = [
        NetLeg(line_of(FLOAT, Wire(100.0)), FREE, LegEnd(node=0)),
        NetLeg(line_of(Wire(90.0)), LegEnd(node=0), anchored(-50.0, 0.0, 200.0)),
        NetLeg(line_of(Wire(90.0)), LegEnd(node=0), anchored(50.0, 0.0, 200.0)),
    ]
    net = solve_net(legs, 1, water_of(200.0, (0.0, 0.0, 0.4)))
    assert net.nodes[0, 0] == pytest.approx(0.0, abs=1e-6)
    east, west = net.legs[2].force[-1], net.legs[1].force[-1]
    assert east == pytest.approx(west * [-1.0, 1.0, 1.0], rel=1e-7, abs=1e-5)
    assert net.nodes[0, 1] > 1.0


@pytest.mark.parametrize("angle", [30.0, 137.0])
def test_a_turned_and_a_mirrored_net(angle: float) -> None:
    """Anchors and current turned about the vertical turn everything; mirrored, mirror it."""
    turn = np.radians(angle)
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    mirror = np.array([[1.0, 0.0], [0.0, -1.0]])

    def net_by(matrix: np.ndarray) -> NetSolution:
        ends = [anchored(*(matrix @ at), 200.0) for at in ([-40.0, 10.0], [60.0, 5.0])]
        flows = [(z, *(matrix @ [u, v])) for z, u, v in ((0.0, 0.5, 0.1), (200.0, 0.1, 0.2))]
        legs = [
            NetLeg(line_of(FLOAT, Wire(90.0)), FREE, LegEnd(node=0)),
            NetLeg(line_of(Wire(95.0)), LegEnd(node=0), ends[0]),
            NetLeg(line_of(Wire(85.0)), LegEnd(node=0), ends[1]),
        ]
        return solve_net(legs, 1, water_of(200.0, *flows))

    plain = net_by(np.eye(2))
    for matrix in (rotation, mirror):
        turned = net_by(matrix)
        assert turned.nodes[0, :2] == pytest.approx(matrix @ plain.nodes[0, :2], abs=1e-6)
        assert turned.nodes[0, 2] == pytest.approx(plain.nodes[0, 2], abs=1e-6)


def test_a_leg_to_a_second_anchor_without_stiffness_leaves_the_mooring() -> None:
    """A second leg that stretches as it likes pulls with next to nothing."""
    water = water_of(200.0, (0.0, 0.4, 0.0))
    single = line_of(FLOAT, Wire(150.0))
    alone = solve_mooring(single, water)
    soft = Wire(100.0, weight=1e-3, diameter=1e-6, stiffness=1.0)
    legs = [
        NetLeg(line_of(FLOAT), FREE, LegEnd(node=0)),
        NetLeg(line_of(Wire(150.0)), LegEnd(node=0), anchored(0.0, 0.0, 200.0)),
        NetLeg(line_of(soft), LegEnd(node=0), anchored(40.0, 0.0, 200.0)),
    ]
    net = solve_net(legs, 1, water)
    # it pulls with about 1 N of the 6000 N: 150 m times that share
    assert net.nodes[0] == pytest.approx(alone.position[0], abs=0.05)


def random_net(seed: int) -> tuple[list[NetLeg], int, np.ndarray, float]:
    """Two to six legs clear of the seabed and the surface, where their nodes may be at first.

    EA is low enough for the relaxation to come to rest soon. What is anchored is held 200 m above
    the seabed: the relaxation knows none, and legs on it are compared with moorings.
    """
    rng = np.random.default_rng(seed)
    depth, soft = 600.0, 2e5

    def wire(low: float, high: float) -> Wire:
        return Wire(rng.uniform(low, high), rng.uniform(0.5, 3.0), rng.uniform(0.006, 0.014), soft)

    def some_float() -> Point:
        return Point(rng.uniform(2000.0, 6000.0), rng.uniform(0.6, 1.2), rng.uniform(0.5, 0.9))

    stem = NetLeg(line_of(wire(80.0, 120.0)), LegEnd(node=0), LegEnd(place=(0.0, 0.0, -400.0)))
    legs = [NetLeg(line_of(some_float(), wire(60.0, 100.0)), FREE, LegEnd(node=0)), stem]
    start = [[0.0, 0.0, -300.0]]
    if rng.random() < 0.5:
        legs.append(NetLeg(line_of(some_float(), wire(20.0, 50.0)), FREE, LegEnd(node=0)))
    if rng.random() < 0.5:
        weight = Point(-rng.uniform(100.0, 400.0), 0.3, 1.0)
        legs.append(NetLeg(line_of(wire(5.0, 30.0), weight), LegEnd(node=0), FREE))
    if rng.random() < 0.5:
        away = LegEnd(place=(rng.uniform(40.0, 70.0), rng.uniform(-30.0, 30.0), -400.0))
        legs.append(NetLeg(line_of(wire(100.0, 140.0)), LegEnd(node=0), away))
    if rng.random() < 0.4:
        legs.append(NetLeg(line_of(wire(20.0, 40.0)), LegEnd(node=1), LegEnd(node=0)))
        legs.append(NetLeg(line_of(some_float(), wire(20.0, 40.0)), FREE, LegEnd(node=1)))
        start.append([0.0, 0.0, -270.0])
    if rng.random() < 0.3:
        held = LegEnd(place=(rng.uniform(-60.0, -30.0), 0.0, -200.0))
        legs.append(NetLeg(line_of(wire(130.0, 170.0)), held, LegEnd(node=0)))
    return legs[:6] if len(start) == 1 else legs, len(start), np.array(start), depth


def agrees_with_relaxation(seed: int) -> None:
    legs, nodes, start, depth = random_net(seed)
    rng = np.random.default_rng(seed + 10_000)
    flows = [(z, *rng.uniform(-0.4, 0.4, 2)) for z in (0.0, 150.0, 400.0)]
    water = water_of(depth, *flows)
    found = solve_net(legs, nodes, water)
    places, rows = relaxed(legs, nodes, water, start)
    # chords of 12 springs a wire: 100 m of it in an arc of some 20 m sag err by some centimetres
    assert found.nodes == pytest.approx(places, abs=0.08)
    for leg, mine, row in zip(legs, found.legs, rows, strict=True):
        first = row[-1] if leg.lower.free else row[0]
        assert mine.position[0] == pytest.approx(first, abs=0.08)


@pytest.mark.parametrize("seed", range(2))
def test_random_nets_agree_with_relaxation(seed: int) -> None:
    agrees_with_relaxation(seed)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(2, 200))
def test_many_random_nets_agree_with_relaxation(seed: int) -> None:
    agrees_with_relaxation(seed)


@pytest.mark.thorough  # its laws are compiled first
def test_compiled_it_is_the_same() -> None:
    water = water_of(300.0, *SHEAR)
    plain = solve_net(y_net(), 1, water, Settings(compiled=False))
    fast = solve_net(y_net(), 1, water, Settings(compiled=True))
    assert fast.nodes == pytest.approx(plain.nodes, abs=1e-9)


def test_a_net_that_needs_more_segments_gets_more_room(monkeypatch: pytest.MonkeyPatch) -> None:
    water = water_of(300.0, *SHEAR)
    roomy = solve_net(y_net(), 1, water)
    monkeypatch.setattr(net_module, "ROOM", 8)
    assert solve_net(y_net(), 1, water).nodes == pytest.approx(roomy.nodes, abs=1e-9)


def test_stated_errors_hold() -> None:
    """Against the same net at a quarter of the step, whose errors are a sixteenth."""
    water = water_of(300.0, *SHEAR)
    usual = solve_net(y_net(), 1, water)
    fine = solve_net(y_net(), 1, water, Settings(angle_step=np.radians(0.25)))
    for mine, its in zip(at_nodes(usual, [0, 1, 2]), at_nodes(fine, [0, 1, 2]), strict=True):
        assert np.abs(mine - its).max() <= usual.depth_error
    for a, b in zip(usual.legs, fine.legs, strict=True):
        assert abs(a.tension[-1] - b.tension[-1]) <= usual.tension_error


@pytest.mark.parametrize(
    "seed", [0, 4, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (3, 7, 11))]
)
def test_stated_errors_hold_of_random_nets(seed: int) -> None:
    """Of all pieces' ends, against a quarter of the step; what both round off is 1e-6 m and N."""
    legs, nodes, _, depth = random_net(seed)
    water = water_of(depth, (0.0, 0.5, 0.1), (150.0, 0.2, -0.3), (400.0, 0.0, 0.1))
    usual = solve_net(legs, nodes, water)
    fine = solve_net(legs, nodes, water, Settings(angle_step=np.radians(0.25)))
    for a, b in zip(usual.legs, fine.legs, strict=True):
        mine, its = a.piece_nodes.ravel(), b.piece_nodes.ravel()
        off = np.abs(a.position[mine] - b.position[its]).max()
        assert off <= usual.depth_error + 1e-6
        assert np.abs(a.tension[mine] - b.tension[its]).max() <= usual.tension_error + 1e-6


def test_from_still_water_it_comes_to_the_same_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the whole current leads nowhere, it is raised by steps from still water."""
    water = water_of(300.0, *SHEAR)
    straight = solve_net(y_net(), 1, water)
    closed, shares = net_module.NetSearch.closed, []

    def lost(net: Any, x: Floats, *how: float) -> Floats | None:
        shares.append(float(np.abs(net.water.u).max()) / 0.6)
        return None if len(shares) == 2 else closed(net, x, *how)

    monkeypatch.setattr(net_module.NetSearch, "closed", lost)
    stepped = solve_net(y_net(), 1, water)
    assert shares[:4] == pytest.approx([0.0, 1.0, 0.5, 1.0])
    assert stepped.nodes == pytest.approx(straight.nodes, abs=1e-6)
    for a, b in zip(stepped.legs, straight.legs, strict=True):
        assert a.tension[-1] == pytest.approx(b.tension[-1], rel=1e-6)


def test_the_audit_sees_a_moved_node(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shape changed behind the march by a millimetre does not pass."""
    marched = leg_marches.march_leg

    def spoilt(net: Any, i: int, x: Any, how: Any) -> int:
        ending = marched(net, i, x, how)
        net.lines.work.records[i][how.record][0][int(net.state[i][leg_numbers.COUNT]) // 2] += 1e-3
        return ending

    monkeypatch.setattr(leg_marches, "march_leg", spoilt)
    with pytest.raises(NoEquilibrium, match=r"balance|rotat|axis|element"):
        solve_net(y_net(), 1, water_of(300.0, *SHEAR), Settings(compiled=False))


def test_a_second_float_that_would_surface_is_refused_by_the_name_of_the_first() -> None:
    hull = Floating(hull=spherical_hull(1.2), weight=3000.0, lift=6000.0)
    parts = Point(6000.0, 1.2, 0.5), Wire(5.0), Point(3000.0, 0.9, 0.5), Wire(360.0)
    line = replace(line_of(*parts), floating=hull)
    with pytest.raises(NoEquilibrium) as refused:
        solve_net([NetLeg(line, FREE, anchored(0.0, 0.0, 300.0))], 0, water_of(300.0, *SHEAR))
    assert (refused.value.status, refused.value.piece) == ("above-surface", 0)
    assert refused.value.message == "Besides piece 1, other parts of the leg would surface."


def test_legs_too_short_to_meet_do_not_come_to_rest() -> None:
    legs = [
        NetLeg(line_of(Wire(50.0, stiffness=np.inf)), LegEnd(place=(0.0, 0.0, -10.0)),
               LegEnd(place=(80.0, 0.0, -10.0)))
    ]  # fmt: skip
    with pytest.raises(NoEquilibrium) as refused:
        solve_net(legs, 0, water_of(100.0))
    assert refused.value.status == "not-converged"
    assert "lengths of its legs" in refused.value.advice


def test_a_weight_on_the_seabed_is_refused() -> None:
    legs = y_net()
    legs[2] = NetLeg(line_of(Wire(150.0), Point(-300.0, 0.2, 1.0)), LegEnd(node=0), FREE)
    with pytest.raises(NoEquilibrium) as refused:
        solve_net(legs, 1, water_of(300.0))
    assert refused.value.status == "grounded"
