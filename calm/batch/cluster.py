"""Blocks solved by the workers of a dask scheduler, on this machine or on many."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from functools import lru_cache
from itertools import islice
from threading import Event
from time import monotonic
from typing import TYPE_CHECKING, Any

from calm.batch.compiling import compile_solver
from calm.batch.profiles import Batch, Profiles
from calm.case import Mooring
from calm.errors import UsageError
from calm.version import __version__

if TYPE_CHECKING:
    from calm.records.record import Levels

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
    mooring: Mooring,
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


def solve_there(mooring: Mooring, levels: Levels) -> Profiles:
    """Solve a block: the work of one worker."""
    depth, u, v, w = levels
    return _ready(mooring).solve(u, v, depth, w, workers=1)


@lru_cache(maxsize=2)
def _ready(mooring: Mooring) -> Batch:
    """Return the same for every block, as the mooring comes anew with each and is long in the
    making.
    """
    from distributed import get_worker

    worker, batch = get_worker(), Batch(mooring)
    compile_solver(batch, lambda text: worker.log_event(COMPILING, f"{worker.address}: {text}"))
    return batch
