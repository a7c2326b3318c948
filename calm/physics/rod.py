"""A rigid body in moment equilibrium: one piece with its clamps, or the head of the line."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, sqrt

from calm.physics.element import Vector, axis_along, drag_force, drag_share, varying_share
from calm.physics.line import REFERENCE_DENSITY
from calm.physics.profile import Profile
from calm.physics.reynolds import DragCurve
from calm.physics.state import MarchError, State, Trace
from calm.physics.track import Load, Rod

_PASSES = 200


def load_force(load: Load, profile: Profile, depth: float, axis: Vector, level: int) -> Vector:
    """Buoyancy, drag and lift of a rigid piece or clamp at a depth [N], searched from `level`."""
    u, v, w, density = profile.at(depth, level)
    scale = density / REFERENCE_DENSITY
    lift = load.buoyancy + (density - REFERENCE_DENSITY) * profile.gravity * load.volume
    if load.lift:
        lift += scale * load.lift * (u * u + v * v + w * w)
    kn = scale * load.normal_drag
    if load.directional:
        if load.curve is not None:
            kn *= _variation(load.curve, profile, depth)(_speed_across(axis, u, v, w))
        qx, qy, qz = drag_force(kn, scale * load.tangential_drag, u, v, w, *axis)
    else:
        speed = sqrt(u * u + v * v + w * w)
        if load.curve is not None:
            kn *= _variation(load.curve, profile, depth)(speed)
        drag = kn * speed
        qx, qy, qz = drag * u, drag * v, drag * w
    return qx + load.push_east, qy + load.push_north, qz + lift


def _variation(curve: DragCurve, profile: Profile, depth: float) -> Callable[[float], float]:
    """How many times its constant drag a load on a curve has, by the speed it goes with [m/s]."""
    per_speed = curve.diameter / profile.viscosity(depth)
    return lambda speed: curve.factor(per_speed * speed)


def _speed_across(axis: Vector, u: float, v: float, w: float) -> float:
    """|V × t| [m/s]."""
    tx, ty, tz = axis
    cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
    return sqrt(cx * cx + cy * cy + cz * cz)


def pass_rod(
    rod: Rod, profile: Profile, state: State, trace: Trace | None, lands: bool = False
) -> float | None:
    """Take the state from the top of a rod to its bottom.

    Parameters
    ----------
    lands : whether the seabed carries what the line cannot: at the rod's lower end, or all along
        it where it would tip over

    Returns
    -------
    0 where the rod lies on the seabed, inf where it stands on it, None where it does neither.
    """
    axis = rod_axis(rod, profile, state)
    forces = [
        load_force(load, profile, -state.z - load.at * axis[2], axis, state.level)
        for load in rod.loads
    ]
    landed = lands and state.fz > 0.0 >= state.fz + sum(force[2] for force in forces)
    if landed and axis[2] >= 0.0:
        state.fz = 0.0
        return 0.0
    if trace is not None:
        _record(rod, forces, trace, state, axis)
    state.x += rod.length * axis[0]
    state.y += rod.length * axis[1]
    state.z += rod.length * axis[2]
    state.tz = axis[2]
    for force in forces:
        state.add(force)
    if not landed:
        return None
    state.fz = 0.0
    if trace is not None:
        trace.force[-1] = (state.fx, state.fy, 0.0)
    return inf


def rod_axis(rod: Rod, profile: Profile, state: State) -> Vector:
    """Axis for which the moments about the rod's middle vanish.

    With several loads q_i at distances a_i from the top the rule of one load becomes
    t ∥ F + Σ (1 - a_i/L) q_i. The normal drags are gathered into one current and one coefficient
    that reproduce their sum at the present axis, so each pass solves a single element exactly,
    its drag curve included, and only shear along the rod is left to the passes; where several
    drags follow curves, these are, too.

    Raises
    ------
    MarchError
        Where the passes do not settle.
    """
    axis: Vector = (0.0, 0.0, state.tz)
    pace, earlier = 1.0, inf
    for _ in range(_PASSES):
        following = _next_axis(rod, profile, state, axis)
        change = (
            abs(following[0] - axis[0]) + abs(following[1] - axis[1]) + abs(following[2] - axis[2])
        )
        if change < 1e-12:
            return following
        if change > 0.7 * earlier:
            pace *= 0.5
        earlier = change
        if pace < 1.0:
            x, y, z = (old + pace * (new - old) for new, old in zip(following, axis, strict=True))
            size = sqrt(x * x + y * y + z * z)
            if size == 0.0:
                break
            following = x / size, y / size, z / size
        axis = following
    raise MarchError("a rigid piece finds no balance")


def _next_axis(rod: Rod, profile: Profile, state: State, axis: Vector) -> Vector:
    ax, ay, az = state.fx, state.fy, state.fz
    normals: list[tuple[float, float, float, float]] = []
    curved: list[tuple[int, Callable[[float], float]]] = []
    for load in rod.loads:
        ax, ay = ax + load.lever * load.push_east, ay + load.lever * load.push_north
        depth = -state.z - load.at * axis[2]
        u, v, w, density = profile.at(depth, state.level)
        scale = load.lever * density / REFERENCE_DENSITY
        excess = (density - REFERENCE_DENSITY) * profile.gravity
        az += load.lever * (load.buoyancy + excess * load.volume)
        if load.lift:
            az += scale * load.lift * (u * u + v * v + w * w)
        kn = scale * load.normal_drag
        if load.directional:
            if load.curve is not None:
                curved.append((len(normals), _variation(load.curve, profile, depth)))
            normals.append((kn, u, v, w))
        else:
            speed = sqrt(u * u + v * v + w * w)
            if load.curve is not None:
                kn *= _variation(load.curve, profile, depth)(speed)
            drag = kn * speed
            ax, ay, az = ax + drag * u, ay + drag * v, az + drag * w
    if curved and len(normals) == 1:
        k, gx, gy, gz = normals[0]
        c = varying_share(ax, ay, az, k, curved[0][1], gx, gy, gz)
    else:
        for i, varied in curved:
            k, u, v, w = normals[i]
            normals[i] = k * varied(_speed_across(axis, u, v, w)), u, v, w
        k, gx, gy, gz = _gather(normals, axis)
        c = drag_share(ax, ay, az, k, gx, gy, gz)
    tx, ty, tz = following = axis_along(ax, ay, az, c, gx, gy, gz)
    mx, my, mz = state.fx, state.fy, state.fz
    for load in rod.loads:
        depth = -state.z - load.at * tz
        qx, qy, qz = load_force(load, profile, depth, following, state.level)
        mx, my, mz = mx + load.lever * qx, my + load.lever * qy, mz + load.lever * qz
    return (-tx, -ty, -tz) if mx * tx + my * ty + mz * tz > 0.0 else following


def _gather(
    normals: list[tuple[float, float, float, float]], axis: Vector
) -> tuple[float, float, float, float]:
    """One coefficient K and current V with K|V × t|V = Σ K_i|V_i × t|V_i at the axis t."""
    if len(normals) == 1:
        return normals[0]
    total = gx = gy = gz = 0.0
    for k, u, v, w in normals:
        share = k * _speed_across(axis, u, v, w)
        total += share
        gx, gy, gz = gx + share * u, gy + share * v, gz + share * w
    if total == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    gx, gy, gz = gx / total, gy / total, gz / total
    across = _speed_across(axis, gx, gy, gz)
    return (total / across if across > 0.0 else 0.0), gx, gy, gz


def _record(rod: Rod, forces: list[Vector], trace: Trace, state: State, axis: Vector) -> None:
    """Record a rod piece by piece; a piece's own load counts as spread along it, a clamp's not."""
    x, y, z = state.x, state.y, state.z
    fx, fy, fz = state.fx, state.fy, state.fz
    if len(forces) == 1:
        ((qx, qy, qz),) = forces
        tx, ty, tz = axis
        trace.element(rod.pieces[0], -1, rod.length, 0.0)
        x, y, z = x + rod.length * tx, y + rod.length * ty, z + rod.length * tz
        trace.node(x, y, z, (fx + qx, fy + qy, fz + qz))
        return
    loads = list(zip(rod.loads, forces, strict=True))
    start = 0.0
    for piece, length in zip(rod.pieces, rod.lengths, strict=True):
        here = [(load, force) for load, force in loads if load.piece == piece]
        own = next(force for load, force in here if load.clamp < 0)
        clamps = [(load.clamp, load.at, force) for load, force in here if load.clamp >= 0]
        reached, end = start, start + length
        for clamp, at, force in [*clamps, (-1, end, (0.0, 0.0, 0.0))]:
            step = at - reached
            share = step / length if length > 0.0 else float(clamp < 0)
            x, y, z = x + step * axis[0], y + step * axis[1], z + step * axis[2]
            fx, fy, fz = fx + share * own[0], fy + share * own[1], fz + share * own[2]
            trace.element(piece, -1, step, 0.0)
            trace.node(x, y, z, (fx, fy, fz))
            if clamp >= 0:
                fx, fy, fz = fx + force[0], fy + force[1], fz + force[2]
                trace.element(piece, clamp, 0.0, 0.0)
                trace.node(x, y, z, (fx, fy, fz))
            reached = at
        start = end
