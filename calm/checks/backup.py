"""Back-up buoyancy: whether what holds the release comes up when the line breaks above it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.errors import NoEquilibrium
from calm.solve.standing import standing_lift

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.files import Piece
    from calm.physics.line import Floats

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
    judged : whether the design can do anything about it
    """

    break_after: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    judged: bool


def breaks_of(mooring: Mooring) -> tuple[Break, ...]:
    """The breaks at every connection above the lowest release, from the top.

    The net force of a piece is that with its clamps, in the water where it stands upright. After a
    break inside a cable what is left lies between the figures of the breaks at its two ends.
    Nothing is told of a line without a release, or one that no length fits.

    Floats that follow one another, with at most connectors and chain between them, are a cluster.
    What breaks inside the lowest one, or in the connectors and chain that lead from it to the
    release, leaves the release on the seabed in any design, and is not judged. Where that is the
    whole line, the last break is.
    """
    release = mooring.file.release
    if release is None:
        return ()
    try:
        lift = standing_lift(mooring.line, mooring.water)[: release + 1]
    except NoEquilibrium:
        return ()
    share = mooring.file.checks.backup_margin
    beyond_help = _beyond_help(mooring.file.pieces[:release], lift[:release])
    judged = set(range(release)) - set(beyond_help) or {release - 1}
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
                judged=piece.index in judged,
            )
        )
    return tuple(breaks)


def _beyond_help(above: Sequence[Piece], lift: Floats) -> range:
    """The breaks inside the lowest cluster of floats, and below it down to a cable or instrument.

    Parameters
    ----------
    above, lift : the pieces above the release, and their net forces [N]
    """
    floats = [
        force > 0.0 and not _is(piece, "cable") for piece, force in zip(above, lift, strict=True)
    ]
    end = len(above)
    while end and not floats[end - 1]:
        end -= 1
    first = end
    while first and (floats[first - 1] or _is(above[first - 1], "connector", "chain")):
        first -= 1
    leads_to_the_release = all(_is(piece, "connector", "chain") for piece in above[end:])
    return range(first, len(above) if leads_to_the_release else end - 1)


def _is(piece: Piece, *what: str) -> bool:
    return piece.component.kind in what or piece.component.role in what
