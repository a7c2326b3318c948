"""A mooring or a tow for other programs: parts with their net force and drag."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np

from calm.case import Result, TowResult
from calm.errors import NoEquilibrium
from calm.files import Anchor, Component, Sphere
from calm.files.definition import STANDARD_GRAVITY
from calm.files.rigid import Displacement
from calm.physics.reference import REFERENCE_DENSITY

_LEAST_MASS = 0.1  # of what its net force weighs

Coordinates = tuple[float, float, float]
"""East and north of the anchor, and depth [m]."""


@dataclass(frozen=True)
class ExportedPart:
    """A piece, or what is clamped on one.

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
        """As its definition has it; 0 for a body [m]."""
        return float(getattr(self.component, "diameter", 0.0))

    @property
    def mass(self) -> float | None:
        """In air, where it is known [kg or kg/m]."""
        return getattr(self.component, "mass", None)


@dataclass(frozen=True)
class ExportedLine:
    """The parts of a line from its first piece to its last, the anchor apart.

    Attributes
    ----------
    name, description : of the file
    parts : of a mooring from the top, of a tow from the ship
    anchor : the anchor, and its weight with what is clamped on it [N]; None for a tow
    depth, levels, u, v, w, density : of the water [m, m/s, kg/m³], first at the surface
    gravity : [m/s²]
    tow : speed [m/s], direction [degrees] and height of the sheave [m]
    afloat : whether the line reaches the surface, and whether its float has a draft there
    riding : share of its buoyancy that the float uses here, and of its drag that acts on it; 1, 1
        below the surface
    windage : of the float: its area in the air here [m²], and its drag coefficient there
    unsaid : what other programs cannot hold
    solve : finds the equilibrium
    """

    name: str
    description: str
    parts: tuple[ExportedPart, ...]
    anchor: tuple[Anchor, float] | None
    depth: float
    levels: tuple[tuple[float, float, float, float, float], ...]
    gravity: float
    wind: tuple[float, float]
    tow: tuple[float, float, float] | None
    afloat: tuple[bool, bool]
    riding: tuple[float, float]
    windage: tuple[float, float]
    unsaid: tuple[str, ...]
    solve: Callable[[], Result | TowResult]

    def paths(self) -> list[PartPath]:
        """The equilibrium: where each part lies, from the top down.

        Raises
        ------
        NoEquilibrium
            There is none.
        """
        result = self.solve()
        nodes = np.column_stack([result.shape.x, result.shape.y, result.shape.depth])
        paths, start = [], 0
        for row in (result.components[i] for i in range(len(self.parts))):
            low = np.array([row.x_bottom, row.y_bottom, row.depth_bottom])
            gap = np.linalg.norm(nodes[start:] - low, axis=1)
            end = start + int(np.flatnonzero(gap <= gap.min() + 1e-9)[0])
            first = np.array([[row.x_top, row.y_top, row.depth_top]])
            inner = nodes[start + 1 : end]
            paths.append(PartPath(np.vstack([first, inner, low[np.newaxis]])))
            start = end
        return paths


@dataclass(frozen=True)
class PartPath:
    """Hold where a part lies in equilibrium: (n, 3) `Coordinates` of nodes from its upper end."""

    nodes: np.ndarray[tuple[int, int], np.dtype[np.float64]]

    def at(self, share: float) -> Coordinates:
        """The place at a share of its length from its upper end."""
        steps = np.linalg.norm(np.diff(self.nodes, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        place = [float(np.interp(share * along[-1], along, column)) for column in self.nodes.T]
        return place[0], place[1], place[2]


def area(part: ExportedPart, density: float | None = None, *, along: bool = False) -> float:
    """Drag coefficient times area [m²], across the line or along it, of a cable per metre.

    Parameters
    ----------
    density : of a program that has a single one [kg/m³]: the area that drags there as the part does
    in its own water
    """
    own = (part.kt if along else part.kn) / (0.5 * REFERENCE_DENSITY)
    return own if density is None else own * part.density / density


def as_point(design: ExportedLine, density: float) -> tuple[float, float]:
    """Net force [N] and drag area [m²] of a float below the surface as a point at the line's end.

    For programs in which a float is a point: its drag is in the flow at the end, not at its middle,
    and has no axis. Force and area are such that it pulls as it does here; without an equilibrium
    they are its own.

    Parameters
    ----------
    density : of the water there [kg/m³]
    """
    part = design.parts[0]
    own = part.net, area(part, density)
    try:
        row = design.solve().components[0]
    except NoEquilibrium:
        return own
    depths, *parts = np.array(design.levels)[:, :4].T
    middle, end = (
        sum(float(np.interp(depth, depths, part)) ** 2 for part in parts)
        for depth in ((row.depth_top + row.depth_bottom) / 2.0, row.depth_top)
    )
    if end == 0.0:
        return own
    if not part.directional or part.clamps:
        return part.net, own[1] * middle / end
    tilt = radians(row.tilt)
    return row.tension_bottom * cos(tilt), row.tension_bottom * sin(tilt) / (0.5 * density * end)


def remarks(design: ExportedLine, more: Sequence[str]) -> tuple[str, ...]:
    """What other programs cannot hold, each remark once."""
    return tuple(dict.fromkeys((*more, *design.unsaid)))


def mass_of(part: ExportedPart) -> float:
    """Mass in air [kg, kg/m]: as given, or from weight and size."""
    if part.mass is not None:
        return part.mass
    hull = getattr(part.component, "hull", None)
    volume = part.component.displaced_volume
    if isinstance(hull, Displacement):
        volume = hull.displacement[-1][1]
    if not volume:
        across = part.diameter
        round_ = pi / 6.0 * across**3 if isinstance(part.component, Sphere) else 0.0
        volume = round_ or pi / 4.0 * across**2 * (1.0 if part.flexible else part.length)
    weighed = part.net / STANDARD_GRAVITY
    return max(REFERENCE_DENSITY * volume - weighed, _LEAST_MASS * abs(weighed))
