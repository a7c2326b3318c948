"""From a file, or none, to the running application."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import InputError, UsageError, unknown
from calm.files import Catalogue, read_mooring
from calm.files.editing import Draft, KeptWork, NotWritten, WorkingFile
from calm.tui.session import Session

if TYPE_CHECKING:
    from calm.tui.app import BuildApp

_TURN = 0.001  # seconds
_GRACE = 3
"""Most seconds for an orderly end: a terminal that is stuck takes no output any more."""


def open_session(
    path: Path | None, environment: str | None = None, catalogs: Sequence[Path] = ()
) -> tuple[Session, KeptWork | None]:
    """The session of a file, and work that an earlier session has kept of it and not saved.

    Parameters
    ----------
    path : a file that need not exist yet; None for one without a name

    Raises
    ------
    InputError, UsageError
        The file, an environment file or a catalogue cannot be read; the folder of a new file does
        not exist; the file names no such environment.
    """
    file = WorkingFile(path)
    if path is not None and file.stamp is not None:
        text = file.read()
    else:
        if path is not None and not path.absolute().parent.is_dir():
            raise UsageError(f"cannot write {path}: there is no folder {path.absolute().parent}")
        text = ""
    if not text.strip("\ufeff \t\r\n"):
        text = Draft.empty().text
    session = Session(file, text, environment=environment, catalogs=catalogs)
    _refuse_other_files(session)
    return session, file.left_behind()


def _refuse_other_files(session: Session) -> None:
    """Refuse mistakes in files other than that which is built: they cannot be mended here."""
    Catalogue.load(session.catalogs)
    here, names = session.standing.environment, session.standing.environments
    if (lost := session.standing.lost_environment) is not None:
        what = f"--environment {lost}: neither a file nor an environment of {session.name}"
        raise UsageError(unknown(what, lost, filter(None, names)))
    given = {str(each) for each in session.catalogs}
    if here is not None and here not in names:
        given.add(str(Path(here)))
    if not given:
        return
    draft = Draft.empty() if session.draft.problems else session.draft
    path = session.file.path or session.name
    try:
        read_mooring(
            path, environment=here, catalogs=session.catalogs, text=draft.text, stand_in=True
        )
    except InputError as error:
        wrong = [each for each in error.problems if each.path in given and not each.lacks]
        if wrong:
            raise InputError(wrong) from None


def build(path: Path | None, environment: str | None = None, catalogs: Sequence[Path] = ()) -> int:
    """Open a file in the line builder, until the person leaves it; the exit code of the command.

    Raises
    ------
    InputError, UsageError
        The file cannot be opened.
    NotWritten
        The session was ended, and its unsaved work could not be kept.
    """
    from calm.tui.app import BuildApp

    session, kept = open_session(path, environment, catalogs)
    sys.setswitchinterval(_TURN)  # the worker that solves lets the keys through
    app = BuildApp(session, kept=kept)
    if os.name == "posix":
        for number in (signal.SIGHUP, signal.SIGTERM):
            signal.signal(number, partial(end, app))
    app.run()
    if app.not_kept:
        raise NotWritten(app.not_kept)
    return app.return_code or 0


def end(app: BuildApp, number: int, _frame: object) -> None:
    """Keep the work and leave, the terminal or the process being ended by a signal.

    The loop of the application is not waited for: it may itself wait for a terminal that is gone,
    for ever. A closed terminal needs no restoring, and the process ends at once.
    """
    try:
        app.take_typed()
    finally:  # whatever the screen is at just then
        app.keep_at_the_end()
    signal.signal(number, signal.SIG_DFL)
    if not (app.is_running and os.isatty(0)):
        os.kill(os.getpid(), number)
        return
    signal.alarm(_GRACE)
    asyncio.get_running_loop().call_soon_threadsafe(app.exit, 0)
