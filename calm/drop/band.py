"""The matrix of a chain in motion: a band, whose unknowns are its nodes and tensions in turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgbsv

from calm.physics.line import Floats, Integers

_SIDE = 6
"""Diagonals of the band on either side."""
_MIDDLE = 2 * _SIDE
"""Row of the main diagonal; those above the band are for the factors."""
_ROWS = 3 * _SIDE + 1


@dataclass(frozen=True)
class Band:
    """Where the blocks of the matrix of a chain of some bars stand."""

    bars: int

    def solved(
        self,
        residual: Floats,
        diagonal: Floats,
        beside: tuple[Floats, Floats],
        axis: Floats,
        slack: Floats,
        fixed: tuple[int, ...],
    ) -> Floats:
        """(n+1, 4) what the nodes and tensions are too much by; 0 at the very last.

        Parameters
        ----------
        residual : (4, n+1) of the forces on the nodes and of the lengths of the bars
        diagonal : (3, 3, n+1) change of the force on a node with its own place
        beside : (3, 3, n) each; that on the node above with the place of the one below, and the
            other way round
        axis : (3, n) of the bars, downward
        slack : (n,) by how much a bar is longer with its tension, negative
        fixed : rows of the unknowns that are known
        """
        size = 4 * self.bars + 4
        band = np.zeros((size, _ROWS))
        blocks = (diagonal, *beside, axis, -axis, -axis, axis, slack)
        band.reshape(-1)[self._places] = np.concatenate([block.reshape(-1) for block in blocks])
        equations = residual.T.reshape(-1)
        band[-1, _MIDDLE], equations[-1] = 1.0, 0.0
        for row in fixed:
            columns = np.arange(max(row - _SIDE, 0), min(row + _SIDE + 1, size))
            band[columns, _MIDDLE + row - columns] = 0.0
            band[row, _MIDDLE], equations[row] = 1.0, 0.0
        _, _, change, singular = dgbsv(
            _SIDE, _SIDE, band.T, equations, overwrite_ab=True, overwrite_b=True
        )
        found: Floats = change.reshape(-1, 4)
        return np.full_like(found, np.nan) if singular else found

    @cached_property
    def _places(self) -> Integers:
        """Where the blocks stand in the band, one column after another."""
        node = np.arange(3)[:, np.newaxis] + 4 * np.arange(self.bars + 1)
        pull = 4 * np.arange(self.bars) + 3
        above, below = node[:, :-1], node[:, 1:]
        rows_and_columns = (
            (node[:, np.newaxis], node),
            (above[:, np.newaxis], below),
            (below[:, np.newaxis], above),
            (above, pull),
            (below, pull),
            (pull, above),
            (pull, below),
            (pull, pull),
        )
        return np.concatenate(
            [
                (column * _ROWS + _MIDDLE + row - column).reshape(-1)
                for row, column in rows_and_columns
            ]
        )
