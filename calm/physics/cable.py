"""Integration (march) along a cable or chain: straight, hinged segments in moment equilibrium."""

from collections.abc import Sequence
from math import inf, sqrt

from calm.physics.compiled import within
from calm.physics.drag import (
    BERTEAUX,
    CONSTANT,
    HOERNER,
    Vector,
    axis_along,
    drag_force,
    drag_share,
    few_steps_share,
    friction_force,
    turning_friction,
)
from calm.physics.line import NO_BALANCE, Bed, State, off_bed
from calm.physics.profile import (
    Sea,
    counts_across,
    distance_to_bend,
    in_interval,
    level_within,
    water_at,
)
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.stretch import Knot, curve_strain, mean_curve_strain
from calm.physics.strumming import (
    Vibration,
    amplified_share,
    strummed,
    strummed_freely,
    with_beat,
)
from calm.physics.track import CableStretch

# without damping, a slack segment at the upper edge of a current would alternate between hanging
# vertically and trailing with the current
PASSES, STALLED = 200, 50
"""PASSES is the largest number of iterations for one segment.

After STALLED iterations, each iteration makes only half of the computed change.
"""
SWITCH_TOLERANCE = 1e-6
"""Accuracy of the position at which a drag law switches, as a fraction of the segment."""
OF_FRICTION, OF_STRUMMING = range(2)
"""Kinds of drag laws that switch, see `switch_at`."""
AT_A_LEVEL, TRIALS = 1e-9, 10
"""Parameters of the search for the part of a segment that ends at a level of the water profile.

AT_A_LEVEL is the allowed distance from the level, as a fraction of the segment's depth range.
TRIALS is the largest number of iterations.
"""
Passed = tuple[float, State, float, State, float]
"""A marched part of a segment, as five values.

A part that is marched in two halves has

- the unstretched length [m];
- the state at the midpoint;
- the strain of the upper half;
- the state at the bottom;
- the strain of the lower half.

A part that is marched in one piece has the state at the top as second value, 0 as third value, and
the strain of the whole part as last value.
"""
SETTLED_ROTATION = 1e-6
"""Largest squared rotation of a segment in the last Newton step of an approximate march [rad²].

After a larger rotation, the axis of the segment is computed to full precision.
"""


def strain_at(cable: CableStretch, knots: Sequence[Knot], tension: float) -> float:
    """Return the strain of a cable at a tension [N], from its elongation curve or compliance."""
    if cable.first_knot == cable.end_knot:
        return cable.compliance * tension
    return curve_strain(knots, cable.first_knot, cable.end_knot, tension)


def segment_lift(cable: CableStretch, cut: float, density: float, gravity: float) -> float:
    """Return the net buoyancy [N], positive up, of a segment with unstretched length `cut` [m]."""
    return cut * (cable.buoyancy + (density - REFERENCE_DENSITY) * gravity * cable.volume)


def segment_area(cable: CableStretch, cut: float, density: float, strain: float) -> float:
    """Return the length [m] of unstretched cable in reference water with the drag of a segment.

    Stretch multiplies this length by √(1 + strain) if `thinning` is ½ (constant volume). Stretch
    has no effect if `thinning` is 0.
    """
    area = cut * density / REFERENCE_DENSITY
    if strain != 0.0 and cable.thinning != 0.0:
        area *= 1.0 + 2.0 * cable.thinning * (sqrt(1.0 + strain) - 1.0)
    return area


def segment_drag(
    friction: int,
    kn: float,
    kt: float,
    u: float,
    v: float,
    w: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Return the drag of the current u, v, w [m/s] on a segment with unit axis t [N].

    `friction` is the number of the tangential drag law.
    """
    if friction == BERTEAUX:
        return drag_force(kn, kt, u, v, w, tx, ty, tz)
    qx, qy, qz = drag_force(kn, 0.0, u, v, w, tx, ty, tz)
    px, py, pz = friction_force(friction, kt, u, v, w, tx, ty, tz)
    return qx + px, qy + py, qz + pz


@within
def pass_segment(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    cut: float,
    near: float,
    expected: Vector,
) -> tuple[State, float]:
    """Compute the state below a straight segment of cable, and the strain of the segment.

    Parameters
    ----------
    cut : unstretched length of the segment [m]
    near : allowed error of the depth at which the water is sampled [m]; 0 for full precision
    expected : initial estimate of the load per metre, from the segment above [N/m]

    Returns
    -------
    The state, and the strain. The strain is `NO_BALANCE` if the iteration does not converge.
    """
    x, y, z, fx, fy, fz, tz, level = state
    kn, kt, friction = cable.normal_drag, cable.tangential_drag, cable.friction
    compliance, first_knot, end_knot = cable.compliance, cable.first_knot, cable.end_knot
    gravity = sea.gravity
    half = 0.5 * cut
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    strain = strain_at(cable, knots, tension)
    ex, ey, ez = expected
    tx, ty, tz_expected = -fx - half * ex, -fy - half * ey, -fz - half * ez
    rise = tz * (1.0 + strain)
    size = sqrt(tx * tx + ty * ty + tz_expected * tz_expected)
    if size > 0.0:
        rise = tz_expected / size * (1.0 + strain)
    tz = tz_expected
    settled = max(near / half, 1e-12) if half > 0.0 else inf
    qx = qy = qz = 0.0
    earlier = inf
    for turn in range(PASSES):
        u, v, w, density, level = water_at(sea, -z - half * rise, level)
        area = segment_area(cable, cut, density, strain)
        lift = segment_lift(cable, cut, density, gravity)
        ax, ay, az = fx, fy, fz + 0.5 * lift
        if friction == HOERNER:
            pull = 0.5 * turning_friction(friction, kt * area, u, v, w)
            ax, ay, az = ax + pull * u, ay + pull * v, az + pull * w
        factor = 1.0
        if vibration.beat == 0.0:
            c, doubt = 0.0, 1.0
            if near > 0.0 and size > 0.0:
                c, doubt = few_steps_share(ax, ay, az, 0.5 * kn * area, size, u, v, w, 1)
            if not doubt < SETTLED_ROTATION:
                c = drag_share(ax, ay, az, 0.5 * kn * area, u, v, w)
        else:
            c, factor = vibrating_share(vibration, ax, ay, az, 0.5 * kn * area, u, v, w, tx, ty, tz)
        tx, ty, tz = axis_along(ax, ay, az, c, u, v, w)
        qx, qy, qz = segment_drag(friction, factor * kn * area, kt * area, u, v, w, tx, ty, tz)
        qz += lift
        hx, hy, hz = fx + 0.5 * qx, fy + 0.5 * qy, fz + 0.5 * qz
        if hx * tx + hy * ty + hz * tz > 0.0:
            tx, ty, tz = -tx, -ty, -tz
        middle = sqrt(hx * hx + hy * hy + hz * hz)
        strain = compliance * middle
        # averaged over the tensions in it, so that the result does not depend on the segment length
        if end_knot > first_knot:
            bx, by, bz = fx + qx, fy + qy, fz + qz
            growth = sqrt(bx * bx + by * by + bz * bz) - tension
            strain = mean_curve_strain(knots, first_knot, end_knot, middle, 0.5 * growth)
        found = tz * (1.0 + strain)
        change = abs(found - rise)
        rise = found if turn < STALLED else 0.5 * (rise + found)
        if change < settled or change * change < 1e-12 * earlier < inf:
            break
        earlier = change
    else:
        strain = NO_BALANCE
    long = cut * (1.0 + strain)
    return (
        (x + long * tx, y + long * ty, z + long * tz, fx + qx, fy + qy, fz + qz, tz, level),
        strain,
    )


def pass_halves(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    cut: float,
    halves: bool,
    near: float,
    expected: Vector,
) -> Passed:
    """Integrate a part of a segment as one straight piece, or as two straight halves.

    `cut` is the unstretched length of the part [m]. `near` and `expected` are as in `pass_segment`.
    """
    half = 0.5 * cut if halves else cut
    above, upper, below, strain = state, 0.0, state, 0.0
    for _ in range(2 if halves else 1):
        above, upper = below, strain
        below, strain = pass_segment(cable, knots, vibration, sea, above, half, near, expected)
        if strain == NO_BALANCE:
            break
    return cut, above, upper, below, strain


def vibrating_share(
    vibration: Vibration,
    ax: float,
    ay: float,
    az: float,
    k: float,
    u: float,
    v: float,
    w: float,
    tx: float,
    ty: float,
    tz: float,
) -> tuple[float, float]:
    """Return the factor c of `drag_share` for a strumming cable, and the strumming factor f.

    f is the normal drag divided by the normal drag without strumming. If drag hardly rotates the
    segment, f is computed for the axis (tx, ty, tz), the latest estimate. This vector may have any
    length.
    """
    speed = sqrt(u * u + v * v + w * w)
    if speed == 0.0:
        return 0.0, 1.0
    here = with_beat(vibration, vibration.beat / speed)
    if k * vibration.greatest * speed * speed > 0.1 * sqrt(ax * ax + ay * ay + az * az):
        return amplified_share(ax, ay, az, k, here, u, v, w)
    cx, cy, cz = v * tz - w * ty, w * tx - u * tz, u * ty - v * tx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    sine = across / (speed * sqrt(tx * tx + ty * ty + tz * tz))
    factor = strummed(here, min(sine, 1.0))
    return drag_share(ax, ay, az, k * factor, u, v, w), factor


def touchdown(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    cut: float,
    halves: bool,
    near: float,
    expected: Vector,
    bed: Bed,
) -> Passed:
    """Find the touchdown in a segment, where the force normal to the seabed vanishes.

    Return the result of `pass_halves` for the part above the touchdown.
    """
    low, high, hanging = 0.0, cut, cut
    carried = off_bed(bed, state[3], state[4], state[5])
    passed = hanging, state, 0.0, state, 0.0
    for _ in range(PASSES):
        passed = pass_halves(cable, knots, vibration, sea, state, hanging, halves, near, expected)
        below = passed[3]
        fz = off_bed(bed, below[3], below[4], below[5])
        if (hanging == cut and fz > 0.0) or abs(fz) <= 1e-12 * carried:
            break
        if fz > 0.0:
            low = hanging
        else:
            high = hanging
        following = hanging * carried / (carried - fz)
        hanging = following if low < following < high else 0.5 * (low + high)
    return passed


@within
def pass_part(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    cut: float,
    halves: bool,
    near: float,
    expected: Vector,
    share: float,
) -> Passed:
    """Integrate a segment down to the first point where the segment must be split.

    A segment is split at levels of the water profile, and where a drag law switches (see
    `switch_at`). `share` is as in `counts_across`.
    """
    passed = pass_halves(cable, knots, vibration, sea, state, cut, halves, near, expected)
    below = passed[3]
    smooth = cable.friction != CONSTANT and vibration.beat == 0.0
    if smooth and in_interval(sea, below[7], -state[2], -below[2]):
        return passed
    part = split_length(
        cable, knots, vibration, sea, state, below, cut, halves, near, expected, share
    )
    if part == cut:
        return passed
    return pass_halves(cable, knots, vibration, sea, state, part, halves, near, expected)


def split_length(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    below: State,
    cut: float,
    halves: bool,
    near: float,
    expected: Vector,
    share: float,
) -> float:
    """Return the length [m] of the part of a segment above the first point where it must be split.

    The result is `cut` if there is no such point. `below` is the state below the whole segment.
    """
    part, level = cut, level_within(sea, below[7], -state[2], -below[2], share)
    if level > 0:
        part = until_level(
            cable, knots, vibration, sea, state, below, cut, halves, near, level, share
        )
    for law in (OF_FRICTION, OF_STRUMMING):
        if cable.friction == CONSTANT if law == OF_FRICTION else vibration.beat > 0.0:
            part = until_switch(
                cable, knots, vibration, sea, state, below, cut, part, halves, near, expected, law
            )
    return part


def until_level(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    below: State,
    cut: float,
    halves: bool,
    near: float,
    k: int,
    share: float,
) -> float:
    """Return the length [m] of the part of a segment above a level of the water profile.

    The length is approximate unless `near` is 0. `below` is the state below the whole segment, and
    `k` is the index of the level.
    """
    _, _, z, fx, fy, fz, _, _ = state
    level, start, whole = sea.levels[k], -z, z - below[2]
    load = (below[3] - fx) / cut, (below[4] - fy) / cut, (below[5] - fz) / cut
    part = cut * (level - start) / whole
    last = sinking(fx, fy, fz, load, cut)
    for _ in range(3 if last != 0.0 else 0):
        sinks = sinking(fx, fy, fz, load, part)
        if sinks * last > 0.0:
            part = min(cut * (level - start) / whole * (last / sinks), cut)
    before, above = 0.0, start
    for _ in range(TRIALS if near == 0.0 else 0):
        _, _, _, passed, strain = pass_halves(
            cable, knots, vibration, sea, state, part, halves, near, load
        )
        depth = -passed[2]
        off, depths = abs(depth - level), abs(depth - start)
        if strain == NO_BALANCE or off <= AT_A_LEVEL * abs(whole) or depth == above:
            break
        if not counts_across(sea, k, off, depths, share):
            break
        following = part + (level - depth) * (part - before) / (depth - above)
        before, above = part, depth
        part = following if 0.0 < following < cut else 0.5 * part
    return part


def sinking(fx: float, fy: float, fz: float, load: Vector, length: float) -> float:
    """Return the increase in depth per metre along a uniformly loaded segment.

    Parameters
    ----------
    fx, fy, fz : force above the segment [N]
    load, length : load [N/m] and length [m] of the segment
    """
    half = 0.5 * length
    x, y, z = fx + half * load[0], fy + half * load[1], fz + half * load[2]
    size = sqrt(x * x + y * y + z * z)
    return z / size if size > 0.0 else 0.0


def until_switch(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    below: State,
    cut: float,
    part: float,
    halves: bool,
    near: float,
    expected: Vector,
    law: int,
) -> float:
    """Return the length [m] of the part of a segment above the point where a drag law switches.

    Only the upper `part` [m] of the segment is searched. The result is `part` if the law does not
    switch. `below` is the state below the whole segment, and `law` is as in `switch_at`.
    """
    low, high, length = 0.0, part, part
    at_low = at_high = switch_at(vibration, sea, state, law)
    for turn in range(PASSES):
        if turn > 0 or part < cut:
            _, _, _, below, _ = pass_halves(
                cable, knots, vibration, sea, state, length, halves, near, expected
            )
        here = switch_at(vibration, sea, below, law)
        if turn == 0:
            if not here * at_low < 0.0:
                break
            at_high = here
        elif here * at_low > 0.0:
            low, at_low, at_high = length, here, 0.5 * at_high
        else:
            high, at_high, at_low = length, here, 0.5 * at_low
        if here == 0.0 or high - low <= SWITCH_TOLERANCE * part:
            break
        length = low + (high - low) * at_low / (at_low - at_high)
    return high


def switch_at(vibration: Vibration, sea: Sea, state: State, law: int) -> float:
    """Return a quantity whose sign changes where a drag law switches.

    - `OF_FRICTION`: the tangential flow times the tension, positive down the line [N m/s].
      Friction of constant size reverses if the sign changes.
    - `OF_STRUMMING`: the limit of the strumming factor, minus the strumming factor without this
      limit [-].
    """
    _, _, z, fx, fy, fz, _, level = state
    u, v, w, _, _ = water_at(sea, -z, level)
    along = -(u * fx + v * fy + w * fz)
    square = (u * u + v * v + w * w) * (fx * fx + fy * fy + fz * fz)
    if law == OF_FRICTION or square == 0.0:
        return along
    here = with_beat(vibration, vibration.beat / sqrt(u * u + v * v + w * w))
    sine = sqrt(max(1.0 - along * along / square, 0.0))
    return vibration.greatest - strummed_freely(here, sine)


@within
def segment_length(
    cable: CableStretch,
    knots: Sequence[Knot],
    vibration: Vibration,
    sea: Sea,
    state: State,
    angle_step: float,
    reach: float,
    share: float,
) -> float:
    """Return the longest allowed length of the next segment [m].

    The segment rotates by the angle step at most, and is not longer than `reach`. It ends at the
    next level of the water profile, and at the depth of minimum flow. `share` is as in
    `counts_across`.
    """
    _, _, z, fx, fy, fz, _, level = state
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    strain = strain_at(cable, knots, tension)
    sinking = 1.0
    tx, ty, tz = 0.0, 0.0, -1.0
    if tension > 0.0:
        sinking = (1.0 + strain) * fz / tension
        tx, ty, tz = -fx / tension, -fy / tension, -fz / tension
    # near a free end the tension vanishes: the floor keeps the number of segments finite
    length, floor = reach, 1e-4 * reach
    kn = cable.normal_drag * (vibration.greatest if vibration.beat > 0.0 else 1.0)
    depth = -z
    for _ in range(2):
        rate = rate_of_turn(cable, kn, sea, depth, level, tension > 0.0, tx, ty, tz, angle_step)
        if rate > 0.0:
            length = min(length, max(tension / rate, floor))
        depth = -z + length * sinking
    return min(distance_to_bend(sea, -z, sinking, level, length, share), length)


@within
def rate_of_turn(
    cable: CableStretch,
    kn: float,
    sea: Sea,
    depth: float,
    level: int,
    taut: bool,
    tx: float,
    ty: float,
    tz: float,
    angle_step: float,
) -> float:
    """Return the tension divided by the longest segment that the angle step allows [N/m].

    The load on the cable is computed in the water at `depth`, for a cable with unit axis t.
    """
    u, v, w, density, _ = water_at(sea, depth, level)
    lift = segment_lift(cable, 1.0, density, sea.gravity)
    qx, qy, qz = drag_force(kn * density / REFERENCE_DENSITY, 0.0, u, v, w, tx, ty, tz)
    along = lift * tz
    qx, qy, qz = qx - along * tx, qy - along * ty, qz + lift - along * tz
    rate = sqrt(qx * qx + qy * qy + qz * qz) / angle_step
    # If the tension is little more than the weight of the line below, the tension decreases along
    # the segment, which then rotates faster and faster. Hence a term for the decrease.
    return rate + 2.0 * max(along, 0.0) if taut else rate
