"""From a file, or none, to the running application."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from calm.errors import UsageError
from calm.files.editing import Draft, WorkingFile
from calm.tui.session import Session

_TURN = 0.001  # seconds


def open_session(
    path: Path | None, environment: str | None = None, catalogs: Sequence[Path] = ()
) -> tuple[Session, str | None]:
    """The session of a file, and a text that an earlier run has kept of it and not saved.

    Parameters
    ----------
    path : a file that need not exist yet; None for one without a name

    Raises
    ------
    InputError, UsageError
        The file cannot be read; the folder of a new one does not exist.
    """
    file = WorkingFile(path)
    if path is not None and path.exists():
        text = file.read()
    else:
        if path is not None and not path.absolute().parent.is_dir():
            raise UsageError(f"cannot write {path}: there is no folder {path.absolute().parent}")
        text = Draft.empty().text
    session = Session(file, text, environment=environment, catalogs=catalogs)
    return session, file.recovered()


def build(path: Path | None, environment: str | None = None, catalogs: Sequence[Path] = ()) -> int:
    """Open a file in the line builder, until the person leaves it; the exit code of the command."""
    from calm.report.schematic.text import can_carry
    from calm.tui.app import BuildApp

    session, recovered = open_session(path, environment, catalogs)
    sys.setswitchinterval(_TURN)  # the worker that solves lets the keys through
    plain = not can_carry(getattr(sys.stderr, "encoding", None))
    app = BuildApp(session, recovered=recovered, ascii_only=plain)
    return app.run() or 0
