"""The screen of the water: its form, and what is done with environments and currents."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.binding import BindingType
from textual.events import DescendantFocus

from calm.tui.actions import bindings, hints
from calm.tui.bars import KeyBar
from calm.tui.line.cell_editor import CellEditor
from calm.tui.screen import DraftScreen
from calm.tui.water.cells import Cells
from calm.tui.water.currents import Currents
from calm.tui.water.environments import Environments
from calm.tui.water.pane import WaterPane
from calm.tui.workspace import Workspace


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
        elif isinstance(focused, Cells):
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
