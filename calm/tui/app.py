"""The application: it owns the workers, the signals and the way out; screens own what is shown."""

from __future__ import annotations

import asyncio
import os
import signal
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on, work
from textual.app import App, SystemCommand
from textual.screen import Screen

from calm.errors import CalmError
from calm.tui.builder import BuilderScreen
from calm.tui.dialogs import Answer, Question
from calm.tui.messages import CatalogueRead, Edited, Judged, JudgingFailed
from calm.tui.palette import Actions
from calm.tui.saving import Saving
from calm.tui.session import Session
from calm.tui.theme import PICTURE_DARK, PICTURE_LIGHT, choose_theme, themes
from calm.tui.turns import InTurn

if TYPE_CHECKING:
    from calm.tui.live import View

_FULLY_AFTER = 0.5  # seconds without a change before launch, recovery and breaks are judged
_AUTOSAVED_AFTER = 0.3  # seconds
_LOOKED_AT_DISK = 2.0  # seconds between two looks


class BuildApp(Saving, InTurn):
    """The line builder.

    Parameters
    ----------
    session : the file that is built
    recovered : a text that an earlier run has kept and not saved, to be offered
    ascii_only : draw with plain signs
    environ : tells of the terminal
    """

    TITLE = "calm build"
    COMMANDS: ClassVar[set[Any]] = {*App.COMMANDS, Actions}
    CSS = """
    * { scrollbar-size: 1 1; }
    """

    def __init__(
        self,
        session: Session,
        *,
        recovered: str | None = None,
        ascii_only: bool = False,
        environ: Mapping[str, str] = os.environ,
    ) -> None:
        super().__init__()
        self.session = session
        self.builder = BuilderScreen(session, ascii_only=ascii_only)
        self._recovered = recovered
        self._environ = environ
        self._view: View | None = None
        self._read = False
        self._busy = False
        self._stale = False
        self._wanted = False
        self._fully: Any = None
        self._autosaving: Any = None

    def on_mount(self) -> None:
        """Show the line; the first solution and the catalogue follow."""
        for theme in themes():
            self.register_theme(theme)
        self.ansi_theme_dark, self.ansi_theme_light = PICTURE_DARK, PICTURE_LIGHT
        self.theme = choose_theme(self._environ)
        self.push_screen(self.builder)
        self.call_after_refresh(self._begin)
        self._listen()
        self.set_interval(_LOOKED_AT_DISK, self.look_at_disk)
        if self._recovered is not None:
            self.call_after_refresh(self._offer_recovered)
        elif self.session.draft.problems:
            self.call_after_refresh(self.builder.action_text)

    def _begin(self) -> None:
        """Once the line is on the screen: read the catalogue, solve."""
        self._read_catalogue()
        self._ask()

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """Of what textual offers, the colours; the rest has its own keys here."""
        yield SystemCommand("colours", "Choose other colours.", self.action_change_theme)

    # judging

    @property
    def is_idle(self) -> bool:
        """Whether the line that is shown has been solved, and nothing else is under way."""
        return not (self._busy or self._stale) and self._view is not None and self._read

    @on(Edited)
    def _after_an_edit(self) -> None:
        self._stale = True
        self.call_after_refresh(self._ask)  # what was typed is seen first
        if self._autosaving is None:
            self._autosaving = self.set_timer(_AUTOSAVED_AFTER, self._autosave)

    def _ask(self) -> None:
        """Have the file judged, now or when the worker comes back; only its last state counts."""
        self._stale = False
        if self._fully is not None:
            self._fully.stop()
            self._fully = None
        if self._busy:
            self._wanted = True
        else:
            self._busy, self._wanted = True, False
            self._judge(self.session.draft.text, self.session.environment)

    @work(thread=True, group="judging", exit_on_error=False)
    def _judge(self, text: str, environment: str | None) -> None:
        from calm.tui.live import judge

        session = self.session
        try:
            view = judge(text, session.file.path, environment, session.catalogs, keep=self._view)
        except Exception as error:
            self.post_message(JudgingFailed(f"{type(error).__name__}: {error}"))
        else:
            self.post_message(Judged(view, fully=False))

    @work(thread=True, group="judging", exit_on_error=False)
    def _judge_fully(self, view: View) -> None:
        from calm.tui.live import judge_fully

        try:
            full = judge_fully(view)
        except Exception as error:
            self.post_message(JudgingFailed(f"{type(error).__name__}: {error}"))
        else:
            self.post_message(Judged(full, fully=True))

    @on(Judged)
    def _take_view(self, event: Judged) -> None:
        self._busy = False
        is_first, self._view = self._view is None, event.view
        view = event.view
        if self._wanted:
            self._ask()
        elif not event.fully and not view.complete:
            self._fully = self.set_timer(_FULLY_AFTER, self.ask_fully)
        for screen in self.screen_stack:
            show = getattr(screen, "show_view", None)
            if show is not None:
                show(view)
        if is_first and view.problems and isinstance(self.screen, BuilderScreen):
            self.screen.action_text()  # a file with mistakes is mended as text

    def ask_fully(self) -> None:
        """Have the launch, the recovery and the breaks judged, too."""
        if self._fully is not None:
            self._fully.stop()
            self._fully = None
        if not self._busy and self._view is not None:
            self._busy = True
            self._judge_fully(self._view)

    @on(JudgingFailed)
    def _tell_failure(self, event: JudgingFailed) -> None:
        self._busy = False
        self.tell(f"internal error ({event.reason}); please report it", wrong=True)
        if self._wanted:
            self._ask()

    # the catalogue

    @work(thread=True, exit_on_error=False)
    def _read_catalogue(self) -> None:
        from calm.files import Catalogue

        try:
            self.post_message(CatalogueRead(Catalogue.load(self.session.catalogs)))
        except CalmError as error:
            self.post_message(CatalogueRead(None, str(error)))

    @on(CatalogueRead)
    def _take_catalogue(self, event: CatalogueRead) -> None:
        self._read = True
        if event.catalogue is None:
            self.tell(event.reason, wrong=True)
        else:
            self.builder.take_catalogue(event.catalogue)

    # what is kept, and the way out

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line of the screen."""
        tell = getattr(self.screen, "tell", None) or self.builder.tell
        tell(text, wrong=wrong)

    def _autosave(self) -> None:
        self._autosaving = None
        self.keep()

    def _listen(self) -> None:
        """Keep what is not saved when the terminal is closed or the process is ended."""
        if os.name != "posix":
            return
        loop = asyncio.get_running_loop()
        for number in (signal.SIGHUP, signal.SIGTERM):
            loop.add_signal_handler(number, self._end)

    def _end(self) -> None:
        self.keep()
        self.exit(0)

    def _offer_recovered(self) -> None:
        text = self._recovered
        assert text is not None

        def take(answer: str | None) -> None:
            if answer == "recover":
                self.session.write(text, "recover what was not saved")
                self.builder.changed(told="Recovered; save it to keep it")
            else:
                self.session.file.forget()
            if self.session.draft.problems:
                self.builder.action_text()

        answers = [Answer("r", "recover it", "recover"), Answer("d", "throw it away", "discard")]
        self.push_screen(
            Question(
                "Work that was not saved",
                f"An earlier run ended before {self.session.name} was saved.",
                answers,
                must=True,
            ),
            take,
        )
