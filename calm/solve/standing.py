"""Whether the buoyancy of a line holds it up."""

from __future__ import annotations

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.line import Line
from calm.solve.status import Status


def too_heavy(line: Line) -> NoEquilibrium:
    """The exception for a line whose buoyancy does not hold it up."""
    total = line.total_buoyancy
    lift, weight = float(total[total > 0].sum()), float(-total[total < 0].sum())
    return Status.NO_EQUILIBRIUM.because(
        f"Too little buoyancy to hold the line up: its buoyant pieces lift {lift:.0f} N, the "
        f"others weigh {weight:.0f} N in water."
    )


def refuse_folded(line: Line) -> None:
    """Refuse a line that folds in still water: once held up it must stay so to its lowest float.

    Raises
    ------
    NoEquilibrium
        ``slack``, or ``no-equilibrium`` where too little holds the line up.
    """
    total = line.total_buoyancy
    above = np.cumsum(total)
    if not (above > 0.0).any():
        raise too_heavy(line)
    first, last = int(np.argmax(above > 0.0)), int(np.flatnonzero(total > 0.0)[-1])
    short = np.flatnonzero(above[first:last] <= 0.0)
    if len(short) and float(total.sum()) <= 0.0:
        raise too_heavy(line)
    if len(short):
        piece = first + int(short[0])
        raise Status.SLACK.because(
            f"In still water the line is slack below piece {piece + 1}: {-above[piece]:.0f} N are "
            "lacking to hold up what is above.",
            piece,
        )
