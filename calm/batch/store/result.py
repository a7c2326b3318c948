"""From a store whose blocks are all done to the result: a NetCDF file or a zarr folder."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.batch.dataset import Variable
from calm.batch.store.chunks import LEVEL
from calm.batch.store.store import IDENTITY, WORK, Store, consolidated, refuse_another
from calm.errors import UsageError

if TYPE_CHECKING:
    import h5netcdf

ENDINGS = (".nc", ".zarr")
"""Of the results that can be written."""


def store_folder(output: Path) -> Path:
    """Where the work on a result is kept: beside it."""
    return output.with_name(f"{output.name}.part")


def is_finished(output: Path, identity: str) -> bool:
    """Whether a result is there already; what its work has left behind is then removed.

    Raises
    ------
    UsageError
        It is something else, or the result of another input.
    """
    if not output.exists():
        return False
    before = _attributes(output).get(IDENTITY)
    if not isinstance(before, str):
        raise UsageError(f"{output} is there already, and no result of calm batch; it is kept")
    refuse_another(output, before, identity)
    shutil.rmtree(output / WORK, ignore_errors=True)
    left = store_folder(output)
    if (left / WORK).is_dir():
        remove(left)
    return True


def finish(store: Store, output: Path) -> None:
    """Make the result of a store, which is no more afterwards.

    It has its name only once it is whole; the memory that it takes is that of one chunk.
    """
    if output.suffix == ".zarr":
        consolidated(store.folder)
        os.replace(store.folder, output)
        shutil.rmtree(output / WORK)
        return
    temporary = store.folder / WORK / output.name
    _write_netcdf(store, temporary)
    os.replace(temporary, output)
    remove(store.folder)


def remove(folder: Path) -> None:
    """Remove a store; what tells that it is one goes last."""
    for path in folder.iterdir():
        if path.name != WORK:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    shutil.rmtree(folder)


def _attributes(output: Path) -> dict[str, Any]:
    """Of a result as a whole; none where it is something else."""
    if output.suffix == ".zarr":
        try:
            content: dict[str, Any] = json.loads((output / ".zattrs").read_bytes())
        except (OSError, ValueError):
            return {}
        return content
    import h5py

    try:
        with h5py.File(output, "r") as file:
            return dict(file.attrs)
    except OSError:
        return {}


def _write_netcdf(store: Store, path: Path) -> None:
    """The metadata by way of h5netcdf; the chunks, which HDF5 knows, go in untouched."""
    import h5netcdf
    import h5py

    attributes: dict[str, Any] = json.loads((store.folder / ".zattrs").read_bytes())
    with h5netcdf.File(path, "w") as file:
        file.dimensions = dict(store.layout.sizes)
        for name, value in sorted(attributes.items()):
            file.attrs[name] = value
        for variable in store.layout.variables:
            _define(file, store, variable)
    with h5py.File(path, "r+") as file:
        for variable in store.in_blocks:
            across = (0,) * (len(variable.dimensions) - 1)
            dataset = file[variable.name].id
            for number in range(store.count):
                data = store.chunk_file(variable, number).read_bytes()
                dataset.write_direct_chunk((number * store.block, *across), data)


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
        defined.attrs[name] = np.array(value, kind) if isinstance(value, list) else value
    if variable.values is not None:
        defined[...] = variable.values.astype(object) if kind.kind == "U" else variable.values
