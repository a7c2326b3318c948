"""The file that is built as all screens have it: its mistakes, its view, and who judges it."""

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
    """Return whether a mistake is in another file than that of the path, which is edited."""
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
    if any(not is_elsewhere(each, path) for each in problems):
        where = "in the file and others" if files else "in the file"
    else:
        where = f"in {Path(*files).name}" if len(files) == 1 else "in other files"
    return f"{count} mistake{'s' * (count != 1)} {where}"


class Workspace:
    """Hold what all screens and their parts are handed.

    Parameters
    ----------
    session : the file that is built
    tell : says something in the last line of the screen, until the next key; `wrong` where
        something cannot be done
    edited : has the draft judged and kept, another one now

    Attributes
    ----------
    index : the catalogue with the file's own components; None until it is read
    view : what was last made of the file; None until it is
    good : the last one that stood
    is_late : whether the view has been that of an earlier draft for some time
    papers_elsewhere : how to get reports and sheets if the builder cannot run a command for them
    """

    def __init__(
        self, session: Session, tell: Callable[..., object], edited: Callable[[], object]
    ) -> None:
        self.session, self.tell, self.edited = session, tell, edited
        self.index: Index | None = None
        self.view: View | None = None
        self.good: View | None = None
        self.is_late = False
        self.papers_elsewhere = ""
        self._catalogue: Catalogue | None = None
        self._defined: Any = None

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
        """Return whether the view is of the text, the path and the environment of now."""
        session, view = self.session, self.view
        return view is not None and view.is_of(
            session.draft.text, session.file.path, session.standing.environment
        )

    def judged(self, otherwise: str) -> View | None:
        """Return the view of what is edited; None where there is none yet, which is told."""
        if not self.is_fresh:
            self.tell(otherwise)
            return None
        return self.view

    @property
    def is_old(self) -> bool:
        """Return whether the figures are to be shown dimmed, those of an earlier draft."""
        return self.is_late and not self.is_fresh

    @property
    def path(self) -> Path:
        """Return that of the file, as its problems have it."""
        return Path() if self.view is None else self.view.path

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


_DIMMED_AFTER = 0.3  # seconds: what is solved sooner is not dimmed for it
_FULLY_AFTER = 0.5  # seconds without a change before launch, recovery and breaks are judged


class Judging:
    """Has workers of the application judge the draft of a workspace, and takes what they find.

    Parameters
    ----------
    app : whose workers they are
    workspace : takes what they find
    show : shows the workspace as it is; `is_first` where its first view is there
    """

    def __init__(self, app: App[int], workspace: Workspace, show: Callable[..., object]) -> None:
        self._app, self._workspace, self._show = app, workspace, show
        self._is_judging = False
        self._is_stale = False  # a change is not asked about yet
        self._is_wanted = False  # another text is to be judged when the worker comes back
        self._checked: View | None = None  # what is being judged fully
        self._fully: Timer | None = None
        self._dimming: Timer | None = None

    @property
    def is_idle(self) -> bool:
        """Return whether the draft has been judged, and nothing is under way."""
        busy = self._is_judging or self._is_stale or self._checked is not None
        return not busy and self._workspace.view is not None

    def after_an_edit(self) -> None:
        """Judge the new draft, after what was typed is shown."""
        self._is_stale = True
        self._app.call_after_refresh(self.ask)
        if self._dimming is None:
            self._dimming = self._app.set_timer(_DIMMED_AFTER, self.dim)

    def dim(self) -> None:
        """Show that the figures are still of an earlier draft."""
        self._dimming = None
        if not self._workspace.is_fresh:
            self._workspace.is_late = True
            self._show()

    def ask(self) -> None:
        """Have the draft judged, now or when the worker comes back; only its last state counts."""
        self._is_stale = False
        self._stop_waiting()
        if self._is_judging:
            self._is_wanted = True
        else:
            self._is_judging, self._is_wanted = True, False
            session = self._workspace.session
            path, environment = session.file.path, session.standing.environment
            text, catalogs, keep = session.draft.text, session.catalogs, self._workspace.view
            self._work(
                lambda live: live.judge(text, path, environment, catalogs, keep=keep), fully=False
            )

    def ask_fully(self) -> None:
        """Have the launch, the recovery and the breaks judged, too."""
        self._stop_waiting()
        view = self._workspace.view
        is_free = not self._is_judging and self._checked is None
        if is_free and view is not None and not view.complete:
            self._checked = view
            catalogs = self._workspace.session.catalogs
            self._work(lambda live: live.judge_fully(view, catalogs), fully=True)

    def _take(self, view: View, fully: bool) -> None:
        """Take what a worker has found, `fully` with launch, recovery and breaks."""
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
            self._fully = self._app.set_timer(_FULLY_AFTER, self.ask_fully)
        if not is_late:
            self._show(is_first=is_first)

    def _fail(self, reason: str) -> None:
        """Report a failure of CALM itself; later drafts are judged all the same."""
        self._workspace.tell(f"internal error ({reason}); please report it", wrong=True)
        self._is_judging, self._checked = False, None
        if self._is_wanted:
            self.ask()

    def _work(self, judge: Callable[[Any], View], *, fully: bool) -> None:
        def work() -> None:
            try:
                from calm.tui import live  # with what solves, after the first screen

                view = judge(live)
            except Exception as error:
                self._app.call_later(self._fail, f"{type(error).__name__}: {error}")
            else:
                self._app.call_later(self._take, view, fully)

        self._app.run_worker(work, thread=True, group="judging", exit_on_error=False)

    def _stop_waiting(self) -> None:
        if self._fully is not None:
            self._fully.stop()
            self._fully = None
