"""Figures that nobody prints, taken as those of their class: judged by their low bound."""

from pathlib import Path

import pytest

import calm
from calm.checks.assessment import Assessment
from calm.checks.design_check import check
from calm.checks.finding import Finding, State
from calm.errors import InputError
from calm.report.check_files import check_document

LINE = """\
name: estimates
environment:
  depth: 500 m
  current: {speed: 0.2 m/s, toward: 90 deg}
line:
  - {use: ball}
  - {use: rope, label: upper, length: 100 m}
  - {use: link, label: link FIGURES}
  - {use: rope, label: lower, length: 100 m}
  - {use: weight}
components:
  ball: {kind: sphere, role: float, diameter: 1 m, buoyancy: 3 kN}
  rope: {kind: cable, diameter: 8 mm, weight: 1.6 N/m, stiffness: 3000 kN, working_load: 20 kN}
  link: {kind: body, role: connector, length: 0.1 m, buoyancy: -5 N, kn: 1 N/(m/s)^2,
         inclination: insensitive}
  weight: {kind: anchor, weight: 20 kN}
"""
ESTIMATE = ", estimate: {quantity: working_load, value: 20 kN, low: LOW, source: its chain}"


WAVES = "  waves: {significant_height: 5 cm, peak_period: 5 s}\n"


def judged(tmp_path: Path, figures: str, checks: str = "", waves: str = "") -> Assessment:
    path = tmp_path / "m.yaml"
    text = LINE.replace(" FIGURES", figures).replace("line:\n", f"{waves}line:\n")
    path.write_text(text + checks, encoding="utf-8")
    mooring = calm.load(path)
    return check(mooring)


def of_link(assessment: Assessment, rule: str) -> tuple[State, float | None, str]:
    (finding,) = [
        one for one in assessment.in_environments[0].findings
        if (one.rule, one.component, one.situation) == (rule, "link", "as given")
    ]  # fmt: skip
    return finding.state, finding.limit, finding.message


def missing_of_link(assessment: Assessment) -> list[Finding]:
    found = [(one, one.missing) for one in assessment.findings]
    return [one for one, figure in found if figure and figure.component_id == "link"]


# The link bears 3000 N less 100 m of rope, 2840 N, and the little that the current adds.
def test_what_passes_by_the_low_bound_is_estimated(tmp_path: Path) -> None:
    assessment = judged(tmp_path, ESTIMATE.replace("LOW", "3 kN"))
    state, limit, message = of_link(assessment, "strength")
    assert (state, limit) == (State.ESTIMATED, 3000.0)
    assert message.endswith(
        "`working_load` is estimated: at least 3.00 kN, probably 20.00 kN (its chain)."
    )
    every = [one for one in assessment.all_findings() if one.state is State.ESTIMATED]
    assert check_document([assessment])["estimated"] == len(every) >= 1


def test_what_passes_by_its_value_alone_is_unknown(tmp_path: Path) -> None:
    assessment = judged(tmp_path, ESTIMATE.replace("LOW", "2.8 kN"))
    (finding,) = missing_of_link(assessment)
    assert finding.state is State.UNKNOWN
    assert "probably 20.00 kN (its chain)" in finding.message
    figure = finding.to_dict()
    assert (figure["component_id"], figure["quantity"]) == ("link", "working_load")
    assert figure["needed_by"] == ["strength"]
    assert figure["pieces"] == ["link"]
    assert figure["class_estimate"] == {
        "quantity": "working_load", "value": 20e3, "low": 2.8e3, "low_in_waves": None,
        "quality": None, "source": "its chain",
    }  # fmt: skip
    of_its_load = {"missing", "strength", "launch-strength"}
    rules = {one.rule for one in assessment.all_findings() if one.component == "link"}
    assert rules & of_its_load == {"missing"}


def test_a_figure_that_is_given_counts_and_not_its_estimate(tmp_path: Path) -> None:
    figures = ESTIMATE.replace("LOW", "3 kN") + ", working_load: 2.9 kN"
    assessment = judged(tmp_path, figures)
    assert of_link(assessment, "strength")[:2] == (State.PASS, 2900.0)
    assert check_document([assessment])["estimated"] == 0


def test_an_estimate_of_another_figure_changes_nothing(tmp_path: Path) -> None:
    figures = ", estimate: {quantity: max_tilt, value: 30 deg, low: 20 deg, source: its like}"
    (finding,) = missing_of_link(judged(tmp_path, figures))
    assert finding.missing is not None
    assert finding.missing.quantity == "working_load"
    assert finding.missing.class_estimate is None


def test_what_an_estimate_leaves_unknown_may_be_accepted(tmp_path: Path) -> None:
    accept = "\nchecks: {accept: [{rule: strength, component: link, reason: pulled at 9 kN}]}\n"
    assessment = judged(tmp_path, ESTIMATE.replace("LOW", "1 kN"), accept)
    assert of_link(assessment, "strength")[0] is State.ACCEPTED


def test_results_show_no_estimate_as_a_figure(tmp_path: Path) -> None:
    assessment = judged(tmp_path, ESTIMATE.replace("LOW", "3 kN"))
    result = assessment.in_environments[0].result
    assert result is not None
    (row,) = [row for row in result.components if row.label == "link"]
    assert row.part.component.working_load is None
    assert row.utilisation != row.utilisation


def test_a_lower_bound_alone_is_enough_and_its_quality_is_shown(tmp_path: Path) -> None:
    figures = ", estimate: {quantity: working_load, low: 3 kN, quality: low, source: its chain}"
    state, limit, message = of_link(judged(tmp_path, figures), "strength")
    assert (state, limit) == (State.ESTIMATED, 3000.0)
    assert message.endswith("is estimated: at least 3.00 kN (its chain, quality low).")


# Waves of 5 cm add next to nothing: the bound differs, not the load.
def test_a_line_that_waves_move_is_judged_by_the_bound_for_waves(tmp_path: Path) -> None:
    figures = ESTIMATE.replace("LOW", "3 kN, low_in_waves: 2.8 kN")
    calm_water = of_link(judged(tmp_path, figures), "strength")
    assert calm_water[:2] == (State.ESTIMATED, 3000.0)
    (finding,) = missing_of_link(judged(tmp_path, figures, waves=WAVES))
    assert finding.state is State.UNKNOWN
    for message in (calm_water[2], finding.message):
        assert "at least 3.00 kN (2.80 kN in waves), probably 20.00 kN" in message


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("{quantity: grip, low: 1 kN, low_in_waves: 2 kN, source: a}", "above the `low` of 1000"),
        ("{quantity: weight, value: 1 kN, low: 1 kN, source: a}", "`quantity: weight` must be one"),
        ("{quantity: grip, value: 1 kN, low: 20 deg, source: a}", "`low: 20 deg` is an angle"),
        ("{quantity: grip, value: 1 kN, low: 2 kN, source: a}", "above the `value` of 1000"),
        ("{quantity: grip, value: 1 kN, low: 0 N, source: a}", "must be more than 0 N"),
        ("{quantity: grip, value: 1 kN, low: 1 kN}", "`source` is missing"),
    ],
)
def test_estimates_that_cannot_be_read(written: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as mistake:
        judged(tmp_path, f", estimate: {written}")
    assert said in str(mistake.value)
