"""A mooring or tow file as text that is edited, and its history: what is not touched stays byte for
byte.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from calm.errors import InputError, Problem
from calm.files import yaml_document
from calm.files.composition import Node, compose
from calm.files.editing import changes
from calm.files.editing.items import LINE, LineItem, LineLists, item_of, items_of, read_snippet
from calm.files.editing.writing import Patch, Value, Worded, WritingStyle, patched
from calm.files.yaml_document import Location

KEPT = "environment"
VARIANTS = "environments"
"""They are needed even where they say nothing."""

_CONTROL = "a control character cannot be written into the file"
_ENTANGLED = "the file is written in a way that does not allow this change; make it in the text"

_EMPTY = """\
# Every figure carries its unit: 12 mm, 1.5 knot, 35 kgf, 0.22 kgf/m, 30 deg, 1/2 in.

name: New mooring

environment:
  density: 1025 kg/m^3

line: []                              # top to bottom
"""


def clamps_of(item: int) -> Location:
    """Return where the clamps of an item of the line stand."""
    return (*LINE, item, "clamps")


@dataclass(frozen=True)
class Draft:
    """Represent a mooring or tow file as text.

    Every edit returns a new draft. Comments, order, quotes, brackets, indentation, line breaks
    and a byte order mark stay as they are; what is new follows the manner of the file. A comment
    directly above an item goes where the item goes. The result is read again, and nothing but
    what was to change may have changed.

    Parameters
    ----------
    text : with its own line breaks, and its byte order mark if it has one

    Raises
    ------
    EditError
        By every edit that cannot be made: there is no such item, the text has `problems`, or it
        is written in a way that cannot be taken apart.
    """

    text: str

    @classmethod
    def empty(cls) -> Draft:
        """Return a line of no pieces yet."""
        return cls(_EMPTY)

    @cached_property
    def _root(self) -> Node | None:
        composition = compose(self.text)
        root = composition.root
        return None if root is None or composition.refusals or root.kind != "mapping" else root

    @cached_property
    def problems(self) -> tuple[Problem, ...]:
        """Return why the text cannot be edited but as text; the `path` of each is empty."""
        if self._root is not None:
            return ()
        try:
            yaml_document.compose("", self.text)
        except InputError as error:
            return error.problems
        raise AssertionError("a text that can be read has nodes")

    @cached_property
    def items(self) -> tuple[LineItem, ...]:
        """Return the items of `line` as written: not expanded, and whatever they say."""
        text, found = self._padded, []
        for rows, _ in self.lists.all if self._root is not None else ():
            node = self._page.node(rows)
            if node is None or node.kind != "sequence" or not node.children:
                continue
            taken = items_of(text, node)
            lines = taken.texts if taken else [""] * len(node.children)
            pairs = zip(node.children, lines, strict=True)
            found += [item_of(child, text, lines=own) for child, own in pairs]
        return tuple(found)

    @cached_property
    def lists(self) -> LineLists:
        """Return where the items of the line stand; an index in `LINE` counts through all legs."""
        return LineLists.of(self._root.data if self._root is not None else None)

    @property
    def is_tow(self) -> bool:
        """Return whether the text says that it is a tow; False where it cannot be read."""
        return isinstance(self.value(()), dict) and "tow" in self.value(())

    def value(self, location: Location) -> Any:
        """Return the text, mapping or list at a location; None without, or with `problems`."""
        if self._root is None:
            return None
        node = self._page.node(self.lists.real(location))
        return node.data if node else None

    def text_at(self, location: Location) -> str:
        """Return a plain value at a location as it is written; empty where there is none."""
        value = self.value(location)
        return value if isinstance(value, str) else ""

    def insert(
        self, index: int, values: Mapping[str, Value], rows: Location = LINE, *, above: bool = False
    ) -> Draft:
        """Put a new item, of values by key, above that of an index, or below the last.

        Parameters
        ----------
        rows : the list meant, here and below: the line, `clamps_of` an item, or another list
        above : between two legs, the first of the lower one is meant, not the last of the upper one
        """
        self._stands(rows)
        return self._add(*self.lists.place_in(rows, index, above=above), [values])

    def delete(self, indices: Iterable[int], rows: Location = LINE) -> Draft:
        """Take some items out of a list."""
        draft = self
        for own, each in reversed([*self.lists.grouped(indices, rows)]):
            draft = draft._without(each, own)
        return draft

    def _without(self, indices: Iterable[int], rows: Location) -> Draft:
        known = self._page.known(rows, indices)
        if not known:
            return self
        page = self._page
        data = [one for i, one in enumerate(self.value(rows)) if i not in known]
        if not data and rows[-1:] != LINE:
            return self.put_at(rows, None)
        if not data:
            return self._changed(page.put(rows, []), rows, data)
        items = page.items(rows)
        for index in reversed(known):
            items.remove(index)
        return self._changed([items.patch()], rows, data)

    def move(self, index: int, to: int, rows: Location = LINE) -> Draft:
        """Take an item to another place.

        Parameters
        ----------
        index : of the item
        to : its index then
        rows : the list

        EditError: they are in two legs.
        """
        places = [self.lists.place_in(rows, each, above=True) for each in (index, to)]
        if places[0][0] != places[1][0]:
            raise changes.EditError(
                "a piece stays in its leg: cut it and paste it into the other one"
            )
        (rows, index), (_, to) = places
        self._page.known(rows, [index, to])
        if index == to:
            return self
        items = self._page.items(rows)
        items.insert(to, items.remove(index))
        data = list(self.value(rows))
        data.insert(to, data.pop(index))
        return self._changed([items.patch()], rows, data)

    def copy(self, indices: Iterable[int], rows: Location = LINE) -> tuple[str, ...]:
        """Return the text of items by themselves, with their comments."""
        lists = self.lists.grouped(indices, rows)
        return tuple(text for own, each in lists for text in self._page.copy(own, each))

    def paste(
        self, index: int, snippets: Iterable[str], rows: Location = LINE, *, above: bool = False
    ) -> Draft:
        """Put items as `copy` gives them above that of an index, or below the last.

        Parameters
        ----------
        index : of the first new item
        snippets : items as `copy` gives them
        rows, above : as of `insert`
        """
        self._stands(rows)
        worded = _worded(snippets)
        place = self.lists.place_in(rows, index, above=above)
        return self._add(*place, worded) if worded else self

    def put(self, index: int, key: str, value: Value | None, rows: Location = LINE) -> Draft:
        """Give a value to a key of an item.

        Parameters
        ----------
        index : of the item
        key : of the item
        value : None takes the key out
        rows : the list
        """
        own, number = self.lists.place_in(rows, index, above=True)
        self._page.known(own, [number])
        return self.put_at((*own, number, key), value)

    def put_at(self, location: Location, value: Value | None) -> Draft:
        """Put a value anywhere in the file, with the mappings that lead to it.

        None takes a key out, and a mapping that is empty then, but for `environment` and the
        named environments.
        """
        page, location = self._page, self.lists.real(location)
        if value is not None:
            patches = page.put(location, value)
            return self._changed(patches, location, value)
        if page.node(location) is None:
            return self
        while len(location) > 1 and isinstance(location[-2], str):
            outer = page.node(location[:-1])
            is_kept = location[:-1] == (KEPT,) or location[:-2] == (VARIANTS,)
            if outer is None or len(outer.keys) > 1 or is_kept:
                break
            location = location[:-1]
        return self._changed(page.remove(location), location, changes.GONE)

    def put_table(
        self, location: Location, columns: Sequence[str], rows: Sequence[Sequence[str | None]]
    ) -> Draft:
        """Put a table in; the rows that it has already stay as they are written.

        Parameters
        ----------
        location : of the table
        columns : names with units
        rows : of values; in a table of as many as before, each stays that does not change
        """
        old = self.value(location)
        if not isinstance(old, dict) or set(old) != {"columns", "rows"}:
            return self.put_at(location, {"columns": columns, "rows": rows})
        draft = self
        if old["columns"] != list(columns):
            draft = draft.put_at((*location, "columns"), columns)
        place = (*location, "rows")
        cells = changes.cells_that_differ(old["rows"], rows)
        if cells is not None:
            for i, j, text in cells:
                draft = draft.put_at((*place, i, j), text)
            return draft
        return draft.put_rows(place, rows)

    def put_rows(self, location: Location, rows: Sequence[Value]) -> Draft:
        """Put in the items of a list; those that it has already stay as they are written."""
        return self._changed(self._page.rows(location, rows), location, rows)

    def put_component(self, id: str, values: Mapping[str, Value]) -> Draft:
        """Define a component used only here, in place of one of that id."""
        return self.put_at((changes.NAMED[0], id), values)

    def _stands(self, rows: Location) -> None:
        """Raise where there is no item whose clamps a list is to be."""
        if rows[0] == LINE[0] and rows != LINE:
            own, index = self.lists.place(int(rows[1]), above=True)
            self._page.known(own, [index])

    def _add(self, location: Location, index: int, values: Sequence[Value]) -> Draft:
        """Put new items into a list that may not exist yet."""
        page = self._page
        node = page.node(location)
        if node is not None and node.kind != "sequence" and node.data is not None:
            raise changes.EditError(f"line {node.line}: `{location[-1]}` is not a list")
        data = list(node.data or ()) if node else []
        if not 0 <= index <= len(data):
            raise changes.EditError(f"there is no place {index} in a list of {len(data)}")
        patches = page.add(location, index, values)
        data[index:index] = changes.data_of(values)
        return self._changed(patches, location, data)

    def _changed(self, patches: Iterable[Patch], location: Location, value: Any) -> Draft:
        """Return the draft with its text patched, which then differs at a location alone."""
        data = changes.with_value(self._data, location, value)
        text = patched(self._padded, patches)
        line_break = self._page.style.line_break
        if self._padded != self.text:
            text = text.removesuffix(line_break)
        draft = Draft(text)
        if draft._root is None or draft._root.data != data:
            is_hidden = changes.has_control(data) and not changes.has_control(self._data)
            raise changes.EditError(_CONTROL if is_hidden else _ENTANGLED)
        return draft

    @cached_property
    def _page(self) -> changes.Page:
        if self._root is None:
            raise changes.EditError("the text has mistakes; correct them first")
        return changes.Page(self._padded, self._root, WritingStyle.of(self.text, self._root))

    @cached_property
    def _padded(self) -> str:
        """Return the text with a last line break."""
        ends = self.text.endswith("\n")
        return self.text if ends else self.text + WritingStyle.of(self.text, None).line_break

    @property
    def _data(self) -> Any:
        return self._page.root.data


def _worded(snippets: Iterable[str]) -> Worded:
    """Read items as `Draft.copy` gives them."""
    wordings = [read_snippet(snippet) for snippet in snippets]
    if None in wordings:
        raise changes.EditError("what is to be pasted is not a list of items")
    return Worded(one for one in wordings if one is not None)


class History:
    """Keep a draft, the states before and after it, and the text that is saved.

    Parameters
    ----------
    draft : as it is saved
    """

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self.saved_text = draft.text
        # Texts only: the nodes of thousands of drafts would take much memory.
        self._done: list[tuple[str, str]] = []
        self._undone: list[tuple[str, str]] = []

    @property
    def changed(self) -> bool:
        """Return whether the draft differs from what was saved."""
        return self.draft.text != self.saved_text

    @property
    def steps(self) -> tuple[str, ...]:
        """Return what was done and can be taken back, the last first."""
        return tuple(label for label, _ in reversed(self._done))

    def do(self, draft: Draft, label: str) -> None:
        """Take a new state, and what it came of; an equal one is none."""
        if draft.text == self.draft.text:
            return
        self._done.append((label, self.draft.text))
        self._undone.clear()
        self.draft = draft

    def undo(self) -> str | None:
        """Go back a step; what was taken back."""
        return self._go(self._done, self._undone)

    def redo(self) -> str | None:
        """Go forward again; what was done again."""
        return self._go(self._undone, self._done)

    def saved(self, text: str | None = None) -> None:
        """Take the draft, or another text, for what is now saved."""
        self.saved_text = self.draft.text if text is None else text

    def _go(self, source: list[tuple[str, str]], target: list[tuple[str, str]]) -> str | None:
        if not source:
            return None
        label, text = source.pop()
        target.append((label, self.draft.text))
        self.draft = Draft(text)
        return label
