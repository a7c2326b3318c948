"""The result of a batch, opened: its labels, its parts and its statuses."""

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
"""What the first component, the free end of the line, is always called besides its own label."""


def open_result(path: Path) -> Dataset:
    """A result of `calm batch`, of which nothing is loaded yet.

    UsageError: it cannot be read.
    """
    import xarray as xr

    with readable(path):
        return xr.open_dataset(path, engine="h5netcdf")


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Says what to do where a finished result cannot be read.

    UsageError: in place of what the libraries raise, whatever that is.
    """
    try:
        yield
    except (UsageError, MemoryError):
        raise
    # damaged files leave the libraries by exceptions of many kinds
    except Exception as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise UsageError(
            f"{path} cannot be read: {reason}; the command that wrote it writes it again"
        ) from None


def labels_of(dataset: Dataset, name: str) -> tuple[str, ...]:
    """The labels of a result, such as `clamp_label`; none where it has no such parts."""
    return tuple(map(str, dataset[name].values)) if name in dataset else ()


def place_of(dataset: Dataset, label: str) -> tuple[str, int]:
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


def status_names(dataset: Dataset) -> tuple[str, ...]:
    """Return what the numbers of `status` in a result mean; the first is 0.

    UsageError: the dataset is no result of `calm batch`.
    """
    attributes = dataset["status"].attrs if "status" in dataset else {}
    names = tuple(str(attributes.get("flag_meanings", "")).split())
    numbers = np.atleast_1d(attributes.get("flag_values", ())).tolist()
    if not names or numbers != list(range(len(names))):
        raise UsageError("this is not a result of calm batch: its `status` has no flag meanings")
    return names


def statuses_of(dataset: Dataset) -> dict[str, int]:
    """Return how many profiles of a result ended with each status that occurs.

    UsageError: the dataset is no result of `calm batch`.
    """
    names = status_names(dataset)
    counts = np.bincount(np.asarray(dataset["status"]), minlength=len(names))
    return {name: count for name, count in zip(names, counts.tolist(), strict=True) if count}
