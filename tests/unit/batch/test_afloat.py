"""Several floats at the surface in a batch, against `calm run`."""

from pathlib import Path

import pytest

from calm.batch.profiles import solve_profiles
from tests.unit.batch.alike import assert_as_run
from tests.unit.batch.drawn_profiles import CHARACTERS, drawn
from tests.unit.batch.made import made_mooring

MOORING = """\
name: Test
environment:
  depth: 100 m
  density: {columns: [depth m, density kg/m^3], rows: [[0, 1022], [100, 1027]]}
  current: {speed: 0.5 m/s, toward: 90 deg}
  wind: {speed: 8 m/s, toward: 200 deg}
components:
  light: {kind: body, length: 0 m, buoyancy: -50 N, drag_area: 0.02 m^2, cd: 1}
  buoy:
    kind: cylinder
    role: float
    length: 1 m
    diameter: 1 m
    mass: 150 kg
    volume: 0.7854 m^3
    HULL
  ball: {kind: sphere, role: float, diameter: 0.7 m, buoyancy: 1200 N, surface: smooth}
  meter: {kind: cylinder, diameter: 60 mm, length: 0.4 m, buoyancy: -40 N, surface: smooth}
  rope: {kind: cable, diameter: 14 mm, weight: 1 N/m, stiffness: 60 kN}
  chain: {kind: chain, diameter: 13 mm, weight: 30 N/m, breaking_load: 100 kN}
  weight: {kind: anchor, weight: 30 kN, length: 0.4 m}
line:
LINE
  - {use: weight}
solver: {SOLVER}
"""
STAND_OFF = """\
  - {use: buoy}
  - {use: rope, length: 30 m, clamps: [{use: meter, at: 12 m}]}
  - {use: ball, clamps: [{use: meter, at: 0.2 m}]}
  - {use: rope, length: 103 m, clamps: [{use: meter, at: 30 m}]}"""
LINES = {
    "two": (STAND_OFF, "", ""),
    "drag curves": (STAND_OFF, "", "drag: reynolds, friction: hoerner"),
    "one that could ride": (
        f"  - {{use: light}}\n{STAND_OFF}", "hull: cylinder", ""
    ),
    "on the seabed": (
        """\
  - {use: buoy}
  - {use: chain, length: 10 m}
  - {use: ball}
  - {use: rope, length: 90 m}
  - {use: chain, length: 30 m}""", "", ""
    ),
    "three": (
        """\
  - {use: buoy}
  - {use: rope, length: 20 m}
  - {use: ball}
  - {use: rope, length: 15 m}
  - {use: ball}
  - {use: rope, length: 99 m}""", "", ""
    ),
    "two that touch": (
        """\
  - {use: buoy}
  - {use: rope, length: 20 m}
  - {use: ball}
  - {use: ball}
  - {use: rope, length: 99 m}""", "", ""
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", LINES.values(), ids=LINES.keys())
def test_several_floats_at_the_surface_are_as_by_the_run(
    tmp_path: Path, case: tuple[str, str, str]
) -> None:
    line, hull, solver = case
    text = MOORING.replace("LINE", line).replace("HULL", hull).replace("SOLVER", solver)
    mooring = made_mooring(tmp_path, text)
    depth, u, v, w = drawn(4, 2 * CHARACTERS, mooring.water.depth)
    found = solve_profiles(mooring, u, v, depth, w)
    assert_as_run(found, mooring, depth, u, v, w)
    ball = [piece.component.role for piece in mooring.file.pieces].index("float", 1)
    several = found.depth_top[:, ball] < 1e-3
    assert several.sum() >= 3
