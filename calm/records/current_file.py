"""Currents from a file of measurements or of a model: NetCDF, zarr or CSV.

A CSV profile has columns `depth[m],u[m/s],v[m/s]` or `depth[m],speed[m/s],toward[deg]`. In a CSV
record, the first column is `time`, and the rows of a time are adjacent. Levels without a value are
omitted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, refused
from calm.physics.line import Floats, Integers
from calm.records import current_terms, delimited
from calm.records.card import ReadCard, VariableSummary, cut
from calm.records.cf_files import UnreadableError, holds_arrays, open_current, reading
from calm.records.current_dataset import ArrayRecord, CurrentDataset
from calm.records.current_terms import Terms, TimeChoiceError, choose_time
from calm.records.delimited import COMMENT, CellRow, NumberedLine, abridged, read_table
from calm.records.headings import heading, is_time, zone_complaint
from calm.records.profile_tables import CurrentTable, QuantityTable, read_currents, turned_notices
from calm.records.record import RULES, Levels, Period, Record, choose_profiles, part
from calm.records.value_tests import CurrentValues, current_doubts, step_doubts
from calm.whole_file import no_such_file

_BLOCK = 10_000
AT_ONCE = 50_000
"""Number of lines of a record that are read together."""

COLUMNS = 4
"""Depth [m], u, v and w [m/s]."""

EXAMPLE = "depth[m],u[m/s],v[m/s]"


def read_current_file(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    """Return the current profile of a file at an ISO 8601 time, and notices about the profile.

    Raises
    ------
    InputError
        The file has mistakes.
    TimeChoiceError
        The time is outside the record, or missing although the file has several times.
    """
    read = _from_arrays if holds_arrays(path) else _from_text
    table, notices = read(path, time, terms)
    return (table if time is None else replace(table, record=(path, terms))), notices


def strongest_of(path: Path, terms: Terms) -> float:
    """Return the maximum horizontal speed of a record over all times and depths [m/s]."""
    strongest = 0.0
    with open_record(path, terms) as record:
        for start in range(0, record.count, _BLOCK):
            _, u, v, _ = record.profiles(start, min(start + _BLOCK, record.count))
            strongest = max(strongest, float(np.nanmax(np.hypot(u, v), initial=0.0)))
    return strongest


def open_record(path: Path, terms: Terms, time: Period | None = None, every: int = 1) -> Record:
    """Open a record of currents in NetCDF, zarr or CSV.

    Parameters
    ----------
    time : period to read, as returned by `parse_period`; None for the whole record
    every : n, to read only every n-th profile

    Raises
    ------
    InputError
        The file is unreadable.
    UsageError
        The options select no profile.
    """
    if not (path.is_file() or path.is_dir()):
        raise refused(path, "is not a regular file" if path.exists() else no_such_file(path))
    return (ArrayRecord if holds_arrays(path) else CsvRecord)(path, terms, time, every)


def _from_arrays(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    with reading(path), open_current(path) as dataset:
        current = CurrentDataset(dataset, terms)
        notices = [*current.notices, *current.turned]
        index = 0
        if current.times is not None:
            index, notice = choose_time(current.times.astype("datetime64[us]"), time)
            notices = [*([notice] if notice else []), *notices]
        elif time is not None:
            raise TimeChoiceError("the file has no times")
        chosen = slice(index, index + 1)
        table = _valid_levels(current.read(chosen), terms, notices)
        card, doubts = current.inspected(path.name, chosen)
        return replace(table, card=card), [*notices, *doubts]


def _valid_levels(found: Levels, terms: Terms, notices: list[str]) -> CurrentTable:
    depth, u, v, up = found
    up = np.zeros_like(u) if up is None else up
    depth, u, v, w = (values.ravel() for values in (depth, u, v, up))
    known = ~np.isnan(u + v + w) & np.isfinite(depth)
    below = known & (depth >= 0)
    for left, what in ((~known, "without a value"), (known & ~below, "above the surface")):
        notices += _excluded(int(left.sum()), what)
    if not below.any():
        raise UnreadableError("no level below the surface has a value")
    for level, east, north, rise in zip(*(one[below] for one in (depth, u, v, w)), strict=True):
        if reason := current_terms.too_deep(level):
            raise UnreadableError(f"its {reason}")
        if reason := current_terms.too_fast(east, north, rise, terms.maximum_speed):
            raise UnreadableError(f"the current at {level:g} m is not valid: {reason}")
    order = np.argsort(depth[below])
    levels, *speeds = (tuple(values[below][order].tolist()) for values in (depth, u, v, w))
    if np.any(np.diff(levels) == 0):
        raise UnreadableError("two levels have the same depth")
    return CurrentTable(levels, speeds[0], speeds[1], speeds[2])


def _excluded(count: int, what: str) -> list[str]:
    return [f"{count} level{'s' * (count > 1)} {what} excluded from the current"] * (count > 0)


def _from_text(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    table = read_table(path, EXAMPLE)
    header, rows, notices = CurrentHeader(table.header), table.rows, list[str]()
    if header.timed:
        rows, notices = _rows_nearest(rows, time)
    elif time is not None:
        raise TimeChoiceError("the file has no column `time`")
    problems: list[Problem] = []
    profile = np.zeros(len(rows), np.int64) if header.timed else None
    found = header.currents(rows, problems, terms, profile)
    if problems:
        raise InputError(abridged(problems))
    known = np.isfinite(found).all(axis=1)
    if not known.any():
        raise InputError([rows[0].problem("no level has a value")])
    notices += _excluded(int((~known).sum()), "without a value")
    depth, u, v, w = found[known].T
    notices += turned_notices(header.columns, terms)
    values = CurrentValues(depth, u[np.newaxis], v[np.newaxis], None, terms.water_depth)
    card = _card_of(header, values, np.empty(0, "M8[ns]"), terms)
    notices += current_doubts(values)
    columns = [tuple(each.tolist()) for each in (depth, u, v, w)]
    return CurrentTable(columns[0], columns[1], columns[2], columns[3], card=card), notices


def _rows_nearest(rows: Sequence[CellRow], time: str | None) -> tuple[list[CellRow], list[str]]:
    problems: list[Problem] = []
    moments = np.array([_time_of_row(row, problems) for row in rows], "datetime64[us]")
    if problems:
        raise InputError(abridged(problems))
    times = np.unique(moments)
    index, notice = choose_time(times, time)
    chosen = np.flatnonzero(moments == times[index]).tolist()
    return [rows[i] for i in chosen], [notice] if notice else []


def _time_of_row(row: CellRow, problems: list[Problem]) -> np.datetime64 | None:
    try:
        return current_terms.parse_time(row.cells[0])
    except TimeChoiceError as error:
        problems.append(row.problem(str(error), 0))
        return None


class CsvRecord(Record):
    """A record in CSV, read once into memory.

    For the parameters and errors, see `open_record`. An error lists up to `MOST_PROBLEMS` mistakes.
    """

    def __init__(self, path: Path, terms: Terms, period: Period | None, every: int) -> None:
        self._terms = terms
        header = self._read(path)
        self._index, chosen = choose_profiles(self._times, period, every, path)
        self.time = self._times[self._index]
        doubts = self._inspect(header, period, every, path)
        self.notes = (*chosen, *self._turned, *doubts, *step_doubts(self.time), *RULES)
        self.source = {"file": path.name, "columns": ", ".join(header.columns)}

    def _inspect(
        self, header: CurrentHeader, period: Period | None, every: int, path: Path
    ) -> list[str]:
        """Set the card of the profiles in a period, and return doubts about their values."""
        mine = self._index
        self._index = choose_profiles(self._times, period, 1, path)[0] if every > 1 else mine
        times = self._times[self._index]
        depth, u, v, _ = self.profiles(0, min(len(times), AT_ONCE))
        self._index = mine
        # reduce the levels to (k,) if all profiles share them
        same = (depth == depth[:1]) | np.isnan(depth)
        values = CurrentValues(
            depth[0] if same.all() else depth, u, v, times[:AT_ONCE], self._terms.water_depth
        )
        self.cards = (_card_of(header, values, times, self._terms),)
        return [*current_doubts(values)]

    def _read(self, path: Path) -> CurrentHeader:
        try:
            with path.open("rb") as file:
                bare = (COMMENT.sub(rb"\1", line) if b"#" in line else line for line in file)
                lines = (
                    (i, line.decode("utf-8-sig" if i == 1 else "utf-8").rstrip("\r\n"))
                    for i, line in enumerate(bare, 1)
                )
                return self._keep(*delimited.table_lines(path, lines, f"time,{EXAMPLE}"))
        except UnicodeDecodeError:
            raise refused(path, "is not UTF-8 text") from None
        except OSError as error:
            raise refused(path, f"cannot be read: {error.strerror or error}") from None

    def _keep(self, first: CellRow, lines: Iterator[NumberedLine]) -> CurrentHeader:
        header = CurrentHeader(first)
        if not header.timed:
            message = "has no column `time`: it is one profile, for `calm run`"
            raise InputError([first.problem(message)])
        problems: list[Problem] = []
        times: list[np.datetime64] = []
        counts: list[int] = []
        parts = [np.empty((0, COLUMNS))]
        for rows in _whole_profiles(lines, first):
            begins = [
                i for i, row in enumerate(rows) if not i or row.cells[0] != rows[i - 1].cells[0]
            ]
            moments = [_time_of_row(rows[i], problems) for i in begins]
            times += [each for each in moments if each is not None]
            sizes = np.diff([*begins, len(rows)])
            which = np.repeat(np.arange(len(begins)), sizes)
            parts.append(header.currents(rows, problems, self._terms, which))
            counts += sizes.tolist()
            _refuse_mistakes(problems, header, at_least=delimited.MOST_PROBLEMS)
        _refuse_mistakes(problems, header)
        self._times = np.array(times, "datetime64[ns]")
        self._first = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        self._most = max(counts, default=0)
        self._rows = np.concatenate(parts)
        self._has_w = any(heading(column)[0].lower() == "w" for column in header.columns)
        self._turned = turned_notices(header.columns, self._terms)
        return header

    def profiles(self, start: int, stop: int) -> Levels:
        """Return the levels of profiles `start` to `stop`; see `Record.profiles`."""
        chosen = np.arange(len(self._times))[part(self._index, start, stop)]
        first, behind = self._first[chosen], self._first[chosen + 1]
        levels = first[:, np.newaxis] + np.arange(self._most)
        there = levels < behind[:, np.newaxis]
        columns = np.full((*levels.shape, COLUMNS), np.nan)
        columns[there] = self._rows[levels[there]]
        depth, u, v, w = (np.ascontiguousarray(columns[:, :, i]) for i in range(COLUMNS))
        return depth, u, v, (w if self._has_w else None)

    def close(self) -> None:
        """Free the memory of the rows."""
        self._rows = np.empty((0, COLUMNS))


def _card_of(
    header: CurrentHeader, values: CurrentValues, times: NDArray[np.datetime64], terms: Terms
) -> ReadCard:
    with header.row.path.open("rb") as file:
        above = (line.decode(errors="replace").strip() for line in islice(file, header.row.number))
        comment = " ".join(line.lstrip("# ") for line in above if line.startswith("#"))
    names = {name.lower(): name for name, _ in map(heading, header.columns)}
    east = north = ", ".join(
        names[one] for one in ("u", "v", "speed", "toward", "from") if one in names
    )
    if "u" in names:
        east, north = names["u"], names["v"]
    summaries = {
        "east": VariableSummary.of(east, "m/s", values.u),
        "north": VariableSummary.of(north, "m/s", values.v),
        "depth": VariableSummary.of(names.get("depth", ""), "m", values.depth),
    }
    clock = (header.row.cells[0], "") if header.timed else ("", "")
    texts = {"comment": cut(comment)} if comment else {}
    return ReadCard(
        header.row.path.name, texts, summaries, values.u.shape[1], times, clock, {},
        terms.declination,
    )  # fmt: skip


def _whole_profiles(lines: Iterable[NumberedLine], header: CellRow) -> Iterator[list[CellRow]]:
    """Yield rows in batches of at least `AT_ONCE`, without splitting a profile."""
    gathered: list[CellRow] = []
    for _, rows in groupby((header.below(*line) for line in lines), lambda row: row.cells[0]):
        gathered += rows
        if len(gathered) >= AT_ONCE:
            yield gathered
            gathered = []
    if gathered:
        yield gathered


def _refuse_mistakes(problems: list[Problem], header: CurrentHeader, *, at_least: int = 0) -> None:
    in_header = [problem for problem in problems if problem.line == header.row.number]
    if in_header:
        raise InputError(abridged(in_header))
    if len(set(problems)) > at_least:
        raise InputError(abridged(problems))


@dataclass(frozen=True)
class CurrentHeader:
    """Header of a table of currents, with or without a time column."""

    row: CellRow

    def __post_init__(self) -> None:
        if self.timed and (complaint := zone_complaint(self.row.cells[0])):
            raise InputError([self.row.problem(complaint, 0)])

    @property
    def timed(self) -> bool:
        """True if the first column holds times; the file is then a record, not a single profile."""
        return is_time(self.row.cells[0])

    @property
    def columns(self) -> list[str]:
        """Column headings without the time column."""
        return list(self.row.cells[int(self.timed) :])

    def currents(
        self,
        rows: Sequence[CellRow],
        problems: list[Problem],
        terms: Terms,
        profile: Integers | None = None,
    ) -> Floats:
        """Convert rows to an array (n, 4) of depth [m], u, v and w [m/s].

        If a row has a mistake, the array is empty and the mistakes are added to `problems`.

        Parameters
        ----------
        profile : (n,) index of the profile of each row; None for a single profile
        """
        first = int(self.timed)

        def report(location: Sequence[str | int], message: str) -> Problem:
            place = [int(part) for part in location[1:]]
            row = rows[place.pop(0)] if location[0] == "rows" and place else self.row
            return row.problem(message, place[0] + first if place else 0)

        before = len(problems)
        for row in rows if self.row.dialect.decimal == "," else ():
            problems += row.mixed_decimals()
        cells = [[cell or None for cell in row.cells[first:]] for row in rows]
        table = QuantityTable(self.columns, cells, report, problems)
        found = read_currents(table, terms, profile)
        return np.empty((0, COLUMNS)) if found is None or len(problems) > before else found
