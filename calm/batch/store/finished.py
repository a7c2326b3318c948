"""One batch at a time on one result, and the result of a store whose blocks are all done."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from calm.batch.store.store import IDENTITY, WORK, Store, refuse_another
from calm.batch.stored_result import attributes_of
from calm.dataset.netcdf import write_netcdf
from calm.errors import UsageError
from calm.whole_file import flush_to_disk

ENDINGS = (".nc", ".zarr")
"""Of the results that can be written."""


def store_folder(output: Path) -> Path:
    """Return where the work on a result is kept: beside it."""
    return output.with_name(f"{output.name}.part")


def is_finished(output: Path, identity: str) -> bool:
    """Return whether a result is there already.

    Raises
    ------
    UsageError
        It is something else, or the result of another input.
    """
    if not output.exists():
        return False
    before = attributes_of(output).get(IDENTITY)
    if not isinstance(before, str):
        raise UsageError(
            f"{output} is there already, and is not a result of calm batch that can be read. "
            "It is kept. "
            "Give another name to the result, or remove it"
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

    Parameters
    ----------
    tell : called where the file system has no locks

    Raises
    ------
    UsageError
        Another batch holds it.
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
                    f"{folder.parent} has no locks: nothing would stop a second calm batch "
                    "from working on the same result"
                )
                return handle
            if _is_still(lock, handle):
                return handle
        except BlockingIOError:
            os.close(handle)
            raise UsageError(f"another calm batch is at work on {folder}") from None
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)  # its last holder has removed it meanwhile


def _has_lock(handle: int) -> bool:
    """Lock an open file; whether there is such a thing.

    Raises
    ------
    BlockingIOError
        Somebody else has it.
    """
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
