import csv
import io
import math

import pytest

from calm.checks.finding import State, governing_of_each_rule
from calm.report.check_files import CHECKS_HEADER, INVENTORY_HEADER, checks_csv, inventory_csv
from tests.judged import FORMULA, LINES, LONG, RIGHT_TO_LEFT, SCRIPT, judged, judged_hostile


@pytest.fixture(scope="module")
def assessment():
    return judged(LINES / "tidal-adcp.yaml", "ebb")


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_a_row_for_every_finding(assessment):
    rows = rows_of(checks_csv([assessment], every=True))
    findings = list(assessment.every_finding())
    assert len(rows) == len(findings)
    assert tuple(rows[0]) == CHECKS_HEADER
    for row, finding in zip(rows, findings, strict=True):
        assert (row["rule"], row["state"]) == (finding.rule, finding.state.value)
        assert row["value"] == ("" if finding.value is None else f"{finding.value:.12g}")
        assert row["sense"] == (finding.sense or "") and row["case"] == (finding.case or "")


def test_rows_are_what_governs_and_what_does_not_pass(assessment):
    rows = rows_of(checks_csv([assessment]))
    assert len(rows) < len(list(assessment.every_finding()))
    for lead in governing_of_each_rule(assessment.every_finding()):
        (row,) = [one for one in rows if one["rule"] == lead.rule and one["governing"] == "yes"]
        assert row["component"] == (lead.component or "") and row["case"] == (lead.case or "")
    states = {(one.rule, one.component, one.state) for one in assessment.every_finding()
              if one.state not in (State.PASS, State.NOT_JUDGED)}  # fmt: skip
    assert states <= {(row["rule"], row["component"] or None, row["state"]) for row in rows}


def test_a_cluster_that_fails_is_one_row(tmp_path):
    path = tmp_path / "cluster.yaml"
    text = (LINES / "upward-adcp-300m.yaml").read_text(encoding="utf-8")
    glass = "{use: glass-17in, count: 12, label: back-up glass, depth_rating: 1000 m}"
    text = text.replace("{use: glass-cluster-4, count: 3, label: back-up glass}", glass)
    path.write_text(text, encoding="utf-8")
    assessment = judged(path)
    failed = [one for one in assessment.all_findings()
              if one.rule == "depth-rating" and one.state is State.FAIL
              and (one.component or "").startswith("back-up glass")]  # fmt: skip
    assert len(failed) == 12
    rows = [
        row
        for row in rows_of(checks_csv([assessment]))
        if row["rule"] == "depth-rating" and row["component"].startswith("back-up glass")
    ]
    assert len(rows) == 1


def test_values_have_their_unit(assessment):
    units = {row["rule"]: row["unit"] for row in rows_of(checks_csv([assessment]))}
    assert units["tilt"] == "deg"
    assert units["strength"] == "N"


def test_a_row_for_every_piece_and_clamp(assessment):
    rows = rows_of(inventory_csv([assessment]))
    assert tuple(rows[0]) == INVENTORY_HEADER
    assert [row["label"] for row in rows] == [item.label for item in assessment.inventory]
    anchor = rows[-1]
    assert anchor["role"] == "anchor"
    assert float(anchor["wet_weight[N]"]) == pytest.approx(
        assessment.inventory[-1].wet_weight, rel=1e-11
    )


def test_negative_numbers_stay_numbers(assessment):
    weights = [float(row["wet_weight[N]"]) for row in rows_of(inventory_csv([assessment]))]
    assert min(weights) < 0.0
    assert all(map(math.isfinite, weights))


def test_no_text_is_a_formula(tmp_path):
    assessment = judged_hostile(tmp_path)
    rows = [row for text in (checks_csv([assessment]), inventory_csv([assessment]))
            for row in rows_of(text)]  # fmt: skip
    texts = {cell for row in rows for cell in row.values()}
    for cell in texts:
        if cell.startswith(("=", "+", "-", "@", "\t", "\r")):
            float(cell)
    assert f"'{FORMULA}" in texts
    assert f"'{FORMULA} 4" in texts
    assert {SCRIPT, LONG, RIGHT_TO_LEFT} <= texts
