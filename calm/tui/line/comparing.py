"""The line beside what was last saved of it: figures, findings and lines of the file."""

from __future__ import annotations

from difflib import unified_diff
from typing import Any

from textual.app import App

from calm.tui.dialogs import Answer, Question
from calm.tui.line.pane import LinePane

_MOST_LINES = 24


class Comparing:
    """Shows what has changed since the file was saved."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    def with_saved(self) -> None:
        """Judge what was saved in a thread, and show the differences."""
        workspace, view = self._workspace, self._workspace.view
        saved = workspace.session.history.saved_text
        if not self._line.settle():
            return
        if not workspace.session.changed:
            workspace.tell("Nothing has changed since it was saved")
            return
        if view is None or not workspace.is_fresh:
            workspace.tell("The line is still being judged; ask again")
            return
        catalogs = workspace.session.catalogs

        def work() -> None:
            from calm.tui.advice import differences
            from calm.tui.live import judge, judge_fully

            before = judge(saved, view.path, view.environment, catalogs, keep=view)
            told = differences(judge_fully(before, catalogs), judge_fully(view, catalogs))
            self._line.call_later(self._show, [*told, "", *changed_lines(saved, view.text)])

        workspace.tell("Comparing …")
        self._line.run_worker(work, thread=True, group="advice", exclusive=True)

    def _show(self, told: list[str]) -> None:
        self._workspace.tell("")
        answers = [Answer("b", "back to the line", "back")]
        self._app.push_screen(Question("Since it was saved", "\n".join(told), answers))


def changed_lines(before: str, after: str) -> list[str]:
    """The lines that were taken out (``-``) and put in (``+``), the first of many."""
    diff = unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    lines = [line for line in diff if not line.startswith(("---", "+++", "@@"))]
    more = len(lines) - _MOST_LINES
    return lines[:_MOST_LINES] + ([f"and {more} lines more"] if more > 0 else [])
