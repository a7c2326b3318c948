"""A current from a file of measurements or of a model: NetCDF by its first bytes, else CSV."""

from __future__ import annotations

from pathlib import Path

from calm.files.current_csv import read_current_csv
from calm.files.tables import CurrentTable


def read_current_file(
    path: Path, time: str | None, water_depth: float
) -> tuple[CurrentTable, list[str]]:
    """The profile of a file at a time, and what to tell about it.

    Raises
    ------
    InputError
        With the mistakes of the file.
    TimeChoiceError
        The time is not in the file, or is needed to choose one of several.
    """
    with path.open("rb") as file:
        signature = file.read(4)
    if signature == b"\x89HDF" or signature[:3] == b"CDF":
        from calm.files.current_netcdf import read_current_netcdf

        return read_current_netcdf(path, time, water_depth)
    return read_current_csv(path, time)
