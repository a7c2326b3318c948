"""The variables of a `.mat` file, whatever program and version wrote it.

Nothing in such a file is executed or unpickled: MATLAB 4 and 5 are read by scipy, 7.3 (HDF5) by
h5py, Octave's text by a reader of this folder.
"""

from __future__ import annotations

import io
import math
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np

from calm.exchange.mdd.octave import is_octave_text, read_octave_text
from calm.exchange.mdd.value import Value
from calm.exchange.refusal import refused
from calm.files.document import read_content

LARGEST = 200_000_000
"""Bytes of a file."""

_MOST = 20_000_000  # elements of a variable
_HDF5 = b"\x89HDF\r\n\x1a\n"


def read_variables(path: Path, wanted: Collection[str]) -> dict[str, Value]:
    """The wanted variables that a file has.

    Raises
    ------
    InputError
        The file is no `.mat` file, or a damaged one.
    """
    content = read_content(path, largest=LARGEST)
    try:
        if is_octave_text(content):
            text = content.decode("utf-8", "replace")
            found = read_octave_text(text)
        elif _HDF5 in (content[:8], content[512:520]):
            found = _hdf5(content, wanted)
        else:
            found = _matlab(content, wanted)
    except MemoryError:
        raise
    except Exception as error:  # the readers fail in many ways on a damaged file
        reason = " ".join(str(error).split()) or type(error).__name__
        raise refused(path, f"is no MATLAB or Octave file, or a damaged one ({reason})") from None
    return {name: value for name, value in found.items() if name in wanted}


def is_mat(content: bytes) -> bool:
    """Whether a file looks like one of MATLAB or Octave, by its first bytes."""
    if is_octave_text(content) or content.startswith(b"MATLAB 5.0"):
        return True
    return _HDF5 in (content[:8], content[512:520]) or _is_version_4(content)


def _is_version_4(content: bytes) -> bool:
    """By its first header: type, rows, columns, imaginary, length of a name that is a word."""
    for order in ("<", ">"):
        head = np.frombuffer(content[:20], f"{order}i4") if len(content) > 20 else np.zeros(0)
        if head.size == 5 and 0 <= head[0] < 5000 and 1 < head[4] < 64 and head[3] in (0, 1):
            name = content[20 : 20 + int(head[4])]
            return name.endswith(b"\0") and name[:-1].replace(b"_", b"a").isalnum()
    return False


def _matlab(content: bytes, wanted: Collection[str]) -> dict[str, Value]:
    from scipy.io import loadmat, whosmat

    names = [name for name, shape, _ in whosmat(io.BytesIO(content)) if _fits(name, shape)]
    chosen = [name for name in names if name in wanted]
    found = loadmat(io.BytesIO(content), variable_names=chosen, struct_as_record=True)
    return {name: found[name] for name in chosen if name in found}


def _hdf5(content: bytes, wanted: Collection[str]) -> dict[str, Value]:
    import h5py

    found: dict[str, Value] = {}
    with h5py.File(io.BytesIO(content), "r") as file:
        for name in wanted:
            if isinstance(file.get(name, getlink=True), h5py.HardLink):
                found[name] = _dataset(file, file[name])
    return found


def _dataset(file: Any, node: Any) -> Value:
    """A dataset of MATLAB's, whose dimensions HDF5 turns round; Octave's stand in a group."""
    import h5py

    if isinstance(node, h5py.Group):
        if not isinstance(node.get("value", getlink=True), h5py.HardLink):
            return np.zeros((0, 0))
        node = node["value"]
    if not isinstance(node, h5py.Dataset) or node.is_virtual or node.external:
        raise ValueError("a variable refers to another file")
    if node.attrs.get("MATLAB_empty", 0):
        return np.zeros((0, 0))
    _fits(node.name, node.shape)
    value = node[()]
    if node.dtype == h5py.ref_dtype:
        return [_dataset(file, file[each]) for each in np.asarray(value).ravel()]
    array = np.asarray(value).T
    kind = node.attrs.get("MATLAB_class", b"")
    if kind in (b"char", "char"):
        rows = np.atleast_2d(array)
        return ["".join(chr(int(code)) for code in row).rstrip() for row in rows]
    return array


def _fits(name: str, shape: tuple[int, ...]) -> bool:
    if math.prod(shape) > _MOST:
        raise ValueError(f"`{name}` has {math.prod(shape)} elements")
    return True
