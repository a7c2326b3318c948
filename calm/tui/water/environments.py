"""The environments of a file: shown one after the other, begun, taken out."""

from __future__ import annotations

from typing import Any

from textual.app import App

from calm.tui.checking import needed
from calm.tui.dialogs import Asked, Sheet
from calm.tui.water.form import Place
from calm.tui.water.pane import WaterPane

_CURRENT: Place = ("current",)


class Environments:
    """Those of the file that a form of the water shows; the line stands in the one shown."""

    def __init__(self, app: App[Any], pane: WaterPane) -> None:
        self._app, self._pane, self._workspace = app, pane, pane.workspace
        self._standing = pane.session.standing

    def show_next(self) -> None:
        """Show the next environment, and stand the line in it."""
        if self._pane.settle():
            self._stand_in(self._standing.next_environment)

    def _stand_in(self, name: str | None) -> None:
        before, self._standing.environment = self._pane.environment_file, name
        self._pane.drop_typing()
        self._pane.show_draft()
        self._workspace.tell(f"The line no longer stands in {before}" if before else "")
        self._workspace.edited()

    def begin(self) -> None:
        """A named environment with the current of the one that is shown."""

        def take(texts: dict[str, str] | None) -> None:
            if texts is None:
                return
            name, water = texts["name"], self._pane.water
            if name in self._standing.environments:
                self._workspace.tell(f"There is an environment {name} already", wrong=True)
                return
            known = water.value("current")
            current = known or water.begun(_CURRENT, "uniform")
            place = ("environments", name, "current")
            if self._pane.change(
                lambda _: water.draft.put_at(place, current), f"environment {name}"
            ):
                self._stand_in(name)
                self._workspace.tell(
                    "" if known else "Filled with a typical current, to be replaced"
                )

        if self._pane.settle():
            asked = [Asked("name", "Name", check=needed("a name"), placeholder="e.g. storm")]
            text = "It says only what differs from the file's own environment."
            self._app.push_screen(Sheet("Another environment", text, asked), take)

    def drop(self) -> None:
        """Take the named environment out of the file."""
        name = self._pane.water.variant
        if name is None:
            self._workspace.tell("The file's own environment stays; F5 goes to a named one")
            return
        self._pane.drop_typing()
        if self._pane.change(lambda water: water.draft.put_at(water.place, None), f"drop {name}"):
            self._stand_in(None)
