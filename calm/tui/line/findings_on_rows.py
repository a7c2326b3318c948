"""What was found of the rows of the line: from one to the next, and all that is said of one."""

from __future__ import annotations

from calm.checks.finding import State
from calm.files import Place
from calm.tui.dialogs import Answer, Question
from calm.tui.line.table import LineTable
from calm.tui.messages import Workspace
from calm.tui.verdict_text import Saying, why

_GRAVE = (State.FAIL, State.WARN, State.UNKNOWN)


class RowFindings:
    """The findings of the rows of a table, as they are known now."""

    def __init__(self, workspace: Workspace, table: LineTable) -> None:
        self._workspace, self._table = workspace, table

    def go_to_next(self) -> None:
        """Go to the next row that a failure is found of, or else a warning or a missing figure."""
        rows, here = self._table.rows, self._table.cursor
        around = [*range(here + 1, len(rows)), *range(here + 1)]
        for state in _GRAVE:
            number = next((each for each in around if rows[each].state is state), None)
            if number is not None:
                self._table.cursor = number
                self._tell(self._of(rows[number].spot))
                return
        self._workspace.tell("There are no findings")

    def of_row(self) -> Question | None:
        """All that was found of the row under the cursor; None, with a report, where nothing is."""
        spot, row = self._table.spot, self._table.row
        if spot is None or row is None:
            return None
        found = self._of(spot)
        if not found:
            self._workspace.tell("There are no findings for this row, or it is not judged yet")
            return None
        text = "\n".join(f"{each.sign} {each.heading}  {each.text}" for each in found)
        called = row.texts.get("label") or row.texts["component"]
        return Question(called, text, [Answer("b", "back to the row", "back")])

    def _tell(self, found: list[Saying]) -> None:
        if found:
            gravest = found[0]
            message = f"{gravest.sign} {gravest.heading}: {gravest.text}"
            self._workspace.tell(message, wrong=gravest.state is State.FAIL)

    def _of(self, spot: Place) -> list[Saying]:
        view = self._workspace.view
        return why(view, spot) if view is not None and self._workspace.is_fresh else []
