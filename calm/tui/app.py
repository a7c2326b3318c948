"""The application: it owns the turns of the keys, the workers and the way out; screens own what is
shown."""

import os
import time
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import Any, ClassVar

from rich.console import RenderableType
from textual import events, work
from textual._compositor import CompositorUpdate
from textual.app import App, SystemCommand
from textual.command import CommandPalette
from textual.filter import LineFilter, NoColor
from textual.message_pump import MessagePump
from textual.screen import Screen
from textual.timer import Timer
from textual.widgets import OptionList

from calm.errors import CalmError
from calm.files import Catalogue, editing
from calm.tui import builder, dialogs, key_table, palette, saving, workspace
from calm.tui.painted import Pace, Painted
from calm.tui.screen import DraftScreen
from calm.tui.session import Session
from calm.tui.theme import DARK, LIGHT, PICTURE_DARK, PICTURE_LIGHT, choose_theme, legible

_AUTOSAVED_AFTER = 0.3  # seconds
_LOOKED_AT_DISK = 2.0  # seconds between two looks
_HELD_AT_MOST = 3.0  # seconds that a frame waits for a terminal that answers no more
_MOST_ROUNDS = 50  # what sends itself messages without an end is not waited for
_COLOURLESS = NoColor()


class BuildApp(App[int]):
    """The line builder.

    It handles keys, pastes and the mouse one after the other: what a key opens is there before the
    next one is pressed. Keys that are typed ahead, or come in one parcel over a slow line, would
    otherwise go to what has the focus when they arrive: to the line instead of the field that the
    first of them opens.

    A key is done when everything that it may have set going has come to rest. Each part of the
    screen handles what it is sent in the order of its queue: a call that is sent after the key
    comes back when the key is handled, and a second round finds what the key made the parts send
    each other. Rounds are made until one of them finds no queue with anything left in it.

    Parameters
    ----------
    session : the file that is built
    kept : work that an earlier session has kept and not saved, to be offered
    environ : describes the terminal

    Attributes
    ----------
    not_kept : why unsaved work could not be kept at the end; empty as a rule
    has_keys_waiting : whether a key is not handled yet
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
        self.saving = saving.Saving(self, self.workspace, self.taken_over, self.leave)
        self.builder = builder.BuilderScreen(self.workspace)
        self.not_kept = ""
        self._painted, self._pace = Painted(), Pace()
        self._offered = kept
        self._is_catalogue_read = False
        self._autosaving: Timer | None = None
        self._late: Timer | None = None
        self._is_left = False
        self._lost: str | None = None
        self._waiting: deque[events.Event] = deque()
        self.has_keys_waiting = False
        self._rounds = 0

        for theme in (DARK, LIGHT):
            self.register_theme(theme)
        self.ansi_theme_dark, self.ansi_theme_light = PICTURE_DARK, PICTURE_LIGHT
        self.theme = choose_theme(environ)

    # the turns of the keys

    async def on_event(self, event: events.Event) -> None:
        """Let what a person does wait for what was done before, but for the mouse that moves."""
        is_done = isinstance(event, events.InputEvent | events.Paste)
        if not is_done or event.is_forwarded or isinstance(event, events.MouseMove):
            await super().on_event(event)
            return
        self._waiting.append(event)
        if not self.has_keys_waiting:
            await self._press()

    async def _press(self) -> None:
        """Do what has waited longest."""
        self.has_keys_waiting = bool(self._waiting)
        if self.has_keys_waiting:
            before = self._listeners()
            await super().on_event(self._waiting.popleft())
            self._rounds = 0
            self._go_round(before)

    def _listeners(self) -> list[MessagePump]:
        """All that a key may set going: what has the focus and what is around it, the screen.

        Not the screens below it: each message makes them have all of the screen painted anew. A
        list hands on what is chosen in it, without the focus.
        """
        around = [] if self.focused is None else list(self.focused.ancestors_with_self)
        lists = [each for top in self.screen_stack[-1:] for each in top.query(OptionList)]
        return list(dict.fromkeys([*around, *lists, *self.screen_stack[-1:], self]))

    def _go_round(self, listeners: list[MessagePump]) -> None:
        """Wait for one after the other; one that is gone handles nothing any more."""
        while listeners:
            first, *others = listeners
            if first.call_later(self._go_round, others):
                return
            listeners = others
        self._rounds += 1
        now = self._listeners()
        is_busy = any(each.message_queue_size for each in now)
        if self._rounds < 2 or (is_busy and self._rounds < _MOST_ROUNDS):
            self._go_round(now)
        elif self._waiting:
            self.call_after_refresh(self._press)
        else:
            self.has_keys_waiting = False

    # the terminal

    def get_default_screen(self) -> Screen[Any]:
        """The line as the lowest screen: a screen below it would be painted too."""
        return self.builder

    def on_mount(self) -> None:
        """The first solution and the catalogue follow what is shown."""
        self.app_resume_signal.subscribe(self, lambda _: self.action_repaint())
        self.call_after_refresh(self._begin)
        self.set_interval(_LOOKED_AT_DISK, self.saving.look_at_disk)

    def _begin(self) -> None:
        """Once the line is on the screen: read the catalogue, solve, tell what was found."""
        self._read_catalogue()
        self.judging.ask()
        if self._offered is not None:
            self.saving.offer(self._offered, partial(self.mend, as_judged=True))
        else:
            self.mend()
        is_unsaved = self.session.file.is_open_elsewhere()
        others = self.saving.presence.say(self.session.file.path)
        if is_unsaved or others:
            what = "with work not saved" if is_unsaved else "in another builder"
            who = f" (process {others[0]})" if others else ""
            self.tell(f"{self.session.name} is open elsewhere{who}, {what}", wrong=True)

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """The command for colours; the other commands of textual have keys of their own here."""
        yield SystemCommand("colours", "Choose other colours.", self.action_change_theme)

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Those of textual, and one for legible colours or for none."""
        if self.no_color:
            return [_COLOURLESS]
        theme = self.current_theme
        own = legible(theme.dark, "ansi" in theme.name)
        return [*super().get_line_filters(), own]

    def _display(self, screen: Screen[Any], renderable: RenderableType | None) -> None:
        """Send the terminal what it does not show yet, once it has shown what was sent before."""
        if not isinstance(renderable, CompositorUpdate):
            super()._display(screen, renderable)
        elif self._pace.holds(time.monotonic()):
            if self._late is None:
                self._late = self.set_timer(_HELD_AT_MOST, self.on_cursor_position)
        else:
            super()._display(screen, self._painted.update(renderable))
            driver = self._driver
            if driver is not None and self._running and not (self.is_headless or self.is_web):
                driver.write(self._pace.question(time.monotonic()))

    def on_cursor_position(self) -> None:
        """The terminal shows what was sent: send what has changed since."""
        if self._late is not None:
            self._late.stop()
            self._late = None
        if self._pace.answered() and self.is_running:
            self.screen.refresh()

    def action_repaint(self) -> None:
        """Send the terminal all of the screen."""
        self._painted.forget()
        self.screen.refresh()

    # the screens

    def tell(self, text: str, *, wrong: bool = False) -> None:
        """Say something in the last line of the screen."""
        if self.is_running:  # else the screens are being taken apart
            screen = self.screen if isinstance(self.screen, DraftScreen) else self.builder
            screen.tell(text, wrong=wrong)

    def draft_screens(self) -> list[DraftScreen]:
        """The open ones, the top one last."""
        return [each for each in self.screen_stack if isinstance(each, DraftScreen)]

    def is_settled(self) -> bool:
        """Return whether nothing is being typed any more; a bad value has been reported."""
        return not isinstance(self.screen, DraftScreen) or self.screen.settle()

    def taken_over(self, message: str) -> None:
        """Another text has taken the place of the draft: every screen reads it again."""
        for screen in self.draft_screens():
            screen.replaced()
        self.tell(message)
        self._edited()

    def action_save(self) -> None:
        """Save, and ask for a name where there is none."""
        if self.is_settled():
            self.saving.save()

    def action_save_as(self) -> None:
        """Save under another name."""
        if self.is_settled():
            self.saving.save_as()

    async def action_quit(self) -> None:
        """Leave; unsaved work is asked about."""
        if self.is_settled():
            self.saving.quit()

    def action_command_palette(self) -> None:
        """Find a command by its name."""
        if not isinstance(self.screen, CommandPalette):
            self.push_screen(palette.Commands(id="--command-palette"))

    def action_help(self) -> None:
        """All keys."""
        self.push_screen(dialogs.LongText(key_table.all_keys()))

    # judging

    @property
    def is_idle(self) -> bool:
        """Return whether the line that is shown has been solved, and nothing else is under way."""
        return self.judging.is_idle and self._is_catalogue_read

    def _edited(self) -> None:
        self.call_later(self._after_an_edit)

    def _after_an_edit(self) -> None:
        self._show_views()
        self._tell_lost_environment()
        self.judging.after_an_edit()
        if self._autosaving is None:
            self._autosaving = self.set_timer(_AUTOSAVED_AFTER, self._autosave)

    def _show_views(self, *, is_first: bool = False) -> None:
        if self.is_running:  # else the screens are being taken apart
            for screen in self.draft_screens():
                if screen.is_mounted and screen.is_attached:  # there, and not on the way out
                    screen.show_view()
            self.mend(as_judged=is_first)

    def _tell_lost_environment(self) -> None:
        before, self._lost = self._lost, self.session.standing.lost_environment
        if self._lost not in (None, before):
            message = f"There is no environment {self._lost} now; the line stands in the file's own"
            self.tell(message)

    def mend(self, *, as_judged: bool = False) -> None:
        """Open the text where the draft cannot be read; or, `as_judged`, has mistakes."""
        judged = self.workspace.view if as_judged and self.screen is self.builder else None
        if (judged and judged.problems) or self.session.draft.problems:
            self.call_later(self._open_text)

    async def _open_text(self) -> None:
        from calm.tui.text_screen import TextScreen

        screens = self.draft_screens()
        if isinstance(screens[-1], TextScreen) or self.screen is not screens[-1]:
            return  # it is open, or a question is, after which the view comes again
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

    # what is kept, and the way out

    def keep(self) -> str:
        """Keep what is not saved, at once; why it cannot be kept, empty where it is."""
        try:
            self.session.note_unsaved().keep()
        except (CalmError, OSError) as error:
            return f"Unsaved work could not be kept: {error}"
        return ""

    def _autosave(self) -> None:
        self._autosaving = None
        if not self._is_left:
            self._keep_aside(self.session.note_unsaved())

    @work(thread=True, group="keeping", exit_on_error=False)
    def _keep_aside(self, file: editing.WorkingFile) -> None:
        """A slow disk holds up no key."""
        try:
            file.keep()
        except (CalmError, OSError) as error:
            self.call_later(self.tell, f"Unsaved work cannot be kept: {error}", wrong=True)

    def on_unmount(self) -> None:
        """Keep what is not saved whatever has ended the application, a closed page or a failure."""
        self.saving.presence.say(None)
        self.keep_at_the_end()

    def take_typed(self) -> None:
        """Take a good value that is being typed, nobody being asked any more."""
        if self.is_running and self.screen_stack and isinstance(self.screen, DraftScreen):
            self.screen.settle()

    def keep_at_the_end(self) -> None:
        """Keep what is not saved, unless the person has left; `not_kept` says what prevents it."""
        if not self._is_left:
            self.not_kept = self.keep()

    def leave(self) -> None:
        """Leave; nothing is to be kept."""
        self._is_left, self._ends_at = True, time.monotonic() + 1.0
        if not self.session.changed:
            self.keep()  # which removes a copy that is out of date
        self._exit_answered()

    def _exit_answered(self) -> None:
        """End once the terminal has answered: the shell would take the answer for keys."""
        if self._pace.is_out and self._ends_at > time.monotonic():
            self.set_timer(0.02, self._exit_answered)
        else:
            self.exit(0)
