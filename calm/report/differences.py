"""What changed between two designs, and what it does: for a terminal and for the report."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.quantities import QUANTITIES, Quantity
from calm.report.blocks import Block, Cell, Column, Prose, ReportPart, Table
from calm.report.check_summary import SIGNS

if TYPE_CHECKING:
    from calm.checks.comparison import Compared, Comparison
    from calm.files.file_differences import Change


def comparison_part(comparison: Comparison) -> ReportPart:
    """The differences, then the figures side by side."""
    before, after = comparison.names
    return ReportPart(f"{before} → {after}", tuple(_blocks(comparison)))


def _blocks(comparison: Comparison) -> Iterator[Block]:
    found, (before, after) = comparison.differences, comparison.names
    if not found.any:
        yield Prose(("Nothing differs.",))
    else:
        rows = [
            *(_row("changed", one) for one in found.changed),
            *(_row("moved", one) for one in found.moved),
            *((Cell("removed"), Cell(label), Cell(), Cell()) for label in found.removed),
            *((Cell("added"), Cell(label), Cell(), Cell()) for label in found.added),
        ]
        columns = (Column("", share=0.0), Column("what"), Column(before), Column(after))
        yield Table("What differs", columns, tuple(rows))
    if comparison.notes:
        yield Prose(comparison.notes, State.FAIL)
    whole = [one for one in comparison.figures if not one.of_a_part and one.states is None]
    yield _figures("What it does", comparison.names, whole, all_rows=True)
    parts = [one for one in comparison.figures if one.of_a_part]
    yield _figures("Pieces and instruments", comparison.names, parts)
    margins = [one for one in comparison.figures if one.states is not None]
    yield _figures("Margins of the design check", comparison.names, margins, all_rows=True)


def _row(kind: str, change: Change) -> tuple[Cell, ...]:
    return Cell(kind), Cell(change.where), Cell(change.before.text), Cell(change.after.text)


def _figures(
    title: str, names: tuple[str, str], figures: Sequence[Compared], *, all_rows: bool = False
) -> Table:
    """Figures side by side; of those that are not shown, how many stay as they are."""
    rows = [_figure(one) for one in figures]
    shown = [row for row in rows if all_rows or row[2].text != row[3].text]
    same = len(rows) - len(shown)
    columns = (
        Column(""),
        Column("", share=0.0),
        *(Column(name, numeric=True, short=_SHORT[n]) for n, name in enumerate(names)),
        Column("change", numeric=True),
    )
    return Table(
        title, columns, tuple(shown), f"The other {same} stay as they are." if same else ""
    )


_SHORT = "before", "after"


def _figure(one: Compared) -> tuple[Cell, ...]:
    quantity = QUANTITIES.get(one.quantity)
    states, both = one.states or (None, None), (one.before, one.after)
    texts = [_text(value, quantity, state) for value, state in zip(both, states, strict=True)]
    values = [
        Cell(text, state=state, mark="" if state is None or value is None else SIGNS[state])
        for text, value, state in zip(texts, both, states, strict=True)
    ]
    change = ""
    if isinstance(one.before, float) and isinstance(one.after, float) and texts[0] != texts[1]:
        assert quantity is not None
        text = quantity.format(one.after - one.before)
        change = text if text.startswith("-") else f"+{text}"
    unit = quantity.display_unit if quantity else ""
    return Cell(one.title), Cell(unit), *values, Cell(change)


def _text(value: float | str | None, quantity: Quantity | None, state: State | None) -> str:
    """A figure; of a margin that is not known, how its rule judges."""
    if isinstance(value, str):
        return value
    if value is None or quantity is None:
        return "-" if state is None else state.value
    return quantity.format(value)
