"""What the verbs of the first screen stand on: its parts, and how a change becomes visible."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from textual.screen import Screen

from calm.errors import CalmError
from calm.tui.bars import KeyBar, TitleBar
from calm.tui.catalogue_index import Index
from calm.tui.catalogue_pane import CataloguePane
from calm.tui.cell_editor import CellEditor
from calm.tui.line_table import LineTable
from calm.tui.messages import Edited
from calm.tui.pictures import Pictures
from calm.tui.rows import table_rows
from calm.tui.session import Session, Spot
from calm.tui.verdict_pane import VerdictPane, state_sign, state_word
from calm.tui.written import document_of, is_tow, written

if TYPE_CHECKING:
    from calm.files import Catalogue
    from calm.tui.live import View


class BuilderBase(Screen[None]):
    """The line, its picture and its verdict, as they are now.

    Attributes
    ----------
    session : the file
    index : the catalogue with the file's own components; None until it is read
    view : what was last made of the file; None until it is
    good : the last one that stood
    """

    def __init__(self, session: Session, *, ascii_only: bool = False) -> None:
        super().__init__()
        self.session = session
        self.index: Index | None = None
        self.view: View | None = None
        self.good: View | None = None
        self.ascii_only = ascii_only
        self._catalogue: Catalogue | None = None
        self._defined: Any = None

    @property
    def table(self) -> LineTable:
        """The line."""
        return self.query_one(LineTable)

    @property
    def editor(self) -> CellEditor:
        """Where a value is edited in place."""
        return self.query_one(CellEditor)

    @property
    def catalogue(self) -> CataloguePane:
        """The catalogue at hand."""
        return self.query_one(CataloguePane)

    @property
    def is_tow(self) -> bool:
        """Whether the file is that of a tow."""
        return is_tow(self.session.draft.text)

    def show_view(self, view: View) -> None:
        """Show what a worker made of the file; nothing where it has changed since."""
        if not self.is_mounted:
            return
        self.view = view
        if view.result is not None:
            self.good = view
        if view.text == self.session.draft.text:
            self.refresh_rows()

    def take_catalogue(self, catalogue: Catalogue) -> None:
        """Search a catalogue, with what the file defines itself."""
        self._catalogue = catalogue
        self._refresh_index()
        self.refresh_rows()

    def _refresh_index(self) -> None:
        """The index of the catalogue and the file's own components, when these are others."""
        defined = written(self.session.draft.text).get("components")
        if self._catalogue is not None and (self.index is None or defined != self._defined):
            self._defined = defined
            self.index = Index.of(self._catalogue, document_of(self.session.draft.text))
            self.catalogue.take_index(self.index)

    def refresh_rows(self) -> None:
        """Show the file as it is now, with the figures that are known of it."""
        self._refresh_index()
        fresh = self.view is not None and self.view.text == self.session.draft.text
        view = self.view
        figures = view if view is not None and (view.rows or view.problems) else self.good
        rows = table_rows(self.session.draft, figures, self.index)
        self.table.show_rows(rows, old=not fresh)
        if fresh:
            self.show_verdict()
        self.show_title()

    def show_verdict(self) -> None:
        """The picture and the verdict of the last view."""
        view = self.view
        old = view is not None and view.result is None and self.good is not None
        self.query_one(Pictures).show(self.good if old else view, old=old)
        self.query_one(VerdictPane).show(view, old=old)

    def show_title(self) -> None:
        """Name, file, what is not saved; environment and verdict."""
        session = self.session
        said = written(session.draft.text)
        unsaved = " (not saved)" if session.changed else ""
        name = said.get("name")
        left = f"{session.name}{unsaved}" + (f"  {name}" if isinstance(name, str) else "")
        several = session.environment is not None or isinstance(said.get("environments"), dict)
        parts = [session.environment or "own water"] if several else []
        narrow = self.has_class("-narrow") and not self.has_class("-flat")
        parts.append(state_sign(self.view) if narrow else state_word(self.view))
        self.query_one(TitleBar).show(left, "   ".join(parts))

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line, until the next key."""
        self.query_one(KeyBar).tell(text, wrong=wrong)

    def changed(self, spot: Spot | None = None, told: str = "") -> None:
        """The file is another one."""
        self.refresh_rows()
        self.table.go_to(spot)
        self.tell(told)
        self.post_message(Edited())

    def attempt(self, change: Callable[[], object], told: str = "") -> bool:
        """Make a change that gives the row to go to; what refuses is told. Whether it was made."""
        try:
            spot = change()
        except CalmError as error:
            self.tell(str(error), wrong=True)
            return False
        self.table.mark(frozenset())
        self.changed(spot if isinstance(spot, Spot) else None, told)
        return True
