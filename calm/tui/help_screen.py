"""Every key, by where it works."""

from __future__ import annotations

from typing import ClassVar

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from calm.tui.actions import PLACES, actions_in
from calm.tui.signs import LOOKS

_SIGNS = "Signs: " + ", ".join(f"{look.sign} {look.word}" for look in LOOKS.values())
_GROUND = (
    "Every change is solved and judged at once. A number without a unit takes the unit shown. "
    "With the mouse: press a cell to go there, press it again to edit."
)


class HelpScreen(ModalScreen[None]):
    """The list of keys, made of the list of actions."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,question_mark,f1,enter", "dismiss", show=False)
    ]
    DEFAULT_CSS = """
    HelpScreen {
        align: center middle;
        & > VerticalScroll {
            width: 84; max-width: 100%; height: 90%; padding: 1 2; background: $panel;
            border-left: outer $primary; scrollbar-size-vertical: 1;
        }
    }
    """

    def compose(self) -> ComposeResult:
        """One long text."""
        with VerticalScroll():
            yield Static(_text())


def _text() -> RenderableType:
    parts: list[RenderableType] = [Text("Keys", style="bold"), Text(_GROUND), Text(_SIGNS)]
    for place, title in PLACES.items():
        table = Table.grid(padding=(0, 2, 0, 0))
        table.add_column(width=20, overflow="fold")
        table.add_column(overflow="fold")
        for action in actions_in(place):
            table.add_row(Text(action.shown_keys, style="bold"), Text(action.meaning))
        parts += [Text(f"\n{title}", style="bold underline"), table]
    parts.append(Text("\nEsc leaves.", style="dim"))
    return Group(*parts)
