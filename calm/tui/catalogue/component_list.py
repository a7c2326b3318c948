"""The list of the components found: one line each, with a cursor; the last ones are remembered."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import zip_longest

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style

from calm import whole_file
from calm.assemble.catalogue_search import COLUMNS, Index, Listed
from calm.files.editing import state_folder
from calm.tui.table import TableCells, TableColumn
from calm.tui.theme import CURSOR, FAVOURITE, ROLES

_LEAD, _FIGURE = 4, 8


class ComponentList(TableCells, can_focus=False):
    """List components with a cursor, which the search moves."""

    DEFAULT_CSS = """
    ComponentList {
        background: $background;
        & > .component-list--cursor { text-style: bold; background: $surface; }
        & > .component-list--id { color: $foreground; }
        & > .component-list--name { text-style: dim; }
        & > .component-list--own { color: $text-accent; }
    }
    """
    COMPONENT_CLASSES = {  # noqa: RUF012 - textual reads the class attribute
        "component-list--cursor",
        "component-list--id",
        "component-list--name",
        "component-list--own",
    }

    def __init__(self) -> None:
        super().__init__()
        self.rows: Sequence[Listed] = ()
        self._longest = 0
        self._index: Index | None = None
        self._by: str | None = None
        self._favourites: frozenset[str] = frozenset()

    @property
    def chosen(self) -> Listed | None:
        """The component under the cursor."""
        return self.rows[self.cursor] if self.rows else None

    def show(
        self,
        found: Sequence[Listed],
        index: Index,
        by: str | None = None,
        favourites: frozenset[str] = frozenset(),
    ) -> None:
        """List other components, the cursor on the first; `by` which figure they are sorted."""
        before, columns = self.rows, self.columns
        cursor, like = self.cursor, (self._index, self._favourites)
        self._index, self._by, self._favourites = index, by, favourites
        self._longest = max((len(each.id) for each in found), default=0)
        self.set_reactive(TableCells.cursor, 0)
        if like != (index, favourites) or columns != self.columns or self.scroll_offset.y:
            self.take_rows(found)
            self.scroll_to(y=0, animate=False)
        else:
            pairs = zip_longest(before[: self.size.height], found[: self.size.height])
            changed = [number for number, (old, new) in enumerate(pairs) if old is not new]
            self.take_rows(found, {0, cursor, *changed})
        self.post_message(self.Moved())

    @property
    def columns(self) -> list[TableColumn]:
        """The ids, the figures that have room beside them, and the names in what is left."""
        width = self.scrollable_content_region.width
        id_width = max(min(self._longest, width - _LEAD), 0)
        room, shown = width - _LEAD - id_width - 1, set()
        for figure in sorted(COLUMNS, key=lambda each: each.key != self._by):
            if room >= _FIGURE + 1:
                shown.add(figure.key)
                room -= _FIGURE + 1
        columns, start = [TableColumn("id", "component", _LEAD, id_width)], _LEAD + id_width + 1
        for figure in COLUMNS:
            if figure.key in shown:
                columns.append(TableColumn(figure.key, figure.heading, start, _FIGURE, True))
                start += _FIGURE + 1
        return [*columns, TableColumn("name", "", start, max(room, 0))]

    def text_of(self, number: int, column: TableColumn) -> str:
        """Return an id, a figure, or a name that stands there whole; else the card has it."""
        each: Listed = self.rows[number]
        if column.name == "id":
            return each.id
        if column.name == "name":
            return each.name if cell_len(each.name) <= column.width else ""
        figures = {} if self._index is None else self._index.figures(each.id)
        return _SHOWN[column.name].shown(figures.get(column.name))

    def lead(self, number: int, style: Style) -> list[Segment]:
        """Return the cursor, the star of a favourite, and the sign of the role."""
        each: Listed = self.rows[number]
        cursor = CURSOR if number == self.cursor else " "
        star = FAVOURITE if each.id in self._favourites else " "
        return [Segment(f"{cursor}{star}{ROLES.get(each.role, ' ')} ", style)]

    def row_style(self, number: int) -> Style:
        """Return how a row looks, that of the cursor whoever has the focus."""
        if number != self.cursor:
            return self.rich_style
        return self.rich_style + self.get_component_rich_style(
            "component-list--cursor", partial=True
        )

    def cell_style(self, number: int, column: TableColumn, style: Style) -> Style:
        """Return how an id and a name look; figures look as the row does."""
        look = {"id": "own" if self.rows[number].own else "id", "name": "name"}.get(column.name)
        if look is None:
            return style
        return style + self.get_component_rich_style(f"component-list--{look}", partial=True)


_SHOWN = {each.key: each for each in COLUMNS}


_NAME = "catalogue.json"
_MOST_RECENT = 40


class Remembered:
    """Ids of components, each list the last one first; a file that cannot be read is none.

    Attributes
    ----------
    favourites : marked by the person
    recent : taken from the catalogue
    """

    def __init__(self) -> None:
        self.favourites, self.recent = _read()

    def take(self, id: str) -> None:
        """Note that one was taken; where it cannot be kept, for this session only."""
        self.recent = [id, *(each for each in self.recent if each != id)][:_MOST_RECENT]
        with suppress(OSError):
            self._keep()

    def mark(self, id: str) -> bool:
        """Mark a favourite, or unmark it; returns whether it is one now.

        Raises
        ------
        OSError
            It could not be kept, and is one in this session only.
        """
        is_new = id not in self.favourites
        self.favourites = [each for each in self.favourites if each != id]
        if is_new:
            self.favourites.insert(0, id)
        self._keep()
        return is_new

    def _keep(self) -> None:
        folder = state_folder()
        folder.mkdir(parents=True, exist_ok=True)
        content = json.dumps({"favourites": self.favourites, "recent": self.recent}, indent=1)
        whole_file.put(folder / _NAME, content.encode())


def _read() -> tuple[list[str], list[str]]:
    try:
        kept = json.loads((state_folder() / _NAME).read_text(encoding="utf-8"))
        return _ids(kept["favourites"]), _ids(kept["recent"])
    except (OSError, ValueError, KeyError, TypeError):
        return [], []


def _ids(kept: Iterable[object]) -> list[str]:
    return [each for each in kept if isinstance(each, str)]
