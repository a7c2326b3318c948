"""How far a batch is, on the standard error: a bar on a terminal, now and then a line elsewhere."""

from __future__ import annotations

import sys
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from calm.batch.work import Progress

BAR = 24
"""Signs from nothing to all."""

_REDRAWN = 0.2  # seconds between two states of the bar
_FIRST_LINE, _NEXT_LINES = 10.0, 60.0  # seconds without a terminal


class Teller:
    """Tells how far a batch is; to be called with its `Progress`."""

    def __init__(self) -> None:
        self._terminal = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False
        self._started: float | None = None
        self._due = 0.0

    def note(self, text: str) -> None:
        """Write a line of its own."""
        self.clear()
        print(text, file=sys.stderr, flush=True)

    def __call__(self, progress: Progress) -> None:
        """Report it, unless something was reported a moment ago."""
        now = monotonic()
        if self._started is None:
            self._started = now
            self._due = now + (0.0 if self._terminal else _FIRST_LINE)
        if now < self._due:
            return
        text = state(progress, now - self._started)
        if self._terminal:
            print(f"\r\x1b[K{bar(progress)} {text}", end="", file=sys.stderr, flush=True)
            self._drawn, self._due = True, now + _REDRAWN
        else:
            print(text, file=sys.stderr, flush=True)
            self._due = now + _NEXT_LINES

    def clear(self) -> None:
        """Take the bar away."""
        if self._drawn:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self._drawn = False


def bar(progress: Progress) -> str:
    """As much of a bar as is done."""
    filled = BAR * progress.done // progress.total
    return f"[{'#' * filled}{'.' * (BAR - filled)}]"


def state(progress: Progress, seconds: float) -> str:
    """How many are done, the rate, the time that the rest takes at it, and the failures so far."""
    from calm.batch.statuses import Ending

    text = f"{grouped(progress.done)} of {grouped(progress.total)} profiles"
    solved = progress.done - progress.found
    if solved and seconds > 0.0:
        rate = solved / seconds
        left = (progress.total - progress.done) / rate
        text += f", {grouped(round(rate))} a second, {duration(left)} left"
    for ending, count in progress.endings.items():
        if count and ending is not Ending.SOLVED:
            text += f", {grouped(count)} {ending.value}"
    return text


def grouped(number: int) -> str:
    """A count with its thousands apart."""
    return f"{number:,}".replace(",", " ")


def duration(seconds: float) -> str:
    """A time in the unit that fits."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"
