"""Back-up buoyancy: whether what holds the release comes up when the line breaks above it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.checks.slack import release_of
from calm.errors import NoEquilibrium
from calm.solve.standing import standing_lift

if TYPE_CHECKING:
    from calm.case import Mooring

LEAST_MARGIN = 250.0
"""Net buoyancy that is asked for after any break, however little hangs on it [N]."""


@dataclass(frozen=True)
class Break:
    """A break of the line below one of its pieces.

    Attributes
    ----------
    break_after, label : the piece above the break
    margin : net buoyancy of the pieces from below the break down to the release [N]
    weight_lifted : weight in water of those of them that are heavy [N]
    required : what the margin should be [N]
    floats_left : whether any of them is buoyant; below the lowest float nothing can come up
    """

    break_after: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    floats_left: bool


def breaks_of(mooring: Mooring) -> tuple[Break, ...]:
    """The breaks at every connection above the lowest release, from the top.

    The net force of a piece is that with its clamps, in the water where it stands upright. After a
    break inside a cable what is left lies between the figures of the breaks at its two ends.
    Nothing is told of a line without a release, or one that no length fits.
    """
    release = release_of(mooring.file)
    if release is None:
        return ()
    try:
        lift = standing_lift(mooring.line, mooring.water)[: release + 1]
    except NoEquilibrium:
        return ()
    share = mooring.file.checks.backup_margin
    breaks = []
    for piece in mooring.file.pieces[:release]:
        left = lift[piece.index + 1 :]
        weight = float(-left[left < 0.0].sum())
        breaks.append(
            Break(
                break_after=piece.index,
                label=piece.label,
                margin=float(left.sum()),
                weight_lifted=weight,
                required=max(share * weight, LEAST_MARGIN),
                floats_left=bool((left > 0.0).any()),
            )
        )
    return tuple(breaks)
