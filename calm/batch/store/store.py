"""The work store of a batch: a zarr folder that grows block by block, and survives anything.

Beside the arrays it has a folder of its own, `.batch`: the identity of what is solved; a flag for
every block that is done, written after the block's data, with the size and the checksum of each
chunk; and what is done of blocks that take long.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, cast
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import Layout, Variable
from calm.batch.store.chunks import array_metadata, to_json
from calm.batch.store.disk import UNFINISHED, settle, write_whole
from calm.batch.store.identity import differences, sha256_of
from calm.errors import UsageError

WORK = ".batch"
"""The folder of a store that its result is without."""

IDENTITY = "input_resolved"
"""The attribute of a result that tells, as JSON, what it was made from."""

Arrays = Mapping[str, NDArray[Any]]
"""Values of some profiles, by the names of the variables that go with time."""


@dataclass(frozen=True)
class Flag:
    """What is known of a block that is done.

    Attributes
    ----------
    chunks : size and CRC-32 of each, by the name of its variable
    statuses : how many profiles there are of each of `calm.batch.statuses.STATUSES`
    """

    chunks: Mapping[str, tuple[int, int]]
    statuses: tuple[int, ...]


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
    def work(self) -> Path:
        """The folder of all that is no part of the result."""
        return self.folder / WORK

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

    def write(self, number: int, chunks: Mapping[str, bytes], statuses: Iterable[int]) -> Flag:
        """Write a block: its chunks by the names of their variables, then its flag."""
        for variable in self.in_blocks:
            write_whole(self.chunk_file(variable, number), chunks[variable.name], self.work)
        told = {name: (len(data), zlib.crc32(data)) for name, data in chunks.items()}
        flag = Flag(told, tuple(int(count) for count in statuses))
        write_whole(self._flag(number), to_json(vars(flag)), self.work)
        with suppress(FileNotFoundError):
            self._begun(number).unlink()
        return flag

    def flag(self, number: int) -> Flag | None:
        """The flag of a block that is done; None where it is not, or not as its flag has it."""
        try:
            content = json.loads(self._flag(number).read_bytes())
            chunks = {name: (size, crc) for name, (size, crc) in content["chunks"].items()}
            sizes = {
                variable.name: self.chunk_file(variable, number).stat().st_size
                for variable in self.in_blocks
            }
        except (FileNotFoundError, ValueError, KeyError, TypeError):
            return None
        if sizes != {name: size for name, (size, _) in chunks.items()}:
            return None
        return Flag(chunks, tuple(content["statuses"]))

    def chunks(self, flags: Mapping[int, Flag]) -> Iterator[tuple[Variable, int, bytes | None]]:
        """Every chunk; None in place of one that is not there, or not as it was written."""
        for variable in self.in_blocks:
            for number in range(self.count):
                flag = flags.get(number)
                yield variable, number, None if flag is None else self.chunk(variable, number, flag)

    def chunk(self, variable: Variable, number: int, flag: Flag) -> bytes | None:
        """A chunk of a block that is done; None where it is not as it was written."""
        try:
            data = self.chunk_file(variable, number).read_bytes()
        except FileNotFoundError:
            return None
        return data if flag.chunks[variable.name] == (len(data), zlib.crc32(data)) else None

    def forget(self, number: int) -> None:
        """Let a block be missing again."""
        with suppress(FileNotFoundError):
            self._flag(number).unlink()

    def put_by(self, number: int, arrays: Arrays) -> None:
        """Keep the first profiles of a block that is not done."""
        content, save = BytesIO(), cast(Any, np.savez)  # whose types know of no names
        save(content, **arrays)
        write_whole(self._begun(number), content.getvalue(), self.work)

    def begun(self, number: int) -> Arrays | None:
        """What was kept of a block by `put_by`; None where there is nothing, or not all of it."""
        try:
            with np.load(BytesIO(self._begun(number).read_bytes()), allow_pickle=False) as kept:
                return {variable.name: kept[variable.name] for variable in self.in_blocks}
        except (FileNotFoundError, BadZipFile, ValueError, KeyError, EOFError, zlib.error):
            return None

    def _flag(self, number: int) -> Path:
        return self.work / str(number)

    def _begun(self, number: int) -> Path:
        return self.work / f"{number}.begun"


def open_store(folder: Path, layout: Layout, block: int, identity: str) -> Store:
    """A store: begun where there is none, continued where there is one; within `lock.locked`.

    Parameters
    ----------
    folder : of the store
    identity : the text of what it is made from, see `calm.batch.store.identity`

    Raises
    ------
    UsageError
        The folder is no store, or that of another input.
    """
    store = Store(folder, layout, block)
    if folder.exists() and any(folder.iterdir()) and not store.work.is_dir():
        raise UsageError(f"{folder} is in the way: the work would be kept there")
    store.work.mkdir(parents=True, exist_ok=True)
    for path in store.work.glob(f"*{UNFINISHED}"):
        path.unlink(missing_ok=True)
    kept = store.work / "identity"
    if kept.exists():
        refuse_another(folder, kept.read_text(encoding="utf-8"), identity)
    # anew each time: after a power cut it may be there in part
    _lay_out(store, identity)
    if not kept.exists():
        write_whole(kept, identity.encode(), store.work)
        settle([kept, store.work])
    return store


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


def _lay_out(store: Store, identity: str) -> None:
    """Write all that does not go with time."""
    folder, layout = store.folder, store.layout
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
