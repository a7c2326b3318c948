"""Solution of the blocks of a batch on the workers of a dask scheduler, on one machine or many."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from functools import lru_cache

from calm.batch.blocks import (
    IN_PROGRESS,
    BlockTask,
    Promise,
    SolvedBlock,
    in_order,
    solve_block,
)
from calm.batch.profiles import Batch
from calm.case import Design
from calm.errors import UsageError
from calm.version import __version__

PATIENCE = "20s"
"""Timeout for an answer of the dask scheduler."""


def on_cluster(
    address: str,
    mooring: Design,
    tasks: Iterator[BlockTask],
    tell: Callable[[str], None],
) -> Generator[SolvedBlock]:
    """Solve blocks on the workers of a dask scheduler, and yield the results in order.

    The function waits for the first worker. If a worker is lost, other workers solve its blocks.

    Parameters
    ----------
    address : address of the scheduler, such as ``tcp://10.0.0.1:8786``
    tell : function called with a message if the scheduler has no worker

    Raises
    ------
    UsageError
        The scheduler does not answer, CALM is not installed on the workers, or the connection is
        lost.
    """
    from distributed import CancelledError, Client, KilledWorker

    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise UsageError(f"no scheduler answers at {address}: {error}") from None

    def submit(task: BlockTask) -> Promise[SolvedBlock]:
        # the task carries its block, so that any worker can solve it again
        promise: Promise[SolvedBlock] = client.submit(
            solve_there, mooring, task, pure=False, retries=3
        )
        return promise

    def ahead() -> int:
        threads: dict[str, int] = client.nthreads()
        return IN_PROGRESS * sum(threads.values())

    with client:
        if not client.nthreads():
            tell(f"the scheduler at {address} has no workers yet; waiting for the first worker")
        try:
            yield from in_order(submit, tasks, ahead)
        except (CancelledError, KilledWorker, OSError) as error:
            raise UsageError(
                f"the connection to the scheduler or its workers was lost: {error}"
            ) from None
        except (ImportError, AttributeError, RuntimeError) as error:
            # dask raises these for missing modules
            raise UsageError(
                f"the scheduler or a worker cannot run the tasks: {error}; install "
                f"calm-mooring {__version__} on the scheduler and on every worker"
            ) from None


def solve_there(mooring: Design, task: BlockTask) -> SolvedBlock:
    """Solve a block on a worker of the dask scheduler."""
    return solve_block(_prepared_batch(mooring), task)


# cached, because every block needs the batch and its preparation is slow
@lru_cache(maxsize=2)
def _prepared_batch(mooring: Design) -> Batch:
    return Batch(mooring)
