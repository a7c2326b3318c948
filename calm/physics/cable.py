"""A stretch of cable or chain: straight segments, hinged, each in moment equilibrium."""

from __future__ import annotations

from dataclasses import replace
from math import asin, copysign, inf, sqrt

from calm.physics.element import Vector, amplified_share, axis_along, drag_force, drag_share
from calm.physics.friction import Friction
from calm.physics.line import REFERENCE_DENSITY
from calm.physics.profile import Profile
from calm.physics.state import MarchError, State, Trace
from calm.physics.track import Cable, Vibration

MOST_SEGMENTS = 50_000
_PASSES = 200
_BERTEAUX, _HOERNER = Friction.BERTEAUX, Friction.HOERNER


def march_cable(
    cable: Cable,
    profile: Profile,
    state: State,
    angle_step: float,
    reach: float,
    given: list[float] | None,
    trace: Trace | None,
    lands: bool = False,
) -> tuple[list[float], float | None]:
    """Take the state from the top of a stretch of cable to its bottom.

    Parameters
    ----------
    angle_step, reach : how much a segment may turn [rad] and how long it may be [m]
    given : the unstretched lengths of the segments to use [m]; None chooses them
    lands : whether to stop where the line has no more weight to give: its touchdown

    Returns
    -------
    cuts : the unstretched lengths of the segments for the whole stretch [m]
    hanging : the unstretched length above its touchdown [m]; None where it has none

    Raises
    ------
    MarchError
        Where a segment finds no balance or more than 50 000 would be needed.
    """
    used: list[float] = []
    done = 0.0
    while done < cable.length or not used:
        left = cable.length - done
        if given is not None:
            if len(used) == len(given):
                break
            cut = given[len(used)]
        else:
            cut = min(left, segment_length(cable, profile, state, angle_step, reach))
            if left - cut < 0.01 * cut:
                cut = left
        used.append(cut)
        if lands and state.fz > 0.0:
            hanging = _touchdown(cable, profile, state, cut)
            if hanging < cut:
                _pass_segment(cable, profile, state, hanging, trace)
                state.fz = 0.0
                if trace is not None:
                    trace.force[-1] = (state.fx, state.fy, 0.0)
                return given or [*used, *evenly(left - cut, reach)], done + hanging
        _pass_segment(cable, profile, state, cut, trace)
        done += cut
        if len(used) > MOST_SEGMENTS:
            raise MarchError(f"the line would need more than {MOST_SEGMENTS} segments")
    return used, None


def evenly(length: float, reach: float) -> list[float]:
    """Segments of one length for a cable that is not marched [m]."""
    count = max(round(length / reach), 1)
    return [length / count] * count if length > 0.0 else []


def _touchdown(cable: Cable, profile: Profile, state: State, cut: float) -> float:
    """How much of a segment hangs before its end has nothing left to carry [m]; at most `cut`."""
    low, high, hanging = 0.0, cut, cut
    for _ in range(_PASSES):
        probe = replace(state)
        _pass_segment(cable, profile, probe, hanging, None)
        if hanging == cut and probe.fz > 0.0:
            return cut
        if abs(probe.fz) <= 1e-12 * state.fz:
            break
        if probe.fz > 0.0:
            low = hanging
        else:
            high = hanging
        following = hanging * state.fz / (state.fz - probe.fz)
        hanging = following if low < following < high else 0.5 * (low + high)
    return hanging


def _pass_segment(
    cable: Cable, profile: Profile, state: State, cut: float, trace: Trace | None
) -> None:
    """Take the state over one segment of an unstretched length [m].

    The segment's axis, its drag at mid-height and its stretch depend on each other: passes repeat
    until its rise per unstretched metre settles. They contract by about change/earlier each.
    """
    kn, kt = cable.normal_drag, cable.tangential_drag
    berteaux, hoerner = cable.friction is _BERTEAUX, cable.friction is _HOERNER
    vibration = cable.vibration
    compliance, thinning, elongation = cable.compliance, cable.thinning, cable.elongation
    levels, rows, gravity = profile.levels, profile.rows, profile.gravity
    fx, fy, fz, z, level = state.fx, state.fy, state.fz, state.z, state.level
    half = 0.5 * cut
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    strain = cable.strain(tension)
    rise = state.tz * (1.0 + strain)
    axis: Vector = (-fx, -fy, -fz)
    earlier = inf
    for _ in range(_PASSES):
        depth = -z - half * rise
        if not levels[level] <= depth < levels[level + 1]:
            level = profile.interval(depth, level)
        origin, u, du, v, dv, w, dw, density, ddensity = rows[level]
        below = depth - origin
        u, v, w = u + du * below, v + dv * below, w + dw * below
        density += ddensity * below
        area = cut * density / REFERENCE_DENSITY
        if strain:
            area *= (1.0 + strain) ** thinning
        lift = cut * (cable.buoyancy + (density - REFERENCE_DENSITY) * gravity * cable.volume)
        ax, ay, az = fx, fy, fz + 0.5 * lift
        if hoerner:
            pull = 0.5 * kt * area * sqrt(u * u + v * v + w * w)
            ax, ay, az = ax + pull * u, ay + pull * v, az + pull * w
        if vibration is None:
            factor, c = 1.0, drag_share(ax, ay, az, 0.5 * kn * area, u, v, w)
        else:
            c, factor = _vibrating_share(vibration, ax, ay, az, 0.5 * kn * area, u, v, w, axis)
        axis = tx, ty, tz = axis_along(ax, ay, az, c, u, v, w)
        along = kt * area if berteaux else 0.0
        qx, qy, qz = drag_force(factor * kn * area, along, u, v, w, tx, ty, tz)
        if not berteaux:
            px, py, pz = _friction_force(cable.friction, kt * area, u, v, w, tx, ty, tz)
            qx, qy, qz = qx + px, qy + py, qz + pz
        hx, hy, hz = fx + 0.5 * qx, fy + 0.5 * qy, fz + 0.5 * (qz + lift)
        if hx * tx + hy * ty + hz * tz > 0.0:
            tx, ty, tz = -tx, -ty, -tz
        strain = compliance * sqrt(hx * hx + hy * hy + hz * hz)
        if elongation is not None:  # of all the tensions in it, so that it may be as long as others
            bottom = sqrt((fx + qx) ** 2 + (fy + qy) ** 2 + (fz + qz + lift) ** 2)
            middle = sqrt(hx * hx + hy * hy + hz * hz)
            strain = elongation.mean_strain(middle, 0.5 * (bottom - tension))
        change = abs(tz * (1.0 + strain) - rise)
        rise = tz * (1.0 + strain)
        if change < 1e-12 or change * change < 1e-12 * earlier < inf:
            break
        earlier = change
    else:
        raise MarchError("a segment finds no balance")
    stretched = cut * (1.0 + strain)
    state.x += stretched * tx
    state.y += stretched * ty
    state.z += stretched * tz
    state.fx, state.fy, state.fz = fx + qx, fy + qy, fz + qz + lift
    state.tz, state.level = tz, level
    if trace is not None:
        trace.element(cable.piece, -1, cut, strain)
        trace.node(state.x, state.y, state.z, (state.fx, state.fy, state.fz))


def _friction_force(
    friction: Friction,
    kt: float,
    u: float,
    v: float,
    w: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Friction of the current u, v, w on a cable of axis t [N], by a law that is not Berteaux's."""
    squared = u * u + v * v + w * w
    if friction is _HOERNER:
        pull = kt * sqrt(squared)
        return pull * u, pull * v, pull * w
    along = u * tx + v * ty + w * tz
    pull = copysign(kt * squared, along) if along else 0.0
    return pull * tx, pull * ty, pull * tz


def _vibrating_share(
    vibration: Vibration,
    ax: float,
    ay: float,
    az: float,
    k: float,
    u: float,
    v: float,
    w: float,
    axis: Vector,
) -> tuple[float, float]:
    """`drag_share` of a cable that strums, and the factor on its Cn.

    `axis` is the last known one. Where the segment's own drag hardly turns it the factor there
    will do for this pass.
    """
    speed = sqrt(u * u + v * v + w * w)
    if speed == 0.0:
        return 0.0, 1.0
    law, beat = vibration.law, vibration.beat / speed
    if k * law.greatest * speed * speed > 0.1 * sqrt(ax * ax + ay * ay + az * az):
        return amplified_share(ax, ay, az, k, lambda sine: law.factor(asin(sine), beat), u, v, w)
    tx, ty, tz = axis
    cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    sine = across / (speed * sqrt(tx * tx + ty * ty + tz * tz))
    factor = law.factor(asin(min(sine, 1.0)), beat)
    return drag_share(ax, ay, az, k * factor, u, v, w), factor


def segment_length(
    cable: Cable, profile: Profile, state: State, angle_step: float, reach: float
) -> float:
    """How long the next segment may be [m]: by its turn, by depth, and to the next level.

    The turn is that of the load at either end of the segment, the tension that at its top. Near a
    free end the tension vanishes: a floor keeps the count finite.
    """
    tension = sqrt(state.fx * state.fx + state.fy * state.fy + state.fz * state.fz)
    depth = -state.z
    strain = cable.strain(tension)
    sinking = (1.0 + strain) * state.fz / tension if tension > 0.0 else 1.0
    length, floor = reach, 1e-4 * reach
    for _ in (0, 1):
        rate = _rate_of_turn(cable, profile, state, tension, depth, angle_step)
        if rate > 0.0:
            length = min(length, max(tension / rate, floor))
        depth = -state.z + length * sinking
    gap = profile.distance_to_level(-state.z, sinking, state.level, 0.01 * length)
    return min(gap, length)


def _rate_of_turn(
    cable: Cable,
    profile: Profile,
    state: State,
    tension: float,
    depth: float,
    angle_step: float,
) -> float:
    """Tension over the allowed length [N/m] for the load at a depth.

    Where a slack line hangs on little more than its own weight it may turn within one segment, so
    the tension may not fall by more than half in it either.
    """
    u, v, w, density = profile.at(depth, state.level)
    lift = cable.buoyancy + (density - REFERENCE_DENSITY) * profile.gravity * cable.volume
    tx, ty, tz = 0.0, 0.0, -1.0
    if tension > 0.0:
        tx, ty, tz = -state.fx / tension, -state.fy / tension, -state.fz / tension
    kn = cable.normal_drag * density / REFERENCE_DENSITY
    if cable.vibration is not None:
        kn *= cable.vibration.law.greatest
    qx, qy, qz = drag_force(kn, 0.0, u, v, w, tx, ty, tz)
    along = lift * tz
    qx, qy, qz = qx - along * tx, qy - along * ty, qz + lift - along * tz
    rate = sqrt(qx * qx + qy * qy + qz * qz) / angle_step
    return max(rate, 2.0 * along) if tension > 0.0 else rate
