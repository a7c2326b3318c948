from __future__ import annotations

import math

import pytest

from calm.verification.published_case import CaseColumn, Kind, table
from tests.unit.verification.fakes import BAD, GOOD, case, failing


@pytest.mark.parametrize(
    ("got", "within"),
    [(1.0, True), (1.25, True), (0.75, True), (1.2501, False), (0.7, False), (math.nan, False)],
)
def test_a_figure_is_met_within_its_tolerance(got, within):
    outcome = case(expected=1.0, got=got, tolerance=0.25).check()
    assert outcome.within is within
    assert outcome.difference == pytest.approx(got - 1.0, nan_ok=True)


def test_a_case_that_raises_is_out_with_its_reason():
    outcome = failing().check()
    assert not outcome.within
    assert math.isnan(outcome.got)
    assert outcome.reason == "ArithmeticError: no such line"


def test_words_choose_by_title_and_name_in_any_case():
    assert [each.name for each in GOOD.having(["FLOAT"]).cases] == ["depth of the float"]
    assert [each.name for each in GOOD.having(["good", "len"]).cases] == ["length"]
    assert GOOD.having([]).cases == GOOD.cases
    assert not BAD.having(["good"]).cases


def test_a_table_gives_a_case_for_every_cell():
    figures = [
        CaseColumn("x", "m", 0.1, lambda answer: answer[0]),
        CaseColumn("T", "N", 0.02, lambda answer: answer[1], relative=True),
    ]
    rows = [
        ("slow", lambda: (1.0, 100.0), (1.05, 100.0)),
        ("fast", lambda: (2.0, 9.0), (2.0, 50.0)),
    ]
    cases = table(figures, rows, "Read off a plot.", Kind.PUBLISHED)
    assert [each.name for each in cases] == ["slow: x", "slow: T", "fast: x", "fast: T"]
    assert [each.tolerance for each in cases] == pytest.approx([0.1, 2.0, 0.1, 1.0])
    assert [each.check().within for each in cases] == [True, True, True, False]
    assert {each.why for each in cases} == {"Read off a plot."}
    assert {each.kind for each in cases} == {Kind.PUBLISHED}


def test_a_row_needs_a_figure_for_every_column():
    with pytest.raises(ValueError, match="shorter"):
        table(
            [CaseColumn("x", "m", 0.1, float), CaseColumn("y", "m", 0.1, float)],
            [("a", float, (1,))],
            "",
            Kind.PUBLISHED,
        )
