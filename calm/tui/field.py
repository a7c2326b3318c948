"""Input fields that interpret their text at each key press."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from rich.text import Text
from textual import events, on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.content import Content
from textual.geometry import Size
from textual.message import Message
from textual.reactive import Reactive
from textual.widget import Widget
from textual.widgets import Input

from calm.tui.checking import Reading
from calm.tui.forms import FormField
from calm.tui.key_table import bindings


class ScrolledEntry(Input):
    """Text input that passes a paste of several lines to its parent widget."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def on_mount(self) -> None:
        self.cursor_blink = False  # an idle builder sends no data

    def on_paste(self, event: events.Paste) -> None:
        # Textual would insert the first row of a pasted table
        if len(event.text.splitlines()) > 1:
            event.prevent_default()

    def correct(self, reading: Reading) -> None:
        """Replace the text by the suggested correction, if any."""
        if reading.offer:
            self.value = reading.offer
            self.cursor_position = len(self.value)


class Part(Protocol):
    """Part of a form, either a field or a table."""

    @property
    def key(self) -> str:
        """Key that this part edits in the file."""

    @property
    def text(self) -> str:
        """Text to write to the file."""

    @property
    def input(self) -> Widget:
        """Widget that receives key presses."""

    def settle(self) -> bool:
        """Accept the typed text; return whether the text is valid."""


def all_settled(fields: Iterable[Part]) -> bool:
    """Accept the texts of all parts; return whether all texts are valid.

    If a text is invalid, the first part with an invalid text gets the focus.
    """
    wrong = [field for field in fields if not field.settle()]
    if wrong:
        wrong[0].input.focus()
    return not wrong


class Field(Horizontal):
    """Field of a form, with a name, a text input, and a note.

    When the user presses Enter or leaves the field, a valid, changed text is posted as `Committed`.
    An invalid text stays in the field and is marked.
    """

    SCOPED_CSS = False  # styles depend on the width of the screen
    DEFAULT_CSS = """
    Field {
        height: 1; width: 1fr; color: $text-muted;
        & > Input { width: 24; margin-left: 16; background: $surface; }
        & > Input:focus { background: $surface; background-tint: $foreground 8%; }
        &.-wrong > Input { text-style: underline; background: $error-muted; }
    }
    """

    @dataclass
    class Committed(Message):
        """Message that a valid text was entered."""

        field: Field
        text: str

    @dataclass
    class Entered(Message):
        """Message that Enter was pressed in the field."""

        field: Field

    @dataclass
    class Judged(Message):
        """Message with the interpretation of the text typed so far."""

        field: Field
        reading: Reading

    def __init__(self, form_field: FormField, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.key, self.check, self.form_field = form_field.key, form_field.check, form_field
        self._note = self._shown_note = form_field.takes
        self.begun = self._shown = form_field.text  # initial text, and text last filled in
        self.input = ScrolledEntry(
            form_field.text, placeholder=form_field.placeholder, compact=True
        )

    def compose(self) -> ComposeResult:
        # the only widget: each widget takes time to start, and a form may have dozens of fields
        yield self.input

    def render(self) -> Content:
        before, width = self.input.styles.margin.left, self.input.outer_size.width + 1
        title = Content(self.form_field.title).truncate(before, ellipsis=True, pad=True)
        room = max(self.content_size.width - before - width, 0)
        note = Content(self._shown_note).truncate(room, ellipsis=True)
        style = "$text-error" if self.has_class("-wrong") else ""
        return Content.assemble(title, " " * width, (note.plain, style))

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self.refresh()  # margin and width of the input may have changed

    @property
    def is_typing(self) -> bool:
        """Whether the text differs from the initial text."""
        return self.input.value != self._shown

    @property
    def text(self) -> str:
        """Text to write to the file; the initial text if the user has not changed it."""
        return self.reading.text if self.is_typing else self.begun

    @property
    def reading(self) -> Reading:
        """Interpretation of the typed text."""
        return self.check(self.input.value)

    def reset(self, text: str) -> None:
        """Replace the initial text, and show the new text."""
        self.begun = self._shown = text
        with self.prevent(Input.Changed):
            self.input.value = text
        self._tell(Reading(text))

    def tell(self, note: str) -> None:
        """Replace the note; "" restores the description of the field.

        While the text is invalid, the error is shown instead of the note.
        """
        self._note = note or self.form_field.takes
        if not self.has_class("-wrong"):
            self._show_note(self._note)

    def note(self, reading: Reading) -> str:
        """Return the feedback on the typed text; without feedback, the note of the field."""
        return reading.feedback(self.input.value) or self._note

    def _tell(self, reading: Reading) -> None:
        self.set_class(not reading.is_good, "-wrong")
        self._show_note(self.note(reading))

    def _show_note(self, note: str) -> None:
        if note != self._shown_note:
            self._shown_note = note
            self.refresh()

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
        if self.reading.is_good:
            self.settle()

    def settle(self) -> bool:
        """Accept a valid text; return whether the text is valid.

        If the text is invalid and a correction is known, the correction is inserted.
        """
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
    """Selector with two arrows that step through a list of words."""

    BINDINGS = bindings("choice")
    DEFAULT_CSS = """
    Cycle { height: 1; width: 1fr; color: $foreground; }
    Cycle:focus { text-style: bold; }
    """

    @dataclass
    class Turned(Message):
        """Message that another word was chosen."""

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
        """Text that names the keys of this widget."""
        return "← → choose, ↑ ↓ next field"

    def show(self, word: str) -> None:
        """Select a word."""
        self.word = word
        self.refresh()

    def next_word(self, by: int) -> str:
        """Return the word `by` places after the selected word; the list is circular."""
        here = self.words.index(self.word) if self.word in self.words else 0
        return self.words[(here + by) % len(self.words)]

    def action_turn(self, by: int) -> None:
        self.show(self.next_word(by))
        self.post_message(self.Turned(self.word))

    def on_click(self) -> None:
        self.action_turn(1)

    def render(self) -> Text:
        return Text.assemble(
            (self._title, "dim"),
            ("‹ " if self.has_focus else "  ", "dim"),
            (self.word, "reverse" if self.has_focus else ""),
            (f" ›   {self.hint}" if self.has_focus else "", "dim"),
        )
