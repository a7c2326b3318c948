"""A store as a NetCDF file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from calm.batch.dataset import Variable
from calm.batch.store.chunks import LEVEL
from calm.batch.store.store import Flag, Store

if TYPE_CHECKING:
    import h5netcdf


def write_netcdf(store: Store, flags: Mapping[int, Flag], path: Path) -> list[int]:
    """Write the file: the metadata by way of h5netcdf; the chunks, which HDF5 knows, untouched.

    Returned are the blocks that are not as they were written; the file is no good then.

    Raises
    ------
    OSError
        There is no room for it.
    """
    import h5netcdf
    import h5py

    attributes: dict[str, Any] = json.loads((store.folder / ".zattrs").read_bytes())
    damaged = set()
    with _File(path) as kept:
        with h5netcdf.File(kept, "w") as file:
            file.dimensions = dict(store.layout.sizes)
            for name, value in sorted(attributes.items()):
                file.attrs[name] = _text(value)
            for variable in store.layout.variables:
                _define(file, store, variable)
        with h5py.File(kept, "r+") as file:
            for variable, number, data in store.chunks(flags):
                if kept.failed:
                    break
                across = (0,) * (len(variable.dimensions) - 1)
                if data is None:
                    damaged.add(number)
                else:
                    place = (number * store.block, *across)
                    file[variable.name].id.write_direct_chunk(place, data)
    return sorted(damaged)


class _File:
    """A file that never fails as long as HDF5 has it: a full disk would crash it.

    What cannot be written is kept in memory, until the `with` block ends and the error is raised;
    `failed` tells that it is time to end it.
    """

    def __init__(self, path: Path) -> None:
        self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC | _BINARY, 0o666)
        self._at = self._end = 0
        self._error: OSError | None = None
        self._unwritten: list[tuple[int, bytes]] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)
        if self._error is not None:
            raise self._error from None

    @property
    def failed(self) -> bool:
        """Whether something could not be written."""
        return self._error is not None

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """To a place in the file."""
        self._at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self._end}[whence]
        return self._at

    def tell(self) -> int:
        """Where it is."""
        return self._at

    def read(self, size: int) -> bytes:
        """What stands there; zeros where nothing does."""
        os.lseek(self._handle, self._at, os.SEEK_SET)
        data = bytearray()
        while len(data) < size:
            data += os.read(self._handle, size - len(data)) or bytes(size - len(data))
        for start, piece in self._unwritten:
            first = max(start, self._at)
            behind = min(start + len(piece), self._at + size)
            if first < behind:
                data[first - self._at : behind - self._at] = piece[first - start : behind - start]
        self._at += size
        return bytes(data)

    def readinto(self, buffer: memoryview) -> int:
        """The same, into a buffer."""
        view = memoryview(buffer).cast("B")
        view[:] = self.read(len(view))
        return len(view)

    def write(self, data: memoryview) -> int:
        """Write it there."""
        whole = left = memoryview(data).cast("B")
        try:
            if self._error is None:
                os.lseek(self._handle, self._at, os.SEEK_SET)
            while left and self._error is None:
                left = left[os.write(self._handle, left) :]
        except OSError as error:
            self._error = error
        if self._error is not None:
            self._unwritten.append((self._at, bytes(whole)))
        self._at += len(whole)
        self._end = max(self._end, self._at)
        return len(whole)

    def truncate(self, size: int | None = None) -> int:
        """Cut the file, or make it longer."""
        self._end = self._at if size is None else size
        try:
            os.ftruncate(self._handle, self._end)
        except OSError as error:
            self._error = self._error or error
        return self._end

    def flush(self) -> None:
        """Nothing is held back."""


_BINARY: int = getattr(os, "O_BINARY", 0)  # of Windows


def _define(file: h5netcdf.File, store: Store, variable: Variable) -> None:
    import h5py

    kind = np.dtype(variable.dtype)
    settings: dict[str, Any] = {}
    if variable.values is None:
        settings = {
            "chunks": store.chunk_shape(variable),
            "compression": "gzip",
            "compression_opts": LEVEL,
            "shuffle": kind.itemsize > 1,
        }
    if kind.kind == "f" and variable.values is None:
        settings["fillvalue"] = kind.type(np.nan)
    defined = file.create_variable(
        variable.name,
        variable.dimensions,
        h5py.string_dtype() if kind.kind == "U" else kind,
        **settings,
    )
    for name, value in sorted(variable.attributes.items()):
        defined.attrs[name] = np.array(value, kind) if isinstance(value, list) else _text(value)
    if variable.values is not None:
        defined[...] = variable.values.astype(object) if kind.kind == "U" else variable.values


def _text(value: str) -> str | np.bytes_:
    """Characters where they will do, which every tool takes; else a string of any length."""
    return np.bytes_(value) if value.isascii() and len(value) < _LONG else value


_LONG = 4096  # all attributes of a variable have 64 kB unless they are strings
