"""A screen that shows the draft: title, the part that shows and edits it, keys."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from textual.app import ComposeResult
from textual.screen import Screen
from textual.widget import Widget

from calm.tui.bars import KeyBar, TitleBar
from calm.tui.messages import Workspace


class ScreenPart(Protocol):
    """What shows and edits the draft of a workspace.

    The application settles the part on top before it saves or leaves, and has every one of them
    read the draft again when that was replaced from outside.
    """

    @property
    def is_typing(self) -> bool:
        """Return whether something is typed that is not in the draft yet."""

    def settle(self) -> bool:
        """Take over what is being typed: the draft holds it when this returns True.

        False where the value is bad: it stays to be corrected, and the reason is shown.
        """

    def show_draft(self) -> None:
        """Show the draft as it is now, some steps further or back."""

    def replaced(self) -> None:
        """Show the draft, another one: what is typed and marked was of the one before.

        It may be one that cannot be read: the application then opens the text view.
        """

    def show_view(self) -> None:
        """Show what a worker made of the draft."""

    def title(self) -> tuple[str, str]:
        """Return what the first line says at its left and at its right end."""


class DraftScreen(Screen[None]):
    """A frame for a part.

    Parameters
    ----------
    workspace : the file that is shown
    part, body : what shows it, as what it is asked for and as the widget that it is
    """

    def __init__(self, workspace: Workspace, part: ScreenPart, body: Widget) -> None:
        super().__init__()
        self.workspace, self.part, self._body = workspace, part, body

    def compose(self) -> ComposeResult:
        """Title, what is shown, keys."""
        yield TitleBar()
        yield self._body
        yield KeyBar()

    def on_mount(self) -> None:
        """Say what is shown."""
        self.show_title()

    def show_view(self) -> None:
        """Show what a worker made of the draft."""
        if self.is_mounted and self.is_attached:  # it is there, and not on the way out
            self.part.show_view()
            self.show_title()

    def show_draft(self) -> None:
        """Show the draft as it is now."""
        self.part.show_draft()
        self.show_title()

    def replaced(self) -> None:
        """Show another draft."""
        self.part.replaced()
        self.show_title()

    def show_title(self) -> None:
        """Say again what is shown and how it stands, dimmed where that is of an earlier draft."""
        self.query_one(TitleBar).show(*self.part.title(), old=not self.workspace.is_fresh)

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line, until the next key."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    def action_undo(self) -> None:
        """Take the last change back, once what is typed is taken."""
        self._go("undone", self.workspace.session.history.undo)

    def action_redo(self) -> None:
        """Make it again."""
        self._go("done again", self.workspace.session.history.redo)

    def _go(self, what: str, step: Callable[[], str | None]) -> None:
        if not self.part.settle():
            return
        label = step()
        if label is None:
            self.tell(f"Nothing is left to be {what}")
        else:
            self.show_draft()
            self.tell(f"{what}: {label}")
            self.workspace.edited()
