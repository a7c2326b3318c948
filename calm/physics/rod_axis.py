"""Inclination of a rigid body: axis for which the moments about the midpoint of the body vanish."""

from collections.abc import Sequence
from math import inf, sqrt

from calm.physics.compiled import within
from calm.physics.drag import Vector, axis_along, drag_force, drag_share
from calm.physics.line import NO_BALANCE, State
from calm.physics.profile import Sea, viscosity_at, water_at
from calm.physics.reynolds import Smooth, drag_variation, varying_share
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.track import Load, Stage

_PASSES, _FEW = 200, 6
_HALVINGS = 60
_NOTHING = 1e-12


def rod_axis(rod: Stage, loads: Sequence[Load], sea: Sea, state: State, near: float) -> Vector:
    """Compute the axis of a rod for which the moments about the midpoint vanish.

    The axis is parallel to F + Σ (1 - a_i/L) q_i. F is the force above the rod, and the loads q_i
    act at distances a_i from the top of the rod of length L.

    Parameters
    ----------
    near : allowed error of the depth at which the water is sampled [m]; 0 for full precision

    Returns
    -------
    The unit axis. The vertical component is `NO_BALANCE` if no axis is in balance.
    """
    _, _, _, fx, fy, fz, rise, _ = state
    tx, ty, tz = 0.0, 0.0, rise
    damping, earlier, settled = 1.0, inf, 1e-12
    if near > 0.0:
        pull = sqrt(fx * fx + fy * fy + fz * fz)
        if pull > 0.0:
            tx, ty, tz = -fx / pull, -fy / pull, -fz / pull
        settled = min(near / rod.length, 1e-4) if rod.length > 0.0 else 1e-4
        if rod.size == 1 and loads[rod.first].diameter == 0.0:
            x, y, z = lone_axis(loads[rod.first], sea, state, tx, ty, tz, settled)
            if z != NO_BALANCE:
                return x, y, z
    for _ in range(_PASSES):
        x, y, z = _following_axis(rod, loads, sea, state, tz, tx, ty, tz)
        change = abs(x - tx) + abs(y - ty) + abs(z - tz)
        if change < settled:
            return x, y, z
        if change > 0.7 * earlier:
            damping *= 0.5
        earlier = change
        if damping < 1.0:
            x, y, z = tx + damping * (x - tx), ty + damping * (y - ty), tz + damping * (z - tz)
            size = sqrt(x * x + y * y + z * z)
            if size == 0.0:
                break
            x, y, z = x / size, y / size, z / size
        tx, ty, tz = x, y, z
    return bracketed_axis(rod, loads, sea, state)


def lone_axis(
    load: Load, sea: Sea, state: State, tx: float, ty: float, tz: float, settled: float
) -> Vector:
    """Return the axis of a rod with a single load of constant drag, by a short iteration.

    The iteration starts at the axis t. The vertical component of the result is `NO_BALANCE` if the
    iteration fails.
    """
    _, _, z, fx, fy, fz, _, level = state
    for _ in range(_FEW):
        depth = -z - load.at * tz
        u, v, w, density, level = water_at(sea, depth, level)
        squared = u * u + v * v + w * w
        ax, ay = fx + load.lever * load.push_east, fy + load.lever * load.push_north
        az = fz + load.lever * load_lift(load, squared, density, sea.gravity)
        k = load.lever * density / REFERENCE_DENSITY * load.normal_drag
        c = drag_share(ax, ay, az, k, u, v, w) if load.directional else k * sqrt(squared)
        x, y, rise = axis_along(ax, ay, az, c, u, v, w)
        change = abs(rise - tz)
        tx, ty, tz = x, y, rise
        if change < settled:
            # under tension, not compression
            if (ax + c * u) * x + (ay + c * v) * y + (az + c * w) * rise < 0.0 or fz <= 0.0:
                return x, y, rise
            break
    return tx, ty, NO_BALANCE


def bracketed_axis(rod: Stage, loads: Sequence[Load], sea: Sea, state: State) -> Vector:
    """Return the axis of a rod by bisection, if the iteration in `rod_axis` does not converge.

    A trial value s of the vertical component of the axis sets the depths at which the water is
    sampled. In this water, the axis in moment balance has the vertical component r(s). The
    bisection finds s = r(s). If r(s) - s jumps past zero, the axis at the jump is tried. If it is
    not in balance, the vertical component of the result is `NO_BALANCE`.
    """
    low, high = -1.0, 1.0
    tx, ty, tz = 0.0, 0.0, -1.0
    east, north = 1.0, 0.0
    for _ in range(_HALVINGS):
        rise = 0.5 * (low + high)
        tx, ty, tz = _axis_in_water_at(rod, loads, sea, state, rise, tx, ty, tz)
        if tx != 0.0 or ty != 0.0:
            across = sqrt(tx * tx + ty * ty)
            east, north = tx / across, ty / across
        if abs(tz - rise) < 1e-14:
            return tx, ty, tz
        low, high = (rise, high) if tz > rise else (low, rise)
    across = sqrt(max(1.0 - low * low, 0.0))
    tx, ty, tz = across * east, across * north, low
    if _turning(rod, loads, sea, state, tx, ty, tz) > _NOTHING:
        return tx, ty, NO_BALANCE
    return tx, ty, tz


def _axis_in_water_at(
    rod: Stage,
    loads: Sequence[Load],
    sea: Sea,
    state: State,
    rise: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Return the axis of a rod in balance, in water sampled as in `_following_axis`."""
    damping, earlier = 1.0, inf
    for _ in range(_PASSES):
        x, y, z = _following_axis(rod, loads, sea, state, rise, tx, ty, tz)
        change = abs(x - tx) + abs(y - ty) + abs(z - tz)
        if change < 1e-15:
            return x, y, z
        if change > 0.7 * earlier:
            damping *= 0.7
        earlier = change
        x, y, z = tx + damping * (x - tx), ty + damping * (y - ty), tz + damping * (z - tz)
        size = sqrt(x * x + y * y + z * z)
        if size == 0.0:
            return tx, ty, tz
        tx, ty, tz = x / size, y / size, z / size
    return tx, ty, tz


def _turning(
    rod: Stage, loads: Sequence[Load], sea: Sea, state: State, tx: float, ty: float, tz: float
) -> float:
    """Return the force that rotates a rod of axis t, relative to its buoyancy and drag."""
    _, _, z, fx, fy, fz, _, level = state
    own = 0.0
    for i in range(rod.first, rod.first + rod.size):
        load = loads[i]
        qx, qy, qz = force_at(load, sea, -z - load.at * tz, level, tx, ty, tz)
        fx, fy, fz = fx + load.lever * qx, fy + load.lever * qy, fz + load.lever * qz
        own += load.lever * (load.normal_drag + abs(load.buoyancy))
    return speed_across(fx, fy, fz, tx, ty, tz) / own if own > 0.0 else 0.0


def _following_axis(
    rod: Stage,
    loads: Sequence[Load],
    sea: Sea,
    state: State,
    rise: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Return the next iterate of the axis of a rod, from the axis t.

    The water is sampled at the depths that the loads have if the vertical component of the axis is
    `rise`.
    """
    _, _, z, fx, fy, fz, _, level = state
    ax, ay, az = fx, fy, fz
    normals = 0
    k = smooth = 0.0
    total = gx = gy = gz = 0.0
    u = v = w = 0.0
    curve = Smooth(0.0, 0.0)
    for i in range(rod.first, rod.first + rod.size):
        load = loads[i]
        lever = load.lever
        depth = -z - load.at * rise
        flow_u, flow_v, flow_w, density, _ = water_at(sea, depth, level)
        squared = flow_u * flow_u + flow_v * flow_v + flow_w * flow_w
        ax, ay = ax + lever * load.push_east, ay + lever * load.push_north
        az += lever * load_lift(load, squared, density, sea.gravity)
        kn = lever * density / REFERENCE_DENSITY * load.normal_drag
        varied, smooth = 1.0, 0.0
        if load.diameter > 0.0:
            viscosity = viscosity_at(sea, depth)
            smooth = load.diameter / viscosity
            varied = load_variation(load, viscosity, flow_u, flow_v, flow_w, tx, ty, tz)
        if not load.directional:
            drag = varied * kn * sqrt(squared)
            ax, ay, az = ax + drag * flow_u, ay + drag * flow_v, az + drag * flow_w
            continue
        normals += 1
        k, u, v, w, curve = kn, flow_u, flow_v, flow_w, Smooth(smooth, load.lengthening)
        if rod.size > 1:
            share = varied * kn * speed_across(u, v, w, tx, ty, tz)
            total += share
            gx, gy, gz = gx + share * u, gy + share * v, gz + share * w
    # Several normal drags are replaced by the drag of one element, which equals their sum at the
    # present axis. The axis of this element is exact.
    if normals == 1 and curve.reynolds > 0.0:
        c = varying_share(ax, ay, az, k, curve, u, v, w)
    else:
        if normals != 1:
            k = u = v = w = 0.0
            if total > 0.0:
                u, v, w = gx / total, gy / total, gz / total
                across = speed_across(u, v, w, tx, ty, tz)
                k = total / across if across > 0.0 else 0.0
        c = drag_share(ax, ay, az, k, u, v, w)
    tx, ty, tz = axis_along(ax, ay, az, c, u, v, w)
    mx, my, mz = fx, fy, fz
    for i in range(rod.first, rod.first + rod.size):
        load = loads[i]
        qx, qy, qz = force_at(load, sea, -z - load.at * rise, level, tx, ty, tz)
        mx, my, mz = mx + load.lever * qx, my + load.lever * qy, mz + load.lever * qz
    return (-tx, -ty, -tz) if mx * tx + my * ty + mz * tz > 0.0 else (tx, ty, tz)


def load_lift(load: Load, squared: float, density: float, gravity: float) -> float:
    """Return the sum of net buoyancy and hydrodynamic lift of a rigid piece or clamp [N].

    `squared` is the square of the current speed [m²/s²].
    """
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
    """Return the force on a rigid piece or clamp with unit axis t [N].

    The force is the sum of net buoyancy, drag, lift and wind force. `varied` is the drag ratio from
    `load_variation`.
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
    """Return the ratio of the normal drag on a body to the drag with constant coefficients.

    (tx, ty, tz) is the unit vector along the axis of the body. The viscosity is in m²/s.
    """
    if load.diameter == 0.0:
        return 1.0
    speed = speed_across(u, v, w, tx, ty, tz)
    if not load.directional:
        speed = sqrt(u * u + v * v + w * w)
    return drag_variation(Smooth(load.diameter / viscosity, load.lengthening), speed)


def force_at(
    load: Load, sea: Sea, depth: float, level: int, tx: float, ty: float, tz: float
) -> Vector:
    """Return the result of `load_force` for the water at a depth [m].

    The search for the depth interval of the water profile starts at interval `level`.
    """
    u, v, w, density, _ = water_at(sea, depth, level)
    varied = 1.0
    if load.diameter > 0.0:
        varied = load_variation(load, viscosity_at(sea, depth), u, v, w, tx, ty, tz)
    return load_force(load, varied, u, v, w, density, sea.gravity, tx, ty, tz)


def speed_across(u: float, v: float, w: float, tx: float, ty: float, tz: float) -> float:
    """Return the speed |V × t| of a current V normal to a unit axis t [m/s]."""
    cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
    return sqrt(cx * cx + cy * cy + cz * cz)
