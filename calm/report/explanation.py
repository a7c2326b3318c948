"""What causes a knockdown and what would change it, as a person reads it."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.quantities import QUANTITIES
from calm.report.blocks import Block, Cell, Column, Prose, ReportPart, Span, Table

if TYPE_CHECKING:
    from calm.case.explain import Causes, Explanation
    from calm.case.targets import Figures

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


def explanation_part(explanation: Explanation) -> ReportPart:
    """The shares of the drags and what a change would do.

    Drags that cause next to nothing share a row; a JSON document has each of them. It fits 80
    columns.
    """
    wholes = [
        f"{name} {_figure(_COLUMNS[name], explanation.figures)} m"
        for name in explanation.quantities
        if name != "used_buoyancy"
    ]
    title = f"What makes the {' and '.join(wholes)} of {explanation.label}"
    blocks: list[Block] = [Prose(explanation.notes)] if explanation.notes else []
    if explanation.causes is not None and len(explanation.causes):
        blocks.append(_causes(explanation, explanation.causes))
    blocks.append(_changes(explanation))
    failures = [change for change in explanation.changes if change.failure is not None]
    if failures:
        told = tuple(f"{change.name}: {change.failure}" for change in failures)
        blocks.append(Prose(told, State.WARN))
    lines = (_SHARES, _CHANGES) if explanation.causes is not None else (_CHANGES,)
    return ReportPart(title, (*blocks, Prose(tuple((Span(line, quiet=True),) for line in lines))))


def _causes(explanation: Explanation, causes: Causes) -> Table:
    columns = [_COLUMNS[name] for name in explanation.quantities]
    wholes = [getattr(explanation.figures, column.name) for column in columns]
    start = [explanation.without_drag[column.name] for column in columns]
    rows = [
        (row.label, row.drag, [getattr(row, column.name) for column in columns]) for row in causes
    ]
    largest = sorted(rows, key=lambda row: -abs(row[2][0]))
    told = [row for row in largest if _matters(row[2], wholes)]
    rest = [row for row in largest if not _matters(row[2], wholes)]
    heads = [Column(""), Column("drag", "N", numeric=True)]
    for column in columns:
        heads.append(Column(column.heading, column.unit, numeric=True))
        if column.unit != "%":
            heads.append(Column("\n", "%", numeric=True))
    lines = [("without drag", "", start)] if any(start) else []
    lines += [(label, f"{drag:.0f}", shares) for label, drag, shares in told]
    if rest:
        sums = [sum(row[2][i] for row in rest) for i in range(len(columns))]
        lines.append((rest[0][0] if len(rest) == 1 else f"{len(rest)} others", "", sums))
    lines.append(("all", "", wholes))
    cells = tuple(
        (Cell(label), Cell(drag), *map(Cell, _cells(columns, shares, wholes)))
        for label, drag, shares in lines
    )
    return Table("", tuple(heads), cells, totals=1)


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
    heads = (Column(""), *(Column(each.heading, each.unit, numeric=True) for each in columns))
    now = explanation.figures
    as_it_is = (Cell(_figure(column, now), strong=True) for column in columns)
    rows = [(Cell("as it is", strong=True), *as_it_is)]
    for change in explanation.changes:
        if change.figures is None:
            assert change.failure is not None
            nothing = (Cell() for _ in columns[1:])
            rows.append((Cell(change.name), Cell(change.failure.status), *nothing))
        else:
            growths = (_growth(each, now, change.figures) for each in columns)
            rows.append((Cell(change.name), *map(Cell, growths)))
    return Table("", heads, tuple(rows))


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
    """Return those of the quantity, more where three digits of the whole need them."""
    usual = QUANTITIES[column.quantity].decimals if column.scale == 1.0 else 1
    if whole == 0.0:
        return usual
    return max(usual, min(2 - floor(log10(abs(whole * column.scale))), 4))
