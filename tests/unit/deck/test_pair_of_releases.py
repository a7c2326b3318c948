"""The two releases of a pair in the logs, the lists and the inventory."""

import pytest

import calm
from calm.checks.design_check import check
from calm.deck import deck_of
from calm.drawing.schematic.deck_parts import parts_of_deck
from calm.report.check_tables import inventory_table
from calm.report.deck_lists import shipping_part
from calm.report.deck_logs import deployment_part, recovery_part

MOORING = """\
name: Pair
environment: {depth: 300 m, current: {speed: 0.25 m/s, toward: 90 deg}}
line:
  - {use: sphere-steel-1250, label: top}
  - {use: wire-jacketed-8, length: 200 m, label: wire}
  - {use: release-pair-ar861, label: releases}
  - {use: anchor-wheels-3, label: anchor}
releases:
  - {serial: 1729, codes: {enable: 0A51, release: 0A55}}
  - {serial: 1730, codes: {enable: 0B51, release: 0B55}}
"""


@pytest.fixture(scope="module")
def deck_with(tmp_path_factory):
    path = tmp_path_factory.mktemp("pair") / "m.yaml"

    def make(serials):
        text = MOORING.replace("label: releases}", f"label: releases{serials}}}")
        if not serials:
            text = text.partition("releases:\n")[0]
        path.write_text(text, encoding="utf-8")
        return deck_of([calm.load(path)])

    return make


def releases(part):
    (table,) = [block for block in part.blocks if getattr(block, "title", "") == "Releases"]
    return [(row[0].text, row[0].detail, row[1].text) for row in table.rows]


def test_each_release_has_a_row_with_its_codes(deck_with):
    deck = deck_with(", serial: [1729, 1730]")
    for part in (deployment_part(deck), recovery_part(deck)):
        assert releases(part) == [
            ("1729", "releases pair", "enable: 0A51\nrelease: 0A55"),
            ("1730", "releases pair", "enable: 0B51\nrelease: 0B55"),
        ]
    words = [part.rows[0].name for part in parts_of_deck(deck, deck.parts, surface=False)]
    told = next(one for one in words if "AR861" in one)
    assert "no. 1729, 1730" in told and "1730: enable: 0B51 · release: 0B55" in told


def test_without_numbers_each_release_has_a_row_to_fill_in(deck_with):
    assert releases(deployment_part(deck_with(""))) == [("", "releases pair", "")] * 2


def test_a_pair_is_one_piece_of_two_units(deck_with):
    deck = deck_with(", serial: [1729, 1730]")
    (shipped,) = [one for one in deck.shipped if one.use == "release-ar861-double"]
    assert (shipped.count, shipped.units, shipped.mass) == (1, 2, 60.0)
    (table,) = shipping_part(deck).blocks
    (packed,) = [row for row in table.rows if row[1].text == "release-ar861-double"]
    assert packed[0].text == "Paired Oceano AR861, 2 units each" and packed[2].text == "1"
    rows = inventory_table(check(deck.result.design).inventory).rows
    (row,) = [row for row in rows if row[1].text == "release-ar861-double"]
    assert row[0].text == packed[0].text and row[2].text == "1"
