"""A tow solved many times, as a table for a terminal."""

from __future__ import annotations

from dataclasses import replace
from math import floor, log10

from rich.console import Group, RenderableType
from rich.text import Text

from calm.errors import NoEquilibrium
from calm.quantities import QUANTITIES, Quantity
from calm.report.tabulation import FIGURES, Tabulation, TabulationRow
from calm.report.terminal import WARNED, plain_table, warning

_HEADINGS = {"body_tension": "tension\nat body"}
_NOTE = "Depth and layback: of the body. Tension and angle: at the tow point, from the horizontal."
_DIGITS = 4
_WARNED = "!: with warnings, told by --json."


def tabulation_table(tabulation: Tabulation) -> RenderableType:
    """A line for each row, for a rich console; it fits 80 columns.

    A row without equilibrium shows its status, one with warnings of its own a mark; warnings that
    all rows share stand below.
    """
    figures = [name for name in FIGURES if name != "frequency" or tabulation.strumming]
    table = plain_table()
    for heading in tabulation.headings:
        table.add_column(heading, justify="right", no_wrap=True)
    for name in figures:
        quantity = QUANTITIES[name]
        heading = f"{_HEADINGS.get(name, quantity.heading)}\n{quantity.display_unit}"
        table.add_column(heading, justify="right", no_wrap=True, vertical="bottom")
    table.add_column("", no_wrap=True)
    quantities = [_fine(name, tabulation) for name in figures]
    remarks = [_remark(tabulation, row) for row in tabulation.rows]
    for row, remark in zip(tabulation.rows, remarks, strict=True):
        values = row.figures
        cells = (quantity.format(values[quantity.name]) for quantity in quantities)
        table.add_row(*row.shown, *cells, Text(remark, style=WARNED))
    note = f"{_NOTE} {_WARNED}" if "!" in remarks else _NOTE
    return Group(
        Text(tabulation.title, style="bold"),
        Text(),
        table,
        Text(),
        *(warning(text) for text in tabulation.warnings),
        Text(note, style="dim"),
    )


def _fine(name: str, tabulation: Tabulation) -> Quantity:
    """The quantity with `_DIGITS` digits at least: rows differ little, and a tow may be small."""
    quantity = QUANTITIES[name]
    greatest = max((abs(row.figures[name] or 0.0) for row in tabulation.rows), default=0.0)
    if greatest == 0.0:
        return quantity
    decimals = _DIGITS - 1 - floor(log10(greatest * quantity.scale))
    return replace(quantity, decimals=max(quantity.decimals, decimals))


def _remark(tabulation: Tabulation, row: TabulationRow) -> str:
    if isinstance(row.outcome, NoEquilibrium):
        return row.outcome.status
    return "!" if set(row.outcome.warnings) - set(tabulation.warnings) else ""
