"""Lines put together from pieces, for tests that need no mooring file."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

import numpy as np

from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.physics.strumming import BourgetMarichal

HALF_DENSITY = 1025.0 / 2.0
GRAVITY = 9.81


@dataclass
class Piece:
    """One piece of a line; the names and units are those of `Line`.

    `clamps` holds (distance from the piece's top, buoyancy, volume, drag, lift if any) of each.
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
    clamps: list[tuple[float, ...]] = field(default_factory=list)
    lift: float = 0.0
    diameter: float = 0.0

    @property
    def total(self) -> float:
        """Net force with the clamps [N]."""
        own = self.buoyancy * (self.length if self.flexible else 1.0)
        return own + sum(buoyancy for _, buoyancy, *_ in self.clamps)

    @property
    def resistance(self) -> float:
        """Drag at 1 m/s across it, with the clamps [N/(m/s)²]."""
        own = self.normal_drag * (self.length if self.flexible else 1.0)
        return own + sum(drag for _, _, _, drag, *_ in self.clamps)


def point(buoyancy: float, drag: float) -> Piece:
    """A piece without length: buoyancy [N], drag at 1 m/s [N/(m/s)²]."""
    return Piece(0.0, False, buoyancy, drag, drag, directional=False)


def sphere_drag(diameter: float, cx: float) -> float:
    """Drag of a sphere at 1 m/s [N/(m/s)²]."""
    return HALF_DENSITY * cx * pi / 4.0 * diameter**2


def cable(
    length: float, diameter: float, weight: float, cn: float, ct: float, compliance: float = 0.0
) -> Piece:
    """Rope or wire: weight in water [N/m], Cn on its diameter, Ct on its surface π D."""
    normal, tangential = HALF_DENSITY * diameter * cn, HALF_DENSITY * pi * diameter * ct
    return Piece(
        length, True, -weight, normal, tangential, compliance=compliance, thinning=0.5,
        diameter=diameter,
    )  # fmt: skip


def line_of(
    *pieces: Piece,
    anchor_height: float = 0.0,
    friction: Friction = Friction.BERTEAUX,
    strumming: BourgetMarichal | None = None,
) -> Line:
    """The arrays of a list of pieces."""
    held = [
        (owner, *clamp, 0.0)[:6] for owner, piece in enumerate(pieces) for clamp in piece.clamps
    ]
    owner, at, buoyancy, volume, drag, lift = zip(*held, strict=True) if held else ((),) * 6
    columns = (
        "length", "flexible", "buoyancy", "volume", "normal_drag", "tangential_drag",
        "directional", "compliance", "thinning", "lift", "diameter",
    )  # fmt: skip
    return Line(
        **{name: np.array([getattr(piece, name) for piece in pieces]) for name in columns},
        clamp_piece=np.array(owner, dtype=int), clamp_at=np.array(at),
        clamp_buoyancy=np.array(buoyancy), clamp_volume=np.array(volume),
        clamp_drag=np.array(drag), clamp_lift=np.array(lift), anchor_height=anchor_height,
        friction=friction, strumming=strumming,
    )  # fmt: skip


def stream(depth: float, speed: float, density: float = 1025.0, toward: float = 0.0) -> Water:
    """Water with the same current everywhere, towards an angle counted from east [rad]."""
    u, v = speed * np.cos(toward), speed * np.sin(toward)
    return Water(
        depth=depth, level=np.array([0.0]), u=np.array([u]), v=np.array([v]), w=np.array([0.0]),
        density=np.array([density]), gravity=GRAVITY,
    )  # fmt: skip


def profile(depth: float, rows: list[tuple[float, float]], density: float = 1025.0) -> Water:
    """Water with an eastward current: rows of (depth [m], speed [m/s])."""
    level, u = np.array(rows).T
    still = np.zeros_like(u)
    return Water(
        depth=depth, level=level, u=u, v=still, w=still, density=still + density, gravity=GRAVITY
    )
