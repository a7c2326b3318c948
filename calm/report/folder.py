"""A folder of reports: all of its files appear, or none."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path

from calm.errors import UsageError
from calm.whole_file import beside

REPORT_FILES = ("report.html", "report.pdf", "report.json", "checks.csv", "inventory.csv")
"""What a design check writes in the folder."""


def check_folder(folder: Path) -> None:
    """Refuse a folder in which nothing could be written, before the work for it is done.

    Raises
    ------
    UsageError
        It is no folder, or lies in none; it or the nearest one that exists may not be written.
    """
    try:
        with contextlib.suppress(FileNotFoundError):
            folder.lstat()  # refuses a name that no folder may have
        nearest = folder.absolute()
        while not os.path.lexists(nearest):
            nearest = nearest.parent
        if not nearest.is_dir():
            raise UsageError(f"cannot write {folder}: {nearest} is no folder; a folder is needed")
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise UsageError(f"cannot write {folder}: permission denied in {nearest}")
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror}") from None


def write_report(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a report, making the folder where it is missing.

    All are written under temporary names before the first takes its place, so that a full disk
    leaves the report that was there as it was.

    Parameters
    ----------
    files : mapping
        Of the name in the folder to the content.

    Raises
    ------
    UsageError
        The system refuses: which file, and why. No temporary file is left behind.
    """
    target, made = folder, not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with contextlib.ExitStack() as all_of_them:
            for name, content in files.items():
                target = folder / name
                if target.is_dir():
                    raise IsADirectoryError(None, "it is a folder")
                all_of_them.enter_context(beside(target)).write_bytes(content)
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}") from None
    finally:
        if made:
            with contextlib.suppress(OSError):
                folder.rmdir()  # which the system does only where nothing was written
