"""A current from a CSV file: `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`.

A record has the column `time` first and a row for every time and depth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.errors import InputError, Problem
from calm.files.document import read_text
from calm.files.tables import CurrentTable, read_current
from calm.files.times import TimeChoiceError, choose_time, parse_time

LARGEST_CSV = 50_000_000
"""Bytes; a larger file is not read."""

MOST_PROBLEMS = 20
"""Mistakes shown of one file; a wrong separator makes thousands of the same."""


@dataclass(frozen=True)
class _Row:
    """A line of the file: its number and its cells, each as far as the next comma."""

    number: int
    cells: list[str]

    def column(self, cell: int) -> int:
        """Where a cell begins in the line, counted from 1."""
        before = sum(len(text) + 1 for text in self.cells[:cell])
        return before + 1 + len(self.cells[cell]) - len(self.cells[cell].lstrip())


def read_current_csv(path: Path, time: str | None) -> tuple[CurrentTable, list[str]]:
    """The profile of a time, and notices; `time` may be None where there is only one.

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file.
    """
    header, *rows = _read_rows(path)
    notices: list[str] = []
    first = 0
    if header.cells[0].strip().partition("[")[0] == "time":
        rows, notices = _rows_of(rows, time, path)
        first = 1
    elif time is not None:
        raise TimeChoiceError("the file has no column `time`")

    def report(location: Sequence[str | int], message: str) -> Problem:
        place = [int(part) for part in location[1:]]
        row = rows[place.pop(0)] if location[0] == "rows" and place else header
        return Problem(str(path), row.number, row.column(place[0] + first if place else 0), message)

    problems: list[Problem] = []
    columns = [cell.strip() for cell in header.cells[first:]]
    values = [[cell.strip() or None for cell in row.cells[first:]] for row in rows]
    table = read_current(columns, values, report, problems)
    if table is None:
        raise InputError(_abridged(problems))
    return table, notices


def _read_rows(path: Path) -> list[_Row]:
    """The lines of the file that are neither blank nor a comment, the header first."""
    rows = [
        _Row(number, line.split(","))
        for number, line in enumerate(read_text(path, largest=LARGEST_CSV).splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not rows:
        raise InputError([Problem(str(path), 0, 0, "is empty")])
    if len(rows[0].cells) < 2:
        message = f"`{rows[0].cells[0][:40]}` is no header such as `depth[m],u[m/s],v[m/s]`"
        raise InputError([Problem(str(path), rows[0].number, 1, message)])
    return rows


def _rows_of(rows: list[_Row], time: str | None, path: Path) -> tuple[list[_Row], list[str]]:
    """The rows of the time nearest to the one wanted, and the notice that says so."""
    problems = []
    moments = []
    for row in rows:
        try:
            moments.append(parse_time(row.cells[0]))
        except TimeChoiceError as error:
            problems.append(Problem(str(path), row.number, 1, str(error)))
    if problems:
        raise InputError(_abridged(problems))
    times = sorted(set(moments))
    index, notice = choose_time(times, time)
    chosen = [row for row, moment in zip(rows, moments, strict=True) if moment == times[index]]
    return chosen, [notice] if notice else []


def _abridged(problems: list[Problem]) -> list[Problem]:
    hidden = len(problems) - MOST_PROBLEMS
    if hidden <= 0:
        return problems
    more = Problem(problems[0].path, 0, 0, f"and {hidden} more mistakes")
    return [*problems[:MOST_PROBLEMS], more]
