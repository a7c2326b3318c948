"""Grounded part of a line: straight on a plane seabed, held by friction, without drag."""

from collections.abc import MutableSequence, Sequence
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.physics.cable import strain_at
from calm.physics.line import Bed, Record, State, write_element, write_node
from calm.physics.referee import Moored, RefereeShape
from calm.physics.stretch import Knot, mean_curve_strain
from calm.physics.track import CABLE, CLAMP, CableStretch, Course

NOTHING = 1e-9
"""Smallest pull at a touchdown whose direction the audit checks, as a fraction of all loads."""


def lay_line(
    course: Course,
    bed: Bed,
    state: State,
    stage: int,
    hanging: float,
    record: Record,
    recording: bool,
    nodes: int,
) -> tuple[State, int, float]:
    """Lay a line on the seabed from its touchdown to the anchor.

    The line is straight, in the direction of the force at the touchdown; a slack line lies across
    the slope. Friction, and weight on a downslope, decrease the tension towards the anchor; weight
    on an upslope increases the tension. There is no drag.

    Parameters
    ----------
    stage : index of the stage with the touchdown
    hanging : unstretched length of this stage above the seabed [m]; inf for a rod or clamp that
        stands on the seabed, 0 for a rod or clamp that lies on the seabed
    record, recording : output for nodes and elements, and whether to record them
    nodes : number of nodes so far

    Returns
    -------
    The state at the end of the line, the number of nodes, and the length on the seabed [m].
    """
    x, y, z, fx, fy, fz, tz, level = state
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    steep = sqrt(bed.east * bed.east + bed.north * bed.north)
    east, north, up = 1.0, 0.0, 0.0
    if tension > 0.0:
        east, north, up = -fx / tension, -fy / tension, -fz / tension
    elif steep > 0.0:
        east, north = -bed.north / steep, bed.east / steep
    hold = bed.friction / sqrt(1.0 + steep * steep) - up
    grounded = 0.0
    for i in range(stage, len(course.stages)):
        here, first = course.stages[i], course.stages[i].first
        hung = hanging if i == stage else 0.0
        if here.kind == CABLE:
            cable = course.cables[first]
            length = cable.length - hung
            if length <= 0.0:
                continue
            weight = -(cable.buoyancy + bed.excess * cable.volume) * length
            pulled, left = held_back(tension, hold * weight)
            strain = lying_strain(cable, course.knots, pulled, tension, left)
            tension = left
            reach = length * (1.0 + strain)
            x, y, z = x + reach * east, y + reach * north, z + reach * up
            fx, fy, fz = -tension * east, -tension * north, 0.0 - tension * up
            if recording:
                write_element(record, nodes, cable.piece, -1, length, strain)
                write_node(record, nodes, (x, y, z, fx, fy, fz, tz, level))
            nodes, grounded = nodes + 1, grounded + length
        elif hung == 0.0:
            # the loads of a rod are listed downwards: for every piece its own load, which is
            # distributed along the piece, then the loads of its clamps
            reached, end, own, length, last = 0.0, 0.0, 0.0, 0.0, first + here.size - 1
            for k in range(first, last + 1):
                load = course.loads[k]
                weight = -(load.buoyancy + bed.excess * load.volume)
                if load.clamp < 0:
                    own, length, end = weight, load.length, reached + load.length
                ends = k == last or course.loads[k + 1].clamp < 0
                for part in range(3):  # the piece down to a clamp, the clamp, the piece to its end
                    there = ends if part == 2 else load.clamp >= 0
                    if not there or (here.kind == CLAMP and part != 1):
                        continue
                    clamp = load.clamp if part == 1 else -1
                    step = 0.0 if part == 1 else (end if part == 2 else load.at) - reached
                    share = step / length if length > 0.0 else 0.5 * part
                    _, tension = held_back(tension, hold * (weight if part == 1 else share * own))
                    x, y, z = x + step * east, y + step * north, z + step * up
                    fx, fy, fz = -tension * east, -tension * north, 0.0 - tension * up
                    if recording:
                        write_element(record, nodes, load.piece, clamp, step, 0.0)
                        write_node(record, nodes, (x, y, z, fx, fy, fz, tz, level))
                    nodes, grounded, reached = nodes + 1, grounded + step, reached + step
    return (x, y, z, fx, fy, fz, tz, level), nodes, grounded


def held_back(tension: float, hold: float) -> tuple[float, float]:
    """Return the fraction of a piece of line that is under tension, and the tension at the end.

    The piece lies on the seabed and begins with `tension` [N]. Friction and slope decrease the
    tension by `hold` [N] along the piece, but not below 0.
    """
    if hold <= tension:
        return 1.0, tension - hold
    return tension / hold, 0.0


def lying_strain(
    cable: CableStretch, knots: Sequence[Knot], pulled: float, tension: float, left: float
) -> float:
    """Return the mean strain of a piece of cable on the seabed.

    The tension decreases linearly from `tension` to `left` [N] over the fraction `pulled` of the
    length, and is 0 on the remaining length.
    """
    middle = 0.5 * (tension + left)
    if cable.first_knot == cable.end_knot:
        return pulled * cable.compliance * middle
    half = 0.5 * abs(tension - left)
    strain = mean_curve_strain(knots, cable.first_knot, cable.end_knot, middle, half)
    return pulled * strain + (1.0 - pulled) * strain_at(cable, knots, 0.0)


Forces = NDArray[np.floating[Any]]


def required_weight(
    vertical: Forces | float, horizontal: Forces | float, factor: float, friction: float
) -> Forces:
    """Return the submerged weight that a dead-weight anchor needs to stay in position [N].

    The weight is factor (V + H / friction), but not less than 0 (Dewey, Mooring Design & Dynamics;
    WHOI).

    Parameters
    ----------
    vertical, horizontal : force of the line on the anchor, V (positive up) and H [N]; floats or
        arrays
    factor : safety factor against lifting and sliding [-], typically 1.5
    friction : friction coefficient between anchor and seabed [-], typically 0.6
    """
    needed: Forces = np.maximum(factor * (vertical + horizontal / friction), 0.0)
    return needed


def closure(
    moored: Moored,
    shape: RefereeShape,
    loads: Sequence[MutableSequence[float]],
    landed: bool,
    bed: Bed,
) -> float:
    """Return the relative difference between the sum of the loads and the force at a line's end.

    If part of the line lies on the seabed, friction and weight along the seabed are included. The
    sum of the loads above the touchdown must then have no component normal to the seabed, with two
    exceptions:

    - a downward force may act on a rigid piece or clamp that stands on the seabed;
    - an upward force may act on a rigid piece or clamp that lies on the seabed.

    `loads` are from `element_loads`. `landed` is true if part of the line lies on the seabed.
    """
    record, end = shape.record, shape.nodes - 1
    x = y = z = whole = 0.0
    for i in range(shape.hanging):
        x, y, z = x + loads[0][i], y + loads[1][i], z + loads[2][i]
        whole += abs(loads[0][i]) + abs(loads[1][i]) + abs(loads[2][i])
    fx, fy, fz = record[3][end], record[4][end], record[5][end]
    scale = max(sqrt(fx * fx + fy * fy + fz * fz), 1e-3 * whole, 1e-300)
    if landed:
        square = 1.0 + bed.east * bed.east + bed.north * bed.north
        across = (z + bed.east * x + bed.north * y) / square
        x, y, z = x - across * bed.east, y - across * bed.north, z - across
        tension, left = sqrt(x * x + y * y + z * z), 1.0
        if tension > NOTHING * whole:
            held = bed.friction / sqrt(square) + z / tension
            left -= held * weight_on_seabed(moored, shape, bed.excess) / tension
        if bears_at_a_point(moored, shape, shape.hanging - 1):
            across = max(across, 0.0)
        if bears_at_a_point(moored, shape, shape.hanging):
            across = min(across, 0.0)
        left = max(left, 0.0)
        x, y, z = left * x + across * bed.east, left * y + across * bed.north, left * z + across
    x, y, z = x - fx, y - fy, z - fz
    return sqrt(x * x + y * y + z * z) / scale


def bears_at_a_point(moored: Moored, shape: RefereeShape, element: int) -> bool:
    """Return whether an element (a rigid piece or clamp) can rest on the seabed at a point."""
    if element >= shape.nodes - 1:
        return False
    piece = int(shape.record[6][element + 1])
    return moored.bodies[piece].flexible == 0 or shape.record[7][element + 1] >= 0


def weight_on_seabed(moored: Moored, shape: RefereeShape, excess: float) -> float:
    """Return the submerged weight of the elements on the seabed [N]."""
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
