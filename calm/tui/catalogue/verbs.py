"""Components from the catalogue into the line."""

from __future__ import annotations

from textual import on

from calm.files import Place
from calm.tui.catalogue.pane import CataloguePane, Purpose
from calm.tui.line.builder_base import BuilderBase
from calm.tui.line.table import LineTable

_OF_THE_ROW = frozenset({"use", "label", "count", "at", "clamps"})
"""Keys of a row that hold whatever component is there."""


class CatalogueVerbs(BuilderBase):
    """Adding, clamping, replacing, defining."""

    def action_search(self) -> None:
        """Search the catalogue for a piece below."""
        self._open_catalogue("below")

    def action_add(self, below: int) -> None:
        """Add a piece below, or above."""
        self._open_catalogue("below" if below else "above")

    def action_clamp(self) -> None:
        """Clamp an instrument on the piece."""
        if self.table.spot is None:
            self.tell("There is no piece yet to clamp it on")
        else:
            self._open_catalogue("clamp")

    def action_replace(self) -> None:
        """Use another component."""
        if self.table.spot is not None:
            self._open_catalogue("replace")

    def _open_catalogue(self, purpose: Purpose) -> None:
        self.remove_class("-zoomed")
        self.add_class("-searching")
        spot = self.table.spot
        clampable = purpose == "clamp" or (
            purpose == "replace" and spot is not None and spot.is_clamp
        )
        self.catalogue.open(purpose, self._target(purpose), clampable=clampable, towed=self.is_tow)

    def _target(self, purpose: Purpose) -> str:
        """What the row is called that the component is for."""
        spot = self.table.spot
        if spot is None:
            return ""
        values = self.session.item(spot if purpose == "replace" else Place(spot.item)).values
        return values.get("label") or values.get("use", "")

    @on(CataloguePane.Taken)
    def _take_component(self, event: CataloguePane.Taken) -> None:
        spot, values, purpose = self.table.spot, event.values, event.purpose
        session = self.session
        if purpose == "clamp" and spot is not None:
            self.attempt(lambda: session.clamp(spot, values), f"{values['use']} clamped on")
        elif purpose == "replace" and spot is not None:
            self._replace(spot, values)
            return
        else:
            below = purpose != "above"
            self.attempt(
                lambda: session.insert(spot, values, below=below), f"{values['use']} added"
            )
            if not below:  # the next one comes below it: a line is listed downwards
                self.catalogue.purpose = "below"
        self.catalogue.retitle(self._target(self.catalogue.purpose))

    def _replace(self, spot: Place, values: dict[str, str]) -> None:
        """Another component on a row; what the row has said of the one before is told."""
        place = ("line", spot.item, *(("clamps", spot.clamp) if spot.is_clamp else ()))
        written = self.session.draft.value(place)
        kept = [
            f"{key} {value}" if isinstance(value, str) else key
            for key, value in (written if isinstance(written, dict) else {}).items()
            if key not in _OF_THE_ROW
        ]
        told = f"now {values['use']}"
        if kept:
            told += f"; kept from the one before: {', '.join(kept)}"
        self.attempt(lambda: self.session.put(spot, values, f"use {values['use']}"), told)
        self._close_catalogue()

    @on(CataloguePane.Closed)
    def _close_catalogue(self) -> None:
        self.remove_class("-searching")
        self.table.focus()

    @on(LineTable.Moved)
    def _retarget(self) -> None:
        if self.has_class("-searching"):
            self.catalogue.retitle(self._target(self.catalogue.purpose))

    def action_define(self) -> None:
        """Define a component of one's own, and put it into the line."""
        from calm.tui.catalogue.component_screen import ComponentScreen

        def take(defined: tuple[str, dict[str, str]] | None) -> None:
            if defined is None:
                return
            id, values = defined
            session = self.session
            if self.attempt(
                lambda: session.do(session.draft.put_component(id, values), f"define {id}"),
                f"{id} is defined in the file; the catalogue has it",
            ):
                self._open_catalogue("below")
                self.catalogue.search.value = id

        listed = () if self.index is None else tuple(self.index.catalogue.ids())
        defined = self.session.draft.value(("components",))
        own = tuple(defined) if isinstance(defined, dict) else ()
        self.app.push_screen(ComponentScreen(listed, own), take)
