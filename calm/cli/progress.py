"""Distribution of long computations over the cores of the machine, and display of their
progress.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Sized
from functools import partial
from time import monotonic
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from calm.cli.outputs import narrate
from calm.quantities import duration, show_in, shown_units

if TYPE_CHECKING:
    from calm.batch.blocks import Progress

_Task = TypeVar("_Task")
_Done = TypeVar("_Done")
_Given = ParamSpec("_Given")

BAR = 24
"""Number of characters of a full bar."""

FEW = 4
"""Number of tasks below which starting other processes takes longer than the tasks."""

_PATIENCE = 1.0  # seconds before the progress of a loop is reported
_REDRAWN = 0.2  # seconds between updates on a terminal
_FIRST_LINE, _NEXT_LINES = 10.0, 60.0  # seconds without a terminal


class ProgressTeller:
    """Progress display in one line of the terminal. Call the object with a `Progress` to update it.

    If `patience` is given, the display appears after `patience` seconds. Otherwise, the display
    appears soon after the first call.
    """

    def __init__(self, patience: float | None = None) -> None:
        self._terminal = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False
        self._started = None if patience is None else monotonic()
        self._due = (self._started or 0.0) + (patience or 0.0)

    def note(self, text: str) -> None:
        """Write a text on a separate line."""
        self.clear()
        narrate(text)

    def __call__(self, progress: Progress) -> None:
        head = f"{bar(progress)} " if self._terminal else ""
        self.tell(lambda seconds: head + state(progress, seconds))

    def tell(self, text: Callable[[float], str]) -> None:
        """Update the display, unless the last update is too recent.

        `text` converts the elapsed time [s] to the text of the display.
        """
        now = monotonic()
        if self._started is None:
            self._started = now
            self._due = now + (0.0 if self._terminal else _FIRST_LINE)
        if now < self._due:
            return
        self._due = now + (_REDRAWN if self._terminal else _NEXT_LINES)
        start, end = ("\r\x1b[K", "") if self._terminal else ("", "\n")
        print(start + text(now - self._started), end=end, file=sys.stderr, flush=True)
        self._drawn = self._terminal

    def clear(self) -> None:
        """Remove the progress line."""
        if self._drawn:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
            self._drawn = False


def bar(progress: Progress) -> str:
    """Draw a progress bar as text."""
    filled = BAR * progress.done // progress.total
    return f"[{'#' * filled}{'.' * (BAR - filled)}]"


def state(progress: Progress, seconds: float) -> str:
    """Describe the progress: finished profiles, rate, remaining time, and failures."""
    from calm.batch.statuses import Ending

    text = f"{grouped(progress.done)} of {grouped(progress.total)} profiles"
    if progress.done and seconds > 0.0:
        rate = progress.done / seconds
        left = (progress.total - progress.done) / rate
        text += f", {grouped(round(rate))} a second, {duration(left)} left"
    for ending, count in progress.endings.items():
        if count and ending is not Ending.SOLVED:
            text += f", {grouped(count)} {ending.value}"
    return text


def grouped(number: int) -> str:
    """Format a number with thousands separated by spaces."""
    return f"{number:,}".replace(",", " ")


def progress(items: Iterable[_Task], what: str, total: int | None = None) -> Iterator[_Task]:
    """Yield the items; on a terminal, show the progress if the items take long.

    Parameters
    ----------
    what : noun for the items, in the plural
    total : number of items, if `items` has no length
    """
    total = total or (len(items) if isinstance(items, Sized) else 0)
    if sys.stderr is None or not sys.stderr.isatty():
        yield from items
        return
    teller = ProgressTeller(_PATIENCE)
    for done, item in enumerate(items):
        teller.tell(lambda _, done=done: f"{done} of {total} {what}")  # type: ignore[misc]
        yield item
    teller.clear()


def mapped(
    function: Callable[[_Task], _Done],
    tasks: Sequence[_Task],
    workers: int | None,
    what: str,
    meanwhile: Callable[[], object] | None = None,
) -> list[_Done]:
    """Apply a function to every task in parallel, and show the progress. Results are in task order.

    Parameters
    ----------
    function : a module-level function, which another process can import
    workers : number of processes; None for one per core
    what : noun for the tasks, in the plural
    meanwhile : function called in this process while other processes work
    """
    workers = min(workers or os.cpu_count() or 1, len(tasks))
    if workers < 2 or len(tasks) <= FEW:
        return [function(task) for task in progress(tasks, what)]
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import active_children

    pool = ProcessPoolExecutor(workers, initializer=_initialise_worker, initargs=(shown_units(),))
    try:
        doing = pool.map(function, tasks)
        if meanwhile is not None:
            meanwhile()
        done = list(progress(doing, what, len(tasks)))
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for child in active_children():
            child.kill()
        raise
    pool.shutdown()
    return done


def begun(
    function: Callable[_Given, _Done], *given: _Given.args, **named: _Given.kwargs
) -> Callable[[], _Done]:
    """Start a computation in another process, and return a function that waits for its result.

    The computation must be a module-level function. On one core, this process computes the result
    when the result is requested.
    """
    if (os.cpu_count() or 1) < 2:
        return partial(function, *given, **named)
    from concurrent.futures import ProcessPoolExecutor

    pool = ProcessPoolExecutor(1, initializer=_initialise_worker, initargs=(shown_units(),))
    made = pool.submit(function, *given, **named)

    def done() -> _Done:
        with pool:
            return made.result()

    return done


def _initialise_worker(shown: Mapping[str, str]) -> None:
    show_in(shown)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
