"""Files that are whole or not there, and that a power cut does not take away."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

TOGETHER = 32
"""Files handed to the disk at once: one by one each waits for a turn of the disk of its own."""

UNFINISHED = ".part"
"""How the names of files end that have not got their own yet."""


def write_whole(path: Path, content: bytes, by_way_of: Path) -> None:
    """Write a file: under another name first, so that it is never seen in part.

    Two that write the same file at once do not meet: the last one stays.

    Parameters
    ----------
    by_way_of : folder for the other name, on the same disk
    """
    temporary = by_way_of / f"{uuid4().hex}{UNFINISHED}"
    try:
        temporary.write_bytes(content)
        os.replace(temporary, path)
    except OSError:
        with suppress(OSError):
            temporary.unlink()
        raise


def settle(paths: Iterable[Path]) -> None:
    """Wait until files, and the names in folders, are on the disk itself.

    Raises
    ------
    OSError
        The disk has not taken them.
    """
    with ThreadPoolExecutor(TOGETHER) as pool:
        for _ in pool.map(_settle, paths):
            pass


def _settle(path: Path) -> None:
    is_folder = stat.S_ISDIR(path.stat().st_mode)
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
