"""What every solution must satisfy, recomputed from its coordinates without the march.

Closure: buoyancy and drag of every element from the final positions and axes sum to the force at
the line's end. Moments: every axis lies along the mean of the forces at its two ends, and a cable
is stretched as that force has it. Neither uses a number that the march left behind, but for the
positions.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from calm.physics.compiled import packed, record_type
from calm.physics.line import Floats, Integers, Line
from calm.physics.pace import is_fast, paced
from calm.physics.referee import Body, Moored, Shape, element_loads, strumming, worst_moment
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.stretch import Knot
from calm.physics.strumming import AT_REST
from calm.physics.track import head_count
from calm.solve.solution import Solution, sizes

LARGEST_CLOSURE = 1e-6
LARGEST_MOMENT = 1e-8


class Audit:
    """A solution laid out once, as it is loaded, for all its checks.

    Attributes
    ----------
    loads : (k, 3) buoyancy and drag of every element [N]; a rigid piece's at its own middle
    """

    def __init__(self, solution: Solution) -> None:
        self._solution = solution
        self._moored, self._shape = _moored(solution), _shape(solution)
        written = _taken(np.zeros((3, len(solution.cut))))
        paced(element_loads)(self._moored, self._shape, written)
        self._written = written
        self.loads: Floats = np.array(written).T

    def closure(self) -> float:
        """Relative departure of the sum of the loads from the force at the line's end.

        Where the line lies on the seabed, the loads above its touchdown must leave no vertical
        force there: but a downward one where a rigid piece or clamp stands, and an upward one that
        the weight of a rigid piece lying there holds down. Friction on what lies takes its share
        of the horizontal force.
        """
        solution = self._solution
        hanging = solution.hanging
        load = self.loads[:hanging]
        total = load.sum(axis=0)
        scale = max(float(solution.tension[-1]), 1e-3 * float(np.abs(load).sum()), 1e-300)
        if solution.landed:
            if _points(solution, hanging - 1):
                total[2] = max(total[2], 0.0)
            if _points(solution, hanging):
                total[2] = min(total[2], 0.0)
            tension = float(np.hypot(total[0], total[1]))
            held = min(solution.settings.seabed_friction * _weight_on_seabed(solution), tension)
            total[:2] *= 1.0 - held / tension if tension > 0.0 else 0.0
        return float(np.linalg.norm(total - solution.force[-1])) / scale

    def moment_residual(self) -> float:
        """Largest angle between an element's axis and the mean of the forces at its ends [rad].

        The forces follow from the loads. Or, where that is larger, departure of a cable's strain
        from what these forces ask for. Both beyond the rounding of the coordinates. Towards a limp
        end the tension vanishes, and with it what sets the direction: there counts what the force
        across the line is beyond the rounding of the greatest tension.
        """
        solution = self._solution
        rounding = 32.0 * float(np.finfo(float).eps)
        worst = paced(worst_moment)(
            self._moored, self._shape, self._written, solution.hanging,
            rounding * float(np.abs(solution.position).max()),
            max(rounding * float(solution.tension.max()), 1e-300),
        )  # fmt: skip
        return float(worst)


def _taken(columns: Floats | Integers) -> Any:
    """Columns of numbers as laws take them: compiled an array, else lists."""
    return columns if is_fast() else columns.tolist()


def _moored(solution: Solution) -> Moored:
    water, line = solution.water, solution.carried
    bodies, knots = bodies_of(line)
    law = line.strumming
    moored = Moored(
        bodies if is_fast() else list(map(Body._make, bodies.tolist())),
        knots,
        len(line.length),
        head_count(line),
        line.friction.law,
        AT_REST if law is None else law.vibration(0.0),
        0.0 if law is None else solution.frequency,
        _taken(water.level),
        _taken(water.u),
        _taken(water.v),
        _taken(water.w),
        _taken(water.density),
        water.gravity,
        _taken(water.viscosity_level),
        _taken(water.viscosity),
    )
    return packed(moored) if is_fast() else moored


def bodies_of(line: Line) -> tuple[Any, list[Knot]]:
    """The pieces of a line and, after them, its clamps, and the knots of its elongation curves.

    The bodies are an array of records, one each `Body`.
    """
    pieces = len(line.length)
    bodies: Any = np.zeros(pieces + len(line.clamp_at), record_type(Body))
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


def _shape(solution: Solution) -> Shape:
    columns = (
        *np.ascontiguousarray(solution.position.T),
        *np.ascontiguousarray(solution.force.T),
        solution.element_piece,
        solution.element_clamp,
        solution.cut,
        *np.ascontiguousarray(solution.piece_nodes.T),
    )
    return Shape(*map(_taken, columns))


def amplification(solution: Solution) -> Floats:
    """(k,) how much strumming raises the normal drag of every element above that at rest."""
    line, factor = solution.line, np.ones(len(solution.cut))
    diameter = line.diameter[solution.element_piece]
    if line.strumming is None or solution.frequency == 0.0:
        return factor
    vibration, flow = line.strumming.vibration(0.0), _flow(solution)
    across = flow_across(solution)
    for element in np.flatnonzero(diameter > 0.0):
        u, v, w = flow[element].tolist()
        factor[element] = strumming(
            vibration,
            solution.frequency,
            float(diameter[element]),
            u,
            v,
            w,
            float(across[element]),
        )
    return factor


def flow_across(solution: Solution) -> Floats:
    """(k,) speed of the current across the axis of every element [m/s]; 0 without length."""
    chord = np.diff(solution.position, axis=0)
    size = sizes(chord)
    across = np.linalg.norm(np.cross(_flow(solution), chord), axis=1)
    speed: Floats = np.divide(across, size, out=np.zeros(len(size)), where=size > 0)
    return speed


def _flow(solution: Solution) -> Floats:
    """Current (k, 3) at the middle of every element [m/s]."""
    current, _ = solution.water.at(-0.5 * (solution.position[:-1] + solution.position[1:])[:, 2])
    return current


def _points(solution: Solution, element: int) -> bool:
    """Whether the seabed can bear on an element at a point: a rigid piece or a clamp."""
    if element == len(solution.element_piece):
        return False
    rigid = not solution.line.flexible[solution.element_piece[element]]
    return bool(rigid or solution.element_clamp[element] >= 0)


def _weight_on_seabed(solution: Solution) -> float:
    """Weight in water of what lies on the seabed [N]."""
    line, lying = solution.line, slice(solution.hanging, None)
    piece, clamp, cut = (
        array[lying] for array in (solution.element_piece, solution.element_clamp, solution.cut)
    )
    length = line.length[piece]
    amount = np.where(line.flexible[piece], cut, 1.0)
    np.divide(cut, length, out=amount, where=~line.flexible[piece] & (length > 0.0))
    _, density = solution.water.at(np.array(solution.water.depth))
    excess = (float(density) - REFERENCE_DENSITY) * solution.water.gravity
    lift = np.where(clamp < 0, (line.buoyancy + excess * line.volume)[piece] * amount, 0.0)
    here = clamp[clamp >= 0]
    lift[clamp >= 0] = line.clamp_buoyancy[here] + excess * line.clamp_volume[here]
    return float(-lift.sum())
