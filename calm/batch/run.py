"""Every profile of a record, in one pass: solved in blocks, written as one file or not at all."""

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
from calm.case import Mooring
from calm.case.net import Net
from calm.errors import UsageError
from calm.records.record import Record

BLOCK, BLOCK_OF_NET = 4096, 64
"""Profiles to a block, whose solving takes a moment."""


def run_batch(
    mooring: Mooring | Net,
    record: Record,
    output: Path,
    *,
    workers: int | None = None,
    block: int | None = None,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> dict[str, int]:
    """Solve a mooring in every profile of a record, write the result, and return how many profiles
    ended with each status that occurs.

    The result has its name only once it is whole; whatever ends the work before leaves none.

    Parameters
    ----------
    output : a .nc file; one that is there is replaced
    workers : threads; one for each processor that may be used where not given
    block : profiles solved and written at a time, which are the chunks of the result; as many as
        take a moment where not given
    scheduler : address of a dask scheduler, whose workers then solve the blocks
    progress : called before the first block, and after each
    tell : called with what is worth knowing meanwhile

    Raises
    ------
    UsageError
        The record has no profile; the result cannot be written; there is nobody at the address of
        the scheduler, or it was lost.
    NoEquilibrium
        Where a piece is to be cut to fit, and no length does.
    """
    if record.count == 0:
        raise UsageError("the record has no profile in the period asked for")
    length = block or (BLOCK_OF_NET if isinstance(mooring, Net) else BLOCK)
    text = resolved_input(mooring, record.time, {})
    whole, found = layout_of(mooring, record), InputHash(text)
    layout = replace(whole, attributes={**whole.attributes, **with_input(text)})
    of_blocks = replace(whole, attributes={})  # which go to other machines, too

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
