"""A current from a CF NetCDF file or a zarr folder: the profile of one time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import CalmError, InputError, Problem
from calm.files.current_dataset import CurrentArrays, understand
from calm.files.current_terms import Terms, too_deep, too_fast
from calm.files.current_variables import UnreadableError
from calm.files.tables import CurrentTable
from calm.files.times import TimeChoiceError, choose_time

if TYPE_CHECKING:
    import xarray as xr

_ZARR = ("zarr.json", ".zgroup", ".zmetadata")


def is_zarr(path: Path) -> bool:
    """Whether a folder is a zarr store."""
    return any((path / name).is_file() for name in _ZARR)


def is_netcdf(path: Path) -> bool:
    """Whether a file is NetCDF, by its first bytes."""
    with path.open("rb") as file:
        signature = file.read(4)
    return signature == b"\x89HDF" or signature[:3] == b"CDF"


def read_current_netcdf(
    path: Path, time: str | None, terms: Terms
) -> tuple[CurrentTable, list[str]]:
    """The profile of a time, and notices; `time` may be None where there is only one.

    Raises
    ------
    InputError
        The file holds no current profile that can be understood.
    TimeChoiceError
        The time is not in the file.
    """
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
        return _profile(current.read(slice(index, index + 1)), terms, notices), notices


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turns what is wrong with a file into an InputError."""
    try:
        yield
    except (CalmError, TimeChoiceError):
        raise
    except UnreadableError as error:
        raise InputError([Problem(str(path), 0, 0, str(error))]) from None
    # Damaged files leave the libraries by exceptions of many kinds.
    except Exception as error:
        kind = "zarr" if path.is_dir() else "NetCDF"
        reason = str(error).partition("\n")[0]
        message = f"cannot be read as {kind}: {reason}"
        raise InputError([Problem(str(path), 0, 0, message)]) from None


def open_current(path: Path) -> xr.Dataset:
    """The dataset of a file, its values read when they are asked for, its times undecoded."""
    import cf_xarray  # noqa: F401  (gives datasets their `cf`)
    import xarray as xr

    if path.is_dir():
        return xr.open_dataset(
            path, engine="zarr", decode_times=False, cache=False, consolidated=False
        )
    with path.open("rb") as file:
        engine = "scipy" if file.read(3) == b"CDF" else "h5netcdf"
    return xr.open_dataset(path, engine=engine, decode_times=False, cache=False)


def _profile(arrays: CurrentArrays, terms: Terms, notices: list[str]) -> CurrentTable:
    """The levels in water that have a value, by depth."""
    import numpy as np

    depth, u, v = (values.ravel() for values in (arrays.depth, arrays.u, arrays.v))
    w = np.zeros_like(u) if arrays.w is None else arrays.w.ravel()
    known = ~np.isnan(u + v + w) & np.isfinite(depth)
    below = known & (depth >= 0)
    _tell(notices, int(np.sum(~known)), "without a value")
    _tell(notices, int(np.sum(known & ~below)), "above the surface")
    if not below.any():
        raise UnreadableError("no level below the surface has a value")
    for level, east, north, up in zip(*(one[below] for one in (depth, u, v, w)), strict=True):
        if reason := too_deep(level):
            raise UnreadableError(f"its {reason}")
        if reason := too_fast(east, north, up, terms.maximum_speed):
            raise UnreadableError(f"its current at {level:g} m, {reason}")
    order = np.argsort(depth[below])
    depth, u, v, w = (values[below][order] for values in (depth, u, v, w))
    if np.any(np.diff(depth) == 0):
        raise UnreadableError("two levels have the same depth")
    return CurrentTable(*(tuple(values.tolist()) for values in (depth, u, v, w)))


def _tell(notices: list[str], count: int, what: str) -> None:
    if count:
        notices.append(f"{count} level{'s' * (count > 1)} {what} left out of the current")
