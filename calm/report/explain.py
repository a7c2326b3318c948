"""What causes a knockdown and what would change it, as a person reads it in a terminal."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from calm.quantities import QUANTITIES
from calm.report.terminal import plain_table, warning

if TYPE_CHECKING:
    from calm.case.explain import Explanation
    from calm.case.figures import Figures

SMALLEST_SHARE = 0.005
"""Of every whole; drags that cause less of all of them are summed up in one row."""

_SHARES = (
    "Shares: all drags grow together from nothing to what they are, and at every stage each is "
    "charged with what its own growth adds. Drag: the horizontal force of the water."
)
_CHANGES = (
    "Buoyancy: of everything buoyant in the line. Drag: of everything. Lengths stay as they are."
)


@dataclass(frozen=True)
class _Column:
    """A figure to show: its name in `Figures`, how it is headed, its quantity and unit."""

    name: str
    heading: str
    quantity: str
    unit: str
    scale: float = 1.0


_COLUMNS = {
    column.name: column
    for column in (
        _Column("knockdown", "knock-\ndown", "knockdown", "m"),
        _Column("excursion", "excur-\nsion", "offset", "m"),
        _Column("used_buoyancy", "buoyancy\nused", "used_buoyancy", "%", 100.0),
        _Column("tension", "anchor\npull", "tension", "N"),
        _Column("vertical", "\nup", "vertical", "N"),
        _Column("horizontal", "\nsideways", "horizontal", "N"),
        _Column("required_weight", "weight\nneeded", "required_weight", "N"),
    )
}
_ANCHOR = ("tension", "vertical", "horizontal", "required_weight")


def explanation_table(explanation: Explanation) -> RenderableType:
    """The shares of the drags and what a change would do, for a rich console.

    Drags that cause next to nothing share a row; a JSON document has each of them. It fits 80
    columns.
    """
    wholes = [
        f"{name} {_figure(_COLUMNS[name], explanation.figures)} m"
        for name in explanation.quantities
        if name != "used_buoyancy"
    ]
    parts: list[RenderableType] = [
        Text(f"What makes the {' and '.join(wholes)} of {explanation.label}", style="bold"),
        Text(),
        *(Text(note) for note in explanation.notes),
    ]
    if explanation.causes is not None and len(explanation.causes):
        parts += [Text()] * bool(explanation.notes) + [_causes(explanation), Text()]
    parts += [_changes(explanation), Text()]
    failures = [change for change in explanation.changes if change.failure is not None]
    parts += [warning(f"{change.name}: {change.failure}") for change in failures]
    told = f"{_SHARES}\n{_CHANGES}" if explanation.causes is not None else _CHANGES
    return Group(*parts, Text(told, style="dim"))


def _causes(explanation: Explanation) -> Table:
    causes = explanation.causes
    assert causes is not None
    columns = [_COLUMNS[name] for name in explanation.quantities]
    wholes = [getattr(explanation.figures, column.name) for column in columns]
    start = [explanation.without_drag[column.name] for column in columns]
    rows = [
        (row.label, row.drag, [getattr(row, column.name) for column in columns]) for row in causes
    ]
    largest = sorted(rows, key=lambda row: -abs(row[2][0]))
    told = [row for row in largest if _matters(row[2], wholes)]
    rest = [row for row in largest if not _matters(row[2], wholes)]
    table = _table()
    table.add_column("drag\nN", justify="right")
    for column in columns:
        table.add_column(f"{column.heading}\n{column.unit}", justify="right")
        if column.unit != "%":
            table.add_column("\n\n%", justify="right")
    if any(start):
        table.add_row("without drag", "", *_cells(columns, start, wholes))
    for label, drag, shares in told:
        table.add_row(label, f"{drag:.0f}", *_cells(columns, shares, wholes))
    if rest:
        sums = [sum(row[2][i] for row in rest) for i in range(len(columns))]
        name = rest[0][0] if len(rest) == 1 else f"{len(rest)} others"
        table.add_row(name, "", *_cells(columns, sums, wholes))
    table.add_row("all", "", *_cells(columns, wholes, wholes), style="bold")
    return table


def _matters(shares: list[float], wholes: list[float]) -> bool:
    pairs = zip(shares, wholes, strict=True)
    return any(abs(share) >= SMALLEST_SHARE * abs(whole) for share, whole in pairs)


def _cells(columns: list[_Column], shares: list[float], wholes: list[float]) -> list[str]:
    cells = []
    for column, share, whole in zip(columns, shares, wholes, strict=True):
        cells.append(f"{share * column.scale:z.{_decimals(column, whole)}f}")
        if column.unit != "%":
            cells.append(f"{100.0 * share / whole:z.1f}" if whole else "-")
    return cells


def _changes(explanation: Explanation) -> Table:
    columns = [_COLUMNS[name] for name in (*explanation.quantities, *_ANCHOR)]
    table = _table()
    for column in columns:
        table.add_column(f"{column.heading}\n{column.unit}", justify="right")
    now = explanation.figures
    table.add_row("as it is", *(_figure(column, now) for column in columns), style="bold")
    for change in explanation.changes:
        if change.figures is None:
            assert change.failure is not None
            table.add_row(change.name, change.failure.status)
        else:
            table.add_row(change.name, *(_growth(c, now, change.figures) for c in columns))
    return table


def _figure(column: _Column, figures: Figures) -> str:
    value = getattr(figures, column.name)
    return f"{value * column.scale:z.{_decimals(column, value)}f}"


def _growth(column: _Column, now: Figures, then: Figures) -> str:
    before, after = getattr(now, column.name), getattr(then, column.name)
    if after is None:
        return "-"
    growth = f"{(after - before) * column.scale:+z.{_decimals(column, before)}f}"
    return growth if growth.strip("+0.") else growth.removeprefix("+")


def _decimals(column: _Column, whole: float) -> int:
    """Those of the quantity, more where three digits of the whole need them."""
    usual = QUANTITIES[column.quantity].decimals if column.scale == 1.0 else 1
    if whole == 0.0:
        return usual
    return max(usual, min(2 - floor(log10(abs(whole * column.scale))), 4))


def _table() -> Table:
    table = plain_table()
    table.add_column(overflow="fold")
    return table
