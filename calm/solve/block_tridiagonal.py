"""Solver for block-tridiagonal linear systems, written in NumPy alone.

The interiors of equal chunks of the system are eliminated at once, with partial pivoting in each
chunk. The blocks between the chunks form a smaller system of the same kind.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]

CHUNK = 4
"""Number of successive blocks that are eliminated together.

The next block becomes a block of the smaller system.
"""
DENSE = 20
"""Largest number of blocks of a system that is solved as a single dense matrix."""


def solve_blocks(diagonal: Numbers, upper: Numbers, lower: Numbers, right: Numbers) -> Numbers:
    """Solve a block-tridiagonal system, or several systems of equal size.

    Parameters
    ----------
    diagonal : (..., n, b, b) blocks of the main diagonal, real or complex
    upper : (..., n-1, b, b) blocks in row i that multiply the unknowns of row i + 1
    lower : (..., n-1, b, b) blocks in row i + 1 that multiply the unknowns of row i
    right : (..., n, b, k) right-hand sides

    Returns
    -------
    Numbers
        (..., n, b, k) solution; NaN if a matrix is singular.
    """
    try:
        return _solved(diagonal, upper, lower, right)
    except np.linalg.LinAlgError:  # a chunk is singular, though the whole may not be
        pass
    try:
        return _densely(diagonal, upper, lower, right)
    except np.linalg.LinAlgError:
        return np.full_like(right, np.nan)


def _solved(diagonal: Numbers, upper: Numbers, lower: Numbers, right: Numbers) -> Numbers:
    *many, count, size, columns = right.shape
    if count <= DENSE:
        return _densely(diagonal, upper, lower, right)
    layout = _layout(count, size, columns)
    rows = np.zeros((*many, layout.chunks * (CHUNK + 1) * size * layout.width), right.dtype)
    rows[..., layout.places] = np.concatenate(
        [part.reshape(*many, -1) for part in (diagonal, upper, lower, right)], axis=-1
    )
    rows[..., layout.padding] = 1.0
    rows = rows.reshape(*many, layout.chunks, (CHUNK + 1) * size, layout.width)

    inside = CHUNK * size
    interior, last = rows[..., :inside, :], rows[..., inside:, :]
    above, at_last, sides = slice(size), slice(size, 2 * size), slice(2 * size, None)
    solved = np.linalg.solve(interior[..., :inside], interior[..., inside:-size])
    into = last[..., inside - size : inside] @ solved[..., -size:, :]
    out = last[..., :-1, :, -size:] @ solved[..., 1:, :size, :]
    least = last[..., inside:-size] - into
    least[..., :-1, :, at_last] -= out[..., above]
    least[..., :-1, :, sides] -= out[..., sides]
    between = _solved(
        least[..., at_last], -out[..., at_last], least[..., 1:, :, above], least[..., sides]
    )

    found = solved[..., sides] - solved[..., at_last] @ between
    found[..., 1:, :, :] -= solved[..., 1:, :, above] @ between[..., :-1, :, :]
    whole = np.concatenate([found, between], axis=-2)
    return whole.reshape(*many, -1, size, columns)[..., :count, :, :]


class _Layout(NamedTuple):
    """Positions of a system's entries in an array with one matrix per chunk of blocks.

    The rows of a matrix belong to the blocks of one chunk. Its columns belong, in this order, to

    - the blocks of the chunk except the last,
    - the last block of the chunk above,
    - the last block of this chunk,
    - the right-hand sides,
    - the block below.

    Attributes
    ----------
    chunks, width : number of matrices, and of their columns
    places : flat indices of the diagonal, upper, lower and right-hand entries
    padding : flat indices of the diagonal entries that fill up the last chunk
    """

    chunks: int
    width: int
    places: Numbers
    padding: Numbers


@lru_cache(maxsize=64)
def _layout(count: int, size: int, columns: int) -> _Layout:
    step, inside = CHUNK + 1, CHUNK * size
    chunks, width = -(-count // step), inside + 3 * size + columns
    block = np.arange(chunks * step)
    within = block % step
    own = np.where(within < CHUNK, within * size, inside + size)
    before = np.where(within > 0, (within - 1) * size, inside)
    after = np.where(within < CHUNK, np.append(own[1:], 0), width - size)
    across = np.arange(size)
    row = (block[:, np.newaxis] * size + across) * width

    def places(first: Numbers, wide: int) -> Numbers:
        return row[..., np.newaxis] + first[:, np.newaxis, np.newaxis] + np.arange(wide)

    diagonal = places(own, size)
    right = places(np.full_like(own, inside + 2 * size), columns)
    given = (
        diagonal[:count],
        places(after, size)[: count - 1],
        places(before, size)[1:count],
        right[:count],
    )
    padding = diagonal[count:, across, across].ravel()
    return _Layout(chunks, width, np.concatenate([part.ravel() for part in given]), padding)


def _densely(diagonal: Numbers, upper: Numbers, lower: Numbers, right: Numbers) -> Numbers:
    flat = right.reshape(*right.shape[:-3], -1, right.shape[-1])
    return np.linalg.solve(_dense(diagonal, upper, lower), flat).reshape(right.shape)


def _dense(diagonal: Numbers, upper: Numbers, lower: Numbers) -> Numbers:
    """Convert block-tridiagonal matrices to full matrices (..., n b, n b)."""
    *many, count, size, _ = diagonal.shape
    matrix = np.zeros((*many, count, size, count, size), diagonal.dtype)
    for blocks, at in (
        (diagonal, matrix),
        (upper, matrix[..., :-1, :, 1:, :]),
        (lower, matrix[..., 1:, :, :-1, :]),
    ):
        np.einsum("...iaib->...iab", at)[...] = blocks  # a view
    return matrix.reshape(*many, count * size, count * size)
