"""The session on the screen: what was last made of it, and how a change of it becomes known."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from calm.errors import CalmError
from calm.files import Place
from calm.tui.catalogue.index import Index
from calm.tui.session import Session

if TYPE_CHECKING:
    from calm.files import Catalogue
    from calm.tui.live import View


class Tell(Protocol):
    """Says something in the last line of the screen, until the next key."""

    def __call__(self, text: str, *, wrong: bool = False) -> None:
        """Say it; `wrong` where something cannot be done."""


class Workspace:
    """What all screens and their parts are handed.

    Parameters
    ----------
    session : the file that is built
    tell : says something in the last line of the screen
    edited : has the draft judged and kept, another one now

    Attributes
    ----------
    index : the catalogue with the file's own components; None until it is read
    view : what was last made of the file; None until it is
    good : the last one that stood
    is_late : whether the view has been that of an earlier draft for some time
    """

    def __init__(self, session: Session, tell: Tell, edited: Callable[[], object]) -> None:
        self.session, self.tell, self.edited = session, tell, edited
        self.index: Index | None = None
        self.view: View | None = None
        self.good: View | None = None
        self.is_late = False
        self._catalogue: Catalogue | None = None
        self._defined: Any = None

    def take_view(self, view: View) -> None:
        """Take what a worker made of the file."""
        self.view = view
        if view.result is not None:
            self.good = view

    def take_catalogue(self, catalogue: Catalogue) -> None:
        """Search a catalogue, with what the file defines itself."""
        self._catalogue, self.index = catalogue, None
        self.refresh_index()

    def refresh_index(self) -> None:
        """Make the index anew where the file's own components are others."""
        draft = self.session.draft
        defined = draft.value(("components",))
        if self._catalogue is not None and (self.index is None or defined != self._defined):
            self._defined = defined
            self.index = Index.of(self._catalogue, draft.text)

    @property
    def is_fresh(self) -> bool:
        """Whether the view is of what is edited: the text, the file's place and the environment."""
        session, view = self.session, self.view
        return view is not None and view.is_of(
            session.draft.text, session.file.path, session.standing.environment
        )

    @property
    def is_old(self) -> bool:
        """Whether the figures are to be shown dimmed, those of an earlier draft."""
        return self.is_late and not self.is_fresh

    @property
    def called(self) -> str:
        """The name of the file, and that it is not saved where it is not."""
        return self.session.name + (" (not saved)" if self.session.changed else "")

    def attempt(self, change: Callable[[], object]) -> tuple[bool, Place | None]:
        """Make a change; whether it was made, and the row it leads to. A refusal is reported."""
        try:
            spot = change()
        except CalmError as error:
            self.tell(str(error), wrong=True)
            return False, None
        return True, spot if isinstance(spot, Place) else None
