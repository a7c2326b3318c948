"""Columns of numbers in a CSV file that people made, with the units in its header."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.errors import InputError, Problem
from calm.files.current_csv import is_content
from calm.files.tables import heading
from calm.suggestions import shown, unknown
from calm.units import DIMENSIONS, QuantityError, unit_factor
from calm.whole_file import read_text

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

Dimensions = Mapping[str, str]
"""Of every column that is known: its dimension, of `calm.units`."""


@dataclass(frozen=True)
class Row:
    """A line of the file: its number, and its cells by the names of the known columns."""

    line: int
    cells: Mapping[str, str]


@dataclass(frozen=True)
class Columns:
    """The rows of a file, the factor of every known column there is, and the headings of others."""

    factors: Mapping[str, float]
    rows: Sequence[Row]
    others: Sequence[str]


def read_columns(path: Path, known: Dimensions, example: str, problems: list[Problem]) -> Columns:
    """The cells of a file as they stand; mistakes of its form are added to `problems`.

    Cells are between commas, semicolons or tabs; empty lines and lines after ``#`` are left out.

    Parameters
    ----------
    example : of a header

    Raises
    ------
    InputError
        It cannot be read, or is empty.
    """
    lines = [
        (number, line)
        for number, line in enumerate(read_text(path).splitlines(), 1)
        if is_content(line)
    ]
    if not lines:
        raise InputError([Problem(str(path), 0, 0, f"is empty; it begins with `{example}`")])
    number, first = lines[0]
    separator = max(",;\t", key=first.count)
    header = [cell.strip() for cell in next(csv.reader([first], delimiter=separator))]
    if all(NUMBER.fullmatch(cell) for cell in header):
        message = f"there is no header; did you mean `{example}`?"
        raise InputError([Problem(str(path), number, 1, message)])
    names = [heading(column)[0].lower() for column in header]
    factors = _factors(path, number, header, known, problems)
    rows = []
    for number, line in lines[1:]:
        cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
        if len(cells) != len(header):
            hint = "; a decimal comma? (write 48.2, not 48,2)" if len(cells) > len(header) else ""
            message = f"the row has {len(cells)} values, the header {len(header)}{hint}"
            problems.append(Problem(str(path), number, 1, message))
            continue
        rows.append(
            Row(
                number,
                {name: cell for name, cell in zip(names, cells, strict=True) if name in factors},
            )
        )
    others = [column for column, name in zip(header, names, strict=True) if name not in known]
    return Columns(factors, rows, others)


def _factors(
    path: Path, line: int, header: Sequence[str], known: Dimensions, problems: list[Problem]
) -> dict[str, float]:
    factors: dict[str, float] = {}
    for column in header:
        name, unit = heading(column)
        name = name.lower()
        if name not in known:
            continue
        complaint, factor = "", 1.0
        if name in factors:
            complaint = f"column `{name}` is given twice"
        elif not unit:
            usual = DIMENSIONS[known[name]].unit
            complaint = f"column `{name}` needs a unit; did you mean `{name}[{usual}]`?"
        else:
            try:
                factor = unit_factor(unit, known[name])
            except QuantityError as error:
                complaint = f"column `{shown(column)}`: `{shown(unit)}` {error}"
        if complaint:
            problems.append(Problem(str(path), line, 1, complaint))
        factors[name] = factor
    return factors


def lacking(path: Path, name: str, unit: str, columns: Columns) -> Problem:
    """That there is no column of a name."""
    message = unknown(f"there is no column `{name}[{unit}]`", name, columns.others or [name])
    return Problem(str(path), 1, 1, message)
