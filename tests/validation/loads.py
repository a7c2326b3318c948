"""What the referee knows of the water, and of the forces on one piece, clamp or metre of cable."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from math import copysign, sqrt

import numpy as np
from numpy.typing import NDArray

from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.physics.reynolds import DragCurve
from tests.validation.smooth import Smooth
from tests.validation.vibration import Vibration

Vector = NDArray[np.float64]
Flow = tuple[float, float, float, float]
"""Current u, v, w [m/s] and density [kg/m³] at a point."""

DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Load:
    """The net force of one rigid piece, one clamp or one metre of cable."""

    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: bool
    gravity: float
    lift: float = 0.0
    friction: Friction = Friction.BERTEAUX
    vibration: Vibration | None = None
    smooth: Smooth | None = None
    push: tuple[float, float] = (0.0, 0.0)

    def force(self, flow: Flow, axis: Vector, swelling: float = 1.0) -> Vector:
        """Buoyancy, lift, drag and wind [N] with the axis along the unit vector `axis`."""
        return np.array(self.pull(flow, *axis.tolist(), swelling))

    def pull(
        self, flow: Flow, x: float, y: float, z: float, swelling: float = 1.0
    ) -> tuple[float, float, float]:
        """The same of plain numbers, the unit vector's parts one by one: it is asked for often."""
        u, v, w, density = flow
        speed = sqrt(u * u + v * v + w * w)
        # Drag is `normal` times the flow and `tangential` times the axis.
        varied = self.smooth.factor if self.smooth else lambda _: 1.0
        normal, tangential = self.normal_drag * varied(speed) * speed, 0.0
        if self.directional:
            along = u * x + v * y + w * z
            across = sqrt((u - along * x) ** 2 + (v - along * y) ** 2 + (w - along * z) ** 2)
            normal = self.normal_drag * varied(across) * across
            if self.vibration:
                normal *= self.vibration.factor(speed, across)
            tangential = -normal * along
            if self.friction is Friction.BERTEAUX:
                tangential += self.tangential_drag * abs(along) * along
            elif self.friction is Friction.HOERNER:
                normal += self.tangential_drag * speed
            else:
                tangential += self.tangential_drag * copysign(speed, along) * speed
        scale = density / 1025.0 * swelling
        lift = density / 1025.0 * self.lift * speed * speed
        lift += self.buoyancy + (density - 1025.0) * self.gravity * self.volume
        return (
            scale * (normal * u + tangential * x) + self.push[0],
            scale * (normal * v + tangential * y) + self.push[1],
            scale * (normal * w + tangential * z) + lift,
        )


def on_piece(
    line: Line, piece: int, gravity: float, share: float = 1.0, frequency: float = 0.0
) -> Load:
    """The load of a piece of a line, or of a metre of it where it is cable.

    `share` is the part of its buoyancy in use, `frequency` [Hz] that of a line that strums.
    """
    cable = bool(line.flexible[piece])
    strums = cable and line.strumming is not None and line.diameter[piece] > 0.0
    return Load(
        share * float(line.buoyancy[piece]), share * float(line.volume[piece]),
        float(line.normal_drag[piece]), float(line.tangential_drag[piece]),
        bool(line.directional[piece]), gravity, float(line.lift[piece]),
        line.friction if cable else Friction.BERTEAUX,
        Vibration(line.strumming, float(line.diameter[piece]), frequency) if strums else None,
        _smooth(line.drag_curve, piece),
        (float(line.push_east[piece]), float(line.push_north[piece])),
    )  # fmt: skip


def on_clamp(line: Line, clamp: int, gravity: float) -> Load:
    """The load of a clamped instrument."""
    drag = float(line.clamp_drag[clamp])
    return Load(
        float(line.clamp_buoyancy[clamp]), float(line.clamp_volume[clamp]), drag, drag, False,
        gravity, float(line.clamp_lift[clamp]), smooth=_smooth(line.clamp_drag_curve, clamp),
    )  # fmt: skip


def _smooth(curves: Sequence[DragCurve | None], index: int) -> Smooth | None:
    curve = curves[index] if curves else None
    return Smooth(curve.diameter, curve.slenderness) if curve else None


class Profile:
    """The water, linear in depth band by band; band k lies between levels k - 1 and k."""

    def __init__(self, water: Water) -> None:
        self.levels = [float(level) for level in water.level]
        table = np.column_stack([water.u, water.v, water.w, water.density])
        slopes = np.diff(table, axis=0) / np.diff(water.level)[:, None]
        still = np.zeros((1, 4))
        self.origins = [self.levels[0], *self.levels]
        self.values = np.vstack([table[:1], table]).tolist()
        self.slopes = np.vstack([still, slopes, still]).tolist()

    def band(self, depth: float, rising: bool = False) -> int:
        """The band of a depth; on a level, the one a rising or sinking line is about to enter."""
        return (bisect_left if rising else bisect_right)(self.levels, depth)

    def flow(self, depth: float, band: int) -> Flow:
        """Water at a depth by the straight line of `band`, prolonged beyond it if need be."""
        (u, v, w, density), (du, dv, dw, ddensity) = self.values[band], self.slopes[band]
        h = depth - self.origins[band]
        return u + du * h, v + dv * h, w + dw * h, density + ddensity * h

    def at(self, depth: float) -> Flow:
        """Water at a depth."""
        return self.flow(depth, self.band(depth))

    def limits(self, band: int) -> tuple[float, float]:
        """The least and greatest depth of a band."""
        bounds = [-np.inf, *self.levels, np.inf]
        return bounds[band], bounds[band + 1]
