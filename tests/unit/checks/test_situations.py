"""What is changed in each situation, against the same mooring written out by hand."""

from __future__ import annotations

import pickle
from functools import wraps
from pathlib import Path

import pytest

from calm.case import Design, load
from calm.case.leg_result import LegResult
from calm.checks.assessment import Assessment
from calm.checks.design_check import check
from calm.checks.finding import State
from calm.checks.posture import reaches_the_surface
from calm.checks.situations import situations_of
from calm.cli.reading import read_designs
from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, solve_mooring

LINE = """
name: shelf
environment:
  depth: 100 m
{environment}  current: {{speed: 0.6 m/s, toward: 90 deg}}
line:
  - {{use: sphere-steel-1250, label: top float}}
{wire}  - {{use: release-ar861}}
  - {{use: chain-buoy-13, length: 5 m}}
  - {{use: anchor-wheels-4}}
"""
WIRE = "  - {use: wire-jacketed-8, length: 60 m, clamps: [{use: sbe37, at: 12 m}]}\n"


def mooring(folder: Path, environment: str = "", wire: str = WIRE) -> Design:
    path = folder / "mooring.yaml"
    path.write_text(LINE.format(environment=environment, wire=wire), encoding="utf-8")
    return load(path)


def results(one: Design) -> dict[str, LegResult | None]:
    return {situation.name: situation.result for (situation,) in situations_of(one)}


def test_a_plain_mooring_is_solved_as_given_at_rest_and_with_strumming_cables(
    tmp_path: Path,
) -> None:
    one = mooring(tmp_path)
    found = results(one)
    assert list(found) == ["as given", "still water", "strumming"]
    given, still, strumming = found.values()
    assert given and still and strumming
    assert still.top.knockdown == 0.0 and still.top.x == 0.0
    assert given.top.knockdown == pytest.approx(one.solve().top.knockdown, abs=0.0)
    band = given.strumming_band
    assert band is not None
    # the same line, solved twice
    assert strumming.top.knockdown == pytest.approx(band.knockdown, rel=1e-9)


@pytest.mark.parametrize(("current", "more", "warned"), [
    ("  current: {speed: 0.6 m/s, toward: 90 deg}", "", False),
    ("  current: {speed: 0 m/s, toward: 90 deg}", "", True),
    ("  current: {speed: 9 mm/s, toward: 90 deg}", "", True),
    ("  current: {speed: 10.1 mm/s, toward: 90 deg}", "", False),
    ("", "", True),
    ("", "environments: {storm: {current: {speed: 0.6 m/s, toward: 90 deg}}}\n", False),
])  # fmt: skip
def test_a_mooring_that_no_current_ever_moves_is_warned_of(tmp_path, current, more, warned):
    path = tmp_path / "m.yaml"
    text = LINE.format(environment="", wire=WIRE)
    text = text.replace("  current: {speed: 0.6 m/s, toward: 90 deg}", current)
    path.write_text(more + text, encoding="utf-8")
    read = load(path)
    environments = [read, *(load(path, name) for name in read.file.variants)]
    found = [one for one in check(*environments).findings if one.rule == "equilibrium"]
    assert bool(found) == warned
    assert all(one.state is State.WARN and "has a current" in one.message for one in found)


def test_a_line_in_still_water_is_not_solved_for_it_again(tmp_path: Path) -> None:
    path = tmp_path / "still.yaml"
    text = LINE.format(environment="", wire=WIRE).replace("0.6 m/s", "0 m/s")
    path.write_text(text, encoding="utf-8")
    read = load(path)
    assert "still water" not in results(read)


def test_the_tide_moves_the_surface_and_the_current_with_it(tmp_path: Path) -> None:
    found = results(mooring(tmp_path, "  depth_range: [97 m, 104 m]\n"))
    for name, depth in (("low water", 97.0), ("high water", 104.0)):
        result = found[name]
        assert result is not None
        text = LINE.format(environment="", wire=WIRE).replace("100 m", f"{depth} m")
        path = tmp_path / "tide.yaml"
        path.write_text(text, encoding="utf-8")
        expected = load(path).solve()
        assert result.top == expected.top


DEPLOYED = """deployed:
  depth: {depth} m
  items: [{{label: wire, length: {length} m}}]
"""


def deployed(folder: Path, depth: float, length: float) -> Design:
    one = mooring(folder, wire=WIRE.replace("jacketed-8, ", "jacketed-8, label: wire, "))
    path = folder / "mooring.yaml"
    path.write_text(path.read_text() + DEPLOYED.format(depth=depth, length=length))
    assert one.file.deployed is None
    return load(path)


def test_a_mooring_is_judged_as_deployed_too(tmp_path: Path) -> None:
    result = results(deployed(tmp_path, 104.0, 58.0))["as deployed"]
    assert result is not None
    path = tmp_path / "other.yaml"
    text = LINE.format(environment="", wire=WIRE.replace("60 m", "58 m"))
    path.write_text(text.replace("100 m", "104 m"), encoding="utf-8")
    written = load(path).solve()
    assert result.top == written.top


@pytest.mark.parametrize(("depth", "length", "moved", "state"), [
    (102.5, 60.0, 2.5, State.PASS),  # 1 m and 2.3 % of 100 m, as squares: 2.508 m
    (102.52, 60.0, 2.52, State.WARN),
    (100.0, 63.0, 3.0, State.WARN), (103.0, 63.0, 0.0, State.PASS),
    (200.0, 60.0, 100.0, State.WARN),
])  # fmt: skip
def test_a_top_that_is_not_where_it_was_designed_to_be(tmp_path, depth, length, moved, state):
    [found] = [
        one for one in check(deployed(tmp_path, depth, length)).findings
        if one.rule == "as-deployed"
    ]  # fmt: skip
    assert (found.value, found.state) == (pytest.approx(moved), state)
    assert found.limit == pytest.approx((1.0 + 2.3**2) ** 0.5)
    assert ("deeper" if depth - 100 > length - 60 else "shallower") in found.message


def test_a_line_to_the_surface_stands_in_another_depth_than_designed(tmp_path: Path) -> None:
    one = mooring(tmp_path, wire=WIRE.replace("60 m", "120 m"))
    path = tmp_path / "mooring.yaml"
    path.write_text(path.read_text() + "deployed: {depth: 110 m}\n")
    [found] = [each for each in check(load(path)).findings if each.rule == "as-deployed"]
    assert reaches_the_surface(one.leg) and found.value == pytest.approx(10.0)
    assert "The water is 10.0 m deeper" in found.message


def test_what_was_deployed_deeper_than_it_stands_fails_the_check(tmp_path: Path) -> None:
    found = check(deployed(tmp_path, 5000.0, 60.0)).all_findings()
    rating = [one for one in found if one.rule == "depth-rating" and one.state is State.FAIL]
    assert {one.situation for one in rating} == {"as deployed"}


def test_a_deployment_that_changes_nothing_is_not_solved(tmp_path: Path) -> None:
    assert "as deployed" not in results(deployed(tmp_path, 100.0, 60.0))


def test_what_is_cut_to_fit_keeps_its_length_when_the_tide_comes(tmp_path: Path) -> None:
    fit = "  - {use: wire-jacketed-8, length: fit, top_depth: 30 m}\n"
    found = results(mooring(tmp_path, "  depth_range: [97 m, 104 m]\n", fit))
    given, high, low = found["as given"], found["high water"], found["low water"]
    assert given and high and low
    lengths = [result.components.cut_length[1] for result in (given, high, low)]
    assert lengths == [lengths[0]] * 3
    still = [result.top.depth - (result.top.knockdown or 0.0) for result in (given, high, low)]
    # a line of one length stands as high above the bed at any tide; closed to 1e-7 of the depth
    assert still == pytest.approx([30.0, 34.0, 27.0], abs=1e-4)


def test_growth_thickens_everything_down_to_its_depth(tmp_path: Path) -> None:
    one = mooring(tmp_path, "  fouling: {depth: 50 m, thickness: 20 mm}\n")
    found = results(one)
    given, fouled = found["as given"], found["fouling"]
    assert given and fouled and given.still_shape is not None
    wire = given.file.pieces[1].component
    # plumb in still water; the stretch of 60 m of wire, some centimetres, is the same in both parts
    top = given.components.depth_top[1] - given.components.knockdown[1]
    bottom = given.components.depth_bottom[1] - given.components.knockdown[2]
    upper = float(60.0 * (50.0 - top) / (bottom - top))
    # areas of the logger of 62 mm and 0.63 m, and of the sphere of 1.25 m, with 20 mm around them
    cn, cx = 1.3 * 0.102 * 0.67 / (0.062 * 0.63), 0.5 * (1.29 / 1.25) ** 2
    by_hand = (
        f"  - {{use: wire-jacketed-8, length: {upper!r} m, diameter: {wire.diameter + 0.04!r} m, "
        f"label: grown, clamps: [{{use: sbe37, at: 12 m, cn: {cn!r}}}]}}\n"
        f"  - {{use: wire-jacketed-8, length: {60.0 - upper!r} m, label: clean}}\n"
    )
    path = tmp_path / "grown.yaml"
    text = LINE.format(environment="", wire=by_hand)
    path.write_text(text.replace("label: top float", f"label: top float, cx: {cx!r}"), "utf-8")
    expected = load(path).solve()
    assert expected.top.knockdown is not None and given.top.knockdown is not None
    assert fouled.top.knockdown == pytest.approx(expected.top.knockdown, rel=1e-3)
    assert fouled.top.knockdown > 1.5 * given.top.knockdown
    assert fouled.components.label.count("wire-jacketed-8") == 2
    assert len(fouled.clamps) == len(given.clamps)


def test_growth_below_which_nothing_reaches_changes_nothing(tmp_path: Path) -> None:
    found = results(mooring(tmp_path, "  fouling: {depth: 1 m, thickness: 20 mm}\n"))
    given, fouled = found["as given"], found["fouling"]
    assert given and fouled
    assert fouled.top == given.top


def test_a_slack_line_has_no_still_water(tmp_path: Path) -> None:
    path = tmp_path / "slack.yaml"
    text = LINE.format(environment="", wire=WIRE.replace("60 m", "110 m"))
    path.write_text(text, encoding="utf-8")
    read = load(path)
    assert "still water" not in results(read)
    assert results(read)["as given"] is not None


BUOY = """
name: buoy
environment:
  depth: 100 m
  depth_range: [96 m, {high} m]
  current: {{speed: {speed} m/s, toward: 90 deg}}
line:
  - {{use: ball}}
  - {{use: rope, length: {length} m}}
  - {{use: block}}
components:
  ball: {{kind: sphere, diameter: 1.2 m, mass: 150 kg, buoyancy: 6 kN}}
  rope: {{kind: cable, diameter: 14 mm, weight: 0.1 N/m, material: polyester, stiffness: 60 kN,
         breaking_load: 40 kN}}
  block: {{kind: anchor, weight: 40 kN}}
"""


FOLD = """
name: fold
environment:
  depth: 500 m
  current: {speed: 1 m/s, toward: 90 deg}
line:
  - {use: ball}
  - {use: wire, length: 100 m}
  - {use: meter}
  - {use: rope, length: 60 m}
  - {use: glass}
  - {use: rope, length: 250 m}
  - {use: block}
components:
  ball: {kind: sphere, diameter: 1 m, buoyancy: 3000 N}
  glass: {kind: cylinder, diameter: 0.43 m, length: 6 m, buoyancy: 3500 N}
  wire: {kind: cable, diameter: 8 mm, weight: 2 N/m, material: steel}
  rope: {kind: cable, diameter: 14 mm, weight: 0.3 N/m, stiffness: 400 kN, material: polyester}
  meter: {kind: cylinder, diameter: 0.15 m, length: 0.6 m, buoyancy: -2900 N}
  block: {kind: anchor, weight: 30 kN}
"""


def judged(folder: Path, **figures: float) -> Assessment:
    path = folder / "buoy.yaml"
    path.write_text(BUOY.format(**figures), encoding="utf-8")
    read = load(path)
    return check(read)


def found(assessment: Assessment, rule: str, situation: str) -> list[str]:
    return [
        finding.state.value
        for finding in assessment.all_findings()
        if (finding.rule, finding.situation) == (rule, situation)
    ]


def test_a_buoy_that_the_tide_drowns_fails(tmp_path: Path) -> None:
    one = judged(tmp_path, high=112, speed=0.3, length=98)
    high = next(each for each in one.in_environments[0].situations if each.name == "high water")
    assert high.result is not None and high.result.type == "subsurface"
    assert found(one, "reserve", "as given") == ["pass"]
    assert found(one, "reserve", "high water") == ["fail"]
    assert found(one, "freeboard", "high water") == ["fail"]


def test_a_buoy_on_a_slack_line_that_the_current_takes_under_fails(tmp_path: Path) -> None:
    """It has no shape in still water, and is a buoy all the same: with the factor of one."""
    one = judged(tmp_path, high=101, speed=3.0, length=108)
    assert (
        one.in_environments[0].result is not None
        and one.in_environments[0].result.type == "subsurface"
    )
    assert found(one, "reserve", "as given") == ["fail"]
    (rope,) = [
        each
        for each in one.in_environments[0].findings
        if (each.rule, each.component, each.situation) == ("strength", "rope", "as given")
    ]
    assert rope.limit == pytest.approx(40_000.0 / 5.0)


def test_a_taut_line_is_slackest_in_still_low_water(tmp_path: Path) -> None:
    one = judged(tmp_path, high=101, speed=0.5, length=92)
    least = {
        each.name: each.result.components.least_tension[1]
        for each in one.in_environments[0].situations
        if each.result is not None
    }
    assert min(least, key=lambda name: float(least[name])) == "still low water"


def test_the_least_margin_of_a_rule_is_told_whatever_the_state(tmp_path: Path) -> None:
    one = check(mooring(tmp_path))
    (given,) = [
        each for each in one.in_environments[0].findings
        if (each.rule, each.situation) == ("anchor-weight", "as given")
    ]  # fmt: skip
    (tighter,) = [each for each in one.in_environments[0].tighter if each.rule == "anchor-weight"]
    assert tighter.situation == "strumming"
    assert tighter.state is given.state
    assert tighter.margin is not None and given.margin is not None
    assert tighter.margin < given.margin


def test_a_line_that_folds_in_still_water_fails(tmp_path: Path) -> None:
    """The current holds up what its floats do not: at slack water part of it falls slack."""
    path = tmp_path / "fold.yaml"
    path.write_text(FOLD, encoding="utf-8")
    read = load(path)
    one = check(read)
    assert one.in_environments[0].result is not None
    assert found(one, "equilibrium", "still water") == ["fail"]


def test_what_no_environment_changes_is_solved_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mooring(tmp_path)
    environments = []
    for toward in (0, 120, 240):
        file = tmp_path / f"toward-{toward}.yaml"
        current = f"{{speed: 0.5 m/s, toward: {toward} deg}}"
        file.write_text(f"name: toward {toward}\nenvironment: {{current: {current}}}")
        environments.append(str(file))
    ((design,), _) = read_designs([tmp_path / "mooring.yaml"], environments, [], 1)
    moving: list[bool] = []

    @wraps(solve_mooring)
    def counted(line: Line, water: Water, settings: Settings) -> Solution:
        moving.append(water.moving)
        return solve_mooring(line, water, settings)

    monkeypatch.setattr("calm.case.leg.solve_mooring", counted)
    together = [results(one) for one in pickle.loads(pickle.dumps(design)).moorings]
    # still water; the line and its strumming twin without current, marched coarsely
    assert (moving.count(True), moving.count(False)) == (2 * 3, 3)
    for alone, shared in zip(map(results, design.moorings), together, strict=True):
        assert list(alone) == list(shared) == ["as given", "still water", "strumming"]
        for name, result in shared.items():
            one = alone[name]
            assert one is not None and result is not None
            assert (one.top, one.anchor) == (result.top, result.anchor)
            assert one.components.to_dicts() == result.components.to_dicts()
