"""Files and folders of reports: looked at before anything is solved, and whole or not there."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Mapping
from pathlib import Path

from calm.errors import UsageError
from calm.whole_file import put

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
            raise UsageError(
                f"cannot write {folder}: {nearest} is not a folder; a folder is needed"
            )
        if not os.access(nearest, os.W_OK | os.X_OK):
            raise UsageError(f"cannot write {folder}: permission denied in {nearest}")
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror}") from None


def write_report(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write the files of a report as a set, making the folder where it is missing.

    All are written under temporary names before the first takes its place. Where one cannot take
    it, or the program is interrupted meanwhile, the report that was there stands again, whole.

    Parameters
    ----------
    files : mapping
        Of the name in the folder to the content.

    Raises
    ------
    UsageError
        The system refuses: which file, and why. No temporary file is left behind.
    """
    parts = {name: folder / f".{name}-{os.getpid()}.part" for name in files}
    kept = {name: folder / f".{name}-{os.getpid()}.old" for name in files}
    target, made = folder, not folder.exists()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            target = folder / name
            if target.is_dir():
                raise IsADirectoryError(None, "it is a folder")
            parts[name].write_bytes(content)
        try:
            for name in files:
                target = folder / name
                if os.path.lexists(target):
                    os.replace(target, kept[name])
                os.replace(parts[name], target)
        except BaseException:
            _restore(folder, parts, kept)
            raise
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}") from None
    finally:
        for path in (*parts.values(), *kept.values()):
            with contextlib.suppress(OSError):
                path.unlink()
        if made:
            with contextlib.suppress(OSError):
                folder.rmdir()  # which the system does only where nothing was written


def _restore(folder: Path, parts: Mapping[str, Path], kept: Mapping[str, Path]) -> None:
    """Take away the new files that have taken their place, and put the old ones back."""
    for name, part in parts.items():
        if not part.exists():
            (folder / name).unlink(missing_ok=True)
        if os.path.lexists(kept[name]):
            os.replace(kept[name], folder / name)


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
