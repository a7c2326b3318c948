"""The equations of a step as a band: nodes and bars in turn, three and one unknown each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from calm.physics.line import Floats, Integers

_SIDE = 6
"""Diagonals of the band on either side."""


@dataclass(frozen=True)
class Band:
    """Where the blocks of a chain's matrix stand.

    Attributes
    ----------
    bars : how many the chain has
    fixed : rows of the unknowns that are known
    """

    bars: int
    fixed: tuple[int, ...]

    def solved(
        self,
        residual: Floats,
        diagonal: Floats,
        beside: tuple[Floats, Floats],
        axis: Floats,
        slack: Floats,
    ) -> Floats:
        """(4 n + 3,) what the nodes and tensions are too much by.

        Parameters
        ----------
        residual : (n+1, 4) of the forces on the nodes and of the lengths of the bars
        diagonal : (n+1, 3, 3) change of the force on a node with its own place
        beside : (n, 3, 3) each; that on the node above with the place of the one below, and the
            other way round
        axis : (n, 3) of the bars, downward
        slack : (n,) by how much a bar is longer with its tension, negative
        """
        from scipy.linalg import solve_banded

        size = 4 * self.bars + 3
        band = np.zeros((2 * _SIDE + 1, size))
        flat = band.reshape(-1)
        blocks = (diagonal, *beside, axis, -axis, -axis, axis)
        for places, block in zip(self._places, blocks, strict=True):
            flat[places] = block
        band[_SIDE, 3::4] = slack
        equations = residual.reshape(-1)[:-1]
        for row in self.fixed:
            columns = np.arange(max(row - _SIDE, 0), min(row + _SIDE + 1, size))
            band[_SIDE + row - columns, columns] = 0.0
            band[_SIDE, row], equations[row] = 1.0, 0.0
        change: Floats = solve_banded(
            (_SIDE, _SIDE), band, equations, overwrite_ab=True, overwrite_b=True,
            check_finite=False,
        )  # fmt: skip
        return change

    @cached_property
    def _places(self) -> tuple[Integers, ...]:
        """Where the blocks stand in the band, flat."""
        width = 4 * self.bars + 3
        node = 4 * np.arange(self.bars + 1)[:, np.newaxis] + np.arange(3)
        pull = 4 * np.arange(self.bars)[:, np.newaxis] + 3

        def at(row: Integers, column: Integers) -> Integers:
            return (_SIDE + row - column) * width + column

        above, below = node[:-1], node[1:]
        return (
            at(node[:, :, np.newaxis], node[:, np.newaxis]),
            at(above[:, :, np.newaxis], below[:, np.newaxis]),
            at(below[:, :, np.newaxis], above[:, np.newaxis]),
            at(above, pull),
            at(below, pull),
            at(pull, above),
            at(pull, below),
        )
