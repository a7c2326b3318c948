"""The figures that are not known, asked for in one form and written into the file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from textual.app import App

from calm.tui.line.pane import LinePane

if TYPE_CHECKING:
    from calm.tui.line.missing_screen import Filled


class Filling:
    """Asks for all that is missing, and writes what was given."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    def ask(self) -> None:
        """Show the form, once the line is judged."""
        from calm.tui.line.missing_figures import filled, missing_figures
        from calm.tui.line.missing_screen import MissingScreen

        workspace, session = self._workspace, self._workspace.session
        if not self._line.settle():
            return
        if workspace.view is None or not workspace.is_fresh:
            workspace.tell("Missing figures are known once the line is judged")
            return
        missing = missing_figures(workspace.view, session.draft)
        if not missing:
            workspace.tell("No figure of a component is missing")
            return

        def take(given: Filled | None) -> None:
            if given is not None and given[0]:
                count = len(given[0])
                self._line.attempt(
                    lambda: session.do(filled(session.draft, missing, *given), "fill in figures"),
                    f"{count} figure{'s' * (count != 1)} filled in",
                )

        self._app.push_screen(MissingScreen(missing), take)
