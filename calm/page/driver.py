"""Textual's driver for a terminal in a page: text goes out, keys and sizes come in."""

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
"""Alternate screen, no cursor, mouse with all its movements, pastes in brackets."""
_END = "\x1b[?2004l\x1b[?1006l\x1b[?1003l\x1b[?1000l\x1b[?25h\x1b[?1049l"
_ESCAPE = "\x1b"


@dataclass
class PageTerminal:
    """The terminal of the page.

    Attributes
    ----------
    write : shows a text
    columns, rows : its size
    driver : that of the application that runs
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
        """Take another size."""
        self.columns, self.rows = columns, rows
        if self.driver is not None:
            self.driver.show_size()


terminal: PageTerminal | None = None
"""The terminal of this page, set before an application starts."""


class PageDriver(Driver):
    """The driver of `terminal`."""

    def __init__(self, app: App[Any], **options: Any) -> None:
        super().__init__(app, **options)
        assert terminal is not None, "no terminal is connected"
        self._terminal, self._parser = terminal, XTermParser(False)
        terminal.driver = self

    @property
    def is_web(self) -> bool:
        """A page is no terminal of its own: no answer of a terminal is waited for."""
        return True

    def write(self, data: str) -> None:
        """Show a text."""
        self._terminal.write(data)

    def start_application_mode(self) -> None:
        """Prepare the terminal, and tell the application its size."""
        self.write(_BEGIN)
        self.show_size()

    def stop_application_mode(self) -> None:
        """Leave the terminal as it was."""
        self.write(_END)
        if self._terminal.driver is self:
            self._terminal.driver = None

    def disable_input(self) -> None:
        """Nothing reads: the page sends what comes."""

    def show_size(self) -> None:
        """Tell the application the size of the terminal."""
        size = Size(self._terminal.columns, self._terminal.rows)
        self.send_message(events.Resize(size, size))

    def feed(self, text: str) -> None:
        """Take what keys and mouse send, as the events of Textual."""
        if text == _ESCAPE:  # the page sends whole sequences: it is no beginning of one
            self.process_message(events.Key("escape", text))
            return
        for event in self._parser.feed(text):
            self.process_message(event)

    def send_message(self, message: Message) -> None:
        """Give the application a message; there is but one thread in a page."""
        self._app.post_message(message)
