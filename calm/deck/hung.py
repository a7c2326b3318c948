"""Every piece and clamp of a solved mooring as the sheets of the deck have it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.case.columns import ClampRow, ComponentRow, rows_down
from calm.files import Flexible

if TYPE_CHECKING:
    from calm.case import Result
    from calm.files import Clamp, Piece
    from calm.files.logbook import DeployedItem


@dataclass(frozen=True)
class Hung:
    """A piece, or an instrument clamped on one.

    Attributes
    ----------
    part : as read
    index : of the piece, of a clamp that of the piece it is on
    on : label of the piece that a clamp is on; None of a piece
    at : of a clamp, from the upper end of that piece, unstretched [m]
    of_length : of a clamp, the unstretched length of that piece [m]
    cut_length, stretched : of a piece [m]; of a clamp None
    depth, height : of the upper end, of a clamp of its place [m]
    tilt : from the vertical [degrees]
    serial : as designed
    deployed_serial, remark : as deployed; the serial number of the design where none is given
    """

    part: Piece | Clamp
    index: int
    on: str | None
    at: float | None
    of_length: float | None
    cut_length: float | None
    stretched: float | None
    depth: float
    height: float
    tilt: float
    serial: str | None
    deployed_serial: str | None
    remark: str | None

    @property
    def label(self) -> str:
        """What people call it."""
        return self.part.label

    @property
    def name(self) -> str:
        """Name of the component; its id where it has none."""
        return self.part.component.name or self.part.use

    @property
    def is_rigid(self) -> bool:
        """Whether it is no cable or chain."""
        return not isinstance(self.part.component, Flexible)

    @property
    def role(self) -> str:
        """What it is for."""
        return self.part.component.role


def hung_of(result: Result) -> tuple[Hung, ...]:
    """Down the line to the anchor, the clamps of a piece after it, down that piece."""
    deployed = result.file.deployed
    items = {item.label: item for item in deployed.items} if deployed else {}
    bottom = result.mooring.water.depth
    found: list[Hung] = []
    for row, clamps in rows_down(result):
        found.append(_hung(row.part, row, row, items, bottom))
        found += (_hung(clamp.part, row, clamp, items, bottom) for clamp in clamps)
    return tuple(found)


def depth_of(row: ComponentRow | ClampRow) -> float:
    """Of the upper end of a piece, or of the place of a clamp [m]."""
    return row.depth if isinstance(row, ClampRow) else row.depth_top


def _hung(
    part: Piece | Clamp,
    piece: ComponentRow,
    row: ComponentRow | ClampRow,
    items: Mapping[str, DeployedItem],
    bottom: float,
) -> Hung:
    item = items.get(part.label)
    clamp = row.part if isinstance(row, ClampRow) else None
    depth = depth_of(row)
    return Hung(
        part=part,
        index=piece.index,
        on=None if clamp is None else piece.label,
        at=None if clamp is None else clamp.at,
        of_length=None if clamp is None else piece.cut_length,
        cut_length=piece.cut_length if clamp is None else None,
        stretched=piece.length if clamp is None else None,
        depth=depth,
        height=bottom - depth,
        tilt=row.tilt,
        serial=part.serial,
        deployed_serial=(item.serial if item else None) or part.serial,
        remark=item.remark if item else None,
    )
