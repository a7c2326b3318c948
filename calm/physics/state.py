"""Where a march stands, and the record it may leave."""

from __future__ import annotations

from dataclasses import dataclass, field

from calm.physics.element import Vector


class MarchError(ArithmeticError):
    """The march cannot go on: an element has no balance, or the line needs endless segments."""


@dataclass(slots=True)
class State:
    """The point reached: place [m], force above it [N], last axis's rise, profile interval."""

    x: float
    y: float
    z: float
    fx: float = 0.0
    fy: float = 0.0
    fz: float = 0.0
    tz: float = -1.0
    level: int = 0

    def add(self, load: Vector) -> None:
        """Take on a load [N]."""
        self.fx += load[0]
        self.fy += load[1]
        self.fz += load[2]


@dataclass
class Trace:
    """What a recorded march leaves: nodes and the elements between them, free end first."""

    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    z: list[float] = field(default_factory=list)
    force: list[Vector] = field(default_factory=list)
    piece: list[int] = field(default_factory=list)
    clamp: list[int] = field(default_factory=list)
    cut: list[float] = field(default_factory=list)
    strain: list[float] = field(default_factory=list)

    def node(self, x: float, y: float, z: float, force: Vector) -> None:
        """Add a node: its place [m] and the force above it [N]."""
        self.x.append(x)
        self.y.append(y)
        self.z.append(z)
        self.force.append(force)

    def element(self, piece: int, clamp: int, cut: float, strain: float) -> None:
        """Add the element that ends at the next node; `clamp` is -1 for a part of the piece."""
        self.piece.append(piece)
        self.clamp.append(clamp)
        self.cut.append(cut)
        self.strain.append(strain)
