"""Blocks solved by the workers of a dask scheduler, on this machine or on many."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING, Any

from calm.batch.profiles import Batch, Profiles
from calm.case import Mooring
from calm.errors import UsageError

if TYPE_CHECKING:
    from calm.batch.records.record import Levels

AHEAD = 2
"""Blocks that are under way for each thread of the workers."""

PATIENCE = "20s"
"""How long the scheduler may take to answer."""


def solved_on(
    address: str, mooring: Mooring, blocks: Iterator[tuple[int, Levels]]
) -> Generator[tuple[int, Profiles]]:
    """The blocks solved, as they are ready; those of a worker that is lost are solved by another.

    Parameters
    ----------
    address : of the scheduler, such as ``tcp://10.0.0.1:8786``
    blocks : numbers with their profiles; no more are taken than the workers have use for

    Raises
    ------
    UsageError
        `distributed` is not installed, or no scheduler answers.
    ConnectionError
        The scheduler is lost, or a block time and again with its worker.
    """
    try:
        import dask
        from distributed import CancelledError, Client, KilledWorker, as_completed
    except ImportError:
        raise UsageError(
            "--scheduler needs dask: pip install 'calm-mooring[cluster]', here and on the workers"
        ) from None
    # a block goes with its task, so that it can be solved again wherever that is
    with dask.config.set({"distributed.admin.large-graph-warning-threshold": "1GB"}):
        try:
            client = Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise UsageError(f"no scheduler answers at {address}: {error}") from None
        with client:
            numbers: dict[Any, int] = {}

            def submitted() -> Iterator[Any]:
                for number, levels in blocks:
                    task = client.submit(solve_there, mooring, levels, pure=False, retries=3)
                    numbers[task.key] = number
                    yield task

            tasks = submitted()
            window = AHEAD * max(sum(client.nthreads().values()), 1)
            under_way = as_completed(islice(tasks, window), loop=client.loop)
            for task in under_way:
                try:
                    profiles = task.result()
                except (CancelledError, KilledWorker) as error:
                    raise ConnectionError(f"the workers were lost: {error}") from None
                yield numbers.pop(task.key), profiles
                task.release()
                under_way.update(islice(tasks, 1))


def solve_there(mooring: Mooring, levels: Levels) -> Profiles:
    """What a worker does with a block."""
    depth, u, v, w = levels
    return _ready(mooring).solve(u, v, depth, w, workers=1)


@lru_cache(maxsize=2)
def _ready(mooring: Mooring) -> Batch:
    """The same for every block, as the mooring comes anew with each and is long in the making."""
    return Batch(mooring)
