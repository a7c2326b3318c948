"""Ways through the line: words that are found, the least margins, the next of a kind."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from calm.checks.strength import strength
from calm.files import Place
from calm.tui.checking import needed
from calm.tui.dialogs import Asked, InputSheet
from calm.tui.line.table import LineTable, TableRow
from calm.tui.messages import Workspace


class Going:
    """Moves the cursor of the table to what is looked for, and tells what it is."""

    def __init__(self, workspace: Workspace, table: LineTable) -> None:
        self._workspace, self._table = workspace, table
        self.words = ""

    def ask(self) -> None:
        """Ask for the words, and go to the next row that has them."""

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                self.words = texts["words"]
                self.to_words()

        asked = [Asked("words", "Words", self.words, needed("a word"), "id, label, serial, maker")]
        self._table.app.push_screen(InputSheet("Find in the line", "", asked), take)

    def to_words(self, by: int = 1) -> None:
        """To the next row, or the one before, that has all words: id, label, serial, maker."""
        wanted = self.words.casefold().split()
        if not wanted:
            self._workspace.tell("/ finds words in the line first")
            return
        self._to(by, lambda row: all(word in self._said(row) for word in wanted), self.words)

    def to_alike(self, by: int) -> None:
        """To the next row, or the one before, of the same kind of component."""
        here = self._table.row
        if here is not None:
            self._to(by, lambda row: row.sign == here.sign, "of its kind")

    def to_least(self, *, loads: bool) -> None:
        """To the row with the least margin of all, or of the `loads` that pieces bear."""
        view = self._workspace.view
        if view is None or not self._workspace.is_fresh:
            self._workspace.tell("The line is still being judged; ask again")
            return
        found = [
            (each.share, each.place.row, each)
            for each in (*view.findings, *view.tighter)
            if each.share is not None and each.place is not None
            if not loads or each.rule == strength.name
        ]
        if not found:
            self._workspace.tell("No margin is known")
            return
        share, place, finding = min(found, key=lambda each: each[0])
        self._table.go_to(place)
        what = "The weakest" if loads else "The lowest margin"
        self._workspace.tell(f"{what}, {share:+.0%}: {finding.component}, {finding.message}")

    def _to(self, by: int, is_wanted: Callable[[TableRow], bool], what: str) -> None:
        rows: Sequence[TableRow] = self._table.rows
        found = [number for number, row in enumerate(rows) if is_wanted(row)]
        if not found:
            self._workspace.tell(f"Nothing in the line has `{what}`", wrong=True)
            return
        here = self._table.cursor
        beyond = [each for each in found[::by] if (each - here) * by > 0]
        number = (beyond or found[::by])[0]
        self._table.cursor = number
        self._workspace.tell(f"{found.index(number) + 1} of {len(found)} {what}")

    def _said(self, row: TableRow) -> str:
        """What a row says, and the catalogue of its component."""
        index, use = self._workspace.index, row.texts["component"].split()[-1:]
        listed = index.get(use[0]) if index and use else None
        values = self._workspace.session.draft.value(location(row.spot))
        serial = values.get("serial", "") if isinstance(values, dict) else ""
        own = f"{row.texts['component']} {row.texts.get('label', '')} {serial}".casefold()
        return f"{own} {listed.searched}" if listed else own


def location(spot: Place) -> tuple[str | int, ...]:
    """Where a row stands in the file."""
    return ("line", spot.item, *(("clamps", spot.clamp) if spot.is_clamp else ()))
