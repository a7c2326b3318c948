"""Driver that connects Textual to a terminal in a web page."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from textual import events
from textual.app import App
from textual.driver import Driver
from textual.geometry import Size
from textual.keys import KEY_NAME_REPLACEMENTS
from textual.message import Message

_BEGIN = "\x1b[?1049h\x1b[?25l"
"""Control sequence that shows the alternate screen and hides the cursor.

No sequence turns on mouse or paste input, because such input arrives as messages of the page.
"""
_END = "\x1b[?25h\x1b[?1049l"
_CONTROL_KEYS = {"\r": "enter", "\n": "enter", "\t": "tab", "\x7f": "backspace"}
"""Keys that an on-screen keyboard sends as text."""
_MOUSE_EVENTS: Mapping[str, type[events.MouseEvent]] = {
    "down": events.MouseDown,
    "up": events.MouseUp,
    "move": events.MouseMove,
    "scroll up": events.MouseScrollUp,
    "scroll down": events.MouseScrollDown,
}


@dataclass
class PageTerminal:
    """The terminal of the page.

    Attributes
    ----------
    write : function that writes a text to the terminal
    columns, rows : size of the terminal
    driver : driver of the running application
    """

    write: Callable[[str], object]
    columns: int = 80
    rows: int = 24
    driver: PageDriver | None = None

    def resize(self, columns: int, rows: int) -> None:
        """Set the size of the terminal."""
        self.columns, self.rows = columns, rows
        if self.driver is not None:
            self.driver.show_size()


terminal: PageTerminal | None = None
"""The terminal of this page, set before an application starts."""


class PageDriver(Driver):
    """Textual driver that writes to `terminal` and receives its input from the page."""

    def __init__(self, app: App[Any], **options: Any) -> None:
        super().__init__(app, **options)
        assert terminal is not None, "no terminal is connected"
        self._terminal, self._application = terminal, app
        self._mouse_at = 0, 0
        terminal.driver = self

    @property
    def is_web(self) -> bool:
        return True  # otherwise Textual waits for replies from a terminal

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
        """Do nothing, because the page sends the input."""

    def show_size(self) -> None:
        """Send the size of the terminal to the application."""
        size = Size(self._terminal.columns, self._terminal.rows)
        self.send_message(events.Resize(size, size))

    def press(self, key: str) -> None:
        """Send a key such as "ctrl+s", in Textual's notation."""
        self.process_message(events.Key(key, None))

    def type(self, text: str) -> None:
        """Send typed text, character by character."""
        for character in text:
            if (name := _key_name(character)) is not None:
                self.process_message(events.Key(name, character))

    def paste(self, text: str) -> None:
        """Send pasted text."""
        self.process_message(events.Paste(text))

    def move_mouse(self, kind: str, x: int, y: int, button: int, held: Mapping[str, bool]) -> None:
        """Send a mouse event to the application.

        `kind` is `down`, `up`, `move`, `scroll up` or `scroll down`. Column `x` and row `y` count
        from 0, buttons from 1 (0 for none). `held` tells whether `shift`, `alt` and `ctrl` are
        pressed.
        """
        change = x - self._mouse_at[0], y - self._mouse_at[1]
        keys = held["shift"], held["alt"], held["ctrl"]
        self._mouse_at = x, y
        self.process_message(_MOUSE_EVENTS[kind](None, x, y, *change, button, *keys, x, y))

    def send_message(self, message: Message) -> None:
        self._application.post_message(message)  # directly: a page has only one thread


def _key_name(character: str) -> str | None:
    if character.isalnum():
        return character
    if not character.isprintable():
        return _CONTROL_KEYS.get(character)
    name = unicodedata.name(character, character).lower().replace("-", "_").replace(" ", "_")
    return KEY_NAME_REPLACEMENTS.get(name, name)
