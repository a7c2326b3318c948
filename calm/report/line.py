"""The table of a solved line, and which of its figures are marked: they pass a limit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from enum import StrEnum
from typing import TYPE_CHECKING

from calm.case import Result
from calm.case.columns import rows_down
from calm.checks.finding import State
from calm.checks.posture import meant_for_the_surface
from calm.checks.strength import safety_factor
from calm.quantities import QUANTITIES
from calm.report.blocks import Cell, Column, Table

if TYPE_CHECKING:
    from calm.case import TowResult
    from calm.case.columns import ClampRow, ComponentRow
    from calm.files import Component

# Headings cut so that the whole table fits 80 columns.
_SHORT = {
    "height": "above\nseabed",
    "knockdown": "knock-\ndown",
    "safety_factor": "safety\nfactor\n",
}
_MARKED = ("tilt", "safety_factor")


class Mark(StrEnum):
    """The sign after a figure: legible without colour."""

    NONE = ""
    NEAR = "~"
    BEYOND = "!"

    @property
    def state(self) -> State | None:
        """How it looks."""
        return _STATES[self]


_STATES = {Mark.NONE: None, Mark.NEAR: State.WARN, Mark.BEYOND: State.FAIL}


def line_table(
    result: Result | TowResult, names: tuple[str, ...], note: str, *, places: bool = False
) -> Table:
    """The line from its first-listed end, each clamped instrument indented below its piece.

    Parameters
    ----------
    names : of the quantities in each row
    note : how to read them
    places : whether a clamp says where on its piece it sits, in place of a length
    """
    columns = (
        Column("no.", numeric=True, narrow=False),
        Column("piece", short=""),
        *map(quantity_column, names),
    )
    return Table("", columns, tuple(_rows(result, names, places)), note, dense=True)


def quantity_column(name: str) -> Column:
    """The head of a column of a quantity in the unit that people read."""
    quantity = QUANTITIES[name]
    return Column(
        quantity.heading,
        quantity.display_unit,
        numeric=True,
        short=_SHORT.get(name),
        marked=name in _MARKED,
    )


def figure_cell(name: str, value: float | None, mark: Mark = Mark.NONE) -> Cell:
    """A value of a quantity under its `quantity_column`."""
    return Cell(QUANTITIES[name].format(value), state=mark.state, mark=mark)


def tilt_mark(component: Component, tilt: float) -> Mark:
    """Mark of a tilt [deg]: beyond `max_tilt` the component is not to be trusted."""
    if component.max_tilt is not None and tilt > component.max_tilt:
        return Mark.BEYOND
    if component.warn_tilt is not None and tilt > component.warn_tilt:
        return Mark.NEAR
    return Mark.NONE


def safety_mark(result: Result | TowResult, record: ComponentRow) -> Mark:
    """Mark of a safety factor: too small, or the piece bears more than its working load.

    The factor asked on the breaking load is the file's `checks.safety_factor`, for a surface
    mooring, for a synthetic cable, or for steel. What is not known, NaN, is not marked.
    """
    meant = isinstance(result, Result) and meant_for_the_surface(result)
    surface = meant or result.type == "surface"
    least = safety_factor(record.part.component, result.file.checks.safety_factor, surface)
    beyond = record.safety_factor < least or record.utilisation > 1.0
    return Mark.BEYOND if beyond else Mark.NONE


def _rows(
    result: Result | TowResult, names: tuple[str, ...], places: bool
) -> Iterator[tuple[Cell, ...]]:
    for number, (piece, clamps) in enumerate(rows_down(result)):
        where = _where(result, piece.depth_top, piece.x_top, piece.y_top)
        marks = {
            "tilt": tilt_mark(piece.part.component, piece.tilt),
            "safety_factor": safety_mark(result, piece),
        }
        label = Cell(piece.label, strong=piece.role == "instrument")
        yield Cell(str(number)), label, *_cells(names, piece, where, marks)
        for clamp in clamps:
            component = clamp.part.component
            where = _where(result, clamp.depth, clamp.x, clamp.y)
            marks = {"tilt": tilt_mark(component, clamp.tilt)}
            strong = component.role == "instrument"
            label = Cell(clamp.label, indented=True, strong=strong)
            cells = [*_cells(names, clamp, where, marks)]
            if places:
                cells[names.index("length")] = Cell(place_text(clamp.part.at))
            yield Cell(), label, *cells


def place_text(at: float) -> str:
    """Where a clamp sits, from the top of its piece [m], as it stands among lengths."""
    return f"at {QUANTITIES['at'].format(at)}"


def _where(result: Result | TowResult, depth: float, x: float, y: float) -> dict[str, float]:
    """Where a clamped instrument is, or the upper end of a piece."""
    bottom = result.file.environment.depth
    return {
        "depth": depth,
        "height": math.nan if bottom is None else bottom - depth,
        "offset": math.hypot(x, y),
        "layback": math.hypot(x, y),
    }


def _cells(
    names: tuple[str, ...],
    row: ComponentRow | ClampRow,
    where: dict[str, float],
    marks: dict[str, Mark],
) -> Iterator[Cell]:
    for name in names:
        value = where[name] if name in where else getattr(row, name, None)
        yield figure_cell(name, value, marks.get(name, Mark.NONE))
