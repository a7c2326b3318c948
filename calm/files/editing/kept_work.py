"""Copies of unsaved work, each with a record of the session that keeps it.

A copy is the text itself below a first line, a comment, that shows the host, the process and what
the file held when the work began. No two sessions keep their work under one name.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import socket
import stat
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

SUFFIX = ".calm-autosave"
_BEGIN = "# calm build: not saved; "
_TOKEN = re.compile(r"\.[0-9a-f]{8}" + re.escape(SUFFIX))


@dataclass(frozen=True)
class Keeper:
    """The process that keeps a copy.

    Attributes
    ----------
    host : its machine
    process : its number there
    started : when it began, as that machine counts; empty where this cannot be known
    """

    host: str
    process: int
    started: str

    @classmethod
    def this(cls) -> Keeper:
        """The process that asks."""
        return cls(socket.gethostname(), os.getpid(), _started(os.getpid()))

    @property
    def is_here(self) -> bool:
        """Whether it is, or was, on this machine."""
        return self.host == socket.gethostname()

    @property
    def is_running(self) -> bool:
        """Whether it is known to be running still; of another machine this is not known."""
        if not self.is_here or os.name != "posix":
            return False
        try:
            os.kill(self.process, 0)
        except (ProcessLookupError, OverflowError):
            return False
        except OSError:
            pass  # it is another person's
        # a number is given again, in a container soon
        return self.started == _started(self.process)


@dataclass(frozen=True)
class Kept:
    """Unsaved work as it was found.

    Attributes
    ----------
    place : where it is
    text : of the mooring file
    keeper : whose it is
    base : the `digest` of what the file held when the work began
    at : when it was kept [s since 1970]
    """

    place: Path
    text: str
    keeper: Keeper
    base: str
    at: float


def digest(content: bytes | None) -> str:
    """A short sign of a content; empty of none."""
    return "" if content is None else hashlib.sha256(content).hexdigest()[:16]


def place_of(folder: Path, stem: str) -> Path:
    """A new name for a copy in a folder."""
    return folder / f"{stem}.{os.urandom(4).hex()}{SUFFIX}"


def with_record(text: str, base: str) -> bytes:
    """The content of a copy."""
    record = json.dumps(asdict(Keeper.this()) | {"base": base})
    return f"{_BEGIN}{record}\n{text}".encode()


def kept_in(folder: Path, stem: str) -> Iterator[Kept]:
    """The copies of a name in a folder; what is no copy is passed over."""
    with contextlib.suppress(OSError):
        for place in sorted(folder.iterdir()):
            ends = place.name.removeprefix(stem)
            if place.name.startswith(stem) and _TOKEN.fullmatch(ends):
                with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
                    yield _read(place)


def _read(place: Path) -> Kept:
    status = place.stat()
    if not stat.S_ISREG(status.st_mode):
        raise ValueError("not a regular file")
    first, _, text = place.read_bytes().decode().partition("\n")
    if not first.startswith(_BEGIN):
        raise ValueError("no record")
    record = json.loads(first.removeprefix(_BEGIN))
    keeper = Keeper(str(record["host"]), int(record["process"]), str(record["started"]))
    return Kept(place, text, keeper, str(record["base"]), status.st_mtime)


def _started(process: int) -> str:
    """When a process began, in ticks since this machine did; empty where that is not known.

    It is not known of one that has ended, though its parent has not asked for that yet.
    """
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except (OSError, ValueError):
        return ""
    # behind the name, which stands in brackets and may hold anything
    values = stat.rpartition(")")[2].split()
    return "" if values[0] in "ZX" else values[19]
