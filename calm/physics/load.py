"""The forces of the water on a rigid piece or clamp."""

from __future__ import annotations

from math import sqrt

from calm.physics.compiled import within
from calm.physics.element import Vector, drag_force
from calm.physics.profile import Sea, viscosity_at, water_at
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.reynolds import Smooth, drag_variation
from calm.physics.track import Load


@within
def load_lift(load: Load, squared: float, density: float, gravity: float) -> float:
    """Buoyancy of a rigid piece or clamp and its lift in a current of a squared speed [N]."""
    lift = load.buoyancy + (density - REFERENCE_DENSITY) * gravity * load.volume
    return lift + density / REFERENCE_DENSITY * load.lift * squared


@within
def load_force(
    load: Load,
    varied: float,
    u: float,
    v: float,
    w: float,
    density: float,
    gravity: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Buoyancy, drag, lift and wind of a rigid piece or clamp of axis t [N].

    Parameters
    ----------
    varied : how many times its constant normal drag it has: see `load_variation`
    """
    scale, squared = density / REFERENCE_DENSITY, u * u + v * v + w * w
    kn = varied * scale * load.normal_drag
    if load.directional:
        qx, qy, qz = drag_force(kn, scale * load.tangential_drag, u, v, w, tx, ty, tz)
    else:
        drag = kn * sqrt(squared)
        qx, qy, qz = drag * u, drag * v, drag * w
    lift = load_lift(load, squared, density, gravity)
    return qx + load.push_east, qy + load.push_north, qz + lift


def load_variation(
    load: Load, viscosity: float, u: float, v: float, w: float, tx: float, ty: float, tz: float
) -> float:
    """Return how many times its constant normal drag a load of axis t has, in water of a
    viscosity.
    """
    if load.diameter == 0.0:
        return 1.0
    speed = speed_across(u, v, w, tx, ty, tz)
    if not load.directional:
        speed = sqrt(u * u + v * v + w * w)
    return drag_variation(Smooth(load.diameter / viscosity, load.lengthening), speed)


@within
def force_at(
    load: Load, sea: Sea, depth: float, level: int, tx: float, ty: float, tz: float
) -> Vector:
    """`load_force` at a depth [m] of the sea, searched from an interval."""
    u, v, w, density, _ = water_at(sea, depth, level)
    varied = 1.0
    if load.diameter > 0.0:
        varied = load_variation(load, viscosity_at(sea, depth), u, v, w, tx, ty, tz)
    return load_force(load, varied, u, v, w, density, sea.gravity, tx, ty, tz)


def speed_across(u: float, v: float, w: float, tx: float, ty: float, tz: float) -> float:
    """|V × t| [m/s]."""
    cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
    return sqrt(cx * cx + cy * cy + cz * cz)
