"""The screen of the water: its form, and what is done with environments and currents."""

from __future__ import annotations

from typing import Any, ClassVar

from textual import on
from textual.app import App
from textual.binding import BindingType
from textual.events import DescendantFocus

from calm.tui.cell_editor import CellEditor
from calm.tui.checking import needed
from calm.tui.dialogs import Asked, InputSheet
from calm.tui.key_table import bindings, hints
from calm.tui.messages import Workspace
from calm.tui.screen import DraftScreen, KeyBar
from calm.tui.water.currents_to_begin import Currents
from calm.tui.water.form import Place
from calm.tui.water.grid_cells import GridCells
from calm.tui.water.water_pane import WaterPane


class WaterScreen(DraftScreen):
    """Depth, density, current and wind of each environment."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("water")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (112, "-wide")]  # noqa: RUF012
    DEFAULT_CSS = "WaterScreen.-narrow Grid { margin-left: 0; }"

    def __init__(self, workspace: Workspace) -> None:
        self.pane = WaterPane(workspace)
        super().__init__(workspace, self.pane, self.pane)
        self._environments = Environments(self.app, self.pane)
        self._currents = Currents(self.app, self.pane)

    @on(DescendantFocus)
    def _show_keys(self) -> None:
        bar = self.query_one(KeyBar)
        focused = self.focused
        if isinstance(focused, CellEditor):
            bar.show_keys(hints("cell"))
        elif isinstance(focused, GridCells):
            bar.show_keys([*hints("grid"), *hints("water")])
        else:
            bar.show_keys(hints("water"))
        if not self.pane.goes_on:
            bar.tell("")
        self.pane.goes_on = False

    def action_next_environment(self) -> None:
        """Show the next environment, and stand the line in it."""
        self._environments.show_next()

    def action_new_environment(self) -> None:
        """A named environment with the current of the one that is shown."""
        self._environments.begin()

    def action_drop_environment(self) -> None:
        """Take the named environment out of the file."""
        self._environments.drop()

    def action_preset(self) -> None:
        """A profile to begin with."""
        self._currents.offer_presets()

    @on(WaterPane.FileWanted)
    def action_load_current(self) -> None:
        """A current from CSV or NetCDF: referred to, or its profile copied."""
        self._currents.ask_for_file()

    def action_undo(self) -> None:
        """Take the last change back, or what is typed where that is bad."""
        if self.pane.settle():
            super().action_undo()
        else:
            self.pane.drop_typing()
            self.show_draft()

    def action_back(self) -> None:
        """Back to the line; what is typed is taken where it is good, and dropped elsewhere."""
        self.pane.settle()
        self.dismiss()  # not waited for: it ends the very loop that would wait


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
            self._app.push_screen(InputSheet("Another environment", text, asked), take)

    def drop(self) -> None:
        """Take the named environment out of the file."""
        name = self._pane.water.variant
        if name is None:
            self._workspace.tell("The file's own environment stays; F5 goes to a named one")
            return
        self._pane.drop_typing()
        if self._pane.change(lambda water: water.draft.put_at(water.place, None), f"drop {name}"):
            self._stand_in(None)
