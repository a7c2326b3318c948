"""Back-up buoyancy: whether what holds the release comes up when the line breaks above it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from calm.assemble import net_buoyancy
from calm.errors import NoEquilibrium
from calm.files import Component, Flexible
from calm.files.definition import CATALOGUE_DENSITY
from calm.physics.materials import materials_in
from calm.solve.standing import standing_lift

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.files import Piece, Place
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
    judged : whether the design can change it
    """

    break_after: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    judged: bool


@dataclass(frozen=True)
class Loss:
    """The loss of one buoyant element, such as a ball that is flooded; the line holds.

    Attributes
    ----------
    index, label : the piece, or the piece that the clamp is on, and what is lost
    margin : net buoyancy of what is left above the release, and of the release [N]
    weight_lifted : weight in water of what of it is heavy [N]
    required : what the margin should be [N]
    place : of what is lost, in the line as read
    """

    index: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    place: Place


def _lift_to_the_release(mooring: Mooring) -> Floats:
    """(n,) net force [N] of each piece down to the lowest release, where the line stands upright.

    None of a line without a release, or one that no length fits.
    """
    release = mooring.file.release
    if release is not None:
        with suppress(NoEquilibrium):
            return standing_lift(mooring.line, mooring.water)[: release + 1]
    return np.zeros(0)


def losses_of(mooring: Mooring) -> tuple[Loss, ...]:
    """The loss of each buoyant piece or clamp above the lowest release, from the top.

    What is lost lifts no more. One that fills with water, and gives its mass and a material whose
    density is known, weighs what that does in water; another is taken to be gone, and a cable is
    not lost. The others lift what they do where the line stands upright.
    """
    lift = _lift_to_the_release(mooring)
    gravity = mooring.water.gravity
    weight = float(-lift[lift < 0.0].sum())
    losses = []
    for piece in mooring.file.pieces[: lift.size]:
        own = () if isinstance(piece.component, Flexible) else (piece,)
        for part in (*own, *piece.clamps):
            lifted = net_buoyancy(part.component, gravity)
            if lifted <= 0.0:
                continue
            sunk = _weight_when_flooded(part.component, gravity)
            losses.append(
                Loss(
                    index=piece.index,
                    label=part.label,
                    margin=float(lift.sum()) - lifted - sunk,
                    weight_lifted=weight + sunk,
                    required=_required(mooring, weight + sunk),
                    place=part.place,
                )
            )
    return tuple(losses)


def _weight_when_flooded(component: Component, gravity: float) -> float:
    """In water, of the shell of a float that is full of water [N]; 0 where that is not known."""
    named = (material.density for material in materials_in(component.material))
    density = next((value for value in named if value and value > CATALOGUE_DENSITY), None)
    if density is None or component.mass is None:
        return 0.0
    return component.mass * gravity * (1.0 - CATALOGUE_DENSITY / density)


def _required(mooring: Mooring, weight: float) -> float:
    return max(mooring.file.checks.backup_margin * weight, LEAST_MARGIN)


def breaks_of(mooring: Mooring) -> tuple[Break, ...]:
    """The breaks at every connection above the lowest release, from the top.

    The net force of a piece is that with its clamps, in the water where it stands upright. After a
    break inside a cable what is left lies between the figures of the breaks at its two ends.
    There are none of a line without a release, or one that no length fits.

    Floats that follow one another, with at most connectors and chain between them, are a cluster.
    What breaks inside the lowest one, or in the connectors and chain that lead from it to the
    release, leaves the release on the seabed in any design, and is not judged. Where that is the
    whole line, chain parts clusters too; one that is compact even so is judged by its losses alone.
    """
    lift = _lift_to_the_release(mooring)
    if not lift.size:
        return ()
    release = lift.size - 1
    above = mooring.file.pieces[:release]
    beyond_help = _beyond_help(above, lift[:release], "connector", "chain")
    if len(beyond_help) == release:
        beyond_help = _beyond_help(above, lift[:release], "connector")
    judged = set(range(release)) - set(beyond_help)
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
                required=_required(mooring, weight),
                judged=piece.index in judged,
            )
        )
    return tuple(breaks)


def _beyond_help(above: Sequence[Piece], lift: Floats, *between: str) -> range:
    """The breaks inside the lowest cluster of floats, and below it down to a cable or instrument.

    Parameters
    ----------
    above, lift : the pieces above the release, and their net forces [N]
    between : kinds and roles of what may stand between the floats of a cluster
    """
    floats = [
        force > 0.0 and not _is(piece, "cable") for piece, force in zip(above, lift, strict=True)
    ]
    end = len(above)
    while end and not floats[end - 1]:
        end -= 1
    first = end
    while first and (floats[first - 1] or _is(above[first - 1], *between)):
        first -= 1
    leads_to_the_release = all(_is(one, "connector", "chain", "release") for one in above[end:])
    return range(first, len(above) if leads_to_the_release else end - 1)


def _is(piece: Piece, *what: str) -> bool:
    return piece.component.kind in what or piece.component.role in what
