"""Columns of quantities by their names, each value in SI, and the depths that they stand at."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from calm.errors import Problem, about_quantity, shown, unknown
from calm.physics.line import Booleans, Floats, Integers
from calm.records.current_terms import DEEPEST, too_deep
from calm.records.delimited import is_gap, plain_numbers
from calm.records.headings import column_unit, heading
from calm.units import QuantityError, QuantityRange, unit_factor

Report = Callable[[Sequence[str | int], str], Problem]
"""Makes a problem of a message, at ``("columns", j)`` or ``("rows", i, j)``."""


@dataclass(frozen=True)
class QuantityTable:
    """Hold a table of quantities as text, and where its mistakes go.

    Attributes
    ----------
    columns : names with their unit, ``"depth m"`` or ``"depth[m]"``; without, each value has its
        own
    rows : numbers, or quantities with a unit, as text
    report : makes a mistake of its place and a message
    problems : to which mistakes are added
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[str | None]]
    report: Report
    problems: list[Problem]

    def refuse(self, place: Sequence[str | int], message: str) -> None:
        """Add a mistake."""
        self.problems.append(self.report(place, message))


_BARE_NUMBER = re.compile(r"[-+.,/\deE ]*")
_NO_WAY = ("direction", "dir", "heading", "bearing")


def read_columns(
    table: QuantityTable, known: Mapping[str, QuantityRange], gaps: Booleans | None = None
) -> dict[str, Floats]:
    """Return the known columns by name, in SI, NaN where a value is wrong, or lacks in `gaps`."""
    columns, rows = table.columns, table.rows
    units = _read_headings(table, known)
    if len(units) == len(columns) and "depth" not in units:
        table.refuse(("columns",), "the table has no `depth` column")
    values = {name: np.full(len(rows), np.nan) for name in units}
    if not rows:
        table.refuse(("rows",), "the table has no rows")
    whole = []
    for i, row in enumerate(rows):
        if len(row) == len(columns):
            whole.append(i)
            continue
        hint = "; a decimal comma? (write 0.8, not 0,8)" if len(row) > len(columns) else ""
        message = f"the row has {len(row)} values, {len(columns)} are needed{hint}"
        table.refuse(("rows", i), message)
    if len(units) < len(columns):
        return values
    for j, (name, unit) in enumerate(units.items()):
        cells = [rows[i][j] for i in whole]
        if gaps is not None and gaps.any():
            lacking = gaps[whole].tolist()
            cells = [
                "nan" if lacks and is_gap(cell) else cell
                for cell, lacks in zip(cells, lacking, strict=True)
            ]
        together = _read_together(cells, unit, known[name], gaps is not None)
        if together is not None:
            values[name][whole] = together
            continue
        for i, cell in zip(whole, cells, strict=True):
            try:
                if gaps is None or not (gaps[i] and cell == "nan"):
                    values[name][i] = _read_cell(cell, unit, known[name])
            except QuantityError as error:
                table.refuse(("rows", i, j), about_quantity(name, cell, error))
    return values


def _read_together(
    cells: Sequence[str | None], unit: str, quantity: QuantityRange, gaps: bool
) -> Floats | None:
    """Return a column in SI; None where a cell is no plain number, or beyond the limits."""
    numbers = plain_numbers(cells) if unit else None
    if numbers is None or (not gaps and np.isnan(numbers).any()):
        return None
    numbers = numbers * unit_factor(unit, quantity.dimension)
    beyond = (numbers <= quantity.above) | (numbers < quantity.at_least)
    return None if (beyond | (numbers > quantity.at_most)).any() else numbers


def _read_headings(table: QuantityTable, known: Mapping[str, QuantityRange]) -> dict[str, str]:
    """Return the unit of each known column by its name, empty where the column gives none."""
    units: dict[str, str] = {}
    for j, column in enumerate(table.columns):
        name, unit = heading(column)
        name = name.lower() if name.lower() in known else name
        if name.lower() in _NO_WAY and "toward" in known:
            message = (
                f"`{shown(column)}` does not say which way: call it `toward` where the current "
                "flows to, or `from` where it comes from"
            )
            table.refuse(("columns", j), message)
        elif name not in known:
            message = unknown(f"no column is called `{shown(name)}`", name, known)
            table.refuse(("columns", j), message)
        elif name in units:
            table.refuse(("columns", j), f"column `{name}` is given twice")
        else:
            try:
                if unit:
                    column_unit(column, unit, [known[name].dimension])
            except QuantityError as error:
                table.refuse(("columns", j), str(error))
            else:
                units[name] = unit
    return units


def _read_cell(text: str | None, unit: str, quantity: QuantityRange) -> float:
    if text is not None and unit and _BARE_NUMBER.fullmatch(text):
        text = f"{text} {unit}"
    return quantity.read(text)


def check_depths(
    table: QuantityTable,
    values: Mapping[str, Floats],
    rows: Integers,
    profile: Integers | None = None,
) -> None:
    """Depths must not be negative, and must increase from one of the rows of a profile to another.

    Rows that are not among `rows` are not looked at.
    """
    if "depth" not in values:
        return
    column = list(values).index("depth")
    depths = values["depth"][rows]
    ends = np.flatnonzero(np.diff(np.zeros(len(rows)) if profile is None else profile[rows])) + 1
    inside = np.delete(np.diff(depths), ends - 1)
    if ((depths >= 0.0) & (depths <= DEEPEST)).all() and (inside > 0.0).all():
        return
    for start, stop in pairwise([0, *ends.tolist(), len(depths)]):
        mine = depths[start:stop]
        if len(mine) > 1 and (mine <= 0.0).all() and mine.any():
            message = "the depths count upwards; depth is positive down, so leave the sign out"
            first = int(rows[start + int(np.argmax(mine < 0.0))])
            table.refuse(("rows", first, column), message)
            continue
        previous = -math.inf
        for i, depth in zip(rows[start:stop].tolist(), mine.tolist(), strict=True):
            place = ("rows", i, column)
            if depth < 0:
                table.refuse(place, f"depth {depth:g} m is above the surface")
            elif reason := too_deep(depth):
                table.refuse(place, reason)
            elif depth <= previous:
                word = "repeats" if depth == previous else "comes after"
                message = f"depth {depth:g} m {word} {previous:g} m; depths must increase"
                table.refuse(place, message)
            previous = depth
