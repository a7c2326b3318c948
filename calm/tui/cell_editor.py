"""Table whose values are edited in place."""

from collections.abc import Callable
from typing import Literal

from textual import events
from textual.app import ComposeResult
from textual.containers import Vertical

from calm.tui import field, key_table
from calm.tui.checking import Check, Reading, anything
from calm.tui.scrolled import TableCells

Then = Literal["stay", "edit next", "right", "up", "down"]
"""Cursor movement after a value is accepted."""


class EditableTable(Vertical):
    """Table with an input line over the edited cell.

    Subclasses call `open_editor`, and implement `write` and `go_on`. `tell` shows a message in the
    last line of the screen.
    """

    DEFAULT_CSS = "EditableTable { layers: table over; }"

    def __init__(
        self, tell: Callable[..., object], table: TableCells, *, id: str | None = None
    ) -> None:
        super().__init__(id=id)
        self.tell, self.table, self.editor = tell, table, CellEditor(self)

    def compose(self) -> ComposeResult:
        yield self.table
        yield self.editor

    def write(self, text: str) -> None:
        """Write a valid text to the edited cell."""
        raise NotImplementedError

    def tell_reading(self, reading: Reading) -> None:
        """Show the interpretation of the typed text, or the error in the text."""
        self.tell(reading.feedback(self.editor.value), wrong=not reading.is_good)

    def go_on(self, then: Then, text: str | None) -> None:
        """Move the cursor after a text is accepted; `text` is None if the value is unchanged."""
        raise NotImplementedError

    def abandoned(self) -> None:
        """Do nothing; subclasses may react when the user cancels editing."""

    def action_move_column(self, by: int) -> None:
        self.table.column += by

    @property
    def is_typing(self) -> bool:
        """Whether the editor contains typed text that is not written yet."""
        return self.editor.is_typing

    def open_editor(
        self, text: str, check: Check, *, least_width: int, begun: bool = False
    ) -> None:
        """Edit the cell under the cursor.

        `check` checks the typed text. `least_width` is in cells. If `begun` is true, the user has
        just typed the initial text.
        """
        region, editor = self.table.cell_region(), self.editor
        editor.styles.offset = region.offset
        editor.styles.width = max(region.width, least_width)
        editor.open(text, check, begun=begun)

    def settle(self) -> bool:
        """Write the typed text to its cell; return whether the text is valid.

        An invalid text stays in the editor, with a message.
        """
        reading = self.editor.settle()
        if not reading.is_good:
            self.editor.focus()
            self.tell(f"Not accepted yet: {reading.note}", wrong=True)
        elif self.editor.is_open:
            self._take_typed()
        return reading.is_good

    def _take_typed(self) -> str | None:
        text = self.editor.text
        self.leave_cell()
        if text is not None:
            self.write(text)
        return text

    def leave_cell(self) -> None:
        """Close the editor and discard the typed text."""
        if self.editor.is_open:
            self.editor.remove_class("-open", "-wrong")
            if self.editor.is_here:
                self.table.focus()
            self.tell("")

    def done(self, then: Then) -> None:
        """Write the typed text, and move the cursor if the editor has the focus."""
        is_here = self.editor.is_here
        text = self._take_typed()
        if is_here:
            self.go_on(then, text)

    def abandon(self, reason: str = "") -> None:
        """Cancel editing.

        If an invalid text is discarded, `reason` is the error message to show.
        """
        self.leave_cell()
        self.abandoned()
        if reason:
            self.tell(reason, wrong=True)


class CellEditor(field.ScrolledEntry):
    """Input line over a table cell; the typed text is interpreted at each key press."""

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
        self._before = ""  # text at the start of editing

    @property
    def is_open(self) -> bool:
        """Whether a value is being edited."""
        return self.has_class("-open")

    @property
    def is_here(self) -> bool:
        """Whether the editor has the focus now; Textual updates `has_focus` with a delay."""
        return self.screen.focused is self

    def open(self, text: str, check: Check, *, begun: bool = False) -> None:
        """Open the editor with a text.

        The next key replaces the text. If the text is the key that opened the editor (`begun`), the
        next key is appended.
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
        """Whether the text differs from the previous value of the cell."""
        return self.is_open and self.value != self._before

    @property
    def text(self) -> str | None:
        """Text to write to the cell; None if the text is unchanged or invalid."""
        reading = self._check(self.value)
        # an untouched value may get a unit, but is not tidied
        is_completed = reading.text.startswith(f"{self.value.strip()} ")
        return reading.text if reading.is_good and (self.is_typing or is_completed) else None

    def settle(self) -> Reading:
        """Return the interpretation of the text; an unchanged text is always valid."""
        if not self.is_typing:
            return Reading(self.value)
        return self._judged()

    def _judged(self) -> Reading:
        reading = self._check(self.value)
        self.set_class(not reading.is_good, "-wrong")
        return reading

    def watch_value(self) -> None:
        if self.is_open:
            self._owner.tell_reading(self._judged())

    def action_done(self, then: Then = "stay") -> None:
        reading = self._judged()
        if reading.is_good:
            self._owner.done(then)
        else:
            self._owner.tell_reading(reading)
            self.correct(reading)

    def action_right(self) -> None:
        # as in a spreadsheet
        if self.is_typing and self.cursor_position == len(self.value) and self.selection.is_empty:
            self.action_done("right")
        else:
            self.action_cursor_right()

    def action_abandon(self) -> None:
        self._owner.abandon()

    def on_blur(self, event: events.Blur) -> None:
        self.call_after_refresh(self._end_if_left)

    def _end_if_left(self) -> None:
        # the editor has opened for another cell (`is_here`), or the window has lost the focus
        if not self.is_open or self.is_here or not self.app.app_focus:
            return
        reading = self._check(self.value)
        if not self.is_typing:
            self._owner.abandon()
        elif reading.is_good:
            self._owner.done("stay")
        else:
            # runs after the focus handlers, which remove messages
            reason = f"`{self.value}` was not accepted: {reading.note}"
            self.call_after_refresh(self._owner.abandon, reason)
