"""Arrays as the bytes that zarr and HDF5 both hold: shuffled, and deflated."""

from __future__ import annotations

import json
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

LEVEL = 1
"""Of the compression; more takes twice the time for 3 % less."""

_NOISE = 2
"""The lower bytes of a float32 that are kept as they are: hardly a tenth of them can be saved."""

_HEADER = b"\x78\x01"  # of a zlib stream


def packed(values: NDArray[Any]) -> bytes:
    """A whole chunk as bytes."""
    size = values.dtype.itemsize
    if size == 1:
        return zlib.compress(values.tobytes(), LEVEL)
    planes = np.ascontiguousarray(values.reshape(-1).view(np.uint8).reshape(-1, size).T).tobytes()
    if values.dtype != np.float32:
        return zlib.compress(planes, LEVEL)
    # one stream of two parts, which any inflater reads: the noise stored, the rest deflated
    noise = _NOISE * values.size
    stored = zlib.compressobj(0, wbits=-15)
    deflated = zlib.compressobj(LEVEL, wbits=-15)
    return b"".join(
        (
            _HEADER,
            stored.compress(planes[:noise]),
            stored.flush(zlib.Z_FULL_FLUSH),
            deflated.compress(planes[noise:]),
            deflated.flush(),
            zlib.adler32(planes).to_bytes(4, "big"),
        )
    )


def unpacked(data: bytes, dtype: np.dtype[Any], shape: Sequence[int]) -> NDArray[Any]:
    """A chunk from its bytes."""
    planes = np.frombuffer(zlib.decompress(data), np.uint8)
    values = planes.reshape(dtype.itemsize, -1).T.copy().view(dtype)
    return values.reshape(tuple(shape))


def array_metadata(
    dtype: str, shape: Sequence[int], chunks: Sequence[int] | None
) -> dict[str, Any]:
    """The `.zarray` of an array, as of version 2 of the format; one without chunks is kept whole.

    Version 2, since its shuffle and its deflate are those of HDF5: a chunk goes from one to the
    other as it stands.
    """
    kind = np.dtype(dtype)
    filters = [{"id": "shuffle", "elementsize": kind.itemsize}] if kind.itemsize > 1 else None
    return {
        "zarr_format": 2,
        "shape": list(shape),
        "chunks": list(shape if chunks is None else chunks),
        "dtype": dtype,
        "order": "C",
        "fill_value": "NaN" if kind.kind == "f" else None,
        "compressor": None if chunks is None else {"id": "zlib", "level": LEVEL},
        "filters": None if chunks is None else filters,
        "dimension_separator": ".",
    }


def to_json(content: object) -> bytes:
    """JSON that is the same for the same content."""
    return json.dumps(content, sort_keys=True, indent=1, allow_nan=False).encode("ascii")
