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
from calm.physics.march import Cuts
from calm.physics.state import MarchError
from calm.physics.track import Track
from calm.solve.closing import Closed, Closing
from calm.solve.finish import finished
from calm.solve.locate import locate
from calm.solve.mooring import refuse_out_of_the_water, solve_mooring
from calm.solve.refine import Refined
from calm.solve.solution import Settings, Solution, nodes_of
from calm.solve.status import Status


class Nearby:
    """A moored line and the lines that differ a little from it.

    Parameters
    ----------
    line, water, settings : as of `solve_mooring`; a tight `tolerance` lets small changes be seen

    Attributes
    ----------
    solution : of the line itself

    Raises
    ------
    NoEquilibrium
        As `solve_mooring` does.
    """

    def __init__(self, line: Line, water: Water, settings: Settings) -> None:
        self.solution = solve_mooring(line, water, settings)
        lands = self.solution.landed
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
        """Nodes of a line that differs a little, and its buoyancy in use.

        Returns
        -------
        (k+1, 3) east and north of the anchor, up from the surface [m]; and the share in use of
        the buoyancy of the floats at the surface, 1 below it.

        Raises
        ------
        NoEquilibrium
            ``not-converged`` or ``slack``.
        """
        _, closed = self._closed(line, self._water)
        position, _ = nodes_of(closed.trace)
        return position, _used(closed, line)

    def solved(self, line: Line, water: Water, track: Track | None = None) -> Solution:
        """The solution of a line that differs, on the cuts of this one.

        Its errors are stated as those of this one, whose cuts it has.

        Parameters
        ----------
        line, water : of the same pieces, all cables longer by one factor
        track : the line laid out, where it is known

        Raises
        ------
        NoEquilibrium
            Where there is none that passes every check, or none of the same kind near by.
        """
        closing, closed = self._closed(line, water, track)
        base = self.solution
        if closed.end.landed != base.landed:
            raise Status.NOT_CONVERGED.because("It lies on the seabed, or hangs, unlike the other.")
        errors = (base.depth_error, base.tension_error, base.lift_error, base.pull_error)
        return finished(closing, Refined(closed, *errors), None, refuse_out_of_the_water)

    def _closed(
        self, line: Line, water: Water, track: Track | None = None
    ) -> tuple[Closing, Closed]:
        closing = Closing(line, water, self._settings)
        root, deeper = self._root, water.depth - self._water.depth
        unknown = replace(
            root.unknown,
            track=track or Track.of(line),
            goal=root.unknown.goal - deeper,
            floating=None if root.unknown.floating is None else line.floating,
        )
        if unknown.afloat is None:
            root = replace(root, x=max(root.x + deeper, 0.0))
        given = self.solution.line
        cables = line.flexible
        longer = line.length[cables].sum() / given.length[cables].sum() if cables.any() else 1.0
        cuts = Cuts(longer * self._cuts.lengths, self._cuts.counts)
        try:
            return closing, closing.polish(replace(root, unknown=unknown), cuts)
        except MarchError as error:
            raise _stopped(error) from error


def _stopped(error: MarchError) -> NoEquilibrium:
    return Status.NOT_CONVERGED.because(f"The march stopped: {error}.")


def _used(closed: Closed, line: Line) -> float:
    shares = closed.root.unknown.shares(closed.root.x)
    if not shares:
        return 1.0
    buoyancy = {piece: float(line.buoyancy[piece]) for piece in shares}
    used = sum(share * buoyancy[piece] for piece, share in shares.items())
    return used / sum(buoyancy.values())
