"""Columns of numbers in tables of text, each headed by its name and its unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem
from calm.physics.line import Floats
from calm.records.delimited import GAPS, NUMBER, CellRow, TextTable, abridged, read_table
from calm.records.headings import column_unit, heading, is_time, zone_complaint
from calm.records.times import TimeChoiceError, parse_time
from calm.suggestions import about_quantity, unknown
from calm.units import DIMENSIONS, QuantityError, QuantityRange

_INFINITE = ("inf", "infinity")


@dataclass(frozen=True)
class NamedRow:
    """Hold a line of a table by the names of its known columns."""

    line: int
    cells: Mapping[str, str]
    columns: Mapping[str, int]

    def problem(self, path: Path, name: str, message: str) -> Problem:
        """Return a mistake at the cell of a column.

        Parameters
        ----------
        path : of the table
        name : of the column
        message : what is wrong
        """
        return Problem(str(path), self.line, self.columns[name], message)


@dataclass(frozen=True)
class NamedColumns:
    """Hold the rows of a table whose columns are known by name.

    Attributes
    ----------
    factors : of the known columns that are there, to SI (degrees)
    rows : as many cells in each as there are headings
    others : headings of the other columns
    header : line of the headings
    """

    factors: Mapping[str, float]
    rows: Sequence[NamedRow]
    others: Sequence[str]
    header: int

    def lacks(self, path: Path, name: str, unit: str) -> Problem:
        """Return the mistake that there is no column of a name.

        Parameters
        ----------
        path : of the table
        name : of the column
        unit : to offer with it
        """
        message = unknown(f"there is no column `{name}[{unit}]`", name, self.others or [name])
        return Problem(str(path), self.header, 1, message)


@dataclass(frozen=True)
class TimeColumns:
    """Hold the columns of a table over time.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    names, dimensions : of the columns; dimensions are those of `calm.units.DIMENSIONS`
    values : (n, c) in SI, NaN in gaps
    """

    time: NDArray[np.datetime64]
    names: tuple[str, ...]
    dimensions: tuple[str, ...]
    values: Floats


def read_named_columns(
    path: Path, known: Mapping[str, str], example: str, problems: list[Problem]
) -> NamedColumns:
    """Return the cells of a table as they stand; mistakes of its form are added to `problems`.

    Parameters
    ----------
    path : of the table
    known : dimensions of the columns by their names, blanks in which may be underscores
    example : of a header, for messages
    problems : to add to

    Raises
    ------
    InputError
        It cannot be read, is empty, or has no header.
    """
    table = read_table(path, example)
    header = table.header
    names = [heading(column)[0].lower().replace(" ", "_") for column in header.cells]
    factors: dict[str, float] = {}
    for j, (column, name) in enumerate(zip(header.cells, names, strict=True)):
        if name not in known:
            continue
        try:
            if name in factors:
                raise QuantityError(f"column `{name}` is given twice")
            factors[name] = column_unit(column, heading(column)[1], [known[name]])[1]
        except QuantityError as error:
            factors[name] = 1.0
            problems.append(Problem(str(path), header.number, header.column(j), str(error)))
    rows = []
    for row in _whole_rows(table, problems):
        mine = [j for j, name in enumerate(names) if name in factors]
        rows.append(
            NamedRow(
                row.number,
                {names[j]: row.cells[j] for j in mine},
                {names[j]: row.column(j) for j in mine},
            )
        )
    others = [column for column, name in zip(header.cells, names, strict=True) if name not in known]
    return NamedColumns(factors, rows, others, header.number)


def read_time_columns(path: Path, dimensions: Sequence[str], example: str) -> TimeColumns:
    """Return a table of times and quantities, each column headed by a label and its unit.

    Parameters
    ----------
    path : of the table
    dimensions : what the columns may be, of `calm.units.DIMENSIONS`
    example : of a heading, for messages

    Raises
    ------
    InputError
        With every mistake.
    """
    table = read_table(path, f"time,{example}")
    header = table.header
    if not is_time(header.cells[0]):
        message = f"is not a table over time; its heading should be `time,{example}`"
        raise InputError([Problem(str(path), header.number, 1, message)])
    problems: list[Problem] = []
    if complaint := zone_complaint(header.cells[0]):
        problems.append(Problem(str(path), header.number, header.column(0), complaint))
    columns = [
        _labelled(path, header, j, dimensions, heading(example)[1], problems)
        for j in range(1, len(header.cells))
    ]
    rows = _whole_rows(table, problems)
    if not rows and not problems:
        problems.append(Problem(str(path), header.number, 1, "the table has no rows"))
    times = np.full(len(rows), np.datetime64("NaT"), "M8[ns]")
    values = np.full((len(rows), len(columns)), np.nan)
    for i, row in enumerate(rows):
        try:
            times[i] = np.datetime64(parse_time(row.cells[0]).replace(tzinfo=None), "ns")
        except TimeChoiceError as error:
            problems.append(Problem(str(path), row.number, row.column(0), str(error)))
        for j, column in enumerate(columns):
            if column is None:
                continue
            try:
                values[i, j] = column.value(row.cells[j + 1])
            except QuantityError as error:
                message = about_quantity(column.name, row.cells[j + 1], error)
                problems.append(Problem(str(path), row.number, row.column(j + 1), message))
    if problems:
        raise InputError(abridged(problems))
    found = [column for column in columns if column is not None]
    order = np.argsort(times, kind="stable")
    return TimeColumns(
        times[order],
        tuple(column.name for column in found),
        tuple(column.dimension for column in found),
        values[order],
    )


@dataclass(frozen=True)
class _LabelledColumn:
    """A column whose name is a label."""

    name: str
    dimension: str
    unit: str
    factor: float

    def value(self, cell: str) -> float:
        """Return the number of a cell in SI, NaN of a gap; QuantityError where it is none."""
        if NUMBER.fullmatch(cell):
            return float(cell) * self.factor
        if cell.lower() in GAPS or cell.lower().lstrip("+-") in _INFINITE:
            return float("nan")
        return QuantityRange(self.dimension, self.unit).read(cell)


def _labelled(
    path: Path,
    header: CellRow,
    j: int,
    dimensions: Sequence[str],
    usual: str,
    problems: list[Problem],
) -> _LabelledColumn | None:
    """Return the column of a heading; None, with its mistake added, where it has any."""
    column = header.cells[j]
    name, unit = heading(column, dimensions)
    try:
        dimension, factor = column_unit(column, unit, dimensions, usual)
    except QuantityError as error:
        problems.append(Problem(str(path), header.number, header.column(j), str(error)))
        return None
    return _LabelledColumn(name, dimension, unit or DIMENSIONS[dimension].unit, factor)


def _whole_rows(table: TextTable, problems: list[Problem]) -> list[CellRow]:
    """Return the rows that have as many cells as the header; mistakes are added for the others."""
    whole = []
    for row in table.rows:
        problems += row.mixed_decimals(table.path)
        count, needed = len(row.cells), len(table.header.cells)
        if count == needed:
            whole.append(row)
            continue
        hint = "; a decimal comma? (write 48.2, not 48,2)" if count > needed else ""
        message = f"the row has {count} values, {needed} are needed{hint}"
        problems.append(Problem(str(table.path), row.number, 1, message))
    return whole
