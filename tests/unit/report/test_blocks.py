"""Tables made of items and of fields, each a head with what it shows."""

from __future__ import annotations

from calm.checks.finding import State
from calm.report.blocks import Cell, Column, table_of


def test_row_for_each_item_and_the_totals_last() -> None:
    table = table_of(
        "Numbers",
        [1, 2],
        (Column("number", numeric=True), str),
        (Column("state"), lambda one: Cell("odd", state=State.WARN) if one % 2 else ""),
        note="All of them.",
        sums=[3],
        by_hand=True,
    )
    assert [column.heading for column in table.columns] == ["number", "state"]
    odd = Cell("odd", state=State.WARN)
    assert table.rows == ((Cell("1"), odd), (Cell("2"), Cell("")), (Cell("3"), odd))
    assert (table.totals, table.note, table.by_hand, table.sortable) == (
        1,
        "All of them.",
        True,
        False,
    )
