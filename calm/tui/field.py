"""Fields for a value: a line of input, and at each key what is made of its text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.geometry import Size
from textual.message import Message
from textual.reactive import Reactive
from textual.widget import Widget
from textual.widgets import Input, Static

from calm.tui.checking import Reading
from calm.tui.forms import Asked
from calm.tui.key_table import bindings


class ScrolledEntry(Input):
    """A line of input; a text of several lines that is pasted is left to what is around it."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def on_mount(self) -> None:
        """Its cursor stands still: nothing is sent while nobody types."""
        self.cursor_blink = False

    def on_paste(self, event: events.Paste) -> None:
        """Rows of a table are no value: textual would take the first of them."""
        if len(event.text.splitlines()) > 1:
            event.prevent_default()

    def correct(self, reading: Reading) -> None:
        """Put in what was probably meant, where that is known."""
        if reading.offer:
            self.value = reading.offer
            self.cursor_position = len(self.value)


class Part(Protocol):
    """A part of a form: a field, or a table."""

    @property
    def key(self) -> str:
        """Return what it is known by."""

    @property
    def text(self) -> str:
        """Return what was entered, as it is to be written."""

    @property
    def input(self) -> Widget:
        """Return where the keys go to."""

    def settle(self) -> bool:
        """Take what is typed; whether it was good."""


def all_settled(fields: Iterable[Part]) -> bool:
    """Return whether all texts are good, and taken; the first that is not gets the focus."""
    wrong = [field for field in fields if not field.settle()]
    if wrong:
        wrong[0].input.focus()
    return not wrong


class Field(Horizontal):
    """A name, an input, and a note beside it.

    It is `Committed` when it is left, by Enter or by the focus, with a good text that differs from
    the one it began with; a text that is not good stays, marked, and is not committed.
    """

    SCOPED_CSS = False  # the width of the screen counts
    DEFAULT_CSS = """
    Field {
        height: 1; width: 1fr;
        & > .field-title { width: 16; color: $text-muted; }
        & > Input { width: 24; background: $surface; }
        & > Input:focus { background: $surface; background-tint: $foreground 8%; }
        & > .field-note {
            width: 1fr; padding-left: 1; color: $text-muted;
            text-wrap: nowrap; text-overflow: ellipsis;
        }
        &.-wrong > Input { text-style: underline; background: $error-muted; }
        &.-wrong > .field-note { color: $text-error; }
    }
    """

    @dataclass
    class Committed(Message):
        """A text is to be taken."""

        field: Field
        text: str

    @dataclass
    class Entered(Message):
        """Enter was pressed in it."""

        field: Field

    @dataclass
    class Judged(Message):
        """Hold what the text typed so far comes to."""

        field: Field
        reading: Reading

    def __init__(self, asked: Asked, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.key, self.check, self.asked = asked.key, asked.check, asked
        self._note = asked.takes
        self.begun = self._shown = asked.text  # what it began with, and was last filled with
        self.input = ScrolledEntry(asked.text, placeholder=asked.placeholder, compact=True)
        self._told = Static(asked.takes, classes="field-note", markup=False)

    def compose(self) -> ComposeResult:
        """Name, input, note."""
        yield Static(self.asked.title, classes="field-title", markup=False)
        yield self.input
        yield self._told

    @property
    def is_typing(self) -> bool:
        """Return whether the text differs from the one shown first."""
        return self.input.value != self._shown

    @property
    def text(self) -> str:
        """Return what was typed, as it is to be written; as it was, where nothing was typed."""
        return self.reading.text if self.is_typing else self.begun

    @property
    def reading(self) -> Reading:
        """Return what the text comes to."""
        return self.check(self.input.value)

    def reset(self, text: str) -> None:
        """Show another text as the one to begin with."""
        self.begun = self._shown = text
        with self.prevent(Input.Changed):
            self.input.value = text
        self._tell(Reading(text))

    def tell(self, note: str) -> None:
        """Show another note, as long as nothing is wrong; none for what the field takes."""
        self._note = note or self.asked.takes
        if not self.has_class("-wrong"):
            self._told.update(self._note, layout=False)

    def note(self, reading: Reading) -> str:
        """Return what is said of the typed text: what is wrong or added, else what it takes."""
        return reading.told(self.input.value) or self._note

    def _tell(self, reading: Reading) -> None:
        self.set_class(not reading.is_good, "-wrong")
        self._told.update(self.note(reading), layout=False)

    @on(Input.Changed)
    def _judge(self, event: Input.Changed) -> None:
        event.stop()
        reading = self.reading
        self._tell(reading)
        self.post_message(self.Judged(self, reading))

    @on(Input.Submitted)
    def _enter(self, event: Input.Submitted) -> None:
        event.stop()
        if self.settle():
            self.post_message(self.Entered(self))

    def on_descendant_blur(self, event: events.DescendantBlur) -> None:
        """Take the text when the focus goes on, if it is good."""
        if self.reading.is_good:
            self.settle()

    def settle(self) -> bool:
        """Commit a good text, put in the correction of another one; whether it was good."""
        reading = self.reading
        if not reading.is_good:
            self._tell(reading)
            self.input.correct(reading)
            return False
        if not self.is_typing:
            return True
        begun = self.begun
        self.reset(reading.text)
        self._tell(reading)
        if reading.text != begun:
            self.post_message(self.Committed(self, reading.text))
        return True


class Cycle(Widget, can_focus=True):
    """A name, and a word between two arrows."""

    BINDINGS = bindings("choice")
    DEFAULT_CSS = """
    Cycle { height: 1; width: 1fr; color: $foreground; }
    Cycle:focus { text-style: bold; }
    """

    @dataclass
    class Turned(Message):
        """Another word is chosen."""

        word: str

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
        self._title, self.words, self.word = f"{title:<{title_width}}", tuple(words), word

    @property
    def hint(self) -> str:
        """Return what the keys do here."""
        return "← → another, ↑ ↓ go on"

    def show(self, word: str) -> None:
        """Show another word."""
        self.word = word
        self.refresh()

    def next_word(self, by: int) -> str:
        """Return the word after the one shown, or before it."""
        here = self.words.index(self.word) if self.word in self.words else 0
        return self.words[(here + by) % len(self.words)]

    def action_turn(self, by: int) -> None:
        """Go to the next word."""
        self.show(self.next_word(by))
        self.post_message(self.Turned(self.word))

    def on_click(self) -> None:
        """The mouse goes on, too."""
        self.action_turn(1)

    def render(self) -> Text:
        """The name, the arrows and the word."""
        return Text.assemble(
            (self._title, "dim"),
            ("‹ " if self.has_focus else "  ", "dim"),
            (self.word, "reverse" if self.has_focus else ""),
            (f" ›   {self.hint}" if self.has_focus else "", "dim"),
        )
