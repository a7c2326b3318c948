"""Start the line builder, with or without a file."""

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
"""Maximum time for an orderly exit [s], since a blocked terminal accepts no output."""


def open_session(
    path: Path | None, environment: str | None = None, catalogs: Sequence[Path] = ()
) -> tuple[Session, KeptWork | None]:
    """Open a session for a file, and return it with any unsaved work of an earlier session.

    The file need not exist; `path` is None for an unnamed file. Raise InputError or UsageError if a
    file cannot be read, a folder is missing, or the environment is unknown.
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
    return session, file.recoverable_work()


def _refuse_other_files(session: Session) -> None:
    """Raise an exception if the environment is unknown, or if another file has mistakes.

    The builder cannot correct mistakes in catalogue files and environment files.
    """
    Catalogue.load(session.catalogs)
    here, names = session.choice.environment, session.choice.environments
    if (lost := session.choice.lost_environment) is not None:
        what = f"--environment {lost} is neither a file nor an environment of {session.name}"
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
    """Run the line builder on a file, and return the exit code of the command.

    Raises
    ------
    InputError, UsageError
        The file cannot be opened.
    NotWritten
        Unsaved work could not be kept on exit.
    """
    from calm.tui.app import BuildApp

    session, kept = open_session(path, environment, catalogs)
    sys.setswitchinterval(_TURN)  # so that the solving worker does not delay keys
    app = BuildApp(session, kept=kept)
    if os.name == "posix":
        for number in (signal.SIGHUP, signal.SIGTERM):
            signal.signal(number, partial(end, app))
    app.run()
    if app.not_kept:
        raise NotWritten(app.not_kept)
    return app.return_code or 0


def end(app: BuildApp, number: int, _frame: object) -> None:
    """Keep unsaved work and quit, after a signal that ends the terminal or the process.

    If the terminal is closed, the process ends without waiting for the event loop, which may hang.
    """
    try:
        app.take_typed()
    finally:  # whatever the state of the screen
        app.save_copy_on_exit()
    signal.signal(number, signal.SIG_DFL)
    if not (app.is_running and os.isatty(0)):
        os.kill(os.getpid(), number)
        return
    signal.alarm(_GRACE)
    asyncio.get_running_loop().call_soon_threadsafe(app.exit, 0)
