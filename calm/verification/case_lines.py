"""Put together lines and waters of published cases without a mooring file, and take their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, inf, pi, radians, sin

import numpy as np

from calm.physics.line import Floats, Line, Water
from calm.physics.reference import REFERENCE_DENSITY
from calm.solve import Settings, Solution, Towing, solve_mooring, solve_tow

GRAVITY = 9.81
"""[m/s²] of every case that does not name another."""

HALF_DENSITY = REFERENCE_DENSITY / 2.0


@dataclass(frozen=True)
class LinePiece:
    """One piece of a line; the names and units are those of `calm.physics.line.Line`.

    `clamps` holds (distance from the piece's top, buoyancy, volume, drag) of each.
    """

    length: float
    flexible: bool
    buoyancy: float
    normal_drag: float = 0.0
    tangential_drag: float = 0.0
    directional: bool = True
    volume: float = 0.0
    compliance: float = 0.0
    thinning: float = 0.0
    clamps: tuple[tuple[float, float, float, float], ...] = ()


def point(buoyancy: float, drag: float) -> LinePiece:
    """Return a piece without length: buoyancy [N], drag at 1 m/s [N/(m/s)²]."""
    return LinePiece(0.0, False, buoyancy, drag, drag, directional=False)


def sphere_drag(diameter: float, cx: float) -> float:
    """Drag of a sphere at 1 m/s [N/(m/s)²]."""
    return HALF_DENSITY * cx * pi / 4.0 * diameter**2


def cable(
    length: float, diameter: float, weight: float, cn: float, ct: float, compliance: float = 0.0
) -> LinePiece:
    """Return a piece of rope or wire.

    Parameters
    ----------
    length, diameter : unstretched [m]
    weight : in water [N/m]
    cn, ct : drag coefficients on its diameter and on its surface π D
    compliance : strain of a newton [1/N]
    """
    normal, tangential = HALF_DENSITY * diameter * cn, HALF_DENSITY * pi * diameter * ct
    return LinePiece(
        length, True, -weight, normal, tangential, compliance=compliance, thinning=0.5
    )  # fmt: skip


def line_of(*pieces: LinePiece, anchor_height: float = 0.0) -> Line:
    """Return the arrays of a list of pieces, free end first."""
    held = [(owner, *clamp) for owner, piece in enumerate(pieces) for clamp in piece.clamps]
    clamps = np.array(held, dtype=np.float64).reshape(len(held), 5)

    def column(name: str) -> Floats:
        return np.array([getattr(piece, name) for piece in pieces], dtype=np.float64)

    return Line(
        length=column("length"),
        flexible=column("flexible").astype(bool),
        buoyancy=column("buoyancy"),
        volume=column("volume"),
        normal_drag=column("normal_drag"),
        tangential_drag=column("tangential_drag"),
        directional=column("directional").astype(bool),
        compliance=column("compliance"),
        thinning=column("thinning"),
        clamp_piece=clamps[:, 0].astype(np.int64),
        clamp_at=clamps[:, 1],
        clamp_buoyancy=clamps[:, 2],
        clamp_volume=clamps[:, 3],
        clamp_drag=clamps[:, 4],
        anchor_height=anchor_height,
    )


def stream(
    depth: float, speed: float, density: float = REFERENCE_DENSITY, toward: float = 0.0
) -> Water:
    """Water with the same current everywhere, towards an angle counted from east [rad].

    Parameters
    ----------
    depth : of the water [m]
    speed : of the current [m/s]
    density : of the water [kg/m³]
    toward : angle of the current from east [rad]
    """
    u, v = speed * cos(toward), speed * sin(toward)
    return Water(
        depth=depth, level=np.array([0.0]), u=np.array([u]), v=np.array([v]), w=np.array([0.0]),
        density=np.array([density]), gravity=GRAVITY,
    )  # fmt: skip


def profile(depth: float, rows: Sequence[tuple[float, float]]) -> Water:
    """Water with an eastward current: rows of (depth [m], speed [m/s])."""
    level, u = np.array(rows).T
    still = np.zeros_like(u)
    return Water(
        depth=depth, level=level, u=u, v=still, w=still, density=still + REFERENCE_DENSITY,
        gravity=GRAVITY,
    )  # fmt: skip


def deep_water(density: float = REFERENCE_DENSITY) -> Water:
    """Still water without a seabed, for tows: the ship makes the current."""
    zero = np.zeros(1)
    return Water(
        depth=inf, level=zero, u=zero, v=zero, w=zero, density=zero + density, gravity=GRAVITY
    )


FINE = Settings(radians(0.1), tolerance=1e-9)
"""For figures of seven digits: the march errs by some 4e-8 of the length at this angle step."""


@dataclass(frozen=True)
class Ends:
    """Free end and lower end of a line in an eastward current.

    Attributes
    ----------
    x, z : the free end downstream of the lower end and above it [m]
    horizontal, vertical : the pull at the lower end, downstream and up [N]
    """

    x: float
    z: float
    horizontal: float
    vertical: float

    @property
    def tension(self) -> float:
        """The tension at the lower end [N]."""
        return hypot(self.horizontal, self.vertical)

    @property
    def lean(self) -> float:
        """Angle of the pull at the lower end from the vertical [degrees]."""
        return degrees(atan2(self.horizontal, self.vertical))


def ends_of(solution: Solution) -> Ends:
    """Return the ends of a solved line."""
    x, _, z = (solution.position[0] - solution.position[-1]).tolist()
    horizontal, _, vertical = solution.force[-1].tolist()
    return Ends(x, z, horizontal, vertical)


def finely(line: Line, water: Water) -> Ends:
    """Return the ends of a line, solved at `FINE`."""
    return ends_of(solve_mooring(line, water, FINE))


@dataclass(frozen=True)
class Wake:
    """Represent a line towed to the east through still water.

    Attributes
    ----------
    aft, depth : of the free end behind and below the tow point [m]
    tension : at the tow point [N]
    angle : of the line at the tow point from the horizontal [degrees]
    frequency : of the cables that strum [Hz]
    """

    aft: float
    depth: float
    tension: float
    angle: float
    frequency: float


def towed(line: Line, water: Water, speed: float, settings: Settings = FINE) -> Wake:
    """Return the wake of a line that is towed.

    Parameters
    ----------
    line : listed from the ship
    water : in which it is towed
    speed : of the ship [m/s]
    settings : of the march
    """
    solution = solve_tow(line, water, Towing(speed, 0.0), settings)
    x, _, z = solution.position[0].tolist()
    back, _, down = solution.force[-1].tolist()
    return Wake(-x, -z, hypot(back, down), degrees(atan2(-down, -back)), solution.frequency)
