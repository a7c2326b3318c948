"""Saving of the file, with questions on missing names, existing files and external changes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from textual.app import App

from calm.errors import CalmError, InputError
from calm.files import editing, read_mooring
from calm.files.editing.user_state import Presence
from calm.tui.checking import Reading
from calm.tui.dialogs import Answer, Question, Then, choose, enter
from calm.tui.forms import FormField
from calm.tui.screen import DraftScreen
from calm.tui.workspace import Workspace, place_of

_SUFFIX = ".yaml"
_CHANGED = "Another program changed the file; you will be asked when saving"
_GONE = "The file was deleted from the disk; saving writes it again"
_READ_AGAIN = "Reloaded: the file was changed by another program"


class Saving:
    """Saver of the file of a workspace, which detects changes by other programs.

    Questions appear on the screen of `app`. `show_replaced_draft` shows a new text and a message.
    `leave` ends the application.
    """

    def __init__(
        self,
        app: App[Any],
        workspace: Workspace,
        show_replaced_draft: Callable[[str], object],
        leave: Callable[[], object],
    ) -> None:
        self._taken_over, self._leave = show_replaced_draft, leave
        self._app, self._workspace, self._session = app, workspace, workspace.session
        self.presence = Presence()
        self._reported: tuple[object] | None = None  # state on the disk that was reported last

    def save(self, then: Then | None = None) -> None:
        """Save the file, and call `then` after a successful save.

        If the file has no name, the user is asked for a name.
        """
        file = self._session.file
        if file.path is None:
            self.save_as(then)
        elif file.is_protected or (file.stamp is not None and file.changed_on_disk()):
            self._ask_to_overwrite(file.path, then)
        else:
            self._write(self._session.save, then)

    def _write(self, write: Callable[[], str], then: Then | None) -> None:
        try:
            lost = write()
        except (CalmError, OSError) as error:
            # drop the known folder, so that the reason is not cut off
            folder = "" if self._session.file.path is None else f"{self._session.file.path.parent}/"
            self._workspace.tell(f"Not saved: {str(error).replace(folder, '')}", wrong=True)
            return
        self.presence.announce(self._session.file.path)
        wrong = self._first_mistake()
        but = "; ".join(filter(None, [lost, wrong]))
        message = f"{self._session.name} saved" + (f", but {but}" if but else "")
        self._workspace.tell(message, wrong=bool(wrong))
        self._workspace.edited()  # relative names may now refer to other files
        if then is not None and not wrong:
            then()

    def _first_mistake(self) -> str:
        session = self._session
        path = session.file.path or Path(session.name)
        try:
            read_mooring(path, catalogs=session.catalogs, text=session.draft.text, stand_in=True)
        except InputError as error:
            # missing parts of the line are no mistakes
            found = [each for each in error.problems if not each.lacks]
            if found:
                place = place_of(found[0], path)
                mistake = ", ".join(filter(None, [place, found[0].message]))
                return f"the file cannot be opened: {mistake}"
        return ""

    def save_as(self, then: Then | None = None, begin: Path | None = None) -> None:
        """Ask for a new file name, suggesting `begin`, and save the file under this name."""
        path = self._session.file.path

        def take(texts: dict[str, str]) -> None:
            chosen = chosen_path(texts["path"])
            if path is not None and os.path.realpath(chosen) == os.path.realpath(path):
                self.save(then)
            elif chosen.exists():
                self._ask_to_overwrite(chosen, then)
            else:
                self._write(lambda: self._session.save_as(chosen), then)

        initial = str(begin or path or "")
        fields = [
            FormField(
                "path", "File", initial, _check_file_name, placeholder="e.g. iroise-2026.yaml"
            )
        ]
        text = f"Relative to {Path.cwd()}."
        enter(self._app, "Save as", text, fields, take)

    def _ask_to_overwrite(self, path: Path, then: Then | None) -> None:
        session, file = self._session, self._session.file
        is_own, stamp = path == file.path, file.stamp
        is_changed = is_own and stamp is not None and file.changed_on_disk()
        write = session.save if is_own else lambda: session.save_as(path)
        mine = " your line" if is_changed else ""
        overwrite = "overwrite it" + (mine and f" with{mine}")
        other = partial(self.save_as, then, _free_name(path))
        answers = [
            Answer("o", overwrite, lambda: self._write(write, then)),
            Answer("n", f"save{mine} under another name", other),
        ]
        title = f"{path.name} is write-protected" if is_own else f"{path.name} exists already"
        protected = not is_own and not os.access(path, os.W_OK)
        text = f"{path}{' (write-protected)' if protected else ''}"
        if is_changed and stamp is not None:
            theirs = "load the file from the disk; undo restores your line"
            answers.append(Answer("t", theirs, self._reload))
            title = f"{path.name} was changed by another program"
            text = "The file on the disk differs from your line. "
            text += f"It was written {moment(stamp[0] / 1e9)}."
        choose(self._app, Question(title, text, answers))

    # the file on the disk

    def check_external_change(self) -> None:
        """Reload the file if another program has changed it.

        If there is unsaved work, show a warning instead.
        """
        session, screen = self._session, next(reversed(self._app.screen_stack), None)
        if not isinstance(screen, DraftScreen):
            return  # try again later: a question is open, or the application is ending
        if not session.file.changed_on_disk():
            self._reported = None
            return
        now = (session.file.stamp,)
        is_new, self._reported = now != self._reported, now
        if now[0] is None:
            if is_new:
                session.history.saved("")
                self._workspace.tell(_GONE, wrong=True)
                self._workspace.edited()  # back up the draft, as after every change
        elif not (session.changed or screen.is_typing):
            self._reload(quietly=not is_new)
        elif is_new:
            self._workspace.tell(_CHANGED, wrong=True)

    def _reload(self, *, quietly: bool = False) -> None:
        try:
            text = self._session.file.read()
        except (CalmError, OSError) as error:
            if not quietly:
                self._workspace.tell(f"The file can no longer be read: {error}", wrong=True)
            return
        self._session.write(text, "reload the file")
        self._session.history.saved()
        self._taken_over(_READ_AGAIN)

    # work of an earlier run

    def offer(self, kept: editing.KeptWork, go_on: Callable[[], object]) -> None:
        """Offer to recover unsaved work; show the time of the work, and whether the file is newer.

        The user must confirm discarding the work, because discarding cannot be undone.
        """
        app, session, keeper = self._app, self._session, kept.keeper

        def recover() -> None:
            session.recover(kept)
            self._taken_over("Recovered; save to keep it")

        def throw_away() -> None:
            session.file.discard(kept)
            go_on()

        whose = "" if keeper.is_here else f" on {keeper.host}, where the file may still be open"
        text = f"An earlier run ended before {session.name} was saved. Unsaved work was stored "
        text += f"{moment(kept.at)}{whose}."
        if session.file.is_of_another(kept):
            stamp = session.file.stamp
            text += (
                " The file was deleted after that work began: saving writes it again."
                if stamp is None
                else f" The file was changed, {moment(stamp[0] / 1e9)}, after that work began: "
                "you will be asked when saving."
            )

        def ask_again() -> None:
            yes = [Answer("y", "discard permanently", throw_away)]
            kept_text = f"It was stored {moment(kept.at)}."
            choose(
                app,
                Question(
                    "Discard the work?", kept_text, yes, back=partial(self.offer, kept, go_on)
                ),
            )

        answers = [
            Answer("r", "recover; undo goes back to the file", recover),
            Answer("k", "keep for later; go on with the file", go_on),
            Answer("d", "discard", ask_again),
        ]
        choose(app, Question("Unsaved work", text, answers, must=True))

    # quitting

    def quit(self) -> None:
        """Quit the builder; if there is unsaved work, ask the user first."""
        self.check_external_change()
        if not self._session.changed:
            self._leave()
            return
        if isinstance(self._app.screen, Question):
            return  # the open question comes first

        def discard() -> None:
            self._session.file.forget()
            self._leave()

        answers = [
            Answer("s", "save and leave", lambda: self.save(self._leave)),
            Answer("d", "leave without saving", discard),
        ]
        name, file = self._session.name, self._session.file
        is_gone = file.stamp is None and file.changed_on_disk()
        condition = "was deleted from the disk" if is_gone else "has unsaved changes"
        choose(self._app, Question("Not saved", f"{name} {condition}.", answers))


def chosen_path(text: str) -> Path:
    """Convert a typed file name to a path, with `.yaml` as its default suffix."""
    path = Path(os.path.expanduser(text.strip()))
    is_named = path.name not in ("", "..") and not text.rstrip().endswith(("/", os.sep))
    bare = is_named and not path.suffix and not path.is_dir()
    return path.with_name(path.name + _SUFFIX) if bare else path


def _free_name(path: Path) -> Path:
    number = 2
    while (free := path.with_name(f"{path.stem}-{number}{path.suffix}")).exists():
        number += 1
    return free


def _check_file_name(text: str) -> Reading:
    tidy = text.strip()
    if not tidy:
        return Reading("", "a name is needed")
    if "\0" in tidy:
        return Reading(tidy, "cannot be a name: it contains a null character")
    try:
        path = chosen_path(tidy)
        if path.is_dir() or tidy.endswith(("/", os.sep)):
            return Reading(tidy, "is a folder; the name of a file is needed")
        if path.exists() and not path.is_file():
            return Reading(tidy, "is not a regular file")
        if not path.absolute().parent.is_dir():
            return Reading(tidy, f"there is no folder {path.parent}")
    except (OSError, ValueError) as error:
        return Reading(tidy, f"cannot be a name: {getattr(error, 'strerror', None) or error}")
    return Reading(tidy)


def moment(seconds: float) -> str:
    """Format a time [s since 1970] as local date and time, to the minute."""
    return time.strftime("%Y-%m-%d at %H:%M", time.localtime(seconds))
