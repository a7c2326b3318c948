"""Results as NetCDF 4 files.

HDF5 ends the process where a write fails, as on a full disk. So it never meets one: what is small
is made in memory, and room for the rest is taken on the disk before it is asked to write there.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.dataset.variables import ResultLayout, Variable

if TYPE_CHECKING:
    import h5netcdf

LEVEL = 1
"""Of the compression; more takes twice the time for 3 % less."""

Chunk = tuple[str, tuple[int, ...], Path]
"""Name of its variable, where it begins in it, and the file that has its bytes."""

_OF_A_CHUNK, _OF_A_VARIABLE = 512, 65_536  # bytes at most that HDF5 needs to keep account of them
_LONG = 4096  # all attributes of a variable have 64 kB unless they are strings
_ZEROS = bytes(1 << 20)


def netcdf_of(layout: ResultLayout, block: int = 0) -> bytes:
    """The file of a layout; what goes with time is laid out, in chunks of a block, and empty.

    The chunks are shuffled and deflated, as `filters.Shuffle` and `Zlib` of `numcodecs` do it.
    """
    import h5netcdf

    image = BytesIO()
    with h5netcdf.File(image, "w") as file:
        file.dimensions = dict(layout.sizes)
        for name, value in sorted(layout.attributes.items()):
            file.attrs[name] = _text(value)
        for variable in layout.variables:
            _define(file, layout, variable, block)
    return image.getvalue()


def write_netcdf(
    layout: ResultLayout, block: int, chunks: Sequence[Chunk], path: Path, check: Callable[[], None]
) -> None:
    """Write a file with all its chunks, which are copied as they stand; in the memory of one.

    Parameters
    ----------
    check : called before each chunk; what it raises ends the writing

    Raises
    ------
    OSError
        There is no room for it; the file is then in part.
    """
    import h5py

    image = netcdf_of(layout, block)
    accounts = _OF_A_CHUNK * len(chunks) + _OF_A_VARIABLE * len(layout.variables)
    room = len(image) + accounts + sum(file.stat().st_size for _, _, file in chunks)
    with path.open("wb") as stream:
        stream.write(image)
        stream.flush()
        _take_room(stream.fileno(), room)
    with h5py.File(path, "r+") as file:
        for name, begin, source in chunks:
            check()
            file[name].id.write_direct_chunk(begin, source.read_bytes())


def _take_room(handle: int, size: int) -> None:
    """Make a file at least so long, on blocks of the disk that are its own."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(handle, 0, size)
        return
    while (missing := size - os.lseek(handle, 0, os.SEEK_END)) > 0:
        os.write(handle, _ZEROS[:missing])


def chunk_shape(layout: ResultLayout, variable: Variable, block: int) -> tuple[int, ...]:
    """Return the shape of the chunks of a variable that goes with time; the last is whole, too.

    Parameters
    ----------
    layout : of the result
    variable : one of its variables
    block : profiles in a chunk, at most
    """
    length = min(block, layout.sizes["time"])
    return length, *(layout.sizes[name] for name in variable.dimensions[1:])


def _define(file: h5netcdf.File, layout: ResultLayout, variable: Variable, block: int) -> None:
    import h5py

    kind = np.dtype(variable.dtype)
    settings: dict[str, Any] = {}
    if variable.values is None:
        settings = {
            "chunks": chunk_shape(layout, variable, block),
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
