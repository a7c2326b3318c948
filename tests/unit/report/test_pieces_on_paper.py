"""Figures of pieces in the report of a design check: each row is of one piece and one finding."""

import re

import pytest

import calm
from calm.checks.finding import State, governing
from calm.deck import deck_of
from calm.quantities import show_in
from calm.report.blocks import Beside, Table
from calm.report.check_matrix import mooring_page
from calm.report.check_pages import basis_page, checks_page, handling_page
from calm.report.check_report import signed_mooring
from calm.report.deck_lists import lifts_part
from calm.report.deck_logs import deployment_part, recovery_part
from calm.report.drawing_page import drawing_pages
from calm.report.line_page import line_page
from calm.report.load_cases import piece_loads
from calm.report.open_items import limit_text, percent_text, verdict_sentence
from calm.report.page_one import page_one
from calm.report.sheet import table_of_line
from tests.judged import judged

# the swivel governs the launch, although the releases below it bear the largest tension
_SLOPE = """
name: Slope 1200
description: Upward ADCP at 150 m, four CTDs, two current meters
position: {latitude: 60.2 deg, longitude: -8.5 deg}
document: {id: SL-01, revision: A, date: 2026-11-28, author: N. User, ship: RV Trial}

environment:
  depth: 1200 m
  density: 1028 kg/m^3
  current:
    columns: [depth m, speed m/s, toward deg]
    rows:
      - [0, 0.50, 90]
      - [1200, 0.10, 90]

line:
  - use: hydrofloat-40in
    label: top float 150 m
    clamps: [{use: adcp-sentinel-uwa, at: 0.1 m, label: ADCP, depth_rating: 500 m}]
  - {use: shackle-16}
  - {use: swivel-miller-c212, label: swivel}
  - {use: shackle-16}
  - use: wire-6x7-6
    length: 144 m
    label: wire 1
    clamps:
      - {use: sbe37, at: 48.5 m, label: CTD 200 m}
  - {use: glass-cluster-4, label: glass 300 m}
  - {use: rcm11, label: meter 300 m}
  - {use: shackle-13}
  - use: wire-6x7-6
    length: 594 m
    label: wire 2
    clamps:
      - {use: sbe37, at: 98.5 m, label: CTD 400 m}
      - {use: sbe37, at: 398 m, label: CTD 700 m}
  - {use: glass-cluster-4, label: glass 900 m}
  - {use: rcm11, label: meter 900 m}
  - {use: shackle-13}
  - use: wire-6x7-6
    length: fit
    top_depth: 150 m
    label: wire 3
    clamps:
      - {use: sbe37, at: 98.5 m, label: CTD 1000 m}
  - {use: glass-cluster-4, count: 3, label: back-up glass}
  - {use: swivel-miller-c212, label: lower swivel}
  - {use: release-pair-ar861, label: releases}
  - {use: chain-short-g30-13, length: 5 m, label: chain}
  - {use: shackle-16}
  - {use: anchor-wheels-3, label: anchor}

checks:
  maximum_knockdown: 20 m
  maximum_tilt: 15 deg
"""


@pytest.fixture(scope="module")
def signed(tmp_path_factory):
    path = tmp_path_factory.mktemp("signed") / "slope.yaml"
    path.write_text(_SLOPE, encoding="utf-8")
    return signed_mooring(judged(path))


def tables_of(blocks):
    for block in blocks:
        if isinstance(block, Beside):
            yield from tables_of((*block.left, *block.right))
        elif isinstance(block, Table):
            yield block


def table(blocks, title):
    (found,) = [one for one in tables_of(blocks) if one.title.startswith(title)]
    return found


def texts(row):
    return [cell.text for cell in row]


def found(signed, rule):
    return [one for one in signed.assessment.every_finding() if one.rule == rule]


def test_the_largest_tension_of_a_launch_stands_beside_the_limit_of_its_own_piece(signed):
    rows = [texts(row) for row in table(handling_page(signed), "Launch").rows]
    loads = {one.component: one for one in found(signed, "launch-strength")}
    most = max(loads.values(), key=lambda one: one.value)
    lead = governing(loads.values())
    assert most.component == "releases pair" and lead.component == "lower swivel"
    for head, one in (("Largest tension", most), ("Largest use", lead)):
        (row,) = [row for row in rows if row[0] == f"{head}, {one.component}"]
        assert row[1].replace("\u00a0", " ") == f"{one.value / 1000.0:.2f} kN"
        assert row[2] == f"{limit_text(one)}, {percent_text(one.utilisation)} %"


def test_each_row_of_the_checks_is_one_finding(signed):
    every = [*signed.assessment.every_finding()]
    shown = table(checks_page(signed), "Checks in full").rows
    for row in shown:
        (one, *_) = [each for each in every if _is_row(each, row)]
        assert row[0].state is one.state
    ratings = [row for row in shown if row[1].text == "Depth rating"]
    assert [row[0].state for row in ratings] == [State.PASS, State.ESTIMATED]
    assert ratings[0][5].text.startswith("ADCP") and "estimate" not in ratings[0][6].then
    assert ratings[1][5].text.startswith("top") and "estimate" in ratings[1][6].then


def _is_row(finding, row):
    where = finding.component or "whole line"
    where = f"{where}, {finding.case}" if finding.case else where
    used = percent_text(finding.utilisation)
    return (row[5].text, row[2].text, row[4].text) == (where, used, limit_text(finding) or "–")


def test_the_page_of_one_of_many_moorings_has_rows_of_one_finding_too(signed):
    rows = table(mooring_page(signed), "Checks").rows
    ratings = [row for row in rows if row[1].text == "Depth rating"]
    assert [row[0].state for row in ratings] == [State.PASS, State.ESTIMATED]


def test_hardware_of_a_type_is_shown_with_load_capacity_and_use_of_one_piece(signed):
    loads = {
        f"{one.number} {one.row.label}": one
        for one in piece_loads(signed.assessment, signed.moored)
    }
    rows = table(line_page(signed), "Connecting hardware").rows
    assert len(rows) == 4
    for row in map(texts, rows):
        stands, falls = loads[row[2]], loads[row[6]]
        assert row[3] == f"{stands.tension / 1000.0:.2f}"
        assert row[7] == f"{falls.launch_tension / 1000.0:.2f}"
        for cells, finding in ((row[4:6], stands.moored), (row[8:], falls.launch)):
            capacity = float(re.sub("[^0-9.]", "", cells[0]))
            assert capacity == pytest.approx(finding.limit / 1000.0, abs=0.005)
            assert cells[1] == percent_text(finding.utilisation)
    (swivels,) = [texts(row) for row in rows if "swivel" in row[0].text]
    assert "lower swivel" in swivels[6]


def test_equal_floats_share_a_row_of_their_extremes(signed):
    loads = piece_loads(signed.assessment, signed.moored)
    chains = [one for one in loads if "back-up glass chain" in one.row.label]
    rows = table(line_page(signed), "The line").rows
    (row,) = [texts(row) for row in rows if "back-up glass chain" in row[1].text]
    assert len(chains) == 3
    assert row[2] == f"{max(one.tension for one in chains) / 1000.0:.2f}"
    assert row[3] == f"{min(one.least for one in chains) / 1000.0:.2f}"
    assert row[4] == f"{max(one.tilt for one in chains):.1f}"
    assert row[8] == f"{max(one.launch_tension for one in chains) / 1000.0:.2f}"
    assert row[11] == f"{max(one.rise_tension for one in chains) / 1000.0:.2f}"


def test_planned_and_still_water_depths_have_a_column_each(signed):
    drawing = table(drawing_pages(signed), "Mooring drawing")
    heads = [column.heading for column in drawing.columns]
    assert heads[5:9] == ["Depth m\nplanned", "\nstill", "\ncase 1", "\ncase 1s"]
    rows = {row[2].text or row[2].detail: [cell.text or cell.detail for cell in row[5:9]]
            for row in drawing.rows}  # fmt: skip
    assert rows["meter 900 m"] == ["900.0", "898.3", "903.1", "906.2"]
    assert {row[0] for name, row in rows.items() if "shackle" in name} == {""}


def test_without_plans_there_is_no_such_column(tmp_path):
    path = tmp_path / "m.yaml"
    text = re.sub(r"label: (CTD|meter|glass|top float) \d+ m", r"label: \1", _SLOPE)
    path.write_text(text.replace("top_depth: 150 m", "top_depth: 151 m"), encoding="utf-8")
    drawing = table(drawing_pages(signed_mooring(judged(path))), "Mooring drawing")
    assert [column.heading for column in drawing.columns][5:7] == ["Depth m\nstill", "\ncase 1"]


def test_what_governs_or_is_open_is_drawn_and_marked_in_a_row_of_its_own(signed):
    drawing = table(drawing_pages(signed), "Mooring drawing")
    rows = {cell.text: (number.text, cell.detail) for _, number, cell, *_ in drawing.rows}
    assert rows["lower swivel"] == ("27", "Miller swivel C212")
    number, words = rows["back-up glass chain 1–3"]
    assert number == "19–25" and "swivel" not in words and "with 4 × 13 mm shackle" in words
    labels = re.findall(r">([^<>]+)</text>", mooring_picture(signed))
    assert "lower swivel ≈1" in labels and "back-up glass chain 1–3" in labels


def mooring_picture(signed):
    beside = next(block for block in page_one(signed) if isinstance(block, Beside))
    return beside.left[0].svg


def test_pieces_have_one_number_in_every_document(signed):
    deck = deck_of([calm.load(signed.assessment.file.path)])
    numbers = deck.numbers
    assert numbers["top float 150 m"] == "1" and numbers["CTD 700 m"] == "11b"
    assert numbers["lower swivel"] == "27" and numbers["anchor"] == "36"
    shown = {}
    for part in (deployment_part(deck), lifts_part(deck), recovery_part(deck)):
        for one in tables_of(part.blocks):
            if one.columns[0].heading == "no.":
                for row in one.rows:
                    shown.setdefault(row[1].text, set()).add(row[0].text)
    for row in table_of_line(deck.result).rows:
        shown.setdefault(row[1].text, set()).add(row[0].text)
    for label in ("top float 150 m", "wire 2", "meter 900 m", "releases pair", "CTD 700 m"):
        first = {re.split("[–,]", one)[0] for one in shown[label]}
        assert first == {numbers[label]}, label
    inventory = table(handling_page(signed), "Inventory")
    items = {row[2].detail: row[6].detail for row in inventory.rows if row[2] is not None}
    assert items["swivel-miller-c212"] == "3, 27" and items["sbe37"] == "5a, 11a–11b, 17a"
    assert items["glass-17in"].startswith("7a–7d, 13a–13d")


def test_depths_stand_under_the_unit_chosen(signed):
    show_in({"length": "ft"})
    try:
        top = signed.moored[0].depth
        cases = table(page_one(signed), "Load cases")
        assert cases.columns[2].heading == "Top depth\nft"
        assert cases.rows[0][2].text == f"{top / 0.3048:.0f}"
        drawing = table(drawing_pages(signed), "Mooring drawing")
        assert drawing.columns[5].heading == "Depth ft\nplanned"
        inventory = table(handling_page(signed), "Inventory")
        assert inventory.columns[3].heading == "Cut length\nft"
    finally:
        show_in({})


def test_shares_among_the_limits_are_in_percent(signed):
    limits = table(basis_page(signed), "Limits used")
    values = {row[0].text: row[1].text.replace("\u00a0", " ") for row in limits.rows}
    assert values["Planned depth limit"] == values["Backup margin"] == "10 %"
    assert values["Anchor friction"] == "0.6"


def test_low_and_high_water_are_stated_with_the_environment(signed, tmp_path):
    assert "Water depth at" not in table(basis_page(signed), "Environment").note
    path = tmp_path / "tidal.yaml"
    tidal = _SLOPE.replace(
        "  depth: 1200 m\n", "  depth: 1200 m\n  depth_range: [1196 m, 1204 m]\n"
    )
    path.write_text(tidal, encoding="utf-8")
    note = table(basis_page(signed_mooring(judged(path))), "Environment").note
    assert "Water depth at low and high water 1196.0 m to 1204.0 m. Density" in note


def test_the_counts_of_findings_name_the_open_items_of_page_one(signed):
    note = table(checks_page(signed), "Checks in full").note
    assert ", 51 not judged, " in note
    assert "Open items: 4 estimated, 2 not judged. " in note
    told = verdict_sentence(signed.assessment)
    assert "four estimated" in told and "two checks" in told


def test_the_title_has_the_description_and_the_ship_below(signed):
    block = next(page_one(signed))
    assert block.below == ("Upward ADCP at 150 m, four CTDs, two current meters", "RV Trial")
