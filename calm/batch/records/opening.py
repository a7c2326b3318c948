"""Which kind of record a file is."""

from __future__ import annotations

from pathlib import Path

from calm.batch.records.arrays import ArrayRecord
from calm.batch.records.choice import Period
from calm.batch.records.csv import CsvRecord
from calm.batch.records.record import Record
from calm.errors import InputError, Problem
from calm.files.current_file import holds_arrays
from calm.files.current_place import Place
from calm.files.current_terms import Terms


def open_record(
    path: Path,
    *,
    seabed: float,
    at: Place | None = None,
    declination: float | None = None,
    time: Period | None = None,
    every: int = 1,
) -> Record:
    """A record in NetCDF, in zarr, or in CSV.

    Parameters
    ----------
    seabed : depth of the water [m], where heights above the seabed begin
    at : latitude and longitude whose column is wanted, where there are several
    declination : turns what the record says is relative to magnetic north [degrees], east positive
    time : first and last time, see `parse_period`
    every : take one profile in so many

    Raises
    ------
    InputError
        It cannot be understood: why, and what it holds.
    UsageError
        No profile of it is asked for.
    """
    if not path.exists():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not (path.is_file() or path.is_dir()):
        raise InputError([Problem(str(path), 0, 0, "is not a regular file")])
    terms = Terms(water_depth=seabed, place=at, declination=declination)
    if holds_arrays(path):
        return ArrayRecord(path, terms, time, every)
    return CsvRecord(path, terms, time, every)
