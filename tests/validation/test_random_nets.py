"""CALM against the referee on random nets, and the referee of nets against itself and a catenary.

The limits are CALM's promises: places within 5e-5 of the water depth and tensions within 2e-4. The
stated errors cover the true ones, and a batch agrees with a run. `benchmarks/accuracy.py` compares
a hundred.
"""

from __future__ import annotations

from math import asinh, hypot

import pytest

from calm.case import Design, load
from calm.case.net import net_legs
from calm.physics.line import Floats
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import NetSolution, solve_net
from tests.unit.solve.nets import Wire, line_of, water_of
from tests.validation import netted
from tests.validation.agreement import apart, ends_of
from tests.validation.comparison import NET, compared
from tests.validation.netted import solve_continuous_net
from tests.validation.surface_nets import surface_net


@pytest.mark.parametrize(
    "number", [1, 2, *(pytest.param(number, marks=pytest.mark.thorough) for number in range(3, 13))]
)
def test_calm_agrees_with_the_referee(number: int) -> None:
    case = compared(NET, number)
    assert case.error is not None and case.batch is not None
    assert case.error.place <= 5e-5 and case.error.tension <= 2e-4
    assert case.place_ratio <= 1.0 and case.tension_ratio <= 1.0
    assert case.batch.place <= 1e-4 and case.batch.tension <= 2e-4
    assert not case.plain_differs


def net_of(number: int) -> tuple[Design, NetSolution]:
    net = load("net.yaml", text=surface_net(number).text)
    return net, net.standing


def test_a_weight_that_the_leg_lifts_in_part_stands_on_the_seabed() -> None:
    """The wire above it bears that part: 53 of 145 N, which the seabed does not."""
    net, found = net_of(7)
    ends, _ = solve_continuous_net(net_legs(net.legs), found, net.water)
    leg = found.legs[1]
    assert leg.grounded_length == pytest.approx(net.legs[1].line.length[2])
    off = apart(ends_of(leg), ends[1], net.water.depth)
    assert off.tension <= 1e-6
    wire, weight = leg.piece_nodes[:2]
    assert leg.force[wire[1], 2] == pytest.approx(53.35, abs=0.01)
    assert leg.force[weight[1], 2] == 0.0


def test_a_leg_followed_up_is_that_followed_down(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four legs on the seabed of one net, one of them slack, which goes up in any case."""
    net, found = net_of(17)
    ways: list[Floats] = []
    for weak in (1e-6, 1.0):
        monkeypatch.setattr(netted, "WEAK", weak)
        _, nodes = solve_continuous_net(net_legs(net.legs), found, net.water)
        ways.append(nodes)
    assert ways[0] == pytest.approx(ways[1], abs=1e-8 * net.water.depth)


def test_between_held_ends_the_referee_finds_the_elastic_catenary() -> None:
    """300 m and 400 m apart, from 15677.747 N and 26291.876 N above (see `test_continuous`)."""
    wire = Wire(520.0, weight=50.0, stiffness=5e6)
    ends = LegEnd(place=(0.0, 0.0, -100.0)), LegEnd(place=(400.0, 0.0, -400.0))
    leg, water = NetLeg(line_of(wire), *ends), water_of(600.0)
    found = solve_net([leg], 0, water)
    (own,), _ = solve_continuous_net([leg], found, water)
    horizontal, vertical = 15677.747, 26291.876
    below = vertical - 50.0 * 520.0
    assert own[1] == pytest.approx(
        [hypot(horizontal, vertical), hypot(horizontal, below)], abs=2e-3
    )
    x = horizontal / 50.0 * (asinh(vertical / horizontal) - asinh(below / horizontal))
    assert x + horizontal * 520.0 / 5e6 == pytest.approx(400.0, abs=1e-4)
