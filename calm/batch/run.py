"""Solution of all profiles of a record in blocks, with one result file."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from functools import partial
from pathlib import Path

from calm.batch.blocks import BlockTask, Progress, in_threads, solve_block, write_solved
from calm.batch.cluster import on_cluster
from calm.batch.compiling import compile_solver
from calm.batch.dataset import layout_of
from calm.batch.profiles import Batch
from calm.batch.resolved import InputHash, resolved_input, with_input
from calm.case import Design
from calm.errors import UsageError
from calm.records.record import Record

BLOCK, BLOCK_OF_NET = 4096, 64
"""Number of profiles in a block, for a line and for a net; a thread usually solves a block in less
than a second.
"""


def run_batch(
    mooring: Design,
    record: Record,
    output: Path,
    *,
    workers: int | None = None,
    block: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> dict[str, int]:
    """Solve a mooring for every profile of a record, and write the result file.

    An interrupted run leaves no new file and does not change an older result.

    Parameters
    ----------
    output : a .nc file; an existing file is replaced
    workers : number of threads; by default one for each processor
    block : number of profiles in a chunk of the result; by default `BLOCK` or, for a net,
        `BLOCK_OF_NET`
    scheduler : address of a dask scheduler whose workers solve the blocks
    progress : function called before the first block and after each block
    tell : function called with messages for the user

    Returns
    -------
    The number of profiles with each status that occurs.

    Raises
    ------
    UsageError
        The record has no profile, the result cannot be written, or the scheduler is not available.
    NoEquilibrium
        No length of a fitted piece reaches the required depth.
    """
    if record.count == 0:
        raise UsageError("the record has no profile in the requested period")
    length = block or (BLOCK_OF_NET if mooring.several else BLOCK)
    text = resolved_input(mooring, record.time, {})
    whole, found = layout_of(mooring, record), InputHash(text)
    layout = replace(whole, attributes={**whole.attributes, **with_input(text)})
    # without attributes, since the blocks may go to other machines
    of_blocks = replace(whole, attributes={})

    def tasks() -> Iterator[BlockTask]:
        for start in range(0, record.count, length):
            stop = min(start + length, record.count)
            levels = record.profiles(start, stop)
            time = record.time[start:stop]
            found.add((time, *levels))
            yield BlockTask(of_blocks, length, time, levels)

    if scheduler is None:
        batch = Batch(mooring)
        compile_solver(batch, tell)
        solved = in_threads(partial(solve_block, batch), tasks(), workers)
    else:
        solved = on_cluster(scheduler, mooring, tasks(), tell)
    with closing(solved):
        return write_solved(layout, length, solved, output, progress, found.attributes)
