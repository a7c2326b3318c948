"""Solver for block-tridiagonal linear systems, written in NumPy alone.

The system is divided into equal chunks. The interiors of all chunks are eliminated at once, each as
a small dense matrix with partial pivoting. The blocks between the chunks form a smaller
block-tridiagonal system, which is solved in the same way. Such systems arise for a chain of bars
and for a line in waves. SciPy has a banded solver, but takes longer to load than these systems take
to solve.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]

CHUNK = 6
"""Number of blocks eliminated together; the block after them stays in the reduced system."""
DENSE = 16
"""Largest number of blocks of a system that is solved as a single dense matrix."""


def solve_blocks(diagonal: Numbers, upper: Numbers, lower: Numbers, right: Numbers) -> Numbers:
    """Solve a block-tridiagonal system, or several systems of equal size.

    Parameters
    ----------
    diagonal : (..., n, b, b) blocks of the main diagonal, real or complex
    upper : (..., n-1, b, b) coupling of block i with block i + 1
    lower : (..., n-1, b, b) coupling of block i + 1 with block i
    right : (..., n, b, k) right-hand sides

    Returns
    -------
    Numbers
        (..., n, b, k) solution; NaN throughout if a matrix is singular.
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
    count, size = diagonal.shape[-3:-1]
    if count <= DENSE:
        return _densely(diagonal, upper, lower, right)
    step = CHUNK + 1
    chunks = -(-count // step)
    diagonal, right = _padded(diagonal, chunks * step, True), _padded(right, chunks * step, False)
    upper, lower = _padded(upper, chunks * step, False), _padded(lower, chunks * step, False)

    def chunked(blocks: Numbers) -> Numbers:
        return blocks.reshape(*blocks.shape[:-3], chunks, step, *blocks.shape[-2:])

    diagonals, uppers, lowers, rights = map(chunked, (diagonal, upper, lower, right))
    inside = _dense(
        diagonals[..., :-1, :, :], uppers[..., : CHUNK - 1, :, :], lowers[..., : CHUNK - 1, :, :]
    )
    # right-hand sides: the block above the chunk, the block below the chunk, the given right side
    beside = np.zeros((*inside.shape[:-1], 2 * size + right.shape[-1]), inside.dtype)
    beside[..., 1:, :size, :size] = lowers[..., :-1, -1, :, :]
    beside[..., -size:, size : 2 * size] = uppers[..., -2, :, :]
    beside[..., 2 * size :] = rights[..., :-1, :, :].reshape(*inside.shape[:-1], -1)
    interior = np.linalg.solve(inside, beside)
    by_above, by_below, alone = np.split(interior, (size, 2 * size), axis=-1)

    into, out = lowers[..., -2, :, :], uppers[..., :-1, -1, :, :]
    last, first = np.s_[..., -size:, :], np.s_[..., 1:, :size, :]
    least_diagonal = diagonals[..., -1, :, :] - into @ by_below[last]
    least_diagonal[..., :-1, :, :] -= out @ by_above[first]
    least_right = rights[..., -1, :, :] - into @ alone[last]
    least_right[..., :-1, :, :] -= out @ alone[first]
    between = _solved(
        least_diagonal,
        -out @ by_below[first],
        -into[..., 1:, :, :] @ by_above[..., 1:, -size:, :],
        least_right,
    )

    found = alone - by_below @ between
    found[..., 1:, :, :] -= by_above[..., 1:, :, :] @ between[..., :-1, :, :]
    whole = np.concatenate(
        [found.reshape(*rights[..., :-1, :, :].shape), between[..., np.newaxis, :, :]], axis=-3
    )
    return whole.reshape(*right.shape)[..., :count, :, :]


def _densely(diagonal: Numbers, upper: Numbers, lower: Numbers, right: Numbers) -> Numbers:
    flat = right.reshape(*right.shape[:-3], -1, right.shape[-1])
    return np.linalg.solve(_dense(diagonal, upper, lower), flat).reshape(right.shape)


def _dense(diagonal: Numbers, upper: Numbers, lower: Numbers) -> Numbers:
    """Return block-tridiagonal matrices in full (..., n b, n b)."""
    *many, count, size, _ = diagonal.shape
    matrix = np.zeros((*many, count, size, count, size), diagonal.dtype)
    for blocks, at in (
        (diagonal, matrix),
        (upper, matrix[..., :-1, :, 1:, :]),
        (lower, matrix[..., 1:, :, :-1, :]),
    ):
        np.einsum("...iaib->...iab", at)[...] = blocks  # a view
    return matrix.reshape(*many, count * size, count * size)


def _padded(blocks: Numbers, count: int, is_diagonal: bool) -> Numbers:
    """Extend blocks to a given number: the main diagonal with unit matrices, others with zeros."""
    padded = np.zeros((*blocks.shape[:-3], count, *blocks.shape[-2:]), blocks.dtype)
    there = blocks.shape[-3]
    padded[..., :there, :, :] = blocks
    if is_diagonal:
        padded[..., there:, :, :] = np.eye(blocks.shape[-1])
    return padded
