"""Jobs done in threads, which are outlived, whatever stops them."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from threading import Event, Lock, Thread
from time import perf_counter
from typing import Any

import numpy as np
from numba.core import event

from calm.batch.profiles import Batch
from calm.physics.compiled import cache_folder


class Stopped(Exception):
    """Work was asked to stop, by an event, and does so where it loses nothing."""


def go_on(stop: Event) -> None:
    """Stop here where that is asked for.

    Raises
    ------
    Stopped
        See above.
    """
    if stop.is_set():
        raise Stopped


def processors() -> int:
    """Return how many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def in_threads(
    job: Callable[[int], None], numbers: Iterable[int], workers: int, stop: Event
) -> None:
    """Do a job for every number, each thread taking the next.

    What a job raises, or Ctrl-C, sets `stop` and is raised once every thread has ended: those under
    way have to look at it. A second Ctrl-C changes nothing. Set from outside, it ends them as well.
    """
    remaining = iter(numbers)
    taking = Lock()
    raised: list[BaseException] = []

    def work() -> None:
        while not stop.is_set():
            with taking:
                number = next(remaining, None)
            if number is None:
                return
            try:
                job(number)
            except BaseException as error:
                raised.append(error)
                stop.set()

    threads = [Thread(target=work, daemon=True) for _ in range(workers)]
    for thread in threads:
        thread.start()
    try:
        for thread in threads:
            thread.join()
    except BaseException:
        stop.set()
        raise
    finally:
        for thread in threads:
            _outlive(thread)
    if raised:
        raise raised[0]


def _outlive(thread: Thread) -> None:
    while thread.is_alive():
        try:
            thread.join()
        except KeyboardInterrupt:
            continue


class _Notice(event.Listener):
    """Reports when something is compiled that was not in the cache."""

    def __init__(self, report: Callable[[str], None]) -> None:
        self.report = report
        self.reported = False

    def on_start(self, event: Any) -> None:
        if self.reported:
            return
        self.reported = True
        self.report("compiling the solver for this machine, once: this takes up to a minute")
        if cache_folder() is None:
            self.report(
                "no folder can be written to keep it in, so every run compiles again; set "
                "NUMBA_CACHE_DIR to one that can"
            )

    def on_end(self, event: Any) -> None:
        pass


def compile_solver(batch: Batch, report: Callable[[str], None]) -> None:
    """Let the solver be compiled, or fetched, and report when it has to be compiled."""
    notice, started = _Notice(report), perf_counter()
    with event.install_listener("numba:compile", notice):
        batch.solve(np.zeros((0, 1)), np.zeros((0, 1)), np.zeros(1), workers=1)
    if notice.reported:
        report(f"compiled in {perf_counter() - started:.0f} s")
