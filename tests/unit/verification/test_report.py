from __future__ import annotations

import io

import pytest
from rich.console import Console

from calm.report.terminal import shown
from calm.report.verification import figures, verification_document, verification_part
from calm.verification import Kind, Source
from tests.unit.verification.fakes import BAD, GOOD, case, failing


def findings(*sources):
    return [(source, [each.check() for each in source.cases]) for source in sources]


def printed(part) -> str:
    text = io.StringIO()
    Console(file=text, width=100).print(shown(part))
    return text.getvalue()


@pytest.mark.parametrize(
    ("expected", "got", "tolerance", "shown"),
    [
        (131.4256, 131.425623, 1e-4, ("131.4256", "131.42562", "2e-05", "0.0001")),
        (812.8, 814.404463, 16.256, ("812.8", "814.4", "1.6", "16")),
        (0.0, 4.4e-15, 1e-8, ("0", "0", "0", "1e-08")),
        (2.0, 1.998340462, 0.05, ("2", "1.998", "-0.002", "0.05")),
        (1350.0, 1200.0, 200.0, ("1350", "1200", "-150", "2e+02")),
    ],
)
def test_digits_end_one_or_two_beyond_the_tolerance(expected, got, tolerance, shown):
    _, *texts, unit = figures(case("x", expected, got, tolerance, "m").check())
    assert tuple(texts) == shown
    assert unit == "m"


def test_a_figure_that_was_not_got_is_a_dash():
    assert figures(failing().check())[2:4] == ("-", "-")


def test_the_document_has_every_case():
    document = verification_document(findings(GOOD, BAD))
    assert (document["checked"], document["out"]) == (5, 2)
    first, out, raised = (document["cases"][i] for i in (0, 2, 3))
    assert first == {
        "source": "Good book", "name": "length", "kind": "published", "expected": 1.0, "got": 1.0,
        "difference": 0.0,
        "tolerance": 1e-3, "unit": "m", "why": "Printed so.", "within": True, "reason": None,
    }  # fmt: skip
    assert (out["got"], out["within"]) == (1.25, False)
    assert raised["reason"] == "ArithmeticError: no such line"


def test_the_table_marks_what_is_out():
    text = printed(verification_part(findings(GOOD, BAD)))
    assert "! length" in text
    assert "! tension: ArithmeticError: no such line" in text
    assert text.count("!") == 3
    assert "Checked 5 figures of 2 sources: 2 out of tolerance\n5 published" in text
    assert "all within tolerance" in printed(verification_part(findings(GOOD)))


def test_totals_by_kind_leave_out_what_is_met_by_construction():
    source = Source("A curve", "Drawn.", tuple(
        case(f"{kind} {number}", kind=kind)
        for kind, wanted in ((Kind.BY_CONSTRUCTION, 3), (Kind.PROPERTY, 2), (Kind.PUBLISHED, 1))
        for number in range(wanted)
    ))  # fmt: skip
    text = printed(verification_part(findings(source)))
    assert text.index("\nPublished") < text.index("\nProperty") < text.index("\nBy construction")
    assert text.rstrip().endswith(
        "Checked 3 figures of 1 source: all within tolerance\n"
        "1 published; 2 property\n"
        "Not counted: 3 figures that are met by construction"
    )
    document = verification_document(findings(source))
    assert (document["checked"], document["out"]) == (3, 0)
    assert document["kinds"] == {"published": 1, "property": 2, "by construction": 3}
    assert document["cases"][0]["kind"] == "by construction"
