"""Terminal driver that sends only changed cells, at the pace of the terminal.

Textual itself sends whole regions, or after a change of size the whole screen (38 kB for 140 by 45
cells).
"""

from __future__ import annotations

import asyncio
import re
import time
from collections.abc import Callable, Iterator
from functools import lru_cache
from threading import RLock
from typing import ClassVar

from rich.cells import cell_len
from textual.driver import Driver

Cell = tuple[str, str]
"""A character and the SGR codes of its style (ECMA-48).

A wide character is followed by a cell without a character.
"""

_TOKEN = re.compile(
    r"\x1b\[(?P<row>\d+);(?P<column>\d+)H"
    r"|\x1b\[(?P<style>[\d;]*)m"
    r"|\x1b\[\?2026(?P<frame>[hl])"
    r"|(?P<text>[^\x00-\x1f\x7f]+)"
    r"|(?P<other>\x1b\[[\x20-\x3f]*[\x40-\x7e]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)|\x1b[^\[\]]|.)",
    re.DOTALL,
)
"""Pattern of a position, style, frame mark, text, or any other sequence or control character."""
_INCOMPLETE = re.compile(r"\x1b(\[[\x20-\x3f]*|\][^\x07\x1b]*\x1b?)?$")
"""Pattern of an incomplete sequence at the end of a text.

On Windows, Textual writes 8192 characters at a time, and so cuts sequences.
"""
_NEW_SCREENS = re.compile(r"\x1b\[(\?1049[hl]|[23]J)")

_UNKNOWN: Cell = ("\0", "")
_BLANK: Cell = (" ", "")
_PLAIN = "\x1b[0m"
_WHERE = "\x1b[6n"  # request of the cursor position (ECMA-48)
_PATIENCE = 3.0  # seconds to wait for an answer
_GAP = 8
"""Maximum gap between changed cells that are sent together [cells].

The unchanged cells in a longer gap are not sent again.
"""


class Painted:
    """Cells that the terminal displays now, and cells that it should display."""

    def __init__(self) -> None:
        self._shown: list[list[Cell]] = []
        self._wanted: list[list[Cell]] = []
        self._touched: set[int] = set()
        self._at: tuple[int, int] | None = None
        self._cursor: tuple[int, int] | None = None
        self._style = self._rest = ""
        self._marks_frames = False

    def clear(self) -> None:
        """Forget all cells."""
        self._shown, self._wanted, self._at = [], [], None
        self._touched.clear()

    def forget(self) -> None:
        """Treat all displayed cells as unknown.

        This is necessary after another program has written to the terminal.
        """
        self._shown = [[_UNKNOWN] * len(row) for row in self._shown]
        self._touched.update(range(len(self._wanted)))

    def take(self, text: str) -> str:
        """Store the cells of an output text, and return the rest of the output.

        The rest does not consist of cells, and must be sent at once.
        """
        text = self._rest + text
        cut = _INCOMPLETE.search(text)
        self._rest = text[cut.start() :] if cut else ""
        at_once = []
        for token in _TOKEN.finditer(text, 0, cut.start() if cut else len(text)):
            kind = token.lastgroup
            if kind == "column":
                self._at = int(token["row"]) - 1, int(token["column"]) - 1
            elif kind == "style":
                self._take_style(token["style"])
            elif kind == "text" and self._at is not None:
                self._put(*self._at, token["text"])
            elif kind == "frame":
                self._marks_frames = True
            elif token[0] == "\n":
                self._at = None  # Textual moves the cursor next
            else:
                at_once.append(token[0])
                if kind == "text" or _NEW_SCREENS.match(token[0]):
                    self.clear()
        return "".join(at_once)

    def _take_style(self, codes: str) -> None:
        if codes in ("", "0"):
            self._style = ""
        else:
            self._style = f"{self._style};{codes}" if self._style else codes

    def _put(self, y: int, x: int, text: str) -> None:
        cells = _cells(text, self._style)
        rows = self._wanted
        rows += ([] for _ in range(y + 1 - len(rows)))
        row = rows[y]
        row += [_BLANK] * (x + len(cells) - len(row))
        row[x : x + len(cells)] = cells
        self._touched.add(y)
        self._at = y, x + len(cells)

    def changes(self) -> str:
        """Return the output that updates the terminal, and treat the new cells as displayed."""
        pen, sent, shown = _Pen(), [], self._shown
        shown += ([] for _ in range(len(self._wanted) - len(shown)))
        for y in sorted(self._touched):
            wanted, row = self._wanted[y], shown[y]
            row += [_UNKNOWN] * (len(wanted) - len(row))
            sent += [
                f"\x1b[{y + 1};{begin + 1}H{pen.written(wanted[begin:end])}"
                for begin, end in _changed(row, wanted)
            ]
            shown[y] = wanted.copy()
        self._touched.clear()
        sent.append(pen.put_down())
        if self._at is not None and (any(sent) or self._at != self._cursor):
            self._cursor = self._at
            sent.append(f"\x1b[{self._at[0] + 1};{self._at[1] + 1}H")
        text = "".join(sent)
        return f"\x1b[?2026h{text}\x1b[?2026l" if text and self._marks_frames else text


class Pace:
    """Flow control that delays each frame until the terminal has displayed the previous frame.

    The terminal answers a request at the end of each frame. Frames do not wait for a terminal that
    has never answered.
    """

    def __init__(self) -> None:
        self._has_asked = self._answers = False
        self._since: float | None = None

    def holds(self, now: float) -> bool:
        """Return whether a frame must wait, because the terminal has not answered yet."""
        return self._answers and self._since is not None and now - self._since < _PATIENCE

    def question(self, now: float) -> str:
        """Return the request to send after a frame; "" if the terminal does not answer."""
        if self._has_asked and not self._answers:
            return ""
        self._has_asked, self._since = True, now
        return _WHERE

    def answered(self) -> None:
        """Note that the terminal has answered the request."""
        self._answers, self._since = True, None

    @property
    def is_out(self) -> bool:
        """Whether the answer to a request is pending.

        If the builder ended now, the shell would read the answer as keys.
        """
        return self._answers and self._since is not None


class TerminalOutput:
    """Output of an application to its terminal, as frames of changed cells."""

    def __init__(self) -> None:
        self._painted, self._pace = Painted(), Pace()
        self._send: Callable[[str], None] | None = None
        self._late: asyncio.TimerHandle | None = None
        self._lock = RLock()  # the thread that reads the keyboard also switches modes

    def driver_class(self, terminal: type[Driver]) -> type[Driver]:
        """Return a subclass of the driver class `terminal` that writes through this output."""
        return type(f"Painting{terminal.__name__}", (_PaintingDriver, terminal), {"output": self})

    def take(self, text: str, send: Callable[[str], None]) -> None:
        """Store the cells of an output text; send other output at once."""
        with self._lock:
            self._send = send
            if at_once := self._painted.take(text):
                send(at_once)

    def send_frame(self) -> None:
        """Send the changed cells, or wait if the terminal has not displayed the previous frame."""
        with self._lock:
            if self._send is None:
                return
            if self._pace.holds(time.monotonic()):
                if self._late is None:
                    loop = asyncio.get_running_loop()
                    self._late = loop.call_later(_PATIENCE, self.answered)
            elif changes := self._painted.changes():
                self._send(changes + self._pace.question(time.monotonic()))

    def answered(self) -> None:
        """Send the next frame after the terminal has displayed the previous frame."""
        with self._lock:
            if self._late is not None:
                self._late.cancel()
                self._late = None
            self._pace.answered()
            self.send_frame()

    def clear(self) -> None:
        """Discard all cells, when the application ends or the terminal has changed its size."""
        with self._lock:
            self._painted.clear()
            if self._late is not None:
                self._late.cancel()
                self._late = None

    def forget(self) -> None:
        """Treat the displayed cells as unknown, so that the next frame contains all cells."""
        with self._lock:
            self._painted.forget()

    @property
    def is_out(self) -> bool:
        """Whether an answer of the terminal is pending."""
        return self._pace.is_out


class _PaintingDriver(Driver):
    """Driver that writes through a `TerminalOutput`; its second base is a driver of Textual."""

    output: ClassVar[TerminalOutput]

    def write(self, data: str) -> None:
        self.output.take(data, super().write)  # type: ignore[safe-super]

    def flush(self) -> None:
        self.output.send_frame()
        super().flush()

    def stop_application_mode(self) -> None:
        self.output.clear()
        super().stop_application_mode()  # type: ignore[safe-super]


def _cells(text: str, style: str) -> list[Cell]:
    ground = _ground(style)
    if text.isascii():
        return [(sign, ground if sign == " " else style) for sign in text]
    cells = []
    for sign in text:
        width = cell_len(sign)
        if width:
            cells.append((sign, ground if sign == " " else style))
        if width == 2:
            cells.append(("", style))
    return cells


_SEEN_ON_BLANKS = {"4", "7", "9", "21", "53"}
"""Codes of underlining, reverse, striking out and overlining."""


@lru_cache(4096)
def _ground(style: str) -> str:
    """Return the part of a style that is visible on blank cells.

    The visible part is the background or, for underlined and similar styles, the whole style.
    """
    kept, codes = [], iter(style.split(";"))
    for code in codes:
        if code in ("38", "48"):
            kind = next(codes, "")
            colour = [kind, *(next(codes, "") for _ in range(3 if kind == "2" else 1))]
            kept += [code, *colour] if code == "48" else []
        elif code in _SEEN_ON_BLANKS:
            return style
        elif re.fullmatch(r"4\d|10\d", code):
            kept.append(code)
    return ";".join(kept)


def _changed(shown: list[Cell], wanted: list[Cell]) -> Iterator[tuple[int, int]]:
    """Yield start and end of each run of changed cells; runs with a small gap are merged.

    A run never begins or ends within a wide character, because half of it cannot be written.
    """
    if shown == wanted:
        return
    begin = end = 0
    for number in range(len(wanted)):
        if shown[number] == wanted[number]:
            continue
        if number - end > _GAP and end > 0:
            yield _around(begin, end, shown, wanted)
        if number - end > _GAP or end == 0:
            begin = number
        end = number + 1
    yield _around(begin, end, shown, wanted)


def _around(begin: int, end: int, shown: list[Cell], wanted: list[Cell]) -> tuple[int, int]:
    while begin > 0 and not (shown[begin][0] and wanted[begin][0]):
        begin -= 1
    while end < len(wanted) and not (shown[end][0] and wanted[end][0]):
        end += 1
    return begin, end


class _Pen:
    """Writer of cells, which sends a style only if the visible style changes."""

    def __init__(self) -> None:
        self._held = ""
        self._ground = ""

    def written(self, cells: list[Cell]) -> str:
        """Return the output for adjacent cells."""
        parts = []
        for sign, style in cells:
            if sign == " " and self._held and style == self._ground:
                parts.append(sign)
                continue
            if style != self._held:
                parts.append(f"\x1b[0;{style}m" if style else _PLAIN)
                self._held = style
            self._ground = _ground(style)
            parts.append(sign)
        return "".join(parts)

    def put_down(self) -> str:
        """Return the output that resets the style at the end."""
        held, self._held = self._held, ""
        return _PLAIN if held else ""
