"""One batch at a time on one result: made of a store whose blocks are all done, and opened."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.batch.work_store import IDENTITY, WORK, Store, refuse_another
from calm.dataset.netcdf import write_netcdf
from calm.errors import UsageError, unknown
from calm.whole_file import flush_to_disk

if TYPE_CHECKING:
    from xarray import Dataset

ENDINGS = (".nc", ".zarr")
"""Of the results that can be written."""


def store_folder(output: Path) -> Path:
    """Return where the work on a result is kept: beside it."""
    return output.with_name(f"{output.name}.part")


def is_finished(output: Path, identity: str) -> bool:
    """Return whether a result is there already.

    UsageError: it is something else, or the result of another input.
    """
    if not output.exists():
        return False
    before = attributes_of(output).get(IDENTITY)
    if not isinstance(before, str):
        raise UsageError(
            f"{output} exists already and is not a readable result of calm batch. It is kept: "
            "give the result another name, or remove it"
        )
    refuse_another(output, before, identity)
    return True


def left_behind(output: Path) -> bool:
    """Return whether there is more of the work on a result than the result."""
    folder = store_folder(output)
    emptied = folder.is_dir() and not any(folder.iterdir())
    parts = (folder / WORK, output / WORK, lock_file(folder))
    return emptied or any(part.exists() for part in parts)


def clear(output: Path) -> None:
    """Remove the work on a result, as far as it can be; what marks it as work goes last."""
    folder = store_folder(output)
    if (folder / WORK).is_dir():
        with suppress(OSError):
            for path in folder.iterdir():
                if path.is_dir() and path.name != WORK:
                    shutil.rmtree(path, ignore_errors=True)
                elif path.name != WORK:
                    path.unlink(missing_ok=True)
        shutil.rmtree(folder / WORK, ignore_errors=True)
    with suppress(OSError):
        folder.rmdir()
    if output.is_dir():
        shutil.rmtree(output / WORK, ignore_errors=True)


def finish(store: Store, output: Path, check: Callable[[], None]) -> list[int]:
    """Make the result of a store, on the disk itself; it has its name only once it is whole.

    Blocks that are not as they were written are returned: they are missing again, and there is no
    result then.

    Parameters
    ----------
    check : called now and then; what it raises ends the making

    Raises
    ------
    OSError
        There is no room for it.
    """
    damaged = store.forget_damaged(check)
    if damaged:
        return damaged
    if output.suffix == ".zarr":
        ready = store.folder
        flush_to_disk(path for path in store.folder.rglob("*") if WORK not in path.parts)
    else:
        ready = store.work / output.name
        write_netcdf(store.layout, store.block, store.chunks(), ready, check)
    flush_to_disk([ready])
    os.replace(ready, output)
    flush_to_disk([output.parent])
    return []


def lock_file(folder: Path) -> Path:
    """Return the lock of a work folder, beside it: the folder may go while the lock is held."""
    return folder.with_name(f"{folder.name}.lock")


@contextmanager
def locked(folder: Path, tell: Callable[[str], None]) -> Iterator[None]:
    """Hold the lock of a work folder, which ends with the process, however that ends.

    Where the file system has no locks, that is told. UsageError: another batch holds it.
    """
    lock = lock_file(folder)
    handle = _held(lock, folder, tell)
    try:
        yield
    finally:
        if sys.platform == "win32":  # where what is open cannot be removed
            os.close(handle)
            handle = -1
        with suppress(OSError):
            lock.unlink()
        if handle >= 0:
            os.close(handle)


def _held(lock: Path, folder: Path, tell: Callable[[str], None]) -> int:
    while True:
        handle = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            if not _has_lock(handle):
                tell(
                    f"{folder.parent} does not support file locks: nothing would stop a second "
                    "calm batch from working on the same result"
                )
                return handle
            if _is_still(lock, handle):
                return handle
        except BlockingIOError:
            os.close(handle)
            raise UsageError(f"another calm batch is working on {folder}") from None
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)  # its last holder has removed it meanwhile


def _has_lock(handle: int) -> bool:
    """Lock an open file; whether there is such a thing. BlockingIOError: somebody else has it."""
    if sys.platform == "win32":
        return False
    import fcntl

    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:
        return False
    return True


def _is_still(lock: Path, handle: int) -> bool:
    """Return whether the name leads to the file that is open."""
    try:
        return os.path.samestat(os.stat(lock), os.fstat(handle))
    except FileNotFoundError:
        return False


TOP = "top"
"""What the first component, the free end of the line, is always called besides its own label."""


def open_result(path: Path) -> Dataset:
    """A result of `calm batch`, a .nc file or a .zarr folder, of which nothing is loaded yet.

    UsageError: it cannot be read.
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
            f"{path} is finished but cannot be read: {reason}. Remove it; the same command "
            "writes it again"
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
