"""The file that a person works on: saved whole or not at all, and kept where a session ends early.

Nothing here waits or locks, so that a signal handler may keep the work too.
"""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import os
import stat
import time
from pathlib import Path

from calm.errors import CalmError
from calm.files.document import read_text

_MARK = b"\xef\xbb\xbf"
_SUFFIX = ".calm-autosave"
_STALE = 600.0
"""Age [s] of a part that no running process can still be writing."""


class NotWritten(CalmError):
    """A file that could not be written; what was there before is untouched."""


class WorkingFile:
    """A mooring file that is worked on, and the copy of unsaved work beside it.

    Parameters
    ----------
    path : path or None
        None: it has no name yet; its copy is then kept in the user's state folder
        (`XDG_STATE_HOME`), where also go copies that cannot be written beside the file.
    """

    _numbers = itertools.count()

    def __init__(self, path: str | Path | None) -> None:
        self.path = None if path is None else Path(path)
        self._seen = self._content()
        self._own = f"unnamed-{os.getpid()}{_SUFFIX}"
        self._recovered: Path | None = None

    def read(self) -> str:
        """The text of the file, with its byte order mark and line breaks.

        Raises
        ------
        InputError
            It cannot be read, or is no text.
        """
        assert self.path is not None
        text = read_text(self.path)
        self._seen = self._content()
        marked = self._seen is not None and self._seen.startswith(_MARK)
        _sweep(self.path)
        return "\ufeff" + text if marked else text

    def save(self, text: str) -> None:
        """Write the file; a reader sees the old text or the new, never a part.

        Its permissions stay as they are, and a symbolic link keeps pointing where it did.

        Raises
        ------
        NotWritten
            With the reason.
        """
        assert self.path is not None
        content = text.encode()
        try:
            self._replace(Path(os.path.realpath(self.path)), content)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise NotWritten(f"cannot write {self.path}: {reason}") from None
        self._seen = content

    def changed_on_disk(self) -> bool:
        """Whether the file is another than that last read or saved; it may be gone."""
        return self._content() != self._seen

    def autosave(self, text: str) -> Path:
        """Keep unsaved work; where.

        Raises
        ------
        NotWritten
            Neither beside the file nor in the state folder.
        """
        reasons = []
        for place in self._places():
            try:
                place.parent.mkdir(parents=True, exist_ok=True)
                self._replace(place, text.encode(), like=self.path)
            except (OSError, ValueError) as error:
                reasons.append(f"{place}: {getattr(error, 'strerror', None) or error}")
            else:
                return place
        raise NotWritten("the work cannot be kept: " + "; ".join(reasons))

    def recovered(self) -> str | None:
        """Unsaved work of a session that ended early, where it differs from the file."""
        for place in self._left_behind():
            with contextlib.suppress(OSError, UnicodeDecodeError):
                content = place.read_bytes()
                text = content.decode()
                if content != self._content():
                    self._recovered = place
                    return text
        return None

    def forget(self) -> None:
        """Remove the copy: its work is saved, or given up."""
        for place in (*self._places(), self._recovered):
            if place is not None:
                with contextlib.suppress(OSError):
                    place.unlink()
        self._recovered = None

    def _content(self) -> bytes | None:
        if self.path is None:
            return None
        try:
            return self.path.read_bytes()
        except OSError:
            return None

    def _places(self) -> list[Path]:
        """Where the copy goes, the best place first."""
        if self.path is None:
            return [_state_folder() / self._own]
        whole = os.path.realpath(self.path)
        digest = hashlib.sha256(os.fsencode(whole)).hexdigest()[:12]
        beside = self.path.with_name(f".{self.path.name}{_SUFFIX}")
        return [beside, _state_folder() / f"{self.path.name}-{digest}{_SUFFIX}"]

    def _left_behind(self) -> list[Path]:
        """Copies that may hold work of this file, the latest first."""
        if self.path is not None:
            places = self._places()
        else:
            others = _state_folder().glob(f"unnamed-*{_SUFFIX}")
            places = [place for place in others if not _is_running(place.name)]
        dated = []
        for place in places:
            with contextlib.suppress(OSError):
                dated.append((place.stat().st_mtime_ns, place))
        return [place for _, place in sorted(dated, reverse=True)]

    def _replace(self, target: Path, content: bytes, like: Path | None = None) -> None:
        """Write beside the target, then put it in its place."""
        model = _status(target) or (_status(like) if like else None)
        if target.exists() and not target.is_file():
            raise ValueError("it is not a regular file")
        # A signal handler may write while this is being done: no two parts have one name.
        number = next(WorkingFile._numbers)
        part = target.with_name(f".{target.name}.{os.getpid()}-{number}.calm-part")
        descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        try:
            with os.fdopen(descriptor, "wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(descriptor)
            if model is not None:
                with contextlib.suppress(OSError, AttributeError):
                    os.chown(part, model.st_uid, model.st_gid)
                os.chmod(part, stat.S_IMODE(model.st_mode))
            os.replace(part, target)
        except BaseException:
            with contextlib.suppress(OSError):
                part.unlink()
            raise


def _status(path: Path) -> os.stat_result | None:
    try:
        return path.stat()
    except OSError:
        return None


def _state_folder() -> Path:
    state = os.environ.get("XDG_STATE_HOME") or os.path.expanduser("~/.local/state")
    return Path(state) / "calm"


def _is_running(name: str) -> bool:
    """Whether the session that keeps an unnamed copy is still there."""
    number = name.removeprefix("unnamed-").removesuffix(_SUFFIX)
    try:
        os.kill(int(number), 0)
    except ProcessLookupError:
        return False
    except (OSError, ValueError):
        return True
    return True


def _sweep(path: Path) -> None:
    """Remove parts that a killed session left beside a file."""
    target = Path(os.path.realpath(path))
    with contextlib.suppress(OSError):
        for part in target.parent.iterdir():
            about = part.name.startswith((f".{target.name}.", f"..{target.name}."))
            ours = about and part.suffix == ".calm-part"
            if ours and time.time() - part.stat().st_mtime > _STALE:
                part.unlink()
