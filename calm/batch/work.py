"""The blocks of a store that are missing: solved a slice at a time, and kept.

They are solved here, or by the workers of a dask scheduler on this machine or on many. The solver
is made ready before the first, and what is reported meanwhile.
"""

from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from threading import Event, Lock, Thread
from time import monotonic, perf_counter
from typing import Any

import numpy as np
from numba.core import event
from numpy.typing import NDArray

from calm.batch.dataset import ShapeNodes, arrays_of
from calm.batch.profiles import Batch, Profiles
from calm.batch.statuses import STATUSES, Ending, endings
from calm.batch.work_store import Arrays, Store
from calm.case import Design
from calm.errors import UsageError
from calm.physics.compiled import cache_folder
from calm.records.record import Levels, Record
from calm.version import __version__

FIRST, FEWEST = 256, 8
"""Profiles solved before progress is reported or a stop heeded: at first, and at least. `SLICE`
sets how many."""

SLICE = 0.5
"""Seconds that the next slice should take."""


@dataclass(frozen=True)
class Progress:
    """Count how far a batch is, in profiles.

    Attributes
    ----------
    done, total : those solved, and all
    found : those that were there already when it began
    endings : how those done ended
    """

    done: int
    total: int
    found: int
    endings: Mapping[Ending, int]


class BatchWork:
    """Hold what is to be done in a store, which nobody else works on, and what has been done."""

    def __init__(
        self,
        batch: Batch,
        record: Record,
        store: Store,
        shape: ShapeNodes | None,
        progress: Callable[[Progress], None] | None,
        stop: Event,
    ) -> None:
        self.batch, self.record, self.store, self.shape = batch, record, store, shape
        self.progress, self.stop = progress, stop
        self._reading, self._counting = Lock(), Lock()
        self._length = FIRST
        found = ((number, store.statuses(number)) for number in range(store.count))
        self._kept = {number: _counted(status) for number, status in found if status is not None}
        self._solved = sum(self._kept.values(), _NONE)
        self._found = int(self._solved.sum())

    @property
    def missing(self) -> list[int]:
        """Blocks that are not done."""
        return [number for number in range(self.store.count) if number not in self._kept]

    @property
    def counts(self) -> dict[str, int]:
        """Return how many profiles are on the disk, by status."""
        return _named(sum(self._kept.values(), _NONE))

    def here(self, workers: int) -> None:
        """Solve what is missing in threads of this process."""
        self.tell()
        missing = self.missing
        in_threads(self._solve, missing, min(workers, len(missing)), self.stop)

    def on_cluster(self, address: str, tell: Callable[[str], None]) -> None:
        """Solve it on the workers of a dask scheduler; this process reads and writes."""
        self.tell()

        def blocks() -> Iterator[tuple[int, Levels]]:
            for number in self.missing:
                yield number, self._levels(number)

        mooring = self.batch.mooring
        with closing(solved_on(address, mooring, blocks(), tell, self.stop)) as solved:
            for number, profiles in solved:
                self._keep(number, [self._arrays(number, 0, profiles)])

    def forget(self, numbers: list[int]) -> None:
        """Blocks turn out to be missing."""
        for number in numbers:
            self._solved = self._solved - self._kept.pop(number, _NONE)

    def tell(self) -> None:
        """Of how far it is."""
        if self.progress is not None:
            done, ended = int(self._solved.sum()), endings(_named(self._solved))
            self.progress(Progress(done, self.record.count, self._found, ended))

    def count(self, profiles: Profiles) -> None:
        """These are solved."""
        with self._counting:
            self._solved = self._solved + _counted(profiles.status)

    def _solve(self, number: int) -> None:
        depth, u, v, w = self._levels(number)
        parts: list[Arrays] = []
        solved = 0
        while solved < len(u):
            if self.stop.is_set():
                return
            began = monotonic()
            mine = slice(solved, solved + self._length)
            here = depth if depth.ndim == 1 else depth[mine]
            up = None if w is None else w[mine]
            profiles = self.batch.solve(u[mine], v[mine], here, up, workers=1)
            parts.append(self._arrays(number, solved, profiles))
            solved = min(mine.stop, len(u))
            if solved == mine.stop:  # a whole slice, or it says little
                share = SLICE / max(monotonic() - began, 1e-6)
                self._length = max(int(self._length * min(share, 2.0)), FEWEST)
            if solved < len(u):
                with self._counting:
                    self.tell()
        self._keep(number, parts)

    def _levels(self, number: int) -> Levels:
        with self._reading:  # libraries that read files take one thread at a time
            return self.record.profiles(*self.store.span(number))

    def _arrays(self, number: int, first: int, profiles: Profiles) -> Arrays:
        """Profiles of a block from one on, which then count as solved."""
        start = self.store.span(number)[0] + first
        time = self.record.time[start : start + len(profiles.status)]
        self.count(profiles)
        return arrays_of(self.store.layout, time, profiles, self.shape)

    def _keep(self, number: int, parts: list[Arrays]) -> None:
        arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        self.store.write(number, arrays)
        with self._counting:
            self._kept[number] = _counted(arrays["status"])
            self.tell()


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


_NONE = np.zeros(len(STATUSES), np.int64)


def _counted(status: NDArray[np.int8]) -> NDArray[np.int64]:
    return np.bincount(status, minlength=len(STATUSES))


def _named(counts: NDArray[np.int64]) -> dict[str, int]:
    return {STATUSES[i]: int(counts[i]) for i in np.flatnonzero(counts)}


class _Notice(event.Listener):
    """Reports when something is compiled that was not in the cache."""

    def __init__(self, report: Callable[[str], None]) -> None:
        self.report = report
        self.reported = False

    def on_start(self, event: Any) -> None:
        if self.reported:
            return
        self.reported = True
        self.report("compiling the solver for this machine, once only; this takes up to a minute")
        if cache_folder() is None:
            self.report(
                "no writable folder was found to keep it in, so every run compiles again; set "
                "NUMBA_CACHE_DIR to one"
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


AHEAD = 2
"""Blocks that are under way for each thread of the workers."""

PATIENCE = "20s"
"""How long the scheduler may take to answer."""

COMPILING = "calm: compiling"
"""The topic of what workers report meanwhile."""

ASKED_ANEW = 1.0
"""Seconds between two looks at how many workers there are."""


def solved_on(
    address: str,
    mooring: Design,
    blocks: Iterator[tuple[int, Levels]],
    tell: Callable[[str], None],
    stop: Event,
) -> Generator[tuple[int, Profiles]]:
    """The blocks solved, as they are ready; those of a worker that is lost are solved by another.

    Workers may come and go. Where there is none yet, the first is waited for.

    Parameters
    ----------
    address : of the scheduler, such as ``tcp://10.0.0.1:8786``
    blocks : numbers with their profiles; no more are taken than the workers have use for
    tell : called when there is no worker, and when one has to compile the solver
    stop : looked at every `ASKED_ANEW` seconds; once it is set no more are given

    Raises
    ------
    UsageError
        `distributed` is not installed, no scheduler answers, or CALM is missing there.
    ConnectionError
        The scheduler is lost, or a block time and again with its worker.
    """
    try:
        import dask
        from distributed import CancelledError, Client, KilledWorker, wait
    except ImportError:
        raise UsageError(
            "--scheduler needs dask: pip install 'calm-mooring[cluster]', here, for the scheduler "
            "and on the workers"
        ) from None
    # a block goes with its task, so that it can be solved again wherever that is
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1GB"}):
        try:
            client = Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise UsageError(f"no scheduler answers at {address}: {error}") from None
        with client:
            workers = _Workers(client)
            numbers: dict[Any, int] = {}
            client.subscribe_topic(COMPILING, lambda event: tell(event[1]))

            def more() -> set[Any]:
                """Tasks for the workers there are, beside those under way."""
                tasks = set()
                for number, levels in islice(blocks, max(AHEAD * workers.count - len(numbers), 0)):
                    task = client.submit(solve_there, mooring, levels, pure=False, retries=3)
                    numbers[task.key] = number
                    tasks.add(task)
                return tasks

            if not workers.count:
                tell(f"the scheduler at {address} has no worker yet: waiting for the first")
                workers.wait(stop)
            under_way = more()
            while under_way and not stop.is_set():
                try:
                    with client.as_current():  # `wait` asks whose the tasks are
                        done = wait(under_way, ASKED_ANEW, "FIRST_COMPLETED").done
                except TimeoutError:
                    under_way |= more()
                    continue
                except CancelledError as error:
                    raise _lost(error) from None
                under_way -= done
                for task in done:
                    try:
                        profiles = task.result()
                    except (CancelledError, KilledWorker, OSError) as error:
                        raise _lost(error) from None
                    except (ImportError, AttributeError, RuntimeError) as error:
                        # what dask makes of modules that are not there
                        raise UsageError(
                            f"the scheduler or a worker cannot take the work: {error}; "
                            f"calm-mooring {__version__} is needed there too"
                        ) from None
                    number = numbers.pop(task.key)
                    task.release()
                    under_way |= more()  # so that no worker waits for what is done with this one
                    yield number, profiles


def _lost(error: Exception) -> ConnectionError:
    return ConnectionError(f"the scheduler or its workers were lost: {error}")


class _Workers:
    """Describe how many threads the workers of a scheduler have, asked for now and then."""

    def __init__(self, client: Any) -> None:
        self._client = client
        self._known, self._due = 0, 0.0

    @property
    def count(self) -> int:
        now = monotonic()
        if now >= self._due:
            self._known = sum(self._client.nthreads().values()) or min(self._known, 1)
            self._due = now + ASKED_ANEW
        return self._known

    def wait(self, stop: Event) -> None:
        while not self.count and not stop.wait(ASKED_ANEW / 4):
            pass


def solve_there(mooring: Design, levels: Levels) -> Profiles:
    """Solve a block: the work of one worker."""
    depth, u, v, w = levels
    return _ready(mooring).solve(u, v, depth, w, workers=1)


@lru_cache(maxsize=2)
def _ready(mooring: Design) -> Batch:
    """Return the same for every block: the mooring comes anew with each, and is long in making."""
    from distributed import get_worker

    worker, batch = get_worker(), Batch(mooring)
    compile_solver(batch, lambda text: worker.log_event(COMPILING, f"{worker.address}: {text}"))
    return batch
