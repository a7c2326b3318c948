"""Output files: checked before anything is solved, and complete or not there at all."""

from __future__ import annotations

import os
from pathlib import Path

from calm.errors import UsageError
from calm.whole_file import put


def check_destination(path: Path) -> None:
    """Refuse a file that could not be written, before the work for it is done.

    Raises
    ------
    UsageError
        The folder is missing, or the file or its folder may not be written.
    """
    folder = os.path.dirname(os.path.realpath(path))
    if os.path.isdir(path):
        raise UsageError(f"cannot write {path}: it is a folder")
    if not os.path.isdir(folder):
        raise UsageError(f"cannot write {path}: there is no folder {folder}")
    if not os.access(path if os.path.exists(path) else folder, os.W_OK):
        raise UsageError(f"cannot write {path}: permission denied")


def write_file(path: Path, content: bytes) -> None:
    """Write a file whole: a reader sees the old content or the new, never a part.

    A device or a pipe is written as it is, and a symbolic link keeps pointing where it did.

    Raises
    ------
    UsageError
        The system refuses, e.g. because the disk is full; the old file is then untouched.
    """
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            path.write_bytes(content)
        else:
            put(Path(os.path.realpath(path)), content)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None
