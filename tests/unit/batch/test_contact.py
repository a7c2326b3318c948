"""Lines that come down on the seabed in a batch, as `calm run` solves them."""

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

from calm.batch.profiles import STATUSES, solve_profiles
from calm.case import Design
from tests.unit.batch.alike import assert_as_run, shipped
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn
from tests.unit.batch.made import made_mooring

SEA = """\
name: Test
environment:
  depth: 100 m
  density: {columns: [depth m, density kg/m^3], rows: [[0, 1022], [100, 1027]]}
  current: {speed: 0.5 m/s, toward: 90 deg}
  wind: {speed: 10 m/s, toward: 200 deg}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 3000 N}
  rope: {kind: cable, diameter: 12 mm, weight: 0.5 N/m, stiffness: 40 kN}
  wire: {kind: cable, diameter: 10 mm, weight: 3 N/m, stiffness: 3 MN}
  links: {kind: chain, diameter: 13 mm, weight: 30 N/m, stiffness: 20 MN}
  logger: {kind: cylinder, diameter: 60 mm, length: 0.4 m, buoyancy: -40 N}
  release: {kind: cylinder, role: release, diameter: 0.2 m, length: 1.2 m, buoyancy: -300 N}
  weight: {kind: anchor, weight: 9000 N, length: 0.4 m}
line:
"""
MADE = {
    "a buoy that rides over rope, a release, chain and wire": """\
  - {use: ball}
  - {use: rope, length: 60 m, clamps: [{use: logger, at: 20 m}]}
  - {use: release}
  - {use: links, length: 30 m, clamps: [{use: logger, at: 5 m}, {use: logger, at: 20 m}]}
  - {use: release, clamps: [{use: logger, at: 0.3 m}]}
  - {use: wire, length: 40 m}
  - {use: weight}
""",
    "a float below the surface that cannot lift its chain": """\
  - {use: ball}
  - {use: rope, length: 30 m}
  - {use: links, length: 60 m, clamps: [{use: logger, at: 10 m}, {use: logger, at: 45 m}]}
  - {use: links, length: 70 m}
  - {use: weight}
""",
}
SETTINGS = "solver: {seabed_friction: %s, angle_step: 0.4 deg}\n"
"""Where friction takes most of the tension, `calm run` knows what is left to a percent at 1 degree:
it refines for the tension of what hangs."""


@pytest.mark.parametrize("strength", [0.1, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.6])
@pytest.mark.parametrize("line", MADE.values(), ids=MADE.keys())
def test_made_lines_agree(tmp_path: Path, line: str, friction: float, strength: float) -> None:
    mooring = made_mooring(tmp_path, SEA + line + SETTINGS % friction)
    depth, u, v, w = drawn(5, 2 * CHARACTERS, mooring.water.depth)
    current = u * strength, v * strength, w * strength
    found = solve_profiles(mooring, current[0], current[1], depth, current[2])
    assert (found.anchor_vertical == 0.0).any()
    assert_as_run(found, mooring, depth, *current)


@pytest.mark.parametrize("line", MADE.values(), ids=MADE.keys())
def test_made_lines_agree_on_a_slope(tmp_path: Path, line: str) -> None:
    sea = SEA.replace("components:", "  seabed: {slope: 7 deg, toward: 140 deg}\ncomponents:")
    mooring = made_mooring(tmp_path, sea + line + SETTINGS % 0.3)
    depth, u, v, w = drawn(5, 2 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert (np.abs(found.anchor_vertical) < 0.2 * found.anchor_horizontal).any()
    assert_as_run(found, mooring, depth, u, v, w)


@pytest.mark.parametrize("name", ["braconnot-buoy", "chain-and-rope-surface"])
def test_shipped_lines_agree_from_slack_to_taut(name: str) -> None:
    mooring = shipped(name)
    solver = mooring.file.solver.model_copy(update={"angle_step": radians(0.4)})
    mooring = Design(replace(mooring.file, solver=solver))
    depth, u, v, w = drawn(21, 3 * CHARACTERS, mooring.water.depth)
    strength = np.geomspace(0.05, 3.0, len(u))[:, None]
    current = u * strength, v * strength, w * strength
    found = solve_profiles(mooring, current[0], current[1], depth, current[2])
    lies = found.anchor_vertical == 0.0
    assert lies.any()
    assert not lies.all()
    assert_as_run(found, mooring, depth, *current)


@pytest.mark.parametrize("name", ["braconnot-buoy", "chain-and-rope-surface"])
def test_lines_that_land_are_the_same_in_any_order(name: str) -> None:
    mooring = shipped(name)
    depth, u, v, w = drawn(8, 60 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert (found.anchor_vertical == 0.0).sum() > 50
    order = np.random.default_rng(4).permutation(len(u))
    other = solve_profiles(mooring, u[order], v[order], depth, w[order], workers=2)
    for name in ("depth_top", "x_top", "tension_bottom", "tilt", "used_buoyancy"):
        assert getattr(found, name)[order].tobytes() == getattr(other, name).tobytes()


def test_what_is_not_chain_may_not_lie_below_a_float_that_has_sunk(tmp_path: Path) -> None:
    line = """\
  - {use: ball}
  - {use: links, length: 120 m}
  - {use: release}
  - {use: weight}
"""
    mooring = made_mooring(tmp_path, SEA.replace("3000 N", "2000 N") + line)
    depth, u, v, w = drawn(5, CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, 0.1 * u, 0.1 * v, depth, 0.1 * w)
    assert {STATUSES[status] for status in found.status} == {"no-equilibrium"}
    assert_as_run(found, mooring, depth, 0.1 * u, 0.1 * v, 0.1 * w)


def test_a_line_that_ends_in_a_float_is_never_looked_for_on_the_seabed(tmp_path: Path) -> None:
    line = "  - {use: ball}\n  - {use: rope, length: 120 m}\n  - {use: ball}\n  - {use: weight}\n"
    mooring = made_mooring(tmp_path, SEA + line)
    depth, u, v, w = drawn(5, CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert not (found.anchor_vertical == 0.0).any()
    assert_as_run(found, mooring, depth, u, v, w)
