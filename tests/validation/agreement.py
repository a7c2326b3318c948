"""How far a solution of CALM is from the referee's, and whether its forces close."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.solve import Solution
from tests.validation.closing import Equilibrium
from tests.validation.loads import DOWN, Load, Profile, Vector, on_clamp, on_piece
from tests.validation.towed import Towed

Ends = tuple[Vector, Vector]
"""Places (2n+m, 3) at the tops and the lower ends of the n pieces and at the m clamps [m]; tensions
(2n) at the tops and the lower ends [N]."""


@dataclass(frozen=True)
class Difference:
    """The worst over the ends of all pieces and over all clamps.

    Attributes
    ----------
    place : of any depth or offset, as a share of the water depth, or of the length of a tow
    tension : of any tension, as a share of that tension, or of a thousandth of the line's
        greatest where it is smaller still
    metres, newtons : the same as they are
    """

    place: float
    tension: float
    metres: float
    newtons: float


def difference(solution: Solution, referee: Equilibrium | Towed) -> Difference:
    """CALM's solution against the referee's."""
    return apart(ends_of(solution), integrated_ends(referee), size_of(solution))


def apart(found: Ends, expected: Ends, size: float) -> Difference:
    """By how much ends are off what is expected; `size` is what places are measured by [m]."""
    (places, tensions), (there, right) = found, expected
    metres, newtons = np.abs(places - there).max(), np.abs(tensions - right)
    relative = newtons / np.maximum(right, 1e-3 * right.max())
    return Difference(
        float(metres / size), float(relative.max()), float(metres), float(newtons.max())
    )


def ends_of(solution: Solution) -> Ends:
    """Those of a solution of CALM."""
    nodes = solution.piece_nodes.T
    at = np.concatenate([*nodes, np.array(clamp_nodes(solution), dtype=int)])
    return solution.position[at], solution.tension[nodes.ravel()]


def inside_cables(solution: Solution, referee: Equilibrium | Towed) -> tuple[float, float]:
    """The worst departures at the nodes of hanging cables: of a place [m] and of a tension [N].

    What is extrapolated of the touchdown is its place, which is at another length of the line in
    every shape: it does not count here.
    """
    metres = newtons = 0.0
    lowest = last_before_touchdown(solution)
    for piece in np.flatnonzero(solution.line.flexible):
        first, last = np.minimum(solution.piece_nodes[piece], lowest)
        s = np.concatenate([[0.0], np.cumsum(solution.cut[first:last])])
        there = referee.shape.inside(int(piece), s)
        known = np.isfinite(there[:, 0])
        off = np.abs(solution.position[first : last + 1] - there[:, :3])[known]
        tension = np.linalg.norm(there[known, 3:], axis=1)
        more = np.abs(solution.tension[first : last + 1][known] - tension)
        # above a clamp and below it there are two forces at one place
        clamps = solution.line.clamp_at[solution.line.clamp_piece == piece]
        more[np.isclose(s[known, None], clamps, rtol=0.0, atol=1e-9 * s[-1]).any(axis=1)] = 0.0
        metres, newtons = max(metres, 0.0, *off.ravel()), max(newtons, 0.0, *more)
    return float(metres), float(newtons)


def last_before_touchdown(solution: Solution) -> int:
    """The last node of what hangs, but of a line that lands the touchdown and the middle of the
    segment above it."""
    return solution.hanging - 2 if solution.landed else solution.hanging


def integrated_ends(referee: Equilibrium | Towed) -> Ends:
    """Those of an answer of the referee."""
    shape = referee.shape
    forces = np.concatenate([shape.force_top, shape.force_bottom])
    places = np.concatenate([shape.top, shape.bottom, shape.clamp])
    return places, np.linalg.norm(forces, axis=1)


def size_of(solution: Solution) -> float:
    """What places are measured by: the water depth, or the length of a tow [m]."""
    line = solution.line
    return float(line.length.sum() if line.towed else solution.water.depth)


def closure(solution: Solution, profile: Profile | None = None) -> float:
    """|sum of all loads − force at the line's end| / |force at the line's end|, or a thousandth of
    the greatest force where that is more.

    The loads are recomputed here from the final coordinates, by the referee's formulas, in the
    water of the solution or in that of `profile`. Of a line on the seabed they are those above the
    touchdown, with friction the force is that there; where a rigid piece or a clamp comes down
    there, it and the seabed settle the vertical ones between them.
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
    held = solution.landed and solution.settings.seabed_friction > 0.0
    anchor = closed.force[solution.hanging if held else -1]
    if solution.landed:
        around = slice(solution.hanging - 1, solution.hanging + 1)
        piece, segment = solution.element_piece[around], solution.element_clamp[around] < 0
        in_cable = segment.all() and len(set(piece)) == 1 and line.flexible[piece[0]]
        total[2] *= float(in_cable)
    # of a line that lies on the seabed nothing may be left at the anchor
    scale = max(float(np.linalg.norm(anchor)), 1e-3 * float(solution.tension.max()))
    return float(np.linalg.norm(total - anchor) / scale)


def clamp_nodes(solution: Solution) -> list[int]:
    """The node above each clamp."""
    order = np.argsort(solution.element_clamp, kind="stable")
    return [int(element) for element in order if solution.element_clamp[element] >= 0]
