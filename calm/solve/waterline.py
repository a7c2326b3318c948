"""Where a towed cable leaves the water: there its load jumps, so a segment should end there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from calm.errors import NoEquilibrium
from calm.physics.state import MarchError, Trace
from calm.solve.problem import HALVED
from calm.solve.solution import Status
from calm.solve.towing import Towed

MOST_MOVES = 6
WIDEST_JUMP = 0.02
"""How far from a root that does not close its jump is sought, as a share of the line out."""
NARROW_JUMP = 1e-9
RIDE_CLEAR = "Pay out or take in some line, so that it is clear of the surface."


class Waterline:
    """Brings the node that is nearest to the surface there, shape after shape, by secants.

    A segment both in water and in air would count for one of them alone, and the same on coarse
    and on halved segments: an error that their difference does not show.

    Parameters
    ----------
    near : what is near enough [m]
    """

    def __init__(self, tow: Towed, near: float) -> None:
        self._tow, self._near = tow, near
        self._shift = self._height = 0.0
        self._moves = 0

    def moves(self, cuts: int, record: int) -> bool:
        """Shift that node along its cable, where it need and can be; whether it was."""
        tow, work = self._tow, self._tow.search.problem.work
        trace = Trace.of(work.records[record], tow.closed.nodes)
        heights, cut = trace.position[:, 2], trace.cut
        node = int(np.argmin(np.abs(heights)))
        height = float(heights[node])
        cable = tow.line.flexible[trace.piece] & (trace.clamp < 0)
        if abs(height) <= self._near or not 0 < node < len(cable) or self._moves == MOST_MOVES:
            return False
        if not (cable[node - 1] and cable[node]):
            return False
        here = slice(node - 1, node + 1)
        rise = float(heights[node + 1] - heights[node - 1]) / float(cut[here].sum())
        if self._shift and height != self._height:
            rise = (height - self._height) / self._shift
        shift = -height / rise if rise else 0.0
        if not -cut[node - 1] < shift < cut[node]:
            return False
        self._shift, self._height = shift, height
        self._moves += 1
        segment = int(cable[: node - 1].sum())
        if segment + 1 in np.cumsum(work.counts[cuts]):
            return False  # the next segment is another cable's
        lengths = work.halved if cuts == HALVED else work.chosen
        lengths[segment] += shift
        lengths[segment + 1] -= shift
        return True


def half_out(tow: Towed) -> NoEquilibrium | None:
    """Return why a tow does not close at a root where its miss jumps; None where it does not jump
    there.

    A rigid piece or a clamp is in the water or out of it, by its middle. Where the line is too
    high with one in the water and too low with it out, it would ride half out: no equilibrium.
    """
    root, span = tow.root, tow.span
    try:
        reach = 1e-4 * span
        while tow.miss(root.x - reach) < 0.0 or tow.miss(root.x + reach) > 0.0:
            reach *= 2.0
            if reach > WIDEST_JUMP * span:
                return None
        high, low = root.x - reach, root.x + reach
        while low - high > NARROW_JUMP * span:
            middle = 0.5 * (high + low)
            high, low = (middle, low) if tow.miss(middle) > 0.0 else (high, middle)
        jump = tow.miss(high), tow.miss(low)
        shapes = [tow.shape_at(x, tow.settings.angle_step) for x in (high, low)]
    except MarchError:
        return None
    above, below = (_middles(tow.line.flexible, shape) for shape in shapes)
    for (piece, clamp), height in above.items():
        if (height > 0.0) is not (below[piece, clamp] > 0.0):
            what = "{piece}" if clamp < 0 else "a clamp on {piece}"
            return Status.NO_EQUILIBRIUM.because(
                f"The line closes neither with {what} in the water nor with it out: its upper end "
                f"would be {jump[0]:.2g} m above the tow point or {-jump[1]:.2g} m below. It would "
                "ride half out of the water, which CALM does not solve.",
                piece,
                RIDE_CLEAR,
            )
    return None


def _middles(flexible: NDArray[np.bool_], shape: Trace) -> dict[tuple[int, int], float]:
    """Heights of the middles of rigid pieces and clamps [m], by piece and clamp."""
    single = np.flatnonzero(~flexible[shape.piece] | (shape.clamp >= 0))
    heights = 0.5 * (shape.position[single, 2] + shape.position[single + 1, 2])
    keys = zip(shape.piece[single].tolist(), shape.clamp[single].tolist(), strict=True)
    return dict(zip(keys, heights.tolist(), strict=True))
