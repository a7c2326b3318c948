"""The variables of a `.mat` file, whatever program and version wrote it.

Nothing in such a file is executed or unpickled: MATLAB 4 and 5 are read by scipy, HDF5 (MATLAB 7.3
and Octave) by h5py, Octave's text, compressed or not, by a reader of this folder.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Collection
from pathlib import Path

import numpy as np

from calm.exchange.mdd.hdf5 import is_hdf5, read_hdf5
from calm.exchange.mdd.octave import is_octave_text, read_octave_text
from calm.exchange.mdd.value import MatValue, fits
from calm.exchange.refusal import refused
from calm.files.document import read_content

LARGEST = 200_000_000
"""Bytes of a file."""

_GZIP = b"\x1f\x8b"
_OCTAVE_BINARY = b"Octave-1-"
_HEAD = 70_000  # bytes by which a compressed file is recognised


def read_variables(path: Path, wanted: Collection[str]) -> dict[str, MatValue]:
    """The wanted variables that a file has.

    Raises
    ------
    InputError
        The file is no `.mat` file, or a damaged one.
    """
    content = _inflated(read_content(path, largest=LARGEST), LARGEST + 1)
    if len(content) > LARGEST:
        raise refused(path, f"holds more than {LARGEST // 1_000_000} MB once it is decompressed")
    if content.startswith(_OCTAVE_BINARY):
        raise refused(path, "is in Octave's binary format; save it there with -v7, -hdf5 or -text")
    try:
        if is_octave_text(content):
            text = content.decode("utf-8", "replace")
            found = read_octave_text(text)
        elif is_hdf5(content):
            found = read_hdf5(content, wanted)
        else:
            found = _matlab(content, wanted)
    except MemoryError:
        raise
    except Exception as error:  # the readers fail in many ways on a damaged file
        reason = " ".join(str(error).split()) or type(error).__name__
        raise refused(
            path, f"is not a MATLAB or Octave file, or a damaged one ({reason})"
        ) from None
    return {name: value for name, value in found.items() if name in wanted}


def is_mat(content: bytes) -> bool:
    """Whether a file looks like one of MATLAB or Octave, by its first bytes."""
    content = _inflated(content, _HEAD)
    if is_octave_text(content) or content.startswith((b"MATLAB 5.0", _OCTAVE_BINARY)):
        return True
    return is_hdf5(content) or _is_version_4(content)


def _inflated(content: bytes, most: int) -> bytes:
    """The first bytes of what is compressed, as far as it is whole; other files as they are."""
    if not content.startswith(_GZIP):
        return content
    try:
        return zlib.decompressobj(wbits=31).decompress(content, most)
    except zlib.error:
        return content


def _is_version_4(content: bytes) -> bool:
    """By its first header: type, rows, columns, imaginary, length of a name that is a word."""
    for order in ("<", ">"):
        head = np.frombuffer(content[:20], f"{order}i4") if len(content) > 20 else np.zeros(0)
        if head.size == 5 and 0 <= head[0] < 5000 and 1 < head[4] < 64 and head[3] in (0, 1):
            name = content[20 : 20 + int(head[4])]
            return name.endswith(b"\0") and name[:-1].replace(b"_", b"a").isalnum()
    return False


def _matlab(content: bytes, wanted: Collection[str]) -> dict[str, MatValue]:
    from scipy.io import loadmat, whosmat

    names = [name for name, shape, _ in whosmat(io.BytesIO(content)) if fits(name, shape)]
    chosen = [name for name in names if name in wanted]
    found = loadmat(io.BytesIO(content), variable_names=chosen, struct_as_record=True)
    return {name: found[name] for name in chosen if name in found}
