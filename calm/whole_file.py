"""Files read whole, and put whole in their place: a reader sees the old content or the new."""

import contextlib
import glob
import os
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Generic, TypeVar

from calm.errors import refused

LARGEST_FILE = 1_000_000
"""Largest text file that is read [bytes]."""

UNFINISHED = ".calm-part"
"""How the names of files end that are not in their place yet."""

_LONGEST = 40  # characters of a name that its part repeats: a long one leaves no room for more
_STALE = 600.0  # seconds: no running process is still writing a part of this age
_TOGETHER = 32  # files handed to the disk at once: one by one each waits for a turn of its own

GRAIN = 2.0
"""A file written this lately may be written again without its time telling [s]."""

T = TypeVar("T")
Stamp = tuple[tuple[str, int, int, int], ...]


@contextlib.contextmanager
def beside(target: Path) -> Iterator[Path]:
    """Open an empty file beside another; it takes its place once the block ends without an error.

    Raises
    ------
    OSError
        The system refuses; what was there is untouched, and no part is left.
    """
    part = target.with_name(f".{target.name[:_LONGEST]}.{os.urandom(6).hex()}{UNFINISHED}")
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


def sweep(folder: Path, name: str = "") -> None:
    """Remove the parts that killed processes left in a folder, of all files or of one."""
    begin = f".{glob.escape(name[:_LONGEST])}." if name else "."
    with contextlib.suppress(OSError):
        for part in folder.glob(f"{begin}*{UNFINISHED}"):
            if time.time() - part.stat().st_mtime > _STALE:
                part.unlink()


def flush_to_disk(paths: Iterable[Path]) -> None:
    """Wait until files, and the names in folders, are on the disk itself.

    Raises
    ------
    OSError
        The disk has not taken them.
    """
    from concurrent.futures import ThreadPoolExecutor

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
    """Give owner and group apart: who may not give the one away may give the other."""
    for owner in ((-1, like.st_gid), (like.st_uid, -1)):
        with contextlib.suppress(OSError, AttributeError):
            os.chown(part, *owner)
    os.chmod(part, stat.S_IMODE(like.st_mode))


def read_text(path: Path, *, largest: int = LARGEST_FILE) -> str:
    """Read a small UTF-8 text file, or raise InputError."""
    return decoded(path, read_content(path, largest=largest)).removeprefix("\ufeff")


def read_content(path: Path, *, largest: int = LARGEST_FILE) -> bytes:
    """Return the bytes of a small regular file, or raise InputError; nothing else is opened."""
    try:
        if path.is_dir():
            raise refused(path, "is a folder; a file is needed")
        if not path.is_file():
            raise refused(path, "is not a regular file" if path.exists() else "no such file")
        if path.stat().st_size > largest:
            megabytes = path.stat().st_size / 1e6
            message = f"is {megabytes:.1f} MB; more than {largest / 1e6:g} MB is not read"
            raise refused(path, message)
        return path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise refused(path, f"cannot be read: {reason}") from None


def decoded(path: Path, content: bytes) -> str:
    """Return the text of a file with its byte order mark, or raise InputError."""
    if b"\0" in content:
        raise refused(path, "is a binary file; text is needed")
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise refused(path, "is not UTF-8 text; save it as UTF-8", line=line) from None


class FileCache(Generic[T]):
    """Keep the last of what was read from files, known by their names, times and sizes."""

    def __init__(self) -> None:
        self._last: tuple[Stamp, T] | None = None

    def of(self, paths: Sequence[Path], read: Callable[[], T]) -> T:
        """Return what `read` makes of files; it is called only where they are others or changed."""
        stamp = _stamp(paths)
        last = self._last
        if stamp is not None and last is not None and last[0] == stamp:
            return last[1]
        value = read()
        self._last = None if stamp is None else (stamp, value)
        return value


def _stamp(paths: Sequence[Path]) -> Stamp | None:
    """Return the names, times and sizes of files; None where they would not show a change."""
    try:
        found = [(str(path), path.stat()) for path in paths]
    except (OSError, ValueError):
        return None
    newest = max((status.st_mtime for _, status in found), default=0.0)
    if time.time() - newest < GRAIN:
        return None
    return tuple((name, each.st_mtime_ns, each.st_size, each.st_ino) for name, each in found)
