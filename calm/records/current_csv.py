"""Currents in tables of text: `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`.

A record has the column `time` first and a row for every time and depth, the levels of one time in
lines that follow. A level of a record may have no value, its cell blank, `nan` or `NA`: it is left
out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem
from calm.records.current_notices import current_notices
from calm.records.current_terms import Terms
from calm.records.delimited import (
    GAPS,
    CellRow,
    abridged,
    read_table,
)
from calm.records.headings import heading, is_time, zone_complaint
from calm.records.profile_tables import CurrentTable, read_current, turned_notices
from calm.records.times import TimeChoiceError, choose_time, parse_time

EXAMPLE = "depth[m],u[m/s],v[m/s]"


@dataclass(frozen=True)
class CurrentHeader:
    """Know the columns of a table of currents after its time, if it has one."""

    path: Path
    row: CellRow

    def __post_init__(self) -> None:
        complaint = zone_complaint(self.row.cells[0]) if self.timed else None
        if complaint:
            column = self.row.column(0)
            raise InputError([Problem(str(self.path), self.row.number, column, complaint)])

    @property
    def timed(self) -> bool:
        """Return whether the file is a record."""
        return is_time(self.row.cells[0])

    @property
    def columns(self) -> list[str]:
        """Return the names with their units, without that of the time."""
        return list(self.row.cells[int(self.timed) :])

    def profile(
        self, rows: Sequence[CellRow], problems: list[Problem], terms: Terms
    ) -> CurrentTable | None:
        """Return the current of the rows of one time; None, with mistakes added, if it has any.

        Parameters
        ----------
        rows : of one time, or all where there is none
        problems : to add to
        terms : how the current is to be taken
        """
        first = int(self.timed)

        def report(location: Sequence[str | int], message: str) -> Problem:
            place = [int(part) for part in location[1:]]
            row = rows[place.pop(0)] if location[0] == "rows" and place else self.row
            column = row.column(place[0] + first if place else 0)
            return Problem(str(self.path), row.number, column, message)

        for row in rows:
            problems += row.mixed_decimals(self.path)
        values = [[cell or None for cell in row.cells[first:]] for row in rows]
        return read_current(self.columns, values, report, problems, terms)

    def without_gaps(self, rows: Sequence[CellRow]) -> list[CellRow]:
        """Return the rows of a record that give a current."""
        names = [heading(cell)[0].lower() for cell in self.row.cells]
        current = [j for j, name in enumerate(names) if name not in ("time", "depth")]
        return [
            row
            for row in rows
            if len(row.cells) != len(names)
            or not any(row.cells[j].lower() in GAPS for j in current)
        ]


def read_current_csv(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    """Return the profile of a time, and notices.

    Parameters
    ----------
    path : of the table
    time : in ISO 8601; None where there is only one
    terms : how the current is to be taken

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file.
    """
    table = read_table(path, EXAMPLE)
    header, rows = CurrentHeader(path, table.header), list(table.rows)
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
    current = header.profile(rows, problems, terms)
    if current is None:
        raise InputError(abridged(problems))
    notices += turned_notices(header.columns, terms)
    arrays = np.array(current.depth), np.array([current.u]), np.array([current.v])
    return current, [*notices, *current_notices(("u", "v"), arrays, None, terms.water_depth)]


def _rows_of(rows: list[CellRow], time: str | None, path: Path) -> tuple[list[CellRow], list[str]]:
    """Return the rows of the time nearest to the one wanted, and the notice that says so."""
    problems = []
    moments = []
    for row in rows:
        try:
            moments.append(parse_time(row.cells[0]))
        except TimeChoiceError as error:
            problems.append(Problem(str(path), row.number, row.column(0), str(error)))
    if problems:
        raise InputError(abridged(problems))
    times = sorted(set(moments))
    index, notice = choose_time(times, time)
    chosen = [row for row, moment in zip(rows, moments, strict=True) if moment == times[index]]
    return chosen, [notice] if notice else []
