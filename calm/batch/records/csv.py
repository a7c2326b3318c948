"""A record in CSV: read once, its numbers kept in a temporary file."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from calm.batch.records.choice import Period, choose_profiles, part
from calm.batch.records.record import RULES, Levels, Record
from calm.batch.records.rows import COLUMNS, Lines, RowReader
from calm.errors import InputError, Problem, UsageError
from calm.files.current_csv import (
    MOST_PROBLEMS,
    CsvHeader,
    abridged,
    is_content,
    read_csv_header,
)
from calm.files.current_terms import Terms
from calm.files.times import TimeChoiceError, parse_time
from calm.physics.line import Floats

AT_ONCE = 50_000
"""Lines that are read together."""

Text = Iterator[tuple[int, str]]


class CsvRecord(Record):
    """A record `time,depth[m],u[m/s],v[m/s]`, the levels of one time in lines that follow.

    Parameters and errors are those of `open_record`; every mistake of the file is reported. The
    numbers stand in a file of the system's temporary folder until the record is closed.
    """

    def __init__(self, path: Path, terms: Terms, period: Period | None, every: int) -> None:
        self._terms = terms
        self._kept = tempfile.TemporaryFile()  # noqa: SIM115 (until it is closed)
        try:
            header = self._read(path)
            self._index, chosen = choose_profiles(self._times, period, every, path)
        except BaseException:
            self._kept.close()
            raise
        self.time = self._times[self._index]
        self.notes = (*chosen, *self._turned, *RULES)
        self.source = {"file": path.name, "columns": ", ".join(header.columns)}

    def _read(self, path: Path) -> CsvHeader:
        """Every profile of the file into the temporary one."""
        try:
            with path.open(encoding="utf-8-sig") as file:
                lines = ((i, line.rstrip("\n")) for i, line in enumerate(file, 1))
                return self._keep(path, (line for line in lines if is_content(line[1])))
        except UnicodeDecodeError:
            raise InputError([Problem(str(path), 0, 0, "is not UTF-8 text")]) from None
        except OSError as error:
            message = f"cannot be read: {error.strerror or error}"
            raise InputError([Problem(str(path), 0, 0, message)]) from None

    def _keep(self, path: Path, lines: Text) -> CsvHeader:
        first = next(lines, None)
        if first is None:
            raise InputError([Problem(str(path), 0, 0, "is empty")])
        header = read_csv_header(path, *first)
        if not header.timed:
            message = "has no column `time`: it is one profile, for `calm run`"
            raise InputError([Problem(str(path), first[0], 1, message)])
        reader = RowReader(header, self._terms)
        problems: list[Problem] = []
        times: list[np.datetime64] = []
        counts: list[int] = []
        for profiles in _gathered(_by_time(lines)):
            for profile in profiles:
                number, line = profile[0]
                try:
                    moment = parse_time(line.partition(",")[0])
                except TimeChoiceError as error:
                    problems.append(Problem(str(path), number, 1, str(error)))
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


def _by_time(lines: Text) -> Iterator[list[tuple[int, str]]]:
    """The lines of every profile: those that follow each other with one time."""
    profile: list[tuple[int, str]] = []
    time = None
    for number, line in lines:
        own = line.partition(",")[0]
        if own != time and profile:
            yield profile
            profile = []
        time = own
        profile.append((number, line))
    if profile:
        yield profile


def _gathered(profiles: Iterator[list[tuple[int, str]]]) -> Iterator[list[Lines]]:
    """So many profiles that they have some `AT_ONCE` lines."""
    gathered: list[Lines] = []
    lines = 0
    for profile in profiles:
        gathered.append(profile)
        lines += len(profile)
        if lines >= AT_ONCE:
            yield gathered
            gathered, lines = [], 0
    if gathered:
        yield gathered


def _refuse(problems: list[Problem], header: CsvHeader, *, at_least: int = 0) -> None:
    """Raise the mistakes where there are more than `at_least`, or where the header has one."""
    unique = sorted(dict.fromkeys(problems), key=lambda one: (one.line, one.column))
    in_header = [problem for problem in unique if problem.line == header.row.number]
    if in_header:
        raise InputError(in_header)
    if len(unique) > at_least:
        raise InputError(abridged(unique))
