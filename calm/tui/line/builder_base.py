"""What the verbs of the first screen stand on: its parts, and how a change becomes visible."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from calm.errors import CalmError
from calm.files import Place
from calm.tui.bars import TitleBar
from calm.tui.catalogue.index import Index
from calm.tui.catalogue.pane import CataloguePane
from calm.tui.line.cell_editor import CellEditor
from calm.tui.line.rows import table_rows
from calm.tui.line.table import LineTable
from calm.tui.messages import Edited
from calm.tui.pictures import Pictures
from calm.tui.screen import DraftScreen
from calm.tui.session import Session
from calm.tui.verdict_pane import VerdictPane, state_sign, state_word

if TYPE_CHECKING:
    from calm.files import Catalogue
    from calm.tui.live import View


class BuilderBase(DraftScreen):
    """The line, its picture and its verdict, as they are now.

    Attributes
    ----------
    session : the file
    index : the catalogue with the file's own components; None until it is read
    view : what was last made of the file; None until it is
    good : the last one that stood
    """

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.index: Index | None = None
        self.view: View | None = None
        self.good: View | None = None
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
        return self.session.draft.is_tow

    def show_view(self, view: View) -> None:
        """Show what a worker made of the file; nothing where it has changed since."""
        if not (self.is_mounted and self.is_attached):
            return  # not there yet, or on the way out
        self.view = view
        if view.result is not None:
            self.good = view
        if self.is_fresh(view):
            self.refresh_rows()

    def take_catalogue(self, catalogue: Catalogue) -> None:
        """Search a catalogue, with what the file defines itself."""
        self._catalogue = catalogue
        self._refresh_index()
        self.refresh_rows()

    def _refresh_index(self) -> None:
        """The index of the catalogue and the file's own components, when these are others."""
        draft = self.session.draft
        defined = draft.value(("components",))
        if self._catalogue is not None and (self.index is None or defined != self._defined):
            self._defined = defined
            self.index = Index.of(self._catalogue, draft.text)
            self.catalogue.take_index(self.index)

    def refresh_rows(self) -> None:
        """Show the file as it is now, with the figures that are known of it."""
        self._refresh_index()
        view, fresh = self.view, self.is_fresh(self.view)
        figures = view if view is not None and (view.rows or view.problems) else self.good
        rows = table_rows(self.session.draft, figures, self.index)
        self.table.show_rows(rows, old=not fresh)
        self._show_study(fresh)
        self.show_title()

    def _show_study(self, fresh: bool) -> None:
        """The picture and the verdict of the last view, dimmed until they are `fresh`."""
        pictures, verdict, view = self.query_one(Pictures), self.query_one(VerdictPane), self.view
        last = None if view is None or view.result is not None else self.good
        if fresh:
            pictures.show(last or view, "as it last stood" if last else "")
            verdict.show(view, "The picture shows the line as it last stood." if last else "")
        pictures.set_class(not fresh or last is not None, "-old")
        verdict.set_class(not fresh, "-old")

    def show_title(self) -> None:
        """Name, file, what is not saved; environment and verdict."""
        name = " ".join(self.session.draft.text_at(("name",)).split())
        here, parts = self.session.environment, []
        if here is not None or len(self.environments) > 1:
            parts.append(f"environment {here}" if here else "own environment")
        narrow = self.has_class("-narrow") and not self.has_class("-flat")
        old = not self.is_fresh(self.view)
        parts.append((state_sign if narrow else state_word)(self.view, old=old))
        self.query_one(TitleBar).show(f"{self.called}  {name}".rstrip(), "   ".join(parts), old=old)

    def changed(self, spot: Place | None = None, told: str = "") -> None:
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
        self.changed(spot if isinstance(spot, Place) else None, told)
        return True
