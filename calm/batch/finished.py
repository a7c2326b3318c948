"""Access to a finished batch result: its labels, its columns and its statuses."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from calm.errors import UsageError, unknown

if TYPE_CHECKING:
    from xarray import Dataset

TOP = "top"
"""Additional name of the first component, the free end of the line."""


def open_result(path: Path) -> Dataset:
    """Open a result of `calm batch` without loading its data.

    Raises UsageError if the result cannot be read.
    """
    import xarray as xr

    with readable(path):
        return xr.open_dataset(path, engine="h5netcdf")


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Context manager for reading a finished result.

    Any exception raised by the libraries becomes a UsageError with a helpful message.
    """
    try:
        yield
    except (UsageError, MemoryError):
        raise
    # libraries raise many kinds of exceptions for damaged files
    except Exception as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise UsageError(
            f"{path} cannot be read: {reason}; repeat the command that created this file"
        ) from None


def labels_of(dataset: Dataset, name: str) -> tuple[str, ...]:
    """Return the labels in a variable of a result, such as `clamp_label`.

    The sequence is empty if the result has no such variable.
    """
    return tuple(map(str, dataset[name].values)) if name in dataset else ()


def place_of(dataset: Dataset, label: str) -> tuple[str, int]:
    """Find the variables and the column of a part of the line in a result.

    Returns the prefix of the variable names, such as ``clamp_``, and the number of the column.

    The label ``top`` selects the first component. Raises UsageError, with the nearest label, if no
    part has the label.
    """
    components, clamps = (labels_of(dataset, f"{kind}_label") for kind in ("component", "clamp"))
    if label == TOP:
        return "", 0
    if label in components:
        return "", components.index(label)
    if label in clamps:
        return "clamp_", clamps.index(label)
    parts = [TOP, *components, *clamps]
    raise UsageError(unknown(f"no part of the line has the label `{label}`", label, parts))


def status_names(dataset: Dataset) -> tuple[str, ...]:
    """Return the names of the statuses in a result; the position in the list is the status number.

    Raises UsageError if the dataset is not a result of `calm batch`.
    """
    attributes = dataset["status"].attrs if "status" in dataset else {}
    names = tuple(str(attributes.get("flag_meanings", "")).split())
    numbers = np.atleast_1d(attributes.get("flag_values", ())).tolist()
    if not names or numbers != list(range(len(names))):
        raise UsageError(
            "this file is not a result of calm batch: its variable `status` has no flag meanings"
        )
    return names


def statuses_of(dataset: Dataset) -> dict[str, int]:
    """Count the profiles of a result by status; statuses without profiles are omitted.

    Raises UsageError if the dataset is not a result of `calm batch`.
    """
    names = status_names(dataset)
    counts = np.bincount(np.asarray(dataset["status"]), minlength=len(names))
    return {name: count for name, count in zip(names, counts.tolist(), strict=True) if count}
