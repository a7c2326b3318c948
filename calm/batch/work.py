"""The blocks of a store that are missing: solved a slice at a time, and kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from threading import Event, Lock
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import arrays_of
from calm.batch.profiles import Batch, Profiles
from calm.batch.shape import ShapeNodes
from calm.batch.statuses import STATUSES, Ending, endings
from calm.batch.store.store import Arrays, Store
from calm.batch.threads import in_threads

if TYPE_CHECKING:
    from calm.records.record import Levels, Record

FIRST, FEWEST = 256, 8
"""Profiles solved before progress is reported or a stop heeded: at first, and at least. `SLICE`
sets how many."""

SLICE = 0.5
"""Seconds that the next slice should take."""


@dataclass(frozen=True)
class Progress:
    """How far a batch is, in profiles.

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
    """What is to be done in a store, which nobody else works on, and what has been done."""

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
        from calm.batch.cluster import solved_on

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


_NONE = np.zeros(len(STATUSES), np.int64)


def _counted(status: NDArray[np.int8]) -> NDArray[np.int64]:
    return np.bincount(status, minlength=len(STATUSES))


def _named(counts: NDArray[np.int64]) -> dict[str, int]:
    return {STATUSES[i]: int(counts[i]) for i in np.flatnonzero(counts)}
