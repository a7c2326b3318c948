"""Currents in tables of text: `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`.

A record has the column `time` first and a row for every time and depth, the levels of one time in
lines that follow. It is read once, its numbers kept in a temporary file. A level of a record may
have no value, its cell blank, `nan` or `NA`: it is left out.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, UsageError
from calm.physics.line import Floats
from calm.records.attributes import refused_by_comments, remarks_in_comments
from calm.records.current_terms import (
    DEEPEST,
    Terms,
    TimeChoiceError,
    current_notices,
    parse_time,
)
from calm.records.delimited import (
    COMMENT,
    GAPS,
    MOST_PROBLEMS,
    CellRow,
    NumberedLine,
    abridged,
    row_below,
    table_lines,
)
from calm.records.headings import heading, is_time, magnetic_columns, zone_complaint
from calm.records.profile_tables import CurrentTable, read_current, turned_by, turned_notices
from calm.records.record import RULES, Levels, Period, Record, choose_profiles, part
from calm.units import QuantityError, unit_factor

AT_ONCE = 50_000
"""Lines of a record that are read together."""

COLUMNS = 4
"""Depth [m], u, v and w [m/s]."""

EXAMPLE = "depth[m],u[m/s],v[m/s]"
_DIMENSIONS = {"depth": "length", "toward": "angle", "from": "angle"}
_PLAIN = ({"depth", "u", "v"}, {"depth", "speed", "toward"}, {"depth", "speed", "from"})


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
                plain = (COMMENT.sub(rb"\1", line).decode("utf-8-sig") for line in file)
                lines = ((i, line.rstrip("\r\n")) for i, line in enumerate(plain, 1))
                return self._keep(path, *table_lines(path, lines, f"time,{EXAMPLE}"))
        except UnicodeDecodeError:
            raise InputError([Problem(str(path), 0, 0, "is not UTF-8 text")]) from None
        except OSError as error:
            message = f"cannot be read: {error.strerror or error}"
            raise InputError([Problem(str(path), 0, 0, message)]) from None

    def _keep(self, path: Path, first: CellRow, lines: Iterator[NumberedLine]) -> CurrentHeader:
        header = CurrentHeader(path, first)
        if not header.timed:
            message = "has no column `time`: it is one profile, for `calm run`"
            raise InputError([Problem(str(path), first.number, 1, message)])
        reader = RowReader(header, self._terms)
        problems: list[Problem] = []
        times: list[np.datetime64] = []
        counts: list[int] = []
        for profiles in _gathered(_by_time(lines, first)):
            for profile in profiles:
                try:
                    moment = parse_time(profile.time)
                except TimeChoiceError as error:
                    problems.append(Problem(str(path), profile.lines[0][0], 1, str(error)))
                else:
                    times.append(np.datetime64(moment.replace(tzinfo=None)))
            rows, sizes = reader.read(profiles, problems)
            self._put_by(rows)
            counts += sizes
            _refuse(problems, header, at_least=MOST_PROBLEMS)
        _refuse(problems, header)
        self._times = np.array(times, "datetime64[ns]")
        self._first = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        self._most = max(counts, default=0)
        self._rows = np.empty((0, COLUMNS))
        if self._first[-1]:
            self._rows = np.memmap(self._kept, np.float64, "r", shape=(self._first[-1], COLUMNS))
        self._has_w, self._turned = reader.has_w, reader.turned
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
        raise InputError([Problem(str(path), 1, 1, f"its current {reason}")])
    return remarks_in_comments(comments)


@dataclass(frozen=True)
class ProfileLines:
    """Hold the lines of one time, and what stands behind the time in each."""

    time: str
    lines: list[NumberedLine]
    behind: list[str]


class RowReader:
    """Turn the lines of whole profiles into rows of depth, u, v and w.

    Where every cell is a number, and every depth and speed possible, they are read together; in
    any other case profile by profile, as `calm run` reads one, which finds the mistakes.
    """

    def __init__(self, header: CurrentHeader, terms: Terms) -> None:
        self._header, self._terms = header, terms
        plain, magnetic = magnetic_columns(header.columns)
        agreed = bool(magnetic) == (terms.declination is not None) and magnetic not in (
            {"u"},
            {"v"},
        )
        self._factors = _factors(plain) if agreed else None  # otherwise the mistake is found
        self._turn = terms.declination or 0.0
        self.turned = turned_notices(header.columns, terms)
        self.has_w = any(_name(column) == "w" for column in plain)
        sign = _between(header.row)
        gaps = "|".join(re.escape(gap) for gap in sorted(GAPS) if gap not in ("", "nan"))
        self._blank = re.compile(rf"(?i){sign}[ ]*(?:{gaps})?[ ]*(?={sign}|$)", re.MULTILINE)

    def read(
        self, profiles: Sequence[ProfileLines], problems: list[Problem]
    ) -> tuple[Floats, list[int]]:
        """Return the rows of some profiles, one after the other, and how many each has.

        Rows without a value are NaN or left out. Mistakes are added to `problems`.
        """
        counts = [len(profile.lines) for profile in profiles]
        rows = self._together(profiles, counts)
        if rows is not None:
            return rows, counts
        tables = [self._one(profile.lines, problems) for profile in profiles]
        return np.concatenate(tables), [len(table) for table in tables]

    def _together(self, profiles: Sequence[ProfileLines], counts: list[int]) -> Floats | None:
        """Return all rows, None where one is not plain."""
        if self._factors is None:
            return None
        sign = _between(self._header.row)
        # the sign stays before the first cell, so that a blank one is found
        text = "\n".join(sign + rest for profile in profiles for rest in profile.behind)
        text = self._blank.sub(f"{sign}nan", text)
        if self._header.row.dialect.decimal == ",":
            if "." in text or sign == ",":
                return None
            text = text.replace(",", ".")
        try:
            cells = np.loadtxt(
                [line[1:] for line in text.split("\n")], delimiter=sign, comments=None, ndmin=2
            )
        except ValueError:
            return None
        if cells.shape[1] != len(self._factors):
            return None
        values = {
            name: cells[:, j] * factor for j, (name, factor) in enumerate(self._factors.items())
        }
        rows = _components(values, self._turn)
        return rows if _possible(values, rows, counts) else None

    def _one(self, lines: Iterable[NumberedLine], problems: list[Problem]) -> Floats:
        rows = [row_below(self._header.row, *line) for line in lines]
        known = self._header.without_gaps(rows)
        table = self._header.profile(known, problems, self._terms) if known else None
        if table is None:
            return np.empty((0, COLUMNS))
        return np.column_stack([table.depth, table.u, table.v, table.w])


def _between(header: CellRow) -> str:
    """Return what stands between the cells behind a time: runs of blanks have become tabs."""
    separator = header.dialect.separator
    return "\t" if separator == " " else separator


def _by_time(lines: Iterable[NumberedLine], header: CellRow) -> Iterator[ProfileLines]:
    """Yield the lines of every profile: those that follow each other with one time."""
    sign, skipped = header.dialect.separator, header.skipped
    profile, before = ProfileLines("", [], []), None
    for number, line in lines:
        if sign == " ":
            own, *others = row_below(header, number, line).cells
            rest = "\t".join(others)
        else:
            numbered = line.partition(sign)[2] if skipped else line
            own, _, rest = numbered.partition(sign)
        if own != before:
            if profile.lines:
                yield profile
            profile, before = ProfileLines(own.strip().strip('"'), [], []), own
        profile.lines.append((number, line))
        profile.behind.append(rest)
    if profile.lines:
        yield profile


def _gathered(profiles: Iterator[ProfileLines]) -> Iterator[list[ProfileLines]]:
    """Yield so many profiles that they have some `AT_ONCE` lines."""
    gathered: list[ProfileLines] = []
    lines = 0
    for profile in profiles:
        gathered.append(profile)
        lines += len(profile.lines)
        if lines >= AT_ONCE:
            yield gathered
            gathered, lines = [], 0
    if gathered:
        yield gathered


def _refuse(problems: list[Problem], header: CurrentHeader, *, at_least: int = 0) -> None:
    """Raise the mistakes where there are more than `at_least`, or where the header has one."""
    in_header = [problem for problem in problems if problem.line == header.row.number]
    if in_header:
        raise InputError(abridged(in_header))
    if len(set(problems)) > at_least:
        raise InputError(abridged(problems))


def _name(column: str) -> str:
    return heading(column)[0].lower()


def _factors(columns: Sequence[str]) -> dict[str, float] | None:
    """Return the factor of every column to SI (degrees), None where a column is not plain."""
    factors: dict[str, float] = {}
    for column in columns:
        name = _name(column)
        dimension = _DIMENSIONS.get(name, "speed")
        unit = heading(column)[1]
        try:
            factors[name] = unit_factor(unit, dimension) if unit else np.nan
        except QuantityError:
            return None
    plain = set(factors) - {"w"} in _PLAIN and len(factors) == len(columns)
    return factors if plain and all(np.isfinite(list(factors.values()))) else None


def _components(values: dict[str, Floats], turn: float) -> Floats:
    """Return Depth, u, v and w, whatever way the current is given, turned clockwise [degrees]."""
    w = values.get("w", np.zeros_like(values["depth"]))
    if "u" in values:
        u, v = values["u"], values["v"]
        if turn:
            u, v = turned_by(turn, u, v)
        return np.column_stack([values["depth"], u, v, w])
    direction = values["from"] + 180.0 if "from" in values else values["toward"]
    angle = np.radians(direction + turn)
    speed = values["speed"]
    return np.column_stack([values["depth"], speed * np.sin(angle), speed * np.cos(angle), w])


def _possible(values: dict[str, Floats], rows: Floats, counts: list[int]) -> bool:
    """Return whether a reading row by row would find no mistake."""
    known = ~np.isnan(rows).any(axis=1)
    depth = values["depth"]
    if not (np.isfinite(depth) & (depth >= 0) & (depth <= DEEPEST)).all() or np.isinf(rows).any():
        return False
    if "speed" in values and (values["speed"][known] < 0).any():
        return False
    if any(
        (np.abs(values[way][known]) > 360.0).any() for way in ("toward", "from") if way in values
    ):
        return False
    profile = np.repeat(np.arange(len(counts)), counts)[known]
    same = profile[1:] == profile[:-1]
    return bool((np.diff(depth[known])[same] > 0).all())


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
