"""A current from a file of measurements or of a model: NetCDF by its first bytes, zarr, or CSV."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC
from pathlib import Path

import numpy as np

from calm.errors import InputError, Problem, refused
from calm.records import current_terms
from calm.records.cf_files import UnreadableError, is_dataset, open_current, reading
from calm.records.current_dataset import ArrayRecord, CurrentArrays, understand
from calm.records.current_terms import Terms, TimeChoiceError, choose_time, current_notices
from calm.records.delimited import CellRow, abridged, read_table
from calm.records.profile_tables import CurrentTable, turned_notices
from calm.records.record import Period, Record
from calm.records.record_csv import EXAMPLE, CsvRecord, CurrentHeader, comment_notices
from calm.records.water_column import Place

_ZARR = ("zarr.json", ".zgroup", ".zmetadata")

_BLOCK = 10_000


def read_current_file(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    """Return the profile of a file at a time, and what to report about it.

    Parameters
    ----------
    path : CSV, NetCDF or zarr
    time : in ISO 8601; None where there is only one
    terms : how the current is to be taken

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file, or is needed to choose one of several.
    """
    read = _from_arrays if holds_arrays(path) else _from_text
    table, notices = read(path, time, terms)
    return (table if time is None else replace(table, record=(path, terms))), notices


def strongest_of(path: Path, terms: Terms) -> float:
    """Return the greatest horizontal speed of a record at any time and depth [m/s]."""
    strongest = 0.0
    with (ArrayRecord if holds_arrays(path) else CsvRecord)(path, terms, None, 1) as record:
        for start in range(0, record.count, _BLOCK):
            _, u, v, _ = record.profiles(start, min(start + _BLOCK, record.count))
            strongest = max(strongest, float(np.nanmax(np.hypot(u, v), initial=0.0)))
    return strongest


def open_record(
    path: Path,
    *,
    seabed: float,
    at: Place | None = None,
    declination: float | None = None,
    time: Period | None = None,
    every: int = 1,
    on_the_line: bool = False,
) -> Record:
    """Return a record in NetCDF, in zarr, or in CSV.

    Parameters
    ----------
    seabed : depth of the water [m], where heights above the seabed begin
    at : latitude and longitude whose column is wanted, where there are several
    declination : turns what the record says is relative to magnetic north [degrees], east positive
    time : first and last time, see `parse_period`
    every : take one profile in so many
    on_the_line : see `Terms`

    Raises
    ------
    InputError
        It cannot be understood: why, and what it holds.
    UsageError
        No profile of it is asked for.
    """
    if not path.exists():
        raise refused(path, "no such file")
    if not (path.is_file() or path.is_dir()):
        raise refused(path, "is not a regular file")
    terms = Terms(seabed, at, declination, on_the_line=on_the_line)
    if holds_arrays(path):
        return ArrayRecord(path, terms, time, every)
    return CsvRecord(path, terms, time, every)


def holds_arrays(path: Path) -> bool:
    """Return whether a file is NetCDF or text of one instrument, or a folder zarr; others are CSV.

    InputError: it is a folder of something else.
    """
    if not path.is_dir():
        return is_dataset(path)
    if not any((path / name).is_file() for name in _ZARR):
        raise refused(path, "is a folder, and not a zarr store; join its files into one first")
    return True


def _from_arrays(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    with reading(path), open_current(path) as dataset:
        current = understand(dataset, terms)
        notices = [*current.notices, *current.turned]
        index = 0
        if current.times is not None:
            seconds = current.times.astype("datetime64[us]").tolist()
            moments = [moment.replace(tzinfo=UTC) for moment in seconds]
            index, notice = choose_time(moments, time)
            notices = [*([notice] if notice else []), *notices]
        elif time is not None:
            raise TimeChoiceError("the file has no times")
        chosen = slice(index, index + 1)
        table = _profile(current.read(chosen), terms, notices)
        return table, [*notices, *current.remarks(chosen)]


def _profile(arrays: CurrentArrays, terms: Terms, notices: list[str]) -> CurrentTable:
    """Return the levels in water that have a value, by depth."""
    depth, u, v = (values.ravel() for values in (arrays.depth, arrays.u, arrays.v))
    w = np.zeros_like(u) if arrays.w is None else arrays.w.ravel()
    known = ~np.isnan(u + v + w) & np.isfinite(depth)
    below = known & (depth >= 0)
    for left, what in ((~known, "without a value"), (known & ~below, "above the surface")):
        if count := int(left.sum()):
            notices.append(f"{count} level{'s' * (count > 1)} {what} left out of the current")
    if not below.any():
        raise UnreadableError("no level below the surface has a value")
    for level, east, north, up in zip(*(one[below] for one in (depth, u, v, w)), strict=True):
        if reason := current_terms.too_deep(level):
            raise UnreadableError(f"its {reason}")
        if reason := current_terms.too_fast(east, north, up, terms.maximum_speed):
            raise UnreadableError(f"its current at {level:g} m, {reason}")
    order = np.argsort(depth[below])
    levels, *speeds = (tuple(values[below][order].tolist()) for values in (depth, u, v, w))
    if np.any(np.diff(levels) == 0):
        raise UnreadableError("two levels have the same depth")
    return CurrentTable(levels, speeds[0], speeds[1], speeds[2])


def _from_text(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    table = read_table(path, EXAMPLE)
    header, rows = CurrentHeader(path, table.header), list(table.rows)
    notices: list[str] = []
    if header.timed:
        rows, notices = _rows_of(rows, time, path)
        known = [rows[i] for i in header.known(rows)]
        if rows and not known:
            raise refused(path, "no level has a value", line=rows[0].number)
        if left_out := len(rows) - len(known):
            levels = f"{left_out} level{'s' * (left_out > 1)}"
            notices.append(f"{levels} without a value left out of the current")
        rows = known
    elif time is not None:
        raise TimeChoiceError("the file has no column `time`")
    problems: list[Problem] = []
    depth, u, v, w = header.currents(rows, problems, terms).T
    if problems:
        raise InputError(abridged(problems))
    notices += [*comment_notices(path, header), *turned_notices(header.columns, terms)]
    notices += current_notices((depth, u[np.newaxis], v[np.newaxis]), None, terms.water_depth)
    return CurrentTable(*(tuple(each.tolist()) for each in (depth, u, v, w))), notices


def _rows_of(rows: list[CellRow], time: str | None, path: Path) -> tuple[list[CellRow], list[str]]:
    """Return the rows of the time nearest to the one wanted, and the notice that says so."""
    problems = []
    moments = []
    for row in rows:
        try:
            moments.append(current_terms.parse_time(row.cells[0]))
        except TimeChoiceError as error:
            problems.append(Problem(str(path), row.number, row.column(0), str(error)))
    if problems:
        raise InputError(abridged(problems))
    times = sorted(set(moments))
    index, notice = choose_time(times, time)
    chosen = [row for row, moment in zip(rows, moments, strict=True) if moment == times[index]]
    return chosen, [notice] if notice else []
