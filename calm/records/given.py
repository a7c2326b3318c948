"""Records passed to the Python interface: paths, xarray datasets and pandas tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    Given: TypeAlias = str | Path | Dataset | DataFrame


def is_record(given: Any) -> bool:
    """Return whether a value is a path, a dataset or a table rather than an array of numbers."""
    return isinstance(given, str | Path) or type(given).__name__ in ("Dataset", "DataFrame")


@contextmanager
def as_file(given: Given) -> Iterator[Path]:
    """Yield the path of a record; a dataset or a table is first written to a temporary file."""
    with TemporaryDirectory() as folder:
        yield Path(as_files(given, Path(folder), "record")[0])


def as_files(given: Any, folder: Path, name: str) -> list[str]:
    """Write datasets and tables to a folder, and return the paths of all records.

    A dataset needs the contents of a NetCDF record, and a table the columns of a CSV record. The
    index of a table may hold the times. If `given` is a mapping from labels to records, the texts
    ``LABEL=PATH`` are returned. `name` is the prefix of the file names.

    Raise TypeError if a record is neither a path nor an object of xarray or pandas.
    """
    if isinstance(given, Mapping) and not is_record(given):
        each = [as_files(one, folder, f"{name}-{i}") for i, one in enumerate(given.values())]
        return [f"{label}={path}" for label, (path,) in zip(given, each, strict=True)]
    if isinstance(given, str | Path) or not isinstance(given, Sequence):
        given = [given]
    found: list[str] = []
    for number, one in enumerate(given, start=1):
        if isinstance(one, str | Path):
            found.append(str(one))
        elif hasattr(one, "to_netcdf"):
            found.append(str(folder / f"{name}-{number}.nc"))
            one.to_netcdf(found[-1], engine="h5netcdf")
        elif hasattr(one, "to_csv"):
            found.append(str(folder / f"{name}-{number}.csv"))
            timed = type(one.index).__name__ == "DatetimeIndex"
            one.to_csv(
                found[-1], index=timed, index_label="time", date_format="%Y-%m-%dT%H:%M:%S.%f"
            )
        else:
            raise TypeError(
                f"{name}: {type(one).__name__} is not a path, an xarray object or a pandas object"
            )
    return found
