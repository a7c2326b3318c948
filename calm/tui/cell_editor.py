"""A table whose values are edited where they stand."""

from collections.abc import Callable
from typing import Literal

from textual import events
from textual.app import ComposeResult
from textual.containers import Vertical

from calm.tui import field, key_table
from calm.tui.checking import Check, Reading, anything
from calm.tui.scrolled import TableCells

Then = Literal["stay", "edit next", "right", "up", "down"]
"""Where the cursor goes from a value that was taken."""


class EditableTable(Vertical):
    """A table, and over it the line of input that edits the cell under its cursor.

    What is made of it begins with `open_editor`, and says how a text is written, and where the
    cursor goes from one that was taken. `tell` says something in the last line of the screen.
    """

    DEFAULT_CSS = "EditableTable { layers: table over; }"

    def __init__(
        self, tell: Callable[..., object], table: TableCells, *, id: str | None = None
    ) -> None:
        super().__init__(id=id)
        self.tell, self.table, self.editor = tell, table, CellEditor(self)

    def compose(self) -> ComposeResult:
        """The rows, and over them what is edited."""
        yield self.table
        yield self.editor

    def write(self, text: str) -> None:
        """Write a good text into the cell that is edited."""
        raise NotImplementedError

    def tell_reading(self, reading: Reading) -> None:
        """Tell what the text typed so far comes to."""
        self.tell(reading.told(self.editor.value), wrong=not reading.is_good)

    def go_on(self, then: Then, text: str | None) -> None:
        """Go on from a cell whose text was taken, None where it stays as it was."""
        raise NotImplementedError

    def abandoned(self) -> None:
        """Do what follows where a value is left as it was."""

    def action_move_column(self, by: int) -> None:
        """Go to the left or the right."""
        self.table.column += by

    @property
    def is_typing(self) -> bool:
        """Return whether a value is typed that is not written yet."""
        return self.editor.is_typing

    def open_editor(
        self, text: str, check: Check, *, least_width: int, begun: bool = False
    ) -> None:
        """Edit the cell under the cursor.

        Parameters
        ----------
        text, check : what is edited, and what judges it
        least_width : of the line of input [cells]
        begun : whether the text is what was typed already
        """
        region, editor = self.table.cell_region(), self.editor
        editor.styles.offset = region.offset
        editor.styles.width = max(region.width, least_width)
        editor.open(text, check, begun=begun)

    def settle(self) -> bool:
        """Write what is typed; a bad value, which is told, stays to be corrected."""
        reading = self.editor.settle()
        if not reading.is_good:
            self.editor.focus()
            self.tell(f"Not taken yet: {reading.note}", wrong=True)
        elif self.editor.is_open:
            self._take_typed()
        return reading.is_good

    def _take_typed(self) -> str | None:
        """Write the good text that is typed, if any, where it was typed."""
        text = self.editor.text
        self.leave_cell()
        if text is not None:
            self.write(text)
        return text

    def leave_cell(self) -> None:
        """Edit nothing any more; what is typed is not taken."""
        if self.editor.is_open:
            self.editor.remove_class("-open", "-wrong")
            if self.editor.is_here:
                self.table.focus()
            self.tell("")

    def done(self, then: Then) -> None:
        """Take the good text that is typed, and go on where it was not left for another place."""
        is_here = self.editor.is_here
        text = self._take_typed()
        if is_here:
            self.go_on(then, text)

    def abandon(self, reason: str = "") -> None:
        """Leave the value as it was; why, where what was typed is bad and nobody is asked."""
        self.leave_cell()
        self.abandoned()
        if reason:
            self.tell(reason, wrong=True)


class CellEditor(field.ScrolledEntry):
    """A line of input laid over a cell; it says at each key what it makes of the text."""

    BINDINGS = key_table.bindings("cell")
    DEFAULT_CSS = """
    CellEditor, CellEditor:focus {
        layer: over; position: absolute; display: none; height: 1; border: none; padding: 0;
        background: $primary-muted; color: $foreground; background-tint: $primary 0%;
        &.-open { display: block; }
        &.-wrong { background: $error-muted; text-style: underline; }
    }
    """

    def __init__(self, owner: EditableTable) -> None:
        super().__init__(compact=True, select_on_focus=True)
        self._owner = owner
        self._check: Check = anything
        self._before = ""  # the text that typing began with

    @property
    def is_open(self) -> bool:
        """Return whether a value is being edited."""
        return self.has_class("-open")

    @property
    def is_here(self) -> bool:
        """Return whether the keys go to it; `has_focus` follows later."""
        return self.screen.focused is self

    def open(self, text: str, check: Check, *, begun: bool = False) -> None:
        """Begin to edit a text.

        The first key takes the place of the text, or goes on with one that is `begun`.
        """
        self._check, self._before = check, "" if begun else text
        self.select_on_focus = not begun
        self.add_class("-open")
        self.value = text
        self.focus()
        if begun:
            self.cursor_position = len(text)
        else:
            self.action_select_all()

    @property
    def is_typing(self) -> bool:
        """Return whether something else was typed than there was."""
        return self.is_open and self.value != self._before

    @property
    def text(self) -> str | None:
        """Return what is to be written; None where it stays, or what was typed is bad."""
        reading = self._check(self.value)
        # a value that nobody touched has its unit added, and is not tidied
        is_completed = reading.text.startswith(f"{self.value.strip()} ")
        return reading.text if reading.is_good and (self.is_typing or is_completed) else None

    def settle(self) -> Reading:
        """Judge what was typed; a bad text stays to be corrected. What nobody touched is good."""
        if not self.is_typing:
            return Reading(self.value)
        return self._judged()

    def _judged(self) -> Reading:
        reading = self._check(self.value)
        self.set_class(not reading.is_good, "-wrong")
        return reading

    def watch_value(self) -> None:
        """Judge at each key."""
        if self.is_open:
            self._owner.tell_reading(self._judged())

    def action_done(self, then: Then = "stay") -> None:
        """Take the text and go on."""
        reading = self._judged()
        if reading.is_good:
            self._owner.done(then)
        else:
            self._owner.tell_reading(reading)
            self.correct(reading)

    def action_right(self) -> None:
        """Go on where something was typed up to here, as in a spreadsheet; else move the cursor."""
        if self.is_typing and self.cursor_position == len(self.value) and self.selection.is_empty:
            self.action_done("right")
        else:
            self.action_cursor_right()

    def action_abandon(self) -> None:
        """Leave the value as it was."""
        self._owner.abandon()

    def on_blur(self, event: events.Blur) -> None:
        """A press of the mouse elsewhere takes the value, if it is good."""
        self.call_after_refresh(self._end_if_left)

    def _end_if_left(self) -> None:
        """Not where the next value is edited meanwhile, nor where the window lost the focus."""
        if not self.is_open or self.is_here or not self.app.app_focus:
            return
        reading = self._check(self.value)
        if not self.is_typing:
            self._owner.abandon()
        elif reading.is_good:
            self._owner.done("stay")
        else:
            # behind what follows the focus, which takes away what is told
            reason = f"`{self.value}` is not taken: {reading.note}"
            self.call_after_refresh(self._owner.abandon, reason)
