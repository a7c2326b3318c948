"""The line beside what was saved of it, or another file: figures, findings, lines, pictures."""

from __future__ import annotations

from difflib import unified_diff
from pathlib import Path
from typing import TYPE_CHECKING, Any

from textual.app import App

from calm.errors import CalmError
from calm.files.editing import WorkingFile
from calm.tui.dialogs import Answer, Asked, InputSheet, Question
from calm.tui.line.body import LineBody

if TYPE_CHECKING:
    from calm.tui.live import View

_MOST_LINES = 24


class Comparing:
    """Shows what has changed since the file was saved, or what is different in another one."""

    def __init__(self, app: App[Any], body: LineBody) -> None:
        self._app, self._line, self._pictures = app, body.line, body.pictures
        self._workspace = body.workspace

    def with_saved(self) -> None:
        """Judge what was saved in a thread, and show the differences."""
        if not self._line.settle():
            return
        session = self._workspace.session
        if session.changed:
            self._judge(session.history.saved_text, None)
        else:
            self._pictures.put_beside(None)
            self._workspace.tell("Nothing has changed since it was saved")

    def with_file(self) -> None:
        """Ask for another file; draw its line beside this one, and show the differences."""
        if not self._line.settle():
            return

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
            if not texts["file"]:
                self._pictures.put_beside(None)
                return
            try:
                text = WorkingFile(Path(texts["file"])).read()
            except (CalmError, OSError) as error:
                self._workspace.tell(str(error), wrong=True)
            else:
                self._judge(text, Path(texts["file"]))

        asked = [Asked("file", "File", placeholder="e.g. other.yaml")]
        text = "Its line is drawn dashed beside this one; no name takes it away again."
        self._app.push_screen(InputSheet("Compare with another file", text, asked), take)

    def _judge(self, text: str, file: Path | None) -> None:
        """Judge a text beside the line's: of another file, or of its own as it was saved."""
        view = self._workspace.view
        if view is None or not self._workspace.is_fresh:
            self._workspace.tell("The line is still being judged; ask again")
            return
        catalogs = self._workspace.session.catalogs
        name = "what was saved" if file is None else str(file)

        def work() -> None:
            from calm.tui.advice import differences
            from calm.tui.live import judge, judge_fully

            if file is None:
                before = judge(text, view.path, view.environment, catalogs, keep=view)
            else:
                before = judge(text, file, None, catalogs)
            lines = differences(judge_fully(before, catalogs), judge_fully(view, catalogs))
            lines += ["", *changed_lines(text, view.text)]
            self._line.call_later(self._show, name, before, lines)

        self._workspace.tell("Comparing …")
        self._line.run_worker(work, thread=True, group="advice", exclusive=True)

    def _show(self, name: str, before: View, lines: list[str]) -> None:
        self._workspace.tell("")
        view = self._workspace.view
        if before.result is not None and view and type(before.result) is type(view.result):
            self._pictures.put_beside((name, before.result.shape))
        answers = [Answer("b", "back to the line", "back")]
        self._app.push_screen(Question(f"Beside {name}", "\n".join(lines), answers))


def changed_lines(before: str, after: str) -> list[str]:
    """The lines that were taken out (``-``) and put in (``+``), the first of many."""
    diff = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    lines = [line for line in diff if not line.startswith(("---", "+++", "@@"))]
    more = len(lines) - _MOST_LINES
    return lines[:_MOST_LINES] + ([f"and {more} lines more"] if more > 0 else [])
