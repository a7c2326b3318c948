"""The line: its rows and what is done with them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

from textual import on
from textual.binding import BindingType
from textual.message import Message

from calm.checks.finding import State
from calm.files import Place
from calm.tui.catalogue.catalogue_pane import Purpose
from calm.tui.catalogue.component_screen import id_check
from calm.tui.cell_editor import CellEditor
from calm.tui.checking import Reading
from calm.tui.dialogs import Answer, Asked, InputSheet, Question, ask, choose
from calm.tui.key_table import bindings
from calm.tui.line.filling import ask_column, ask_equipment, ask_times, rows_meant
from calm.tui.line.rows import LineCell, table_rows
from calm.tui.line.table import EDITABLE, Column, LineSearch, LineTable
from calm.tui.names import Named, namings
from calm.tui.verdict_text import Saying, why
from calm.tui.workspace import Workspace

_LEAST_WIDTHS: dict[Column, int] = {"length": 16}
_LEAST_WIDTH = 6
_MIXED = "Pieces are marked, and clamps of other pieces; mark pieces only, or clamps only"


class LinePane(LineSearch):
    """Edit the line: its cells, its rows and their order."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("line")]
    DEFAULT_CSS = "LinePane { width: 3fr; height: 1fr; }"

    @dataclass
    class ComponentWanted(Message):
        """A component is to be chosen for the row under the cursor."""

        purpose: Purpose

    class BackWanted(Message):
        """Back to the line of the verdict that led to the row."""

    @dataclass
    class ChangeWanted(Message):
        """A component of the file is to be changed in its form."""

        id: str

    def __init__(self, workspace: Workspace) -> None:
        self.table: LineTable = LineTable(id="line")
        super().__init__(self.table, editor_id="cell", id="line-pane")
        self.workspace, self.session = workspace, workspace.session
        self.came_from_verdict = False
        self._cell: LineCell | None = None  # what is edited, or was last

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """The keys of the rows are not those of a value that is typed."""
        return not self.editor.is_open

    def show_rows(self) -> None:
        """Show the rows as they are now, with the figures that are known of them."""
        workspace, view = self.workspace, self.workspace.view
        workspace.refresh_index()
        figures = view if view is not None and (view.rows or view.problems) else workspace.good
        rows = table_rows(self.session.draft, figures, workspace.index, self.session.added)
        self.table.show_rows(rows, old=workspace.is_old)

    def show_draft(self, spot: Place | None = None) -> None:
        """Show the draft, another one now; the cursor goes to a row, or stays where it is."""
        here = self.table.spot if spot is None else spot
        self.forget()
        self.show_rows()
        self.table.go_to(here)

    def forget(self) -> None:
        """The piece that is marked or edited may be another one now."""
        self.leave_cell()
        self.table.mark(frozenset())

    def attempt(self, change: Callable[[], object], message: str = "") -> bool:
        """Make a change, after what is typed in place is taken. Whether it was made."""
        if not self.settle():
            return False
        self.session.followed = []
        is_made, spot = self.workspace.attempt(change)
        if is_made:
            self._show_edited(spot, message)
        return is_made

    def _show_edited(self, spot: Place | None = None, message: str = "") -> None:
        """Show the draft, which was edited, and have it judged."""
        self.show_draft(spot)
        self.workspace.tell("; ".join([*filter(None, [message]), *self.session.followed]))
        self.workspace.edited()

    # the cursor and the marks

    def action_move_cursor(self, by: int) -> None:
        """Go up or down."""
        self.table.cursor += by

    def action_move_page(self, by: int) -> None:
        """Go a page up or down."""
        self.table.cursor += by * max(self.table.size.height - 2, 1)

    def action_move_to_end(self, way: int) -> None:
        """Go to the top or the bottom."""
        self.table.cursor = 0 if way < 0 else len(self.table.rows) - 1

    def action_move_column(self, by: int) -> None:
        """Go to the left or the right."""
        self.table.column += by

    def action_mark(self, by: int) -> None:
        """Mark the row or not, and go on."""
        spot = self.table.spot
        if spot is not None:
            self.table.mark(self.table.marked ^ {spot} if by == 0 else self.table.marked | {spot})
            self.table.cursor += by
            if by and self.table.spot is not None:
                self.table.mark(self.table.marked | {self.table.spot})

    def action_mark_all(self) -> None:
        """Mark all pieces, or none where all are."""
        pieces = frozenset(row.spot for row in self.table.rows if not row.spot.is_clamp)
        self.table.mark(frozenset() if self.table.marked >= pieces else pieces)

    # what was found

    def action_next_finding(self) -> None:
        """Go to the next row that a failure, else a warning, else a missing figure is found of."""
        rows, here = self.table.rows, self.table.cursor
        around = [*range(here + 1, len(rows)), *range(here + 1)]
        for state in (State.FAIL, State.WARN, State.UNKNOWN):
            number = next((each for each in around if rows[each].state is state), None)
            if number is not None:
                self.table.cursor = number
                for gravest in self._found_of(rows[number].spot)[:1]:
                    message = f"{gravest.sign} {gravest.heading}: {gravest.text}"
                    self.workspace.tell(message, wrong=gravest.state is State.FAIL)
                return
        self.workspace.tell("There are no findings")

    def _found_of(self, spot: Place) -> list[Saying]:
        """Return what is known now of a row, the gravest first."""
        view = self.workspace.view
        return why(view, spot) if view is not None and self.workspace.is_fresh else []

    def action_back(self) -> None:
        """Back to the verdict, where it has led here."""
        if self.came_from_verdict:
            self.came_from_verdict = False
            self.post_message(self.BackWanted())

    def action_why(self) -> None:
        """Show all that was found of the row under the cursor."""
        row = self.table.row
        if row is None:
            return
        found = self._found_of(row.spot)
        if not found:
            self.workspace.tell("There are no findings for this row, or it is not judged yet")
            return
        text = "\n".join(f"{each.sign} {each.heading}  {each.text}" for each in found)
        called = row.texts.get("label") or row.texts["component"]
        choose(self.app, Question(called, text, [Answer("b", "back to the row")]))

    # rows

    def action_add(self, below: int) -> None:
        """Add a piece below, or above."""
        self.post_message(self.ComponentWanted("below" if below else "above"))

    def action_clamp(self) -> None:
        """Clamp an instrument on the piece."""
        if self.table.spot is None:
            self.workspace.tell("There is no piece yet to clamp it on")
        else:
            self.post_message(self.ComponentWanted("clamp"))

    def action_replace(self) -> None:
        """Use another component."""
        if self.table.spot is not None:
            self.post_message(self.ComponentWanted("replace"))

    def action_change_component(self) -> None:
        """Change the component of the row in its form."""
        if self.table.spot is not None and self.settle():
            self.post_message(self.ChangeWanted(self.session.item(self.table.spot).values["use"]))

    def action_equipment(self) -> None:
        """Serial number, calibration and more of the row."""
        if self.table.spot is not None and self.settle():
            ask_equipment(self, self.table.spot)

    def action_assemble(self) -> None:
        """Make an assembly of what is chosen."""
        chosen = self.table.chosen
        if not chosen or not self.settle():
            return

        def take(texts: dict[str, str]) -> None:
            self.attempt(
                lambda: self.session.assemble(chosen, texts["id"]),
                f"{texts['id']} is defined in the file; add it again with a",
            )

        own = self.session.draft.value(("components",))
        check = id_check(own if isinstance(own, dict) else ())
        asked = [Asked("id", "Id", check=check, placeholder="e.g. glass-pack-own")]
        text = "The pieces go into the file's components; `use` of this id stands for them."
        ask(self.app, InputSheet("Make an assembly", text, asked), take)

    def action_column(self) -> None:
        """Fill a column of the rows that are meant."""
        if self.table.rows and self.settle():
            ask_column(self, rows_meant(self.table))

    def action_repeat(self) -> None:
        """Repeat what is chosen several times."""
        chosen = self._chosen_of_a_kind()
        if chosen and self.settle():
            ask_times(self, chosen)

    def action_duplicate(self) -> None:
        """Repeat what is chosen."""
        chosen = self._chosen_of_a_kind()
        named = [each for spot in chosen for each in namings(self.session.draft, spot)]
        one = partial(self._duplicate, chosen)
        if not named:
            one()
            return
        text = "\n".join(f"{each.where} names {each.text}" for each in named)
        answers = [
            Answer("o", "the one that is there; the copy stands for itself", one),
            Answer("b", "both (`NAME *`) in what is accepted", partial(one, named)),
        ]
        choose(self.app, Question("Is the copy meant, too?", text, answers))

    def _duplicate(self, chosen: tuple[Place, ...], also: Sequence[Named] = ()) -> None:
        def change() -> Place | None:
            return self.session.duplicate(chosen, also)

        if chosen:
            self.attempt(change)

    def action_delete(self) -> None:
        """Take out what is chosen."""
        chosen = self.table.chosen
        if chosen:
            count = f"{len(chosen)} rows" if len(chosen) > 1 else "deleted"
            self.attempt(lambda: self.session.delete(chosen), f"{count}; u brings it back")

    def action_move_piece(self, by: int) -> None:
        """Move what is chosen up or down."""
        marked, chosen = self.table.marked, self._chosen_of_a_kind()
        if not chosen:
            return
        moved: list[Place] = []

        def move() -> Place | None:
            moved.extend(self.session.move(chosen, by))
            return moved[0] if moved else None

        if self.attempt(move) and marked:
            self.table.mark(frozenset(moved))

    def action_copy(self) -> None:
        """Keep what is chosen for pasting."""
        copied = self.session.copy(self._chosen_of_a_kind())
        if copied:
            self.table.mark(frozenset())
            self.workspace.tell(f"{copied} row{'s' * (copied != 1)} copied; v pastes below")

    def action_cut(self) -> None:
        """Take out what is chosen, for pasting."""
        chosen = self._chosen_of_a_kind()
        if self.session.copy(chosen):
            self.attempt(lambda: self.session.delete(chosen), "cut; v pastes below")

    def action_paste(self, below: int) -> None:
        """Put in what was copied."""
        if not len(self.session.copied):
            self.workspace.tell("Nothing was copied yet")
        else:
            self.attempt(lambda: self.session.paste(self.table.spot, below=bool(below)))

    def _chosen_of_a_kind(self) -> tuple[Place, ...]:
        """Return what is chosen; nothing, with a report, where clamps of other pieces are with
        pieces.

        They have no place of their own among pieces that are pasted or moved.
        """
        chosen = self.table.chosen
        pieces = {spot.item for spot in chosen if not spot.is_clamp}
        if pieces and any(spot.is_clamp and spot.item not in pieces for spot in chosen):
            self.workspace.tell(_MIXED, wrong=True)
            return ()
        return chosen

    # a value in place

    def action_edit(self) -> None:
        """Edit the value under the cursor."""
        self.action_edit_column(self.table.cell)

    @on(LineTable.Pressed)
    def _pressed(self) -> None:
        self.action_edit()

    def action_edit_column(self, column: Column) -> None:
        """Edit a value of the row under the cursor."""
        spot = self.table.spot
        if spot is None:
            self.action_add(1)
        elif column == "component":
            self.action_replace()
        else:
            self._edit(LineCell(self.workspace, spot, column))

    def _edit(self, cell: LineCell) -> None:
        """Edit a value, after what is typed in another is taken."""
        if refused := cell.refused:
            self.workspace.tell(refused)
        if refused or not self.settle():
            return
        self.table.column = EDITABLE.index(cell.column)
        self._cell = cell
        least = _LEAST_WIDTHS.get(cell.column, _LEAST_WIDTH)
        self.open_editor(cell.text, cell.check, least_width=least)

    def settle(self) -> bool:
        """Take what is typed in a cell; a bad value stays to be corrected."""
        reading = self.settle_cell()
        if not reading.is_good:
            self.tell_refusal(f"Not taken yet: {reading.note}")
        return reading.is_good

    def write(self, text: str) -> None:
        """Write a good text into the draft."""
        cell, before = self._cell, self.session.draft
        is_put = cell is not None and self.workspace.attempt(lambda: cell.put(text))[0]
        if is_put and self.session.draft is not before:
            self._show_edited()

    def leave_cell(self) -> None:
        """Edit nothing any more; what is typed is not taken."""
        if self.editor.is_open:
            super().leave_cell()
            self.workspace.tell("")

    def tell_reading(self, reading: Reading) -> None:
        """Tell what the text typed so far comes to."""
        completed = reading.text if reading.text != self.editor.value.strip() else ""
        note = reading.note or (f"= {completed}" if completed and reading.is_good else "")
        self.workspace.tell(note, wrong=not reading.is_good)

    def tell_refusal(self, reason: str) -> None:
        """Tell why something is not done."""
        self.workspace.tell(reason, wrong=True)

    def go_on(self, done: CellEditor.Done) -> None:
        """Go to the next value of the row, or to another row."""
        onward = self._cell.onward() if self._cell and done.then == "edit next" else None
        if onward is not None:
            self._edit(onward)
        self.table.column += done.then == "right"
        self.table.cursor += (done.then == "down") - (done.then == "up")
