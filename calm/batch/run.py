"""Every profile of a record: solved in blocks, kept at once, taken up again where it stopped."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Lock, Thread
from time import monotonic, perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import layout_of
from calm.batch.kernel.compiled import cache_folder
from calm.batch.kernel.plan import plan_of
from calm.batch.profiles import STATUSES, Batch, Profiles
from calm.batch.shape import Shape, shape_of
from calm.batch.store.chunks import packed
from calm.batch.store.identity import identity_of, to_text
from calm.batch.store.result import ENDINGS, finish, is_finished, remove, store_folder
from calm.batch.store.store import Store, open_store
from calm.case import Mooring
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.batch.records.record import Levels, Record

BLOCK, BLOCK_ALONE = 8192, 256
"""Profiles to a block: what is solved, written and, after an interruption, lost at once. The
second where the lanes do not solve the mooring, and each takes a hundred times as long."""


GRACE = 5.0
"""Seconds that blocks under way have to be done once the rest is given up."""


@dataclass(frozen=True)
class Progress:
    """How far a batch is, in profiles; `found` were there already when it began."""

    done: int
    total: int
    found: int
    failed: int


@dataclass(frozen=True)
class Outcome:
    """How a batch ended.

    Attributes
    ----------
    counts : how many profiles ended with each status that occurred, "converged" the first
    done : whether the result is there; if not, running the same again finishes it
    reason : why it is not
    """

    counts: Mapping[str, int]
    done: bool
    reason: str = ""

    @property
    def converged(self) -> int:
        """Profiles with an equilibrium."""
        return self.counts.get(STATUSES[0], 0)

    @property
    def failed(self) -> int:
        """Profiles without."""
        return sum(self.counts.values()) - self.converged


def run_batch(
    mooring: Mooring,
    record: Record,
    output: Path,
    *,
    workers: int | None = None,
    block: int | None = None,
    shape: bool = False,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] | None = None,
    tell: Callable[[str], None] | None = None,
) -> Outcome:
    """Solve a mooring in every profile of a record, and write the result.

    The work is kept in a folder beside the result, ``RESULT.part``. Whatever ends it, even at
    once, the same call later solves what is missing; the result is byte for byte the same.

    Parameters
    ----------
    output : a .nc file or a .zarr folder
    workers : threads; one for each processor that may be used where not given
    block : profiles that are solved and kept at a time, which are the chunks of the result; as
        many as take a moment where not given
    shape : store the shape of the line too
    scheduler : address of a dask scheduler, whose workers then solve the blocks
    progress : called before the first block and after each
    tell : called with what is worth knowing before the first of them

    Raises
    ------
    UsageError
        The output is there already, from another input; another batch is at work on it; there
        is nobody at the address of the scheduler.
    NoEquilibrium
        Where a piece is to be cut to fit, and no length does.
    """
    if output.suffix not in ENDINGS:
        raise UsageError(f"cannot write {output}: the name of a result ends in .nc or .zarr")
    if record.count == 0:
        raise UsageError("the record has no profile in the time that was asked for")
    if block is None:
        block = BLOCK_ALONE if plan_of(mooring) is None else BLOCK
    nodes = shape_of(mooring) if shape else None
    layout = layout_of(mooring, record, nodes)
    identity = to_text(identity_of(mooring, record, {"shape": shape, "block": block}))
    if is_finished(output, identity):
        return Outcome(_counts_of(output), True)
    with open_store(store_folder(output), layout, block, identity) as store:
        work = _Work(nodes.mooring if nodes else mooring, record, store, nodes, progress)
        try:
            if scheduler is not None:
                work.on_cluster(scheduler)
            else:
                work.here(workers or _processors(), tell or (lambda _: None))
            counts = _named(store.statuses())
            finish(store, output)
        except UsageError:
            if not work.done:
                remove(store.folder)
            raise
        except KeyboardInterrupt:
            return Outcome(_named(store.statuses()), False, "interrupted")
        except OSError as error:
            reason = error.strerror or str(error)
            return Outcome(_named(store.statuses()), False, reason)
    return Outcome(counts, True)


class _Work:
    """The blocks of a store that are missing, and how they are solved and kept."""

    def __init__(
        self,
        mooring: Mooring,
        record: Record,
        store: Store,
        shape: Shape | None,
        progress: Callable[[Progress], None] | None,
    ) -> None:
        self.mooring, self.record, self.store, self.shape = mooring, record, store, shape
        self.batch = Batch(mooring)
        self.progress = progress
        self.reading, self.counting = Lock(), Lock()
        self.missing = store.missing()
        statuses = store.statuses()
        self.done = self.found = int(statuses.sum())
        self.failed = self.done - int(statuses[0])

    def here(self, workers: int, tell: Callable[[str], None]) -> None:
        """Solve them in threads of this process."""
        if self.missing:
            compile_kernel(self.batch, tell)
        self._tell()
        in_threads(self._solve, self.missing, min(workers, len(self.missing)))

    def on_cluster(self, address: str) -> None:
        """Solve them on the workers of a dask scheduler; this process reads and writes."""
        from calm.batch.cluster import solved_on

        self._tell()
        blocks = ((number, self._levels(number)) for number in self.missing)
        with closing(solved_on(address, self.mooring, blocks)) as solved:
            for number, profiles in solved:
                self._keep(number, profiles)

    def _solve(self, number: int) -> None:
        depth, u, v, w = self._levels(number)
        self._keep(number, self.batch.solve(u, v, depth, w, workers=1))

    def _levels(self, number: int) -> Levels:
        with self.reading:  # libraries that read files take one thread at a time
            return self.record.profiles(*self.store.span(number))

    def _keep(self, number: int, profiles: Profiles) -> None:
        start, stop = self.store.span(number)
        layout = self.store.layout
        arrays = layout.arrays(self.record.time[start:stop], profiles, self.shape)
        chunks = {
            variable.name: packed(_filled(arrays[variable.name], self.store.chunk_shape(variable)))
            for variable in self.store.in_blocks
        }
        self.store.write(number, chunks)
        with self.counting:
            self.done += stop - start
            self.failed += int(np.count_nonzero(profiles.status))
            self._tell()

    def _tell(self) -> None:
        if self.progress is not None:
            total = self.record.count
            self.progress(Progress(self.done, total, self.found, self.failed))


def compile_kernel(batch: Batch, tell: Callable[[str], None]) -> None:
    """Let the kernel be compiled, or fetched, and tell when that takes long."""
    folder = cache_folder()
    new = folder is None or not any(folder.rglob("*.nbi"))
    if new:
        tell("compiling the solver for this machine, once: this takes a minute")
    if folder is None:
        tell(
            "no folder can be written to keep it in, so every run compiles anew; "
            "NUMBA_CACHE_DIR names one"
        )
    started = perf_counter()
    batch.solve(np.zeros((0, 1)), np.zeros((0, 1)), np.zeros(1), workers=1)
    if new:
        tell(f"compiled in {perf_counter() - started:.0f} s")


def in_threads(job: Callable[[int], None], numbers: Iterable[int], workers: int) -> None:
    """Do a job for every number, each thread taking the next.

    What a job raises, or Ctrl-C, stops the others after the job that they are at, and is raised;
    a job that takes longer than `GRACE` is left to itself, which a store does not mind.
    """
    remaining = iter(numbers)
    taking, stop = Lock(), Event()
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
    finally:
        stop.set()
        until = monotonic() + GRACE
        for thread in threads:
            thread.join(max(until - monotonic(), 0.0))
    if raised:
        raise raised[0]


def _filled(values: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """A block as a whole chunk: the last one is made as long as the others."""
    if values.shape == shape:
        return values
    whole = np.full(shape, np.nan if values.dtype.kind == "f" else 0, values.dtype)
    whole[: len(values)] = values
    return whole


def _named(statuses: NDArray[np.int64]) -> dict[str, int]:
    return {STATUSES[i]: int(statuses[i]) for i in np.flatnonzero(statuses)}


def _counts_of(output: Path) -> dict[str, int]:
    """From the statuses of a finished result."""
    from calm.batch.accessor import open_result

    counts = np.zeros(len(STATUSES), np.int64)
    with open_result(output) as result:
        status = result["status"]
        for start in range(0, len(status), BLOCK):
            counts += np.bincount(status[start : start + BLOCK].values, minlength=len(STATUSES))
    return _named(counts)


def _processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
