"""Every profile of a record: solved in blocks, kept at once, taken up again where it stopped."""

import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Timer
from typing import TypeVar

from calm.batch import finished
from calm.batch.dataset import layout_of, nodes_of
from calm.batch.profiles import Batch, processors
from calm.batch.statuses import Ending, endings
from calm.batch.work import BatchWork, Progress, compile_solver
from calm.batch.work_store import Stopped, go_on, identity_of, open_store, to_text
from calm.case import Design
from calm.errors import UsageError
from calm.records.record import Record

BLOCK = 8192
"""Profiles to a block: what is written at once, and lost where a process is stopped."""

MOST_BLOCKS, LARGEST_BLOCK = 2048, 65536
"""Longer records have larger blocks, up to a size, as each makes a file for every variable."""

LONG = 2.0
"""Seconds after which progress is reported."""

ATTEMPTS = 3
"""How often blocks are solved again that do not come back from the disk as they went there."""


@dataclass(frozen=True)
class BatchOutcome:
    """Tell how a batch ended.

    Attributes
    ----------
    counts : how many profiles ended with each status that occurred; those that are kept, where it
        is not done
    done : whether the result is there; if not, running the same again finishes it
    reason : why it is not
    """

    counts: Mapping[str, int]
    done: bool
    reason: str = ""

    @property
    def endings(self) -> dict[Ending, int]:
        """The counts by what they come to."""
        return endings(self.counts)


def run_batch(
    mooring: Design,
    record: Record,
    output: Path,
    *,
    workers: int | None = None,
    block: int | None = None,
    shape: bool = False,
    scheduler: str | None = None,
    progress: Callable[[Progress], None] | None = None,
    tell: Callable[[str], None] | None = None,
    stop: Event | None = None,
) -> BatchOutcome:
    """Solve a mooring in every profile of a record, and write the result.

    The work is kept in a folder beside the result, ``RESULT.part``. Whatever ends it, even at
    once, the same call later solves what is missing; the result is byte for byte the same.

    Parameters
    ----------
    output : a .nc file or a .zarr folder
    workers : threads; one for each processor that may be used where not given
    block : profiles that are kept at a time, which are the chunks of the result; as many as take
        a moment where not given
    shape : store the shape of the line too
    scheduler : address of a dask scheduler, whose workers then solve the blocks
    progress : called before the first block, and after each part of one
    tell : called with what is worth knowing meanwhile
    stop : set from outside, it ends the work with what is done kept, as Ctrl-C does

    Raises
    ------
    UsageError
        The output is there already, from another input, or cannot be read; another batch is at
        work on it; there is nobody at the address of the scheduler.
    NoEquilibrium
        Where a piece is to be cut to fit, and no length does.
    """
    if record.count == 0:
        raise UsageError("the record has no profile in the period asked for")
    say, stop = tell or (lambda _: None), stop or Event()
    nodes = nodes_of(mooring) if shape else None
    batch = Batch(nodes.mooring if nodes else mooring)
    if block is None:
        block = _block_for(record.count)
    length, options = block, {"shape": shape, "block": block}

    def identify() -> str:
        return to_text(identity_of(mooring, record, options, stop))

    def begin(folder: Path, identity: str) -> BatchWork:
        store = open_store(folder, layout_of(mooring, record, nodes), length, identity)
        return BatchWork(batch, record, store, nodes, progress, stop)

    def solve(work: BatchWork) -> None:
        if scheduler is None:
            if work.missing:
                compile_solver(batch, say)
            work.here(workers or processors())
            return
        try:
            work.on_cluster(scheduler, say)
        except UsageError:
            if not work.counts:
                finished.clear(output)
            raise

    return run_kept(output, identify, begin, solve, say)


W = TypeVar("W", bound=BatchWork)


def run_kept(
    output: Path,
    identify: Callable[[], str],
    begin: Callable[[Path, str], W],
    solve: Callable[[W], None],
    say: Callable[[str], None],
) -> BatchOutcome:
    """Do work that is kept beside its result as it is done, and make the result.

    Parameters
    ----------
    identify : gives the text of what the result is made from
    begin : opens the store in a folder, and finds what of the work is missing
    solve : does what is missing
    say : called with what is worth knowing meanwhile

    Raises
    ------
    UsageError
        As `run_batch`.
    """
    if output.suffix not in finished.ENDINGS:
        raise UsageError(f"cannot write {output}: the name of a result must end in .nc or .zarr")
    folder = finished.store_folder(output)
    identity, work = "", None
    try:
        with _reported_when_long(say):
            identity = identify()
        if finished.is_finished(output, identity):
            if finished.left_behind(output):
                with suppress(UsageError), finished.locked(folder, say):
                    finished.clear(output)
            return _found(output)
        with finished.locked(folder, say):
            if finished.is_finished(output, identity):  # somebody else has done it meanwhile
                finished.clear(output)
                return _found(output)
            work = begin(folder, identity)
            _complete(work, output, solve, say)
            finished.clear(output)
    except (KeyboardInterrupt, Stopped, OSError, MemoryError) as error:
        if work is None:
            return BatchOutcome({}, False, _reason(error))
        if not finished.is_finished(output, identity):
            return BatchOutcome(work.counts, False, _reason(error))
    return BatchOutcome(work.counts, True)


def _complete(
    work: W, output: Path, solve: Callable[[W], None], tell: Callable[[str], None]
) -> None:
    """Solve what is missing, and make the result."""
    for _ in range(ATTEMPTS):
        solve(work)
        go_on(work.stop)
        damaged = finished.finish(work.store, output, lambda: go_on(work.stop))
        if not damaged:
            return
        work.forget(damaged)
        tell(f"{len(damaged)} blocks were damaged on the disk; they are solved again")
    raise OSError(f"{work.store.folder} does not keep what is written to it")


def _found(output: Path) -> BatchOutcome:
    """Of a finished result."""
    with finished.open_result(output) as result, finished.readable(output):
        return BatchOutcome(finished.statuses_of(result), True)


def _block_for(count: int) -> int:
    block = BLOCK
    while count > MOST_BLOCKS * block and block < LARGEST_BLOCK:
        block *= 2
    return block


@contextmanager
def _reported_when_long(tell: Callable[[str], None]) -> Iterator[None]:
    timer = Timer(LONG, tell, ("reading the whole record, to check that it is unchanged",))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _reason(error: BaseException) -> str:
    if isinstance(error, OSError):
        return os.strerror(error.errno) if error.errno else str(error)
    if isinstance(error, MemoryError):
        return "not enough memory; fewer --workers need less"
    # an interrupt within an `exec`, by which numba compiles, has `python -m calm` end by that
    # signal, whatever it exits with: until another `exec` has ended well
    exec("")
    return "interrupted"
