"""State shared by all screens: edited file, mistakes, results, and workers that judge the draft."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from textual.app import App
from textual.content import Content
from textual.timer import Timer

from calm.assemble.catalogue_search import Index
from calm.errors import CalmError, Problem
from calm.files import Catalogue, Place
from calm.tui.session import Session

if TYPE_CHECKING:
    from calm.tui.live import View


def is_elsewhere(problem: Problem, path: Path) -> bool:
    """Return whether a mistake is in a file other than the edited file."""
    return problem.path not in ("", str(path))


def place_of(problem: Problem, path: Path) -> str:
    """Format the position of a mistake, such as ``line 4:2``.

    If the mistake is in a file other than the edited file, the file name precedes the position.
    """
    place = f"line {problem.line}:{problem.column}" if problem.line else ""
    if not is_elsewhere(problem, path):
        return place
    file, folder = Path(problem.path), path.parent
    name = file.relative_to(folder) if file.is_relative_to(folder) else file
    return f"{name}, {place}" if place else str(name)


def problem_text(problem: Problem, path: Path) -> Content:
    """Return a text with the symbol, the position and the message of a mistake."""
    parts = filter(None, (place_of(problem, path), problem.message))
    return Content.assemble(("!", "bold $text-error"), f" {'  '.join(parts)}")


def mistakes(problems: Sequence[Problem], path: Path) -> str:
    """Return the number of mistakes and their files, as text; "" if there are no mistakes."""
    count = len(problems)
    files = {each.path for each in problems if is_elsewhere(each, path)}
    if not count:
        return ""
    if any(not is_elsewhere(each, path) for each in problems):
        where = "in the file and others" if files else "in the file"
    else:
        where = f"in {Path(*files).name}" if len(files) == 1 else "in other files"
    return f"{count} mistake{'s' * (count != 1)} {where}"


class Workspace:
    """Data shared by all screens.

    Parameters
    ----------
    tell : function that shows a message until the next key; its argument `wrong` marks an error
    edited : function that checks the draft and keeps a backup copy

    Attributes
    ----------
    index : search index of the catalogue and the components of the file, once loaded
    view : last view of the file, once solved
    good : last view with an equilibrium
    is_late : whether the view has been out of date for some time
    documents_elsewhere : message on how to get reports and sheets if the builder cannot write them
    """

    def __init__(
        self, session: Session, tell: Callable[..., object], edited: Callable[[], object]
    ) -> None:
        self.session, self.tell, self.edited = session, tell, edited
        self.index: Index | None = None
        self.view: View | None = None
        self.good: View | None = None
        self.is_late = False
        self.documents_elsewhere = ""
        self._catalogue: Catalogue | None = None
        self._defined: Any = None

    def take_catalogue(self, catalogue: Catalogue) -> None:
        """Switch to a catalogue, and rebuild the search index with the components of the file."""
        self._catalogue, self.index = catalogue, None
        self.refresh_index()

    def refresh_index(self) -> None:
        """Rebuild the search index if the components of the file have changed."""
        draft = self.session.draft
        defined = draft.value(("components",))
        if self._catalogue is not None and (self.index is None or defined != self._defined):
            self._defined = defined
            self.index = Index.of(self._catalogue, draft.text)

    @property
    def is_fresh(self) -> bool:
        """Whether the results belong to the current text, path and environment."""
        session, view = self.session, self.view
        return view is not None and view.is_of(
            session.draft.text, session.file.path, session.choice.environment
        )

    def judged(self, otherwise: str) -> View | None:
        """Return the view if it is up to date, else show a message and return None."""
        if not self.is_fresh:
            self.tell(otherwise)
            return None
        return self.view

    @property
    def is_old(self) -> bool:
        """Whether values are dimmed because they belong to an earlier draft."""
        return self.is_late and not self.is_fresh

    @property
    def path(self) -> Path:
        """Path of the file, as used in reports of mistakes."""
        return Path() if self.view is None else self.view.path

    @property
    def called(self) -> str:
        """Name of the file, followed by a note on unsaved changes."""
        return self.session.name + (" (not saved)" if self.session.changed else "")

    def attempt(self, change: Callable[[], object]) -> tuple[bool, Place | None]:
        """Make a change; return whether the change succeeded, and the row that `change` returned.

        If the change fails, a message shows the reason.
        """
        try:
            spot = change()
        except CalmError as error:
            self.tell(str(error), wrong=True)
            return False, None
        return True, spot if isinstance(spot, Place) else None


_DIM_DELAY = 0.3  # seconds; faster solutions cause no dimming
_FULL_CHECK_DELAY = 0.5  # seconds without a change before launch, recovery and breaks are judged


class Judging:
    """Workers that solve and check the draft of a workspace.

    `show` updates the screens; its argument `is_first` marks the first view.
    """

    def __init__(self, app: App[int], workspace: Workspace, show: Callable[..., object]) -> None:
        self._app, self._workspace, self._show = app, workspace, show
        self._is_judging = False
        self._is_stale = False  # a change is not judged yet
        self._is_wanted = False  # judge the newest text when the worker returns
        self._checked: View | None = None  # the view that is being judged fully
        self._fully: Timer | None = None
        self._dimming: Timer | None = None

    @property
    def is_idle(self) -> bool:
        """Whether the draft has been solved and checked, and no worker is running."""
        busy = self._is_judging or self._is_stale or self._checked is not None
        return not busy and self._workspace.view is not None

    def after_an_edit(self) -> None:
        """Solve and check the new draft, after the screen has shown the typed text."""
        self._is_stale = True
        self._app.call_after_refresh(self.ask)
        if self._dimming is None:
            self._dimming = self._app.set_timer(_DIM_DELAY, self.dim)

    def dim(self) -> None:
        """Dim the displayed values if they belong to an earlier draft."""
        self._dimming = None
        if not self._workspace.is_fresh:
            self._workspace.is_late = True
            self._show()

    def ask(self) -> None:
        """Solve and check the draft.

        If a worker is busy, it first finishes its work, and then continues with the latest draft.
        """
        self._is_stale = False
        self._stop_waiting()
        if self._is_judging:
            self._is_wanted = True
        else:
            self._is_judging, self._is_wanted = True, False
            session = self._workspace.session
            path, environment = session.file.path, session.choice.environment
            text, catalogs, keep = session.draft.text, session.catalogs, self._workspace.view
            self._work(
                lambda live: live.judge(text, path, environment, catalogs, keep=keep), fully=False
            )

    def ask_fully(self) -> None:
        """Apply all checks to the draft, including launch, recovery and breaks."""
        self._stop_waiting()
        view = self._workspace.view
        is_free = not self._is_judging and self._checked is None
        if is_free and view is not None and not view.complete:
            self._checked = view
            catalogs = self._workspace.session.catalogs
            self._work(lambda live: live.judge_fully(view, catalogs), fully=True)

    def _take_view(self, view: View, fully: bool) -> None:
        workspace = self._workspace
        is_first, is_late = workspace.view is None, fully and self._checked is not workspace.view
        if fully:
            self._checked = None
        else:
            self._is_judging = False
        if not is_late:
            workspace.view = view
            workspace.good = view if view.result is not None else workspace.good
            workspace.is_late = workspace.is_late and not workspace.is_fresh
        if self._is_wanted:
            self.ask()
        elif (is_late or not fully) and not (self._is_judging or self._fully):
            self._fully = self._app.set_timer(_FULL_CHECK_DELAY, self.ask_fully)
        if not is_late:
            self._show(is_first=is_first)

    def _fail(self, reason: str) -> None:
        self._workspace.tell(f"internal error ({reason}); please report it", wrong=True)
        self._is_judging, self._checked = False, None
        if self._is_wanted:
            self.ask()

    def _work(self, judge: Callable[[Any], View], *, fully: bool) -> None:
        def work() -> None:
            try:
                from calm.tui import live  # imports the solver, after the first screen

                view = judge(live)
            except Exception as error:
                self._app.call_later(self._fail, f"{type(error).__name__}: {error}")
            else:
                self._app.call_later(self._take_view, view, fully)

        self._app.run_worker(work, thread=True, group="judging", exit_on_error=False)

    def _stop_waiting(self) -> None:
        if self._fully is not None:
            self._fully.stop()
            self._fully = None
