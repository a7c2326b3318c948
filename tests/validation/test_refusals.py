"""Lines that lie on the seabed: which are refused and why, and an equilibrium near the surface."""

from pathlib import Path

import pytest

import calm
from calm.errors import NoEquilibrium

LAID_DOWN = """\
name: buoyant enough, but laid down by the current
environment:
  depth: 100 m
  current: {speed: 2 m/s, toward: 90 deg}
line:
  - {use: float}
  - {use: rope, length: 95 m}
  - {use: release}
  - {use: chain, length: 3 m}
  - {use: anchor}
components:
  float: {kind: sphere, diameter: 1 m, buoyancy: 1000 N}
  rope: {kind: cable, diameter: 60 mm, weight: 0 N/m}
  release: {kind: cylinder, diameter: 0.13 m, length: 1 m, buoyancy: -330 N}
  chain: {kind: chain, diameter: 26 mm, weight: 150 N/m}
  anchor: {kind: anchor, weight: 100000 N}
"""


def test_a_release_laid_down_by_the_current_is_named(tmp_path: Path) -> None:
    """1000 N of buoyancy hold 780 N up: it is not too little."""
    (tmp_path / "m.yaml").write_text(LAID_DOWN)
    with pytest.raises(NoEquilibrium) as caught:
        calm.load(tmp_path / "m.yaml").solve()
    assert caught.value.status == "grounded"
    assert caught.value.message.startswith("The current puts release on the seabed")
    heavy = LAID_DOWN.replace("buoyancy: 1000 N", "buoyancy: 700 N")
    (tmp_path / "m.yaml").write_text(heavy)
    with pytest.raises(
        NoEquilibrium, match="is 700 N, but the weight of the other pieces in water is 780"
    ):
        calm.load(tmp_path / "m.yaml").solve()


STANDING = """\
name: a weight stands on the anchor
environment:
  depth: 21.1 m
  current: {columns: [depth m, speed m/s, toward deg], rows: [[0, 0.01, 90], [21.1, 0.8, 90]]}
line: [{use: f}, {use: ch, length: 0.5 m}, {use: c, length: 18.9 m}, {use: k}, {use: dw}]
components:
  f: {kind: sphere, diameter: 1.6 m, buoyancy: 507.2 N, mass: 500 kg}
  ch: {kind: chain, diameter: 13 mm, weight: 33 N/m}
  c: {kind: cable, diameter: 20 mm, weight: 0.274 N/m}
  k: {kind: cylinder, diameter: 0.32 m, length: 1.5 m, buoyancy: -492.4 N}
  dw: {kind: anchor, weight: 100000 N, length: 0.5 m}
"""


def test_an_anchor_that_is_pressed_down_needs_no_weight(tmp_path: Path) -> None:
    """1.5 (V + H / 0.6) is -184 N there."""
    (tmp_path / "m.yaml").write_text(STANDING)
    anchor = calm.load(tmp_path / "m.yaml").solve().anchor
    assert 1.5 * (anchor.vertical + anchor.horizontal / 0.6) == pytest.approx(-183.80, abs=0.01)
    assert anchor.required_weight == 0.0


CLAMPS = [
    (4.5, 6.96, 0.0),
    (-78.2, 19.95, 177.84),
    (-21.3, 17.16, 210.0),
    (-75.0, 6.96, 329.05),
    (-71.0, 12.27, 48.6),
    (-22.1, 11.56, 9.35),
    (-62.0, 20.88, 194.0),
    (-4.8, 4.48, 0.0),
    (22.4, 15.11, 331.71),
    (-14.2, 18.62, 490.33),
    (-23.6, 13.83, 478.78),
    (-3.5, 22.26, 397.65),
    (-63.9, 21.5, 490.72),
    (-26.1, 21.34, 201.23),
    (14.0, 24.75, 242.67),
    (9.2, 6.72, 73.44),
    (-71.2, 12.08, 393.48),
    (-79.1, 16.19, 285.32),
    (-80.0, 0.67, 451.21),
    (-68.8, 23.53, 0.0),
]
"""Net buoyancy [N], drag at 1 m/s [N], and place on the rope [m]."""

HANGING = f"""\
name: a landed equilibrium close below the surface
environment:
  depth: 571.2 m
  current:
    columns: [depth m, u m/s, v m/s]
    rows: [[0.0, 0.22679, 0.76143], [11.35, 0.22524, 0.75622], [33.31, 0.21355, 0.71697],
           [53.85, 0.19273, 0.64708], [74.68, 0.16284, 0.5467], [81.88, 0.15068,
           0.50589], [125.2, 0.0627, 0.2105], [155.89, -0.00823, -0.02763],
           [158.29, -0.01383, -0.04644], [161.51, -0.02134, -0.07164], [192.46,
           -0.09109, -0.30581], [264.59, -0.20764, -0.69713], [290.5, -0.22435,
           -0.75324], [307.48, -0.2267, -0.76113], [341.28, -0.21089, -0.70804],
           [378.55, -0.16424, -0.55143], [386.28, -0.15127, -0.50788], [394.51,
           -0.13641, -0.45798], [394.57, -0.1363, -0.4576], [453.92, -0.00746,
           -0.02503], [465.4, 0.01936, 0.065], [526.87, 0.1494, 0.5016],
           [530.44, 0.15558, 0.52234], [550.2346173462895, 0.18579, 0.62377]]
line:
  - {{use: float}}
  - {{use: chain, length: 1 m}}
  - {{use: wire, length: 158.27 m}}
  - {{use: pod}}
  - use: rope
    length: 494.78 m
    clamps: [{", ".join(f"{{use: k{i}, at: {at} m}}" for i, (*_, at) in enumerate(CLAMPS))}]
  - {{use: chain, length: 16.619574568628124 m, stiffness: 10 MN}}
  - {{use: chain, length: 5 m, weight: 39.90523141975701 N/m}}
  - {{use: anchor}}
solver: {{buoy_drag: full}}
components:
  float: {{kind: sphere, diameter: 1.31 m, buoyancy: 2664.7 N, cx: 0.3}}
  chain: {{kind: chain, diameter: 13 mm, weight: 33 N/m}}
  wire: {{kind: cable, diameter: 17.4 mm, weight: 11.177963774533959 N/m, cn: 1.4363197394947367,
         ct: 0.005, stiffness: 9784776.271820487 N}}
  pod: {{kind: cylinder, diameter: 0.44 m, length: 1.98 m, buoyancy: -72.57746097853442 N,
        cn: 1.1023485373775124, ct: 0.5}}
  rope: {{kind: cable, diameter: 12.9 mm, weight: -0.09400687487886548 N/m, cn: 1.7073771129744504,
         ct: 0, stiffness: 166.41 kN}}
  anchor: {{kind: anchor, weight: 10000000 N}}
""" + "".join(
    f"  k{i}: {{kind: body, length: 0 m, buoyancy: {lift} N, kn: {drag} N/(m/s)^2,\n"
    "       inclination: insensitive}\n"
    for i, (lift, drag, _) in enumerate(CLAMPS)
)


def test_an_equilibrium_between_the_surface_and_the_first_step_of_the_scan(tmp_path: Path) -> None:
    """An independent continuous solution has its free end at 0.36 m and chain alone on the bed."""
    (tmp_path / "m.yaml").write_text(HANGING)
    result = calm.load(tmp_path / "m.yaml").solve()
    assert result.top.depth == pytest.approx(0.36, abs=0.005)
    assert 0.0 < result.anchor.grounded_length < 21.6
