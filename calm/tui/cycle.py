"""One of some words, chosen with the arrows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.text import Text
from textual.binding import BindingType
from textual.message import Message
from textual.widget import Widget

from calm.tui.actions import bindings


class Cycle(Widget, can_focus=True):
    """A name, and a word between two arrows."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("choice")]
    DEFAULT_CSS = """
    Cycle { height: 1; width: 1fr; color: $foreground; }
    Cycle:focus { text-style: bold; }
    """

    @dataclass
    class Turned(Message):
        """Another word is chosen."""

        cycle: Cycle
        word: str

        @property
        def control(self) -> Cycle:
            """Which of several it was."""
            return self.cycle

    def __init__(
        self,
        title: str,
        words: Sequence[str],
        word: str,
        *,
        title_width: int = 16,
        id: str | None = None,
    ) -> None:
        super().__init__(id=id)
        self._title, self.words, self.word, self._width = title, tuple(words), word, title_width

    @property
    def hint(self) -> str:
        """What the keys do here."""
        return "← → another, ↑ ↓ go on"

    def show(self, word: str) -> None:
        """Show another word."""
        self.word = word
        self.refresh()

    def action_turn(self, by: int) -> None:
        """Go to the next word."""
        here = self.words.index(self.word) if self.word in self.words else 0
        self.show(self.words[(here + by) % len(self.words)])
        self.post_message(self.Turned(self, self.word))

    def on_click(self) -> None:
        """The mouse goes on, too."""
        self.action_turn(1)

    def render(self) -> Text:
        """The name, the arrows and the word."""
        return Text.assemble(
            (f"{self._title:<{self._width}}", "dim"),
            ("‹ " if self.has_focus else "  ", "dim"),
            (self.word, "reverse" if self.has_focus else ""),
            (f" ›   {self.hint}" if self.has_focus else "", "dim"),
        )
