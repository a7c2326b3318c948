"""The file being built: its text, its history, what was copied, and every verb that changes it.

Nothing here knows of the screen; nothing is computed here.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from calm.files import Place, editing
from calm.files.editing import LINE, Draft, History, LineItem, Value, WorkingFile, clamps_of
from calm.files.yaml_document import Location
from calm.tui.names import Named, Standing, followed, widened

_OF_THE_ROW = frozenset({"use", "label", "count", "at", "clamps"})
"""Keys of a row that hold whatever component is there."""


class Session:
    """A mooring or tow file on its way.

    Parameters
    ----------
    file : where it is read from and saved to
    text : what it holds
    environment : see `Standing`

    Attributes
    ----------
    catalogs : catalogue files given with the command
    copied : what `paste` puts in, as text: items of a line, or clamped instruments
    standing : the environment that the line stands in
    after_save : is given the path and the text of a file that has been saved
    added : the rows that the last change has put in
    followed : what the last change of the line made of labels that the file names elsewhere

    Raises
    ------
    EditError
        By every verb that the text does not allow: it has mistakes, or is written in a way that
        cannot be taken apart. Nothing is changed then.
    NotWritten
        By `save` and `save_as`.
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
        self._are_clamps = False  # what was copied
        self.followed: list[str] = []
        self.added: frozenset[Place] = frozenset()
        self.standing = Standing(self.history, environment)
        self.after_save: Callable[[Path, str], object] | None = None

    @property
    def draft(self) -> Draft:
        """The file as it is now."""
        return self.history.draft

    @property
    def changed(self) -> bool:
        """Return whether something is not saved yet."""
        return self.history.changed

    @property
    def name(self) -> str:
        """The file's name, for people."""
        path = self.file.path
        return "unnamed" if path is None else path.name

    @property
    def components(self) -> dict[str, Any]:
        """The components that the file defines, as written."""
        defined = self.draft.value(("components",))
        return defined if isinstance(defined, dict) else {}

    # the line

    def spots(self) -> list[Place]:
        """Every row of the line, clamps below their piece."""
        return _rows_of(self.draft, 0, len(self.draft.items))

    def item(self, spot: Place) -> LineItem:
        """The item, or clamp, of a row."""
        item = self.draft.items[spot.item]
        return item.clamps[spot.clamp] if spot.is_clamp else item

    def written(self, spot: Place) -> dict[str, Any]:
        """All that the file says of a row."""
        values = self.draft.value(location(spot))
        return values if isinstance(values, dict) else {}

    def do(self, draft: Draft, label: str) -> None:
        """Take a draft as the next state; one that changes nothing is no step."""
        if draft.text != self.draft.text:
            self.history.do(draft, label)
            self.added = frozenset()

    def _edit(
        self, draft: Draft, label: str, *, gone: Iterable[Place] = (), new: Iterable[Place] = ()
    ) -> None:
        """Take a draft of which rows are `gone` and others `new`; what names the others follows."""
        gone, new, then = list(gone), set(new), _rows_of(draft, 0, len(draft.items))
        pairs = zip(
            [spot for spot in self.spots() if spot not in gone],
            [spot for spot in then if spot not in new],
            strict=False,
        )
        moved = dict(pairs) | (dict(zip(gone, sorted(new), strict=False)) if gone and new else {})
        draft, self.followed = followed(self.draft, draft, moved)
        self.do(draft, label)
        self.added = frozenset(new.difference(moved.values()))

    def write(self, text: str, label: str = "edit the text", *, further: bool = False) -> None:
        """Take another text; `further` where it goes on with the last step."""
        if further:
            self.history.undo()
        self.do(Draft(text), label)

    def insert(self, spot: Place | None, values: Mapping[str, str], *, below: bool) -> Place:
        """A new piece beside a row; at the top of an empty line."""
        index = 0 if spot is None else spot.item + below
        draft = self.draft.insert(index, dict(values), above=not below)
        self._edit(draft, f"add {values['use']}", new=_rows_of(draft, index, 1))
        return Place(index)

    def clamp(self, spot: Place, values: Mapping[str, str]) -> Place:
        """A new instrument on the piece of a row, below the other ones."""
        index = spot.clamp + 1 if spot.is_clamp else len(self.draft.items[spot.item].clamps)
        draft = self.draft.insert(index, dict(values), clamps_of(spot.item))
        at = Place(spot.item, clamp=index)
        self._edit(draft, f"clamp {values['use']}", new=[at])
        return at

    def put(self, given: Mapping[Place, Mapping[str, Value | None]], label: str) -> None:
        """Set keys of rows in one step; None takes one away."""
        draft = self.draft
        for spot, values in given.items():
            rows, index = _listed(spot)
            for key, value in values.items():
                draft = draft.put(index, key, value, rows)
        self._edit(draft, label)

    def replace(self, spot: Place, values: Mapping[str, str]) -> list[str]:
        """Put another component on a row; returns what the row still overrides of the old one."""
        kept = [
            f"{key} {value}" if isinstance(value, str) else key
            for key, value in self.written(spot).items()
            if key not in _OF_THE_ROW
        ]
        self.put({spot: values}, f"use {values['use']}")
        return kept

    def delete(self, spots: Iterable[Place]) -> Place | None:
        """Take rows out, a piece with its clamps; the row to go to, None where none is left."""
        chosen = _whole(spots)
        if not chosen:
            return None
        rows = self.spots()
        first = rows.index(chosen[0])
        pieces = {spot.item for spot in chosen if not spot.is_clamp}
        gone = [spot for spot in rows if spot in chosen or spot.item in pieces]
        draft = self.draft
        for spot in reversed(chosen):
            if spot.is_clamp:
                draft = draft.delete([spot.clamp], clamps_of(spot.item))
        self._edit(draft.delete(pieces), f"delete {self._called(chosen)}", gone=gone)
        left = self.spots()
        return left[min(first, len(left) - 1)] if left else None

    def duplicate(
        self, spots: Iterable[Place], also: Sequence[Named] = (), times: int = 1
    ) -> Place | None:
        """Repeat rows below the last of them, once or several times; the first of the copies.

        Of what names them, `also` names the copies then.
        """
        chosen = _whole(spots)
        if not chosen:
            return None
        items = [spot.item for spot in chosen if not spot.is_clamp]
        label = f"duplicate {self._called(chosen)}"
        if items:
            copies = self.draft.copy(items) * times
            draft = widened(self.draft.paste(items[-1] + 1, copies), also)
            self._edit(draft, label, new=_rows_of(draft, items[-1] + 1, len(copies)))
            return Place(items[-1] + 1)
        last, clamps = chosen[-1], self._clamps(chosen) * times
        return self._put_clamps(last, last.clamp + 1, clamps, label)[0]

    def _put_clamps(self, spot: Place, first: int, texts: Sequence[str], label: str) -> list[Place]:
        """Put clamps on the piece of a row, as the `first` and below; where they are."""
        new = [Place(spot.item, clamp=first + each) for each in range(len(texts))]
        self._edit(self.draft.paste(first, texts, clamps_of(spot.item)), label, new=new)
        return new

    def move(self, spots: Iterable[Place], by: int) -> tuple[Place, ...]:
        """Move pieces, or one clamp, up (-1) or down (1); where they are then.

        At the end of the line, or of the clamps of the piece, they stay.
        """
        chosen = _whole(spots)
        moved = [spot for spot in chosen if not spot.is_clamp] or chosen
        first, last, draft = moved[0], moved[-1], self.draft
        if first.is_clamp and first != last:
            return tuple(moved)
        rows, top = _listed(first)
        bottom = _listed(last)[1]
        held = draft.items[first.item].clamps if first.is_clamp else draft.items
        if top + by < 0 or bottom + by >= len(held):
            return tuple(moved)
        for _, index in sorted(map(_listed, moved), reverse=by > 0):
            draft = draft.move(index, index + by, rows)

        def there(spot: Place) -> Place:
            if first.is_clamp:
                return Place(spot.item, clamp=spot.clamp + by)
            return Place(spot.item + by, clamp=spot.clamp)

        pieces = {spot.item for spot in moved if not spot.is_clamp}
        gone = [spot for spot in self.spots() if spot in moved or spot.item in pieces]
        self._edit(draft, f"move {self._called(moved)}", gone=gone, new=map(there, gone))
        return tuple(map(there, moved))

    def copy(self, spots: Iterable[Place]) -> int:
        """Keep rows for pasting; how many."""
        chosen = _whole(spots)
        items = [spot.item for spot in chosen if not spot.is_clamp]
        if chosen:
            self.copied = tuple(self.draft.copy(items)) if items else self._clamps(chosen)
            self._are_clamps = not items
        return len(self.copied) if chosen else 0

    def paste(self, spot: Place | None, *, below: bool) -> Place | None:
        """Put what was copied beside a row; its last row, where the next comes below, or its
        first; None where nothing was copied.
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
        return self._put_clamps(spot, first, self.copied, label)[-1 if below else 0]

    def _clamps(self, chosen: Sequence[Place]) -> tuple[str, ...]:
        """The text of clamps, of one piece or of several."""
        copied = (self.draft.copy([spot.clamp], clamps_of(spot.item)) for spot in chosen)
        return tuple(text for texts in copied for text in texts)

    def _called(self, chosen: Sequence[Place]) -> str:
        return _label(self.item(chosen[0])) if len(chosen) == 1 else f"{len(chosen)} rows"

    # saving

    def save(self) -> str:
        """Write the file whole, and forget what was kept; what could not be kept of it.

        Raises
        ------
        NotWritten
        """
        lost = self.file.save(self.draft.text)
        self.history.saved()
        self.file.forget()
        if self.after_save is not None and self.file.path is not None:
            self.after_save(self.file.path, self.draft.text)
        return lost

    def save_as(self, path: Path) -> str:
        """Write another file and go on with that one; see `save`."""
        before, self.file = self.file, WorkingFile(path)
        try:
            lost = self.save()
        except Exception:
            self.file = before
            raise
        before.forget()
        return lost

    # what is kept in case of a crash

    def note_unsaved(self) -> WorkingFile:
        """The file, which knows then what it has to `keep`."""
        self.file.unsaved = self.draft.text if self.changed else None
        return self.file

    def recover(self, kept: editing.KeptWork) -> None:
        """Go on with work that an earlier session has left; undo leads back to the file."""
        self.file.adopt(kept)
        self.write(kept.text, "recover what was not saved")


def _rows_of(draft: Draft, first: int, count: int) -> list[Place]:
    """The rows of some items that follow one another."""
    return [
        Place(number, clamp=clamp)
        for number in range(first, first + count)
        for clamp in range(-1, len(draft.items[number].clamps))
    ]


def _whole(spots: Iterable[Place]) -> list[Place]:
    """The rows in order, without clamps whose piece is among them."""
    chosen = sorted(set(spots))
    pieces = {spot.item for spot in chosen if not spot.is_clamp}
    return [spot for spot in chosen if not spot.is_clamp or spot.item not in pieces]


def location(spot: Place) -> Location:
    """Return where a row stands in the file."""
    rows, index = _listed(spot)
    return (*rows, index)


def _listed(spot: Place) -> tuple[Location, int]:
    """The list of the file that a row stands in, and its index there."""
    return (clamps_of(spot.item), spot.clamp) if spot.is_clamp else (LINE, spot.item)


def _label(item: LineItem) -> str:
    return item.values.get("label") or item.values.get("use") or "a row"
