"""Read and write whole files, so that a reader sees either the old or the new content."""

import contextlib
import difflib
import glob
import os
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Generic, TypeVar

from calm.errors import refused

LARGEST_FILE = 1_000_000
"""Maximum size of a text file [bytes]."""

UNFINISHED = ".calm-part"
"""Suffix of temporary files that are still being written."""

# characters of the target's name that the temporary name repeats, to limit its length
_LONGEST = 40
_STALE = 600.0  # seconds: no process is still writing an older temporary file
_TOGETHER = 32  # number of files flushed at once, since waiting for each in turn is slow

_ALIKE = 0.75
"""Minimum similarity between a missing file and an existing file that is suggested instead."""

GRAIN = 2.0
"""Resolution of file times [s]; a change within this interval may not change the time of a file."""

T = TypeVar("T")
Stamp = tuple[tuple[str, int, int, int], ...]


@contextlib.contextmanager
def beside(target: Path) -> Iterator[Path]:
    """Context manager for an empty temporary file that replaces the target if the block succeeds.

    Raises OSError if the file could not be written. After any exception, the target is unchanged
    and no temporary file remains.
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
    """Write the content of a whole file; callers must resolve symbolic links first.

    The permissions and, if allowed, the owner are those of the file status `like`. A `durable` file
    survives a loss of power. Raises OSError if the file could not be written; the old file is then
    unchanged.
    """
    with beside(target) as part:
        part.write_bytes(content)
        if like is not None:
            _copy_owner_and_mode(part, like)
        if durable:
            _flush(part)
    if durable:
        with contextlib.suppress(OSError):
            _flush(target.parent)


def sweep(folder: Path, name: str = "") -> None:
    """Delete old temporary files of the file `name` in a folder, or of all files if `name` is
    empty.
    """
    begin = f".{glob.escape(name[:_LONGEST])}." if name else "."
    with contextlib.suppress(OSError):
        for part in folder.glob(f"{begin}*{UNFINISHED}"):
            if time.time() - part.stat().st_mtime > _STALE:
                part.unlink()


def flush_to_disk(paths: Iterable[Path]) -> None:
    """Flush files, and the directory entries of folders, to the disk.

    Raises
    ------
    OSError
        The disk reports an error.
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
        if is_folder:  # a system that cannot open folders
            return
        raise
    try:
        os.fsync(handle)
    except OSError:
        if not is_folder:  # not every file system supports this for folders
            raise
    finally:
        os.close(handle)


def _copy_owner_and_mode(part: Path, like: os.stat_result) -> None:
    # group and owner are set separately, because a user may be allowed to change the group alone
    for owner in ((-1, like.st_gid), (like.st_uid, -1)):
        with contextlib.suppress(OSError, AttributeError):
            os.chown(part, *owner)
    os.chmod(part, stat.S_IMODE(like.st_mode))


def read_text(path: Path, *, largest: int = LARGEST_FILE) -> str:
    """Read a small UTF-8 text file.

    Raises InputError if the file cannot be read, is too large, or is not UTF-8.
    """
    return decoded(path, read_content(path, largest=largest)).removeprefix("\ufeff")


def read_content(path: Path, *, largest: int = LARGEST_FILE) -> bytes:
    """Return the bytes of a small regular file.

    Raises InputError if the path is not a regular file, or if the file is too large or cannot be
    read.
    """
    with _regular(path):
        if path.stat().st_size > largest:
            megabytes = path.stat().st_size / 1e6
            message = f"has a size of {megabytes:.1f} MB; the limit is {largest / 1e6:g} MB"
            raise refused(path, message)
        return path.read_bytes()


def read_head(path: Path, most: int) -> bytes:
    """Return the first `most` bytes of a regular file.

    Raises InputError if the path is not a regular file, or if the file cannot be read.
    """
    with _regular(path), path.open("rb") as file:
        return file.read(most)


@contextlib.contextmanager
def _regular(path: Path) -> Iterator[None]:
    try:
        if path.is_dir():
            raise refused(path, "is a folder; a file is needed")
        if not path.is_file():
            what = "is not a regular file" if path.exists() else no_such_file(path)
            raise refused(path, what)
        yield
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise refused(path, f"cannot be read: {reason}") from None


def no_such_file(path: Path) -> str:
    """Return the message about a missing file, with the most similar file name in the same folder.

    Only files with the same suffix are considered. For .yml, and for a path without a suffix, these
    are the files with the suffix .yaml.
    """
    with contextlib.suppress(OSError, ValueError):
        suffix = {"": ".yaml", ".yml": ".yaml"}.get(path.suffix, path.suffix)
        listed = sorted(name for name in os.listdir(path.parent) if not name.startswith("."))
        names = [name for name in listed if Path(name).suffix == suffix]
        stems = {Path(name).stem.casefold() for name in names}
        alike = difflib.get_close_matches(path.stem.casefold(), stems, 1, _ALIKE)
        found = [path.with_name(name) for name in names if Path(name).stem.casefold() in alike]
        if found and found[0].is_file():
            return f"no such file; did you mean `{found[0]}`?"
    return "no such file"


def decoded(path: Path, content: bytes) -> str:
    """Decode the UTF-8 text of a file, with or without a byte-order mark.

    Raises InputError if the content is not UTF-8.
    """
    if b"\0" in content:
        raise refused(path, "is a binary file; text is needed")
    try:
        return content.decode()
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise refused(path, "is not UTF-8 text; save it as UTF-8", line=line) from None


class FileCache(Generic[T]):
    """Cache of the last value computed from a set of files.

    The key consists of the names, times and sizes of the files.
    """

    def __init__(self) -> None:
        self._last: tuple[Stamp, T] | None = None

    def of(self, paths: Sequence[Path], read: Callable[[], T]) -> T:
        """Return the cached value, or call `read` if `paths` or one of the files has changed."""
        stamp = _stamp(paths)
        last = self._last
        if stamp is not None and last is not None and last[0] == stamp:
            return last[1]
        value = read()
        self._last = None if stamp is None else (stamp, value)
        return value


def _stamp(paths: Sequence[Path]) -> Stamp | None:
    """Return the names, times and sizes of files. Return None if a file is missing, or so recent
    that its time may not reveal a change.
    """
    try:
        found = [(str(path), path.stat()) for path in paths]
    except (OSError, ValueError):
        return None
    newest = max((status.st_mtime for _, status in found), default=0.0)
    if time.time() - newest < GRAIN:
        return None
    return tuple((name, each.st_mtime_ns, each.st_size, each.st_ino) for name, each in found)
