import csv
import io
import math

import pytest

from calm.report.check_files import CHECKS_HEADER, INVENTORY_HEADER, checks_csv, inventory_csv
from tests.judged import FORMULA, LINES, LONG, RIGHT_TO_LEFT, SCRIPT, judged, judged_hostile


@pytest.fixture(scope="module")
def assessment():
    return judged(LINES / "tidal-adcp.yaml", "ebb")


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_a_row_for_every_finding(assessment):
    rows = rows_of(checks_csv([assessment]))
    findings = list(assessment.all_findings())
    assert len(rows) == len(findings)
    assert tuple(rows[0]) == CHECKS_HEADER
    for row, finding in zip(rows, findings, strict=True):
        assert (row["rule"], row["state"]) == (finding.rule, finding.state.value)
        assert row["value"] == ("" if finding.value is None else f"{finding.value:.12g}")


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
