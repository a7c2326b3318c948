"""Verification of properties that hold for every line (C20), and of the order of convergence."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from math import atan2, cos, hypot, log2, pi, radians, sin

import numpy as np

from calm.analytic.uniform import heavy_line
from calm.physics.drag import Friction
from calm.physics.line import Floats, Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve import Settings, Solution, solve_mooring
from calm.verification import solved_moorings
from calm.verification.published_case import (
    FINE,
    GRAVITY,
    HALF_DENSITY,
    Case,
    Kind,
    LinePiece,
    Source,
    cable,
    deep_water,
    line_of,
    point,
    profile,
    sphere_drag,
    stream,
    towed,
)

_TIGHT = Settings(tolerance=1e-9)
_DRAG = sphere_drag(1.25, 0.6)

# A line with all kinds of components: floats, wire, elastic rope, instruments that align with the
# line and others that do not, clamps, and chain. The line is submerged, in a veering current.
_PIECES = (
    LinePiece(1.25, False, 7000.0, _DRAG, _DRAG, False, volume=1.02),
    replace(
        cable(300.0, 0.008, 1.6, 1.3, 0.009, 1.0 / 3e6),
        clamps=((20.0, -80.0, 0.004, 9.0), (150.0, -40.0, 0.002, 4.0)),
    ),
    LinePiece(1.8, False, -180.0, 55.0, 3.0, volume=0.05),
    cable(400.0, 0.016, 0.35, 1.3, 0.013, 1.0 / 2e5),
    *[LinePiece(0.43, False, 225.0, 72.0, 72.0, False, volume=0.042)] * 4,
    LinePiece(0.8, False, -240.0, 60.0, 60.0, False, volume=0.02),
    LinePiece(15.0, True, -31.0, HALF_DENSITY * 0.013 * 2.75, HALF_DENSITY * pi * 0.013 * 0.46),
)
_LINE = line_of(*_PIECES, anchor_height=0.7)
_SEA = Water(
    depth=800.0,
    level=np.array([0.0, 60.0, 150.0, 400.0, 800.0]),
    u=np.array([0.9, 0.8, 0.2, -0.2, 0.1]),
    v=np.array([0.1, 0.4, 0.5, 0.3, 0.0]),
    w=np.array([0.0, 0.01, -0.02, 0.01, 0.0]),
    density=np.array([1022.0, 1024.0, 1026.0, 1027.5, 1029.5]),
    gravity=GRAVITY,
)


@cache
def _solved() -> Solution:
    return solve_mooring(_LINE, _SEA, _TIGHT)


def _apart(one: Solution, other: Solution) -> float:
    """Return the largest difference between two solutions at the ends of their pieces.

    Differences in position are divided by the depth, and differences in tension by the largest
    tension.
    """
    here, there = one.piece_nodes.ravel(), other.piece_nodes.ravel()
    place = np.abs(one.position[here] - other.position[there]).max() / one.water.depth
    tension = np.abs(one.tension[here] - other.tension[there]).max() / one.tension.max()
    return float(max(place, tension))


def _turned() -> float:
    angle = radians(37.0)
    turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
    u, v = turn @ np.array([_SEA.u, _SEA.v])
    other = solve_mooring(_LINE, replace(_SEA, u=u, v=v), _TIGHT)
    back = other.position.copy()
    back[:, :2] = back[:, :2] @ turn
    return _apart(_solved(), replace(other, position=back))


def _mirrored(east: float, north: float) -> float:
    other = solve_mooring(_LINE, replace(_SEA, u=east * _SEA.u, v=north * _SEA.v), _TIGHT)
    return _apart(_solved(), replace(other, position=other.position * [east, north, 1.0]))


def _difference_if_deeper() -> float:
    down = 100.0
    water = replace(_SEA, depth=_SEA.depth + down, level=_SEA.level + down)
    here, there = solve_mooring(_LINE, _SEA, FINE), solve_mooring(_LINE, water, FINE)
    return _apart(here, replace(there, position=there.position + np.array([0.0, 0.0, down])))


def _difference_in_other_units(length: float, force: float, speed: float) -> float:
    amount = force / np.where(_LINE.flexible, length, 1.0)
    line = replace(
        _LINE, length=_LINE.length * length, buoyancy=_LINE.buoyancy * amount,
        volume=_LINE.volume * amount, normal_drag=_LINE.normal_drag * amount / speed**2,
        tangential_drag=_LINE.tangential_drag * amount / speed**2,
        compliance=_LINE.compliance / force, clamp_at=_LINE.clamp_at * length,
        clamp_buoyancy=_LINE.clamp_buoyancy * force, clamp_volume=_LINE.clamp_volume * force,
        clamp_drag=_LINE.clamp_drag * force / speed**2,
        anchor_height=_LINE.anchor_height * length,
    )  # fmt: skip
    water = replace(
        _SEA, depth=_SEA.depth * length, level=_SEA.level * length, u=_SEA.u * speed,
        v=_SEA.v * speed, w=_SEA.w * speed,
    )  # fmt: skip
    other = solve_mooring(line, water, _TIGHT)
    return _apart(
        _solved(), replace(other, position=other.position / length, force=other.force / force)
    )


def _difference_if_split() -> float:
    finest = Settings(radians(0.01), tolerance=1e-10)
    whole, split = (
        solve_mooring(solved_moorings.s1000_mooring(parts), solved_moorings.S1000_SEA, finest)
        for parts in (1, 10)
    )
    place = np.abs(whole.position[0] - split.position[0]).max() / solved_moorings.S1000_SEA.depth
    force = np.abs(whole.force[-1] - split.force[-1]).max() / whole.tension.max()
    return float(max(place, force))


def _loads(solution: Solution) -> Floats:
    """Return the sum (3,) of the weights and drags on all elements at their positions [N]."""
    line, water = solution.line, solution.water
    piece, clamp = solution.element_piece, solution.element_clamp
    chord = np.diff(solution.position, axis=0)
    length = np.linalg.norm(chord, axis=1)
    axis = chord / np.where(length > 0.0, length, 1.0)[:, None]
    depth = -0.5 * (solution.position[:-1, 2] + solution.position[1:, 2])
    current, density = water.current_at(depth), water.density_at(depth)
    along = np.sum(current * axis, axis=1, keepdims=True) * axis
    across = np.where(line.directional[piece][:, None], current - along, current)
    along = np.where(line.directional[piece][:, None], along, 0.0)

    grown = (1.0 + np.where(line.flexible[piece], solution.strain, 0.0)) ** line.thinning[piece]
    amount = np.where(line.flexible[piece], solution.cut, 1.0)
    normal, tangential = line.normal_drag[piece] * grown, line.tangential_drag[piece] * grown
    lift, volume = line.buoyancy[piece], line.volume[piece]
    on_clamp = clamp >= 0
    amount[on_clamp] = 1.0
    across[on_clamp], along[on_clamp] = current[on_clamp], 0.0
    normal[on_clamp] = line.clamp_drag[clamp[on_clamp]]
    lift[on_clamp] = line.clamp_buoyancy[clamp[on_clamp]]
    volume[on_clamp] = line.clamp_volume[clamp[on_clamp]]

    def squared(velocity: Floats) -> Floats:
        return np.asarray(np.linalg.norm(velocity, axis=1, keepdims=True) * velocity)

    drag = normal[:, None] * squared(across) + tangential[:, None] * squared(along)
    drag *= (amount * density / REFERENCE_DENSITY)[:, None]
    drag[:, 2] += amount * (lift + (density - REFERENCE_DENSITY) * water.gravity * volume)
    return np.asarray(drag.sum(axis=0))


def _reaction() -> float:
    solution = _solved().as_marched
    missing = np.linalg.norm(_loads(solution) - solution.force[-1])
    return float(missing / solution.tension[-1])


def _tension_by_height() -> float:
    """Return the largest error of the relation T_top − T_bottom = w Δz, relative to the tension.

    The relation is exact for a cable without tangential drag. The error is the largest over the
    cables of a line, divided by the maximum tension.
    """
    line = line_of(
        *(
            replace(piece, tangential_drag=0.0, compliance=0.0, volume=0.0, clamps=())
            for piece in _PIECES
        )
    )
    solution = solve_mooring(line, _SEA, FINE)
    first, last = solution.piece_nodes[line.flexible].T
    height = solution.position[first, 2] - solution.position[last, 2]
    fall = solution.tension[first] - solution.tension[last]
    missed = np.abs(fall + line.buoyancy[line.flexible] * height)
    return float(missed.max() / solution.tension.max())


def _tension_by_height_and_friction() -> float:
    """Return |T_ship − T_body − w Δz − F s| / T_ship of a tow with constant friction F."""
    weight, friction, length, pull = 2.5, 0.3, 300.0, 2000.0
    line = line_of(LinePiece(length, True, -weight, 8.0, friction), point(-pull, 0.0))
    wake = towed(replace(line, friction=Friction.CONSTANT), deep_water(), 1.0)
    return abs(wake.tension - pull - weight * wake.depth - friction * length) / wake.tension


def _plumb() -> float:
    """Return the largest relative error of offset and tension in still water.

    The exact tension is the net buoyancy of the line above.
    """
    water = replace(_SEA.still(), density=np.full(len(_SEA.level), REFERENCE_DENSITY))
    solution = solve_mooring(_LINE, water, _TIGHT)
    _, last = solution.piece_nodes.T
    held = np.cumsum(_LINE.total_buoyancy)
    offset = float(np.abs(solution.position[:, :2]).max()) / water.depth
    return max(offset, float(np.abs(solution.force[last, 2] - held).max() / held.max()))


@cache
def _undercurrent() -> Solution:
    line = line_of(point(500.0, 100.0), LinePiece(100.0, True, 0.0))
    return solve_mooring(line, profile(110.0, [(0.0, 0.2), (12.0, 0.2), (30.0, 3.0)]), _TIGHT)


def _depth_of_other_equilibrium() -> float:
    other = _undercurrent().other
    return 0.0 if other is None else other.depth


def _nothing(name: str, tolerance: float, why: str, got: Callable[[], float]) -> Case:
    return Case(f"C20 {name}", 0.0, "", tolerance, why, got, Kind.PROPERTY)


_SAME = (
    "Both solutions have the same segments. The tolerance covers rounding and the root searches, "
    "which stop at an error of 1e-9 of the depth."
)
_RODS = "The error of straight segments is 1 − cos(half an angle step): 4e-7 at a step of 0.1°."

INVARIANTS = Source(
    "Invariants",
    """These properties hold for every line and need no reference (C20). The line has one piece of
each kind (a float, 300 m of wire with two clamps, an instrument that follows the line, 400 m of
rope that stretches, four glass balls, a release, chain). The current turns with depth, reverses and
has an upward component, and the density grows with depth. Each difference is the maximum over all
positions, divided by the depth, or the maximum over all tensions, divided by the largest tension.

If the current grows with depth, a mooring may have several equilibria. The example is a float of
500 N, with a drag of 100 N at 1 m/s, on 100 m of thread in 110 m of water. The current is 0.2 m/s
down to 12 m, and grows to 3 m/s at 30 m. The float has three equilibria, at depths d of 10.0032,
21.0044 and 61.4357 m. These depths are the roots of d = 110 − 100/√(1 + (D(d)/B)²), with the
buoyancy B and the drag D. CALM gives the highest equilibrium and reports the deepest; the
equilibrium between them is unstable.""",
    (
        _nothing("current turned by 37°: the line turns", 1e-8, _SAME, _turned),
        _nothing("current reversed: the line reverses", 1e-8, _SAME,
                 lambda: _mirrored(-1.0, -1.0)),
        _nothing("current mirrored: the line is mirrored", 1e-8, _SAME,
                 lambda: _mirrored(1.0, -1.0)),
        _nothing("seabed and axes moved by 100 m: the line follows", 4e-6,
                 "The two shapes have different segments. At 0.1°, each has an error of 2e-6.",
                 _difference_if_deeper),
        _nothing("lengths × 3, forces × 0.2, speeds × 1.7: similar", 1e-8, _SAME,
                 lambda: _difference_in_other_units(3.0, 0.2, 1.7)),
        _nothing("anchor reaction − sum of all loads", 1e-9,
                 "Rounding; the loads are recomputed from the final coordinates.", _reaction),
        _nothing("no current: plumb, tensions are sums", 1e-12, "Rounding.", _plumb),
        _nothing("Ct 0: T_top − T_bottom − w Δz, divided by T", 1e-6, _RODS, _tension_by_height),
        _nothing("constant friction: T − T₀ − w Δz − F s, divided by T", 1e-6, _RODS,
                 _tension_by_height_and_friction),
        _nothing("S1000 with its cable in ten pieces", 1e-8,
                 "The error of the march is 1e-9 of the depth at an angle step of 0.01°.",
                 _difference_if_split),
        *(
            Case(f"C20 three equilibria: float depth in the {name}", depth, "m", 1e-6,
                 "The roots are given to nine digits; CALM closes to 1e-9 of the depth.", got,
                 Kind.CLOSED_FORM)
            for name, depth, got in (
                ("highest", 10.0031998, lambda: -float(_undercurrent().position[0, 2])),
                ("lowest", 61.4357069, _depth_of_other_equilibrium),
            )
        ),
    ),
)  # fmt: skip


ANGLE_STEPS = (4.0, 2.0, 1.0, 0.5, 0.25, 0.125)
"""Angle steps for the order of convergence [degrees]."""

LENGTH = 1000.0
_BUOYANCY, _WEIGHT = 4905.0, 2.0


@cache
def heavy_line_error(degrees: float) -> float:
    """Return the distance of the free end of a heavy line from its closed-form position [m].

    Parameters
    ----------
    degrees : angle step of the integration along the line [degrees]
    """
    drag, rope = sphere_drag(1.0, 0.65), cable(LENGTH, 0.0127, _WEIGHT, 1.3, 0.01)
    line = line_of(point(_BUOYANCY, drag), rope)
    solution = solve_mooring(line, stream(1010.0, 1.0), Settings(radians(degrees), 1e-9))
    exact = heavy_line(
        -LENGTH, hypot(_BUOYANCY, drag), atan2(_BUOYANCY, -drag), _WEIGHT,
        rope.normal_drag, rope.tangential_drag,
    )  # fmt: skip
    position = solution.as_marched.position
    x, _, z = (position[-1] - position[0]).tolist()
    return hypot(-x - float(exact.x), z - float(exact.z))


def _order(coarse: float, fine: float) -> float:
    return log2(heavy_line_error(coarse) / heavy_line_error(fine)) / log2(coarse / fine)


CONVERGENCE = Source(
    "Order of convergence",
    """The heavy line of C5 in a uniform current of 1 m/s is solved at angle steps from 4° to 0.125°
and compared with the closed form of `calm.analytic.uniform`, which shares no code with the march.
The march is of second order: halving the step divides the error by four. CALM extrapolates its
results from two such shapes, so their errors are much smaller.""",
    (
        *(
            Case(f"C20 order, {coarse:g}° to {fine:g}°", 2.0, "", 0.05,
                 "Fourth-order terms and the shorter last segment change the order slightly.",
                 partial(_order, coarse, fine), Kind.PROPERTY)
            for coarse, fine in ((2.0, 1.0), (1.0, 0.5), (0.5, 0.25))
        ),
        Case("C20 position error of the free end at 1°", 0.0, "m", 5e-5 * LENGTH,
             "CALM's stated accuracy at its default angle step: 5e-5 of the depth.",
             partial(heavy_line_error, 1.0), Kind.CLOSED_FORM),
    ),
    picture="verification-convergence",
)  # fmt: skip
