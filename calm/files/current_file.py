"""A current from a file of measurements or of a model: NetCDF by its first bytes, zarr, or CSV."""

from __future__ import annotations

from pathlib import Path

from calm.errors import InputError, Problem
from calm.files.current_csv import read_current_csv
from calm.files.current_netcdf import is_netcdf, is_zarr, read_current_netcdf
from calm.files.current_terms import Terms
from calm.files.tables import CurrentTable


def read_current_file(path: Path, time: str | None, terms: Terms) -> tuple[CurrentTable, list[str]]:
    """The profile of a file at a time, and what to report about it.

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file, or is needed to choose one of several.
    """
    if holds_arrays(path):
        return read_current_netcdf(path, time, terms)
    return read_current_csv(path, time, terms)


def holds_arrays(path: Path) -> bool:
    """Whether a file is NetCDF or a folder zarr; any other file is taken as CSV.

    Raises
    ------
    InputError
        It is a folder of something else.
    """
    if not path.is_dir():
        return is_netcdf(path)
    if not is_zarr(path):
        message = "is a folder, and not a zarr store; join its files into one first"
        raise InputError([Problem(str(path), 0, 0, message)])
    return True
