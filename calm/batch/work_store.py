"""The work store of a batch: a zarr folder that grows block by block, and survives anything.

Beside the arrays it has a folder of its own, `.batch`: the identity of what is solved, and a flag
for every block that is done, which is made after the block's data. What the data have come to
since is for the codecs of zarr to find out: zlib has a checksum. By its identity a result
is never continued with something else than what it is made from.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import zlib
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from calm.case import Design
from calm.dataset.netcdf import LEVEL, Chunk, ResultLayout, chunk_shape
from calm.errors import UsageError
from calm.records.record import Record
from calm.version import __version__
from calm.whole_file import flush_to_disk, put

if TYPE_CHECKING:
    import zarr

WORK = ".batch"
"""The folder of a store that its result is without."""

IDENTITY = "input_resolved"
"""The attribute of a result that shows, as JSON, what it was made from."""

Arrays = Mapping[str, NDArray[Any]]
"""Values of some profiles, by the names of the variables that go with time."""


class Stopped(Exception):
    """Work was asked to stop, by an event, and does so where it loses nothing."""


def go_on(stop: Event) -> None:
    """Stop here where that is asked for (Stopped: see above)."""
    if stop.is_set():
        raise Stopped


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
    layout: ResultLayout
    block: int

    @property
    def work(self) -> Path:
        """The folder of all that is no part of the result."""
        return self.folder / WORK

    @property
    def times(self) -> int:
        """Return how many times there are, be their dimension called in capitals or not."""
        return self.layout.sizes[self.layout.in_blocks[0].dimensions[0]]

    @property
    def count(self) -> int:
        """Return how many blocks there are."""
        return -(-self.times // self.block)

    @cached_property
    def arrays(self) -> Mapping[str, zarr.Array[Any]]:
        """Return those that go with time, by their names."""
        import zarr

        with zarr.config.set({"array.write_empty_chunks": True}):
            group = zarr.open_group(self.folder, mode="r+", zarr_format=2)
            return {
                variable.name: cast("zarr.Array[Any]", group[variable.name])
                for variable in self.layout.in_blocks
            }

    def span(self, number: int) -> tuple[int, int]:
        """First profile of a block, and the one after its last."""
        start = number * self.block
        return start, min(start + self.block, self.times)

    def write(self, number: int, arrays: Arrays) -> None:
        """Write a block, then its flag."""
        start, stop = self.span(number)
        for name, array in self.arrays.items():
            array[start:stop] = arrays[name]
        self._flag(number).touch()

    def statuses(self, number: int) -> NDArray[np.int8] | None:
        """The statuses of a block that is done; None where it is not."""
        if not self._flag(number).exists():
            return None
        try:
            return self._read("status", number)
        except _DAMAGED:
            return None

    def chunks(self) -> list[Chunk]:
        """The files of all blocks."""
        return [
            (name, (number * self.block, *(0 for _ in array.shape[1:])), self._file(name, number))
            for name, array in self.arrays.items()
            for number in range(self.count)
        ]

    def forget_damaged(self, check: Callable[[], None]) -> list[int]:
        """The blocks that are not as they were written: they are missing again.

        `check` is called before each block is read again.
        """

        def is_whole(number: int) -> bool:
            check()
            return self._is_whole(number)

        with ThreadPoolExecutor() as pool:
            whole = list(pool.map(is_whole, range(self.count)))
        damaged = [number for number, good in enumerate(whole) if not good]
        for number in damaged:
            self._flag(number).unlink(missing_ok=True)
        return damaged

    def _is_whole(self, number: int) -> bool:
        try:
            for name in self.arrays:
                self._read(name, number)
        except _DAMAGED:
            return False
        return True

    def _read(self, name: str, number: int) -> NDArray[Any]:
        if not self._file(name, number).stat().st_size:  # zarr takes what is missing for NaN
            raise ValueError("an empty file")
        start, stop = self.span(number)
        return np.asarray(self.arrays[name][start:stop])

    def _file(self, name: str, number: int) -> Path:
        array = self.arrays[name]
        place = (number, *(0 for _ in array.shape[1:]))
        return self.folder / name / array.metadata.encode_chunk_key(place)

    def _flag(self, number: int) -> Path:
        return self.work / str(number)


_DAMAGED = (OSError, ValueError, RuntimeError, zlib.error)
"""By which codecs leave."""


def open_store(folder: Path, layout: ResultLayout, block: int, identity: str) -> Store:
    """A store: begun where there is none, continued where there is one; within `lock.locked`.

    Parameters
    ----------
    folder : of the store
    identity : the text of what it is made from, see `calm.batch.work_store`

    Raises
    ------
    UsageError
        The folder is no store, or that of another input, or its identity is damaged.
    """
    attributes = {**layout.attributes, IDENTITY: identity, "input_sha256": sha256_of(identity)}
    store = Store(folder, replace(layout, attributes=attributes), block)
    if folder.exists() and any(folder.iterdir()) and not store.work.is_dir():
        raise UsageError(f"{folder} is in the way: the work would be kept there")
    store.work.mkdir(parents=True, exist_ok=True)
    kept = store.work / "identity"
    if kept.exists():
        refuse_another(folder, kept.read_bytes().decode("utf-8", "replace"), identity)
    for pattern in ("*.partial", "*.calm-part"):  # of killed processes
        for path in folder.rglob(pattern):
            path.unlink(missing_ok=True)
    # anew each time: after a power cut it may be there in part
    _lay_out(store)
    if not kept.exists():
        put(kept, identity.encode(), durable=True)
        flush_to_disk([store.work])
    return store


def refuse_another(path: Path, before: str, now: str) -> None:
    """Refuse to go on with what was made from another input, and report what differs.

    UsageError: where the two identities are not the same, or the first cannot be read.
    """
    if before == now:
        return
    try:
        changes = differences(json.loads(before), json.loads(now))
    except ValueError:
        raise UsageError(
            f"{path} is damaged: it no longer shows what it was made from. Remove it; the "
            "same command starts afresh"
        ) from None
    raise UsageError(
        f"{path} was made from another input: {changes}. It is kept; give the result "
        "another name, or remove it"
    )


def _lay_out(store: Store) -> None:
    """All but the blocks: made apart, then put in place file by file."""
    import zarr
    from numcodecs import Shuffle, Zlib

    layout, apart = store.layout, store.work / "layout"
    shutil.rmtree(apart, ignore_errors=True)
    group = zarr.open_group(apart, mode="w", zarr_format=2, attributes=layout.attributes)
    for variable in layout.variables:
        kind, values = np.dtype(variable.dtype), variable.values
        in_blocks = values is None
        shape = tuple(layout.sizes[name] for name in variable.dimensions)
        array = group.create_array(
            variable.name,
            shape=shape,
            chunks=chunk_shape(layout, variable, store.block) if in_blocks else shape,
            dtype=variable.dtype,
            filters=[Shuffle(kind.itemsize)] if in_blocks and kind.itemsize > 1 else None,
            compressors=Zlib(LEVEL) if in_blocks else None,
            fill_value=np.nan if kind.kind == "f" else None,
            attributes={**variable.described, "_ARRAY_DIMENSIONS": list(variable.dimensions)},
            config={"write_empty_chunks": True},
        )
        if values is not None:
            array[...] = values
    zarr.consolidate_metadata(apart, zarr_format=2)
    for path in sorted(apart.rglob("*")):
        place = store.folder / path.relative_to(apart)
        if path.is_dir():
            place.mkdir(exist_ok=True)
        else:
            os.replace(path, place)
    with suppress(OSError):
        shutil.rmtree(apart)


MOST_TOLD = 5
"""So many differences are reported, and how many more there are."""

_NO_MATTER = frozenset(
    {"path", "line", "column", "checks", "notices", "variants", "description", "current"}
    | {"sources", "searched", "prefer", "waves", "seas"}
)
"""What of a mooring file changes no figure of its results: every profile has its own current."""


def identity_of(
    mooring: Design, record: Record, options: Mapping[str, Any], stop: Event
) -> dict[str, Any]:
    """All that the figures of a result follow from, as JSON has it.

    Stopped: while the record is read through, which may take long.
    """
    ends = (record.time[0], record.time[-1])
    identity = {
        "calm": __version__,
        "mooring": _plain(mooring.file),
        "record": {
            "profiles": record.count,
            "from": str(ends[0].astype("datetime64[s]")),
            "to": str(ends[1].astype("datetime64[s]")),
            "sha256": record.digest(lambda: go_on(stop)),
        },
        "options": dict(options),
    }
    decoded: dict[str, Any] = json.loads(to_text(identity))
    return decoded


def to_text(identity: Mapping[str, Any]) -> str:
    """The JSON text of an identity: the same for the same."""
    return json.dumps(identity, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def sha256_of(text: str) -> str:
    """Return the SHA-256 of a text, in hexadecimal."""
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()


def differences(before: Any, now: Any) -> str:
    """Return what differs between two identities, in words."""
    found = list(_differing("", before, now))
    listed = "; ".join(found[:MOST_TOLD])
    return f"{listed}; and {len(found) - MOST_TOLD} more" if len(found) > MOST_TOLD else listed


def _differing(place: str, before: Any, now: Any) -> Iterator[str]:
    if isinstance(before, dict) and isinstance(now, dict):
        for key in sorted({*before, *now}):
            inner = f"{place}.{key}" if place else key
            yield from _differing(inner, before.get(key), now.get(key))
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        for index, pair in enumerate(zip(before, now, strict=True)):
            yield from _differing(f"{place}[{index}]", *pair)
    elif before != now:
        yield f"{place} was {_shown(before)}, is now {_shown(now)}"


def _shown(value: Any) -> str:
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if isinstance(value, dict):
        return "something else" if len(value) > 1 else str(value)
    return "absent" if value is None else str(value)


def _plain(value: Any) -> Any:
    """A model as mappings, lists, text and numbers; without what is None or does not matter."""
    if isinstance(value, BaseModel):
        return _known({name: getattr(value, name) for name in type(value).model_fields})
    if is_dataclass(value):
        return _known({each.name: getattr(value, each.name) for each in fields(value)})
    if isinstance(value, tuple | list):
        return [_plain(member) for member in value]
    return value


def _known(members: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: _plain(member)
        for name, member in members.items()
        if member is not None and name not in _NO_MATTER
    }
