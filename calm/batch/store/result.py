"""From a store whose blocks are all done to the result: a NetCDF file or a zarr folder."""

from __future__ import annotations

import json
import os
import shutil
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.batch.store.chunks import to_json
from calm.batch.store.disk import settle, write_whole
from calm.batch.store.lock import lock_file
from calm.batch.store.netcdf import write_netcdf
from calm.batch.store.store import IDENTITY, WORK, Flag, Store, refuse_another
from calm.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

ENDINGS = (".nc", ".zarr")
"""Of the results that can be written."""


def store_folder(output: Path) -> Path:
    """Where the work on a result is kept: beside it."""
    return output.with_name(f"{output.name}.part")


def is_finished(output: Path, identity: str) -> bool:
    """Whether a result is there already.

    Raises
    ------
    UsageError
        It is something else, or the result of another input.
    """
    if not output.exists():
        return False
    before = _attributes(output).get(IDENTITY)
    if not isinstance(before, str):
        raise UsageError(f"{output} is there already, and no result of calm batch; it is kept")
    refuse_another(output, before, identity)
    return True


def left_behind(output: Path) -> bool:
    """Whether there is more of the work on a result than the result."""
    folder = store_folder(output)
    emptied = folder.is_dir() and not any(folder.iterdir())
    parts = (folder / WORK, output / WORK, lock_file(folder))
    return emptied or any(part.exists() for part in parts)


def clear(output: Path) -> None:
    """Remove the work on a result, as far as it can be; what tells that it is work goes last."""
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


def finish(store: Store, flags: Mapping[int, Flag], output: Path) -> list[int]:
    """Make the result of a store, on the disk itself.

    It has its name only once it is whole; the memory that it takes is that of one chunk.

    Blocks that are not as they were written are returned: they are missing again, and there is no
    result then.

    Parameters
    ----------
    flags : of the blocks, by their numbers

    Raises
    ------
    OSError
        There is no room for it.
    """
    if output.suffix == ".zarr":
        damaged = sorted({number for _, number, data in store.chunks(flags) if data is None})
        ready = store.folder
    else:
        ready = store.work / output.name
        damaged = write_netcdf(store, flags, ready)
    if damaged:
        for number in damaged:
            store.forget(number)
        return damaged
    if output.suffix == ".zarr":
        _consolidate(store)
        settle(path for path in store.folder.rglob("*") if WORK not in path.parts)
    settle([ready])
    os.replace(ready, output)
    settle([output.parent])
    return []


def _attributes(output: Path) -> dict[str, Any]:
    """Of a result as a whole; none where it is something else."""
    if output.suffix == ".zarr":
        try:
            content: dict[str, Any] = json.loads((output / ".zattrs").read_bytes())
        except (OSError, ValueError):
            return {}
        return content
    import h5py

    try:
        with h5py.File(output, "r") as file:
            return {
                name: value.decode() if isinstance(value, bytes) else value
                for name, value in file.attrs.items()
            }
    except OSError:
        return {}


def _consolidate(store: Store) -> None:
    """Write the metadata of all arrays into one file, which readers ask for first."""
    folder = store.folder
    files = [
        folder / ".zgroup",
        folder / ".zattrs",
        *folder.glob("*/.zarray"),
        *folder.glob("*/.zattrs"),
    ]
    metadata = {
        file.relative_to(folder).as_posix(): json.loads(file.read_bytes()) for file in files
    }
    document: dict[str, Any] = {"zarr_consolidated_format": 1, "metadata": metadata}
    write_whole(folder / ".zmetadata", to_json(document), store.work)
