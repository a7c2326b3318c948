"""Work shared out over the cores of the machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TypeVar

from calm.cli.streams import progress

_Task = TypeVar("_Task")
_Done = TypeVar("_Done")

FEW = 4
"""So many tasks are done before another process has started."""


def mapped(
    function: Callable[[_Task], _Done], tasks: Sequence[_Task], workers: int | None, what: str
) -> list[_Done]:
    """What a function makes of every task, in their order; the user is told how far it is.

    Parameters
    ----------
    function : of a module, so that another process finds it
    workers : how many processes; None for one on each core
    what : the tasks, in the plural
    """
    workers = min(workers or os.cpu_count() or 1, len(tasks))
    if workers < 2 or len(tasks) <= FEW:
        return [function(task) for task in progress(tasks, what)]
    from concurrent.futures import ProcessPoolExecutor

    pool = ProcessPoolExecutor(workers)
    try:
        return list(progress(pool.map(function, tasks), what, len(tasks)))
    finally:
        pool.shutdown(cancel_futures=True)
