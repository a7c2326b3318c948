"""Editing session of a file: text, history, clipboard and all editing operations.

This module depends neither on the screen nor on the solver.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from calm.files import Place, editing
from calm.files.editing import LINE, Draft, History, LineItem, Value, WorkingFile, clamps_of
from calm.files.yaml_document import Location
from calm.tui.names import EnvironmentChoice, Named, followed, with_extended_acceptances

_OF_THE_ROW = frozenset({"use", "label", "count", "at", "clamps"})
"""Row keys that do not depend on the component."""


class Session:
    """Editing session of a mooring or tow file.

    Attributes
    ----------
    catalogs : catalogue files given on the command line
    copied : text of the copied items or clamps
    choice : choice of the environment in which the line is solved
    after_save : function called with the path and text of a saved file
    added : rows added by the last change
    followed : messages on references to labels that the last change updated

    Raises
    ------
    EditError
        Raised by every operation that the text does not allow; the text then stays unchanged.
    NotWritten
        Raised by `save` and `save_as` if the file cannot be written.
    """

    def __init__(
        self,
        file: WorkingFile,
        text: str,
        *,
        environment: str | None = None,
        catalogs: Sequence[Path] = (),
    ) -> None:
        self.history = History(Draft(text))
        self.file = file
        self.catalogs = tuple(catalogs)
        self.copied: tuple[str, ...] = ()
        self._are_clamps = False  # whether the clipboard contains clamps
        self.followed: list[str] = []
        self.added: frozenset[Place] = frozenset()
        self.choice = EnvironmentChoice(self.history, environment)
        self.after_save: Callable[[Path, str], object] | None = None

    @property
    def draft(self) -> Draft:
        """The current draft of the file."""
        return self.history.draft

    @property
    def changed(self) -> bool:
        """Whether there are unsaved changes."""
        return self.history.changed

    @property
    def name(self) -> str:
        """Name of the file, for messages."""
        path = self.file.path
        return "unnamed" if path is None else path.name

    @property
    def components(self) -> dict[str, Any]:
        """Components defined in the file, with values as typed."""
        defined = self.draft.value(("components",))
        return defined if isinstance(defined, dict) else {}

    # the line

    def spots(self) -> list[Place]:
        """Return the positions of all rows of the line, each piece followed by its clamps."""
        return _rows_of(self.draft, 0, len(self.draft.items))

    def item(self, spot: Place) -> LineItem:
        """Return the item or clamp in a row."""
        item = self.draft.items[spot.item]
        return item.clamps[spot.clamp] if spot.is_clamp else item

    def written(self, spot: Place) -> dict[str, Any]:
        """Return the keys of a row and their values in the file."""
        values = self.draft.value(location(spot))
        return values if isinstance(values, dict) else {}

    def do(self, draft: Draft, label: str) -> None:
        """Make a draft the current draft and add a history step, unless the text is unchanged."""
        if draft.text != self.draft.text:
            self.history.do(draft, label)
            self.added = frozenset()

    def _edit(
        self, draft: Draft, label: str, *, removed: Iterable[Place] = (), new: Iterable[Place] = ()
    ) -> None:
        """Make a draft the current draft, and update its references to labels.

        References to the `removed` rows then refer to the `new` rows, in line order.
        """
        removed, new, then = list(removed), set(new), _rows_of(draft, 0, len(draft.items))
        pairs = zip(
            [spot for spot in self.spots() if spot not in removed],
            [spot for spot in then if spot not in new],
            strict=False,
        )
        moved = dict(pairs) | (
            dict(zip(removed, sorted(new), strict=False)) if removed and new else {}
        )
        draft, self.followed = followed(self.draft, draft, moved)
        self.do(draft, label)
        self.added = frozenset(new.difference(moved.values()))

    def write(self, text: str, label: str = "edit the text", *, further: bool = False) -> None:
        """Replace the text.

        With `further`, merge the change with the last step of the history.
        """
        if further:
            self.history.undo()
        self.do(Draft(text), label)

    def insert(self, spot: Place | None, values: Mapping[str, Value], *, below: bool) -> Place:
        """Add a piece next to a row, or at the top of an empty line."""
        index = 0 if spot is None else spot.item + below
        draft = self.draft.insert(index, dict(values), above=not below)
        self._edit(draft, f"add {values['use']}", new=_rows_of(draft, index, 1))
        return Place(index)

    def clamp(self, spot: Place, values: Mapping[str, Value]) -> Place:
        """Add a clamp to the piece of a row, below the other clamps of this piece."""
        index = spot.clamp + 1 if spot.is_clamp else len(self.draft.items[spot.item].clamps)
        draft = self.draft.insert(index, dict(values), clamps_of(spot.item))
        at = Place(spot.item, clamp=index)
        self._edit(draft, f"clamp {values['use']}", new=[at])
        return at

    def put(self, given: Mapping[Place, Mapping[str, Value | None]], label: str) -> None:
        """Set keys of rows, in one step of the history; None deletes a key."""
        draft = self.draft
        for spot, values in given.items():
            rows, index = _list_and_index(spot)
            for key, value in values.items():
                draft = draft.put(index, key, value, rows)
        self._edit(draft, label)

    def replace(self, spot: Place, values: Mapping[str, Value]) -> list[str]:
        """Replace the component of a row.

        Return the other values of the row, which were set for the previous component and are kept.
        """
        kept = [
            f"{key} {value}" if isinstance(value, str) else key
            for key, value in self.written(spot).items()
            if key not in _OF_THE_ROW
        ]
        self.put({spot: values}, f"use {values['use']}")
        return kept

    def delete(self, spots: Iterable[Place]) -> Place | None:
        """Delete rows; the clamps of a deleted piece are deleted, too.

        Return the row to which the cursor moves, or None if there is no such row.
        """
        chosen = _whole(spots)
        if not chosen:
            return None
        rows = self.spots()
        first = rows.index(chosen[0])
        pieces = {spot.item for spot in chosen if not spot.is_clamp}
        removed = [spot for spot in rows if spot in chosen or spot.item in pieces]
        draft = self.draft
        for spot in reversed(chosen):
            if spot.is_clamp:
                draft = draft.delete([spot.clamp], clamps_of(spot.item))
        self._edit(draft.delete(pieces), f"delete {self._called(chosen)}", removed=removed)
        left = self.spots()
        return left[min(first, len(left) - 1)] if left else None

    def duplicate(
        self, spots: Iterable[Place], also: Sequence[Named] = (), times: int = 1
    ) -> Place | None:
        """Insert copies of rows below the last of these rows, and return the first copy.

        The references in `also` are extended to the copies.
        """
        chosen = _whole(spots)
        if not chosen:
            return None
        items = [spot.item for spot in chosen if not spot.is_clamp]
        label = f"duplicate {self._called(chosen)}"
        if items:
            copies = self.draft.copy(items) * times
            draft = with_extended_acceptances(self.draft.paste(items[-1] + 1, copies), also)
            self._edit(draft, label, new=_rows_of(draft, items[-1] + 1, len(copies)))
            return Place(items[-1] + 1)
        last, clamps = chosen[-1], self._clamps(chosen) * times
        return self._paste_clamps(last, last.clamp + 1, clamps, label)[0]

    def _paste_clamps(
        self, spot: Place, first: int, texts: Sequence[str], label: str
    ) -> list[Place]:
        new = [Place(spot.item, clamp=first + each) for each in range(len(texts))]
        self._edit(self.draft.paste(first, texts, clamps_of(spot.item)), label, new=new)
        return new

    def move(self, spots: Iterable[Place], by: int) -> tuple[Place, ...]:
        """Move pieces or a single clamp up (-1) or down (1), and return their new rows.

        A piece does not move beyond the end of the line. A clamp does not leave its piece.
        """
        chosen = _whole(spots)
        moved = [spot for spot in chosen if not spot.is_clamp] or chosen
        first, last, draft = moved[0], moved[-1], self.draft
        if first.is_clamp and first != last:
            return tuple(moved)
        rows, top = _list_and_index(first)
        bottom = _list_and_index(last)[1]
        held = draft.items[first.item].clamps if first.is_clamp else draft.items
        if top + by < 0 or bottom + by >= len(held):
            return tuple(moved)
        for _, index in sorted(map(_list_and_index, moved), reverse=by > 0):
            draft = draft.move(index, index + by, rows)

        def there(spot: Place) -> Place:
            if first.is_clamp:
                return Place(spot.item, clamp=spot.clamp + by)
            return Place(spot.item + by, clamp=spot.clamp)

        pieces = {spot.item for spot in moved if not spot.is_clamp}
        removed = [spot for spot in self.spots() if spot in moved or spot.item in pieces]
        self._edit(draft, f"move {self._called(moved)}", removed=removed, new=map(there, removed))
        return tuple(map(there, moved))

    def copy(self, spots: Iterable[Place]) -> int:
        """Copy rows for pasting, and return the number of copied rows."""
        chosen = _whole(spots)
        items = [spot.item for spot in chosen if not spot.is_clamp]
        if chosen:
            self.copied = tuple(self.draft.copy(items)) if items else self._clamps(chosen)
            self._are_clamps = not items
        return len(self.copied) if chosen else 0

    def paste(self, spot: Place | None, *, below: bool) -> Place | None:
        """Paste the copied rows next to a row of the line.

        Return the last pasted row if pasted below, the first if pasted above, and None if nothing
        was copied.
        """
        count = len(self.copied)
        label = f"paste {count} row{'s' * (count != 1)}"
        if self.copied and not self._are_clamps:
            index = 0 if spot is None else spot.item + below
            draft = self.draft.paste(index, self.copied, above=not below)
            self._edit(draft, label, new=_rows_of(draft, index, count))
            return Place(index + (count - 1) * below)
        if not self.copied or spot is None:
            return None
        first = spot.clamp + below if spot.is_clamp else len(self.draft.items[spot.item].clamps)
        return self._paste_clamps(spot, first, self.copied, label)[-1 if below else 0]

    def _clamps(self, chosen: Sequence[Place]) -> tuple[str, ...]:
        copied = (self.draft.copy([spot.clamp], clamps_of(spot.item)) for spot in chosen)
        return tuple(text for texts in copied for text in texts)

    def _called(self, chosen: Sequence[Place]) -> str:
        return _label(self.item(chosen[0])) if len(chosen) == 1 else f"{len(chosen)} rows"

    # saving

    def save(self) -> str:
        """Save the file, delete its backup copy, and return a note on lost file attributes.

        Raises
        ------
        NotWritten
            The file cannot be written.
        """
        lost = self.file.save(self.draft.text)
        self.history.saved()
        self.file.forget()
        if self.after_save is not None and self.file.path is not None:
            self.after_save(self.file.path, self.draft.text)
        return lost

    def save_as(self, path: Path) -> str:
        """Save to another path, and edit the file at this path from then on.

        Return the same note as `save`.
        """
        before, self.file = self.file, WorkingFile(path)
        try:
            lost = self.save()
        except Exception:
            self.file = before
            raise
        before.forget()
        return lost

    # backup in case of a crash

    def note_unsaved(self) -> WorkingFile:
        """Pass unsaved text to the working file, and return the working file.

        The next backup copy of the working file contains this text.
        """
        self.file.unsaved = self.draft.text if self.changed else None
        return self.file

    def recover(self, kept: editing.KeptWork) -> None:
        """Continue with unsaved work of an earlier session; undo restores the text of the file."""
        self.file.adopt(kept)
        self.write(kept.text, "recover unsaved work")


def _rows_of(draft: Draft, first: int, count: int) -> list[Place]:
    return [
        Place(number, clamp=clamp)
        for number in range(first, first + count)
        for clamp in range(-1, len(draft.items[number].clamps))
    ]


def _whole(spots: Iterable[Place]) -> list[Place]:
    """Sort rows, and drop clamps whose piece is among the rows."""
    chosen = sorted(set(spots))
    pieces = {spot.item for spot in chosen if not spot.is_clamp}
    return [spot for spot in chosen if not spot.is_clamp or spot.item not in pieces]


def location(spot: Place) -> Location:
    """Return the location of a row in the file, as a path of keys and indices."""
    rows, index = _list_and_index(spot)
    return (*rows, index)


def _list_and_index(spot: Place) -> tuple[Location, int]:
    return (clamps_of(spot.item), spot.clamp) if spot.is_clamp else (LINE, spot.item)


def _label(item: LineItem) -> str:
    return item.values.get("label") or item.values.get("use") or "a row"
