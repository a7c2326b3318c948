"""Arrays of values on a solved line, for the result tables of pieces, clamps and nodes.

Pieces are in the order of the file, without the anchor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from calm.files import Clamp, Piece
from calm.files.pieces import clamps_in
from calm.physics.line import Floats, Integers
from calm.physics.track import head_count
from calm.solve import Solution


class LineFigures:
    """Columns of the n pieces of a solved line.

    Attributes
    ----------
    solution, still : solutions in the current and in still water; `still` is needed for the
        knockdown
    pieces : (n,) pieces of the file; needed for `index` and `reynolds` only
    upper, lower : (n,) indices of the nodes at the ends of each piece, in the order of the file
    top, bottom : (n, 3) positions of these nodes: east, north, up [m]
    """

    def __init__(
        self, solution: Solution, still: Solution | None = None, pieces: Sequence[Piece] = ()
    ) -> None:
        self.solution, self.still, self.pieces = solution, still, pieces
        self._ahead = slice(None, None, -1) if solution.line.towed else slice(None)
        self._first, self._last = solution.piece_nodes.T
        ends = (self._last, self._first) if solution.line.towed else (self._first, self._last)
        self.upper, self.lower = ends[0][self._ahead], ends[1][self._ahead]
        self.top, self.bottom = solution.position[self.upper], solution.position[self.lower]

    @property
    def count(self) -> int:
        """Number of pieces."""
        return len(self.upper)

    @property
    def index(self) -> Integers:
        """(n,) index of each piece in the file."""
        return np.array([piece.index for piece in self.pieces])

    @cached_property
    def length(self) -> Floats:
        """(n,) stretched lengths [m]."""
        stretched, solution = np.zeros(self.count), self.solution
        np.add.at(stretched, solution.element_piece, solution.cut * (1.0 + solution.strain))
        return stretched[self._ahead]

    @property
    def cut_length(self) -> Floats:
        """(n,) unstretched lengths [m]."""
        return self.solution.line.length[self._ahead]

    @property
    def tension_top(self) -> Floats:
        """(n,) tensions at the `upper` nodes of the pieces [N]."""
        tension: Floats = self.solution.tension[self.upper]
        return tension

    @property
    def tension_bottom(self) -> Floats:
        """(n,) tensions at the `lower` nodes of the pieces [N]."""
        tension: Floats = self.solution.tension[self.lower]
        return tension

    @property
    def greatest_tension(self) -> Floats:
        """(n,) maximum tension in each piece [N]."""
        tension = self.solution.tension
        within = np.maximum.reduceat(tension[:-1], self._first)
        greatest: Floats = np.maximum(within, tension[self._last])[self._ahead]
        return greatest

    @property
    def least_tension(self) -> Floats:
        """(n,) minimum tension in the suspended part of each piece [N], or NaN for a piece entirely
        on the seabed.
        """
        tension = self.solution.tension
        hanging = np.where(np.arange(len(tension)) <= self.solution.hanging, tension, np.inf)
        within = np.minimum.reduceat(hanging[:-1], self._first)
        least = np.minimum(within, hanging[self._last])[self._ahead]
        return np.where(np.isfinite(least), least, np.nan)

    @cached_property
    def tilt(self) -> Floats:
        """(n,) angle between the vertical and the straight line through the ends of each piece
        [degrees].

        The tilt of a piece without length is the angle of the tension. Rigid pieces at the head of
        the line form one rod and have the same tilt.
        """
        solution, chord = self.solution, self.top - self.bottom
        pull = solution.force[self.upper] + solution.force[self.lower]
        lean = np.where(
            np.linalg.norm(chord, axis=1) > 0,
            leaning_of(chord),
            leaning_of(-pull if solution.line.towed else pull),
        )
        head = 0 if solution.pulled else head_count(solution.line)
        if head and (self.top[0] != self.bottom[head - 1]).any():
            lean[:head] = leaning_of(self.top[0] - self.bottom[head - 1])
        return lean

    @property
    def knockdown(self) -> Floats:
        """(n,) knockdown [m], or NaN if there is no solution in still water."""
        if self.still is None:
            return np.full(self.count, np.nan)
        before = self.still.piece_nodes[self._ahead, 1 if self.solution.line.towed else 0]
        knockdown: Floats = self.still.position[before, 2] - self.top[:, 2]
        return knockdown

    @property
    def reynolds(self) -> Floats:
        """(n,) largest Reynolds number of each piece, or NaN if the diameter is unknown."""
        solution = self.solution
        middle = -0.5 * (solution.position[:-1] + solution.position[1:])[:, 2]
        speed = np.linalg.norm(solution.water.current_at(middle), axis=1)
        greatest = np.zeros(self.count)
        np.maximum.at(greatest, solution.element_piece, speed / solution.water.viscosity_at(middle))
        return greatest[self._ahead] * catalogue_figures(self.pieces, "diameter")


class ClampFigures:
    """Columns of the m clamped instruments of a solved line, in file order.

    Attributes
    ----------
    index : (m,) index of the piece that carries each clamp
    position : (m, 3) east, north, up [m]
    """

    def __init__(
        self, pieces: Sequence[Piece], solution: Solution, still: Solution | None = None
    ) -> None:
        self.solution, self.still = solution, still
        order = clamps_in(pieces)
        elements = np.flatnonzero(solution.element_clamp >= 0)
        self.index: Integers = solution.element_piece[elements]
        if solution.line.towed:
            elements = elements[::-1]
            self.index = len(pieces) - 1 - self.index[::-1]
        self.clamps = [order[which] for which in solution.element_clamp[elements]]
        self.position, self._elements = solution.position[elements], elements

    @property
    def tension(self) -> Floats:
        """(m,) larger of the tensions above and below the clamp [N]."""
        tension = self.solution.tension
        return np.maximum(tension[self._elements], tension[self._elements + 1])

    @property
    def tilt(self) -> Floats:
        """(m,) tilt [degrees].

        A clamp on a rigid piece has the tilt of the piece. A clamp on a cable or chain has the
        angle of the mean tension above and below the clamp.
        """
        solution, elements = self.solution, self._elements
        pull = solution.force[elements] + solution.force[elements + 1]
        cable = solution.line.flexible[solution.element_piece[elements]]
        tilt = leaning_of(-pull if solution.line.towed else pull)
        return (
            tilt if cable.all() else np.where(cable, tilt, LineFigures(solution).tilt[self.index])
        )

    @property
    def knockdown(self) -> Floats:
        """(m,) knockdown [m], or NaN if there is no solution in still water."""
        if self.still is None:
            return np.full(len(self._elements), np.nan)
        before = self.still.position[np.flatnonzero(self.still.element_clamp >= 0)]
        ahead = slice(None, None, -1) if self.solution.line.towed else slice(None)
        return before[ahead, 2] - self.position[:, 2]


@dataclass(frozen=True)
class NodeFigures:
    """Columns of the k nodes of a solved line, free end first."""

    solution: Solution

    @property
    def position(self) -> Floats:
        """(k, 3) positions: east, north, up [m]."""
        return self.solution.position

    @property
    def tension(self) -> Floats:
        """(k,) tensions [N]."""
        return self.solution.tension

    @property
    def tilt(self) -> Floats:
        """(k,) angle from the vertical of the segment between each node and the node before it
        [degrees].

        The first node has the angle of the first segment.
        """
        chord = self.solution.position[:-1] - self.solution.position[1:]
        if self.solution.line.towed:
            chord = -chord
        lengthy = np.linalg.norm(chord, axis=1) > 0
        # a segment without length takes the angle of the segment above; at the top of the line,
        # it takes the angle of the segment below
        last = np.maximum.accumulate(np.where(lengthy, np.arange(len(chord)), -1))
        first = int(np.argmax(lengthy))
        leaning = leaning_of(chord)[np.where(last >= 0, last, first)]
        return np.concatenate([leaning[:1], leaning])


def leaning_of(vector: Floats) -> Floats:
    """Return the angle of vectors (..., 3) from the upward vertical [degrees]; 0 for a zero
    vector.
    """
    horizontal = np.hypot(vector[..., 0], vector[..., 1])
    tilt: Floats = np.degrees(np.arctan2(horizontal, vector[..., 2]))
    return np.where((horizontal > 0) | (vector[..., 2] != 0), tilt, 0.0)


def catalogue_figures(parts: Sequence[Piece | Clamp], name: str) -> Floats:
    """Return (n,) values of a catalogue field for pieces or clamps, or NaN for unknown values."""
    values = [getattr(part.component, name, None) for part in parts]
    return np.array([np.nan if value is None else value for value in values])
