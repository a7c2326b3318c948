"""The forms of what is said of a whole file, and of its deployment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from textual.app import App

from calm.files.editing import Draft
from calm.tui.dialogs import InputSheet
from calm.tui.line.line_pane import LinePane
from calm.tui.line.mooring_sheet import (
    as_deployed,
    deployed_sheet,
    document_sheet,
    documented,
    hung_at,
    mooring_sheet,
    tow_sheet,
    written,
)


class Sheets:
    """Shows each, and writes what was entered."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    @property
    def _draft(self) -> Draft:
        return self._workspace.session.draft

    def mooring(self) -> None:
        """Name, description, position."""
        self._ask(mooring_sheet(self._draft), "name and place", written)

    def document(self) -> None:
        """Do what the title block of the drawings says, and what the revision changed."""
        self._ask(document_sheet(self._draft), "the document", documented)

    def deployed(self) -> None:
        """When and where the mooring was deployed, and what hangs at the row."""
        view = self._workspace.view if self._workspace.is_fresh else None
        hung = hung_at(None if view is None else view.file, self._line.table.spot)

        def deployed(draft: Draft, texts: Mapping[str, str]) -> Draft:
            return as_deployed(draft, hung, texts)

        self._ask(deployed_sheet(self._draft, hung), "the deployment", deployed)

    def tow(self) -> None:
        """Speed and course of a tow; a mooring becomes one."""
        self._ask(tow_sheet(self._draft), "the tow", written)

    def _ask(
        self, sheet: InputSheet, label: str, changed: Callable[[Draft, Mapping[str, str]], Draft]
    ) -> None:
        session = self._workspace.session

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                self._line.attempt(lambda: session.do(changed(session.draft, texts), label))

        self._app.push_screen(sheet, take)
