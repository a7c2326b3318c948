"""An independent continuous solution of a mooring: the referee of CALM's march.

Nothing here is shared with the solver, which cuts cables into straight rods. Cables are ordinary
differential equations in the unstretched length s, with the force above F (every force on the
free-end side) and the position r, z up:

    dr/ds = (1 + ε) t,    dF/ds = (0, 0, b) + (1 + ε)^m (Kn |Vn| Vn + Kt |Vt| Vt) ρ/1025,
    t = -F/|F|,           ε = |F|/EA,        b = buoyancy + (ρ - 1025) g · volume,

integrated by an eighth-order Runge–Kutta method which restarts at clamps and wherever the line
passes a level of the profile, so that no kink lies inside a step. A rigid piece of length L turns
until the moments about its lower end vanish: with loads q at distances a from its upper end,

    t = -G/|G|,    G = F + Σ (1 - a/L) q.

Pieces that do not float, listed above the first float, make one rod with it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from calm.physics.line import Line, Water
from tests.validation.loads import DOWN, Load, Profile, Vector

FREE_END = 1e-6
"""Part of a bare cable taken as straight at its free end, where |F| = 0 leaves it no direction."""

MOST_EVALUATIONS = 50_000
"""Of the slope along one cable: a hundred times what one takes that is not slack."""


class NoContinuousSolution(Exception):
    """The referee finds no shape; the message says why."""


class Folded(NoContinuousSolution):
    """The line is slack somewhere and hangs there in a fold too sharp to be a shape of its own."""


@dataclass
class Shape:
    """A line marched down from its free end: n pieces and m clamps, positions and forces above.

    x and y count from the free end. `depths` are those of every point visited, `slackest` the
    least tension inside a cable, but for the bare end of one.
    """

    top: Vector
    bottom: Vector
    force_top: Vector
    force_bottom: Vector
    clamp: Vector
    clamp_above: Vector
    clamp_below: Vector
    depths: list[float] = field(default_factory=list)
    slackest: float = np.inf

    def shifted(self, by: Vector) -> Shape:
        """The same shape elsewhere: `by` (2,) added to every x, y [m]."""
        move = np.array([by[0], by[1], 0.0])
        top, bottom, clamp = self.top + move, self.bottom + move, self.clamp + move
        return replace(self, top=top, bottom=bottom, clamp=clamp)


class March:
    """Goes down one line in one water; `tolerance` is the relative error of a step."""

    def __init__(self, line: Line, water: Water, tolerance: float) -> None:
        self.line, self.profile, self.tolerance = line, Profile(water), tolerance
        self.gravity, self.depth = float(water.gravity), float(water.depth)
        self.head = head(line)
        pieces = range(len(line.length))
        self.clamps = [
            sorted(np.flatnonzero(line.clamp_piece == piece), key=lambda c: line.clamp_at[c])
            for piece in pieces
        ]

    def down(self, depth: float, share: Vector, until: int | None = None) -> Shape:
        """The shape with the free end at `depth` and the part `share` (n,) of each buoyancy.

        It is left blank below the top of the piece `until`.
        """
        n, m = len(self.line.length), len(self.line.clamp_piece)
        shape = Shape(*(np.zeros((k, 3)) for k in (n, n, n, n, m, m, m)))
        position, force = np.array([0.0, 0.0, -depth]), np.zeros(3)
        shape.depths.append(depth)
        piece = 0
        while piece < (n if until is None else until):
            if self.line.flexible[piece]:
                position, force = self._cable(piece, position, force, share, shape)
                piece += 1
            else:
                rod = range(piece, self.head if piece == 0 else piece + 1)
                position, force = self._rod(rod, position, force, share, shape)
                piece = rod.stop
            shape.depths.append(-float(position[2]))
        return shape

    def _load(self, piece: int, share: Vector) -> Load:
        line, part = self.line, float(share[piece])
        return Load(
            part * float(line.buoyancy[piece]), part * float(line.volume[piece]),
            float(line.normal_drag[piece]), float(line.tangential_drag[piece]),
            bool(line.directional[piece]), self.gravity,
        )  # fmt: skip

    def _clamp(self, clamp: int) -> Load:
        line, drag = self.line, float(self.line.clamp_drag[clamp])
        buoyancy, volume = float(line.clamp_buoyancy[clamp]), float(line.clamp_volume[clamp])
        return Load(buoyancy, volume, drag, drag, False, self.gravity)

    def _rod(
        self, rod: range, position: Vector, force: Vector, share: Vector, shape: Shape
    ) -> tuple[Vector, Vector]:
        line = self.line
        length = float(line.length[rod].sum())
        loads: list[tuple[int, int, float, Load]] = []  # piece, clamp or -1, distance, load
        top = 0.0
        for piece in rod:
            own = (piece, -1, top + float(line.length[piece]) / 2, self._load(piece, share))
            clamped = [
                (piece, c, top + float(line.clamp_at[c]), self._clamp(c))
                for c in self.clamps[piece]
            ]
            loads += sorted([own, *clamped], key=lambda entry: entry[2])
            top += float(line.length[piece])
        axis = self._axis([(at, load) for _, _, at, load in loads], length, position, force)
        end = position
        for piece in rod:
            shape.top[piece], shape.force_top[piece] = end, force
            for owner, c, at, load in loads:
                if owner != piece:
                    continue
                point = position + at * axis
                pull = load.force(self.profile.at(-float(point[2])), axis)
                if c >= 0:
                    shape.clamp[c] = point
                    shape.clamp_above[c], shape.clamp_below[c] = force, force + pull
                force = force + pull
            end = end + float(line.length[piece]) * axis
            shape.bottom[piece], shape.force_bottom[piece] = end, force
        return end, force

    def _axis(
        self, loads: list[tuple[float, Load]], length: float, position: Vector, force: Vector
    ) -> Vector:
        """The unit vector down the rod that leaves no moment about its lower end."""

        def lever(axis: Vector, drag: float) -> Vector:
            total = force.copy()
            for at, load in loads:
                u, v, w, density = self.profile.at(-float(position[2] + at * axis[2]))
                arm = 1.0 - at / length if length else 0.5
                total += arm * load.force((drag * u, drag * v, drag * w, density), axis)
            return total

        # The drag is raised in steps, one if one will do: each axis starts the search for the next.
        for steps in (1, 4, 16, 64):
            axis: Vector | None = _against(lever(DOWN, 0.0))
            for drag in np.linspace(0.0, 1.0, steps + 1)[1:]:
                axis = _balance(lambda t, drag=drag: lever(t, drag), axis)  # type: ignore[misc]
                if axis is None:
                    break
            else:
                return axis
        raise NoContinuousSolution("a rigid piece finds no balance of moments")

    def _cable(
        self, piece: int, position: Vector, force: Vector, share: Vector, shape: Shape
    ) -> tuple[Vector, Vector]:
        line, length, load = self.line, float(self.line.length[piece]), self._load(piece, share)
        shape.top[piece], shape.force_top[piece] = position, force
        s = 0.0
        for c in self.clamps[piece]:
            at = float(line.clamp_at[c])
            position, force = self._run(piece, load, at - s, position, force, shape)
            pull = self._clamp(c).force(self.profile.at(-float(position[2])), DOWN)
            shape.clamp[c] = position
            shape.clamp_above[c], shape.clamp_below[c] = force, force + pull
            force, s = force + pull, at
        position, force = self._run(piece, load, length - s, position, force, shape)
        shape.bottom[piece], shape.force_bottom[piece] = position, force
        return position, force

    def _run(
        self, piece: int, load: Load, length: float, position: Vector, force: Vector, shape: Shape
    ) -> tuple[Vector, Vector]:
        """Along `length` unstretched metres of cable without a clamp."""
        if length <= 0.0:
            return position, force
        s, bare = 0.0, not force.any()
        if bare:
            s = FREE_END * length
            flow = self.profile.at(-float(position[2]))
            axis = _balance(lambda t: load.force(flow, t), _against(load.force(flow, DOWN)))
            if axis is None:
                raise NoContinuousSolution("a bare end of cable finds no direction")
            position, force = position + s * axis, s * load.force(flow, axis)
        compliance = float(self.line.compliance[piece])
        thinning = float(self.line.thinning[piece])
        band = self.profile.band(-float(position[2]), rising=force[2] < 0.0)

        evaluations = 0

        def slope(_: float, state: Vector) -> Vector:
            nonlocal evaluations
            evaluations += 1
            if evaluations > MOST_EVALUATIONS:
                raise Folded("a cable is too slack over too long a way to be followed")
            tension = sqrt(state[3] ** 2 + state[4] ** 2 + state[5] ** 2)
            stretched = 1.0 + tension * compliance
            axis = state[3:] / -tension
            pull = load.force(self.profile.flow(-state[2], band), axis, stretched**thinning)
            return np.concatenate((stretched * axis, pull))

        def leaves_upward(_: float, state: Vector) -> float:
            return float(-state[2] - max(self.profile.limits(band)[0], -1e9))

        def leaves_downward(_: float, state: Vector) -> float:
            return float(-state[2] - min(self.profile.limits(band)[1], 1e9))

        def is_level(_: float, state: Vector) -> float:
            return float(state[5])

        leaves_upward.terminal, leaves_upward.direction = True, -1  # type: ignore[attr-defined]
        leaves_downward.terminal, leaves_downward.direction = True, 1  # type: ignore[attr-defined]

        state = np.concatenate((position, force))
        scale = self.tolerance * np.repeat([self.depth, max(float(np.linalg.norm(force)), 1.0)], 3)
        while s < length:
            path = solve_ivp(
                slope, (s, length), state, method="DOP853", rtol=self.tolerance, atol=scale,
                events=(leaves_upward, leaves_downward, is_level),
            )  # fmt: skip
            if not path.success:
                raise NoContinuousSolution(f"a cable cannot be followed: {path.message}")
            s, state = float(path.t[-1]), path.y[:, -1]
            band += path.t_events[1].size - path.t_events[0].size
            shape.depths += [-z for z in path.y[2]] + [-extreme[2] for extreme in path.y_events[2]]
            tensions = np.linalg.norm(path.y[3:], axis=0)
            shape.slackest = min(shape.slackest, *tensions[-1 if bare else 0 :])
        return state[:3], state[3:]


def head(line: Line) -> int:
    """How many pieces from the free end on are one rod: up to the first float if all are rigid."""
    for piece, flexible in enumerate(line.flexible):
        if flexible:
            break
        if line.buoyancy[piece] > 0.0:
            return piece + 1
    return 1


def _against(force: Vector) -> Vector:
    """The unit vector against a force; plumb where there is none."""
    size = float(np.linalg.norm(force))
    return -force / size if size > 0.0 else DOWN


def _balance(lever: Callable[[Vector], Vector], guess: Vector) -> Vector | None:
    """The unit vector t = -lever(t)/|lever(t)| near `guess`; None where none is found."""
    for start in (guess, _against(lever(guess))):
        across = np.linalg.svd(start[None, :])[2][1:]

        def turned(by: Vector, start: Vector = start, across: Vector = across) -> Vector:
            axis = start + by @ across
            return axis / np.linalg.norm(axis)

        def moment(by: Vector, turned=turned, across=across) -> Vector:
            return across @ (turned(by) - _against(lever(turned(by))))

        found = turned(root(moment, np.zeros(2), tol=1e-14).x)
        if np.abs(found - _against(lever(found))).max() < 1e-10:
            return found
    return None
