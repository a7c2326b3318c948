"""The work store of a batch: a zarr folder that grows block by block, and survives anything.

Beside the arrays it has a folder of its own, `.batch`: the identity of what is solved, and a flag
for every block that is done, written after the block's data and holding the size of them.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import Layout, Variable
from calm.batch.profiles import STATUSES
from calm.batch.store.chunks import array_metadata, to_json, unpacked
from calm.batch.store.identity import differences, sha256_of
from calm.errors import UsageError

WORK = ".batch"
"""The folder of a store that its result is without."""

IDENTITY = "input_resolved"
"""The attribute of a result that tells, as JSON, what it was made from."""


@dataclass(frozen=True)
class Store:
    """A work store on disk.

    Attributes
    ----------
    folder : of the store
    layout : of the result
    block : profiles to a block, the last one excepted
    """

    folder: Path
    layout: Layout
    block: int

    @property
    def count(self) -> int:
        """How many blocks there are."""
        return -(-self.layout.sizes["time"] // self.block)

    @property
    def in_blocks(self) -> list[Variable]:
        """The variables that go with time."""
        return [variable for variable in self.layout.variables if variable.values is None]

    def span(self, number: int) -> tuple[int, int]:
        """First profile of a block, and the one behind its last."""
        start = number * self.block
        return start, min(start + self.block, self.layout.sizes["time"])

    def chunk_shape(self, variable: Variable) -> tuple[int, ...]:
        """Of the chunks of a variable that goes with time: all are whole, the last one too."""
        length = min(self.block, self.layout.sizes["time"])
        return length, *(self.layout.sizes[name] for name in variable.dimensions[1:])

    def chunk_file(self, variable: Variable, number: int) -> Path:
        """Where a chunk is."""
        place = ".".join([str(number), *("0" for _ in variable.dimensions[1:])])
        return self.folder / variable.name / place

    def missing(self) -> list[int]:
        """The blocks that are still to be solved."""
        return [number for number in range(self.count) if not self._is_done(number)]

    def write(self, number: int, chunks: Mapping[str, bytes]) -> None:
        """Write a block: its chunks by the names of their variables, then its flag."""
        size = 0
        for variable in self.in_blocks:
            size += self.chunk_file(variable, number).write_bytes(chunks[variable.name])
        self._flag(number).write_text(str(size), encoding="ascii")

    def statuses(self) -> NDArray[np.int64]:
        """How many profiles there are of each of `STATUSES`, among the blocks that are done."""
        status = next(variable for variable in self.in_blocks if variable.name == "status")
        counts = np.zeros(len(STATUSES), np.int64)
        for number in range(self.count):
            if self._is_done(number):
                data = self.chunk_file(status, number).read_bytes()
                values = unpacked(data, np.dtype(status.dtype), self.chunk_shape(status))
                start, stop = self.span(number)
                counts += np.bincount(values[: stop - start], minlength=len(STATUSES))
        return counts

    def _flag(self, number: int) -> Path:
        return self.folder / WORK / str(number)

    def _is_done(self, number: int) -> bool:
        """Whether a block has its flag, and as many bytes as that says."""
        try:
            flag = self._flag(number).read_text(encoding="ascii")
            sizes = [
                self.chunk_file(variable, number).stat().st_size for variable in self.in_blocks
            ]
        except FileNotFoundError:
            return False
        return flag == str(sum(sizes))


@contextmanager
def open_store(folder: Path, layout: Layout, block: int, identity: str) -> Iterator[Store]:
    """A store to work on alone: begun where there is none, continued where there is one.

    Parameters
    ----------
    folder : of the store
    identity : the text of what it is made from, see `calm.batch.store.identity`

    Raises
    ------
    UsageError
        The folder is no store, or that of another input; someone else is at work on it.
    """
    work = folder / WORK
    if folder.exists() and any(folder.iterdir()) and not work.is_dir():
        raise UsageError(f"{folder} is in the way: the work would be kept there")
    work.mkdir(parents=True, exist_ok=True)
    with _alone(work / "lock", folder):
        kept = work / "identity"
        if kept.exists():
            refuse_another(folder, kept.read_text(encoding="utf-8"), identity)
        else:
            _begin(folder, layout, block, identity)
            _write_whole(kept, identity.encode())
        yield Store(folder, layout, block)


def refuse_another(path: Path, before: str, now: str) -> None:
    """Refuse to go on with what was made from another input, and tell what differs.

    Raises
    ------
    UsageError
        Where the two identities are not the same.
    """
    if before != now:
        told = differences(json.loads(before), json.loads(now))
        raise UsageError(
            f"{path} was made from another input: {told}. "
            "It is kept; give another name to the result, or remove it"
        )


def _begin(folder: Path, layout: Layout, block: int, identity: str) -> None:
    """Write all that does not go with time."""
    store = Store(folder, layout, block)
    attributes = {**layout.attributes, IDENTITY: identity, "input_sha256": sha256_of(identity)}
    (folder / ".zgroup").write_bytes(to_json({"zarr_format": 2}))
    (folder / ".zattrs").write_bytes(to_json(attributes))
    for variable in layout.variables:
        shape = [layout.sizes[name] for name in variable.dimensions]
        chunks = None if variable.values is not None else store.chunk_shape(variable)
        array = folder / variable.name
        array.mkdir(exist_ok=True)
        (array / ".zarray").write_bytes(to_json(array_metadata(variable.dtype, shape, chunks)))
        (array / ".zattrs").write_bytes(
            to_json({**variable.attributes, "_ARRAY_DIMENSIONS": variable.dimensions})
        )
        if variable.values is not None:
            whole = np.ascontiguousarray(variable.values, variable.dtype).tobytes()
            (array / ".".join("0" * max(len(shape), 1))).write_bytes(whole)


def consolidated(folder: Path) -> None:
    """Write the metadata of all arrays into one file, which readers ask for first."""
    files = [
        folder / ".zgroup",
        folder / ".zattrs",
        *folder.glob("*/.zarray"),
        *folder.glob("*/.zattrs"),
    ]
    metadata = {
        file.relative_to(folder).as_posix(): json.loads(file.read_bytes()) for file in files
    }
    document: dict[str, Any] = {"zarr_consolidated_format": 1, "metadata": metadata}
    _write_whole(folder / ".zmetadata", to_json(document))


def _write_whole(path: Path, content: bytes) -> None:
    temporary = path.with_name(f"{path.name}.part")
    temporary.write_bytes(content)
    os.replace(temporary, path)


@contextmanager
def _alone(lock: Path, folder: Path) -> Iterator[None]:
    """Hold a lock that ends with the process, however that ends."""
    with lock.open("w") as held:
        if sys.platform != "win32":
            import fcntl

            try:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise UsageError(f"another calm batch is at work on {folder}") from None
            except OSError:  # a file system without locks
                pass
        yield
