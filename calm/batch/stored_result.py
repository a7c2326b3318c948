"""A result of `calm batch`, opened, and where its parts stand in it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError
from calm.suggestions import unknown

if TYPE_CHECKING:
    from xarray import Dataset

TOP = "top"
"""What the first component, the free end of the line, is always called besides its own label."""

_ROWS = 65536  # profiles read at a time
_UNITS = {
    "days": "D", "hours": "h", "minutes": "m", "seconds": "s",
    "milliseconds": "ms", "microseconds": "us", "nanoseconds": "ns",
}  # fmt: skip


class Stored(Protocol):
    """A result: attributes, and arrays by name, which are read as they are sliced.

    An xarray dataset is one.
    """

    @property
    def attrs(self) -> Mapping[Any, Any]: ...

    def __contains__(self, name: object, /) -> bool: ...

    def __getitem__(self, name: str, /) -> Any: ...


@contextmanager
def stored_result(path: Path) -> Iterator[Stored]:
    """A result of `calm batch` as it lies on the disk; quicker there than `open_result`.

    Raises
    ------
    UsageError
        It cannot be read.
    """
    if path.suffix == ".zarr":
        import zarr

        with readable(path):
            group: Any = zarr.open_group(path, mode="r")
        yield group
        return
    import h5netcdf

    with readable(path):
        file: Any = h5netcdf.File(path, "r")
    with file:
        yield file


def open_result(path: Path) -> Dataset:
    """A result of `calm batch`, a .nc file or a .zarr folder, of which nothing is loaded yet.

    Raises
    ------
    UsageError
        It cannot be read.
    """
    import xarray as xr

    with readable(path):
        if path.suffix == ".zarr":
            stored: Dataset = xr.open_zarr(path, chunks=None)
            return stored
        return xr.open_dataset(path, engine="h5netcdf")


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Says what to do where a finished result cannot be read.

    Raises
    ------
    UsageError
        In place of what the libraries raise, whatever that is.
    """
    try:
        yield
    except (UsageError, MemoryError):
        raise
    # damaged files leave the libraries by exceptions of many kinds
    except Exception as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise UsageError(
            f"{path} is finished, and cannot be read: {reason}. Remove it, and the same command "
            "makes it anew"
        ) from None


def attributes_of(path: Path) -> Mapping[str, Any]:
    """Return the attributes of a result; none where it is something else, or cannot be read."""
    if path.suffix == ".zarr":
        try:
            content = json.loads((path / ".zattrs").read_bytes())
        except (OSError, ValueError):
            return {}
        return content if isinstance(content, dict) else {}
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return {
                name: value.decode() if isinstance(value, bytes) else value
                for name, value in file.attrs.items()
            }
    except (OSError, RuntimeError, ValueError):
        return {}


def times_of(dataset: Stored) -> NDArray[np.datetime64]:
    """(n,) of the profiles of a result."""
    time = np.asarray(dataset["time"][...])
    if time.dtype.kind == "M":
        return time.astype("datetime64[ns]", copy=False)
    unit, _, begin = str(dataset["time"].attrs["units"]).partition(" since ")
    since = np.datetime64(begin.replace(" ", "T"), "ns")
    return np.asarray(since + time.astype(f"timedelta64[{_UNITS[unit]}]"))


def labels_of(dataset: Stored, name: str) -> tuple[str, ...]:
    """The labels of a result, such as `clamp_label`; none where it has no such parts."""
    if name not in dataset:
        return ()
    labels = np.asarray(dataset[name][...])
    return tuple(label.decode() if isinstance(label, bytes) else str(label) for label in labels)


def place_of(dataset: Stored, label: str) -> tuple[str, int]:
    """Prefix of the variables of a part of the line in a result, and its column.

    Parameters
    ----------
    label : of a component or a clamp; ``top`` is the first component, whatever else is called so

    Raises
    ------
    UsageError
        No part is called so; the message offers the nearest that is.
    """
    components, clamps = (labels_of(dataset, f"{kind}_label") for kind in ("component", "clamp"))
    if label == TOP:
        return "", 0
    if label in components:
        return "", components.index(label)
    if label in clamps:
        return "clamp_", clamps.index(label)
    parts = [TOP, *components, *clamps]
    raise UsageError(unknown(f"no part of the line is called `{label}`", label, parts))


def status_names(dataset: Stored) -> tuple[str, ...]:
    """Return what the numbers of `status` in a result mean; the first is 0.

    Raises
    ------
    UsageError
        The dataset is no result of `calm batch`.
    """
    attributes = dataset["status"].attrs if "status" in dataset else {}
    names = tuple(str(attributes.get("flag_meanings", "")).split())
    numbers = np.atleast_1d(attributes.get("flag_values", ())).tolist()
    if not names or numbers != list(range(len(names))):
        raise UsageError("this is not a result of calm batch: its `status` has no flag meanings")
    return names


def statuses_of(dataset: Stored) -> dict[str, int]:
    """Return how many profiles of a result ended with each status that occurs.

    Raises
    ------
    UsageError
        The dataset is no result of `calm batch`.
    """
    names, status = status_names(dataset), dataset["status"]
    counts = np.zeros(len(names), np.int64)
    for start in range(0, status.shape[0], _ROWS):
        ended = np.asarray(status[start : start + _ROWS])
        counts += np.bincount(ended, minlength=len(names))
    return {name: count for name, count in zip(names, counts.tolist(), strict=True) if count}
