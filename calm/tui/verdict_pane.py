"""The verdict beside the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.widgets import Static

from calm.checks.finding import State
from calm.tui.signs import ELLIPSIS, LOOKS
from calm.tui.verdict_text import Saying, headline, sayings

if TYPE_CHECKING:
    from calm.tui.live import View


class VerdictPane(VerticalScroll, can_focus=True):
    """What holds, what does not and why; the figures of the anchor and the top."""

    DEFAULT_CSS = """
    VerdictPane {
        height: auto; max-height: 60%; min-height: 5; width: 1fr; padding: 0 1; margin-top: 1;
        scrollbar-size-vertical: 1; background: $background;
    }
    VerdictPane:focus { background-tint: $foreground 3%; }
    VerdictPane.-old { text-style: dim; }
    """

    def compose(self) -> ComposeResult:
        """One text."""
        yield Static(id="verdict")

    def show(self, view: View | None, note: str = "") -> None:
        """Say what is to be said of a line, and a note below it."""
        self.query_one("#verdict", Static).update(_rendered(view, note))


def _rendered(view: View | None, note: str) -> RenderableType:
    head = headline(view)
    style = "dim" if head.state is None else LOOKS[head.state].style
    title = Text(f"{head.sign} {head.text}", style=f"{style} bold")
    parts: list[RenderableType] = [title]
    table = Table.grid(padding=(0, 1, 0, 0))
    table.add_column(width=1)
    table.add_column(overflow="fold", ratio=1)
    for saying in sayings(view):
        table.add_row(_sign(saying), _text(saying))
    parts.append(table)
    if note:
        parts.append(Text(note, style="dim italic"))
    return Group(*parts)


def _sign(saying: Saying) -> Text:
    return Text(saying.sign, style="" if saying.state is None else LOOKS[saying.state].style)


def _text(saying: Saying) -> Text:
    text = Text()
    if saying.heading:
        grave = saying.state in (State.FAIL, State.WARN)
        style = LOOKS[saying.state].style if grave and saying.state else "dim"
        text.append(f"{saying.heading}  ", style=style)
    return text.append(saying.text, style="dim" if saying.faint else "")


def state_sign(view: View | None, *, old: bool = False) -> str:
    """The sign of the headline; dots where it is `old`, of what is not edited any more."""
    return ELLIPSIS if old else headline(view).sign.strip()


def state_word(view: View | None, *, old: bool = False) -> str:
    """The headline in one line with its sign."""
    return f"{state_sign(view, old=old)} {headline(view).text}".strip()
