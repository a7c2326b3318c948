"""Files that are replaced whole: whoever reads sees the old content or the new, never a part."""

from __future__ import annotations

import contextlib
import itertools
import os
import stat
import time
from pathlib import Path

_SUFFIX = ".calm-part"
_STALE = 600.0
"""Age [s] of a part that no running process can still be writing."""

_numbers = itertools.count()


def replace(target: Path, content: bytes, like: os.stat_result | None) -> None:
    """Write beside a file, then take its place; it outlasts a loss of power where that can be had.

    Parameters
    ----------
    like : whose owner, where that is allowed, and permissions it gets

    Raises
    ------
    OSError, ValueError
        It cannot be written, or what is there is no regular file; that is untouched.
    """
    if target.exists() and not target.is_file():
        raise ValueError("it is not a regular file")
    part = target.with_name(f".{target.name}.{os.getpid()}-{next(_numbers)}{_SUFFIX}")
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(descriptor)
        if like is not None:
            _give(part, like)
        os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise
    _settle(target.parent)


def lost(before: os.stat_result | None, after: os.stat_result | None) -> str:
    """What a file could not take over from the one that it replaced; empty as a rule."""
    if before is None or after is None:
        return ""
    told = []
    if (before.st_uid, before.st_gid) != (after.st_uid, after.st_gid):
        told.append("its owner or group could not be kept")
    if before.st_nlink > 1:
        told.append("its other hard links keep the old text")
    return "; ".join(told)


def sweep(target: Path) -> None:
    """Remove parts that a killed process left beside a file."""
    with contextlib.suppress(OSError):
        for part in target.parent.iterdir():
            about = part.name.startswith((f".{target.name}.", f"..{target.name}."))
            ours = about and part.suffix == _SUFFIX
            if ours and time.time() - part.stat().st_mtime > _STALE:
                part.unlink()


def status(path: Path) -> os.stat_result | None:
    """What the system says of a file; None where it is not there."""
    try:
        return path.stat()
    except (OSError, ValueError):
        return None


def _give(part: Path, like: os.stat_result) -> None:
    """Owner and group apart: who may not give the one away may give the other."""
    for owner in ((-1, like.st_gid), (like.st_uid, -1)):
        with contextlib.suppress(OSError, AttributeError):
            os.chown(part, *owner)
    os.chmod(part, stat.S_IMODE(like.st_mode))


def _settle(folder: Path) -> None:
    """Have a new name in a folder outlast a loss of power."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
