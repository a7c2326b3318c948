"""How far a solution of CALM is from the referee's, and whether its forces close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.solve import Solution
from tests.validation.closing import Equilibrium
from tests.validation.loads import DOWN, Load, Profile, Vector


@dataclass(frozen=True)
class Difference:
    """The worst over the ends of all pieces and over all clamps.

    Attributes
    ----------
    place : of any depth or offset, as a share of the water depth
    tension : of any tension, as a share of that tension, or of a thousandth of the line's
        greatest where it is smaller still
    """

    place: float
    tension: float


def difference(solution: Solution, referee: Equilibrium) -> Difference:
    """CALM's solution against the referee's."""
    nodes, shape = solution.piece_nodes, referee.shape
    at = np.concatenate([*nodes.T, np.array(clamp_nodes(solution), dtype=int)])
    place = np.abs(solution.position[at] - np.concatenate([shape.top, shape.bottom, shape.clamp]))
    expected = np.linalg.norm(np.concatenate([shape.force_top, shape.force_bottom]), axis=1)
    tension = np.abs(solution.tension[nodes.T.ravel()] - expected)
    relative = tension / np.maximum(expected, 1e-3 * expected.max())
    return Difference(float(place.max()) / solution.water.depth, float(relative.max()))


def closure(solution: Solution) -> float:
    """|sum of all loads − force at the anchor| / |force at the anchor|.

    The loads are recomputed here from the final coordinates, by the referee's formulas. Of a line
    on the seabed they are those above the touchdown; where a rigid piece or a clamp comes down
    there, it and the seabed settle the vertical ones between them.
    """
    line, water, position = solution.carried, solution.water, solution.position
    profile, total = Profile(water), np.zeros(3)

    def pull(load: Load, start: Vector, end: Vector, swelling: float = 1.0) -> Vector:
        chord = float(np.linalg.norm(end - start))
        flow = profile.at(-float(start[2] + end[2]) / 2.0)
        return load.force(flow, (end - start) / chord if chord else DOWN, swelling)

    for clamp, node in enumerate(clamp_nodes(solution)):
        if node >= solution.hanging:
            continue
        drag = line.clamp_drag[clamp]
        lift = line.clamp_buoyancy[clamp], line.clamp_volume[clamp]
        load = Load(*lift, drag, drag, False, water.gravity)
        total += pull(load, position[node], position[node])
    for piece, (first, last) in enumerate(np.minimum(solution.piece_nodes, solution.hanging)):
        if first == last:
            continue
        load = Load(
            line.buoyancy[piece], line.volume[piece], line.normal_drag[piece],
            line.tangential_drag[piece], line.directional[piece], water.gravity,
        )  # fmt: skip
        if not line.flexible[piece]:
            total += pull(load, position[first], position[last])
            continue
        for element in range(first, last):
            cut, ends = solution.cut[element], position[element : element + 2]
            if cut > 0.0:
                stretched = np.linalg.norm(ends[1] - ends[0]) / cut
                total += cut * pull(load, *ends, stretched ** line.thinning[piece])
    anchor = solution.force[-1]
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
