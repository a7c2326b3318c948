"""What a variable of a `.mat` file may be, and how numbers and names are taken from it."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

MatValue: TypeAlias = "NDArray[Any] | str | list[MatValue]"
"""A variable: numbers or characters, a text, or the elements of a cell array."""

MOST = 20_000_000
"""Most elements of a variable."""

RealArray = NDArray[np.float64]


def numbers(value: MatValue | None) -> RealArray:
    """A variable as numbers; an empty array where there is none.

    Raises
    ------
    ValueError
        It holds no real numbers.
    """
    if value is None:
        return np.zeros((0, 0))
    if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
        return np.asarray(value, np.float64)
    if isinstance(value, list) and not value:
        return np.zeros((0, 0))
    raise ValueError("holds no real numbers")


def fits(name: str, shape: tuple[int, ...]) -> bool:
    """Whether a variable of a shape may be read at all.

    Raises
    ------
    ValueError
        It may not.
    """
    if math.prod(shape) > MOST:
        raise ValueError(f"`{name}` has {math.prod(shape)} elements")
    return True


def names(value: MatValue | None) -> list[str]:
    """A variable as texts: a character matrix, a cell array, or codes of characters."""
    if value is None:
        return []
    if isinstance(value, str):
        return [value.strip()]
    if isinstance(value, list):
        return [" ".join(names(each)) for each in value]
    if value.dtype.kind == "U":
        if value.ndim == 2 and value.size and np.char.str_len(value).max() <= 1:
            return ["".join(row).strip() for row in value]
        return [str(row).strip() for row in value.ravel()]
    if value.dtype.kind == "O":
        return [" ".join(names(_inner(each))) for each in value.ravel(order="F")]
    if value.dtype.kind not in "iuf":
        return []
    rows = np.atleast_2d(value)
    return ["".join(_sign(code) for code in row).strip() for row in rows]


def _inner(value: object) -> MatValue:
    return value if isinstance(value, (np.ndarray, str, list)) else str(value)


def _sign(code: float) -> str:
    return chr(int(code)) if np.isfinite(code) and 32 <= code < 0x110000 else ""
