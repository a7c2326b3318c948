"""The launch of a line by hand: without friction along it, every drag is K V².

The water is so deep that the line has long come plumb when its anchor lands.
"""

from math import pi, sqrt

import pytest

import calm
from calm.drop.launch import launch_of
from calm.errors import NoEquilibrium
from calm.shipped import shipped_folder

FILE = """
name: By hand
environment:
  depth: 5000 m
  current: {speed: 0.2 m/s, toward: 90 deg}
line:
  - {use: ball, label: top}
  - {use: thin, length: 200 m, ct: CT}
  - {use: meter}
  - {use: thin, length: 100 m, ct: CT}
  - {use: block}
components:
  ball: {kind: body, length: 1 m, buoyancy: 2000 N, kn: 200 N/(m/s)^2, inclination: insensitive}
  meter: {kind: body, length: 1 m, buoyancy: -200 N, kn: 50 N/(m/s)^2, inclination: insensitive}
  thin: {kind: cable, diameter: 10 mm, weight: 1 N/m}
  block: {kind: anchor, weight: 5 kN, kt: 400 N/(m/s)^2}
"""
PLUMB = 1e-3
"""Relative: what is left of the lean, and drag with the speed below 1 mm/s."""
NET = 5000.0 - (2000.0 - 200.0 - 200.0 - 100.0)


@pytest.fixture
def launched(tmp_path):
    def of(text=FILE, ct="0"):
        path = tmp_path / "m.yaml"
        path.write_text(text.replace("CT", ct))
        mooring = calm.load(path)
        return launch_of(mooring.leg)

    return of


def test_speed_and_tensions(launched):
    launch = launched()
    squared = NET / 650.0
    assert launch.fall_speed == pytest.approx(sqrt(squared), rel=PLUMB)
    assert launch.anchor_tension == pytest.approx(5000.0 - 400.0 * squared, rel=PLUMB)
    assert launch.drift == pytest.approx((0.2, 0.0), abs=PLUMB)
    below = 2000.0 + 200.0 * squared
    lower = [below, below - 200.0, below - 400.0 + 50.0 * squared, below - 500.0 + 50.0 * squared]
    assert launch.tension_top == pytest.approx([0.0, *lower[:-1]], abs=1e-6)
    assert launch.tension_bottom == pytest.approx(lower)
    assert launch.anchor_drag_known
    assert launch.tangles == ()


def test_the_band_of_the_drag_of_the_anchor(launched):
    slow, fast = launched().fall_speed_band
    assert (slow, fast) == pytest.approx((sqrt(NET / 1050.0), sqrt(NET / 450.0)), rel=PLUMB)


def test_the_band_of_the_friction_along_the_line(launched):
    launch = launched(FILE.replace("kt: 400 N/(m/s)^2", "kt: 0 N/(m/s)^2"), ct="0.01")
    friction = 512.5 * pi * 0.01 * 0.01 * 300.0
    speeds = [sqrt(NET / (250.0 + times * friction)) for times in (1.0, 2.0, 0.5)]
    assert [launch.fall_speed, *launch.fall_speed_band] == pytest.approx(speeds, rel=PLUMB)


def test_an_anchor_of_unknown_drag_is_a_cube_and_judged_as_if_it_had_none(launched):
    launch = launched(FILE.replace(", kt: 400 N/(m/s)^2", ""))
    volume = 5000.0 / ((7850.0 - 1025.0) * 9.80665)
    squared = NET / (250.0 + 0.5 * 1025.0 * 1.05 * volume ** (2 / 3))
    assert not launch.anchor_drag_known
    assert launch.fall_speed == pytest.approx(sqrt(squared), rel=PLUMB)
    assert launch.greatest_speed == pytest.approx(sqrt(NET / 250.0), rel=PLUMB)
    assert launch.greatest_tension[-1] == pytest.approx(5100.0)
    assert launched().greatest_speed == launched().fall_speed


def test_components_are_named_figures(launched):
    launch = launched()
    rows = launch.components()
    assert [row["index"] for row in rows] == [0, 1, 2, 3]
    assert rows[2]["tension_top"] == launch.tension_top[2]
    assert rows[2]["tension_bottom"] == launch.tension_bottom[2]


def test_a_float_at_the_surface_is_drawn_over_the_anchor():
    """The anchor lands while the float is still on its way: its drag holds the line taut."""
    mooring = calm.load(shipped_folder("lines") / "chain-and-rope-surface.yaml")
    launch = launch_of(mooring.leg)
    assert launch.tangles == ()
    assert launch.greatest_tension.min() > 0.7 * mooring.leg.anchor_weight
    assert launch.anchor_tension < mooring.leg.anchor_weight
    drag = mooring.file.anchor.kt * launch.fall_speed**2
    # it moves sideways as well
    assert mooring.leg.anchor_weight - launch.anchor_tension == pytest.approx(drag, rel=0.1)


def test_a_fall_that_nothing_limits_has_no_speed(launched):
    text = FILE.replace("kt: 400 N/(m/s)^2", "kt: 0 N/(m/s)^2").replace("kn: 200", "kn: 0")
    with pytest.raises(NoEquilibrium, match="speed of the line is unlimited"):
        launched(text.replace("kn: 50", "kn: 0"))


ROPE = """
  rope: {kind: cable, diameter: 10 mm, mass: 0.06 kg/m, density: 1140 kg/m^3, material: nylon,
         breaking_load: 20 kN, elongation: [[0.1, 2 %], [0.3, 6 %]] MORE}
"""


def test_rope_with_permanent_elongation_falls_like_longer_rope(launched):
    """Its weight and its drag per metre are those of the cut length; both differ by 4 %."""
    text = FILE.replace("{use: thin, length: 200 m, ct: CT}", "{use: rope, length: 200 m}") + ROPE
    grown = launched(text.replace("MORE", ", permanent_elongation: 4 %"))
    longer = launched(text.replace("MORE", "").replace("length: 200 m", "length: 208 m"))
    assert grown.fall_speed == pytest.approx(longer.fall_speed, rel=2e-3)
    assert grown.anchor_tension == pytest.approx(longer.anchor_tension, rel=2e-3)
