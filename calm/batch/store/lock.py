"""One batch at a time on one result."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from calm.errors import UsageError


def lock_file(folder: Path) -> Path:
    """Of a work folder: beside it, so that the folder can be removed while it is held."""
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
    """Whether the name leads to the file that is open."""
    try:
        return os.path.samestat(os.stat(lock), os.fstat(handle))
    except FileNotFoundError:
        return False
