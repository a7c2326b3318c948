"""The drop of an anchor with inertia and added mass, apart from the program: lumped masses.

Masses at nodes, springs with some damping between them that bear no push, drag of every segment by
its mean velocity; in the plane of the drop, x towards the float and z upward. scipy's BDF.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

DAMPING = 0.05  # of the critical one of a spring
ADDED = 0.5  # of a sphere, as a share of its volume


@dataclass(frozen=True)
class Wire:
    """A uniform wire: length [m], diameter [m], weight in water [N/m], mass [kg/m], Cn, Ct, EA."""

    length: float
    diameter: float
    weight: float
    mass: float
    cn: float
    ct: float
    stiffness: float


@dataclass(frozen=True)
class Ball:
    """A sphere at either end: diameter [m], mass [kg], K of its drag [N/(m/s)²]."""

    diameter: float
    mass: float
    drag: float

    @property
    def volume(self):
        return np.pi * self.diameter**3 / 6.0


@dataclass(frozen=True)
class Sea:
    """Depth [m], density [kg/m³], gravity [m/s²], and the current towards the float by depth."""

    depth: float
    density: float
    gravity: float
    current: object


def dynamic_drop(sea, wire, top, anchor, anchor_weight, start):
    """Fall time [s], how far the anchor lands towards the float, and how far that moved [m].

    Parameters
    ----------
    start : (n+1, 2) nodes at rest, the float first, the anchor at the origin
    """
    n = len(start) - 1
    piece = wire.length / n
    rho, gravity = sea.density, sea.gravity
    mass = np.full(n + 1, piece * (wire.mass + rho * np.pi * wire.diameter**2 / 4.0))
    weight = np.full(n + 1, piece * wire.weight)
    mass[[0, -1]] *= 0.5
    weight[[0, -1]] *= 0.5
    mass[0] += top.mass + ADDED * rho * top.volume
    mass[-1] += anchor.mass + ADDED * rho * anchor.volume
    weight[-1] += anchor_weight
    across = 0.5 * rho * wire.cn * wire.diameter * piece
    along = 0.5 * rho * wire.ct * np.pi * wire.diameter * piece
    damping = 2.0 * DAMPING * np.sqrt(wire.stiffness / piece * np.minimum(mass[:-1], mass[1:]))

    def water(z):
        return np.column_stack([sea.current(-z), np.zeros(len(z))])

    def motion(_, state):
        place, velocity = state.reshape(2, -1, 2)
        force = np.zeros_like(place)
        force[:, 1] -= weight
        chord = np.diff(place, axis=0)
        size = np.hypot(*chord.T)
        axis = chord / size[:, np.newaxis]
        rate = np.einsum("ij,ij->i", np.diff(velocity, axis=0), axis)
        pull = np.maximum(wire.stiffness * (size / piece - 1.0) + damping * rate, 0.0)
        pull = (pull * (size > piece))[:, np.newaxis] * axis
        middle, moving = ((each[1:] + each[:-1]) / 2.0 for each in (place, velocity))
        flow = water(middle[:, 1]) - moving
        slip = np.einsum("ij,ij->i", flow, axis)
        normal = flow - slip[:, np.newaxis] * axis
        drag = across * np.hypot(*normal.T)[:, np.newaxis] * normal
        drag += (along * abs(slip) * slip)[:, np.newaxis] * axis
        force[:-1] += pull + drag / 2.0
        force[1:] += drag / 2.0 - pull
        flow = water(place[[0, -1], 1]) - velocity[[0, -1]]
        pushed = np.hypot(*flow.T)[:, np.newaxis] * flow
        draft = np.clip(0.5 - place[0, 1] / top.diameter, 0.0, 1.0)
        wetted = np.arccos(1.0 - 2.0 * draft)
        wetted -= 2.0 * (1.0 - 2.0 * draft) * np.sqrt(draft * (1.0 - draft))
        force[0] += top.drag * wetted / np.pi * pushed[0]
        force[0, 1] += gravity * (rho * top.volume * draft**2 * (3.0 - 2.0 * draft) - top.mass)
        force[-1] += anchor.drag * pushed[1]
        return np.concatenate([velocity.ravel(), (force / mass[:, np.newaxis]).ravel()])

    def touchdown(_, state):
        return state[2 * n + 1] + sea.depth

    touchdown.terminal = True
    begin = np.concatenate([start.ravel(), np.zeros(2 * (n + 1))])
    solved = solve_ivp(
        motion, (0.0, 1e5), begin, method="BDF", events=touchdown, rtol=1e-3, atol=1e-3
    )
    end = solved.y[: 2 * (n + 1), -1].reshape(-1, 2)
    return solved.t[-1], end[-1, 0], start[0, 0] - end[0, 0]
