"""Where a towed cable leaves the water: there its load jumps, so a segment should end there."""

from __future__ import annotations

import numpy as np

from calm.physics.march import Cuts
from calm.solve.closing import Closed, Closing

MOST_MOVES = 6


class Waterline:
    """Brings the node that is nearest to the surface there, shape after shape, by secants.

    A segment both in water and in air would count for one of them alone, and the same on coarse
    and on halved segments: an error that their difference does not show.

    Parameters
    ----------
    near : what is near enough [m]
    """

    def __init__(self, closing: Closing, near: float) -> None:
        self._line, self._near = closing.line, near
        self._shift = self._height = 0.0
        self._moves = 0

    def moved(self, closed: Closed) -> Cuts | None:
        """The cuts with that node shifted along its cable; None where it need or can not be."""
        trace = closed.trace
        heights, cut = trace.position[:, 2], trace.cut
        node = int(np.argmin(np.abs(heights)))
        height = float(heights[node])
        cable = self._line.flexible[trace.piece] & (trace.clamp < 0)
        if abs(height) <= self._near or not 0 < node < len(cable) or self._moves == MOST_MOVES:
            return None
        if not (cable[node - 1] and cable[node]):
            return None
        here = slice(node - 1, node + 1)
        rise = float(heights[node + 1] - heights[node - 1]) / float(cut[here].sum())
        if self._shift and height != self._height:
            rise = (height - self._height) / self._shift
        shift = -height / rise if rise else 0.0
        if not -cut[node - 1] < shift < cut[node]:
            return None
        self._shift, self._height = shift, height
        self._moves += 1
        return _shifted(closed.end.cuts, int(cable[: node - 1].sum()), shift)


def _shifted(cuts: Cuts, segment: int, shift: float) -> Cuts | None:
    """The cuts with one segment longer and the next shorter; None where that is another cable's."""
    if segment + 1 in np.cumsum(cuts.counts):
        return None
    lengths = cuts.lengths.copy()
    lengths[segment : segment + 2] += shift, -shift
    return cuts._replace(lengths=lengths)
