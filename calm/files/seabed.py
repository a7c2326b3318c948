"""The `seabed:` of an environment: a plane that slopes, or a grid of depths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Discriminator, Tag

from calm.errors import InputError, shown
from calm.files.components import Anchor
from calm.files.definition import Model, QuantityField, Text, described
from calm.files.water import Toward
from calm.files.yaml_document import SourceMapping
from calm.records.grids import Floats, SeabedGrid

if TYPE_CHECKING:
    from calm.files.check_limits import Checks
    from calm.files.legs import Leg
    from calm.files.mooring_file import Piece


class SeabedKeys(Model):
    """A seabed that slopes, as a plane: how steep, and towards where it gets deeper [degrees]."""

    slope: Annotated[float, QuantityField("angle", at_least=0, at_most=45)] = described(
        "from the horizontal", "3 deg"
    )
    toward: Toward = described("where it gets deeper, clockwise from north", "120 deg")

    def at(self, east: float, north: float) -> SeabedKeys:
        """Return the same about another point, by its distance from this one [m]."""
        return self

    @property
    def plane(self) -> tuple[float, float]:
        """How much deeper it is per metre to the east and to the north [-]."""
        way, steep = math.radians(self.toward), math.tan(math.radians(self.slope))
        return steep * math.sin(way), steep * math.cos(way)

    def deeper(self, places: Floats) -> Floats:
        """Return how much deeper it is (n,) at places (n, 2) east and north of the point [m]."""
        deeper: Floats = places @ np.array(self.plane)
        return deeper


class SeabedFile(Model):
    """Say which grid the depths of the seabed are from."""

    file: Text = described("NetCDF over latitude and longitude: GEBCO, EMODnet", "gebco.nc")


def _form(value: object) -> str:
    return "file" if isinstance(value, dict) and "file" in value else "plane"


Seabed = SeabedKeys | SeabedGrid
SeabedGiven = Annotated[
    Annotated[SeabedKeys, Tag("plane")] | Annotated[SeabedFile, Tag("file")], Discriminator(_form)
]


def read_seabed(
    given: SeabedKeys | SeabedFile | None,
    where: tuple[float, float] | None,
    depth: float | None,
    section: SourceMapping,
    notices: list[str],
) -> Seabed | None:
    """Return the seabed; a grid as far about the mooring as that may reach.

    Parameters
    ----------
    where : latitude and longitude [degrees]; None where nobody gives them
    depth : of the water [m]
    section : the environment
    notices : for what is doubtful
    """
    if not isinstance(given, SeabedFile):
        return given
    path, key = Path(section.home("seabed").document.path).parent / given.file, ("seabed", "file")
    if not path.is_file():
        section.refuse(key, f"`file: {shown(given.file)}`: no such file")
    elif where is None:
        section.refuse(key, "a grid needs the `position` of the mooring")
    elif depth is not None:
        try:
            grid = SeabedGrid.of_file(path, *where, 2000.0 + 3.0 * depth)
            if not 0.5 < grid.depth / depth < 2.0:
                notices.append(
                    f"The seabed of {given.file} is {grid.depth:.4g} m deep at the position of the "
                    f"mooring, where `depth` is {depth:.4g} m: check the unit and the position."
                )
            return grid
        except InputError as error:
            section.problems.extend(error.problems)
    return None


def check_anchors(
    seabed: Seabed,
    pieces: Sequence[Piece],
    legs: Sequence[Leg],
    checks: Checks,
    top: SourceMapping,
    depth: float | None,
) -> None:
    """Check that no anchor slides down the seabed by its own weight, nor stands off the grid or out
    of the water, which is so deep at the origin [m].
    """
    ends = {leg.end - 1: leg.bottom.anchor for leg in legs}
    for piece in pieces:
        if not isinstance(piece.component, Anchor):
            continue
        place, own = ends.get(piece.index), piece.component.friction
        at = (0.0, 0.0) if place is None else place.at
        here, deeper = seabed.at(*at), float(seabed.deeper(np.array([at]))[0])
        most = math.degrees(math.atan(checks.anchor_friction if own is None else own))
        said = []
        if here.slope >= most:
            said.append(
                f"with a friction of {math.tan(math.radians(most)):g} the anchor slides by itself "
                f"on a seabed that slopes by {here.slope:.4g}°; it holds on slopes of less than "
                f"{most:.3g}°"
            )
        if place is not None and place.depth is not None:
            pass
        elif np.isnan(deeper):
            said.append("the grid of the seabed has no depth here; give the anchor its `depth`")
        elif depth is not None and depth + deeper <= 0.0:
            said.append(f"by its slope the seabed is {-depth - deeper:.3g} m above the water here")
        for one in said:
            top.refuse_at(piece.line, piece.column, one)
