"""Currents in tables of text: `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`.

A record has the column `time` first and a row for every time and depth, the levels of one time in
lines that follow. It is read once, its numbers kept in a temporary file. A level of a record may
have no value, its cell blank, `nan` or `NA`: it is left out.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, UsageError, refused
from calm.physics.line import Floats, Integers
from calm.records import delimited
from calm.records.attributes import refused_by_comments, remarks_in_comments
from calm.records.columns import QuantityTable
from calm.records.current_terms import Terms, TimeChoiceError, current_notices, parse_time
from calm.records.delimited import COMMENT, MOST_PROBLEMS, CellRow, NumberedLine, abridged, is_gap
from calm.records.headings import heading, is_time, magnetic_columns, zone_complaint
from calm.records.profile_tables import read_currents, turned_notices
from calm.records.record import RULES, Levels, Period, Record, choose_profiles, part

AT_ONCE = 50_000
"""Lines of a record that are read together."""

COLUMNS = 4
"""Depth [m], u, v and w [m/s]."""

EXAMPLE = "depth[m],u[m/s],v[m/s]"


class CsvRecord(Record):
    """Read a record once, and keep its numbers in a temporary file until it is closed.

    Parameters and errors are those of `open_record`; every mistake of the file is reported.
    """

    def __init__(self, path: Path, terms: Terms, period: Period | None, every: int) -> None:
        self._terms = terms
        self._kept = tempfile.TemporaryFile()  # noqa: SIM115 (until it is closed)
        try:
            header = self._read(path)
            told = comment_notices(path, header)
            self._index, chosen = choose_profiles(self._times, period, every, path)
        except BaseException:
            self._kept.close()
            raise
        self.time = self._times[self._index]
        depth, u, v, _ = self.profiles(0, min(self.count, AT_ONCE))
        odd = current_notices((depth, u, v), self.time[:AT_ONCE], terms.water_depth)
        self.notes = (*chosen, *told, *self._turned, *odd, *RULES)
        self.source = {"file": path.name, "columns": ", ".join(header.columns)}

    def _read(self, path: Path) -> CurrentHeader:
        """Return every profile of the file into the temporary one."""
        try:
            with path.open("rb") as file:
                bare = (COMMENT.sub(rb"\1", line) if b"#" in line else line for line in file)
                lines = (
                    (i, line.decode("utf-8-sig" if i == 1 else "utf-8").rstrip("\r\n"))
                    for i, line in enumerate(bare, 1)
                )
                return self._keep(path, *delimited.table_lines(path, lines, f"time,{EXAMPLE}"))
        except UnicodeDecodeError:
            raise refused(path, "is not UTF-8 text") from None
        except OSError as error:
            raise refused(path, f"cannot be read: {error.strerror or error}") from None

    def _keep(self, path: Path, first: CellRow, lines: Iterator[NumberedLine]) -> CurrentHeader:
        header = CurrentHeader(path, first)
        if not header.timed:
            message = "has no column `time`: it is one profile, for `calm run`"
            raise refused(path, message, line=first.number)
        problems: list[Problem] = []
        times: list[np.datetime64] = []
        counts: list[int] = []
        for rows in _whole_profiles(lines, first):
            begins = [
                i for i, row in enumerate(rows) if not i or row.cells[0] != rows[i - 1].cells[0]
            ]
            for i in begins:
                try:
                    moment = parse_time(rows[i].cells[0])
                except TimeChoiceError as error:
                    problems.append(Problem(str(path), rows[i].number, 1, str(error)))
                else:
                    times.append(np.datetime64(moment.replace(tzinfo=None)))
            sizes = np.diff([*begins, len(rows)])
            which = np.repeat(np.arange(len(begins)), sizes)
            self._put_by(header.currents(rows, problems, self._terms, which))
            counts += sizes.tolist()
            _refuse(problems, header, at_least=MOST_PROBLEMS)
        _refuse(problems, header)
        self._times = np.array(times, "datetime64[ns]")
        self._first = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        self._most = max(counts, default=0)
        self._rows = np.empty((0, COLUMNS))
        if self._first[-1]:
            self._rows = np.memmap(self._kept, np.float64, "r", shape=(self._first[-1], COLUMNS))
        self._has_w = any(heading(column)[0].lower() == "w" for column in header.columns)
        self._turned = turned_notices(header.columns, self._terms)
        return header

    def _put_by(self, rows: Floats) -> None:
        try:
            rows.tofile(self._kept)
            self._kept.flush()
        except OSError:
            place = tempfile.gettempdir()
            raise UsageError(f"no room for the numbers of the record in {place}") from None

    def profiles(self, start: int, stop: int) -> Levels:
        """See `Record`."""
        chosen = np.arange(len(self._times))[part(self._index, start, stop)]
        first, behind = self._first[chosen], self._first[chosen + 1]
        levels = first[:, np.newaxis] + np.arange(self._most)
        there = levels < behind[:, np.newaxis]
        columns = np.full((*levels.shape, COLUMNS), np.nan)
        columns[there] = self._rows[levels[there]]
        depth, u, v, w = (np.ascontiguousarray(columns[:, :, i]) for i in range(COLUMNS))
        return depth, u, v, (w if self._has_w else None)

    def close(self) -> None:
        """See `Record`."""
        self._rows = np.empty((0, COLUMNS))
        self._kept.close()


def comment_notices(path: Path, header: CurrentHeader) -> list[str]:
    """Return what the comments above a table of currents say that a person should know.

    InputError: they say that it is a part of the current, or in other coordinates than its columns.
    """
    with path.open("rb") as file:
        above = (line.decode(errors="replace").strip() for line in islice(file, header.row.number))
        comments = [line.lstrip("# ") for line in above if line.startswith("#")]
    magnetic = bool(magnetic_columns(header.columns)[1])
    if reason := refused_by_comments(comments, magnetic=magnetic):
        raise refused(path, f"its current {reason}", line=1)
    return remarks_in_comments(comments)


def _whole_profiles(lines: Iterable[NumberedLine], header: CellRow) -> Iterator[list[CellRow]]:
    """Yield the rows of so many whole profiles that they are some `AT_ONCE`.

    The rows of a profile follow each other with one time.
    """
    gathered: list[CellRow] = []
    for line in lines:
        row = delimited.row_below(header, *line)
        if len(gathered) >= AT_ONCE and row.cells[0] != gathered[-1].cells[0]:
            yield gathered
            gathered = []
        gathered.append(row)
    if gathered:
        yield gathered


def _refuse(problems: list[Problem], header: CurrentHeader, *, at_least: int = 0) -> None:
    """Raise the mistakes where there are more than `at_least`, or where the header has one."""
    in_header = [problem for problem in problems if problem.line == header.row.number]
    if in_header:
        raise InputError(abridged(in_header))
    if len(set(problems)) > at_least:
        raise InputError(abridged(problems))


@dataclass(frozen=True)
class CurrentHeader:
    """Know the columns of a table of currents after its time, if it has one."""

    path: Path
    row: CellRow

    def __post_init__(self) -> None:
        complaint = zone_complaint(self.row.cells[0]) if self.timed else None
        if complaint:
            place = {"line": self.row.number, "column": self.row.column(0)}
            raise refused(self.path, complaint, **place)

    @property
    def timed(self) -> bool:
        """Return whether the file is a record."""
        return is_time(self.row.cells[0])

    @property
    def columns(self) -> list[str]:
        """Return the names with their units, without that of the time."""
        return list(self.row.cells[int(self.timed) :])

    def currents(
        self,
        rows: Sequence[CellRow],
        problems: list[Problem],
        terms: Terms,
        profile: Integers | None = None,
    ) -> Floats:
        """Return (n, 4) depth [m], u, v and w [m/s] of rows; none, with mistakes added, of wrong
        ones.

        Parameters
        ----------
        rows : of the table
        problems : to add to
        terms : how the current is to be taken
        profile : (n,) which profile each row is of; None where all are of one
        """
        first = int(self.timed)

        def report(location: Sequence[str | int], message: str) -> Problem:
            place = [int(part) for part in location[1:]]
            row = rows[place.pop(0)] if location[0] == "rows" and place else self.row
            column = row.column(place[0] + first if place else 0)
            return Problem(str(self.path), row.number, column, message)

        before = len(problems)
        for row in rows if self.row.dialect.decimal == "," else ():
            problems += row.mixed_decimals(self.path)
        cells = [[cell or None for cell in row.cells[first:]] for row in rows]
        table = QuantityTable(self.columns, cells, report, problems)
        found = read_currents(table, terms, profile)
        return np.empty((0, COLUMNS)) if found is None or len(problems) > before else found

    def known(self, rows: Sequence[CellRow]) -> list[int]:
        """Return which rows of a record give a current."""
        names = [heading(cell)[0].lower() for cell in self.row.cells]
        current = [j for j, name in enumerate(names) if name not in ("time", "depth")]
        return [
            i
            for i, row in enumerate(rows)
            if len(row.cells) != len(names) or not any(map(is_gap, (row.cells[j] for j in current)))
        ]
