"""What was read from files, for as long as these do not change."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Generic, TypeVar

GRAIN = 2.0
"""A file written this lately may be written again without its time telling [s]."""

T = TypeVar("T")
Stamp = tuple[tuple[str, int, int, int], ...]


class Unchanged(Generic[T]):
    """The last of what was read from files, known by their names, times and sizes."""

    def __init__(self) -> None:
        self._last: tuple[Stamp, T] | None = None

    def of(self, paths: Sequence[Path], read: Callable[[], T]) -> T:
        """What `read` returns for files; it is only called where they are others, or changed."""
        stamp = _stamp(paths)
        last = self._last
        if stamp is not None and last is not None and last[0] == stamp:
            return last[1]
        value = read()
        self._last = None if stamp is None else (stamp, value)
        return value


def _stamp(paths: Sequence[Path]) -> Stamp | None:
    """None where it would not show a change."""
    try:
        found = [(str(path), path.stat()) for path in paths]
    except (OSError, ValueError):
        return None
    newest = max((status.st_mtime for _, status in found), default=0.0)
    if time.time() - newest < GRAIN:
        return None
    return tuple((name, each.st_mtime_ns, each.st_size, each.st_ino) for name, each in found)
