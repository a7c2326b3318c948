"""An editable mooring or tow file, as text, with its undo history.

Parts that are not edited are kept byte for byte.
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

DEFAULT_ENVIRONMENT = "environment"
VARIANTS = "environments"
"""Section of the named environments, each of which is kept even if it is empty."""

_CONTROL = "a control character cannot be written into the file"
_LAYOUT_PREVENTS = "the layout of the file does not allow this change; make it in the text"

_EMPTY = """\
# Every value has a unit: 12 mm, 1.5 knot, 35 kgf, 0.22 kgf/m, 30 deg, 1/2 in.

name: New mooring

environment:
  density: 1025 kg/m^3

line: []                              # top to bottom
"""


def clamps_of(item: int) -> Location:
    """Return the location of an item's list of clamps."""
    return (*LINE, item, "clamps")


@dataclass(frozen=True)
class Draft:
    """A mooring or tow file as text.

    Every edit returns a new draft. Layout and comments are kept, and new text follows the style of
    the file. A comment directly above an item belongs to the item.

    Raises
    ------
    EditError
        An item does not exist, the text has `problems`, or its layout prevents the edit.
    """

    text: str

    @classmethod
    def empty(cls) -> Draft:
        """Return a draft of a mooring without pieces."""
        return cls(_EMPTY)

    @cached_property
    def _root(self) -> Node | None:
        composition = compose(self.text)
        root = composition.root
        return None if root is None or composition.refusals or root.kind != "mapping" else root

    @cached_property
    def problems(self) -> tuple[Problem, ...]:
        """Problems in the YAML text. The `path` of each problem is empty.

        A file with problems can only be edited as plain text.
        """
        if self._root is not None:
            return ()
        try:
            yaml_document.compose("", self.text)
        except InputError as error:
            return error.problems
        raise AssertionError("readable YAML text without nodes")

    @cached_property
    def items(self) -> tuple[LineItem, ...]:
        """Items of the line as written in the file, neither expanded nor validated."""
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
        """Locations of the lists of line items: one list for a line, or one for each leg of a net.

        Indices of items continue from one leg to the next.
        """
        return LineLists.of(self._root.data if self._root is not None else None)

    @property
    def is_tow(self) -> bool:
        """Whether the text describes a tow; False if it cannot be parsed."""
        return isinstance(self.value(()), dict) and "tow" in self.value(())

    def value(self, location: Location) -> Any:
        """Return the text, mapping or list at a location.

        Return None if the location does not exist, or if the text has `problems`.
        """
        if self._root is None:
            return None
        node = self._page.node(self.lists.real(location))
        return node.data if node else None

    def text_at(self, location: Location) -> str:
        """Return the text of the scalar at a location; empty if there is no scalar."""
        value = self.value(location)
        return value if isinstance(value, str) else ""

    def insert(
        self, index: int, values: Mapping[str, Value], rows: Location = LINE, *, above: bool = False
    ) -> Draft:
        """Insert an item before the item that has the given index.

        Parameters
        ----------
        values : keys and values of the new item
        rows : location of the list: `LINE`, the result of `clamps_of`, or another list
        above : at an index between two legs, whether the item belongs to the lower leg
        """
        self._check_clamped_item(rows)
        return self._add(*self.lists.place_in(rows, index, above=above), [values])

    def delete(self, indices: Iterable[int], rows: Location = LINE) -> Draft:
        """Remove items from a list."""
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
        """Move an item to another index.

        Parameters
        ----------
        rows : location of the list

        Raises
        ------
        EditError
            The two indices are in different legs.
        """
        places = [self.lists.place_in(rows, each, above=True) for each in (index, to)]
        if places[0][0] != places[1][0]:
            raise changes.EditError(
                "a piece cannot be moved to another leg; cut it and paste it there"
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
        """Return the texts of items, each with its comments."""
        lists = self.lists.grouped(indices, rows)
        return tuple(text for own, each in lists for text in self._page.copy(own, each))

    def paste(
        self, index: int, snippets: Iterable[str], rows: Location = LINE, *, above: bool = False
    ) -> Draft:
        """Insert the items that `copy` returned.

        Parameters
        ----------
        index : index of the first new item
        rows, above : as in `insert`
        """
        self._check_clamped_item(rows)
        worded = _parse_items(snippets)
        place = self.lists.place_in(rows, index, above=above)
        return self._add(*place, worded) if worded else self

    def put(self, index: int, key: str, value: Value | None, rows: Location = LINE) -> Draft:
        """Set a key of an item; the value None removes the key.

        Parameters
        ----------
        index : index of the item
        rows : location of the list
        """
        own, number = self.lists.place_in(rows, index, above=True)
        self._page.known(own, [number])
        return self.put_at((*own, number, key), value)

    def put_at(self, location: Location, value: Value | None) -> Draft:
        """Set the value at a location. Mappings that are missing above the location are added.

        The value None removes the key and any mappings that become empty, except `environment` and
        the named environments.
        """
        page, location = self._page, self.lists.real(location)
        if value is not None:
            patches = page.put(location, value)
            return self._changed(patches, location, value)
        if page.node(location) is None:
            return self
        while len(location) > 1 and isinstance(location[-2], str):
            outer = page.node(location[:-1])
            is_kept = location[:-1] == (DEFAULT_ENVIRONMENT,) or location[:-2] == (VARIANTS,)
            if outer is None or len(outer.keys) > 1 or is_kept:
                break
            location = location[:-1]
        return self._changed(page.remove(location), location, changes.REMOVED)

    def put_table(
        self, location: Location, columns: Sequence[str], rows: Sequence[Sequence[str | None]]
    ) -> Draft:
        """Replace a table, but keep the text of unchanged rows.

        Parameters
        ----------
        columns : column names with units
        rows : rows of values; if the table keeps its shape, only changed values are rewritten
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
        """Replace the items of a list; unchanged items keep their text."""
        return self._changed(self._page.rows(location, rows), location, rows)

    def put_component(self, id: str, values: Mapping[str, Value]) -> Draft:
        """Define a component in this file, replacing any definition with the same id."""
        return self.put_at((changes.NAMED[0], id), values)

    def _check_clamped_item(self, rows: Location) -> None:
        if rows[0] == LINE[0] and rows != LINE:
            own, index = self.lists.place(int(rows[1]), above=True)
            self._page.known(own, [index])

    def _add(self, location: Location, index: int, values: Sequence[Value]) -> Draft:
        page = self._page
        node = page.node(location)
        if node is not None and node.kind != "sequence" and node.data is not None:
            raise changes.EditError(f"line {node.line} of the file: `{location[-1]}` is not a list")
        data = list(node.data or ()) if node else []
        if not 0 <= index <= len(data):
            raise changes.EditError(
                f"position {index} does not exist in a list of {len(data)} items"
            )
        patches = page.add(location, index, values)
        data[index:index] = changes.data_of(values)
        return self._changed(patches, location, data)

    def _changed(self, patches: Iterable[Patch], location: Location, value: Any) -> Draft:
        """Apply patches to the text, and check that only the value at the location has changed."""
        data = changes.with_value(self._data, location, value)
        text = patched(self._padded, patches)
        line_break = self._page.style.line_break
        if self._padded != self.text:
            text = text.removesuffix(line_break)
        draft = Draft(text)
        if draft._root is None or draft._root.data != data:
            is_hidden = changes.has_control(data) and not changes.has_control(self._data)
            raise changes.EditError(_CONTROL if is_hidden else _LAYOUT_PREVENTS)
        return draft

    @cached_property
    def _page(self) -> changes.Page:
        if self._root is None:
            raise changes.EditError("the text has mistakes; correct them first")
        return changes.Page(self._padded, self._root, WritingStyle.of(self.text, self._root))

    @cached_property
    def _padded(self) -> str:
        ends = self.text.endswith("\n")
        return self.text if ends else self.text + WritingStyle.of(self.text, None).line_break

    @property
    def _data(self) -> Any:
        return self._page.root.data


def _parse_items(snippets: Iterable[str]) -> Worded:
    wordings = [read_snippet(snippet) for snippet in snippets]
    if None in wordings:
        raise changes.EditError("the pasted text is not a list of items")
    return Worded(one for one in wordings if one is not None)


class History:
    """Undo history of a draft, with the last saved text.

    Parameters
    ----------
    draft : initial draft, which equals the saved file
    """

    def __init__(self, draft: Draft) -> None:
        self.draft = draft
        self.saved_text = draft.text
        # Texts only: the nodes of thousands of drafts would take much memory.
        self._done: list[tuple[str, str]] = []
        self._undone: list[tuple[str, str]] = []

    @property
    def changed(self) -> bool:
        """Whether the draft differs from the saved text."""
        return self.draft.text != self.saved_text

    @property
    def steps(self) -> tuple[str, ...]:
        """Labels of the changes that can be undone, the latest first."""
        return tuple(label for label, _ in reversed(self._done))

    def do(self, draft: Draft, label: str) -> None:
        """Make a draft the current one, unless the two are equal; `label` names the step."""
        if draft.text == self.draft.text:
            return
        self._done.append((label, self.draft.text))
        self._undone.clear()
        self.draft = draft

    def undo(self) -> str | None:
        """Undo the last change; return its label, or None if there is none."""
        return self._go(self._done, self._undone)

    def redo(self) -> str | None:
        """Redo the last undone change; return its label, or None if there is none."""
        return self._go(self._undone, self._done)

    def saved(self, text: str | None = None) -> None:
        """Mark the current draft, or another text, as saved."""
        self.saved_text = self.draft.text if text is None else text

    def _go(self, source: list[tuple[str, str]], target: list[tuple[str, str]]) -> str | None:
        if not source:
            return None
        label, text = source.pop()
        target.append((label, self.draft.text))
        self.draft = Draft(text)
        return label
