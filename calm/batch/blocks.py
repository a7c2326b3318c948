"""Solution of blocks of profiles in threads, and output of the blocks in order."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import laid_out
from calm.batch.profiles import Batch, processors
from calm.batch.statuses import STATUSES, Ending, endings
from calm.dataset.netcdf import Attributes, Chunks, ResultLayout, packed, write_netcdf
from calm.records.record import Levels

IN_PROGRESS = 2
"""Largest number of blocks in progress per worker. This number limits the memory of a batch."""

Task = TypeVar("Task")
Done = TypeVar("Done", covariant=True)


@dataclass(frozen=True)
class Progress:
    """Progress of a batch.

    Attributes
    ----------
    done, total : number of finished profiles, and of all profiles
    endings : number of finished profiles by category of their status
    """

    done: int
    total: int
    endings: Mapping[Ending, int]


class SolvedBlock(NamedTuple):
    """Results for a block of n profiles.

    Attributes
    ----------
    status : (n,) status of each profile
    chunks : data of the block for the result file
    """

    status: NDArray[np.int8]
    chunks: Chunks


class BlockTask(NamedTuple):
    """Input of `solve_block`: the profiles of a block, and the layout of the result file.

    Attributes
    ----------
    layout, block : see `calm.dataset.netcdf.packed`
    time : (n,) times of the profiles
    levels : depths and currents, as returned by `calm.records.record.Record.profiles`
    """

    layout: ResultLayout
    block: int
    time: NDArray[np.datetime64]
    levels: Levels


def solve_block(batch: Batch, task: BlockTask) -> SolvedBlock:
    """Solve the profiles of a block in one thread."""
    depth, u, v, w = task.levels
    profiles = batch.solve(u, v, depth, w, workers=1)
    arrays = laid_out(task.layout, task.time, vars(profiles))
    return SolvedBlock(profiles.status, packed(task.layout, task.block, arrays))


class Promise(Protocol[Done]):
    """Running task, in a thread or on another machine."""

    def result(self) -> Done:
        """Wait for the task to finish, and return its result."""
        ...


def in_order(
    submit: Callable[[Task], Promise[Done]], tasks: Iterable[Task], ahead: Callable[[], int]
) -> Iterator[Done]:
    """Yield the results of tasks in the order of the tasks, even if later tasks finish first.

    `submit` starts a task. `ahead` returns the maximum number of tasks in progress.
    """
    under_way: deque[Promise[Done]] = deque()
    for task in tasks:
        under_way.append(submit(task))
        while len(under_way) >= max(ahead(), 1):
            yield under_way.popleft().result()
    while under_way:
        yield under_way.popleft().result()


def in_threads(
    solve: Callable[[Task], Done], tasks: Iterable[Task], workers: int | None
) -> Generator[Done]:
    """Solve tasks in threads, and yield the results in the order of the tasks.

    If the consumer stops early, waiting tasks are cancelled. `workers` is the number of threads, by
    default one for each processor.
    """
    count = workers or processors()
    pool = ThreadPoolExecutor(count)
    try:
        yield from in_order(
            lambda task: pool.submit(solve, task), tasks, lambda: IN_PROGRESS * count
        )
    finally:
        pool.shutdown(cancel_futures=True)


def write_solved(
    layout: ResultLayout,
    block: int,
    solved: Iterator[SolvedBlock],
    output: Path,
    progress: Callable[[Progress], None] | None = None,
    last: Callable[[], Attributes] = dict,
) -> dict[str, int]:
    """Write solved blocks to a file, and return the number of profiles with each status.

    Parameters
    ----------
    layout, block, output, last : see `calm.dataset.netcdf.write_netcdf`
    progress : function called before the first block and after each block
    """
    counts = np.zeros(len(STATUSES), np.int64)
    total = layout.sizes["time"]

    def named() -> dict[str, int]:
        return {STATUSES[i]: int(counts[i]) for i in np.flatnonzero(counts)}

    def tell() -> None:
        if progress is not None:
            progress(Progress(int(counts.sum()), total, endings(named())))

    def chunks() -> Iterator[Chunks]:
        tell()
        for one in solved:
            counts[:] += np.bincount(one.status, minlength=len(STATUSES))
            yield one.chunks
            tell()

    write_netcdf(layout, block, chunks(), output, last)
    return named()
