"""Tables computed from a solution: the pieces, the clamps and the shape of a line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

from calm.case.line_figures import ClampFigures, LineFigures, NodeFigures
from calm.case.result_tables import (
    ClampRow,
    Clamps,
    ComponentRow,
    Components,
    LineEnd,
    OnAnchor,
    Shape,
)
from calm.files import Clamp, Piece
from calm.solve import Solution

T = TypeVar("T", Components, Clamps)


def components_of(
    pieces: Sequence[Piece], solution: Solution, still: Solution | None = None
) -> Components:
    """Build the table of the solved pieces, in file order.

    `pieces` excludes the anchor. `still` is the solution in still water, needed for the knockdown.
    """
    line = LineFigures(solution, still, pieces)
    return Components.made(pieces, lambda column: column.found and column.found(line))


def clamps_of(pieces: Sequence[Piece], solution: Solution, still: Solution | None = None) -> Clamps:
    """Build the table of the clamped instruments, in file order and down each piece."""
    held = ClampFigures(pieces, solution, still)
    return Clamps.made(held.clamps, lambda column: column.found and column.found(held))


def shape_of(solution: Solution) -> Shape:
    """Return the shape of the line as a table, node by node."""
    nodes = NodeFigures(solution)
    return Shape(**{one.name: one.found(nodes) for one in Shape.columns() if one.found})


def with_anchor(above: Components, anchor: Piece, depth: float) -> Components:
    """Append the row of the anchor to the components; the anchor stands upright below the line."""
    end = LineEnd(above.rows(slice(-1, None))[0], anchor, depth)
    return Components.joined([above, _standing(Components, anchor, end)])


def on_anchor(clamp: Clamp, anchor: ComponentRow) -> ClampRow:
    """Build the row of a clamp on the anchor."""
    return _standing(Clamps, clamp, OnAnchor(clamp, anchor))[0]


def _standing(table: type[T], part: Piece | Clamp, end: LineEnd | OnAnchor) -> T:
    return table.made([part], lambda column: np.array([column.at_anchor and column.at_anchor(end)]))
