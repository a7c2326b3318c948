"""The Textual application of the line builder.

The application handles key presses in order, starts workers, and saves backup copies.
"""

import os
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import Any, ClassVar

from textual import events, work
from textual.app import App, SystemCommand
from textual.command import CommandPalette
from textual.driver import Driver
from textual.filter import LineFilter, NoColor
from textual.message_pump import MessagePump
from textual.screen import Screen
from textual.timer import Timer
from textual.widgets import OptionList

from calm.errors import CalmError
from calm.files import Catalogue, editing
from calm.tui import builder, dialogs, key_table, palette, saving, workspace
from calm.tui.painted import TerminalOutput
from calm.tui.screen import DraftScreen
from calm.tui.session import Session
from calm.tui.theme import DARK, LIGHT, PICTURE_DARK, PICTURE_LIGHT, choose_theme, legible

_AUTOSAVE_DELAY = 0.3  # seconds
_DISK_INTERVAL = 2.0  # seconds between two checks of the file
_MAX_WAITS = 50  # limit for a widget that keeps sending messages to itself
_COLOURLESS = NoColor()


class BuildApp(App[int]):
    """The line builder.

    Keys, pastes and mouse presses are handled one after the other, even if typed ahead. A screen
    opened by a key is thus open before the next key is handled. Before each key, the application
    waits until the widgets and screens concerned have handled all their messages.

    Parameters
    ----------
    kept : unsaved work of an earlier session, which the user may recover at the start
    environ : environment variables that describe the terminal

    Attributes
    ----------
    not_kept : reason why unsaved work could not be backed up on exit; empty without a failure
    """

    TITLE = "calm build"
    COMMANDS: ClassVar[set[Any]] = {*App.COMMANDS, palette.Actions}
    CSS = """
    * { scrollbar-size: 1 1; }
    Input > .input--placeholder { text-style: italic dim; }
    Input:nocolor > .input--cursor, Input:nocolor > .input--selection,
    TextArea:nocolor .text-area--cursor, TextArea:nocolor .text-area--selection {
        text-style: reverse;
    }
    """

    def __init__(
        self,
        session: Session,
        *,
        kept: editing.KeptWork | None = None,
        environ: Mapping[str, str] = os.environ,
    ) -> None:
        super().__init__()
        self.session = session
        self.workspace = workspace.Workspace(session, self.tell, self._edited)
        self.judging = workspace.Judging(self, self.workspace, self._show_views)
        self.saving = saving.Saving(self, self.workspace, self.show_replaced_draft, self.leave)
        self.builder = builder.BuilderScreen(self.workspace)
        self.not_kept = ""
        self._offered = kept
        self._is_catalogue_read = False
        self._autosaving: Timer | None = None
        self._is_left = False
        self._lost: str | None = None
        self._waiting: deque[events.Event] = deque()
        self.has_keys_waiting = False
        self._waits = 0

        for theme in (DARK, LIGHT):
            self.register_theme(theme)
        self.ansi_theme_dark, self.ansi_theme_light = PICTURE_DARK, PICTURE_LIGHT
        self.theme = choose_theme(environ)

    # the order of keys

    async def on_event(self, event: events.Event) -> None:
        is_done = isinstance(event, events.InputEvent | events.Paste)
        if not is_done or event.is_forwarded or isinstance(event, events.MouseMove):
            await super().on_event(event)
            return
        self._waiting.append(event)
        if not self.has_keys_waiting:
            await self._press()

    async def _press(self) -> None:
        self.has_keys_waiting = bool(self._waiting)
        if self.has_keys_waiting:
            before = self._listeners()
            await super().on_event(self._waiting.popleft())
            self._waits = 0
            self._wait_for_listeners(before)

    def _listeners(self) -> list[MessagePump]:
        """Return the widgets and screens that a key press may affect."""
        around = [] if self.focused is None else list(self.focused.ancestors_with_self)
        # the top screen only: a message to a screen below would repaint the whole terminal;
        # lists post their selection without having the focus
        lists = [each for top in self.screen_stack[-1:] for each in top.query(OptionList)]
        return list(dict.fromkeys([*around, *lists, *self.screen_stack[-1:], self]))

    def _wait_for_listeners(self, listeners: list[MessagePump]) -> None:
        # A queue is handled in order, so the posted call runs after the key. A second round waits
        # for messages that widgets sent to each other.
        while listeners:
            first, *others = listeners
            if first.call_later(self._wait_for_listeners, others):  # false for a removed widget
                return
            listeners = others
        self._waits += 1
        now = self._listeners()
        is_busy = any(each.message_queue_size for each in now)
        if self._waits < 2 or (is_busy and self._waits < _MAX_WAITS):
            self._wait_for_listeners(now)
        elif self._waiting:
            self.call_after_refresh(self._press)
        else:
            self.has_keys_waiting = False

    # the terminal

    def get_default_screen(self) -> Screen[Any]:
        # as the bottom screen of the stack: Textual would also paint a screen below the builder
        return self.builder

    def on_mount(self) -> None:
        self.app_resume_signal.subscribe(self, lambda _: self.action_repaint())
        self.call_after_refresh(self._begin)  # once the line is on the screen
        self.set_interval(_DISK_INTERVAL, self.saving.check_external_change)

    def _begin(self) -> None:
        self._read_catalogue()
        self.judging.ask()
        if self._offered is not None:
            self.saving.offer(self._offered, partial(self.open_text_if_invalid, as_judged=True))
        else:
            self.open_text_if_invalid()
        is_unsaved = self.session.file.is_open_elsewhere()
        others = self.saving.presence.announce(self.session.file.path)
        if is_unsaved or others:
            what = "with unsaved work" if is_unsaved else "in another builder"
            who = f" (process {others[0]})" if others else ""
            self.tell(f"{self.session.name} is open elsewhere{who}, {what}", wrong=True)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        # the other commands of Textual have keys in the builder
        yield SystemCommand("colours", "Choose other colours.", self.action_change_theme)

    def get_line_filters(self) -> Sequence[LineFilter]:
        if self.no_color:
            return [_COLOURLESS]
        theme = self.current_theme
        own = legible(theme.dark, "ansi" in theme.name)
        return [*super().get_line_filters(), own]

    def get_driver_class(self) -> type[Driver]:
        return self.output.driver_class(super().get_driver_class())

    @cached_property
    def output(self) -> TerminalOutput:
        """Output of the terminal driver. Only changed cells are sent to the terminal."""
        return TerminalOutput()

    def on_cursor_position(self) -> None:
        self.output.answered()  # the terminal reports its cursor once the last frame is displayed

    def on_resize(self) -> None:
        self.output.clear()  # the terminal may have moved the displayed text

    def action_repaint(self) -> None:
        self.output.forget()
        self.screen.refresh()

    # the screens

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Show a message in the last line of the screen; `wrong` marks an error."""
        if self.is_running:  # at the end, the screens are being removed
            screen = self.screen if isinstance(self.screen, DraftScreen) else self.builder
            screen.tell(text, wrong=wrong)

    def draft_screens(self) -> list[DraftScreen]:
        """Return the open draft screens, the top screen last."""
        return [each for each in self.screen_stack if isinstance(each, DraftScreen)]

    def is_settled(self) -> bool:
        """Accept the value being typed; return False, with a message, if the value is invalid."""
        return not isinstance(self.screen, DraftScreen) or self.screen.settle()

    def show_replaced_draft(self, message: str) -> None:
        """Update all screens after another text has replaced the draft."""
        for screen in self.draft_screens():
            screen.replaced()
        self.tell(message)
        self._edited()

    def action_save(self) -> None:
        if self.is_settled():
            self.saving.save()

    def action_save_as(self) -> None:
        if self.is_settled():
            self.saving.save_as()

    async def action_quit(self) -> None:
        if self.is_settled():
            self.saving.quit()

    def action_command_palette(self) -> None:
        if not isinstance(self.screen, CommandPalette):
            self.push_screen(palette.Commands(id="--command-palette"))

    def action_help(self) -> None:
        self.push_screen(dialogs.LongText(key_table.all_keys()))

    # judging

    @property
    def is_idle(self) -> bool:
        """Whether the draft has been solved and checked, and the catalogue has been read."""
        return self.judging.is_idle and self._is_catalogue_read

    def _edited(self) -> None:
        self.call_later(self._after_an_edit)

    def _after_an_edit(self) -> None:
        self._show_views()
        self._tell_lost_environment()
        self.judging.after_an_edit()
        if self._autosaving is None:
            self._autosaving = self.set_timer(_AUTOSAVE_DELAY, self._autosave)

    def _show_views(self, *, is_first: bool = False) -> None:
        if self.is_running:  # at the end, the screens are being removed
            for screen in self.draft_screens():
                if screen.is_mounted and screen.is_attached:  # mounted, and not being removed
                    screen.show_view()
            self.open_text_if_invalid(as_judged=is_first)

    def _tell_lost_environment(self) -> None:
        before, self._lost = self._lost, self.session.choice.lost_environment
        if self._lost not in (None, before):
            message = f"Environment {self._lost} no longer exists; the default environment is used"
            self.tell(message)

    def open_text_if_invalid(self, *, as_judged: bool = False) -> None:
        """Open the text editor if the draft cannot be parsed.

        With `as_judged`, the editor also opens if the last check found mistakes in the text.
        """
        judged = self.workspace.view if as_judged and self.screen is self.builder else None
        if (judged and judged.problems) or self.session.draft.problems:
            self.call_later(self._open_text)

    async def _open_text(self) -> None:
        from calm.tui.text_screen import TextScreen

        screens = self.draft_screens()
        if isinstance(screens[-1], TextScreen) or self.screen is not screens[-1]:
            return  # the text is open, or a question, after which the view is shown again
        while self.screen is not self.builder:
            await self.pop_screen()
        self.builder.action_text()

    # the catalogue

    @work(thread=True, exit_on_error=False)
    def _read_catalogue(self) -> None:
        try:
            self.call_later(self._take_catalogue, Catalogue.load(self.session.catalogs))
        except CalmError as error:
            self.call_later(self._take_catalogue, None, str(error))

    def _take_catalogue(self, catalogue: Catalogue | None, reason: str = "") -> None:
        self._is_catalogue_read = True
        if catalogue is None:
            self.tell(reason, wrong=True)
        elif self.is_running:
            self.workspace.take_catalogue(catalogue)
            self.builder.show_catalogue()

    # unsaved work, and the exit

    def keep(self) -> str:
        """Save a backup copy of unsaved work. Return the reason for a failure, otherwise ""."""
        try:
            self.session.note_unsaved().keep()
        except (CalmError, OSError) as error:
            return f"Unsaved work could not be stored: {error}"
        return ""

    def _autosave(self) -> None:
        self._autosaving = None
        if not self._is_left:
            self._back_up(self.session.note_unsaved())

    # in a thread, so that a slow disk does not block keys
    @work(thread=True, group="keeping", exit_on_error=False)
    def _back_up(self, file: editing.WorkingFile) -> None:
        try:
            file.keep()
        except (CalmError, OSError) as error:
            self.call_later(self.tell, f"Unsaved work cannot be stored: {error}", wrong=True)

    def on_unmount(self) -> None:
        # Textual also unmounts after a failure, and when the page is closed
        self.saving.presence.announce(None)
        self.save_copy_on_exit()

    def take_typed(self) -> None:
        """Accept the value that is being typed, if it is valid."""
        if self.is_running and self.screen_stack and isinstance(self.screen, DraftScreen):
            self.screen.settle()

    def save_copy_on_exit(self) -> None:
        """Save a backup copy, unless the user has quit.

        If this fails, `not_kept` gives the reason.
        """
        if not self._is_left:
            self.not_kept = self.keep()

    def leave(self) -> None:
        """End the application and discard unsaved changes without a backup copy."""
        self._is_left, self._ends_at = True, time.monotonic() + 1.0
        if not self.session.changed:
            self.keep()  # removes an outdated copy
        self._exit_once_answered()

    def _exit_once_answered(self) -> None:
        # the shell would read a late answer of the terminal as keys
        if self.output.is_out and self._ends_at > time.monotonic():
            self.set_timer(0.02, self._exit_once_answered)
        else:
            self.exit(0)
