"""A profiler on its wire: its stops, the worst place between, and what is asked of it."""

import json
from dataclasses import asdict

import numpy as np
import pytest

from calm.case import load
from calm.case.profilers import PLACES
from calm.checks.arrangement import profiler
from calm.checks.design_check import check
from calm.errors import InputError
from calm.physics.seawater import pressure_at

FILE = """\
name: Profiler
environment:
  depth: 1500 m
  current: CURRENT
line:
  - {use: ball, label: top}
  - use: wire
    length: 1400 m
    label: wire
    clamps:
      - {use: bumper, at: 5 m, label: upper stop}
      - {use: bumper, at: 1380 m, label: lower stop}
      - {use: RIDER, label: MMP, WHERE}
  - {use: rel, label: release}
  - {use: wheels, label: anchor}
components:
  ball: {kind: sphere, role: float, diameter: 1.25 m, buoyancy: 7500 N}
  wire: {kind: cable, role: line, diameter: 8 mm, weight: 0.9 N/m, cn: 1.3, ct: 0.01}
  bumper: {kind: cylinder, role: connector, diameter: 80 mm, length: 0.2 m, buoyancy: -5 N}
  mmp: {kind: profiler, length: 1.3 m, mass: 70 kg, buoyancy: 0 N, drag_area: 0.45 m^2, cd: 0.6,
        drive_force: 50 N, speed: 0.25 m/s}
  like: {kind: body, length: 1.3 m, mass: 70 kg, buoyancy: 0 N, drag_area: 0.45 m^2, cd: 0.6}
  rel: {kind: cylinder, role: release, diameter: 0.3 m, length: 1.2 m, buoyancy: -550 N}
  wheels: {kind: anchor, weight: 14 kN}
"""
STILL = "{speed: 0 m/s, toward: 0 deg}"
TURNING = (
    "{columns: [depth m, speed m/s, toward deg], "
    "rows: [[0, 0.5, 90], [700, 0.5, 90], [800, 0.5, 270], [1500, 0.5, 270]]}"
)
STOPS = "between: [upper stop, lower stop]"


def mooring(path, current=STILL, where=STOPS, rider="mmp", change=("", "")):
    text = FILE.replace("CURRENT", current).replace("WHERE", where).replace("RIDER", rider)
    return load(path / "m.yaml", text=text.replace(*change) if change[0] else text)


def test_in_still_water_each_stop_bears_what_hangs_below_the_float(tmp_path):
    """T(s) = lift of the float - weight of the wire above - the bumpers passed."""
    (travel,) = mooring(tmp_path).solve().profilers
    assert travel.upper.tension == pytest.approx(7500.0 - 0.9 * 5.0, abs=5.01)
    assert travel.lower.tension == pytest.approx(7500.0 - 5.0 - 0.9 * 1380.0, abs=5.01)
    assert travel.lower.depth - travel.upper.depth == pytest.approx(1375.0, abs=1e-6)
    assert travel.upper.tilt == travel.lower.tilt == pytest.approx(0.0, abs=1e-9)


def test_every_place_is_that_of_an_instrument_clamped_there(tmp_path):
    """Where the current turns, at 750 m, the wire leans most between the stops."""
    result = mooring(tmp_path, TURNING).solve()
    (travel,) = result.profilers
    found = []
    for at in np.linspace(5.0, 1380.0, PLACES):
        clamps = mooring(tmp_path, TURNING, f"at: {at} m", "like").solve().clamps
        row = clamps.label.index("MMP")
        found.append((at, clamps.depth[row], clamps.tension[row], clamps.tilt[row]))
    for place, expected in (
        (travel.upper, found[0]),
        (travel.lower, found[-1]),
        (travel.worst, max(found, key=lambda one: one[3])),
    ):
        assert tuple(asdict(place).values()) == pytest.approx(expected, rel=1e-12)
    assert travel.upper.at < travel.worst.at < travel.lower.at
    assert result.clamps.depth[result.clamps.label.index("MMP")] == travel.upper.depth
    assert json.loads(json.dumps(result.to_dict()))["profilers"][0]["worst"]["tilt"] == (
        travel.worst.tilt
    )


def test_a_piece_at_the_end_of_the_wire_is_a_stop(tmp_path):
    (travel,) = mooring(tmp_path, TURNING, "between: [top, release]").solve().profilers
    assert (travel.upper.at, travel.lower.at) == (0.0, 1400.0)


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ("between: [lower stop, upper stop]", "give the upper stop first"),
        ("between: [uper stop, lower stop]", "did you mean `upper stop`?"),
        ("between: [wire, lower stop]", "`wire` is neither a clamp on `wire`"),
        ("between: [upper stop]", "between"),
        ("at: 3 m", "it travels `between` two stops"),
        ("serial: 12", "needs `between: [upper stop, lower stop]`"),
    ],
)
def test_stops_that_cannot_be_are_refused(tmp_path, where, told):
    with pytest.raises(InputError) as refused:
        mooring(tmp_path, STILL, where)
    (problem,) = refused.value.problems
    assert told in problem.message
    assert problem.line == 13


def test_a_profiler_in_the_line_is_refused(tmp_path):
    change = ("  - {use: rel, label: release}", "  - {use: mmp}\n  - {use: rel, label: release}")
    with pytest.raises(InputError, match="a profiler must be among the `clamps`"):
        mooring(tmp_path, change=change)


@pytest.mark.parametrize(
    ("change", "state", "told"),
    [
        (("7500 N", "3300 N"), "fail", "the profiler needs at least 2.22 kN to travel"),
        (("drive_force: 50 N", "drive_force: 5 N"), "fail", "its drive force is 5.00 N"),
        (("drive_force: 50 N, ", ""), "unknown", "The drive force of"),
        (("diameter: 8 mm", "diameter: 14 mm"), "warn", "wire has a diameter of 14.0 mm"),
        (
            ("      - {use: bumper, at: 1380", "      - {use: bumper, at: 600 m}\n"
             "      - {use: bumper, at: 1380"),
            "fail",
            "bumper, 600 m down the wire, blocks MMP",
        ),
    ],
)  # fmt: skip
def test_what_a_profiler_asks_of_its_wire(tmp_path, change, state, told):
    assert {each.state for each in profiler.judge(mooring(tmp_path).solve().leg)} == {"pass"}
    judged = check(mooring(tmp_path, change=change)).all_findings()
    rules = {"profiler", "missing"}
    found = [each for each in judged if each.rule in rules and told in each.message]
    assert max(found, key=lambda each: each.state.severity).state == state


def test_time_and_number_of_profiles(tmp_path):
    """1375 m with 0.25 m/s are 5500 s; 100 km of batteries 72 times that."""
    change = ("speed: 0.25 m/s", "speed: 0.25 m/s, endurance: 100 km")
    (travel,) = mooring(tmp_path, change=change).solve().profilers
    assert (travel.distance, travel.time, travel.profiles) == (1375.0, 5500.0, 72)
    slow = mooring(tmp_path, change=("speed: 0.25 m/s", "speed: 0.05 m/s")).solve()
    told = [each.message for each in profiler.judge(slow) if each.state == "warn"]
    assert told == ["A profile of MMP takes 7 h 38 min; the limit is 6 h 24 min."]


def test_drag_along_a_leaning_wire(tmp_path):
    """½ρ cd A (speed + U sin tilt)² and the weight along the wire, at the tilt of the result."""
    figures = "buoyancy: {} N, drag_area: 0.45 m^2, cd: 0.6,\n        drive_force: {} N"
    weak = (figures.format(0, 50), figures.format(-3, 1))
    result = mooring(tmp_path, "{speed: 0.5 m/s, toward: 90 deg}", change=weak).solve()
    tilt = np.radians(result.profilers[0].upper.tilt)
    past = 0.25 + 0.5 * np.sin(tilt)
    drag = 0.5 * 1025.0 * 0.6 * 0.45 * past**2
    needed = [each.limit for each in profiler.judge(result) if "its drive force is" in each.message]
    assert needed == [pytest.approx(drag + 3.0 * np.cos(tilt), rel=1e-6)]


def test_each_rule_is_judged_at_both_stops_and_where_the_wire_leans_most(tmp_path):
    names = [each.name for each in check(mooring(tmp_path, TURNING)).in_environments[0].situations]
    assert "MMP at its lower stop" in names
    assert "MMP at its largest wire angle" in names
    assert [each for each in names if "MMP" in each] == names[2:4]


def test_pressure_of_the_standard_ocean():
    """10 000 dbar at 30° are 9712.653 m deep (UNESCO 44, 1983, by EOS-80; TEOS-10 differs by 1)."""
    assert pressure_at(9712.653, 30.0) == pytest.approx(10_000.0, abs=2.0)
