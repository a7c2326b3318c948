"""Shapes near a solved one, so alike in their segments that their differences are derivatives.

Two independent solves cut a line differently and differ by their truncation errors too, which
drowns a small change. Here every neighbour keeps the cuts of the first shape and starts at its
root: two or three marches close it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Line, Water
from calm.physics.state import MarchError
from calm.physics.track import Track
from calm.solve.closing import Closed, Closing
from calm.solve.locate import locate
from calm.solve.mooring import solve_mooring
from calm.solve.solution import Settings, nodes_of
from calm.solve.status import Status


class Nearby:
    """A moored line and the lines that differ a little from it.

    Parameters
    ----------
    line, water, settings : as of `solve_mooring`; a tight `tolerance` lets small changes be seen

    Raises
    ------
    NoEquilibrium
        As `solve_mooring` does.
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        lands = solve_mooring(line, water, settings).landed
        self._water, self._settings = water, settings
        closing = Closing(line, water, settings)
        try:
            root, _ = locate(closing, lands)
            self._root, self._cuts = closing.planned(root, settings.angle_step)
            closed = closing.polish(self._root, self._cuts)
        except MarchError as error:
            raise _stopped(error) from error
        self._root, self._trace = closed.root, closed.trace

    def node(self, piece: int, clamp: int = -1) -> int:
        """The node at the top of a piece, or at a clamp, in every one of these shapes."""
        if clamp >= 0:
            return int(np.argmax(self._trace.clamp == clamp))
        return int(np.argmax(self._trace.piece == piece))

    def shape(self, line: Line) -> tuple[Floats, float]:
        """Nodes of a line that differs in its forces alone, and its buoyancy in use.

        Returns
        -------
        (k+1, 3) east and north of the anchor, up from the surface [m]; and the share in use of
        the buoyancy of the floats at the surface, 1 below it.

        Raises
        ------
        NoEquilibrium
            ``not-converged`` or ``slack``.
        """
        closing = Closing(line, self._water, self._settings)
        unknown = replace(self._root.unknown, track=Track.of(line))
        try:
            closed = closing.polish(replace(self._root, unknown=unknown), self._cuts)
        except MarchError as error:
            raise _stopped(error) from error
        position, _ = nodes_of(closed.trace)
        return position, _used(closed, line)


def _stopped(error: MarchError) -> NoEquilibrium:
    return Status.NOT_CONVERGED.because(f"The march stopped: {error}.")


def _used(closed: Closed, line: Line) -> float:
    shares = closed.root.unknown.shares(closed.root.x)
    if not shares:
        return 1.0
    buoyancy = {piece: float(line.buoyancy[piece]) for piece in shares}
    used = sum(share * buoyancy[piece] for piece, share in shares.items())
    return used / sum(buoyancy.values())
