"""Define a mooring or a tow for other programs: parts with their net force and drag."""

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
    "that the drag of the float acts at its middle and by its axis: its point has the pull found "
    "here"
)
"""What is said where a float is written as `ExportedLine.float_as_point` has it."""

_LEAST_MASS = 0.1  # of what its net force weighs

Coordinates = tuple[float, float, float]
"""East and north of the anchor, and depth [m]."""

Levels = tuple[tuple[float, float, float, float, float], ...]
"""Rows of depth [m], current to the east, to the north and up [m/s], and density [kg/m³]."""


@dataclass(frozen=True)
class ExportedPart:
    """Describe a piece, or what is clamped on one.

    Attributes
    ----------
    use, label, role : as in the mooring file
    component : its definition
    flexible : whether it is a cable or chain, whose figures are per metre
    length : unstretched [m]
    buoyancy : net force in water of the reference density, + up [N or N/m]
    net, density : the same, and the density [kg/m³], in the water where it stands upright
    kn, kt : drag across and along it at 1 m/s and 1025 kg/m³ [N/(m/s)², per metre where flexible]
    directional : whether its drag depends on its axis
    stiffness : EA [N]; 0 where it does not stretch
    clamps : with their distance from its upper end [m]
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
        """The diameter of its definition; 0 for a body [m]."""
        return float(getattr(self.component, "diameter", 0.0))

    @property
    def mass(self) -> float | None:
        """The mass in air, where it is known [kg or kg/m]."""
        return getattr(self.component, "mass", None)

    @property
    def likely_mass(self) -> float:
        """The mass in air [kg, kg/m]: as given, or from weight and size."""
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
        """Return drag coefficient times area [m²], of a cable per metre.

        Parameters
        ----------
        density : of a program that has a single one [kg/m³]: the area that drags there as the part
            does in its own water
        along : whether it is that along the line, not across it
        """
        own = (self.kt if along else self.kn) / (0.5 * REFERENCE_DENSITY)
        return own if density is None else own * self.density / density


@dataclass
class PartLoad:
    """Add up what parts do at one point, or in one stiff length.

    Attributes
    ----------
    density : of the water, the same everywhere [kg/m³]
    names : of the parts
    net, mass : net force [N] and mass [kg]
    area, along : drag areas across and along the line [m²]
    """

    density: float
    names: list[str] = field(default_factory=list)
    net: float = 0.0
    mass: float = 0.0
    area: float = 0.0
    along: float = 0.0

    def merge(self, other: PartLoad) -> None:
        """Add what another does."""
        self.names += other.names
        self.net += other.net
        self.mass += other.mass
        self.area += other.area
        self.along += other.along

    def add(self, part: ExportedPart, share: float = 1.0) -> None:
        """Add a part without its clamps; `share` is of its drag."""
        areas = (share * part.area(self.density, along=along) for along in (False, True))
        self.merge(PartLoad(self.density, [part.use], part.net, part.likely_mass, *areas))

    def add_whole(self, part: ExportedPart, share: float = 1.0) -> None:
        """Add a part with what is clamped on it; `share` is of its own drag."""
        self.add(part, share)
        for clamp, _ in part.clamps:
            self.add(clamp)

    def per_metre(self, length: float) -> PartLoad:
        """Return the same load, spread over a length [m]."""
        figures = (self.net, self.mass, self.area, self.along)
        return PartLoad(self.density, self.names, *(each / length for each in figures))


def unique_name(known: dict[str, str], name: str, figures: str) -> str:
    """Keep figures under a name, and return it: another where it is taken by other figures.

    Parameters
    ----------
    known : figures by name, to which these are added
    name : that they are to have
    figures : as the file has them
    """
    chosen, number = name, 1
    while known.setdefault(chosen, figures) != figures:
        number += 1
        chosen = f"{name}_{number}"
    return chosen


def place_along(path: Floats, share: float) -> Coordinates:
    """Return the place at a share of the length of a part, whose nodes (n, 3) are its `path`."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    east, north, depth = (float(np.interp(share * along[-1], along, each)) for each in path.T)
    return east, north, depth


@dataclass(frozen=True)
class ExportedTow:
    """Hold the speed of the ship east and north [m/s], and the height of the sheave [m]."""

    east: float
    north: float
    height: float


@dataclass(frozen=True)
class ExportedLine:
    """Hold the parts of a line from its first piece to its last, the anchor apart.

    Attributes
    ----------
    name : of the file
    parts : of a mooring from the top, of a tow from the ship
    anchor : the anchor, and its weight with what is clamped on it [N]; None for a tow
    depth, levels : of the water [m], the first level at the surface
    gravity : [m/s²]
    wind : to the east and to the north [m/s]
    tow : None for a mooring
    afloat, has_draft : whether the line reaches the surface, and whether its float has a draft
    riding : share of its buoyancy that the float uses here, and of its drag that acts on it; 1, 1
        below the surface
    windage : of the float: its area in the air here [m²], and its drag coefficient there
    omitted : what other programs cannot hold
    solve : finds the equilibrium
    ends : what holds the upper and the lower end of a leg of a net; None for a line of its own
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
        """The density for programs that have a single one [kg/m³]."""
        return sum(row[4] for row in self.levels) / len(self.levels)

    def losses(self, more: Sequence[str]) -> tuple[str, ...]:
        """Return what another program cannot hold, each remark once, `more` first."""
        return tuple(dict.fromkeys((*more, *self.omitted)))

    def paths(self) -> list[Floats]:
        """Return where each part lies in equilibrium, from the top down: `Coordinates` of nodes.

        NoEquilibrium: there is none.
        """
        result = self.solve()
        nodes = np.column_stack([result.shape.x, result.shape.y, result.shape.depth])
        row = result.components[0]
        upper = np.array([row.x_top, row.y_top, row.depth_top])
        if np.linalg.norm(nodes[0] - upper) > np.linalg.norm(nodes[-1] - upper):
            nodes = nodes[::-1]  # a leg that hangs is found from its lower end
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
        """Return net force [N] and drag area [m²] of a float below the surface as a point.

        It is for programs in which a float is a point at the line's end, in water of a density
        [kg/m³]: its drag is in the flow there, not at its middle, and has no axis. Force and area
        are such that it pulls as it does here; without an equilibrium they are its own.
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
    """A design for another program: its name, and the legs of a net or else a single line."""

    name: str
    legs: tuple[ExportedLine, ...]
