"""Work shared out over the cores of the machine."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import ParamSpec, TypeVar

from calm.cli.streams import progress
from calm.quantities import show_in, shown_units

_Task = TypeVar("_Task")
_Done = TypeVar("_Done")
_Given = ParamSpec("_Given")

FEW = 4
"""So many tasks are done before another process has started."""


def mapped(
    function: Callable[[_Task], _Done],
    tasks: Sequence[_Task],
    workers: int | None,
    what: str,
    meanwhile: Callable[[], object] | None = None,
) -> list[_Done]:
    """What a function makes of every task, in their order; how far it is is shown.

    Parameters
    ----------
    function : of a module, so that another process finds it
    workers : how many processes; None for one on each core
    what : the tasks, in the plural
    meanwhile : what this process does while others work; nothing where it works itself
    """
    workers = min(workers or os.cpu_count() or 1, len(tasks))
    if workers < 2 or len(tasks) <= FEW:
        return [function(task) for task in progress(tasks, what)]
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import active_children

    pool = ProcessPoolExecutor(workers, initializer=_as_parent, initargs=(shown_units(),))
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
    """Let another process make something while this one goes on; what is returned hands it over.

    On a machine of one core it is made here when it is called for.

    Parameters
    ----------
    function : of a module, so that another process finds it
    """
    if (os.cpu_count() or 1) < 2:
        return partial(function, *given, **named)
    from concurrent.futures import ProcessPoolExecutor

    pool = ProcessPoolExecutor(1, initializer=_as_parent, initargs=(shown_units(),))
    made = pool.submit(function, *given, **named)

    def done() -> _Done:
        with pool:
            return made.result()

    return done


def _as_parent(shown: Mapping[str, str]) -> None:
    """Show the units of the parent, and leave interrupts to it."""
    show_in(shown)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
