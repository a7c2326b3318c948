"""What every solution must satisfy, recomputed from its coordinates without the march.

Closure: buoyancy and drag of every element from the final positions and axes sum to the force at
the line's end. Moments: every axis lies along the mean of the forces at its two ends, and a cable
is stretched as that force has it. Neither uses a number that the march left behind, but for the
positions.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import asin

import numpy as np

from calm.physics.friction import Friction
from calm.physics.line import REFERENCE_DENSITY, Floats, Integers, Water
from calm.physics.reynolds import DragCurve
from calm.physics.track import head_count
from calm.solve.solution import Solution, sizes

LARGEST_CLOSURE = 1e-6
LARGEST_MOMENT = 1e-8


def loads(solution: Solution) -> Floats:
    """(k, 3) buoyancy and drag of every element [N]; a rigid piece's at its own middle."""
    line, water = solution.carried, solution.water
    piece, clamp = solution.element_piece, solution.element_clamp
    top, bottom = solution.position[:-1].copy(), solution.position[1:].copy()
    rigid = ~line.flexible[piece] & (clamp < 0)
    ends = solution.piece_nodes[piece[rigid]]
    top[rigid], bottom[rigid] = (
        solution.position[ends[:, 0]],
        solution.position[ends[:, 1]],
    )

    depth = -0.5 * (top + bottom)[:, 2]
    current, density = water.at(depth)
    chord = bottom - top
    size = sizes(chord)[:, None]
    axis = np.divide(chord, size, out=np.zeros_like(chord), where=size > 0)
    axis[rigid] = _rigid_axes(solution)[piece[rigid]]
    along = np.sum(current * axis, axis=1, keepdims=True) * axis
    normal = current - along

    def squared(v: Floats) -> Floats:
        result: Floats = sizes(v)[:, None] * v
        return result

    # a rigid piece's load is spread over its elements by length; without length the last has it
    last = solution.piece_nodes[piece, 1] - 1 == np.arange(len(piece))
    whole = np.where(last, 1.0, 0.0)
    np.divide(solution.cut, line.length[piece], out=whole, where=line.length[piece] > 0)
    amount = np.where(line.flexible[piece], solution.cut, whole)
    grown = amount * _stretched(solution, size[:, 0]) ** line.thinning[piece]
    directional = line.directional[piece][:, None]
    opposed = np.where(directional, normal, current)
    varied = _on_curves(line.drag_curve, piece, opposed, depth, water)
    normal_drag = line.normal_drag[piece] * amplification(solution) * varied
    tangential_drag = np.where(directional, line.tangential_drag[piece][:, None], 0.0)
    drag = normal_drag[:, None] * squared(opposed) + tangential_drag * squared(along)
    cables = line.flexible[piece] & (clamp < 0)
    if line.friction is not Friction.BERTEAUX:
        otherwise = squared(current)
        if line.friction is Friction.CONSTANT:
            way = np.sign(np.sum(current * axis, axis=1, keepdims=True))
            otherwise = np.sum(current**2, axis=1, keepdims=True) * way * axis
        change = line.tangential_drag[piece][:, None] * (otherwise - squared(along))
        drag[cables] += change[cables]
    drag *= (grown * density / REFERENCE_DENSITY)[:, None]
    excess = (density - REFERENCE_DENSITY) * water.gravity
    lift = amount * (line.buoyancy[piece] + excess * line.volume[piece])
    raised = np.sum(current**2, axis=1) * density / REFERENCE_DENSITY
    lift += np.where(line.flexible[piece], 0.0, amount * line.lift[piece] * raised)

    here = clamp >= 0
    which = clamp[here]
    flow = current[here]
    varied = _on_curves(line.clamp_drag_curve, which, flow, depth[here], water)
    resistance = line.clamp_drag[which] * varied
    drag[here] = squared(flow) * (resistance * density[here] / REFERENCE_DENSITY)[:, None]
    lift[here] = line.clamp_buoyancy[which] + excess[here] * line.clamp_volume[which]
    lift[here] += line.clamp_lift[which] * raised[here]
    drag[:, 2] += lift
    rigid_own = np.where(line.flexible[piece] | (clamp >= 0), 0.0, amount)
    drag[:, 0] += rigid_own * line.push_east[piece]
    drag[:, 1] += rigid_own * line.push_north[piece]
    return drag


def _rigid_axes(solution: Solution) -> Floats:
    """(n, 3) axes of the rigid pieces; one without length lies along the mean force at its ends."""
    nodes = solution.piece_nodes.copy()
    head = head_count(solution.line)
    if head:
        nodes[:head] = nodes[0, 0], nodes[head - 1, 1]
    first, last = nodes.T
    axis = solution.position[last] - solution.position[first]
    plumb = sizes(axis) == 0.0
    axis[plumb] = -(solution.force[first] + solution.force[last])[plumb]
    size = sizes(axis)[:, None]
    unit: Floats = np.divide(axis, size, out=np.zeros_like(axis), where=size > 0)
    return unit


def _on_curves(
    curves: Sequence[DragCurve | None], which: Integers, flow: Floats, depth: Floats, water: Water
) -> Floats:
    """How many times its constant drag each element has, by `which` of the curves it follows.

    In a flow across it (k, 3) [m/s], at a depth (k,) [m].
    """
    varied = np.ones(len(which))
    for index, curve in enumerate(curves):
        if curve is not None:
            for element in np.flatnonzero(which == index):
                viscosity = float(water.viscosity_at(depth[element]))
                speed = float(np.linalg.norm(flow[element]))
                varied[element] = curve.factor(speed * curve.diameter / viscosity)
    return varied


def _stretched(solution: Solution, length: Floats) -> Floats:
    """(k,) length of every element [m] over its cut length; 1 of what is rigid or has no length."""
    cut = solution.cut
    cable = solution.line.flexible[solution.element_piece] & (cut > 0.0)
    return np.divide(length, cut, out=np.ones(len(cut)), where=cable)


def _expected_stretch(solution: Solution, above: Floats) -> Floats:
    """(k,) strain that the forces at the ends of every element (k+1, 3) ask for."""
    line, piece = solution.line, solution.element_piece
    middle = sizes(0.5 * (above[:-1] + above[1:]))
    half = 0.5 * np.diff(sizes(above))
    expected: Floats = line.compliance[piece] * middle
    for index, curve in enumerate(line.elongation):
        if curve is not None:
            for element in np.flatnonzero(piece == index):
                expected[element] = curve.mean_strain(middle[element], half[element])
    return expected


def amplification(solution: Solution) -> Floats:
    """(k,) how much strumming raises the normal drag of every element above that at rest."""
    line, factor = solution.line, np.ones(len(solution.cut))
    law, diameter = line.strumming, line.diameter[solution.element_piece]
    if law is None or solution.frequency == 0.0:
        return factor
    current, _ = _flow(solution)
    speed, across = sizes(current), flow_across(solution)
    for element in np.flatnonzero((diameter > 0.0) & (across > 0.0)):
        angle = asin(min(across[element] / speed[element], 1.0))
        beat = solution.frequency * diameter[element] / speed[element]
        factor[element] = law.factor(angle, beat)
    return factor


def flow_across(solution: Solution) -> Floats:
    """(k,) speed of the current across the axis of every element [m/s]; 0 without length."""
    chord = np.diff(solution.position, axis=0)
    size = sizes(chord)
    across = np.linalg.norm(np.cross(_flow(solution)[0], chord), axis=1)
    speed: Floats = np.divide(across, size, out=np.zeros(len(size)), where=size > 0)
    return speed


def _flow(solution: Solution) -> tuple[Floats, Floats]:
    """Current (k, 3) [m/s] and density (k,) [kg/m³] at the middle of every element."""
    return solution.water.at(-0.5 * (solution.position[:-1] + solution.position[1:])[:, 2])


def closure(solution: Solution, load: Floats) -> float:
    """Relative departure of the recomputed `loads`' sum from the force at the line's end.

    Where the line lies on the seabed, the loads above its touchdown must leave no vertical force
    there: but a downward one where a rigid piece or clamp stands, and an upward one that the
    weight of a rigid piece lying there holds down. Friction on what lies takes its share of the
    horizontal force.
    """
    hanging = solution.hanging
    load = load[:hanging]
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


def moment_residual(solution: Solution, load: Floats) -> float:
    """Largest angle between an element's axis and the mean of the forces at its ends [rad].

    The forces follow from the recomputed `loads`. Or, where that is larger, departure of a cable's
    strain from what these forces ask for. Both beyond the rounding of the coordinates.
    """
    above = np.vstack([np.zeros(3), np.cumsum(load, axis=0)])
    chord = np.diff(solution.position, axis=0)
    worst = 0.0
    cable = solution.line.flexible[solution.element_piece] & (solution.element_clamp < 0)
    single = cable.copy()  # elements that balance by themselves
    head = head_count(solution.line)
    rods = [
        list(range(head)),
        *([p] for p in range(head, len(solution.line.length)) if not solution.line.flexible[p]),
    ]
    for rod in rods:
        if not rod or not solution.line.length[rod].sum() > 0.0:
            continue
        first, last = solution.piece_nodes[rod[0], 0], solution.piece_nodes[rod[-1], 1]
        if last - first == 1:
            single[first] = True
        elif last <= solution.hanging:
            worst = max(worst, _rod_residual(solution, load, above, rod))
    hanging = (solution.cut > 0) & (np.arange(len(cable)) < solution.hanging)
    cable, single = cable & hanging, single & hanging
    mean = above[:-1] + 0.5 * load
    angles = _angles(chord[single], mean[single])
    # the ends of a very short segment are rounded by more than the limit
    rounding = 32.0 * np.finfo(float).eps * np.abs(solution.position).max()
    length = sizes(chord)
    angles = np.maximum(angles - rounding / np.maximum(length[single], rounding), 0.0)
    expected = _expected_stretch(solution, above)
    strained = np.abs(_stretched(solution, length) - 1.0 - expected)[cable]
    strained = np.maximum(strained - rounding / solution.cut[cable], 0.0)
    return max(worst, float(np.max(angles, initial=0.0)), float(np.max(strained, initial=0.0)))


def _rod_residual(solution: Solution, load: Floats, above: Floats, rod: list[int]) -> float:
    first, last = solution.piece_nodes[rod[0], 0], solution.piece_nodes[rod[-1], 1]
    origin = solution.position[first]
    chord = solution.position[last] - origin
    length = float(np.linalg.norm(chord))
    mean = above[first].copy()
    for element in range(first, last):
        piece = solution.element_piece[element]
        place = solution.position[element]
        if solution.element_clamp[element] < 0:
            ends = solution.piece_nodes[piece]
            place = 0.5 * (solution.position[ends[0]] + solution.position[ends[1]])
        at = float(np.linalg.norm(place - origin))
        mean += (1.0 - at / length) * load[element]
    return float(_angles(chord[None, :], mean[None, :])[0])


def _angles(axes: Floats, forces: Floats) -> Floats:
    """Angles between the axes and the reversed forces; 0 where either vanishes."""
    (x, y, z), (u, v, w) = axes.T, forces.T
    cross = np.sqrt((y * w - z * v) ** 2 + (z * u - x * w) ** 2 + (x * v - y * u) ** 2)
    along = -(x * u + y * v + z * w)
    return np.where(sizes(axes) * sizes(forces) > 0.0, np.arctan2(cross, along), 0.0)
