"""Files put whole in their place: a reader sees the old content or the new, never a part."""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

UNFINISHED = ".calm-part"
"""How the names of files end that are not in their place yet."""

_LONGEST = 40  # characters of a name that its part repeats: a long one leaves no room for more
_STALE = 600.0  # seconds: no running process is still writing a part of this age
_TOGETHER = 32  # files handed to the disk at once: one by one each waits for a turn of its own


@contextlib.contextmanager
def beside(target: Path) -> Iterator[Path]:
    """Open an empty file beside another; it takes its place once the block ends without an error.

    Raises
    ------
    OSError
        The system refuses; what was there is untouched, and no part is left.
    """
    part = target.with_name(f".{target.name[:_LONGEST]}.{secrets.token_hex(6)}{UNFINISHED}")
    part.touch(exist_ok=False)
    try:
        yield part
        os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


def put(
    target: Path, content: bytes, *, like: os.stat_result | None = None, durable: bool = False
) -> None:
    """Write a file whole; a symbolic link is replaced, so that callers resolve it first.

    Parameters
    ----------
    like : whose owner, where that is allowed, and permissions it gets
    durable : whether it is to outlast a loss of power

    Raises
    ------
    OSError
        The system refuses, e.g. because the disk is full; the old file is then untouched.
    """
    with beside(target) as part:
        part.write_bytes(content)
        if like is not None:
            _give(part, like)
        if durable:
            _flush(part)
    if durable:
        with contextlib.suppress(OSError):
            _flush(target.parent)


def sweep(folder: Path) -> None:
    """Remove the parts that killed processes left in a folder."""
    with contextlib.suppress(OSError):
        for part in folder.glob(f".*{UNFINISHED}"):
            if time.time() - part.stat().st_mtime > _STALE:
                part.unlink()


def flush_to_disk(paths: Iterable[Path]) -> None:
    """Wait until files, and the names in folders, are on the disk itself.

    Raises
    ------
    OSError
        The disk has not taken them.
    """
    with ThreadPoolExecutor(_TOGETHER) as pool:
        for _ in pool.map(_flush, paths):
            pass


def _flush(path: Path) -> None:
    is_folder = path.is_dir()
    try:
        handle = os.open(path, os.O_RDONLY if is_folder else os.O_RDWR)
    except OSError:
        if is_folder:  # a system that opens no folders
            return
        raise
    try:
        os.fsync(handle)
    except OSError:
        if not is_folder:  # not every file system does it for folders
            raise
    finally:
        os.close(handle)


def _give(part: Path, like: os.stat_result) -> None:
    """Owner and group apart: who may not give the one away may give the other."""
    for owner in ((-1, like.st_gid), (like.st_uid, -1)):
        with contextlib.suppress(OSError, AttributeError):
            os.chown(part, *owner)
    os.chmod(part, stat.S_IMODE(like.st_mode))
