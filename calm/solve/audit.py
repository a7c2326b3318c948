"""Audit of every solution, which recomputes its force and moment balance from the coordinates.

The audit and the march share only the measured curves of stretch, drag and strumming.

- Force balance: buoyancy and drag of all elements sum to the force at the line's end.
- Moment balance: the axis of every element is parallel to the mean of the forces at its two ends.
  Every cable element also has the strain that this mean force causes.
"""

from copy import copy
from typing import Any

import numpy as np

from calm.physics.law_kinds import record_type
from calm.physics.line import Floats, Line, Water, once_per_input
from calm.physics.referee import Moored, RefereeBody, RefereeShape, element_loads, strumming
from calm.physics.stretch import Knot
from calm.physics.strumming import AT_REST
from calm.physics.track import head_count
from calm.solve.search import Referee
from calm.solve.solution import Solution, sizes


def loads_of(solution: Solution) -> Floats:
    """Return the sum of the buoyancy and drag forces on every element (k, 3) [N].

    The drag of a rigid piece is computed at its midpoint.
    """
    moored = moored_of(solution.carried, solution.water, solution.frequency, False)
    written: list[list[float]] = [[0.0] * len(solution.cut) for _ in range(3)]
    element_loads(moored, shape_of(solution), written)
    return np.array(written).T


def moored_of(line: Line, water: Water, frequency: float, compiled: bool) -> Moored:
    """Convert a line and its water to the data structure used by the audit."""
    bodies, knots = bodies_of(line)
    law = line.strumming

    def taken(column: Floats) -> Any:
        return np.ascontiguousarray(column) if compiled else column.tolist()

    records: Any = np.array(knots, record_type(Knot))
    return Moored(
        bodies.copy() if compiled else list(map(RefereeBody._make, bodies.tolist())),
        records if compiled else knots,
        len(line.length),
        head_count(line),
        line.friction.law,
        AT_REST if law is None else law.vibration(0.0),
        0.0 if law is None else frequency,
        taken(water.level),
        taken(water.u),
        taken(water.v),
        taken(water.w),
        taken(water.density),
        water.gravity,
        taken(water.viscosity_level),
        taken(water.viscosity),
    )


def referee_of(line: Line, water: Water, frequency: float, compiled: bool) -> Referee:
    """Prepare the inputs and work arrays for the audit of a line."""
    moored = moored_of(line, water, frequency, compiled)
    nodes: Any = np.zeros((2, len(line.length)), np.intp)
    first, last = nodes if compiled else nodes.tolist()
    return Referee(moored, copy(moored.bodies), first, last)


@once_per_input
def bodies_of(line: Line) -> tuple[Any, list[Knot]]:
    """Return the bodies of a line for the audit, and the knots of its elongation curves.

    The bodies are the pieces, then the clamps, as an array of `RefereeBody` records. The knots are
    interpolation points.
    """
    pieces = len(line.length)
    bodies: Any = np.zeros(pieces + len(line.clamp_at), record_type(RefereeBody))
    for name in _OF_PIECE:
        bodies[name][:pieces] = getattr(line, name)
    for name, column in _OF_CLAMP.items():
        bodies[name][pieces:] = getattr(line, column)
    for first, curves in ((0, line.drag_curve), (pieces, line.clamp_drag_curve)):
        for place, curve in enumerate(curves, first):
            if curve is not None:
                bodies["smooth"][place] = curve.diameter
                bodies["lengthening"][place] = curve.lengthening
    knots: list[Knot] = []
    for piece, stretch in enumerate(line.elongation):
        if stretch is not None:
            bodies["first_knot"][piece] = len(knots)
            knots += stretch.knots
            bodies["end_knot"][piece] = len(knots)
    return bodies, knots


_OF_PIECE = (
    "flexible", "length", "buoyancy", "volume", "normal_drag", "tangential_drag", "directional",
    "compliance", "thinning", "lift", "push_east", "push_north", "diameter",
)  # fmt: skip
_OF_CLAMP = {
    "buoyancy": "clamp_buoyancy",
    "volume": "clamp_volume",
    "normal_drag": "clamp_drag",
    "lift": "clamp_lift",
}


def shape_of(solution: Solution) -> RefereeShape:
    """Convert the shape of a solution to the data structure used by the audit.

    The shape on fine segments is used, before extrapolation.
    """
    nodes = len(solution.position)
    none = np.zeros(1)
    of_elements = solution.element_piece, solution.element_clamp, solution.cut, solution.strain
    closed = solution.marched or solution
    columns = [*closed.position.T, *closed.force.T]
    columns += [np.concatenate([none, column]) for column in of_elements]
    first, last = solution.piece_nodes.T.tolist()
    record = [column.tolist() for column in columns]
    return RefereeShape(record, nodes, solution.hanging, first, last)


def amplification(solution: Solution) -> Floats:
    """Return the factor (k,) by which strumming increases the normal drag of every element."""
    line, factor = solution.line, np.ones(len(solution.cut))
    diameter = line.diameter[solution.element_piece]
    if line.strumming is None or solution.frequency == 0.0:
        return factor
    vibration, flow = line.strumming.vibration(0.0), _flow(solution)
    across = flow_across(solution)
    for element in np.flatnonzero(diameter > 0.0):
        u, v, w = flow[element].tolist()
        factor[element] = strumming(
            vibration, solution.frequency, float(diameter[element]), u, v, w, float(across[element])
        )
    return factor


def flow_across(solution: Solution) -> Floats:
    """Return the speed (k,) of the current component normal to every element [m/s].

    The speed is 0 for an element without length.
    """
    chord = np.diff(solution.position, axis=0)
    size = sizes(chord)
    across = np.linalg.norm(np.cross(_flow(solution), chord), axis=1)
    speed: Floats = np.divide(across, size, out=np.zeros(len(size)), where=size > 0)
    return speed


def _flow(solution: Solution) -> Floats:
    """Return the current (k, 3) at the midpoint of every element [m/s]."""
    heights = solution.position[:, 2]
    return solution.water.current_at(-0.5 * (heights[:-1] + heights[1:]))
