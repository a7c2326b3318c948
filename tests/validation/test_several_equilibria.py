"""Undercurrents in which a line has several equilibria, counted by the referee.

With the free end at a depth the line ends some way above its anchor. It stands where this
vanishes, and stays there where it falls with depth: where it grows a line pushed down goes on down.
CALM gives the highest and tells the deepest that it comes upon; of a net it gives the highest.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from random import Random

import numpy as np
import pytest
from scipy.optimize import brentq

import calm
from calm.physics.line import Line, Water
from calm.solve import Settings, solve_mooring
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import solve_net
from tests.property.strategies import mooring
from tests.validation.closing import COARSE, FINE
from tests.validation.continuous import March
from tests.validation.pieces import cable, line_of, point, profile

NEAR = 5e-5
"""Of the depth: what CALM promises at an angle step of 1°."""

THREAD = line_of(point(500.0, 100.0), cable(100.0, 0.0, 0.0, 1.3, 0.0))
IN_ROPE = 0.006, 0.3, 1.3, 0.01, 2e-6
ROPE = line_of(point(900.0, 250.0), cable(260.0, *IN_ROPE))
LONG = line_of(point(2000.0, 800.0), cable(401.0, 0.006, 0.3, 1.3, 0.01, 2e-6))


def sheet(speed: float, depth: float) -> Water:
    """400 m of water with a current in a sheet of it that begins at a depth."""
    rows = [(0.0, 0.05), (depth, 0.05), (depth + 27.0, speed), (depth + 102.0, 0.1)]
    return profile(400.0, rows)


def turning(speed: float, depth: float) -> Water:
    """400 m of water with a current that runs the other way below a depth, no faster."""
    level, u = np.array([0.0, depth, depth + 10.0, 400.0]), speed * np.array([-1.0, -1.0, 1.0, 1.0])
    still = np.zeros(4)
    return Water(400.0, level, u, still, still, still + 1025.0)


def stays(line: Line, water: Water, steps: int) -> list[float]:
    """Depths of the free end below the surface at which the line stands and stays."""
    rough, fine = March(line, water, COARSE), March(line, water, FINE)
    bottom, whole = water.depth - line.anchor_height, np.ones(len(line.length))

    def short(depth: float, march: March = fine) -> float:
        return float(march.down(depth, whole).bottom[-1, 2] + bottom)

    tried = [(depth, short(depth, rough)) for depth in np.linspace(0.0, water.depth, steps + 1)]
    falls = [(a[0], b[0]) for a, b in pairwise(tried) if a[1] > 0.0 >= b[1]]
    return [float(brentq(short, *bounds, xtol=1e-9)) for bounds in falls]


@pytest.mark.parametrize(
    ("line", "water", "expected"),
    [
        pytest.param(THREAD, profile(110.0, [(0, 0.2), (12, 0.2), (30, 3.0)]), 2, id="jet"),
        pytest.param(ROPE, sheet(1.4, 148.0), 2, id="sheet"),
        pytest.param(ROPE, sheet(0.8, 148.0), 1, id="weak sheet", marks=pytest.mark.thorough),
        pytest.param(ROPE, sheet(1.8, 148.0), 1, id="strong sheet", marks=pytest.mark.thorough),
        pytest.param(ROPE, turning(1.0, 160.0), 2, id="turning"),
        pytest.param(ROPE, turning(1.0, 146.0), 1, id="turning above", marks=pytest.mark.thorough),
        pytest.param(
            ROPE, profile(400.0, [(0, 2.5), (400, 0.1)]), 1, id="decaying",
            marks=pytest.mark.thorough,
        ),
    ],
)  # fmt: skip
def test_the_highest_is_given_and_the_deepest_told(line, water, expected) -> None:
    depths = stays(line, water, 150)
    assert len(depths) == expected
    solution = solve_mooring(line, water)
    assert -solution.position[0, 2] == pytest.approx(depths[0], abs=NEAR * water.depth)
    if expected == 1:
        assert solution.other is None
    else:
        assert solution.other.depth == pytest.approx(depths[-1], abs=NEAR * water.depth)


@pytest.mark.parametrize("water", [sheet(1.4, 148.0), turning(1.0, 160.0)])
def test_of_a_net_the_highest_is_found(water: Water) -> None:
    """The same line as two legs that meet; let go in the second it would rest at the deeper."""
    depths = stays(ROPE, water, 150)
    assert len(depths) == 2
    legs = [
        NetLeg(line_of(point(900.0, 250.0), cable(100.0, *IN_ROPE)), LegEnd(), LegEnd(node=0)),
        NetLeg(
            line_of(cable(160.0, *IN_ROPE)), LegEnd(node=0),
            LegEnd(place=(0.0, 0.0, ROPE.anchor_height - 400.0), seabed=-400.0),
        ),
    ]  # fmt: skip
    still = solve_net(legs, 1, water.still())
    for near in (None, still):  # as of `calm run` and of `calm batch`
        net = solve_net(legs, 1, water, near=near)
        assert -net.legs[0].position[0, 2] == pytest.approx(depths[0], abs=NEAR * water.depth)


def test_a_line_afloat_that_an_undercurrent_would_hold_down() -> None:
    (held,) = stays(LONG, sheet(1.1, 8.0), 150)
    solution = solve_mooring(LONG, sheet(1.1, 8.0))
    assert solution.surface
    assert solution.other.depth == pytest.approx(held, abs=NEAR * 400.0)


def test_the_other_is_as_good_as_the_first() -> None:
    water = profile(110.0, [(0, 0.2), (12, 0.2), (30, 3.0)])
    tight = solve_mooring(THREAD, water, replace(Settings(), tolerance=1e-9))
    highest, deepest = stays(THREAD, water, 150)
    assert -tight.position[0, 2] == pytest.approx(highest, abs=1e-7)
    assert tight.other.depth == pytest.approx(deepest, abs=1e-7)


def test_of_hanging_and_lying_the_line_lies_and_the_other_shape_is_told() -> None:
    """Seed 66: it could hang as well between the seabed and the top of its anchor."""
    line, water = mooring(Random(66))
    solution = solve_mooring(line, water)
    assert solution.landed
    assert solution.grounded_length == pytest.approx(5.301, abs=0.01)
    assert (solution.other.depth, solution.other.grounded_length) == (0.0, 0.0)
    flat = replace(line, anchor_height=0.0)
    assert solve_mooring(flat, water).other is None


JET = """
environment:
  depth: 110 m
  current:
    columns: [depth m, speed m/s, toward deg]
    rows: [[0, 0.2, 90], [12, 0.2, 90], [30, 3, 90]]
line: [{use: ball}, {use: thread, length: 100 m}, {use: block}]
components:
  ball: {kind: body, length: 0 m, buoyancy: 500 N, kn: 100 N/(m/s)^2, inclination: insensitive}
  thread: {kind: cable, diameter: 1 mm, weight: 0 N/m, cn: 0, ct: 0}
  block: {kind: anchor, weight: 20 kN}
"""


def test_both_are_in_the_result_and_in_its_warnings() -> None:
    highest, deepest = stays(THREAD, profile(110.0, [(0, 0.2), (12, 0.2), (30, 3.0)]), 150)
    result = calm.load("jet.yaml", text=JET).solve()
    assert result.top.depth == pytest.approx(highest, abs=NEAR * 110.0)
    other = result.to_dict()["other_equilibrium"]
    # without weight and drag the thread brings the force on the float to the anchor
    assert other == {
        "depth": pytest.approx(deepest, abs=NEAR * 110.0),
        "grounded_length": 0.0,
        "used_buoyancy": 1.0,
        "anchor_vertical": pytest.approx(500.0),
        "anchor_horizontal": pytest.approx(100.0 * 3.0**2),
    }
    said = f"Another equilibrium exists, with the free end at a depth of {deepest:.1f} m."
    assert said in result.warnings


CLEAR = """
environment:
  depth: 136 m
  current: {columns: [depth m, u m/s, v m/s], rows: [[0, 0, 0], [136, 1.3, 0]]}
components:
  ball: {kind: sphere, diameter: 0.8 m, buoyancy: 800 N}
  rope: {kind: cable, diameter: 18 mm, weight: 3.6 N/m, cn: 1.7, ct: 0.01}
  block: {kind: anchor, weight: 9000 N, length: 1 m}
line: [{use: ball}, {use: rope, length: 136 m}, {use: block}]
"""


def test_a_line_that_hangs_higher_than_it_lies_hangs() -> None:
    """With 11 m of it on the seabed it lies lower; rope may not, which it was refused for."""
    mooring = calm.load("clear.yaml", text=CLEAR)
    result = mooring.solve()
    assert result.top.depth == pytest.approx(68.72, abs=0.01)
    other = result.to_dict()["other_equilibrium"]
    assert other == {
        "depth": pytest.approx(70.32, abs=0.01),
        "grounded_length": pytest.approx(11.2, abs=0.1),
        "used_buoyancy": 1.0,
        "anchor_vertical": 0.0,
        "anchor_horizontal": pytest.approx(601.7, abs=0.1),
    }
    heights = 136.0 + solve_mooring(mooring.line, mooring.water).position[:, 2]
    assert heights.min() == pytest.approx(0.67, abs=0.01)


def test_a_surface_float_pulled_under_is_said_to_be() -> None:
    """It carries what hangs at rest; that all of the line weighs more is not why."""
    text = CLEAR.replace("length: 136 m", "length: 300 m").replace("1.3, 0]", "2.5, 0]")
    with pytest.raises(calm.NoEquilibrium, match="top of the line under water") as refusal:
        calm.load("pulled.yaml", text=text.replace("800 N", "1000 N")).solve()
    assert refusal.value.status == "grounded"


TURNING = """
environment:
  depth: 108.9 m
  density: 1025 kg/m^3
  current:
    columns: [depth m, u m/s, v m/s]
    rows:
      - [0, 1.5333, -2.84467]
      - [41.82, -1.49008, 2.76447]
      - [69.22, 1.18324, -2.19521]
      - [106.92, -1.08555, 2.01398]
components:
  float: {kind: sphere, diameter: 0.94 m, length: 0.94 m, buoyancy: 4335.5 N, cx: 0.5}
  tether: {kind: cable, diameter: 16.5 mm, weight: 0 N/m, cn: 1.67, ct: 0.05}
  meter: {kind: body, length: 0.6 m, buoyancy: -180 N, kn: 26.4 N/(m/s)^2, inclination: insensitive}
  cord: {kind: cable, diameter: 6.5 mm, weight: 0.03 N/m, cn: 1.73, ct: 0.009, stiffness: 6127 N}
  frame: {kind: cylinder, diameter: 0.36 m, length: 2.71 m, buoyancy: -156 N, cn: 1.1, ct: 0.0}
  rope: {kind: cable, diameter: 24.2 mm, weight: 1.464 N/m, cn: 1.54, ct: 0.0, stiffness: 11.7 MN}
  glass: {kind: sphere, diameter: 0.33 m, length: 0.33 m, buoyancy: 110 N, cx: 0.8}
  line: {kind: cable, diameter: 10.1 mm, weight: 0 N/m, cn: 1.53, ct: 0.013}
  chain: {kind: chain, diameter: 13 mm, weight: 33 N/m}
  release: {kind: cylinder, diameter: 0.13 m, length: 1 m, buoyancy: -330 N, cn: 1.2, ct: 0.9}
  block: {kind: anchor, weight: 100 kN}
line:
  - {use: float}
  - {use: tether, length: 12.63 m}
  - {use: meter}
  - {use: cord, length: 28.37 m}
  - {use: frame}
  - {use: rope, length: 44.63 m}
  - {use: glass, count: 2}
  - {use: line, length: 38.56 m}
  - {use: chain, length: 19.126 m}
  - {use: release}
  - {use: block}
"""


def test_a_float_has_two_equilibria_in_a_current_that_turns_back() -> None:
    """Both commands give the one that a current rising from zero leads to, without a jump."""
    mooring = calm.load("turning.yaml", text=TURNING)
    shares = []
    for part in np.linspace(0.1, 1.0, 10):
        water = mooring.water
        weaker = replace(water, u=part * water.u, v=part * water.v)
        shares.append(solve_mooring(mooring.line, weaker).buoyancy_used)
    assert np.abs(np.diff(shares)).max() < 0.1
    result = mooring.solve()
    assert result.top.used_buoyancy == pytest.approx(shares[-1], abs=1e-9)
    other = result.other_equilibrium
    assert abs(other["used_buoyancy"] - shares[-1]) > 0.2
    assert (
        np.hypot(other["anchor_vertical"], other["anchor_horizontal"]) > 1.5 * result.anchor.tension
    )
    found = calm.solve_profiles(
        mooring, *(np.stack([part] * 2) for part in (mooring.water.u, mooring.water.v)),
        depth=mooring.water.level,
    )  # fmt: skip
    assert found.used_buoyancy == pytest.approx(shares[-1], abs=1e-5)
    assert found.other_used_buoyancy == pytest.approx(other["used_buoyancy"], abs=2e-3)


TIPPING = """
environment:
  depth: 90 m
  current:
    columns: [depth m, u m/s, v m/s]
    rows:
      - [0, 1.2, 0]
      - [10, 1.2, 0]
      - [10.01, -1.2, 0]
      - [20, -1.2, 0]
      - [20.01, 1.2, 0.24]
      - [50, 1.2, 0.24]
      - [50.01, 0, -1.2]
      - [90, 0, -1.2]
line: [{use: glass, count: 5}, {use: wire, length: 75 m}, {use: block}]
components:
  glass: {kind: sphere, diameter: 0.51 m, buoyancy: 225.6 N, cx: 0.95}
  wire: {kind: cable, diameter: 8 mm, weight: 1.5 N/m, cn: 1.3, ct: 0.01, stiffness: 2.5 MN}
  block: {kind: anchor, weight: 9 kN, length: 0.7 m}
"""


def test_a_float_that_tips_over_at_a_step_of_the_current_leaves_the_lower_equilibrium() -> None:
    """The lowest ball leans to one side of the step or to the other: in between no line stands."""
    mooring = calm.load("tipping.yaml", text=TIPPING)
    water = mooring.water
    *_, expected = stays(mooring.line, water, 60)
    solution = solve_mooring(mooring.line, water)
    assert -solution.position[0, 2] == pytest.approx(expected, abs=NEAR * water.depth)
    found = calm.solve_profiles(mooring, water.u[None], water.v[None], water.level)
    assert found.depth_top[0, 0] == pytest.approx(expected, abs=1e-4 * water.depth)


TETHER = """
environment:
  depth: 60 m
  current: {columns: [depth m, speed knot, toward deg], rows: [[0, 1.2, 40], [60, 0.3, 40]]}
line:
  - {use: buoy-nexsens-cb-450, label: buoy, length: 0.9 m, drag_area: 0.5 m^2, cd: 0.8}
  - {use: chain-buoy-10, length: 3 m}
  - {use: polypropylene-16, length: 22 m, label: floating}
  - {use: viny-16in, label: mid float}
  - {use: polyester-16, length: 45 m, label: sinking}
  - {use: sbe37-bar}
  - {use: release-port-lf}
  - {use: chain-buoy-13, length: 4 m}
  - {use: anchor-wheels-1}
"""


def test_another_equilibrium_of_nearly_equal_loads_is_told_by_its_line_on_the_seabed() -> None:
    result = calm.load("tether.yaml", text=TETHER).solve()
    lying = result.other_equilibrium["grounded_length"]
    assert lying > 0.1 and result.anchor.grounded_length == 0.0
    (told,) = [one for one in result.warnings if one.startswith("Another equilibrium")]
    assert f"buoyancy in use, {lying:.1f} m of line on the seabed and an anchor load of" in told
