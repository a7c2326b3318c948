"""Rows of the line: where the cursor is, what is marked, and what is done with it."""

from __future__ import annotations

from calm.files import Place
from calm.tui.line.builder_base import BuilderBase

_MIXED = "Pieces are marked, and clamps of other pieces; mark pieces only, or clamps only"


class RowVerbs(BuilderBase):
    """Moving about, marking, copying, deleting, moving."""

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

    def action_duplicate(self) -> None:
        """Repeat what is chosen."""
        chosen = self._chosen_of_a_kind()
        if chosen:
            self.attempt(lambda: self.session.duplicate(chosen))

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

    def action_copy(self) -> None:
        """Keep what is chosen for pasting."""
        copied = self.session.copy(self._chosen_of_a_kind())
        if copied:
            self.table.mark(frozenset())
            self.tell(f"{copied} row{'s' * (copied != 1)} copied; v pastes below")

    def action_cut(self) -> None:
        """Take out what is chosen, for pasting."""
        chosen = self._chosen_of_a_kind()
        if self.session.copy(chosen):
            self.attempt(lambda: self.session.delete(chosen), "cut; v pastes below")

    def action_paste(self, below: int) -> None:
        """Put in what was copied."""
        if not len(self.session.copied):
            self.tell("Nothing was copied yet")
        else:
            self.attempt(lambda: self.session.paste(self.table.spot, below=bool(below)))

    def _chosen_of_a_kind(self) -> tuple[Place, ...]:
        """What is chosen; nothing, and that is told, where clamps of other pieces are with pieces.

        They have no place of their own among pieces that are pasted or moved.
        """
        chosen = self.table.chosen
        pieces = {spot.item for spot in chosen if not spot.is_clamp}
        if pieces and any(spot.is_clamp and spot.item not in pieces for spot in chosen):
            self.tell(_MIXED, wrong=True)
            return ()
        return chosen
