"""A current from a CSV file: `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`.

A record has the column `time` first and a row for every time and depth. A level of a record may
have no value, its cell blank or `nan`: it is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from calm.errors import InputError, Problem
from calm.files.current_terms import Terms
from calm.files.tables import CurrentTable, heading, read_current, turned_notices
from calm.files.times import ZONES_OF_UTC, TimeChoiceError, choose_time, parse_time
from calm.whole_file import read_text

LARGEST_CSV = 50_000_000
"""Largest file that is read for a single profile [bytes]."""

MOST_PROBLEMS = 20
"""Most mistakes shown of one file; a wrong separator makes thousands of the same."""


@dataclass(frozen=True)
class CsvRow:
    """A line of the file: its number and its cells, each as far as the next comma."""

    number: int
    cells: list[str]

    def column(self, cell: int) -> int:
        """Where a cell begins in the line, counted from 1."""
        before = sum(len(text) + 1 for text in self.cells[:cell])
        return before + 1 + len(self.cells[cell]) - len(self.cells[cell].lstrip())


@dataclass(frozen=True)
class CsvHeader:
    """The first line: names and units of the columns after the time, if there is one."""

    path: Path
    row: CsvRow

    @property
    def timed(self) -> bool:
        """Whether the file is a record."""
        return heading(self.row.cells[0])[0].lower() == "time"

    @property
    def columns(self) -> list[str]:
        """Names with units, without that of the time."""
        return [cell.strip() for cell in self.row.cells[int(self.timed) :]]

    def profile(
        self, rows: Sequence[CsvRow], problems: list[Problem], terms: Terms
    ) -> CurrentTable | None:
        """The current of the rows of one time; None, with mistakes added, when it has any."""
        first = int(self.timed)

        def report(location: Sequence[str | int], message: str) -> Problem:
            place = [int(part) for part in location[1:]]
            row = rows[place.pop(0)] if location[0] == "rows" and place else self.row
            column = row.column(place[0] + first if place else 0)
            return Problem(str(self.path), row.number, column, message)

        values = [[cell.strip() or None for cell in row.cells[first:]] for row in rows]
        return read_current(self.columns, values, report, problems, terms)

    def without_gaps(self, rows: Sequence[CsvRow]) -> list[CsvRow]:
        """The rows of a record that give a current."""
        names = [heading(cell)[0].lower() for cell in self.row.cells]
        current = [j for j, name in enumerate(names) if name not in ("time", "depth")]
        return [
            row
            for row in rows
            if len(row.cells) != len(names)
            or not any(row.cells[j].strip().lower() in ("", "nan") for j in current)
        ]


def read_current_csv(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    """The profile of a time, and notices; `time` may be None where there is only one.

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file.
    """
    header, rows = _read_rows(path)
    notices: list[str] = []
    if header.timed:
        rows, notices = _rows_of(rows, time, path)
        known = header.without_gaps(rows)
        if rows and not known:
            raise InputError([Problem(str(path), rows[0].number, 1, "no level has a value")])
        if left_out := len(rows) - len(known):
            levels = f"{left_out} level{'s' * (left_out > 1)}"
            notices.append(f"{levels} without a value left out of the current")
        rows = known
    elif time is not None:
        raise TimeChoiceError("the file has no column `time`")
    problems: list[Problem] = []
    table = header.profile(rows, problems, terms)
    if table is None:
        raise InputError(abridged(problems))
    return table, [*notices, *turned_notices(header.columns, terms)]


def read_csv_header(path: Path, number: int, line: str) -> CsvHeader:
    """The header of a file.

    Raises
    ------
    InputError
        The line is no header.
    """
    cells = line.split(",")
    if len(cells) > 1 and not cells[-1].strip():
        message = "the line ends in a comma; take it off every line"
        raise InputError([Problem(str(path), number, len(line.rstrip()), message)])
    if len(cells) < 2:
        message = f"`{cells[0][:40]}` is not a header such as `depth[m],u[m/s],v[m/s]`"
        raise InputError([Problem(str(path), number, 1, message)])
    name, zone = heading(cells[0])
    if name.lower() == "time" and zone and zone.upper() not in ZONES_OF_UTC:
        message = (
            f"`{cells[0].strip()[:40]}`: times are in UTC, or each says what it is ahead, as in "
            "2026-03-01T06:00+02:00"
        )
        raise InputError([Problem(str(path), number, 1, message)])
    return CsvHeader(path, CsvRow(number, cells))


def is_content(line: str) -> bool:
    """Whether a line is neither blank nor a comment."""
    return bool(line.strip()) and not line.lstrip().startswith("#")


def abridged(problems: list[Problem]) -> list[Problem]:
    """The first mistakes, and how many more there are."""
    hidden = len(problems) - MOST_PROBLEMS
    if hidden <= 0:
        return problems
    more = Problem(problems[0].path, 0, 0, f"and {hidden} more mistakes")
    return [*problems[:MOST_PROBLEMS], more]


def _read_rows(path: Path) -> tuple[CsvHeader, list[CsvRow]]:
    """The header, and the lines of the file that are neither blank nor a comment."""
    text = read_text(path, largest=LARGEST_CSV)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if is_content(line)]
    if not lines:
        raise InputError([Problem(str(path), 0, 0, "is empty")])
    header = read_csv_header(path, *lines[0])
    return header, [CsvRow(number, line.split(",")) for number, line in lines[1:]]


def _rows_of(rows: list[CsvRow], time: str | None, path: Path) -> tuple[list[CsvRow], list[str]]:
    """The rows of the time nearest to the one wanted, and the notice that says so."""
    problems = []
    moments = []
    for row in rows:
        try:
            moments.append(parse_time(row.cells[0]))
        except TimeChoiceError as error:
            problems.append(Problem(str(path), row.number, 1, str(error)))
    if problems:
        raise InputError(abridged(problems))
    times = sorted(set(moments))
    index, notice = choose_time(times, time)
    chosen = [row for row, moment in zip(rows, moments, strict=True) if moment == times[index]]
    return chosen, [notice] if notice else []
