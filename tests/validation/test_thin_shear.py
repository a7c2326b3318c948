"""Rigid pieces in layers thinner than they are long, and a float where no current is.

The water along such a piece changes with its lean, so that its balance is bracketed.
"""

from pathlib import Path

import pytest

import calm


@pytest.fixture(params=["never", "always"], ids=["plain", "compiled"], autouse=True)
def speed(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CALM_COMPILED", request.param)


def solved(folder: Path, text: str) -> calm.Result:
    (folder / "m.yaml").write_text(text)
    return calm.load(folder / "m.yaml").solve()


BALLS = """\
name: a float of 1.73 m in a layer of 0.6 m
environment:
  depth: 99.7 m
  current:
    columns: [depth m, u m/s, v m/s]
    rows: [[0, 1.45477, 0.99022], [66.42112709979558, 1.45477, 0.99022],
           [67.01319694488896, 0.72358, 0.49252], [97.28348878730802, 0.72358, 0.49252]]
line:
  - {use: float}
  - {use: rope, length: 86.16 m}
  - {use: ball}
  - {use: small, count: 3}
  - {use: ball}
  - {use: small}
  - {use: ball}
  - {use: chain, length: 3 m}
  - {use: anchor}
components:
  float: {kind: sphere, diameter: 1.73 m, buoyancy: 311.3 N, cx: 0.3}
  rope: {kind: cable, diameter: 6.8 mm, weight: -0.01583450865464897 N/m, cn: 1.3675455773588638,
         ct: 0.013, stiffness: 46240 N}
  ball: {kind: sphere, diameter: 0.43 m, buoyancy: 250 N, cx: 0.95}
  small: {kind: sphere, diameter: 0.33 m, buoyancy: 110 N, cx: 0.8}
  chain: {kind: chain, diameter: 13 mm, weight: 53.12808890403495 N/m, cn: 2.75, ct: 0.46}
  anchor: {kind: anchor, weight: 10000000 N, length: 0.35 m}
solver: {buoy_drag: full}
"""


def test_a_float_across_a_thin_layer(tmp_path: Path) -> None:
    """An independent continuous solution has its top at 66.2738 m, to the last digit given."""
    result = solved(tmp_path, BALLS)
    assert result.top.depth == pytest.approx(66.2738, abs=5e-5)
    assert result.closure < 1e-10


CYLINDERS = """\
name: two cylinders, each in its own current, across a step
environment:
  depth: 148.2 m
  current:
    columns: [depth m, u m/s, v m/s, w m/s]
    rows: [[0, -1.5356, 3.24853, 0], [72.72, -1.5356, 3.24853, -0.62439],
           [100.53552667160395, -1.5356, 3.24853, -0.13267],
           [101.43082055854583, -0.24841, 0.52551, 0.30815], [148, -0.24841, 0.52551, 0]]
line:
  - {use: float}
  - {use: chain, length: 1 m}
  - {use: rope, length: 134.18 m}
  - {use: pod}
  - {use: tube}
  - {use: chain, length: 3 m}
  - {use: anchor}
components:
  float: {kind: sphere, diameter: 1.45 m, buoyancy: 870.5 N, cx: 0.3}
  chain: {kind: chain, diameter: 13 mm, weight: 33 N/m, cn: 2.75, ct: 0.46}
  rope: {kind: cable, diameter: 7.7 mm, weight: -0.01346 N/m, cn: 1.218, ct: 0}
  pod: {kind: cylinder, diameter: 0.36 m, length: 1.15 m, buoyancy: -344 N, cn: 1.19, ct: 0}
  tube: {kind: cylinder, diameter: 0.13 m, length: 1 m, buoyancy: -230 N, cn: 1.2, ct: 0.9}
  anchor: {kind: anchor, weight: 10000000 N, length: 0.35 m}
"""


def test_the_step_is_solved_as_finely_as_one_likes(tmp_path: Path) -> None:
    usual = solved(tmp_path, CYLINDERS)
    fine = solved(tmp_path, CYLINDERS + "solver: {angle_step: 0.1 deg, tolerance: 1e-9}\n")
    assert usual.top.depth == pytest.approx(fine.top.depth, abs=2 * usual.accuracy.depth)
    assert usual.closure < 1e-9


def still_at_the_surface(speed: str, drag: str = "immersed") -> str:
    return f"""\
name: no current at the surface
environment:
  depth: 100 m
  current: {{columns: [depth m, speed m/s, toward deg], rows: [[0, {speed}, 90], [100, 0.8, 90]]}}
line:
  - {{use: buoy}}
  - {{use: rope, length: 110 m}}
  - {{use: anchor}}
solver: {{buoy_drag: {drag}}}
components:
  buoy: {{kind: sphere, diameter: 1.6 m, buoyancy: 2000 N, mass: 500 kg}}
  rope: {{kind: cable, diameter: 20 mm, weight: 0.274 N/m, stiffness: 100 kN}}
  anchor: {{kind: anchor, weight: 100000 N}}
"""


@pytest.mark.parametrize("drag", ["immersed", "full"])
def test_no_current_at_the_surface_is_the_limit_of_little(tmp_path: Path, drag: str) -> None:
    none = solved(tmp_path, still_at_the_surface("0", drag))
    little = solved(tmp_path, still_at_the_surface("1e-9", drag))
    assert none.top.x == pytest.approx(little.top.x, abs=1e-5)
    assert none.top.used_buoyancy == pytest.approx(little.top.used_buoyancy, abs=1e-7)
