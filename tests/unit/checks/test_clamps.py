"""The pull of what is clamped on a line, and its drag in the fall and the rise, by hand."""

from math import hypot, pi
from types import SimpleNamespace

import pytest

import calm
from calm.assemble import axial_drag_of, with_axial_clamps
from calm.checks.arrangement import clamp_grip, clamp_place
from calm.checks.design_check import check
from calm.checks.recovery import recovery_of
from calm.drop.launch import launch_of
from calm.shipped import shipped_folder

FILE = """
name: By hand
environment:
  depth: 500 m
  current: {speed: 0.5 m/s, toward: 90 deg}
line:
  - {use: ball, label: top}
  - {use: thin, label: wire, length: 400 m, clamps: [LOGGERS]}
  - {use: opener, label: release}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, role: float, buoyancy: 3000 N}
  opener: {kind: body, role: release, length: 0 m, buoyancy: -300 N, kn: 9 N/(m/s)^2, inclination: insensitive}
  logger: {kind: cylinder, diameter: 100 mm, length: 0.5 m, cn: 1.2, ct: 0.8, buoyancy: -40 N}
  box: {kind: body, length: 0.3 m, kn: 30 N/(m/s)^2, inclination: insensitive, buoyancy: -40 N}
  thin: {kind: cable, diameter: 8 mm, weight: 1 N/m, ct: 0}
  block: {kind: anchor, weight: 20 kN, kt: 600 N/(m/s)^2}
"""  # noqa: E501


@pytest.fixture
def load(tmp_path):
    def of(loggers, **changes):
        text = FILE.replace("LOGGERS", loggers)
        for old, new in changes.items():
            text = text.replace(old, new)
        path = tmp_path / "m.yaml"
        path.write_text(text, encoding="utf-8")
        return calm.load(path)

    return of


def test_the_pull_is_that_of_weight_and_drag(load):
    mooring = load("{use: logger, at: 50 m, label: a}, {use: box, at: 10 m, label: b, grip: 41 N}")
    found = {one.component: one for one in clamp_grip.judge(mooring.solve().leg)}
    # ½ρ Cn D L V² = 0.5·1025·1.2·0.1·0.5·0.25 N across, 40 N down
    drag = 0.5 * 1025.0 * 1.2 * 0.1 * 0.5 * 0.25
    assert found["a"].value == pytest.approx(hypot(drag, 40.0), rel=1e-9)
    assert (found["a"].state, found["a"].limit) == ("not-judged", None)
    assert found["b"].value == pytest.approx(hypot(7.5, 40.0), rel=1e-9)
    assert (found["b"].state, found["b"].limit) == ("pass", 41.0)


def test_the_drag_of_a_clamp_is_that_of_the_water_there(load):
    heavy = {"depth: 500 m": "depth: 500 m\n  density: 1200 kg/m^3"}
    (found,) = clamp_grip.judge(load("{use: logger, at: 50 m}", **heavy).solve().leg)
    drag = 0.5 * 1200.0 * 1.2 * 0.1 * 0.5 * 0.25
    assert found.value == pytest.approx(hypot(drag, 40.0), rel=1e-9)


@pytest.mark.parametrize(("at", "fails"), [(0.0, False), (0.1, True), (0.3, False)])
def test_half_of_what_is_clamped_at_an_end_may_stick_out(load, at, fails):
    """A logger of 0.5 m at the very end of a wire hangs beside what is above it."""
    handling = SimpleNamespace(leg=load(f"{{use: logger, at: {at} m}}").leg)
    assert any(one.state == "fail" for one in clamp_place.judge(handling)) == fails


@pytest.mark.parametrize(
    ("figures", "limit", "state"),
    [
        ("grip: 40 N", 40.0, "fail"),
        ("breaking_load: 40 N", 40.0, "fail"),  # where no grip is given
        ("grip: 39 N, breaking_load: 9 kN", 39.0, "fail"),  # a strong thing may slip
        ("grip: 50 N, breaking_load: 40 N", 50.0, "pass"),
        ("working_load: 9 kN", None, "not-judged"),  # says nothing of the clamp
    ],
)
def test_a_grip_comes_before_a_breaking_load(load, figures, limit, state):
    mooring = load(f"{{use: box, at: 10 m, label: b, {figures}}}")
    (found,) = clamp_grip.judge(mooring.solve().leg)
    assert (found.limit, found.state) == (limit, state)


def test_the_fall_and_the_rise_pull_along_the_line(load):
    mooring = load("{use: logger, at: 50 m, label: a}")
    result = mooring.solve()
    fall, rise = launch_of(mooring.leg).fall_speed, recovery_of(mooring.leg, result.leg).rise_speed
    end = 0.5 * 1025.0 * 0.8 * pi * 0.1**2 / 4.0
    pulls = [abs(end * fall**2 - 40.0), 40.0 + end * rise**2]
    (found,) = (one for one in check(mooring).findings if one.rule == "clamp-grip")
    assert found.value == pytest.approx(max(pulls), rel=1e-9)
    assert "during the ascent" in found.message


def test_clamps_in_the_fall_and_the_rise_have_their_drag_along_the_line(load):
    """Many loggers on a plumb line in still water: all that drags is known."""
    loggers = ", ".join(f"{{use: logger, at: {at} m}}" for at in range(10, 400, 10))
    changes = {"speed: 0.5 m/s": "speed: 0 m/s", "depth: 500 m": "depth: 5000 m"}
    mooring = load(loggers, **changes)
    result = mooring.solve()
    end, ball = 0.5 * 1025.0 * 0.8 * pi * 0.1**2 / 4.0, 0.5 * 1025.0 * 0.5 * pi / 4.0
    net = 3000.0 - 39 * 40.0 - 400.0 - 300.0
    drag = ball + 39 * end + 9.0
    rise = recovery_of(mooring.leg, result.leg).rise_speed
    assert rise == pytest.approx((net / drag) ** 0.5, rel=1e-4)
    falls = ((20_000.0 - net) / (drag + 600.0)) ** 0.5
    assert launch_of(mooring.leg).fall_speed == pytest.approx(falls, rel=1e-4)


def test_loggers_on_a_wire_below_a_buoy_fall_with_it_taut():
    """Free, they would fall faster than their wire; the drag of the buoy keeps the line taut."""
    mooring = calm.load(shipped_folder("lines") / "taut-nylon-surface.yaml")
    launch = launch_of(mooring.leg)
    assert launch.tangles == ()
    assert launch.greatest_tension.min() > 5000.0
    assessment = check(mooring)
    speed = next(one for one in assessment.findings if one.rule == "launch-speed")
    assert speed.value == launch.fall_speed
    assert not any(one.rule == "tangling" for one in assessment.findings)


def test_what_has_no_axis_has_its_one_drag(load):
    mooring = load("{use: box, at: 10 m}, {use: ball, at: 20 m}, {use: logger, at: 30 m}")
    line = with_axial_clamps(mooring.line, mooring.file.pieces[:-1])
    box, ball, logger = (clamp.component for clamp in mooring.file.pieces[1].clamps)
    assert axial_drag_of(box) == 30.0
    assert axial_drag_of(ball) == pytest.approx(0.5 * 1025.0 * 0.5 * pi / 4.0)
    assert line.clamp_drag.tolist() == [axial_drag_of(each) for each in (box, ball, logger)]
    assert mooring.line.clamp_drag[2] > 3.0 * line.clamp_drag[2]


def test_a_line_that_is_hauled_in_pulls_at_no_clamp_in_an_ascent():
    text = """
environment: {depth: 60 m, current: {speed: 0.5 m/s, toward: 90 deg}}
line:
  - {use: sphere-ore-41in}
  - {use: chain-buoy-13, length: 70 m, clamps: [{use: sbe37, at: 10 m, label: logger}]}
  - {use: anchor-wheels-2}
"""
    found = [
        one
        for one in check(calm.load("hauled.yaml", text=text)).all_findings()
        if one.rule == "clamp-grip" and one.component == "logger"
    ]
    assert found and not any("ascent" in one.message for one in found)
