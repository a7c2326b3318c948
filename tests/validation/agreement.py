"""How far a solution of CALM is from the referee's, and whether its forces close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.solve import Solution
from tests.validation.closing import Equilibrium
from tests.validation.loads import DOWN, Load, Profile, Vector, on_clamp, on_piece
from tests.validation.towed import Towed


@dataclass(frozen=True)
class Difference:
    """The worst over the ends of all pieces and over all clamps.

    Attributes
    ----------
    place : of any depth or offset, as a share of the water depth, or of the length of a tow
    tension : of any tension, as a share of that tension, or of a thousandth of the line's
        greatest where it is smaller still
    """

    place: float
    tension: float


def difference(solution: Solution, referee: Equilibrium | Towed) -> Difference:
    """CALM's solution against the referee's."""
    nodes, shape = solution.piece_nodes, referee.shape
    size = solution.line.length.sum() if isinstance(referee, Towed) else solution.water.depth
    at = np.concatenate([*nodes.T, np.array(clamp_nodes(solution), dtype=int)])
    place = np.abs(solution.position[at] - np.concatenate([shape.top, shape.bottom, shape.clamp]))
    expected = np.linalg.norm(np.concatenate([shape.force_top, shape.force_bottom]), axis=1)
    tension = np.abs(solution.tension[nodes.T.ravel()] - expected)
    relative = tension / np.maximum(expected, 1e-3 * expected.max())
    return Difference(float(place.max() / size), float(relative.max()))


def closure(solution: Solution, profile: Profile | None = None) -> float:
    """|sum of all loads − force at the line's end| / |force at the line's end|.

    The loads are recomputed here from the final coordinates, by the referee's formulas, in the
    water of the solution or in that of `profile`. Of a line on the seabed they are those above the
    touchdown; where a rigid piece or a clamp comes down there, it and the seabed settle the
    vertical ones between them.
    """
    closed = solution.marched or solution
    line, position = solution.carried, closed.position
    gravity = solution.water.gravity
    profile, total = profile or Profile(solution.water), np.zeros(3)

    def pull(load: Load, start: Vector, end: Vector, swelling: float = 1.0) -> Vector:
        chord = float(np.linalg.norm(end - start))
        flow = profile.at(-float(start[2] + end[2]) / 2.0)
        return load.force(flow, (end - start) / chord if chord else DOWN, swelling)

    for clamp, node in enumerate(clamp_nodes(solution)):
        if node >= solution.hanging:
            continue
        load = on_clamp(line, clamp, gravity)
        total += pull(load, position[node], position[node])
    for piece, (first, last) in enumerate(np.minimum(solution.piece_nodes, solution.hanging)):
        if first == last:
            continue
        load = on_piece(line, piece, gravity, frequency=solution.frequency)
        if not line.flexible[piece]:
            total += pull(load, position[first], position[last])
            continue
        for element in range(first, last):
            cut, ends = solution.cut[element], position[element : element + 2]
            if cut > 0.0:
                stretched = np.linalg.norm(ends[1] - ends[0]) / cut
                total += cut * pull(load, *ends, stretched ** line.thinning[piece])
    anchor = closed.force[-1]
    if solution.landed:
        around = slice(solution.hanging - 1, solution.hanging + 1)
        piece, segment = solution.element_piece[around], solution.element_clamp[around] < 0
        in_cable = segment.all() and len(set(piece)) == 1 and line.flexible[piece[0]]
        total[2] *= float(in_cable)
    return float(np.linalg.norm(total - anchor) / np.linalg.norm(anchor))


def clamp_nodes(solution: Solution) -> list[int]:
    """The node above each clamp."""
    order = np.argsort(solution.element_clamp, kind="stable")
    return [int(element) for element in order if solution.element_clamp[element] >= 0]
