"""Pane with the rows of the line, and the commands that edit the rows."""

from collections.abc import Callable, Sequence
from functools import partial

from textual import on

from calm.checks.finding import State
from calm.files import Place
from calm.tui.catalogue_pane import Purpose
from calm.tui.cell_editor import Then
from calm.tui.checking import count
from calm.tui.dialogs import Answer, Question, ask, choose, enter
from calm.tui.forms import FormField
from calm.tui.key_table import bindings
from calm.tui.line_rows import ColumnFilling, LineCell, table_rows
from calm.tui.line_table import EDITABLE, Column, LineSearch, LineTable
from calm.tui.mooring_sheet import equipment_changes, equipment_sheet
from calm.tui.names import Named, references_to
from calm.tui.verdict_text import VerdictLine, why
from calm.tui.workspace import Workspace

_MIXED = "Pieces and clamps on other pieces are both marked; mark only pieces or only clamps"
_FROM_A_ROW = frozenset(
    {"mark", "why", "equipment", "column", "repeat", "duplicate", "delete",
     "move_piece", "cut"}
)  # fmt: skip
"""Actions that need at least one row."""


class LinePane(LineSearch):
    """Pane in which the cells and rows of the line are edited.

    Parameters
    ----------
    search : function that opens the catalogue to find a component for the row under the cursor
    """

    BINDINGS = bindings("line")
    DEFAULT_CSS = "LinePane { width: 3fr; height: 1fr; }"

    def __init__(self, workspace: Workspace, search: Callable[[Purpose], object]) -> None:
        self.table: LineTable = LineTable(id="line")
        super().__init__(workspace.tell, self.table, id="line-pane")
        self.workspace, self.session, self._search = workspace, workspace.session, search
        self._cell: LineCell | None = None  # the cell edited now or last

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return not self.editor.is_open and (bool(self.table.rows) or action not in _FROM_A_ROW)

    def show_rows(self) -> None:
        """Show the rows of the draft, with the results or the mistakes of the latest view.

        If the latest view has neither results nor mistakes, the rows show the results of the last
        draft with an equilibrium.
        """
        workspace, view = self.workspace, self.workspace.view
        workspace.refresh_index()
        figures = view if view is not None and (view.rows or view.problems) else workspace.good
        rows = table_rows(self.session.draft, figures, workspace.index, self.session.added)
        self.table.show_rows(rows, old=workspace.is_old)

    def show_draft(self, spot: Place | None = None) -> None:
        """Show a new draft, and move the cursor to the row at `spot`, if given."""
        here = self.table.spot if spot is None else spot
        self.leave_cell()
        self.table.mark(frozenset())
        self.show_rows()
        self.table.go_to(here)

    def attempt(self, change: Callable[[], object], message: str = "") -> bool:
        """Accept typed text and make a change; return whether the change was made."""
        if not self.settle():
            return False
        self.session.followed = []
        is_made, spot = self.workspace.attempt(change)
        if is_made:
            self._show_edited(spot, message)
        return is_made

    def _show_edited(self, spot: Place | None = None, message: str = "") -> None:
        self.show_draft(spot)
        self.workspace.tell("; ".join([*filter(None, [message]), *self.session.followed]))
        self.workspace.edited()

    # the cursor and the marks

    def action_move_cursor(self, by: int) -> None:
        self.table.cursor += by

    def action_move_page(self, by: int) -> None:
        self.table.cursor += by * max(self.table.size.height - 2, 1)

    def action_move_to_end(self, direction: int) -> None:
        self.table.cursor = 0 if direction < 0 else len(self.table.rows) - 1

    def action_mark(self, by: int) -> None:
        table = self.table
        marked, spot = table.marked, table.chosen_here
        table.cursor += by
        # `by` = 0 toggles the mark of the row
        table.mark(marked | {spot, table.chosen_here} if by else marked ^ {spot})

    def action_mark_all(self) -> None:
        pieces = frozenset(row.spot for row in self.table.rows if not row.spot.is_clamp)
        self.table.mark(frozenset() if self.table.marked >= pieces else pieces)

    # findings

    def action_next_finding(self) -> None:
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

    def _found_of(self, spot: Place) -> list[VerdictLine]:
        view = self.workspace.view
        return why(view, spot) if view is not None and self.workspace.is_fresh else []

    def action_why(self) -> None:
        row = self.table.rows[self.table.cursor]
        found = self._found_of(row.spot)
        if not found:
            self.workspace.tell("This row has no findings, or is not judged yet")
            return
        text = "\n".join(f"{each.sign} {each.heading}  {each.text}" for each in found)
        called = row.texts.get("label") or row.texts["component"]
        choose(self.app, Question(called, text, [Answer("b", "back to the row")]))

    # rows

    def action_search(self, purpose: Purpose) -> None:
        if self.table.rows or purpose in ("below", "above"):
            self._search(purpose)
        elif purpose == "clamp":
            self.workspace.tell("Add a piece before clamping an instrument")

    def action_equipment(self) -> None:
        spot = self.table.chosen_here
        values = self.session.written(spot)
        label = str(values.get("label") or values.get("use") or "")
        if refused := LineCell(self.workspace, spot, "serial").refused:
            self.workspace.tell(f"{label} {refused}")
            return

        def take(texts: dict[str, str]) -> None:
            changed = equipment_changes(values, texts)
            if changed:
                self.attempt(lambda: self.session.put({spot: changed}, f"equipment of {label}"))

        ask(self.app, equipment_sheet(label, values, is_clamp=spot.is_clamp), take)

    def action_column(self) -> None:
        table = self.table
        spots = table.chosen
        if not table.marked:
            use = table.rows[table.cursor].texts["component"]
            spots = tuple(row.spot for row in table.rows if row.texts["component"] == use)

        def fill(column: str) -> None:
            filling = ColumnFilling(self.workspace, spots, column)
            if (sheet := filling.sheet) is None:
                self.workspace.tell("These rows cannot have such a value")
            else:
                ask(self.app, sheet, lambda texts: self.attempt(lambda: filling.write(texts)))

        answers = [
            Answer("s", "serial numbers", partial(fill, "serial")),
            Answer("l", "lengths", partial(fill, "length")),
            Answer("n", "labels", partial(fill, "label")),
            Answer("c", "codes of releases that have serial numbers", partial(fill, "codes")),
        ]
        text = f"Values of {len(spots)} rows, one below the other; you can paste a copied list."
        choose(self.app, Question("Fill a column", text, answers))

    def action_repeat(self) -> None:
        chosen = self._unmixed_selection()

        def take(texts: dict[str, str]) -> None:
            self.attempt(lambda: self.session.duplicate(chosen, times=int(texts["count"])))

        if chosen:
            fields = [FormField("count", "Copies below", check=count)]
            enter(self.app, "Repeat", "", fields, take)

    def action_duplicate(self) -> None:
        chosen = self._unmixed_selection()
        named = [each for spot in chosen for each in references_to(self.session.draft, spot)]

        def duplicate(also: Sequence[Named] = ()) -> None:
            self.attempt(lambda: self.session.duplicate(chosen, also))

        if named:
            text = "\n".join(f"{each.where} refers to {each.text}" for each in named)
            answers = [
                Answer("o", "the original only", duplicate),
                Answer(
                    "b",
                    "original and copy; accepted findings will refer to `NAME *`",
                    partial(duplicate, named),
                ),
            ]
            choose(self.app, Question("Which pieces should these entries refer to?", text, answers))
        elif chosen:
            duplicate()

    def action_delete(self) -> None:
        chosen = self.table.chosen
        what = f"{len(chosen)} rows" if len(chosen) > 1 else "deleted"
        self.attempt(lambda: self.session.delete(chosen), f"{what}; u restores")

    def action_move_piece(self, by: int) -> None:
        marked, chosen = self.table.marked, self._unmixed_selection()
        moved: list[Place] = []

        def move() -> Place:
            moved.extend(self.session.move(chosen, by))
            return moved[0]

        if chosen and self.attempt(move) and marked:
            self.table.mark(frozenset(moved))

    def action_copy(self) -> None:
        if copied := self.session.copy(self._unmixed_selection()):
            self.table.mark(frozenset())
            self.workspace.tell(f"{copied} row{'s' * (copied != 1)} copied; v pastes below")

    def action_cut(self) -> None:
        chosen = self._unmixed_selection()
        if self.session.copy(chosen):
            self.attempt(lambda: self.session.delete(chosen), "cut; v pastes below")

    def action_paste(self, below: int) -> None:
        if not self.session.copied:
            self.workspace.tell("There are no copied rows to paste")
        else:
            self.attempt(lambda: self.session.paste(self.table.spot, below=bool(below)))

    def _unmixed_selection(self) -> tuple[Place, ...]:
        chosen = self.table.chosen
        pieces = {spot.item for spot in chosen if not spot.is_clamp}
        # a clamp on another piece has no position among pieces that are pasted or moved
        if pieces and any(spot.is_clamp and spot.item not in pieces for spot in chosen):
            self.workspace.tell(_MIXED, wrong=True)
            return ()
        return chosen

    # a value in place

    def action_edit(self) -> None:
        self.action_edit_column(EDITABLE[self.table.column])

    @on(LineTable.Pressed)
    def _pressed(self) -> None:
        self.action_edit()

    def action_edit_column(self, column: Column) -> None:
        spot = self.table.spot
        if spot is None:
            self._search("below")
        elif column == "component":
            self._search("replace")
        else:
            self._edit(LineCell(self.workspace, spot, column))

    def _edit(self, cell: LineCell) -> None:
        if refused := cell.refused:
            self.workspace.tell(refused)
        if refused or not self.settle():
            return
        self.table.column = EDITABLE.index(cell.column)
        self._cell = cell
        least = 16 if cell.column == "length" else 6
        self.open_editor(cell.text, cell.check, least_width=least)

    def write(self, text: str) -> None:
        cell, before = self._cell, self.session.draft
        is_put = cell is not None and self.workspace.attempt(lambda: cell.put(text))[0]
        if is_put and self.session.draft is not before:
            self._show_edited()

    def go_on(self, then: Then, text: str | None) -> None:
        onward = self._cell.onward() if self._cell and then == "edit next" else None
        if onward is not None:
            self._edit(onward)
        self.table.column += then == "right"
        self.table.cursor += (then == "down") - (then == "up")
