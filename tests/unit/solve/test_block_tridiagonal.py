"""Block-tridiagonal systems against LAPACK."""

import numpy as np
import pytest
from scipy.linalg import solve_banded

from calm.solve.block_tridiagonal import solve_blocks


def banded(diagonal, upper, lower):
    """One such matrix as `scipy.linalg.solve_banded` takes it."""
    count, size, _ = diagonal.shape
    side = 2 * size - 1
    bands = np.zeros((2 * side + 1, count * size), diagonal.dtype)
    for blocks, down, right in ((diagonal, 0, 0), (upper, 0, 1), (lower, 1, 0)):
        for number, block in enumerate(blocks):
            for (i, j), value in np.ndenumerate(block):
                row, column = (number + down) * size + i, (number + right) * size + j
                bands[side + row - column, column] = value
    return side, bands


@pytest.mark.parametrize("count", [1, 2, 10, 11, 14, 15, 71, 150])
@pytest.mark.parametrize("is_complex", [False, True])
def test_solutions_are_those_of_a_banded_solver(count, is_complex):
    random = np.random.default_rng(count)

    def drawn(*shape):
        values = random.normal(size=shape)
        return values + 1j * random.normal(size=shape) if is_complex else values

    diagonal, right = drawn(3, count, 4, 4), drawn(3, count, 4, 1)
    upper, lower = drawn(3, count - 1, 4, 4), drawn(3, count - 1, 4, 4)
    found = solve_blocks(diagonal, upper, lower, right)
    for one in range(3):
        side, bands = banded(diagonal[one], upper[one], lower[one])
        wanted = solve_banded((side, side), bands, right[one].reshape(-1))
        assert found[one].reshape(-1) == pytest.approx(wanted, rel=1e-9, abs=1e-9)


def test_a_singular_chunk_of_a_regular_matrix_is_no_obstacle():
    """A block of zeros, held by its neighbours alone."""
    count = 30
    diagonal = np.tile(np.eye(2), (count, 1, 1))
    diagonal[0] = 0.0
    upper, lower = np.tile(np.eye(2), (2, count - 1, 1, 1))
    upper[1:] = lower[1:] = 0.0
    right = np.arange(2.0 * count).reshape(count, 2, 1)
    found = solve_blocks(diagonal, upper, lower, right)
    assert found[:2, :, 0].tolist() == [[2.0, 2.0], [0.0, 1.0]]


def test_a_singular_matrix_gives_nan():
    diagonal = np.zeros((30, 2, 2))
    found = solve_blocks(diagonal, diagonal[1:], diagonal[1:], np.ones((30, 2, 1)))
    assert np.isnan(found).all()
