"""What screens and workers tell the application, and where a mistake is for a person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from textual.content import Content
from textual.message import Message

from calm.assemble.catalogue_search import Index
from calm.errors import CalmError
from calm.files import Place
from calm.files.editing import LineItem
from calm.tui.session import Session

if TYPE_CHECKING:
    from calm.errors import Problem
    from calm.files import Catalogue
    from calm.tui.live import View


class Edited(Message):
    """The file, or the environment it is seen in, is another one."""


@dataclass
class Told(Message):
    """Something is to be said in the last line; `wrong` where something cannot be done."""

    text: str
    wrong: bool = False


@dataclass
class Judged(Message):
    """A worker has judged the file; `fully` with its launch, recovery and breaks."""

    view: View
    fully: bool


@dataclass
class JudgingFailed(Message):
    """CALM itself failed."""

    reason: str


@dataclass
class CatalogueRead(Message):
    """A worker has read the catalogue; None where that cannot be used, with the reason."""

    catalogue: Catalogue | None
    reason: str = ""


def is_elsewhere(problem: Problem, path: Path) -> bool:
    """Return whether a mistake is in another file than the one that is edited, which has this
    path.
    """
    return problem.path not in ("", str(path))


def place_of(problem: Problem, path: Path) -> str:
    """Return where a mistake is: ``line 4:2``, with the file where it is not that of the path."""
    place = f"line {problem.line}:{problem.column}" if problem.line else ""
    if not is_elsewhere(problem, path):
        return place
    file, folder = Path(problem.path), path.parent
    name = file.relative_to(folder) if file.is_relative_to(folder) else file
    return f"{name}, {place}" if place else str(name)


def said(problem: Problem, path: Path) -> Content:
    """A mistake with its sign and its place."""
    parts = filter(None, (place_of(problem, path), problem.message))
    return Content.assemble(("!", "bold $text-error"), f" {'  '.join(parts)}")


def mistakes(problems: Sequence[Problem], path: Path) -> str:
    """Return how many there are, and in which file; empty of none."""
    count = len(problems)
    files = {each.path for each in problems if is_elsewhere(each, path)}
    if not count:
        return ""
    if not files or any(not is_elsewhere(each, path) for each in problems):
        where = "in the file" if not files else "in the file and others"
    else:
        where = f"in {Path(*files).name}" if len(files) == 1 else "in other files"
    return f"{count} mistake{'s' * (count != 1)} {where}"


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

    def is_assembly(self, item: LineItem) -> bool:
        """Return whether a row is one of several parts, as far as the catalogue is read."""
        listed = None if self.index is None else self.index.get(item.values.get("use", ""))
        return listed is not None and listed.kind == "assembly"

    @property
    def is_fresh(self) -> bool:
        """Return whether the view is of what is edited: the text, the file's place and the
        environment.
        """
        session, view = self.session, self.view
        return view is not None and view.is_of(
            session.draft.text, session.file.path, session.standing.environment
        )

    @property
    def is_old(self) -> bool:
        """Return whether the figures are to be shown dimmed, those of an earlier draft."""
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
