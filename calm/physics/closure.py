"""Whether the loads of a shape sum up to the force at its end: the other half of the referee."""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from math import sqrt

from calm.physics.referee import Moored, RefereeShape


def closure(
    moored: Moored,
    shape: RefereeShape,
    loads: Sequence[MutableSequence[float]],
    landed: bool,
    friction: float,
    excess: float,
) -> float:
    """Relative departure of the sum of the loads from the force at the line's end.

    Where the line lies on the seabed, the loads above its touchdown must leave no vertical force
    there: but a downward one where a rigid piece or clamp stands, and an upward one that the weight
    of a rigid piece lying there holds down. Friction on what lies takes its share of the horizontal
    force.

    Parameters
    ----------
    loads : of every element, as by `element_loads`
    landed : whether the line lies on the seabed
    friction : there [-]
    excess : what a displaced cubic metre lifts more there than in reference water [N/m³]
    """
    record, end = shape.record, shape.nodes - 1
    x = y = z = whole = 0.0
    for i in range(shape.hanging):
        x, y, z = x + loads[0][i], y + loads[1][i], z + loads[2][i]
        whole += abs(loads[0][i]) + abs(loads[1][i]) + abs(loads[2][i])
    fx, fy, fz = record[3][end], record[4][end], record[5][end]
    scale = max(sqrt(fx * fx + fy * fy + fz * fz), 1e-3 * whole, 1e-300)
    if landed:
        if bears_at_a_point(moored, shape, shape.hanging - 1):
            z = max(z, 0.0)
        if bears_at_a_point(moored, shape, shape.hanging):
            z = min(z, 0.0)
        tension = sqrt(x * x + y * y)
        held = min(friction * weight_on_seabed(moored, shape, excess), tension)
        left = 1.0 - held / tension if tension > 0.0 else 0.0
        x, y = left * x, left * y
    x, y, z = x - fx, y - fy, z - fz
    return sqrt(x * x + y * y + z * z) / scale


def bears_at_a_point(moored: Moored, shape: RefereeShape, element: int) -> bool:
    """Whether the seabed can bear on an element at a point: a rigid piece or a clamp."""
    if element >= shape.nodes - 1:
        return False
    piece = int(shape.record[6][element + 1])
    return moored.bodies[piece].flexible == 0 or shape.record[7][element + 1] >= 0


def weight_on_seabed(moored: Moored, shape: RefereeShape, excess: float) -> float:
    """Weight in water of what lies on the seabed [N]."""
    weight = 0.0
    for i in range(shape.hanging, shape.nodes - 1):
        piece, clamp = int(shape.record[6][i + 1]), int(shape.record[7][i + 1])
        body = moored.bodies[piece if clamp < 0 else moored.pieces + clamp]
        amount = 1.0
        if clamp < 0 and body.flexible:
            amount = shape.record[8][i + 1]
        elif clamp < 0 and body.length > 0.0:
            amount = shape.record[8][i + 1] / body.length
        weight -= amount * (body.buoyancy + excess * body.volume)
    return weight
