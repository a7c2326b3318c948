"""The file that a user is editing, and backup copies of its unsaved text.

The first line of a backup copy is a comment with host, process and a digest of the original file.
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
"""Stand-in for the content of an existing but unreadable file; no text file contains it."""

Stamp = tuple[int, int, int]


class NotWritten(CalmError):
    """A file could not be written; its previous content is unchanged."""


class WorkingFile:
    """A mooring file that is being edited, and the backup copy of its unsaved text.

    Attributes
    ----------
    path : path of the file; None if the file has no name yet
    unsaved : the text that `keep` saves; None if nothing is unsaved
    """

    def __init__(self, path: str | Path | None) -> None:
        self.path = None if path is None else Path(path)
        self.unsaved: str | None = None
        self._seen: bytes | None = None
        self._looked: Stamp | None = None
        self._differs = False
        self._places = [
            folder / f"{stem}.{os.urandom(4).hex()}{SUFFIX}"
            for folder, stem in self._copy_folders()
        ]
        self._adopted: Path | None = None
        self._lock = RLock()  # a signal handler may use the copy while it is being removed

    def read(self) -> str:
        """Read the text of the file, with its byte-order mark and line breaks.

        Raises
        ------
        InputError
            The file cannot be read or is not text.
        """
        assert self.path is not None
        content = read_content(self.path)
        text = decoded(self.path, content)
        self._remember(content)
        sweep(Path(os.path.realpath(self.path)).parent)
        return text

    def save(self, text: str) -> str:
        """Write the file, so that other programs never see a partly written text.

        Permissions and symbolic links are kept.

        Returns
        -------
        str
            Message about attributes of the file that could not be kept, usually empty.

        Raises
        ------
        NotWritten
            The file cannot be written.
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
        self._remember(content)
        return _lost_attributes(before, _status(target))

    @property
    def is_protected(self) -> bool:
        """True if the file exists and may not be written."""
        path = self.path
        return path is not None and _status(path) is not None and not os.access(path, os.W_OK)

    @property
    def stamp(self) -> Stamp | None:
        """Time, size and inode of the file, to detect changes; None if there is no file on disk."""
        status = None if self.path is None else _status(self.path)
        return status and (status.st_mtime_ns, status.st_size, status.st_ino)

    def changed_on_disk(self) -> bool:
        """True if the file has changed, or was removed, since it was last read or saved.

        The content is compared only if the time, size or inode of the file has changed.
        """
        if self.path is None:
            return False
        stamp = self.stamp
        if stamp is None or stamp != self._looked:
            self._differs = self._content() != self._seen
            # a file written this recently may be changed again within the resolution of its time
            is_old = stamp is not None and time.time() - stamp[0] / 1e9 > GRAIN
            self._looked = stamp if is_old else None
        return self._differs

    def keep(self) -> Path | None:
        """Write `unsaved` to the backup copy and return the path of the copy.

        If nothing is unsaved, remove the copy and return None. This method is thread-safe.

        Raises
        ------
        NotWritten
            The copy can be written neither next to the file nor in the state folder.
        """
        with self._lock:
            if self.unsaved is None:
                self._drop(*self._places)
                return None
            return self._keep(self.unsaved)

    def forget(self) -> None:
        """Delete the backup copy and any adopted copy, after the work was saved or discarded."""
        with self._lock:
            self.unsaved = None
            self._drop(*self._places, *([self._adopted] if self._adopted else []))
            self._adopted = None

    def recoverable_work(self) -> KeptWork | None:
        """Return the latest unsaved work left by a session that has ended, or None.

        Work that equals the file is ignored, and its copy on this machine is deleted.
        """
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
        """True if another running session has unsaved work on this file."""
        if self.path is None:
            return False
        own = set(self._places)
        return any(each.keeper.is_running and each.place not in own for each in self._copies())

    def is_of_another(self, kept: KeptWork) -> bool:
        """True if the content of the file has changed since the recovered work `kept` began."""
        return self.path is not None and kept.base != _digest(self._content())

    def adopt(self, kept: KeptWork) -> None:
        """Continue with recovered work, whose copy is deleted when the work is saved or discarded.

        If the file has changed since the work began, `changed_on_disk` returns True.
        """
        self._adopted = kept.place
        if self.is_of_another(kept):
            self._remember(_UNREADABLE)

    def discard(self, kept: KeptWork) -> None:
        """Delete the backup copy of work that the user does not want to keep."""
        self._drop(kept.place)

    def _remember(self, content: bytes) -> None:
        self._seen, self._looked = content, None

    def _content(self) -> bytes | None:
        if self.path is None or _status(self.path) is None:
            return None
        try:
            return read_content(self.path)
        except InputError:
            return _UNREADABLE if _status(self.path) else None

    def _copy_folders(self) -> list[tuple[Path, str]]:
        """Return the possible folders of the backup copy, best first.

        With each folder, return the beginning of the name of the copy in this folder.
        """
        if self.path is None:
            return [(state_folder(), "unnamed")]
        target = Path(os.path.realpath(self.path))
        sign = hashlib.sha256(os.fsencode(target)).hexdigest()[:12]
        # in the folder of the file, the extended name may be too long
        away = state_folder(), f"{target.name[:40]}-{sign}"
        return [(target.parent, f".{target.name}"), away]

    def _copies(self) -> list[KeptWork]:
        return [each for folder in self._copy_folders() for each in _kept_in(*folder)]

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
        raise NotWritten("the unsaved work cannot be stored: " + "; ".join(reasons))

    def _drop(self, *places: Path) -> None:
        for place in places:
            with contextlib.suppress(OSError):
                place.unlink()


def state_folder() -> Path:
    """Return the per-user state folder of CALM."""
    state = os.environ.get("XDG_STATE_HOME") or os.path.expanduser("~/.local/state")
    return Path(state) / "calm"


def _replace(target: Path, content: bytes, like: os.stat_result | None) -> None:
    if target.exists() and not target.is_file():
        raise ValueError("the path is not a regular file")
    put(target, content, like=like, durable=True)


def _lost_attributes(before: os.stat_result | None, after: os.stat_result | None) -> str:
    if before is None or after is None:
        return ""
    losses = []
    if (before.st_uid, before.st_gid) != (after.st_uid, after.st_gid):
        losses.append("the owner or group of the file could not be preserved")
    if before.st_nlink > 1:
        losses.append("other hard links to the file keep the old text")
    return "; ".join(losses)


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except (OSError, ValueError):
        return None


SUFFIX = ".calm-autosave"
_BEGIN = "# calm build: not saved; "
_TOKEN = re.compile(r"\.[0-9a-f]{8}" + re.escape(SUFFIX))


@dataclass(frozen=True)
class Keeper:
    """Process that wrote a backup copy.

    Attributes
    ----------
    host : name of the machine
    process : process number
    started : start time of the process in ticks since boot; empty if unknown
    """

    host: str
    process: int
    started: str

    @classmethod
    def this(cls) -> Keeper:
        """Return the current process."""
        return cls(socket.gethostname(), os.getpid(), _start_ticks(os.getpid()))

    @property
    def is_here(self) -> bool:
        """Whether the process runs, or ran, on this machine."""
        return self.host == socket.gethostname()

    @property
    def is_running(self) -> bool:
        """Whether the process is known to be running.

        False for a process on another machine, and in a web browser, where sessions share one
        process.
        """
        if not self.is_here or os.name != "posix" or sys.platform == "emscripten":
            return False
        try:
            os.kill(self.process, 0)
        except (ProcessLookupError, OverflowError):
            return False
        except OSError:
            pass  # the process belongs to another user
        # process numbers are reused; in a container, this happens after a short time
        return self.started == _start_ticks(self.process)


@dataclass(frozen=True)
class KeptWork:
    """Unsaved work found in a backup copy.

    Attributes
    ----------
    place : path of the copy
    keeper : process that wrote the copy
    base : digest of the file when the work began
    at : time of the copy [s since 1970]
    """

    place: Path
    text: str
    keeper: Keeper
    base: str
    at: float


def _digest(content: bytes | None) -> str:
    return "" if content is None else hashlib.sha256(content).hexdigest()[:16]


def _kept_in(folder: Path, stem: str) -> Iterator[KeptWork]:
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


def _start_ticks(process: int) -> str:
    """Start time of a process in ticks since boot; empty if unknown or if the process has ended."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except (OSError, ValueError):
        return ""
    # after the name, which is in brackets and may contain anything
    values = stat.rpartition(")")[2].split()
    # Z or X: the process has ended, although its parent may not have collected the exit status
    return "" if values[0] in "ZX" else values[19]
