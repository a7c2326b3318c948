"""What the verdict says at its head is the worst of what it says below."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from calm.checks.finding import State
from calm.files.editing import Draft
from calm.tui.line_rows import table_rows
from calm.tui.live import judge, judge_fully
from calm.tui.theme import ELLIPSIS
from calm.tui.verdict_text import headline, verdict_lines
from tests.judged import without_checks
from tests.tui.conftest import MOORING

LINES = Path(__file__).resolve().parents[2] / "lines"


BUOY = without_checks("braconnot-buoy")


def lines_of(text):
    return list(verdict_lines(judge_fully(judge(text))))


def the(lines, begin):
    return next(each for each in lines if each.text.startswith(begin))


@pytest.mark.parametrize(
    "anchor, needs, state",
    # as given 720 N, and more as the cable strums: a failure if it fails as given, too
    [
        ("700 N", "needs 949 N (strumming), has", State.FAIL),
        ("800 N", "needs 949 N (strumming), has", State.WARN),
        ("1000 N", "needs 949 N (strumming), has", State.PASS),
    ],
)
def test_the_anchor_needs_what_the_worst_finding_says(anchor, needs, state):
    lines = lines_of(BUOY.replace("weight: 1000 N", f"weight: {anchor}"))
    head = the(lines, "needs")
    assert head.text.startswith(needs) and head.state is state
    for each in (each for each in lines if each.heading):
        if found := re.search(r"([\d.]+ k?N) is required", each.text):
            assert f"needs {found[1]}" in head.text and each.state is head.state
            assert each.heading == "Anchor weight" + " (strumming)" * ("strumming" in needs)


def test_the_reserve_is_that_of_the_worst_finding():
    lines = lines_of(BUOY.replace("buoyancy: 1000 N", "buoyancy: 550 N"))
    head, below = (
        the(lines, "212 N"),
        the(lines, "127 % of ≥ 0.300. Reserve buoyancy of the float is 24 %"),
    )
    assert head.heading == "Reserve" and head.state is below.state is State.WARN
    assert head.text.endswith("61% of the float's buoyancy in use; 76% at worst (strumming)")
    assert below.heading == "Reserve buoyancy (strumming)"


def test_the_knockdown_is_that_of_the_worst_finding():
    text = without_checks("s1000")
    lines = lines_of(text + "checks: {maximum_knockdown: 35 m}\n")
    head = next(each for each in lines if each.heading == "Knockdown" and "top at" in each.text)
    below = next(each for each in lines if "Knockdown of the top is" in each.text)
    worst = re.search(r"is ([\d.]+ m)", below.text)[1]
    assert re.match(r"\d+ % of ≤ 35.0 m\. Knockdown of the top", below.text)
    assert head.text.endswith(f"; {worst} at worst (strumming)") and head.state is below.state


def test_the_use_of_a_row_is_the_greatest_of_any_situation():
    view = judge_fully(judge(BUOY))
    block = view.rows[-1]
    tighter = [each for each in view.tighter if each.component == block.label]
    assert tighter and block.use == max(each.utilisation for each in tighter)
    assert block.use == pytest.approx(949.2 / 1000.0, abs=2e-3)  # as it strums
    assert block.state is State.UNKNOWN  # its strength is not given


def test_a_line_without_an_anchor_is_told_what_one_is_to_weigh():
    lines = list(verdict_lines(judge(BUOY.replace("  - {use: block}\n", ""))))
    assert the(lines, "needs").text == "needs 720 N in water"


def test_nothing_is_said_to_pass_before_all_is_judged():
    view = judge((LINES / "s1000.yaml").read_text(encoding="utf-8"))
    assert headline(view).sign == "…" and headline(view).state is None
    assert "so far" in headline(view).text
    fully = judge_fully(view)
    assert headline(fully).sign != "…"


def test_what_is_unknown_does_not_pass():
    view = judge_fully(judge(BUOY))
    kept = tuple(e for e in view.findings if e.state in (State.PASS, State.UNKNOWN))
    assert any(each.state is State.UNKNOWN for each in kept)
    head = headline(replace(view, findings=kept))
    assert "unknown" in head.text and head.sign == "?"


def test_the_use_of_unknown_strength_is_a_question():
    view = judge_fully(judge(BUOY))
    rows = table_rows(Draft(BUOY), view, None)
    lacking = [row.texts.get("use") for row in rows if row.spot.item == 1]
    assert lacking == ["?"]
    assert view.rows[1].lacks_strength


STORM = """
environments:
  storm:
    current: {speed: 1.5 m/s, toward: 90 deg}
"""


def test_all_environments_are_judged_and_the_worst_is_named():
    text = MOORING.replace("breaking_load: 20 kN", "breaking_load: 12 kN") + STORM
    view = judge_fully(judge(text))
    assert [each.environment for each in view.cases] == ["own", "storm"]
    lines = list(verdict_lines(view))
    by_heading = {each.heading: each for each in lines}
    assert by_heading["In storm"].state is State.FAIL
    assert by_heading["In default environment"].state is not State.FAIL
    assert headline(view).state is State.FAIL
    grave = [each.heading for each in lines if each.state is State.FAIL and each.heading]
    assert any("(storm" in heading for heading in grave)


def test_seen_from_the_storm_the_own_environment_is_named():
    text = MOORING + STORM
    here, there = (judge_fully(judge(text, environment=name)) for name in (None, "storm"))
    assert {each.environment for each in there.cases} == {"own", "storm"}
    count = [sum(f.state is State.FAIL for f in each.findings) for each in (here, there)]
    assert count[0] == count[1] > 0


def test_an_environment_that_cannot_be_read_is_named(tmp_path):
    text = MOORING + "environments: {neap: {current: {file: none.csv}}}\n"
    view = judge(text, tmp_path / "m.yaml")
    if not view.problems:  # the file of another environment is looked for when that is judged
        view = judge_fully(view)
        assert view.elsewhere and headline(view).state is State.FAIL
        assert any("none.csv" in each.text for each in verdict_lines(view))


def test_nothing_passes_before_all_is_judged_nor_where_a_figure_is_missing():
    early = judge(MOORING)
    signs = [headline(early).sign, *(each.sign for each in verdict_lines(early))]
    assert State.PASS.sign not in signs and signs[0] == ELLIPSIS
    lines = [*verdict_lines(judge_fully(early))]
    unknown = {each.heading for each in lines if each.state is State.UNKNOWN}
    passed = next(each.text for each in lines if each.heading == "Pass").split(", ")
    assert unknown and not unknown & set(passed)


def test_an_environment_that_fails_is_named_and_each_has_its_line():
    """The own one is sound; what fails elsewhere makes the whole verdict fail."""
    gale = "environments:\n  gale: {current: {speed: 4 m/s, toward: 0 deg}}\n"
    view = judge_fully(judge(MOORING.replace("line:\n", f"{gale}line:\n")))
    lines = [each for each in verdict_lines(view) if each.heading.startswith("In ")]
    assert [each.heading for each in lines] == ["In default environment", "In gale"]
    assert lines[1].state is State.FAIL and lines[0].state is not State.FAIL
    assert headline(view).state is State.FAIL
    assert any("gale" in each.heading for each in verdict_lines(view) if each.state is State.FAIL)
