"""Catalogue pane, with incremental search, a component card, and fields for length or position."""

from collections.abc import Callable, Sequence
from itertools import zip_longest
from typing import ClassVar, Literal

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.widgets import Input, Static

from calm.assemble.catalogue_search import Index
from calm.errors import CalmError
from calm.files.catalogue_search import COLUMNS, Listed
from calm.files.components import FLEXIBLE_KINDS, RIGID_KINDS
from calm.files.editing import Value
from calm.files.editing.user_state import Remembered
from calm.tui import dialogs, key_table, theme
from calm.tui.checking import distance, length, length_values
from calm.tui.field import ScrolledEntry
from calm.tui.forms import FormField
from calm.tui.scrolled import ScrolledText, TableCells, TableColumn
from calm.tui.workspace import Workspace

_LEAD, _FIGURE = 4, 8


class ComponentList(TableCells, can_focus=False):
    """List of components with a cursor."""

    DEFAULT_CSS = """
    ComponentList {
        background: $background;
        & > .component-list--cursor { text-style: bold; background: $surface; }
        & > .component-list--id { color: $foreground; }
        & > .component-list--name { text-style: dim; }
        & > .component-list--own { color: $text-accent; }
    }
    """
    COMPONENT_CLASSES: ClassVar[set[str]] = {
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
        """List components in the given order, and move the cursor to the first component.

        If the components are sorted by a quantity, `by` is this quantity, and its column is always
        shown. `favourites` are component ids.
        """
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
        """Columns for id, name, and as many values as fit the width."""
        width = self.scrollable_content_region.width
        id_width = max(min(self._longest, width - _LEAD), 0)
        columns, start = [TableColumn("id", "component", _LEAD, id_width)], _LEAD + id_width + 1
        room = max((width - start) // (_FIGURE + 1), 0)
        shown = sorted(COLUMNS, key=lambda each: each.key != self._by)[:room]
        for figure in COLUMNS:
            if figure in shown:
                columns.append(TableColumn(figure.key, figure.heading, start, _FIGURE, True))
                start += _FIGURE + 1
        return [*columns, TableColumn("name", "", start, max(width - start, 0))]

    def text_of(self, number: int, column: TableColumn) -> str:
        each: Listed = self.rows[number]
        if column.name == "id":
            return each.id
        if column.name == "name":
            # a name that is too long for the column appears only on the card
            return each.name if cell_len(each.name) <= column.width else ""
        figures = {} if self._index is None else self._index.figures(each.id)
        figure = next(each for each in COLUMNS if each.key == column.name)
        return figure.shown(figures.get(column.name))

    def lead(self, number: int, style: Style) -> list[Segment]:
        each: Listed = self.rows[number]
        cursor = theme.CURSOR if number == self.cursor else " "
        star = theme.FAVOURITE if each.id in self._favourites else " "
        return [Segment(f"{cursor}{star}{theme.ROLES.get(each.role, ' ')} ", style)]

    def row_style(self, number: int) -> Style:
        if number != self.cursor:
            return self.rich_style
        return self.rich_style + self.look("component-list--cursor")

    def cell_style(self, number: int, column: TableColumn, style: Style) -> Style:
        look = {"id": "own" if self.rows[number].own else "id", "name": "name"}.get(column.name)
        if look is None:
            return style
        return style + self.look(f"component-list--{look}")


Purpose = Literal["below", "above", "clamp", "replace"]
"""Purpose of a catalogue search."""

_TITLES = {
    "below": "Add below",
    "above": "Add above",
    "clamp": "Clamp on",
    "replace": "Replace",
}


class CataloguePane(Vertical):
    """Pane with a search field, the components found, and the card of the chosen component.

    The pane also asks for the length of a new cable and the position of a new clamp. `take` is
    called with the purpose of the search, and with the keys and values of the new row. `close`
    returns to the line.
    """

    BINDINGS = key_table.bindings("catalogue")
    SCOPED_CSS = False  # styles depend on the width of the screen
    DEFAULT_CSS = """
    CataloguePane {
        display: none; width: 1fr; height: 1fr; padding: 0 1; background: $background;
        & #catalogue-title { height: 1; color: $text-muted; }
        & #catalogue-search { height: 1; background: $surface; }
        & #catalogue-search:focus { background: $surface; background-tint: $foreground 8%; }
        & #catalogue-found { height: 1fr; layout: vertical; }
        & #catalogue-card { height: 1fr; margin-top: 1; }
    }
    .-narrow CataloguePane #catalogue-found { layout: horizontal; }
    .-narrow CataloguePane ComponentList { width: 1fr; }
    .-narrow CataloguePane #catalogue-card { width: 1fr; height: 1fr; margin: 0 0 0 1; }
    """

    def __init__(
        self,
        workspace: Workspace,
        take: Callable[[Purpose, dict[str, Value]], object],
        close: Callable[[], object],
    ) -> None:
        super().__init__(id="catalogue")
        self.workspace, self._take, self._close = workspace, take, close
        self.index: Index | None = None  # the index of the last search
        self.listing, self._card = ComponentList(), ScrolledText(id="catalogue-card")
        words = "words of id, name, maker, kind, role; breaking>50kN"
        self.search = ScrolledEntry(id="catalogue-search", compact=True, placeholder=words)
        self.remembered = Remembered()
        self.purpose: Purpose = "below"
        self.clampable = False
        self._role = ""
        self._by: str | None = None
        self._shown: Listed | None = None
        self._target = ""

    def compose(self) -> ComposeResult:
        yield Static(id="catalogue-title", markup=False)
        yield self.search
        with Horizontal(id="catalogue-found"):
            yield self.listing
            yield self._card

    def refresh_index(self) -> None:
        """Search again if the catalogue has changed."""
        if self.workspace.index is not self.index:
            self.index = self.workspace.index
            if self.display or not self.listing.rows:
                self._search_again()

    def _search_again(self) -> None:
        chosen = self.listing.chosen
        self._search()
        ids = [each.id for each in self.listing.rows]
        if chosen is not None and chosen.id in ids:
            self.listing.cursor = ids.index(chosen.id)

    def open(
        self, purpose: Purpose, target: str, role: str = "", *, clampable: bool = False
    ) -> None:
        """Open the search for a component.

        Until the user types, the favourites are first in the list. Components with the given role
        are next, followed by recent components and components of the line. `target` is the row name
        in the title of the pane. `clampable` limits the list to components that can be clamped on.
        """
        self.purpose, self.clampable, self._role = purpose, clampable, role
        self.retitle(target)
        with self.prevent(Input.Changed):
            self.search.value = ""
        self._search()
        self.search.focus()

    def retitle(self, target: str) -> None:
        """Update the title, which names the row next to which the component is added."""
        self._target = target
        text = f"{_TITLES[self.purpose]} {target}" if target else "The top of the line"
        if self._by is not None:
            text += f"   sorted by {self._by}"
        self.query_one("#catalogue-title", Static).update(text, layout=False)

    @on(Input.Changed, "#catalogue-search")
    def _search(self) -> None:
        if self.index is None:
            return
        kinds = RIGID_KINDS if self.clampable else None
        kept = self.remembered
        items = self.workspace.session.draft.items
        used = [part.values.get("use", "") for each in items for part in (each, *each.clamps)]
        first = [*dict.fromkeys([*kept.favourites, *kept.recent, *reversed(used)])]
        found = self.index.search(self.search.value, kinds, first=first, by=self._by)
        if self._role and self._by is None and not self.search.value.strip():
            found.sort(key=lambda each: (each.id not in kept.favourites, each.role != self._role))
        self.listing.show(found, self.index, self._by, frozenset(kept.favourites))

    @on(ComponentList.Moved)
    def _show_card(self) -> None:
        card, chosen = self._card, self.listing.chosen
        if chosen is self._shown and chosen is not None:
            return
        self._shown = chosen
        if chosen is None or self.index is None:
            card.show("No component matches all words.")
            return
        from calm.report.component_cards import to_card
        from calm.report.terminal import shown

        try:
            catalogue = self.index.catalogue
            card.show(shown(to_card(chosen.id, catalogue.get(chosen.id), catalogue)))
        except CalmError as error:
            card.show(Text(str(error)))

    def action_sort(self) -> None:
        keys = [None, *(column.key for column in COLUMNS)]
        self._by = keys[(keys.index(self._by) + 1) % len(keys)]
        self.retitle(self._target)
        self._search()

    def action_mark(self) -> None:
        chosen = self.listing.chosen
        if chosen is not None:
            try:
                is_one = self.remembered.mark(chosen.id)
            except OSError as error:
                self.workspace.tell(f"Could not save favourites: {error}", wrong=True)
            else:
                became = "is a favourite now" if is_one else "is no longer a favourite"
                self.workspace.tell(f"{chosen.id} {became}")
            self._search_again()

    def action_choose(self, by: int) -> None:
        self.listing.cursor += by

    @on(Input.Submitted, "#catalogue-search")
    @on(ComponentList.Pressed)
    def action_take(self) -> None:
        chosen = self.listing.chosen
        if chosen is None:
            return
        if self.purpose == "clamp":
            place = "e.g. 2 m"
            self._ask(chosen, FormField("at", "From the top", "", distance(), place))
        elif chosen.kind in FLEXIBLE_KINDS and self.purpose != "replace":
            check = length(towed=self.workspace.session.draft.is_tow)
            self._ask(chosen, FormField("length", "Length", "", check, "e.g. 480 m, or fit 105 m"))
        else:
            self._give({"use": chosen.id})

    def _give(self, values: dict[str, Value]) -> None:
        self.remembered.take(str(values["use"]))
        self._take(self.purpose, values)
        self.search.action_select_all()

    def _ask(self, chosen: Listed, form_field: FormField) -> None:
        def take(texts: dict[str, str]) -> None:
            long, towed = texts.pop("length", ""), self.workspace.session.draft.is_tow
            keys = length_values(long, towed=towed) if long else {}
            given = {"use": chosen.id, **keys, **texts}
            self._give({key: value for key, value in given.items() if value})

        label = FormField("label", "Label", placeholder="optional")
        dialogs.enter(self.app, chosen.id, "", [form_field, label], take)

    def action_close(self) -> None:
        self._close()
