"""The file that a person works on, and the copies of what is not saved of it.

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
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from threading import RLock

from calm.errors import CalmError, InputError
from calm.whole_file import GRAIN, decoded, put, read_content, sweep

_UNREADABLE = b"\0"
"""Stands for the content of what is there and cannot be read; no text has it."""

Stamp = tuple[int, int, int]


class NotWritten(CalmError):
    """Say that a file could not be written; what was there before is untouched."""


class WorkingFile:
    """Represent a mooring file that is worked on, and the copy of unsaved work beside it.

    The copy is this session's own; the copies of others are read, and removed
    only where their work was taken over with `adopt`, or is given up.

    Parameters
    ----------
    path : None: it has no name yet; its copy is then kept in the user's state folder
        (`XDG_STATE_HOME`), where also go copies that cannot be written beside the file

    Attributes
    ----------
    unsaved : what `keep` is to keep; None where nothing is unsaved
    """

    def __init__(self, path: str | Path | None) -> None:
        self.path = None if path is None else Path(path)
        self.unsaved: str | None = None
        self._seen: bytes | None = None
        self._looked: Stamp | None = None
        self._differs = False
        self._places = [
            folder / f"{stem}.{os.urandom(4).hex()}{SUFFIX}" for folder, stem in self._folders()
        ]
        self._adopted: Path | None = None
        self._lock = RLock()  # a signal may ask for the copy while it is being removed

    def read(self) -> str:
        """Return the text of the file, with its byte order mark and line breaks.

        InputError: it cannot be read, or is no text.
        """
        assert self.path is not None
        content = read_content(self.path)
        text = decoded(self.path, content)
        self._see(content)
        sweep(Path(os.path.realpath(self.path)).parent)
        return text

    def save(self, text: str) -> str:
        """Write the file; a reader sees the old text or the new, never a part.

        Its permissions stay as they are, and a symbolic link keeps pointing where it did.

        Returns
        -------
        str : what of the file could not be kept, for people; empty as a rule

        Raises
        ------
        NotWritten
            With the reason.
        """
        assert self.path is not None
        content = text.encode()
        target = Path(os.path.realpath(self.path))
        before = _status(target)
        try:
            _replace(target, content, before)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise NotWritten(f"cannot write {self.path}: {reason}") from None
        self._see(content)
        return _lost(before, _status(target))

    @property
    def is_protected(self) -> bool:
        """Return whether the file is there and may not be written."""
        path = self.path
        return path is not None and _status(path) is not None and not os.access(path, os.W_OK)

    @property
    def stamp(self) -> Stamp | None:
        """Return what tells one state of the file on the disk from another; None without a file."""
        status = None if self.path is None else _status(self.path)
        return status and (status.st_mtime_ns, status.st_size, status.st_ino)

    def changed_on_disk(self) -> bool:
        """Return whether the file is another than that last read or saved; it may be gone.

        It is read only where its time or size changed, and not where it is not a regular file.
        """
        if self.path is None:
            return False
        stamp = self.stamp
        if stamp is None or stamp != self._looked:
            self._differs = self._content() != self._seen
            # a file written this lately may be written again without its time telling
            is_old = stamp is not None and time.time() - stamp[0] / 1e9 > GRAIN
            self._looked = stamp if is_old else None
        return self._differs

    def keep(self) -> Path | None:
        """Bring the copy in line with `unsaved`; where it is. For any thread.

        A copy that this session made goes where nothing is unsaved; none but that. NotWritten:
        neither beside the file nor in the state folder.
        """
        with self._lock:
            if self.unsaved is None:
                self._drop(*self._places)
                return None
            return self._keep(self.unsaved)

    def forget(self) -> None:
        """Remove the copy, and that taken over: the work is saved, or given up."""
        with self._lock:
            self.unsaved = None
            self._drop(*self._places, *([self._adopted] if self._adopted else []))
            self._adopted = None

    def left_behind(self) -> KeptWork | None:
        """Return the latest work that no session keeps any more and that is not in the file."""
        content = self._content()
        found = []
        for each in self._copies():
            if each.keeper.is_running:
                continue
            if each.text.encode() != content:
                found.append(each)
            elif each.keeper.is_here:
                self._drop(each.place)
        return max(found, key=lambda each: each.at, default=None)

    def is_open_elsewhere(self) -> bool:
        """Return whether another session that is running has unsaved work of this file."""
        if self.path is None:
            return False
        own = set(self._places)
        return any(each.keeper.is_running and each.place not in own for each in self._copies())

    def is_of_another(self, kept: KeptWork) -> bool:
        """Return whether the file is another than that which the work began with."""
        return self.path is not None and kept.base != _digest(self._content())

    def adopt(self, kept: KeptWork) -> None:
        """Go on with kept work: its copy stays until this is saved or given up.

        A file that is another than the work began with is then `changed_on_disk`.
        """
        self._adopted = kept.place
        if self.is_of_another(kept):
            self._see(_UNREADABLE)

    def discard(self, kept: KeptWork) -> None:
        """Remove a copy whose work is not wanted."""
        self._drop(kept.place)

    def _see(self, content: bytes) -> None:
        self._seen, self._looked = content, None

    def _content(self) -> bytes | None:
        if self.path is None or _status(self.path) is None:
            return None
        try:
            return read_content(self.path)
        except InputError:
            return _UNREADABLE if _status(self.path) else None

    def _folders(self) -> list[tuple[Path, str]]:
        """Return where the copy goes and how its name begins, the best place first."""
        if self.path is None:
            return [(state_folder(), "unnamed")]
        target = Path(os.path.realpath(self.path))
        sign = hashlib.sha256(os.fsencode(target)).hexdigest()[:12]
        # a long name leaves no room for more beside the file
        away = state_folder(), f"{target.name[:40]}-{sign}"
        return [(target.parent, f".{target.name}"), away]

    def _copies(self) -> list[KeptWork]:
        return [each for folder in self._folders() for each in _kept_in(*folder)]

    def _keep(self, text: str) -> Path:
        record = json.dumps(asdict(Keeper.this()) | {"base": _digest(self._seen)})
        content = f"{_BEGIN}{record}\n{text}".encode()
        like = None if self.path is None else _status(self.path)
        reasons = []
        for place in self._places:
            try:
                place.parent.mkdir(parents=True, exist_ok=True)
                _replace(place, content, like)
            except (OSError, ValueError) as error:
                reasons.append(f"{place}: {getattr(error, 'strerror', None) or error}")
            else:
                return place
        raise NotWritten("the work cannot be kept: " + "; ".join(reasons))

    def _drop(self, *places: Path) -> None:
        for place in places:
            with contextlib.suppress(OSError):
                place.unlink()


def state_folder() -> Path:
    """Return where CALM keeps of a user what belongs to no file."""
    state = os.environ.get("XDG_STATE_HOME") or os.path.expanduser("~/.local/state")
    return Path(state) / "calm"


def _replace(target: Path, content: bytes, like: os.stat_result | None) -> None:
    if target.exists() and not target.is_file():
        raise ValueError("it is not a regular file")
    put(target, content, like=like, durable=True)


def _lost(before: os.stat_result | None, after: os.stat_result | None) -> str:
    """Return what a file could not take over from the one that it replaced; empty as a rule."""
    if before is None or after is None:
        return ""
    losses = []
    if (before.st_uid, before.st_gid) != (after.st_uid, after.st_gid):
        losses.append("its owner or group could not be kept")
    if before.st_nlink > 1:
        losses.append("its other hard links keep the old text")
    return "; ".join(losses)


def _status(path: Path) -> os.stat_result | None:
    """Return what the system says of a file; None where it is missing."""
    try:
        return path.stat()
    except (OSError, ValueError):
        return None


SUFFIX = ".calm-autosave"
_BEGIN = "# calm build: not saved; "
_TOKEN = re.compile(r"\.[0-9a-f]{8}" + re.escape(SUFFIX))


@dataclass(frozen=True)
class Keeper:
    """Represent the process that keeps a copy.

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
        """Return the process that asks."""
        return cls(socket.gethostname(), os.getpid(), _started(os.getpid()))

    @property
    def is_here(self) -> bool:
        """Return whether it is, or was, on this machine."""
        return self.host == socket.gethostname()

    @property
    def is_running(self) -> bool:
        """Return whether it is known to be running still; of another machine this is not known.

        A web page has one process, whose sessions follow one another.
        """
        if not self.is_here or os.name != "posix" or sys.platform == "emscripten":
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
class KeptWork:
    """Hold unsaved work as it was found.

    Attributes
    ----------
    place : where it is
    text : of the mooring file
    keeper : whose it is
    base : the `_digest` of what the file held when the work began
    at : when it was kept [s since 1970]
    """

    place: Path
    text: str
    keeper: Keeper
    base: str
    at: float


def _digest(content: bytes | None) -> str:
    """Return a short sign of a content; empty of none."""
    return "" if content is None else hashlib.sha256(content).hexdigest()[:16]


def _kept_in(folder: Path, stem: str) -> Iterator[KeptWork]:
    """Return the copies of a name in a folder; what is no copy is passed over."""
    with contextlib.suppress(OSError):
        for place in sorted(folder.iterdir()):
            ends = place.name.removeprefix(stem)
            if place.name.startswith(stem) and _TOKEN.fullmatch(ends):
                with contextlib.suppress(OSError, ValueError, TypeError, KeyError):
                    yield _read(place)


def _read(place: Path) -> KeptWork:
    status = place.stat()
    if not stat.S_ISREG(status.st_mode):
        raise ValueError("not a regular file")
    first, _, text = place.read_bytes().decode().partition("\n")
    if not first.startswith(_BEGIN):
        raise ValueError("no record")
    record = json.loads(first.removeprefix(_BEGIN))
    keeper = Keeper(str(record["host"]), int(record["process"]), str(record["started"]))
    return KeptWork(place, text, keeper, str(record["base"]), status.st_mtime)


def _started(process: int) -> str:
    """Return when a process began, in ticks since this machine did; empty where that is not known.

    It is not known of one that has ended, though its parent has not asked for that yet.
    """
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except (OSError, ValueError):
        return ""
    # behind the name, which stands in brackets and may hold anything
    values = stat.rpartition(")")[2].split()
    return "" if values[0] in "ZX" else values[19]
