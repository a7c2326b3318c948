"""Variables of HDF5 files: those of MATLAB 7.3, and those that Octave writes."""

from __future__ import annotations

import io
from collections.abc import Collection
from typing import Any

import numpy as np

from calm.exchange.mdd.octave import spread
from calm.exchange.mdd.value import MatValue, fits

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_TEXTS = ("char", "string", "sq_string")
_DEEPEST = 4  # cells in cells


def is_hdf5(content: bytes) -> bool:
    """Whether a file is HDF5, by its first bytes or those after MATLAB's header."""
    return _SIGNATURE in (content[:8], content[512:520])


def read_hdf5(content: bytes, wanted: Collection[str]) -> dict[str, MatValue]:
    """The wanted variables that a file has; links to other files are not followed.

    Raises
    ------
    ValueError, OSError
        The file is damaged, or a variable refers to another file.
    """
    import h5py

    found: dict[str, MatValue] = {}
    with h5py.File(io.BytesIO(content), "r") as file:
        for name in wanted:
            if isinstance(file.get(name, getlink=True), h5py.HardLink):
                found[name] = _variable(file, file[name], 0)
    return found


def _variable(file: Any, node: Any, depth: int) -> MatValue:
    """A dataset, as MATLAB writes it, or one of Octave's, which are in groups."""
    import h5py

    if depth > _DEEPEST:
        raise ValueError("cells are nested too deeply")
    if not isinstance(node, h5py.Group):
        return _values(file, node, _text_of(node.attrs.get("MATLAB_class", "")), depth)
    hard = [isinstance(node.get(key, getlink=True), h5py.HardLink) for key in ("type", "value")]
    if not all(hard) or not isinstance(node["type"], h5py.Dataset):
        return np.zeros((0, 0))  # a structure
    kind, value = _text_of(node["type"][()]), node["value"]
    if not isinstance(value, h5py.Group):
        return _values(file, value, kind.removeprefix("global ").strip(), depth)
    elements = [key for key in value if key.startswith("_") and key[1:].isdigit()]
    return [_variable(file, value[key], depth + 1) for key in sorted(elements, key=_number)]


def _number(key: str) -> int:
    return int(key[1:])


def _values(file: Any, node: Any, kind: str, depth: int) -> MatValue:
    """The values of a dataset; HDF5 has the dimensions in reverse order."""
    import h5py

    if not isinstance(node, h5py.Dataset) or node.is_virtual or node.external:
        raise ValueError("a variable refers to another file")
    if node.attrs.get("MATLAB_empty", 0) or node.attrs.get("OCTAVE_EMPTY_MATRIX", 0):
        return np.zeros((0, 0))
    fits(node.name, node.shape)
    value = node[()]
    if node.dtype == h5py.ref_dtype:
        return [_variable(file, file[each], depth + 1) for each in np.asarray(value).ravel()]
    if node.dtype.names == ("base", "limit", "increment"):
        return spread(node.name, *(float(value[name]) for name in node.dtype.names))
    array = np.asarray(value).T
    if kind in _TEXTS:
        rows = np.atleast_2d(array)
        if array.dtype.kind == "i":
            return [_utf_8(row) for row in rows]
        return ["".join(chr(int(code)) for code in row).rstrip() for row in rows]
    return array


def _utf_8(row: np.ndarray[Any, np.dtype[Any]]) -> str:
    """A text of Octave, which writes bytes."""
    return row.astype(np.uint8).tobytes().decode("utf-8", "replace").rstrip()


def _text_of(value: object) -> str:
    return value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)
