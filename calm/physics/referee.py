"""Independent check of a march: load and moment balance of every element of a shape.

The recorded coordinates are the only input from the march. Water profile and laws of drag and
friction are implemented anew; measured curves (stretch, drag, strumming) are shared with the march.
"""

from collections.abc import MutableSequence, Sequence
from math import atan2, pow, sqrt
from sys import float_info
from typing import NamedTuple

from calm.physics.drag import BERTEAUX, CONSTANT, Vector, interpolated
from calm.physics.line import Record
from calm.physics.reynolds import Smooth, drag_variation
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.stretch import Knot, mean_curve_strain
from calm.physics.strumming import Vibration, strummed

ROUNDING = 32.0 * float_info.epsilon
"""Rounding error, as a fraction of the largest coordinate or force of the shape."""
SETTLED = 1e-10
"""Relative error that the march may leave in the load on a segment.

For a segment with a stretch of 2 %, the error is 4e-11.
"""


class RefereeBody(NamedTuple):
    """A piece or a clamp of a line, for the independent check.

    Attributes
    ----------
    smooth, lengthening : diameter [m] and `lengthening` of the body's `DragCurve`; 0 without a
        curve
    first_knot, end_knot : the points `first_knot` to `end_knot` - 1 of `Moored.knots` are the
        body's elongation curve. Both numbers are equal for a body without a curve

    Other attributes are as in `Line`.
    """

    flexible: int
    length: float
    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: int
    compliance: float
    thinning: float
    lift: float
    push_east: float
    push_north: float
    diameter: float
    smooth: float
    lengthening: float
    first_knot: int
    end_knot: int


class Moored(NamedTuple):
    """A line and its water, for the independent check.

    `bodies` lists the pieces, followed by the clamps. The first `head` pieces form one rod.
    `friction` is the number of a friction law, and `frequency` is the strumming frequency [Hz].
    """

    bodies: Sequence[RefereeBody]
    knots: Sequence[Knot]
    pieces: int
    head: int
    friction: int
    vibration: Vibration
    frequency: float
    level: Sequence[float]
    u: Sequence[float]
    v: Sequence[float]
    w: Sequence[float]
    density: Sequence[float]
    gravity: float
    viscosity_level: Sequence[float]
    viscosity: Sequence[float]


class RefereeShape(NamedTuple):
    """Nodes and elements of a shape, from the free end on.

    Attributes
    ----------
    record : record of the march (see `calm.physics.line`), where column n has node n and the
        element that ends there
    nodes, hanging : number of nodes, and number of elements above the touchdown
    first, last : first and last node of every piece
    """

    record: Record
    nodes: int
    hanging: int
    first: MutableSequence[int]
    last: MutableSequence[int]


def find_ends(shape: RefereeShape) -> None:
    """Write the first and last node of every piece to `shape.first` and `shape.last`."""
    pieces, node = len(shape.first), 0
    for piece in range(pieces):
        shape.first[piece] = node
        while node + 1 < shape.nodes and int(shape.record[6][node + 1]) <= piece:
            node += 1
        shape.last[piece] = node


def element_loads(
    moored: Moored, shape: RefereeShape, loads: Sequence[MutableSequence[float]]
) -> None:
    """Compute buoyancy, drag and wind force of every element, and write them to `loads` [N].

    The load of a rigid piece follows from the water at the piece's midpoint, and is distributed
    over the elements of the piece by length.
    """
    east, north, up = loads[0], loads[1], loads[2]
    for i in range(shape.nodes - 1):
        piece, clamp = int(shape.record[6][i + 1]), int(shape.record[7][i + 1])
        cut = shape.record[8][i + 1]
        body = moored.bodies[piece if clamp < 0 else moored.pieces + clamp]
        top, bottom = i, i + 1
        amount = 1.0
        if clamp < 0 and body.flexible:
            amount = cut
        elif clamp < 0:
            top, bottom = shape.first[piece], shape.last[piece]
            # if it has no length, the last element takes the whole load
            amount = 1.0 if bottom == i + 1 else 0.0
            if body.length > 0.0:
                amount = cut / body.length
        dx, dy, dz = chord(shape, top, bottom)
        size = sqrt(dx * dx + dy * dy + dz * dz)
        grown = 1.0
        if body.flexible and cut > 0.0:
            grown = pow(size / cut, body.thinning)
        if clamp < 0 and not body.flexible:
            dx, dy, dz = rigid_axis(moored, shape, piece)
            size = sqrt(dx * dx + dy * dy + dz * dz)
        if size > 0.0:
            dx, dy, dz = dx / size, dy / size, dz / size
        depth = -0.5 * (shape.record[2][top] + shape.record[2][bottom])
        u, v, w, density = flow_at(moored, depth)
        qx, qy, qz = drag_on(moored, body, depth, u, v, w, dx, dy, dz)
        scale = amount * grown * density / REFERENCE_DENSITY
        lift = body.buoyancy + (density - REFERENCE_DENSITY) * moored.gravity * body.volume
        if not body.flexible:
            lift += body.lift * (u * u + v * v + w * w) * density / REFERENCE_DENSITY
        east[i] = scale * qx + amount * body.push_east
        north[i] = scale * qy + amount * body.push_north
        up[i] = scale * qz + amount * lift


def chord(shape: RefereeShape, top: int, bottom: int) -> Vector:
    """Return the vector from one node to another [m]."""
    x, y, z = shape.record[0], shape.record[1], shape.record[2]
    return x[bottom] - x[top], y[bottom] - y[top], z[bottom] - z[top]


def rigid_axis(moored: Moored, shape: RefereeShape, piece: int) -> Vector:
    """Return a vector along the axis of the rod to which a rigid piece belongs.

    For a rod without length, the vector is opposite to the mean force at the ends.
    """
    top, bottom = rod_nodes(moored, shape, piece)
    x, y, z = chord(shape, top, bottom)
    if x == 0.0 and y == 0.0 and z == 0.0:
        fx, fy, fz = shape.record[3], shape.record[4], shape.record[5]
        return -fx[top] - fx[bottom], -fy[top] - fy[bottom], -fz[top] - fz[bottom]
    return x, y, z


def rod_nodes(moored: Moored, shape: RefereeShape, piece: int) -> tuple[int, int]:
    """Return the first and the last node of the rod to which a rigid piece belongs."""
    if piece < moored.head:
        return shape.first[0], shape.last[moored.head - 1]
    return shape.first[piece], shape.last[piece]


def flow_at(moored: Moored, depth: float) -> tuple[float, float, float, float]:
    """Interpolate current u, v, w [m/s] and density [kg/m³] linearly to a depth [m]."""
    level = moored.level
    low, high = 0, len(level) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if level[middle] <= depth:
            low = middle
        else:
            high = middle
    share = 0.0
    if high > low:
        share = min(max((depth - level[low]) / (level[high] - level[low]), 0.0), 1.0)
    u, v, w, density = moored.u, moored.v, moored.w, moored.density
    return (
        u[low] + share * (u[high] - u[low]),
        v[low] + share * (v[high] - v[low]),
        w[low] + share * (w[high] - w[low]),
        density[low] + share * (density[high] - density[low]),
    )


def drag_on(
    moored: Moored,
    body: RefereeBody,
    depth: float,
    u: float,
    v: float,
    w: float,
    tx: float,
    ty: float,
    tz: float,
) -> Vector:
    """Return the drag of a current on a body with unit axis t, in reference water, without stretch.

    The drag is in N, or for cables and chains in N/m.
    """
    along = u * tx + v * ty + w * tz
    if not body.directional:
        speed = sqrt(u * u + v * v + w * w)
        normal = body.normal_drag * varied(moored, body, depth, speed) * speed
        return normal * u, normal * v, normal * w
    nx, ny, nz = u - along * tx, v - along * ty, w - along * tz
    across = sqrt(nx * nx + ny * ny + nz * nz)
    factor = varied(moored, body, depth, across)
    if moored.frequency > 0.0 and body.diameter > 0.0:
        factor *= strumming(moored.vibration, moored.frequency, body.diameter, u, v, w, across)
    normal = body.normal_drag * factor * across
    qx, qy, qz = normal * nx, normal * ny, normal * nz
    kt = body.tangential_drag
    if not body.flexible or moored.friction == BERTEAUX:
        pull = kt * abs(along) * along
        return qx + pull * tx, qy + pull * ty, qz + pull * tz
    speed = sqrt(u * u + v * v + w * w)
    if moored.friction == CONSTANT:
        pull = kt * speed * speed
        if along <= 0.0:
            pull = -pull if along < 0.0 else 0.0
        return qx + pull * tx, qy + pull * ty, qz + pull * tz
    pull = kt * speed
    return qx + pull * u, qy + pull * v, qz + pull * w


def varied(moored: Moored, body: RefereeBody, depth: float, speed: float) -> float:
    """Return the ratio of the normal drag on a body to the normal drag with constant coefficients.

    `speed` is the speed of the current normal to the axis of the body [m/s].
    """
    if body.smooth == 0.0:
        return 1.0
    viscosity = interpolated(moored.viscosity_level, moored.viscosity, depth)
    return drag_variation(Smooth(speed * body.smooth / viscosity, body.lengthening), 1.0)


def strumming(
    vibration: Vibration,
    frequency: float,
    diameter: float,
    u: float,
    v: float,
    w: float,
    across: float,
) -> float:
    """Return the factor by which strumming increases the normal drag of a cable.

    `across` is the speed of the current normal to the axis of the cable [m/s].
    """
    if across <= 0.0:
        return 1.0
    speed = sqrt(u * u + v * v + w * w)
    a1, b1, c1, greatest, _ = vibration
    here = Vibration(a1, b1, c1, greatest, frequency * diameter / speed)
    return strummed(here, min(across / speed, 1.0))


def worst_moment(
    moored: Moored, shape: RefereeShape, loads: Sequence[MutableSequence[float]]
) -> float:
    """Return the largest error of the moment balance of a shape [rad].

    The error of an element is the angle between its axis and the mean of the forces at its ends.
    The forces are sums of `loads`. The error of a cable element may also be the difference between
    the strain and the strain expected from the forces. All errors are reduced by the effect of
    rounding errors. Elements on the seabed are ignored.
    """
    rounding = ROUNDING * greatest_size(shape, 0)
    hanging = shape.hanging
    east, north, up = loads[0], loads[1], loads[2]
    least = 1e-300
    for i in range(hanging):
        least += SETTLED * (abs(east[i]) + abs(north[i]) + abs(up[i]))
    least = max(ROUNDING * greatest_size(shape, 3), least)
    worst = 0.0
    fx = fy = fz = 0.0
    for i in range(hanging):
        piece, clamp = int(shape.record[6][i + 1]), int(shape.record[7][i + 1])
        body, cut = moored.bodies[piece], shape.record[8][i + 1]
        dx, dy, dz = chord(shape, i, i + 1)
        hx, hy, hz = fx + 0.5 * east[i], fy + 0.5 * north[i], fz + 0.5 * up[i]
        bx, by, bz = fx + east[i], fy + north[i], fz + up[i]
        cable = body.flexible and clamp < 0
        alone = cable
        if not body.flexible:
            top, bottom = rod_nodes(moored, shape, piece)
            alone = top == i and bottom == i + 1
            if top == i and i + 1 < bottom <= hanging:
                worst = max(worst, rod_moment(shape, loads, top, bottom, fx, fy, fz))
        if alone and cut > rounding:
            # the ends of a very short segment are rounded by more than the limit
            length = sqrt(dx * dx + dy * dy + dz * dz)
            angle = angle_against(dx, dy, dz, hx, hy, hz)
            middle = sqrt(hx * hx + hy * hy + hz * hz)
            blurred = rounding / max(length, rounding) + least / max(middle, least)
            worst = max(worst, angle - blurred)
            if cable:
                growth = sqrt(bx * bx + by * by + bz * bz) - sqrt(fx * fx + fy * fy + fz * fz)
                strain = expected_strain(moored, body, middle, 0.5 * growth)
                worst = max(worst, abs(length / cut - 1.0 - strain) - rounding / cut)
        fx, fy, fz = bx, by, bz
    return worst


def greatest_size(shape: RefereeShape, first: int) -> float:
    """Return the largest absolute coordinate [m] or the largest force [N] of a shape.

    The parameter `first` is 0 for coordinates and 3 for forces.
    """
    greatest = 0.0
    for n in range(shape.nodes):
        x, y, z = shape.record[first][n], shape.record[first + 1][n], shape.record[first + 2][n]
        if first == 0:
            greatest = max(greatest, abs(x), abs(y), abs(z))
        else:
            greatest = max(greatest, sqrt(x * x + y * y + z * z))
    return greatest


def expected_strain(moored: Moored, body: RefereeBody, middle: float, half: float) -> float:
    """Return the mean strain that the tensions in a segment cause.

    The tension varies linearly along the segment by ± `half` about `middle` [N].
    """
    if body.first_knot == body.end_knot:
        return body.compliance * middle
    return mean_curve_strain(moored.knots, body.first_knot, body.end_knot, middle, half)


def rod_moment(
    shape: RefereeShape,
    loads: Sequence[MutableSequence[float]],
    top: int,
    bottom: int,
    fx: float,
    fy: float,
    fz: float,
) -> float:
    """Return the angle between a rod of several elements and the force that rotates the rod [rad].

    The rod extends from node `top` to node `bottom`. (fx, fy, fz) is the force above the rod [N].
    """
    dx, dy, dz = chord(shape, top, bottom)
    length = sqrt(dx * dx + dy * dy + dz * dz)
    if length == 0.0:
        return 0.0
    for i in range(top, bottom):
        x, y, z = chord(shape, top, i)
        if shape.record[7][i + 1] < 0:  # the load of a piece acts at its midpoint
            piece = int(shape.record[6][i + 1])
            first, last = shape.first[piece], shape.last[piece]
            x, y, z = chord(shape, top, first)
            px, py, pz = chord(shape, first, last)
            x, y, z = x + 0.5 * px, y + 0.5 * py, z + 0.5 * pz
        lever = 1.0 - sqrt(x * x + y * y + z * z) / length
        fx, fy, fz = fx + lever * loads[0][i], fy + lever * loads[1][i], fz + lever * loads[2][i]
    return angle_against(dx, dy, dz, fx, fy, fz)


def angle_against(x: float, y: float, z: float, fx: float, fy: float, fz: float) -> float:
    """Return the angle between an axis and the opposite of a force [rad].

    The result is 0 if the axis or the force is zero.
    """
    cx, cy, cz = y * fz - z * fy, z * fx - x * fz, x * fy - y * fx
    across = sqrt(cx * cx + cy * cy + cz * cz)
    along = -(x * fx + y * fy + z * fz)
    return atan2(across, along) if across != 0.0 or along != 0.0 else 0.0
