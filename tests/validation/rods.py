"""The referee's rigid pieces: the axis that leaves no moment about the lower end.

With the force F above and loads q at distances a from the upper end of a rod of length L,

    t = -G/|G|,    G = F + Σ (1 - a/L) q.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import sqrt

import numpy as np
from scipy.optimize import root

from tests.validation.loads import DOWN, Load, Profile, Vector


def rod_axis(
    loads: Sequence[tuple[float, Load]],
    length: float,
    position: Vector,
    force: Vector,
    profile: Profile,
) -> Vector | None:
    """The unit vector down a rod from `position`; None where no balance is found.

    `loads` are (distance from the upper end, load); those of a rod without length turn it by half.
    """

    height, above = float(position[2]), force.tolist()

    def lever(axis: Vector, drag: float) -> Vector:
        x, y, z = axis.tolist()
        east, north, up = above
        for at, load in loads:
            u, v, w, density = profile.at(-(height + at * z))
            arm = 1.0 - at / length if length else 0.5
            pull = load.pull((drag * u, drag * v, drag * w, density), x, y, z)
            east, north, up = east + arm * pull[0], north + arm * pull[1], up + arm * pull[2]
        return np.array((east, north, up))

    # The drag is raised in steps, one if one will do: each axis starts the search for the next.
    for steps in (1, 4, 16, 64):
        axis: Vector | None = against(lever(DOWN, 0.0))
        for drag in np.linspace(0.0, 1.0, steps + 1)[1:]:
            axis = balance(lambda t, drag=drag: lever(t, drag), axis)
            if axis is None:
                break
        else:
            return axis
    return None


def against(force: Vector) -> Vector:
    """The unit vector against a force; plumb where there is none."""
    size = sqrt(force @ force)
    return force / -size if size > 0.0 else DOWN


def balance(lever: Callable[[Vector], Vector], guess: Vector) -> Vector | None:
    """The unit vector t = -lever(t)/|lever(t)| near `guess`; None where none is found."""
    for start in (guess, against(lever(guess))):
        across = np.linalg.svd(start[None, :])[2][1:]

        def turned(by: Vector, start: Vector = start, across: Vector = across) -> Vector:
            axis = start + by @ across
            return axis / sqrt(axis @ axis)

        def moment(by: Vector, turned=turned, across=across) -> Vector:
            axis = turned(by)
            return across @ (axis - against(lever(axis)))

        found = turned(root(moment, np.zeros(2), tol=1e-14).x)
        if np.abs(found - against(lever(found))).max() < 1e-10:
            return found
    return None
