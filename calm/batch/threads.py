"""Jobs done in threads, which are outlived, whatever stops them."""

import os
from collections.abc import Callable, Iterable
from threading import Event, Lock, Thread


class Stopped(Exception):
    """Work was asked to stop, by an event, and does so where it loses nothing."""


def go_on(stop: Event) -> None:
    """Stop here where that is asked for (Stopped: see above)."""
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
