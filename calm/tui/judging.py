"""The file judged while it is edited: by workers, only its last state, what takes longer later."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from textual.app import App
from textual.timer import Timer

from calm.tui.messages import Judged, JudgingFailed, Workspace

if TYPE_CHECKING:
    from calm.tui.live import View

_DIMMED_AFTER = 0.3  # seconds: what is solved sooner is not dimmed for it
_FULLY_AFTER = 0.5  # seconds without a change before launch, recovery and breaks are judged


class Judging:
    """Starts workers that judge the draft of a workspace and post messages to the application.

    Parameters
    ----------
    app : whose workers they are
    workspace : takes what they find
    show : shows the workspace as it is
    """

    def __init__(self, app: App[int], workspace: Workspace, show: Callable[[], object]) -> None:
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

    def take(self, event: Judged) -> bool:
        """Take what a worker has found; whether it is of the last state that was judged."""
        workspace = self._workspace
        if event.fully:
            is_late, self._checked = self._checked is not workspace.view, None
        else:
            is_late, self._is_judging = False, False
        if not is_late:
            workspace.take_view(event.view)
            workspace.is_late = workspace.is_late and not workspace.is_fresh
        if self._is_wanted:
            self.ask()
        elif (is_late or not event.fully) and not (self._is_judging or self._fully):
            self._fully = self._app.set_timer(_FULLY_AFTER, self.ask_fully)
        return not is_late

    def failed(self) -> None:
        """Report a failure of CALM itself; later drafts are judged all the same."""
        self._is_judging, self._checked = False, None
        if self._is_wanted:
            self.ask()

    def _work(self, judge: Callable[[Any], View], *, fully: bool) -> None:
        def work() -> None:
            try:
                from calm.tui import live  # with what solves, after the first screen

                view = judge(live)
            except Exception as error:
                self._app.post_message(JudgingFailed(f"{type(error).__name__}: {error}"))
            else:
                self._app.post_message(Judged(view, fully))

        self._app.run_worker(work, thread=True, group="judging", exit_on_error=False)

    def _stop_waiting(self) -> None:
        if self._fully is not None:
            self._fully.stop()
            self._fully = None
