"""The catalogue: a search that answers at each key, a card, and what else is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Static

from calm.assemble.catalogue_search import COLUMNS, Index, Listed
from calm.errors import CalmError
from calm.files.components import FLEXIBLE_KINDS, RIGID_KINDS
from calm.tui.catalogue.component_list import ComponentList, Remembered
from calm.tui.checking import distance, length
from calm.tui.dialogs import Asked, InputSheet, ask
from calm.tui.key_table import bindings
from calm.tui.scrolled import ScrolledEntry, ScrolledText
from calm.tui.workspace import Told

Purpose = Literal["below", "above", "clamp", "replace"]
"""What the component is wanted for."""

_WHAT_FOR = {
    "below": "Add below",
    "above": "Add above",
    "clamp": "Clamp on",
    "replace": "In place of",
}


class CataloguePane(Vertical):
    """Search, list, card; the length of a cable and the place of a clamp are asked for before."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("catalogue")]
    SCOPED_CSS = False  # the width of the screen counts
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

    @dataclass
    class Taken(Message):
        """A component was chosen, with what was asked for: `length`, `at`, `label`."""

        purpose: Purpose
        values: dict[str, str]

    class Closed(Message):
        """Back to the line."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.index: Index | None = None
        self.remembered = Remembered()
        self.purpose: Purpose = "below"
        self.clampable = False
        self.towed = False
        self._used: list[str] = []
        self._role = ""
        self._by: str | None = None
        self._shown: Listed | None = None
        self._target = ""

    def compose(self) -> ComposeResult:
        """Title, search, and the list with its card."""
        yield Static(id="catalogue-title", markup=False)
        yield ScrolledEntry(
            id="catalogue-search",
            compact=True,
            placeholder="words of id, name, maker, kind, role; breaking>50kN",
        )
        with Horizontal(id="catalogue-found"):
            yield ComponentList()
            yield ScrolledText(id="catalogue-card")

    @property
    def listing(self) -> ComponentList:
        """Return what was found."""
        return self.query_one(ComponentList)

    @property
    def search(self) -> ScrolledEntry:
        """The words."""
        return self.query_one("#catalogue-search", ScrolledEntry)

    def take_index(self, index: Index) -> None:
        """Search another catalogue."""
        self.index = index
        if self.display or not self.listing.rows:
            self._search_again()

    def _search_again(self) -> None:
        """Search for the same, the cursor on the component it was on."""
        chosen = self.listing.chosen
        self._search()
        ids = [each.id for each in self.listing.rows]
        if chosen is not None and chosen.id in ids:
            self.listing.cursor = ids.index(chosen.id)

    def open(
        self,
        purpose: Purpose,
        target: str,
        used: list[str],
        role: str = "",
        *,
        clampable: bool = False,
        towed: bool = False,
    ) -> None:
        """Look for a component for the row called `target`, empty in an empty line.

        Favourites come first; then, until words are typed, what has a `role`, what was taken
        lately, and what is `used` in the line. With `clampable`, only what can be clamped on a
        line.
        """
        self.purpose, self.clampable, self.towed = purpose, clampable, towed
        self._used, self._role = used, role
        self.retitle(target)
        with self.prevent(Input.Changed):
            self.search.value = ""
        self._search()
        self.search.focus()

    def retitle(self, target: str) -> None:
        """Say beside which row the next one comes."""
        self._target = target
        text = f"{_WHAT_FOR[self.purpose]} {target}" if target else "The top of the line"
        if self._by is not None:
            text += f"   sorted by {self._by}"
        self.query_one("#catalogue-title", Static).update(text, layout=False)

    @on(Input.Changed, "#catalogue-search")
    def _search(self) -> None:
        if self.index is None:
            return
        kinds = RIGID_KINDS if self.clampable else None
        kept = self.remembered
        first = [*dict.fromkeys([*kept.favourites, *kept.recent, *self._used])]
        found = self.index.search(self.search.value, kinds, first=first, by=self._by)
        if self._role and self._by is None and not self.search.value.strip():
            found.sort(key=lambda each: (each.id not in kept.favourites, each.role != self._role))
        self.listing.show(found, self.index, self._by, frozenset(kept.favourites))

    @on(ComponentList.Moved)
    def _show_card(self) -> None:
        card, chosen = self.query_one("#catalogue-card", ScrolledText), self.listing.chosen
        if chosen is self._shown and chosen is not None:
            return
        self._shown = chosen
        if chosen is None or self.index is None:
            card.show("No component has all these words.")
            return
        from calm.report.component_cards import to_card
        from calm.report.terminal import shown

        try:
            catalogue = self.index.catalogue
            card.show(shown(to_card(chosen.id, catalogue.get(chosen.id), catalogue)))
        except CalmError as error:
            card.show(Text(str(error)))

    def action_sort(self) -> None:
        """Sort by the next of the figures, or by how well the words fit."""
        keys = [None, *(column.key for column in COLUMNS)]
        self._by = keys[(keys.index(self._by) + 1) % len(keys)]
        self.retitle(self._target)
        self._search()

    def action_mark(self) -> None:
        """Mark the component as a favourite, or unmark it."""
        chosen = self.listing.chosen
        if chosen is not None:
            try:
                is_one = self.remembered.mark(chosen.id)
            except OSError as error:
                self.post_message(Told(f"It could not be kept: {error}", wrong=True))
            else:
                became = "is a favourite now" if is_one else "is no longer a favourite"
                self.post_message(Told(f"{chosen.id} {became}"))
            self._search_again()

    def action_choose(self, by: int) -> None:
        """Move the cursor of the list."""
        self.listing.cursor += by

    @on(Input.Submitted, "#catalogue-search")
    @on(ComponentList.Pressed)
    def action_take(self) -> None:
        """Put the component into the line, or ask for what it needs first."""
        chosen = self.listing.chosen
        if chosen is None:
            return
        if self.purpose == "clamp":
            place = "e.g. 2 m down the piece"
            self._ask(chosen, Asked("at", "From the top", "", distance(), place))
        elif chosen.kind in FLEXIBLE_KINDS and self.purpose != "replace":
            lengths = "e.g. 480 m, or fit 105 m"
            self._ask(chosen, Asked("length", "Length", "", length(towed=self.towed), lengths))
        else:
            self._give({"use": chosen.id})

    def _give(self, values: dict[str, str]) -> None:
        self.remembered.take(values["use"])
        self.post_message(self.Taken(self.purpose, values))
        self.search.action_select_all()

    def _ask(self, chosen: Listed, asked: Asked) -> None:
        """Ask for the length or the place, and for a label."""

        def take(texts: dict[str, str]) -> None:
            self._give({"use": chosen.id} | {key: text for key, text in texts.items() if text})

        label = Asked("label", "Label", placeholder="may stay empty")
        ask(self.app, InputSheet(chosen.id, "", [asked, label]), take)

    def action_close(self) -> None:
        """Leave the catalogue."""
        self.post_message(self.Closed())
