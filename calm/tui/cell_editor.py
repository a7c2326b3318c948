"""One value of a table, edited where it stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from textual import events
from textual.binding import BindingType
from textual.geometry import Region
from textual.message import Message

from calm.tui.checking import Check, Reading, anything
from calm.tui.key_table import bindings
from calm.tui.scrolled import ScrolledEntry

Then = Literal["stay", "edit next", "right", "up", "down"]
"""Where the cursor goes from a value that was taken."""


class CellEditor(ScrolledEntry):
    """A line of input laid over a cell; it says at each key what it makes of the text."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("cell")]
    DEFAULT_CSS = """
    CellEditor, CellEditor:focus {
        layer: over; position: absolute; display: none; height: 1; border: none; padding: 0;
        background: $primary-muted; color: $foreground; background-tint: $primary 0%;
        &.-open { display: block; }
        &.-wrong { background: $error-muted; text-style: underline; }
    }
    """

    @dataclass
    class Judged(Message):
        """What the text typed so far comes to."""

        reading: Reading

    @dataclass
    class Done(Message):
        """A good text was entered, None where it is as it was; and where to go then."""

        text: str | None
        then: Then

    @dataclass
    class Abandoned(Message):
        """The value stays as it was; why, where what was typed is bad and nobody is asked."""

        reason: str = ""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id, compact=True, select_on_focus=True)
        self._check: Check = anything
        self._before = ""  # the text that typing began with

    @property
    def is_open(self) -> bool:
        """Return whether a value is being edited."""
        return self.has_class("-open")

    def open(
        self, text: str, check: Check, region: Region, *, least_width: int = 10, begun: bool = False
    ) -> None:
        """Begin to edit a text over a part of the screen [cells of the parent].

        The first key takes the place of the text, or goes on with one that is `begun`.
        """
        self._check, self._before = check, "" if begun else text
        self.select_on_focus = not begun
        self.styles.offset = region.offset
        self.styles.width = max(region.width, least_width)
        self.add_class("-open")
        self.value = text
        self.focus()
        if begun:
            self.cursor_position = len(text)
        else:
            self.action_select_all()

    def close(self) -> None:
        """Go away."""
        self.remove_class("-open", "-wrong")

    @property
    def is_typing(self) -> bool:
        """Return whether something else was typed than there was."""
        return self.is_open and self.value != self._before

    @property
    def text(self) -> str | None:
        """Return what is to be written; None where nothing is: it stays, or what was typed is
        bad.
        """
        reading = self._check(self.value)
        # a value that nobody touched has its unit added, and is not tidied
        is_completed = reading.text.startswith(f"{self.value.strip()} ")
        return reading.text if reading.is_good and (self.is_typing or is_completed) else None

    def settle(self) -> Reading:
        """Judge what was typed; a bad text stays to be corrected. What nobody touched is good."""
        if not self.is_typing:
            return Reading(self.value)
        reading = self._check(self.value)
        self.set_class(not reading.is_good, "-wrong")
        return reading

    def watch_value(self, value: str) -> None:
        """Judge at each key."""
        if self.is_open:
            self._judge(value)

    def _judge(self, value: str) -> Reading:
        reading = self._check(value)
        self.set_class(not reading.is_good, "-wrong")
        self.post_message(self.Judged(reading))
        return reading

    def action_done(self, then: Then = "stay") -> None:
        """Take the text and go on."""
        reading = self._judge(self.value)
        if reading.is_good:
            self.post_message(self.Done(self.text, then))
        elif reading.offer:
            self.value = reading.offer
            self.cursor_position = len(self.value)

    def action_right(self) -> None:
        """Go on where something was typed up to here, as in a spreadsheet; else move the cursor."""
        if self.is_typing and self.cursor_position == len(self.value) and self.selection.is_empty:
            self.action_done("right")
        else:
            self.action_cursor_right()

    def action_abandon(self) -> None:
        """Leave the value as it was."""
        self.post_message(self.Abandoned())

    def on_blur(self, event: events.Blur) -> None:
        """A press of the mouse elsewhere takes the value, if it is good."""
        self.call_after_refresh(self._end_if_left)

    def _end_if_left(self) -> None:
        """Not where the next value is edited meanwhile, nor where the window lost the focus."""
        is_left = self.screen.focused is not self  # `has_focus` follows it later
        if not self.is_open or not is_left or not self.app.app_focus:
            return
        reading = self._check(self.value)
        if not self.is_typing:
            self.post_message(self.Abandoned())
        elif reading.is_good:
            self.action_done()
        else:
            self.post_message(self.Abandoned(f"`{self.value}` is not taken: {reading.note}"))
