"""The blocks of a store that are missing: solved a slice at a time, and kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass
from threading import Event, Lock
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Batch, Profiles
from calm.batch.shape import Shape
from calm.batch.statuses import STATUSES, Ending, endings
from calm.batch.store.chunks import packed
from calm.batch.store.store import Arrays, Flag, Store
from calm.batch.threads import in_threads

if TYPE_CHECKING:
    from calm.batch.records.record import Levels, Record

FIRST, FEWEST = 256, 8
"""Profiles that are solved before anybody is told, or may stop it: at first, and at least, where
each is solved by itself. `SLICE` sets how many."""

SLICE = 0.5
"""Seconds that the next slice should take."""

PUT_BY = 20.0
"""Seconds between two states of one block that are kept: where many of its profiles have to be
solved by themselves it takes minutes, which a kill would otherwise cost."""


@dataclass(frozen=True)
class Progress:
    """How far a batch is, in profiles.

    Attributes
    ----------
    done, total : those solved, and all
    found : those that were there already when it began
    endings : how those done ended
    alone : those of this run that the lanes could not solve, each far slower than the others
    """

    done: int
    total: int
    found: int
    endings: Mapping[Ending, int]
    alone: int


class Work:
    """What is to be done in a store, which nobody else works on, and what has been done."""

    def __init__(
        self,
        batch: Batch,
        record: Record,
        store: Store,
        shape: Shape | None,
        progress: Callable[[Progress], None] | None,
    ) -> None:
        self.batch, self.record, self.store, self.shape = batch, record, store, shape
        self.progress = progress
        self.stop, self.alone = Event(), 0
        self._reading, self._counting = Lock(), Lock()
        self._length = FIRST
        found = ((number, store.flag(number)) for number in range(store.count))
        self.flags: dict[int, Flag] = {number: flag for number, flag in found if flag is not None}
        begun = ((number, store.begun(number)) for number in self.missing)
        self._kept = {
            number: _counted(arrays["status"]) for number, arrays in begun if arrays is not None
        }
        self._solved = sum((np.array(flag.statuses) for flag in self.flags.values()), _NONE)
        self._solved = sum(self._kept.values(), self._solved)
        self._found = int(self._solved.sum())

    @property
    def missing(self) -> list[int]:
        """Blocks that are not done."""
        return [number for number in range(self.store.count) if number not in self.flags]

    @property
    def counts(self) -> dict[str, int]:
        """How many profiles are on the disk, by status."""
        on_disk = sum((np.array(flag.statuses) for flag in self.flags.values()), _NONE)
        return _named(sum(self._kept.values(), on_disk))

    def here(self, workers: int) -> None:
        """Solve what is missing in threads of this process."""
        self.tell()
        missing = self.missing
        in_threads(self._solve, missing, min(workers, len(missing)), self.stop)

    def on_cluster(self, address: str, tell: Callable[[str], None]) -> None:
        """Solve it on the workers of a dask scheduler; this process reads and writes."""
        from calm.batch.cluster import solved_on

        self.tell()
        begun: dict[int, list[Arrays]] = {}

        def blocks() -> Iterator[tuple[int, Levels]]:
            for number in self.missing:
                begun[number], first = self._begun(number)
                yield number, self._levels(number, first)

        with closing(solved_on(address, self.batch.mooring, blocks(), tell)) as solved:
            for number, profiles in solved:
                parts = begun.pop(number)
                self._add(number, parts, profiles)
                self._keep(number, parts)

    def forget(self, numbers: list[int]) -> None:
        """Blocks turn out to be missing."""
        for number in numbers:
            flag = self.flags.pop(number, None)
            if flag is not None:
                self._solved = self._solved - np.array(flag.statuses)

    def tell(self) -> None:
        """Of how far it is."""
        if self.progress is not None:
            done, ended = int(self._solved.sum()), endings(_named(self._solved))
            self.progress(Progress(done, self.record.count, self._found, ended, self.alone))

    def _solve(self, number: int) -> None:
        parts, first = self._begun(number)
        depth, u, v, w = self._levels(number, first)
        behind, put_by = 0, monotonic()
        while behind < len(u):
            if self.stop.is_set():
                self._put_by(number, parts)
                return
            began = monotonic()
            mine = slice(behind, behind + self._length)
            behind = min(mine.stop, len(u))
            here = depth if depth.ndim == 1 else depth[mine]
            up = None if w is None else w[mine]
            profiles = self.batch.solve(u[mine], v[mine], here, up, workers=1)
            self._add(number, parts, profiles)
            now = monotonic()
            if behind == mine.stop:  # a whole slice, or it says little
                share = SLICE / max(now - began, 1e-6)
                self._length = max(int(self._length * min(share, 2.0)), FEWEST)
            if behind < len(u):
                with self._counting:
                    self.tell()
                if now - put_by > PUT_BY:
                    self._put_by(number, parts)
                    put_by = now
        self._keep(number, parts)

    def _begun(self, number: int) -> tuple[list[Arrays], int]:
        """What is there of a block, and of how many profiles."""
        arrays = self.store.begun(number)
        return ([], 0) if arrays is None else ([arrays], len(arrays["status"]))

    def _levels(self, number: int, first: int) -> Levels:
        start, stop = self.store.span(number)
        with self._reading:  # libraries that read files take one thread at a time
            return self.record.profiles(start + first, stop)

    def _add(self, number: int, parts: list[Arrays], profiles: Profiles) -> None:
        """Put the next profiles of a block to its parts."""
        start = self.store.span(number)[0] + sum(len(part["status"]) for part in parts)
        time = self.record.time[start : start + len(profiles.status)]
        parts.append(self.store.layout.arrays(time, profiles, self.shape))
        with self._counting:
            self._solved = self._solved + _counted(profiles.status)
            self.alone += int(np.count_nonzero(profiles.alone))

    def _put_by(self, number: int, parts: list[Arrays]) -> None:
        if parts:
            arrays = _joined(parts)
            parts[:] = [arrays]
            self.store.put_by(number, arrays)
            with self._counting:
                self._kept[number] = _counted(arrays["status"])

    def _keep(self, number: int, parts: list[Arrays]) -> None:
        arrays = _joined(parts)
        chunks = {
            variable.name: packed(_filled(arrays[variable.name], self.store.chunk_shape(variable)))
            for variable in self.store.in_blocks
        }
        flag = self.store.write(number, chunks, _counted(arrays["status"]))
        with self._counting:
            self.flags[number] = flag
            self._kept.pop(number, None)
            self.tell()


_NONE = np.zeros(len(STATUSES), np.int64)


def _counted(status: NDArray[np.int8]) -> NDArray[np.int64]:
    return np.bincount(status, minlength=len(STATUSES))


def _named(counts: NDArray[np.int64]) -> dict[str, int]:
    return {STATUSES[i]: int(counts[i]) for i in np.flatnonzero(counts)}


def _joined(parts: list[Arrays]) -> Arrays:
    if len(parts) == 1:
        return parts[0]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _filled(values: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """A block as a whole chunk: the last one is made as long as the others."""
    if values.shape == shape:
        return values
    whole = np.full(shape, np.nan if values.dtype.kind == "f" else 0, values.dtype)
    whole[: len(values)] = values
    return whole
