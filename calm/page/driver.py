"""Textual's driver for a terminal in a page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from textual import events
from textual._xterm_parser import XTermParser
from textual.app import App
from textual.driver import Driver
from textual.geometry import Size
from textual.message import Message

_BEGIN = "\x1b[?1049h\x1b[?25l\x1b[?1000h\x1b[?1003h\x1b[?1006h\x1b[?2004h"
"""Alternate screen, hidden cursor, all mouse movements, bracketed paste."""
_END = "\x1b[?2004l\x1b[?1006l\x1b[?1003l\x1b[?1000l\x1b[?25h\x1b[?1049l"
_ESCAPE = "\x1b"


@dataclass
class PageTerminal:
    """The terminal of the page.

    Attributes
    ----------
    write : writes a text to the terminal
    columns, rows : size of the terminal
    driver : driver of the running application
    """

    write: Callable[[str], object]
    columns: int = 80
    rows: int = 24
    driver: PageDriver | None = None

    def type(self, text: str) -> None:
        """Receive the input of keyboard and mouse."""
        if self.driver is not None:
            self.driver.feed(text)

    def resize(self, columns: int, rows: int) -> None:
        """Set the size."""
        self.columns, self.rows = columns, rows
        if self.driver is not None:
            self.driver.show_size()


terminal: PageTerminal | None = None
"""The terminal of this page, set before an application starts."""


class PageDriver(Driver):
    """Textual driver for `terminal`."""

    def __init__(self, app: App[Any], **options: Any) -> None:
        super().__init__(app, **options)
        assert terminal is not None, "no terminal is connected"
        self._terminal, self._parser = terminal, XTermParser(False)
        terminal.driver = self

    @property
    def is_web(self) -> bool:
        """True, so that Textual does not wait for replies of a terminal."""
        return True

    def write(self, data: str) -> None:
        self._terminal.write(data)

    def start_application_mode(self) -> None:
        self.write(_BEGIN)
        self.show_size()

    def stop_application_mode(self) -> None:
        self.write(_END)
        if self._terminal.driver is self:
            self._terminal.driver = None

    def disable_input(self) -> None:
        """Do nothing: the page sends the input."""

    def show_size(self) -> None:
        """Send the size of the terminal to the application."""
        size = Size(self._terminal.columns, self._terminal.rows)
        self.send_message(events.Resize(size, size))

    def feed(self, text: str) -> None:
        """Convert the input of keyboard and mouse to Textual's events."""
        if text == _ESCAPE:  # not the beginning of a sequence, since the page sends whole ones
            self.process_message(events.Key("escape", text))
            return
        for event in self._parser.feed(text):
            self.process_message(event)

    def send_message(self, message: Message) -> None:
        """Post a message to the application; a page has only one thread."""
        self._app.post_message(message)
