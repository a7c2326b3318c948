"""The referee's cables: differential equations in the unstretched length s.

With the force above F (every force on the free-end side) and the position r, z up,

    dr/ds = (1 + ε) t,    dF/ds = (0, 0, b) + (1 + ε)^m (Kn |Vn| Vn + Kt |Vt| Vt) ρ/1025,
    t = -F/|F|,           ε = ε(|F|),        b = buoyancy + (ρ - 1025) g · volume.

An eighth-order Runge–Kutta method restarts wherever the cable passes a level of the profile, so
that no kink lies inside a step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import sqrt

import numpy as np
from scipy.integrate import solve_ivp

from tests.validation.loads import DOWN, Load, Profile, Vector
from tests.validation.rods import against, balance

FREE_END = 1e-6
"""Part of a bare cable taken as straight at its free end, where |F| = 0 leaves it no direction."""

MOST_EVALUATIONS = 50_000
"""Of the slope along one cable: a hundred times what one takes that is not slack."""


class NoContinuousSolution(Exception):
    """The referee finds no shape; the message says why."""


class Folded(NoContinuousSolution):
    """The line is slack somewhere and hangs there in a fold too sharp to be a shape of its own."""


@dataclass(frozen=True)
class Cable:
    """A stretch of cable without clamps.

    `load` is that of one unstretched metre, `strain` its law by tension [N].
    """

    load: Load
    length: float
    strain: Callable[[float], float]
    thinning: float


Path = tuple[float, float, Callable[[Vector], Vector]]


@dataclass
class Way:
    """What was followed: where it ends, with what force above, and after how much cable.

    `depths` are those of the points visited, its extremes among them; `slackest` is the least
    tension, but for that of a bare end; `paths` lead along it part by part, where asked for: place
    and force by the unstretched length, from one to another.
    """

    position: Vector
    force: Vector
    length: float = 0.0
    depths: list[float] = field(default_factory=list)
    slackest: float = np.inf
    paths: list[Path] = field(default_factory=list)


def follow(
    cable: Cable, position: Vector, force: Vector, profile: Profile, tolerance: float, lands: bool,
    keeps_path: bool = False,
) -> Way:  # fmt: skip
    """Follow a cable from its upper end; one that `lands` only to where it comes down level.

    `tolerance` is the relative error of a step.
    """
    way = Way(position, force)
    bare = not force.any()
    if bare:
        _leave_free_end(cable, way, profile)
    band = profile.band(-float(way.position[2]), rising=way.force[2] < 0.0)
    load, strain, thinning = cable.load, cable.strain, cable.thinning
    evaluations = 0

    def slope(_: float, state: Vector) -> Vector:
        nonlocal evaluations
        evaluations += 1
        if evaluations > MOST_EVALUATIONS:
            raise Folded("a cable is too slack over too long a way to be followed")
        _, _, height, east, north, up = state.tolist()
        tension = sqrt(east * east + north * north + up * up)
        stretched = 1.0 + strain(tension)
        x, y, z = east / -tension, north / -tension, up / -tension
        pull = load.pull(profile.flow(-height, band), x, y, z, stretched**thinning)
        return np.array((stretched * x, stretched * y, stretched * z, *pull))

    def leaves_upward(_: float, state: Vector) -> float:
        return float(-state[2] - profile.limits(band)[0])

    def leaves_downward(_: float, state: Vector) -> float:
        return float(-state[2] - profile.limits(band)[1])

    def is_level(_: float, state: Vector) -> float:
        return float(state[5])

    leaves_upward.terminal, leaves_upward.direction = True, -1
    leaves_downward.terminal, leaves_downward.direction = True, 1
    is_level.terminal, is_level.direction = lands, -1 if lands else 0

    size = max(float(np.linalg.norm(way.force)), 1.0)
    scale = tolerance * np.array([10.0, 10.0, 10.0, size, size, size])
    while way.length < cable.length:
        path = solve_ivp(
            slope, (way.length, cable.length), np.concatenate((way.position, way.force)),
            method="DOP853", rtol=tolerance, atol=scale,
            events=(leaves_upward, leaves_downward, is_level), dense_output=keeps_path,
        )  # fmt: skip
        if keeps_path:
            way.paths.append((way.length, float(path.t[-1]), path.sol))
        way.length, way.position, way.force = float(path.t[-1]), path.y[:3, -1], path.y[3:, -1]
        upward, downward, level = (times.size for times in path.t_events)
        band += downward - upward
        way.depths += [-z for z in path.y[2]] + [-extreme[2] for extreme in path.y_events[2]]
        tensions = np.linalg.norm(path.y[3:], axis=0)
        way.slackest = min(way.slackest, *tensions[-1 if bare else 0 :])
        if lands and level:
            break
    return way


def _leave_free_end(cable: Cable, way: Way, profile: Profile) -> None:
    flow, pull = profile.at(-float(way.position[2])), cable.load.force
    axis = balance(lambda t: pull(flow, t), against(pull(flow, DOWN)))
    if axis is None:
        raise NoContinuousSolution("a bare end of cable finds no direction")
    way.length = FREE_END * cable.length
    way.position = way.position + way.length * axis
    way.force = way.length * pull(flow, axis)
