"""Columns of quantities by their names, each value in SI, and the depths that they stand at."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
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

_BARE_NUMBER = re.compile(r"[-+.,/\deE ]*")
_NO_WAY = ("direction", "dir", "heading", "bearing")


def read_columns(
    columns: Sequence[str],
    rows: Sequence[Sequence[str | None]],
    known: Mapping[str, QuantityRange],
    report: Report,
    problems: list[Problem],
    gaps: Booleans | None = None,
) -> dict[str, Floats]:
    """Return the known columns by name, in SI, NaN where a value is wrong, or lacks in `gaps`."""
    units = _read_headings(columns, known, report, problems)
    if len(units) == len(columns) and "depth" not in units:
        problems.append(report(("columns",), "the table has no `depth` column"))
    values = {name: np.full(len(rows), np.nan) for name in units}
    if not rows:
        problems.append(report(("rows",), "the table has no rows"))
    whole = []
    for i, row in enumerate(rows):
        if len(row) == len(columns):
            whole.append(i)
            continue
        hint = "; a decimal comma? (write 0.8, not 0,8)" if len(row) > len(columns) else ""
        message = f"the row has {len(row)} values, {len(columns)} are needed{hint}"
        problems.append(report(("rows", i), message))
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
                problems.append(report(("rows", i, j), about_quantity(name, cell, error)))
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


def _read_headings(
    columns: Sequence[str],
    known: Mapping[str, QuantityRange],
    report: Report,
    problems: list[Problem],
) -> dict[str, str]:
    """Return the unit of each known column by its name, empty where the column gives none."""
    units: dict[str, str] = {}
    for j, column in enumerate(columns):
        name, unit = heading(column)
        name = name.lower() if name.lower() in known else name
        if name.lower() in _NO_WAY and "toward" in known:
            message = (
                f"`{shown(column)}` does not say which way: call it `toward` where the current "
                "flows to, or `from` where it comes from"
            )
            problems.append(report(("columns", j), message))
        elif name not in known:
            message = unknown(f"no column is called `{shown(name)}`", name, known)
            problems.append(report(("columns", j), message))
        elif name in units:
            problems.append(report(("columns", j), f"column `{name}` is given twice"))
        else:
            try:
                if unit:
                    column_unit(column, unit, [known[name].dimension])
            except QuantityError as error:
                problems.append(report(("columns", j), str(error)))
            else:
                units[name] = unit
    return units


def _read_cell(text: str | None, unit: str, quantity: QuantityRange) -> float:
    if text is not None and unit and _BARE_NUMBER.fullmatch(text):
        text = f"{text} {unit}"
    return quantity.read(text)


def check_depths(
    values: Mapping[str, Floats],
    report: Report,
    problems: list[Problem],
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
            problems.append(report(("rows", first, column), message))
            continue
        previous = -math.inf
        for i, depth in zip(rows[start:stop].tolist(), mine.tolist(), strict=True):
            place = ("rows", i, column)
            if depth < 0:
                problems.append(report(place, f"depth {depth:g} m is above the surface"))
            elif reason := too_deep(depth):
                problems.append(report(place, reason))
            elif depth <= previous:
                word = "repeats" if depth == previous else "comes after"
                message = f"depth {depth:g} m {word} {previous:g} m; depths must increase"
                problems.append(report(place, message))
            previous = depth
