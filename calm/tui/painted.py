"""Records the displayed cells, so that only changed cells are sent to the terminal.

Textual sends a whole region again if one of its cells may have changed, and the whole screen after
a change of size: 38 kB for a screen of 140 columns and 45 rows.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import chain

from rich.cells import cell_len
from rich.color import ColorSystem
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual._compositor import ChopsUpdate, CompositorUpdate, LayoutUpdate

Cell = tuple[str, Style | None]
"""A character and its style; the second cell of a wide character is empty."""

_UNKNOWN: Cell = ("\0", None)
_PLAIN = "\x1b[0m"
_WHERE = "\x1b[6n"  # request of the cursor position (ECMA-48)
_PATIENCE = 3.0  # seconds after which an answer is given up
_GAP = 8
"""Minimum length of a run of unchanged cells that is skipped; sending a shorter run costs less."""


class Painted:
    """Cells that the terminal displays."""

    def __init__(self) -> None:
        self._rows: list[list[Cell]] = []

    def forget(self) -> None:
        """Forget all cells after another program has written to the terminal."""
        self._rows = []

    def update(self, update: CompositorUpdate) -> CompositorUpdate:
        """Wrap a compositor update so that only changed cells are written."""
        return _Changes(self, update)

    def put(self, y: int, x: int, cells: list[Cell], pen: _Pen) -> str:
        """Return the output that displays cells in row y from column x."""
        self._rows += ([] for _ in range(y + 1 - len(self._rows)))
        row = self._rows[y]
        row += [_UNKNOWN] * (x + len(cells) - len(row))
        sent = [
            f"\x1b[{y + 1};{x + begin + 1}H{pen.written(cells[begin:end])}"
            for begin, end in _changed(row[x : x + len(cells)], cells)
        ]
        row[x : x + len(cells)] = cells
        return "".join(sent)

    def fit(self, width: int, height: int) -> None:
        """Forget all cells if the size of the terminal has changed."""
        if len(self._rows) != height or any(len(row) != width for row in self._rows):
            self._rows = [[_UNKNOWN] * width for _ in range(height)]


class Pace:
    """Flow control: each frame waits until the terminal has displayed the previous frame.

    After each frame, the cursor position is requested; the answer shows that the frame has been
    displayed. Over a slow connection, frames merge in this way. A terminal that has never answered
    is not waited for.
    """

    def __init__(self) -> None:
        self._has_asked = self._answers = self._has_waiting = False
        self._since: float | None = None

    def holds(self, now: float) -> bool:
        """Return whether a frame must wait; the next frame sent then contains all changes."""
        is_out = self._since is not None and now - self._since < _PATIENCE
        self._has_waiting = self._answers and is_out
        return self._has_waiting

    def question(self, now: float) -> str:
        """Return the status request to send after a frame, or ""."""
        if self._has_asked and not self._answers:
            return ""
        self._has_asked, self._since = True, now
        return _WHERE

    def answered(self) -> bool:
        """Register the answer to a status request; return whether a frame is waiting."""
        self._answers, self._since = True, None
        return self._has_waiting

    @property
    def is_out(self) -> bool:
        """Whether the answer to a status request is pending. The shell would read this answer as
        keys.
        """
        return self._answers and self._since is not None


class _Changes(CompositorUpdate):
    """Update that writes only changed cells."""

    def __init__(self, painted: Painted, update: CompositorUpdate) -> None:
        self._painted, self._update = painted, update

    def render_segments(self, console: Console) -> str:
        """Return the output for the changed cells, and record them as displayed."""
        painted, update, pen = self._painted, self._update, _Pen(console)
        if not isinstance(update, LayoutUpdate | ChopsUpdate):
            painted.forget()
            return update.render_segments(console)
        if isinstance(update, LayoutUpdate):
            painted.fit(update.region.width, update.region.height)
        sent = "".join(painted.put(y, x, cells, pen) for y, x, cells in _parts(update))
        return sent + pen.put_down()


def _parts(update: LayoutUpdate | ChopsUpdate) -> Iterator[tuple[int, int, list[Cell]]]:
    """Yield (row, column, cells) for an update of the whole screen or of spans."""
    if isinstance(update, LayoutUpdate):
        for y, line in enumerate(update.strips, update.region.y):
            yield y, update.region.x, [*_cells(chain.from_iterable(line))]
        return
    for y, begin, end in update.spans:
        for x, strip in update.chops[y].items():
            if strip is not None and x < end and x + strip.cell_length > begin:
                first = max(begin - x, 0)
                yield y, x + first, [*_cells(strip)][first : end - x]


def _cells(segments: Iterable[Segment]) -> Iterator[Cell]:
    for text, style, _ in segments:
        ground = _ground(style)
        if text.isascii():
            yield from ((sign, ground if sign == " " else style) for sign in text)
            continue
        for sign in text:
            width = cell_len(sign)
            if width:
                yield sign, ground if sign == " " else style
            if width == 2:
                yield "", style


@lru_cache(1024)
def _ground(style: Style | None) -> Style | None:
    """Return the visible part of a style on blank cells."""
    if style is None or style.underline or style.overline or style.strike or style.reverse:
        return style
    return Style(bgcolor=style.bgcolor)


def _changed(shown: list[Cell], wanted: list[Cell]) -> Iterator[tuple[int, int]]:
    """Yield start and end of each run of changed cells; runs with small gaps are merged.

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
    """Writer of cells that sends a style only if the visible style changes."""

    def __init__(self, console: Console) -> None:
        self._system = console._color_system
        self._held = ""
        self._ground: Style | None = None

    def written(self, cells: list[Cell]) -> str:
        """Return the output for adjacent cells."""
        parts = []
        for sign, style in cells:
            if sign == " " and self._held and style is not None and style == self._ground:
                parts.append(sign)
                continue
            wanted = _style_codes(style, self._system)
            if wanted != self._held:
                parts.append(f"\x1b[0;{wanted}m" if wanted else _PLAIN)
                self._held = wanted
            self._ground = _ground(style)
            parts.append(sign)
        return "".join(parts)

    def put_down(self) -> str:
        """Return the output that resets the style."""
        held, self._held = self._held, ""
        return _PLAIN if held else ""


@lru_cache(4096)
def _style_codes(style: Style | None, system: ColorSystem | None) -> str:
    """Return the numbers of the terminal escape sequence for a style."""
    if style is None or system is None:
        return ""
    return style._make_ansi_codes(system)
