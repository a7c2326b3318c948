"""A record of currents: many profiles, read as they are needed."""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Callable
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats

Levels = tuple[Floats, Floats, Floats, Floats | None]
"""Depth, u, v and w of some profiles, as `solve_profiles` takes them."""

RULES = (
    "levels where the current or their depth has no value are left out of their profile",
    "levels above the surface are left out",
    "levels below the seabed are used where they have a value: the current at the seabed lies "
    "between",
    "between levels the current is linear in depth, beyond the first and the last it is constant",
)
"""What holds in every record."""

DIGEST_BLOCK = 8192
"""Profiles that are read at a time for a digest, which depends on it."""


class Record(ABC):
    """The profiles of a record that were asked for, in the order of time.

    Reading is for one thread at a time. A record is closed by `close`, or by a `with` statement.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    notes : the rules by which it was read, and what to know before trusting it
    source : its file, its variables and its place, by name
    """

    time: NDArray[np.datetime64]
    notes: tuple[str, ...]
    source: dict[str, str]

    @property
    def count(self) -> int:
        """Number of profiles."""
        return len(self.time)

    @abstractmethod
    def profiles(self, start: int, stop: int) -> Levels:
        """Depth (k,) or (m, k) [m], and u, v, w (m, k) [m/s] of some profiles, NaN in gaps.

        The depths are positive down, in any order; `w` is None where the record has none.

        Raises
        ------
        InputError
            The file is damaged there.
        """

    def flags(self, start: int, stop: int) -> NDArray[np.int8] | None:
        """(m, k) quality flags of the currents of some profiles; None where it has none."""
        return None

    @abstractmethod
    def close(self) -> None:
        """Leave the file."""

    def digest(self, check: Callable[[], None] = lambda: None) -> str:
        """SHA-256 of the times, depths and currents as they are read; the name does not count.

        Parameters
        ----------
        check : called before each part is read
        """
        digest = hashlib.sha256()
        digest.update(np.ascontiguousarray(self.time, "<M8[ns]").view("<i8").data)
        for start in range(0, self.count, DIGEST_BLOCK):
            check()
            for values in self.profiles(start, min(start + DIGEST_BLOCK, self.count)):
                if values is not None:
                    digest.update(str(values.shape).encode())
                    digest.update(np.ascontiguousarray(values, "<f8").data)
        return digest.hexdigest()

    def __enter__(self) -> Record:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
