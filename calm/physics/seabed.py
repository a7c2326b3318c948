"""The part of a line that lies on the seabed: straight, held by friction, out of the current."""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.physics.cable import strain_at
from calm.physics.line import Record, write_element, write_node
from calm.physics.referee import Moored, RefereeShape
from calm.physics.stretch import Knot, mean_curve_strain
from calm.physics.track import CABLE, CableStretch, Course


def lay_line(
    course: Course,
    record: Record,
    nodes: int,
    stage: int,
    hanging: float,
    fx: float,
    fy: float,
    seabed: float,
    excess: float,
    friction: float,
) -> tuple[int, float]:
    """Continue a record from a touchdown to the anchor; returns the nodes and the length [m].

    The line lies along the horizontal force at touchdown. Its tension falls by friction times the
    weight of what lies, down to nothing; there is no drag. What the vertical force could not carry
    at the touchdown itself, a rigid piece or a clamp, rests there at a point.

    Parameters
    ----------
    stage, hanging : where the line came down
    fx, fy : horizontal force above the touchdown [N]
    seabed : height [m], + up from the surface
    friction : of the line on the seabed [-]
    excess : what a displaced cubic metre lifts more there than in reference water [N/m³]
    """
    tension = sqrt(fx * fx + fy * fy)
    east, north = (-fx / tension, -fy / tension) if tension > 0.0 else (1.0, 0.0)
    grounded, first = 0.0, nodes
    # elements and tensions first, then the places that follow from them
    for i in range(stage, len(course.stages)):
        here = course.stages[i]
        hung = hanging if i == stage else 0.0
        if here.kind == CABLE:
            cable = course.cables[here.first]
            length = cable.length - hung
            if length <= 0.0:
                continue
            weight = -(cable.buoyancy + excess * cable.volume) * length
            pulled, left = held_back(tension, friction * weight)
            strain = lying_strain(cable, course.knots, pulled, tension, left)
            tension = left
            write_element(record, nodes, cable.piece, -1, length, strain)
            record[3][nodes] = tension
            nodes += 1
        elif hung == 0.0:
            nodes, tension = lay_rod(course, i, record, nodes, tension, excess, friction)
    x, y = record[0][first - 1], record[1][first - 1]
    for n in range(first, nodes):
        length, strain, pull = record[8][n], record[9][n], record[3][n]
        x, y = x + length * (1.0 + strain) * east, y + length * (1.0 + strain) * north
        grounded += length
        write_node(record, n, (x, y, seabed, -pull * east, -pull * north, 0.0, 0.0, 0))
    return nodes, grounded


def lay_rod(
    course: Course,
    stage: int,
    record: Record,
    nodes: int,
    tension: float,
    excess: float,
    friction: float,
) -> tuple[int, float]:
    """Lay down a rod or a clamp; returns the nodes and the tension that is left [N].

    The loads of a rod go down it: of every piece its own, spread along it, then its clamps.
    """
    rod, loads = course.stages[stage], course.loads
    reached, end, own, length, piece = 0.0, 0.0, 0.0, 0.0, -1
    last = rod.first + rod.size - 1
    for i in range(rod.first, rod.first + rod.size):
        load = loads[i]
        weight = -(load.buoyancy + excess * load.volume)
        if load.clamp < 0:
            own, length, piece = weight, load.length, load.piece
            end = reached + length
        else:
            if piece >= 0:
                step = load.at - reached
                share = step / length if length > 0.0 else 0.0
                _, tension = held_back(tension, friction * share * own)
                write_element(record, nodes, piece, -1, step, 0.0)
                record[3][nodes] = tension
                nodes += 1
                reached = load.at
            _, tension = held_back(tension, friction * weight)
            write_element(record, nodes, load.piece, load.clamp, 0.0, 0.0)
            record[3][nodes] = tension
            nodes += 1
        if piece >= 0 and (i == last or loads[i + 1].clamp < 0):
            step = end - reached
            share = step / length if length > 0.0 else 1.0
            _, tension = held_back(tension, friction * share * own)
            write_element(record, nodes, piece, -1, step, 0.0)
            record[3][nodes] = tension
            nodes += 1
            reached = end
    return nodes, tension


def held_back(tension: float, hold: float) -> tuple[float, float]:
    """Share of a part that the tension reaches into against friction, up to `hold`, and what is
    left of it at its end [N]."""
    if hold <= tension:
        return 1.0, tension - hold
    return tension / hold, 0.0


def lying_strain(
    cable: CableStretch, knots: Sequence[Knot], pulled: float, tension: float, left: float
) -> float:
    """Mean strain of a part where the tension falls evenly over a share `pulled` of its length."""
    middle = 0.5 * (tension + left)
    if cable.first_knot == cable.end_knot:
        return pulled * cable.compliance * middle
    half = 0.5 * (tension - left)
    strain = mean_curve_strain(knots, cable.first_knot, cable.end_knot, middle, half)
    return pulled * strain + (1.0 - pulled) * strain_at(cable, knots, 0.0)


Forces = NDArray[np.floating[Any]]


def required_weight(
    vertical: Forces | float, horizontal: Forces | float, factor: float, friction: float
) -> Forces:
    """Return the weight in water that keeps a dead-weight anchor where it is [N].

    It is never below 0: an anchor that the line presses down on the bed needs none.

    Parameters
    ----------
    vertical, horizontal : pull of the line on the anchor [N], + up; floats or columns of them
    factor : safety on both the lift and the slide [-], 1.5 in practice
    friction : of the anchor on the bed [-], 0.6 in practice

    W ≥ factor (V + H / friction): the rule of Dewey's Mooring Design & Dynamics and of WHOI.
    """
    needed: Forces = np.maximum(factor * (vertical + horizontal / friction), 0.0)
    return needed


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
