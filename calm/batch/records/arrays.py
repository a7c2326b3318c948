"""A record in NetCDF or zarr, read through xarray a block at a time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.batch.records.choice import Period, choose_profiles, part
from calm.batch.records.record import RULES, Levels, Record
from calm.errors import InputError, Problem
from calm.files.current_dataset import CurrentArrays, understand
from calm.files.current_netcdf import open_current, reading
from calm.files.current_terms import Terms

AHEAD = 16_000_000
"""Bytes that are read together where a file has compressed them together."""


class ArrayRecord(Record):
    """A record whose profiles are found as `calm run` finds that of one time.

    Parameters and errors are those of `open_record`.
    """

    def __init__(self, path: Path, terms: Terms, period: Period | None, every: int) -> None:
        self._path = path
        with reading(path):
            self._dataset = open_current(path)
        try:
            with reading(path):
                self._current = understand(self._dataset, terms)
            times = self._current.times
            if times is None:
                message = "has no times: it is one profile, for `calm run`"
                raise InputError([Problem(str(path), 0, 0, message)])
            self._index, chosen = choose_profiles(times, period, every, path)
        except BaseException:
            self._dataset.close()
            raise
        self.time = times[self._index]
        self.notes = (
            *chosen,
            *self._current.notices,
            *self._current.turned,
            *self._current.rules,
            *RULES,
        )
        self.source = {"file": path.name, **self._current.source}
        self._ahead: tuple[int, int, CurrentArrays] | None = None

    def profiles(self, start: int, stop: int) -> Levels:
        """See `Record`."""
        first, _, arrays = self._window(start, stop)
        mine = slice(start - first, stop - first)
        depth = arrays.depth[mine] if self._current.moves else arrays.depth
        w = None if arrays.w is None else arrays.w[mine]
        return depth, arrays.u[mine], arrays.v[mine], w

    def flags(self, start: int, stop: int) -> NDArray[np.int8] | None:
        """See `Record`."""
        with reading(self._path):
            return self._current.flags(part(self._index, start, stop))

    def _window(self, start: int, stop: int) -> tuple[int, int, CurrentArrays]:
        """The profiles around those wanted that are decompressed with them, and which they are."""
        if self._ahead is not None and self._ahead[0] <= start and stop <= self._ahead[1]:
            return self._ahead
        self._ahead = None
        end = min(max(stop, self._end_of_chunk(start)), self.count)
        with reading(self._path):
            arrays = self._current.read(part(self._index, start, end))
        window = start, end, arrays
        if end > stop:
            self._ahead = window
        return window

    def _end_of_chunk(self, start: int) -> int:
        """The profile after those that a file has compressed together with one."""
        chunk = self._current.chunk
        if isinstance(self._index, slice):
            position = self._index.start + start * self._index.step
            chunk = -(-(chunk - position % chunk) // int(self._index.step))
        return start + min(chunk, AHEAD // max(self._current.size, 1))

    def close(self) -> None:
        """See `Record`."""
        self._dataset.close()
