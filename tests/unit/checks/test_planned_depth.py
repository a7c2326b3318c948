"""Planned depths against the depths in still water: `planned-depth`."""

from __future__ import annotations

from pathlib import Path

import pytest

from calm.case import load
from calm.checks.assess import with_probabilities
from calm.checks.design_check import check
from calm.checks.finding import Finding, State, worst_state
from calm.shipped import shipped_folder

LINE = """\
name: planned
environment:
  depth: {depth} m
  current: {{columns: [depth m, speed m/s, toward deg], rows: [[0, 0.3, 90], [2000, 0.1, 90]]}}
checks: {{{checks}}}
line:
  - {{use: float-clamshell-54in, label: float}}
  - {{use: wire-jacketed-8, length: {upper} m, label: wire 1, clamps: [
      {{use: sbe37, at: 10 m, label: upper, planned_depth: 210 m}}]}}
  - {{use: rcm11, label: middle, planned_depth: 500 m}}
  - {{use: wire-jacketed-8, length: {lower} m, label: wire 2, clamps: [
      {{use: sbe37, at: 100 m, label: lower, planned_depth: 600 m}}]}}
  - {{use: anchor-wheels-4}}
"""


def _found(
    folder: Path, depth: float = 1000.0, upper: float = 300.0, lower: float = 500.0,
    checks: str = "",
) -> list[Finding]:  # fmt: skip
    path = folder / "planned.yaml"
    path.write_text(LINE.format(depth=depth, upper=upper, lower=lower, checks=checks))
    return [one for one in check(load(path)).all_findings() if one.rule == "planned-depth"]


def test_the_depth_in_still_water_is_compared(tmp_path: Path) -> None:
    """The current knocks the line down; the plan is of still water."""
    found = _found(tmp_path)
    assert [one.component for one in found] == ["upper", "middle", "lower"]
    assert {one.state for one in found} == {State.PASS}
    path = tmp_path / "planned.yaml"
    result = load(path).solve()
    for one in found:
        rows = result.clamps if one.component != "middle" else result.components
        row = rows[one.component]
        planned, depth = row.part.planned_depth, row.upper[0] - row.knockdown
        assert one.value == pytest.approx(abs(depth - planned))
        assert one.limit == max(10.0, 0.02 * planned)


@pytest.mark.parametrize(
    ("longer", "state"),
    [(7.0, "pass"), (15.0, "warn"), (25.0, "fail")],
)
def test_a_wire_of_another_length_moves_what_is_above_it(
    longer: float, state: str, tmp_path: Path
) -> None:
    """The clamp above is planned at 210 m: 10 m is allowed, 21 m is the limit."""
    before = _found(tmp_path)
    after = _found(tmp_path, upper=300.0 + longer)
    assert after[0].state == state and after[0].component == "upper"
    assert {one.state for one in after[1:]} == {State.PASS}
    assert before[0].value is not None  # 1.8 m too shallow
    assert after[0].value == pytest.approx(before[0].value + longer, abs=0.1)
    if state != "pass":
        assert after[0].remedy == "Check the lengths and clamp positions between upper and middle."


@pytest.mark.parametrize("deeper", [100.0, -80.0, 15.0])
def test_all_off_by_one_amount_is_one_finding(deeper: float, tmp_path: Path) -> None:
    (found,) = _found(tmp_path, depth=1000.0 + deeper)
    assert found.component is None
    assert found.state is (State.FAIL if abs(deeper) > 50.0 else State.WARN)
    way = "too deep" if deeper > 0.0 else "too shallow"
    assert found.message.startswith("All 3 parts with a planned depth are ")
    assert way in found.message
    assert found.remedy == "Check `depth`, and the lengths below lower."


def test_probabilities_count_parts_whatever_the_others_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In most samples all parts are off alike, which is one finding there."""
    monkeypatch.setattr("calm.checks.assess.HANDLED", 8)  # a launch takes long
    _found(tmp_path)
    path = tmp_path / "planned.yaml"
    path.write_text(path.read_text() + "uncertainty: {depth: 3 %}\n")
    assessment = with_probabilities(check(load(path)), 64, 1)
    found = [one for one in assessment.findings if one.rule == "planned-depth"]
    assert len(found) == 3
    assert all(one.probability is not None and one.probability > 0.1 for one in found)


def test_the_limits_of_the_file_are_used(tmp_path: Path) -> None:
    loose = "planned_depth_warning: 30 m, planned_depth_limit: 20 %"
    found = _found(tmp_path, upper=325.0, checks=loose)
    assert {one.state for one in found} == {State.PASS}
    assert "planned_depth_warning" in found[0].source
    strict = _found(tmp_path, upper=325.0, checks="planned_depth_limit: 50 %")
    assert strict[0].state is State.WARN


def test_without_a_plan_the_rule_is_not_judged(tmp_path: Path) -> None:
    """It does not pass, and says nothing of the mooring as a whole."""
    mooring = load(shipped_folder("lines") / "cdms-1.yaml")
    (found,) = [one for one in check(mooring).all_findings() if one.rule == "planned-depth"]
    assert found.state is State.NOT_JUDGED and found.component is None
    assert found.value is found.limit is found.margin is None
    assert worst_state([State.NOT_JUDGED, State.PASS]) is State.PASS
    assert worst_state([State.NOT_JUDGED]) is State.NOT_JUDGED
    order = [State.FAIL, State.UNKNOWN, State.WARN, State.ESTIMATED, State.ACCEPTED,
             State.NOT_JUDGED, State.PASS]  # fmt: skip
    assert sorted(State, key=lambda state: -state.severity) == order


def test_a_slack_line_is_judged_between_its_depth_in_the_current_and_its_length(
    tmp_path: Path,
) -> None:
    """Its shape in still water is not unique; only what no shape can be is a finding."""
    text = (shipped_folder("lines") / "chain-and-rope-surface.yaml").read_text()
    assert load(shipped_folder("lines") / "chain-and-rope-surface.yaml").solve().still_shape is None
    head, line = text.split("line:\n", 1)
    first, second, rest = line.split("\n", 2)
    for planned, state in ((3.0, "pass"), (50.0, "fail")):
        meter = f"  - {{use: sbe37, label: CTD, planned_depth: {planned} m}}"
        path = tmp_path / "slack.yaml"
        path.write_text(f"{head}line:\n{first}\n{second}\n{meter}\n{rest}")
        found = [one for one in check(load(path)).all_findings() if one.rule == "planned-depth"]
        assert [one.state for one in found] == [state]
    assert found[0].remedy == "Check the planned depth of CTD, and the lengths above it."


def test_a_line_cut_to_fit_is_checked_from_its_top(tmp_path: Path) -> None:
    text = (shipped_folder("lines") / "fit-top-depth.yaml").read_text()
    path = tmp_path / "fit.yaml"
    path.write_text(text.replace("CTD 130 m", "CTD 180 m").replace("CTD 230 m", "CTD 280 m"))
    (found,) = [one for one in check(load(path)).all_findings() if one.rule == "planned-depth"]
    assert found.state is State.FAIL and "top_depth" in str(found.remedy)
