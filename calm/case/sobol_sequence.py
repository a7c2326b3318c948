"""Scrambled Sobol' sequences, with the same numbers as `scipy.stats.qmc.Sobol`.

SciPy's statistics take a third of a second to load, as long as a hundred draws are solved.

Sources: direction numbers of Joe and Kuo, SIAM Journal on Scientific Computing 30 (2008),
2635-2654; scrambling by random lower triangular matrices and a digital shift, Matousek, Journal of
Complexity 14 (1998), 527-556.
"""

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats

BITS = 30
"""Number of binary digits of a number; the longest sequence has 2^BITS numbers."""

_STARTS = (
    (1, (1,)), (3, (1,)), (7, (1, 3)), (11, (1, 3, 1)), (13, (1, 1, 1)), (19, (1, 1, 3, 3)),
    (25, (1, 3, 5, 13)), (37, (1, 1, 5, 5, 17)), (41, (1, 1, 5, 5, 5)),
)  # fmt: skip
"""Primitive polynomial and first direction numbers of each dimension."""

MOST_DIMENSIONS = len(_STARTS)


def scrambled(count: int, dimensions: int, seed: int) -> Floats:
    """Return the first numbers (count, dimensions) of a scrambled sequence, from 0 to below 1.

    Parameters
    ----------
    count : length of the sequence; a power of two balances it
    dimensions : at most `MOST_DIMENSIONS`
    seed : seed of the scrambling
    """
    random = np.random.default_rng(seed)
    powers = np.uint32(1) << np.arange(BITS, dtype=np.uint32)
    shift = random.integers(2, size=(dimensions, BITS), dtype=np.uint32) @ powers
    mixing = np.tril(random.integers(2, size=(dimensions, BITS, BITS), dtype=np.uint32), -1)
    mixing += np.eye(BITS, dtype=np.uint32)
    numbers = np.array([_direction_numbers(*start) for start in _STARTS[:dimensions]], np.uint32)
    digits = (numbers[:, np.newaxis] >> np.arange(BITS, dtype=np.uint32)[::-1, np.newaxis]) & 1
    directions = np.einsum("dpj,p->dj", (mixing @ digits) % 2, powers[::-1])
    place = np.arange(count, dtype=np.uint32)
    gray = place ^ (place >> np.uint32(1))
    points: NDArray[np.uint32] = np.tile(shift, (count, 1))
    for bit in range(max(count - 1, 0).bit_length()):
        points ^= ((gray >> np.uint32(bit)) & np.uint32(1))[:, np.newaxis] * directions[:, bit]
    return points / float(1 << BITS)


def _direction_numbers(polynomial: int, first: tuple[int, ...]) -> list[int]:
    """Return the direction numbers of a dimension, with `BITS` binary digits each."""
    degree = polynomial.bit_length() - 1
    if not degree:  # the first dimension is van der Corput's sequence
        return [1 << (BITS - 1 - j) for j in range(BITS)]
    numbers = list(first)
    for j in range(degree, BITS):
        number = numbers[j - degree]
        for k in range(1, degree + 1):
            if polynomial >> (degree - k) & 1:
                number ^= numbers[j - k] << k
        numbers.append(number)
    return [number << (BITS - 1 - j) for j, number in enumerate(numbers)]
