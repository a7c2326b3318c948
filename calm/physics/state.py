"""Where a march stands, and the record it may leave."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from calm.physics.compiled import within
from calm.physics.line import Floats, Integers


class MarchError(ArithmeticError):
    """The march cannot go on: an element has no balance, or the line needs endless segments."""


State = tuple[float, float, float, float, float, float, float, int]
"""The point reached, x, y, z, fx, fy, fz, tz and level: its place [m], the force above it [N], the
last axis's rise, the interval of the water. A bare tuple: in CPython a named one costs as much as
half of a segment's balance."""

GOES_ON, RUNS_OFF, SEGMENT_UNBALANCED, ROD_UNBALANCED, ENDLESS, NO_ROOM = range(6)
"""Whether a march can go on, or why it cannot."""
FAILURES = (
    "",
    "the line runs off to infinity",
    "a segment finds no balance",
    "a rigid piece finds no balance",
    "the line would need more than 50000 segments",
    "there is no room for so many segments",
)
"""The same in words."""
NO_BALANCE = -2.0
"""In place of the strain of a segment, or of the rise of a rod, that finds no balance."""


Record = Any
"""Columns of numbers, as written by `write_node`: lists, or the rows of an array."""
COLUMNS = 10


@within
def write_node(record: Record, n: int, state: State) -> None:
    """Write node n: the place [m] and the force above it [N] of a state."""
    x, y, z, fx, fy, fz, _, _ = state
    record[0][n] = x
    record[1][n] = y
    record[2][n] = z
    record[3][n] = fx
    record[4][n] = fy
    record[5][n] = fz


@within
def write_element(
    record: Record, n: int, piece: int, clamp: int, cut: float, strain: float
) -> None:
    """Write the element that ends at node n; `clamp` is -1 for a part of the piece."""
    record[6][n] = piece
    record[7][n] = clamp
    record[8][n] = cut
    record[9][n] = strain


@dataclass(frozen=True)
class Trace:
    """What a recorded march leaves: k + 1 nodes and the k elements between, free end first.

    Attributes
    ----------
    position : (k+1, 3) [m]
    force : (k+1, 3) above each node [N]
    piece, clamp : (k,) the piece of each element, and the clamp that it is or -1
    cut : (k,) unstretched length [m]
    strain : (k,) of cables and chains
    """

    position: Floats
    force: Floats
    piece: Integers
    clamp: Integers
    cut: Floats
    strain: Floats

    @staticmethod
    def of(record: Record, nodes: int) -> Trace:
        """The trace of a record with so many nodes."""
        columns = np.array([column[:nodes] for column in record])
        return Trace(
            position=columns[:3].T.copy(),
            force=columns[3:6].T.copy(),
            piece=columns[6, 1:].astype(np.int64),
            clamp=columns[7, 1:].astype(np.int64),
            cut=columns[8, 1:],
            strain=columns[9, 1:],
        )
