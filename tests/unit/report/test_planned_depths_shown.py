"""The planned depth beside the computed one: tables, JSON, CSV, the sheets of the deck."""

import csv
import io
import json

import pytest
from rich.console import Console

import calm
from calm.deck import deck_of
from calm.report.deck_files import deck_csvs
from calm.report.deck_lists import instruments_part
from calm.report.deck_logs import deployment_part
from calm.report.diagram import PageSize, diagram_pages
from calm.report.result_files import to_csv
from calm.report.sheet import result_part
from calm.report.terminal import shown
from calm.shipped import shipped_folder

PLANNED = {"meter 150 m": 150.0, "CTD 150 m": 150.0, "CTD 250 m": 250.0, "meter 350 m": 350.0,
           "meter 700 m": 700.0}  # fmt: skip


@pytest.fixture(scope="module")
def design():
    return calm.load(shipped_folder("lines") / "veering-current.yaml")


def _text(part, width):
    stream = io.StringIO()
    Console(file=stream, width=width).print(shown(part))
    return stream.getvalue()


def test_the_table_has_it_within_80_columns(design):
    text = _text(result_part(design.solve()), 80)
    assert max(len(line.rstrip()) for line in text.splitlines()) <= 80
    assert "length depth planned seabed" in text
    (row,) = [line.split() for line in text.splitlines() if line.startswith("meter 350 m")]
    assert row[3:6] == ["0.55", "345.7", "350.0"]


def test_a_line_without_plans_has_no_such_column():
    cdms = calm.load(shipped_folder("lines") / "cdms-1.yaml")
    assert "planned" not in _text(result_part(cdms.solve()), 80)


def test_json_and_csv_have_it_for_every_row(design):
    result = design.solve()
    data = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    rows = [*data["components"], *data["clamps"]]
    assert all("planned_depth" in row for row in rows)
    assert {row["label"]: row["planned_depth"] for row in rows if row["planned_depth"]} == PLANNED
    listed = csv.DictReader(io.StringIO(to_csv([result])))
    told = {row["label"]: row["planned_depth[m]"] for row in listed}
    assert {label: float(depth) for label, depth in told.items() if depth} == PLANNED


def test_the_deck_has_it_beside_the_depth(design):
    deck = deck_of([design])
    for part in (deployment_part(deck), instruments_part(deck)):
        text = _text(part, 200)
        assert "planned" in text and "350.0" in text
    for name in ("deployment.csv", "instruments.csv"):
        rows = csv.DictReader(io.StringIO(deck_csvs(deck)[name]))
        told = {row["label"]: row["planned_depth[m]"] for row in rows}
        assert {label: float(depth) for label, depth in told.items() if depth} == PLANNED
    pages = "".join(diagram_pages(deck, PageSize.A4))
    assert ">planned<" in pages and ">350.0<" in pages
