"""Parts of a mooring or a tow with net buoyancy and drag, for export to other programs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import cos, pi, radians, sin

import numpy as np

from calm.case.leg_result import LegResult
from calm.errors import NoEquilibrium
from calm.files import Anchor, Component, Sphere
from calm.files.definition import STANDARD_GRAVITY
from calm.files.legs import EndKeys
from calm.files.rigid import Displacement
from calm.physics.line import Floats
from calm.physics.seawater import REFERENCE_DENSITY

AS_A_POINT = (
    "the size and inclination of the float: the float is exported as a point, with the force that "
    "CALM computed"
)
"""Loss reported for a float that is exported by `ExportedLine.float_as_point`."""

_LEAST_MASS = 0.1  # smallest mass, as a share of the net force divided by gravity

Coordinates = tuple[float, float, float]
"""Distances east and north of the anchor, and depth [m]."""

Levels = tuple[tuple[float, float, float, float, float], ...]
"""Rows of depth [m], current (east, north, up) [m/s] and density [kg/m³]."""


@dataclass(frozen=True)
class ExportedPart:
    """A piece, or an item clamped on a piece.

    Values of a flexible part (a cable or chain) are per metre.

    Attributes
    ----------
    length : unstretched length [m]
    buoyancy : net buoyancy in reference water, positive up [N or N/m]
    net, density : net buoyancy [N or N/m] and water density [kg/m³] at the depth of the part in the
        upright line
    kn, kt : normal and tangential drag at 1 m/s and 1025 kg/m³ [N/(m/s)² or N/(m/s)²/m]
    directional : whether the drag depends on the flow direction relative to the axis
    stiffness : EA [N]; 0 if inextensible
    clamps : clamps, with their distances from the upper end [m]
    """

    use: str
    label: str
    role: str
    component: Component
    flexible: bool
    length: float
    buoyancy: float
    net: float
    density: float
    kn: float
    kt: float
    directional: bool
    stiffness: float
    clamps: tuple[tuple[ExportedPart, float], ...] = ()

    @property
    def diameter(self) -> float:
        """Diameter of the component [m]; 0 for a body."""
        return float(getattr(self.component, "diameter", 0.0))

    @property
    def mass(self) -> float | None:
        """Mass in air [kg or kg/m], or None if unknown."""
        return getattr(self.component, "mass", None)

    @property
    def likely_mass(self) -> float:
        """Mass in air [kg or kg/m]: the specified mass, or an estimate from weight and size."""
        if self.mass is not None:
            return self.mass
        hull = getattr(self.component, "hull", None)
        volume = self.component.displaced_volume
        if isinstance(hull, Displacement):
            volume = hull.displacement[-1][1]
        if not volume:
            across = self.diameter
            round_ = pi / 6.0 * across**3 if isinstance(self.component, Sphere) else 0.0
            volume = round_ or pi / 4.0 * across**2 * (1.0 if self.flexible else self.length)
        weighed = self.net / STANDARD_GRAVITY
        return max(REFERENCE_DENSITY * volume - weighed, _LEAST_MASS * abs(weighed))

    def area(self, density: float | None = None, *, along: bool = False) -> float:
        """Return the drag area (drag coefficient times area) [m²], per metre for a cable or chain.

        The drag area is tangential if `along` is true, and normal otherwise. `density` is the
        uniform density of the water in the other program [kg/m³]. The drag area is scaled so that
        the drag in this water equals that at the depth of the part. By default, the drag area is
        for reference water.
        """
        own = (self.kt if along else self.kn) / (0.5 * REFERENCE_DENSITY)
        return own if density is None else own * self.density / density


@dataclass
class PartLoad:
    """Sums over the parts at one point or on one rigid segment.

    Attributes
    ----------
    density : uniform density of the water [kg/m³]
    net, mass : net force [N] and mass [kg]
    area, along : normal and tangential drag areas [m²]
    """

    density: float
    names: list[str] = field(default_factory=list)
    net: float = 0.0
    mass: float = 0.0
    area: float = 0.0
    along: float = 0.0

    def merge(self, other: PartLoad) -> None:
        """Add the sums of another load to these sums."""
        self.names += other.names
        self.net += other.net
        self.mass += other.mass
        self.area += other.area
        self.along += other.along

    def add(self, part: ExportedPart, share: float = 1.0) -> None:
        """Add a part without its clamps; the drag of the part is multiplied by `share`."""
        areas = (share * part.area(self.density, along=along) for along in (False, True))
        self.merge(PartLoad(self.density, [part.use], part.net, part.likely_mass, *areas))

    def add_whole(self, part: ExportedPart, share: float = 1.0) -> None:
        """Add a part and its clamps; the drag of the part itself is multiplied by `share`."""
        self.add(part, share)
        for clamp, _ in part.clamps:
            self.add(clamp)

    def per_metre(self, length: float) -> PartLoad:
        """Divide the sums by a length [m]."""
        figures = (self.net, self.mass, self.area, self.along)
        return PartLoad(self.density, self.names, *(each / length for each in figures))


def unique_name(known: dict[str, str], name: str, figures: str) -> str:
    """Register values under a unique name, and return this name.

    `known` holds registered values by name. A number is appended to `name` if `name` is registered
    with other values.
    """
    chosen, number = name, 1
    while known.setdefault(chosen, figures) != figures:
        number += 1
        chosen = f"{name}_{number}"
    return chosen


def place_along(path: Floats, share: float) -> Coordinates:
    """Interpolate the position at a fraction of the length of a part.

    `path` has the node positions (n, 3). `share`, from 0 to 1, is the fraction from the first node.
    """
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    east, north, depth = (float(np.interp(share * along[-1], along, each)) for each in path.T)
    return east, north, depth


@dataclass(frozen=True)
class ExportedTow:
    """Velocity of the ship to the east and north [m/s], and sheave height above the water [m]."""

    east: float
    north: float
    height: float


@dataclass(frozen=True)
class ExportedLine:
    """A mooring line, a tow, or a leg of a net, for export.

    Attributes
    ----------
    parts : parts without the anchor, from the top (of a tow: from the ship) down
    anchor : the anchor, and its weight in water with its clamps [N]; None for a tow
    depth : water depth [m]
    levels : current and density, from the surface down
    gravity : acceleration of gravity [m/s²]
    wind : wind velocity to the east and to the north [m/s]
    tow : None for a mooring
    afloat : whether the line reaches the surface
    has_draft : whether the hull of the float is known
    riding : used fraction of the net buoyancy of the float, and ratio of its drag to the drag when
        immersed
    windage : wind area of the float [m²], and drag coefficient of this area
    omitted : features that no other program can represent
    solve : function that finds the equilibrium
    ends : upper and lower connection of a leg; None for a single line
    """

    name: str
    parts: tuple[ExportedPart, ...]
    anchor: tuple[Anchor, float] | None
    depth: float
    levels: Levels
    gravity: float
    wind: tuple[float, float]
    tow: ExportedTow | None
    afloat: bool
    has_draft: bool
    riding: tuple[float, float]
    windage: tuple[float, float]
    omitted: tuple[str, ...]
    solve: Callable[[], LegResult]
    ends: tuple[EndKeys, EndKeys] | None = None

    @property
    def mean_density(self) -> float:
        """Mean density of the levels [kg/m³], for programs in which the density is uniform."""
        return sum(row[4] for row in self.levels) / len(self.levels)

    def losses(self, more: Sequence[str]) -> tuple[str, ...]:
        """Return the features that the other program cannot represent.

        The list has the features in `more`, then the features in `omitted`, without repetitions.
        """
        return tuple(dict.fromkeys((*more, *self.omitted)))

    def paths(self) -> list[Floats]:
        """Return the positions (n, 3) of the nodes of each part in equilibrium, from the top down.

        Each position is east, north and depth [m]. Raise NoEquilibrium if there is no equilibrium.
        """
        result = self.solve()
        nodes = np.column_stack([result.shape.x, result.shape.y, result.shape.depth])
        row = result.components[0]
        upper = np.array([row.x_top, row.y_top, row.depth_top])
        if np.linalg.norm(nodes[0] - upper) > np.linalg.norm(nodes[-1] - upper):
            nodes = nodes[::-1]  # the solution of a hanging leg begins at its lower end
        paths, start = [], 0
        for row in (result.components[i] for i in range(len(self.parts))):
            low = np.array([row.x_bottom, row.y_bottom, row.depth_bottom])
            gap = np.linalg.norm(nodes[start:] - low, axis=1)
            end = start + int(np.flatnonzero(gap <= gap.min() + 1e-9)[0])
            first = np.array([row.x_top, row.y_top, row.depth_top])
            paths.append(np.vstack([first, nodes[start + 1 : end], low]))
            start = end
        return paths

    def float_as_point(self, density: float) -> tuple[float, float]:
        """Return net force [N] and drag area [m²] of a point in place of a submerged float.

        In water of uniform `density` [kg/m³], a point at the end of the line exerts the same load
        as the float. Without an equilibrium, the values of the float itself are returned.
        """
        part = self.parts[0]
        own = part.net, part.area(density)
        try:
            row = self.solve().components[0]
        except NoEquilibrium:
            return own
        depths, *speeds = np.array(self.levels)[:, :4].T
        middle, end = (
            sum(float(np.interp(depth, depths, speed)) ** 2 for speed in speeds)
            for depth in ((row.depth_top + row.depth_bottom) / 2.0, row.depth_top)
        )
        if end == 0.0:
            return own
        if not part.directional or part.clamps:
            return part.net, own[1] * middle / end
        tilt, pull = radians(row.tilt), row.tension_bottom
        return pull * cos(tilt), pull * sin(tilt) / (0.5 * density * end)


@dataclass(frozen=True)
class ExportedDesign:
    """A design for export: its name and its lines, one line or the legs of a net."""

    name: str
    legs: tuple[ExportedLine, ...]
