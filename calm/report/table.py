"""The table of a line as a technician reads it in a terminal, in the order of the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from calm.quantities import QUANTITIES
from calm.report.limits import Mark
from calm.report.rows import Phrase, Sheet
from calm.report.sheet import sheet
from calm.report.terminal import WARNED, plain_table, warning

if TYPE_CHECKING:
    from calm.case import Result, TowResult

# Headings cut so that the whole table fits 80 columns.
_HEADINGS = {
    "height": ("above", "seabed"),
    "knockdown": ("knock-", "down"),
    "safety_factor": ("safety", "factor"),
}
_MARKED = ("tilt", "safety_factor")
_STYLES = {Mark.NONE: "", Mark.NEAR: "yellow", Mark.BEYOND: WARNED}


def result_table(result: Result | TowResult) -> RenderableType:
    """Everything a result says, for a rich console.

    A figure beyond its limit carries ``!`` and one near it ``~``, so that nothing hangs on colour.

    Parameters
    ----------
    result : Result or TowResult
        A solved mooring or tow.

    Returns
    -------
    RenderableType
        Title, a row for each component with its clamped instruments below it, the two ends of the
        line, the warnings, and how the solution was reached. It fits 80 columns; long labels wrap.
    """
    said = sheet(result)
    return Group(
        Text(said.title, style="bold"),
        Text(),
        _components(said),
        Text(),
        *map(_sentence, said.summary),
        *(warning(text) for text in said.warnings),
        Text(),
        Text(f"{said.note}\n{said.convergence}", style="dim"),
    )


def _components(said: Sheet) -> Table:
    table = plain_table(gap=1)
    table.add_column(overflow="fold")
    for name in said.columns:
        quantity = QUANTITIES[name]
        lines = (*_HEADINGS.get(name, (quantity.heading,)), quantity.display_unit)
        heading = "\n".join(line + _margin(name) for line in lines)
        table.add_column(heading, justify="right", no_wrap=True)
    for row in said.rows:
        label = Text(
            f"  {row.label}" if row.clamped else row.label,
            style="bold" if row.instrument else "",
        )
        cells = (
            Text(f"{cell.text}{cell.mark or _margin(name)}", style=_STYLES[cell.mark])
            for name, cell in zip(said.columns, row.cells, strict=True)
        )
        table.add_row(label, *cells)
    return table


def _margin(name: str) -> str:
    """Room behind the digits of a column that may carry marks, so that the digits stay aligned."""
    return " " if name in _MARKED else ""


def _sentence(phrase: Phrase) -> Text:
    return Text(f"{phrase.text} {phrase.mark}".rstrip(), style=_STYLES[phrase.mark])
