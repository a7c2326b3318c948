"""Saving, and what may stand against it: no name yet, another file there, a change on the disk."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.errors import CalmError
from calm.tui.checking import Reading
from calm.tui.dialogs import Answer, Asked, Question, Sheet
from calm.tui.session import Session

if TYPE_CHECKING:
    from textual.app import App

    Base = App[int]
else:
    Base = object

_SUFFIX = ".yaml"


class Saving(Base):
    """What an application does to save the file of its `session` and to leave."""

    session: Session
    builder: Any

    if TYPE_CHECKING:

        def tell(self, text: str, *, wrong: bool = False) -> None:
            """Say something in the last line of the screen."""

    def keep(self) -> None:
        """Keep what is not saved beside the file; that it cannot be kept is told."""
        try:
            self.session.autosave()
        except (CalmError, OSError) as error:
            self.tell(f"What is not saved could not be kept: {error}", wrong=True)

    def action_save(self) -> None:
        """Save, and ask for a name where there is none."""
        self._save()

    def action_save_as(self) -> None:
        """Save under another name."""
        self._ask_for_name()

    def _save(self, then: Callable[[], object] | None = None) -> None:
        file = self.session.file
        if file.path is None:
            self._ask_for_name(then)
        elif file.changed_on_disk():
            self._ask_of_change(then)
        else:
            self._write(self.session.save, then)

    def _write(self, write: Callable[[], object], then: Callable[[], object] | None) -> None:
        try:
            write()
        except (CalmError, OSError) as error:
            # the folder is known, and the reason must not be cut off behind it
            folder = "" if self.session.file.path is None else f"{self.session.file.path.parent}/"
            self.tell(f"Not saved: {str(error).replace(folder, '')}", wrong=True)
            return
        self.builder.refresh_rows()
        self.tell(f"{self.session.name} saved")
        if then is not None:
            then()

    def _ask_for_name(self, then: Callable[[], object] | None = None) -> None:
        path = self.session.file.path
        begin = "" if path is None else str(path)

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
            chosen = _path(texts["path"])
            if chosen.exists() and chosen != path:
                self._ask_to_overwrite(chosen, then)
            else:
                self._write(lambda: self.session.save_as(chosen), then)

        asked = [Asked("path", "File", begin, _is_writable, placeholder="iroise-2026.yaml")]
        self.push_screen(Sheet("Save as", f"In {Path.cwd()}, unless told otherwise.", asked), take)

    def _ask_to_overwrite(self, path: Path, then: Callable[[], object] | None) -> None:
        def take(answer: str | None) -> None:
            if answer:
                self._write(lambda: self.session.save_as(path), then)

        answers = [Answer("o", "overwrite it", "overwrite")]
        self.push_screen(Question(f"{path.name} is there already", str(path), answers), take)

    def _ask_of_change(self, then: Callable[[], object] | None) -> None:
        def take(answer: str | None) -> None:
            if answer == "overwrite":
                self._write(self.session.save, then)
            elif answer == "theirs":
                self._take_theirs()
            elif answer == "other":
                self._ask_for_name(then)

        answers = [
            Answer("o", "overwrite it with what is here", "overwrite"),
            Answer("n", "save what is here under another name", "other"),
            Answer("t", "take theirs; what is here can be had back with undo", "theirs"),
        ]
        self.push_screen(
            Question(
                f"{self.session.name} was changed by another program",
                "It is not as it was when it was read.",
                answers,
            ),
            take,
        )

    def look_at_disk(self) -> None:
        """Take a file that another program has changed; or tell of it, where work is not saved."""
        session = self.session
        if session.file.path is None or not session.file.changed_on_disk():
            return
        if session.changed:
            self.tell("The file was changed by another program; saving will ask", wrong=True)
        else:
            self._take_theirs()

    def _take_theirs(self) -> None:
        try:
            text = self.session.file.read()
        except (CalmError, OSError) as error:
            self.tell(f"The file cannot be read any more: {error}", wrong=True)
            return
        self.session.take_saved(text)
        self.builder.changed(told="Read again: another program has changed it")

    async def action_quit(self) -> None:
        """Leave; unsaved work is asked about."""
        if not self.session.changed:
            self.leave()
            return

        def take(answer: str | None) -> None:
            if answer == "save":
                self._save(self.leave)
            elif answer == "discard":
                self.session.file.forget()
                self.exit(0)

        answers = [
            Answer("s", "save and leave", "save"),
            Answer("d", "leave without saving", "discard"),
        ]
        self.push_screen(
            Question("Not saved", f"{self.session.name} has changes that are not saved.", answers),
            take,
        )

    def leave(self) -> None:
        """Leave; what is saved is kept nowhere else."""
        self.session.file.forget()
        self.exit(0)


def _path(text: str) -> Path:
    path = Path(text).expanduser()
    return path if path.suffix else path.with_suffix(_SUFFIX)


def _is_writable(text: str) -> Reading:
    """Whether a file of that name could be written."""
    tidy = text.strip()
    if not tidy:
        return Reading("", "a name is needed")
    path = _path(tidy)
    if path.is_dir():
        return Reading(tidy, "is a folder")
    if not path.absolute().parent.is_dir():
        return Reading(tidy, f"there is no folder {path.parent}")
    return Reading(tidy)
