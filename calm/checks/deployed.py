"""A mooring as it was deployed, where that is not as it was designed."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from calm.case import Mooring
from calm.checks.situations import cut_like
from calm.errors import UsageError
from calm.files import Clamp, Piece
from calm.files.logbook import DeployedItem

_Part = TypeVar("_Part", Piece, Clamp)


def as_deployed(mooring: Mooring) -> Mooring:
    """The mooring with the depth, position, serial numbers and cut lengths of its `deployed`.

    What is cut to fit keeps the length that fits as designed, unless another was cut.

    Raises
    ------
    UsageError
        The file says nothing of a deployment.
    NoEquilibrium
        What is cut to fit has no length that fits as designed.
    """
    deployed = mooring.file.deployed
    if deployed is None:
        raise UsageError(f"{mooring.file.path} has no `deployed:` to compare its design with")
    items = {item.label: item for item in deployed.items}
    file = cut_like(mooring.file, mooring)
    depth, position = deployed.depth, deployed.position
    environment = replace(
        file.environment,
        depth=file.environment.depth if depth is None else depth,
        position=position or file.environment.position,
    )
    return Mooring(
        replace(
            file,
            position=position or file.position,
            environment=environment,
            pieces=tuple(_as_cut(piece, items) for piece in file.pieces),
        )
    )


def _as_cut(piece: Piece, items: dict[str, DeployedItem]) -> Piece:
    item = items.get(piece.label)
    clamps = tuple(_numbered(clamp, items) for clamp in piece.clamps)
    piece = replace(_numbered(piece, items), clamps=clamps)
    return piece if item is None or item.length is None else replace(piece, length=item.length)


def _numbered(part: _Part, items: dict[str, DeployedItem]) -> _Part:
    item = items.get(part.label)
    if item is None or item.serial is None:
        return part
    return replace(part, equipment=part.equipment.model_copy(update={"serial": item.serial}))
