"""Linear response of a line to waves, frequency by frequency.

The linearised drag dissipates the same energy as the quadratic drag.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from math import erf, exp, pi, radians, sqrt
from typing import Any, NamedTuple

import numpy as np

from calm.physics.compiled import outcome
from calm.physics.line import Floats
from calm.records.sea_states import SeaState
from calm.solve.block_tridiagonal import solve_blocks
from calm.solve.chain_sweep import MassChain, sweep_chain
from calm.solve.two_speeds import may_compile
from calm.waves.buoy import SIDEWAYS_ADDED, Buoy
from calm.waves.lumped_line import Complexes, LumpedLine

SETTLED = 5e-3
"""Relative change of the flow past the nodes at which the linearised drag has converged. The
relative change of tension is twenty times smaller.
"""

STILL = 1e-12
"""Smallest speed of flow past a node, to avoid division by zero [m/s]."""

MOST_ITERATIONS = 40

RELAXATION = 0.8
"""Under-relaxation of the iteration: the fraction of a change in flow that is applied."""

_POINTS, _WEIGHTS = np.polynomial.hermite_e.hermegauss(7)
_WEIGHTS = _WEIGHTS / _WEIGHTS.sum()


@dataclass(frozen=True)
class WaveResponse:
    """Transfer functions of a line per metre of wave elevation, at f frequencies of a sea state.

    Attributes
    ----------
    omega : (f,) angular frequencies [rad/s]
    weight : (f,) variance of the elevation that each frequency represents [m²]
    motion : (f, n, 3) displacement of the nodes [m/m]
    pull : (f, n-1) change of the tension in the springs [N/m]
    pitch : (f,) pitch of the float [rad/m], positive if the top moves with the waves
    """

    omega: Floats
    weight: Floats
    motion: Complexes
    pull: Complexes
    pitch: Complexes

    def moments(self, transfer: Complexes) -> tuple[Floats, Floats]:
        """Return standard deviations and zero-crossing periods [s] of responses to the sea state.

        `transfer` has the transfer functions (f, …) of the responses.
        """
        shape = (-1,) + (1,) * (transfer.ndim - 1)
        spectral = np.abs(transfer) ** 2 * self.weight.reshape(shape)
        zeroth = spectral.sum(0)
        second = (spectral * self.omega.reshape(shape) ** 2).sum(0)
        with np.errstate(divide="ignore", invalid="ignore"):
            period = 2.0 * pi * np.sqrt(zeroth / second)
        return np.sqrt(zeroth), period

    def below(self, limit: float) -> WaveResponse:
        """Return the response to the waves with frequencies below `limit` [rad/s]."""
        middle = 0.5 * (self.omega[1:] + self.omega[:-1])
        edges = np.concatenate([self.omega[:1], middle, self.omega[-1:]])
        share = (limit - edges[:-1]) / np.diff(edges)
        return replace(self, weight=self.weight * np.clip(share, 0.0, 1.0))

    def joined(self, other: WaveResponse) -> WaveResponse:
        """Combine this response and a response at other frequencies into one response."""
        names = [each.name for each in fields(self)]
        both = ((getattr(self, name), getattr(other, name)) for name in names)
        return WaveResponse(*(np.concatenate(pair) for pair in both))


@dataclass(frozen=True)
class Waves:
    """Long-crested waves in water of finite depth.

    Attributes
    ----------
    omega : (f,) angular frequencies [rad/s]
    toward : direction in which the waves travel [degrees], clockwise from north
    depth, density, gravity : water depth [m], density [kg/m³], and acceleration of gravity [m/s²]
    """

    omega: Floats
    toward: float
    depth: float
    density: float
    gravity: float

    @property
    def number(self) -> Floats:
        """Wave numbers [1/m]."""
        return wave_numbers(self.omega, self.depth, self.gravity)

    @property
    def ahead(self) -> Floats:
        """Unit vector (3,) in the direction of travel."""
        return np.array([np.sin(radians(self.toward)), np.cos(radians(self.toward)), 0.0])

    def velocity(self, position: Floats) -> Complexes:
        """Return the velocity of the water (f, n, 3) per metre of wave elevation [1/s].

        `position` is (n, 3) [m]. The elevation is the real part of e^(i(ωt - ks)), where s is the
        distance in the direction of travel.
        """
        k, omega = self.number[:, None], self.omega[:, None]
        ahead, height = self.ahead, np.minimum(position[:, 2], 0.0)[None, :]
        deep = k * self.depth
        # cosh k(z+h) / sinh kh and sinh k(z+h) / sinh kh without overflow
        whole = 1.0 - np.exp(-2.0 * np.minimum(deep, 300.0))
        rest = np.exp(-2.0 * np.minimum(k * (height + self.depth), 300.0))
        decay = np.exp(np.maximum(k * height, -700.0)) / whole
        phase = np.exp(-1j * k * (position @ ahead)[None, :])
        along = omega * decay * (1.0 + rest) * phase
        up = 1j * omega * decay * (1.0 - rest) * phase
        return np.asarray(along[:, :, None] * ahead + up[:, :, None] * np.array([0.0, 0.0, 1.0]))


class _Afloat(NamedTuple):
    """Dynamic stiffness of a float and exciting forces on the float, without drag.

    The degrees of freedom are the three translations of the bail, and pitch.

    Attributes
    ----------
    held : (f, 4, 4) stiffness
    pushed : (f, 4) exciting force per metre of wave elevation
    ways : (p, 3, 4) motion of the p points where drag acts, per unit of each degree of freedom
    water : (f, p, 3) velocity of the water at these points
    turning : coefficient of the drag on the bottom against rotation
    slope : (f,) slope of the waves at the bottom, for this drag
    """

    held: Complexes
    pushed: Complexes
    ways: Floats
    water: Complexes
    turning: float
    slope: Complexes

    @classmethod
    def of(cls, place: Floats, buoy: Buoy, waves: Waves) -> _Afloat:
        omega, number, ahead, hull = waves.omega, waves.number, waves.ahead, buoy.profile
        medium = (omega, number, waves.density, waves.gravity)
        if hull is None:
            deep, heights, both, turning = 0.0, place[2:], 0.0, 0.0
            moved = (1.0 + SIDEWAYS_ADDED) * buoy.displaced
            surge, turn = -(omega**2) * (moved + buoy.mass - buoy.displaced), 1.0
            middle = waves.velocity(np.array([[0.0, 0.0, -0.5 * buoy.draft]]))[:, 0]
            pushing = 1j * omega * moved * (middle @ ahead)
        else:
            (surge, both, turn), (pushing, turning) = buoy.pitch(hull, *medium)
            # two points represent a drag that is uniform over the draft
            deep, heights = -buoy.bail, buoy.draft * (-0.5 + np.array([-1.0, 1.0]) / sqrt(12.0))
        held = np.zeros((len(omega), 4, 4), complex)
        pushed = pushing[:, None] * np.array([*ahead, deep], complex)
        held[:, 2, 2], pushed[:, 2] = buoy.heave(*medium)
        held[:, 0, 0] = held[:, 1, 1] = surge
        if hull is not None:
            held[:, :3, 3] = held[:, 3, :3] = (both + deep * surge)[:, None] * ahead
        held[:, 3, 3] = turn + 2.0 * deep * both + deep**2 * surge
        pushed[:, 3] += turning
        at = np.column_stack([np.tile(place[:2], (len(heights), 1)), heights])
        arms = np.zeros(1) if hull is None else heights + deep
        ways = np.stack([np.column_stack([np.eye(3), arm * ahead]) for arm in arms])
        elevation = np.exp(-1j * number * float(place @ ahead))
        # rotational drag of the bottom: its heave drag, weighted by the third power of the distance
        # from the axis
        drag = 0.0 if hull is None else buoy.heave_drag * 8.0 * buoy.radius**3 / (15.0 * pi)
        slope = 1j * number * np.exp(-number * buoy.draft) * elevation
        return cls(held, pushed * elevation[:, None], ways, waves.velocity(at), drag, slope)

    def dragged(self, omega: Floats, drag: Floats, turning: float) -> tuple[Complexes, Complexes]:
        """Return stiffness (f, 4, 4) and exciting force (f, 4), with linear drag.

        `drag` (3, 3) is the drag on translations, and `turning` the drag on rotation.
        """
        each = drag / len(self.ways)
        whole = np.einsum("pca,cd,pdb->ab", self.ways, each, self.ways)
        held = self.held + 1j * omega[:, None, None] * whole
        held[:, 3, 3] += 1j * omega * turning
        pushed = self.pushed + np.einsum("pca,cd,fpd->fa", self.ways, each, self.water)
        pushed[:, 3] += 1j * omega * turning * self.slope
        return held, pushed


def respond(
    line: LumpedLine,
    buoy: Buoy | None,
    waves: Waves,
    sea: SeaState,
    *,
    drag_factor: float = 1.0,
    first: Floats | None = None,
    once: bool = False,
) -> tuple[WaveResponse, Floats]:
    """Compute the linear response of a line to a sea state.

    Drag is replaced by a linear drag with the coefficient E[F v'] / E[v'²] for a Gaussian flow v'
    about the mean current. The linear drag dissipates the same energy on average.

    Parameters
    ----------
    buoy : float at the surface; None for a line below the surface
    drag_factor : factor on the linear drag, for a sensitivity test
    first : initial estimate of the flow past the nodes
    once : whether to use the flow `first` without iteration

    Returns
    -------
    The response, and the flow past the nodes (n + 1, 3): standard deviations along the axes of each
    node [m/s], and a last row for the pitch of the float.
    """
    omega = waves.omega
    steps = np.diff(omega, prepend=omega[0], append=omega[-1])
    weight = sea.density(omega) * 0.5 * (steps[:-1] + steps[1:])
    water = waves.velocity(line.position)
    forced = _inertia_force(line, waves, water)
    still = np.sqrt((np.abs(water) ** 2 * weight[:, None, None]).sum(0)) + STILL
    flow = np.vstack([still, still[:1]]) if first is None else first
    afloat = None if buoy is None else _Afloat.of(line.position[0], buoy, waves)
    axes, rate = _axes(line), 1j * omega[:, None, None]
    pitch, held = np.zeros(len(omega), complex), None
    undamped = _undamped(line)
    for _ in range(MOST_ITERATIONS):
        damping = drag_factor * _linearised(line, buoy, flow[:-1])
        if afloat is not None:
            turning = drag_factor * afloat.turning * _slope(0.0, flow[-1, 0])
            whole, pushed = afloat.dragged(omega, damping[0], turning)
            damping[0] = 0.0
            lever = whole[:, :3, 3] / whole[:, 3, 3, None]
            bail = whole[:, :3, :3] - lever[:, :, None] * whole[:, 3, None, :3]
            held = bail, pushed[:, :3] - lever * pushed[:, 3, None]
        motion = _solved(undamped, held, omega, water, forced, damping)
        found = np.zeros_like(flow)
        found[:-1] = _deviations(axes, water - rate * motion, weight)
        if afloat is not None:
            rest = pushed[:, 3] - (whole[:, 3, :3] * motion[:, 0]).sum(1)
            pitch = rest / whole[:, 3, 3]
            moved = np.column_stack([motion[:, 0], pitch])
            past = afloat.water - rate * np.einsum("pca,fa->fpc", afloat.ways, moved)
            own = _deviations(np.repeat(axes[:1], len(afloat.ways), 0), past, weight)
            found[0] = np.sqrt((own**2).mean(0))
            turned = np.abs(omega * (afloat.slope - pitch)) ** 2 * weight
            found[-1] = sqrt(float(turned.sum())) + STILL
        change = np.abs(found - flow).max() / max(float(found.max()), 1e-12)
        if once or change < SETTLED:
            break
        flow = flow + RELAXATION * (found - flow)
    pull = _pull(line, motion)
    return WaveResponse(omega, weight, motion, pull, pitch), flow


def _axes(line: LumpedLine) -> Floats:
    """Return (n, 3, 3) unit vectors at the nodes.

    The vectors lie along the line, along the mean normal flow, and normal to both.
    """
    t = line.tangent
    across = line.current - (line.current * t).sum(1, keepdims=True) * t
    size = np.linalg.norm(across, axis=1, keepdims=True)
    other = np.where(np.abs(t[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
    other = other - (other * t).sum(1, keepdims=True) * t
    other /= np.linalg.norm(other, axis=1, keepdims=True)
    first = np.where(size > 1e-9, across / np.maximum(size, 1e-9), other)
    return np.stack([t, first, np.cross(t, first)], axis=1)


def _deviations(axes: Floats, relative: Complexes, weight: Floats) -> Floats:
    """Return (n, 3) standard deviations of the flow past the nodes, along their axes [m/s]."""
    own = _times(axes, relative)
    return np.asarray(np.sqrt((np.abs(own) ** 2 * weight[:, None, None]).sum(0)) + STILL)


def _linearised(line: LumpedLine, buoy: Buoy | None, deviation: Floats) -> Floats:
    """Return the damping (n, 3, 3) of the nodes, from standard deviations of the flow [N/(m/s)]."""
    axes = _axes(line)
    mean = np.einsum("nac,nc->na", axes, line.current)
    along = np.array([_slope(u, s) for u, s in zip(mean[:, 0], deviation[:, 0], strict=True)])
    x = mean[:, 1, None, None] + deviation[:, 1, None, None] * _POINTS[None, :, None]
    y = mean[:, 2, None, None] + deviation[:, 2, None, None] * _POINTS[None, None, :]
    weights = _WEIGHTS[:, None] * _WEIGHTS[None, :]
    size = np.hypot(x, y) + 1e-12
    first = ((size + x * x / size) * weights).sum((1, 2))
    second = ((size + y * y / size) * weights).sum((1, 2))
    local = np.zeros((len(line.mass), 3))
    local[:, 0] = line.along_drag * along
    local[:, 1] = line.across_drag * first
    local[:, 2] = line.across_drag * second
    any_drag = line.any_drag.copy()
    if buoy is not None:
        any_drag[0] += buoy.drag
    round_ones = np.flatnonzero(any_drag > 0.0)
    if len(round_ones):
        u, s = mean[round_ones], deviation[round_ones]
        grid = np.stack(np.meshgrid(_POINTS, _POINTS, _POINTS, indexing="ij"), -1).reshape(-1, 3)
        share = np.einsum("a,b,c->abc", _WEIGHTS, _WEIGHTS, _WEIGHTS).reshape(-1)
        flow = u[:, None, :] + s[:, None, :] * grid[None]
        size3 = np.linalg.norm(flow, axis=2, keepdims=True) + 1e-12
        slopes = ((size3 + flow**2 / size3) * share[None, :, None]).sum(1)
        local[round_ones] += any_drag[round_ones, None] * slopes
    damping: Floats = np.einsum("nac,na,nad->ncd", axes, local, axes)
    if buoy is not None:
        upward = float(np.linalg.norm(axes[0, :, 2] * deviation[0]))
        damping[0, 2, 2] += buoy.heave_drag * _slope(0.0, upward)
    return damping


def _slope(mean: float, deviation: float) -> float:
    """Return E[d(|v|v)/dv] of a Gaussian flow: 2 (σ √(2/π) e^(-U²/2σ²) + U erf(U/(√2 σ)))."""
    ratio = mean / deviation
    return 2.0 * (
        deviation * sqrt(2.0 / pi) * exp(-0.5 * min(ratio**2, 1400.0))
        + mean * erf(ratio / sqrt(2.0))
    )


def _inertia_force(line: LumpedLine, waves: Waves, water: Complexes) -> Complexes:
    """Return the inertia forces (f, n, 3) on the nodes, per metre of wave elevation [N/m]."""
    across = line.water_across + line.added_across
    along = line.water_along + line.added_along
    t = line.tangent
    axial = (water * t).sum(2, keepdims=True) * t
    accelerated = across[:, None] * (water - axial) + along[:, None] * axial
    return np.asarray(1j * waves.omega[:, None, None] * accelerated)


FREQUENCIES_AT_ONCE = 16
"""Number of frequencies solved at once, so that their matrices fit into the processor's cache."""


def _undamped(line: LumpedLine) -> tuple[Floats, Floats]:
    """Return the springs (n-1, 5) of a line, and the masses (n-1, 3, 3) of its nodes.

    The springs have the form of `MassChain`. Each mass is that of the node above the spring.
    """
    eye, t, sideways = np.eye(3), line.tangent, line.tension / line.span
    outer = t[:, :, None] * t[:, None, :]
    mass = line.mass[:, None, None] * eye + line.added_across[:, None, None] * (eye - outer)
    mass = mass + line.added_along[:, None, None] * outer
    return np.column_stack([sideways, line.stiffness - sideways, line.spring]), mass[:-1]


def _solved(
    undamped: tuple[Floats, Floats],
    top: tuple[Complexes, Complexes] | None,
    omega: Floats,
    water: Complexes,
    forced: Complexes,
    damping: Floats,
) -> Complexes:
    """Solve for the motion (f, n, 3) of the nodes.

    `top` is the stiffness (f, 3, 3) and the exciting force (f, 3) of the float at the first node.
    """
    push, stiffness = forced + _times(damping, water), np.zeros((len(omega), 3, 3), complex)
    if top is not None:
        stiffness += top[0]
        push[:, 0] += top[1]
    motion = np.zeros(push.shape, complex)
    by = _by_sweep if may_compile() else _by_blocks
    motion[:, :-1] = by(undamped, stiffness, omega, damping[:-1], push[:, :-1])
    return motion


def _by_sweep(
    undamped: tuple[Floats, Floats],
    top: Complexes,
    omega: Floats,
    damping: Floats,
    push: Complexes,
) -> Complexes:
    springs: Any = undamped[0]
    rates: Any = np.ascontiguousarray(omega)
    work: Any = np.empty((len(springs), 26))
    motion = push.copy()
    chain = MassChain(
        springs, _triangles(undamped[1]), _triangles(damping), rates,
        _triangles(top).view(float), motion.view(float), work,
    )  # fmt: skip
    outcome(sweep_chain, True, chain)
    return motion


def _triangles(matrices: Any) -> Any:
    """Return the upper triangles (…, 6) of matrices (…, 3, 3), row by row."""
    return np.ascontiguousarray(matrices[..., (0, 0, 0, 1, 1, 2), (0, 1, 2, 1, 2, 2)])


def _by_blocks(
    undamped: tuple[Floats, Floats],
    top: Complexes,
    omega: Floats,
    damping: Floats,
    push: Complexes,
) -> Complexes:
    """Return the motion (f, n, 3) of the nodes, computed with NumPy alone.

    The computation takes eight times as long as `_by_sweep`.
    """
    (across, excess, *axis), masses = undamped[0].T, undamped[1]
    axial = np.einsum("an,bn->nab", axis, axis)
    springs = across[:, None, None] * np.eye(3) + excess[:, None, None] * axial
    held = springs.copy()
    held[1:] += springs[:-1]
    beside, motion = -springs[:-1].astype(complex), np.empty_like(push)
    for first in range(0, len(omega), FREQUENCIES_AT_ONCE):
        part = slice(first, first + FREQUENCIES_AT_ONCE)
        rate = omega[part, None, None, None]
        diagonal = held - rate**2 * masses + 1j * rate * damping
        diagonal[:, 0] += top[part]
        others = np.broadcast_to(beside, (len(diagonal), *beside.shape))
        motion[part] = solve_blocks(diagonal, others, others, push[part, ..., None])[..., 0]
    return motion


def _times(matrices: Floats, vectors: Complexes) -> Complexes:
    """Multiply real matrices (n, 3, 3) by vectors (f, n, 3)."""
    return np.asarray(sum(matrices[:, :, i] * vectors[:, :, i, None] for i in range(3)))


def _pull(line: LumpedLine, motion: Complexes) -> Complexes:
    """Return the change in tension (f, n-1) of the springs from equilibrium [N/m]."""
    stretched = ((motion[:, 1:] - motion[:, :-1]) * line.spring).sum(2)
    return np.asarray(line.stiffness * stretched)


def wave_numbers(omega: Floats, depth: float, gravity: float) -> Floats:
    """Return the wave numbers k of linear waves [1/m], from ω² = g k tanh(k h).

    Parameters
    ----------
    omega : (f,) angular frequencies [rad/s]
    depth : water depth h [m]
    gravity : acceleration of gravity [m/s²]
    """
    deep = omega**2 / gravity
    k = deep / np.sqrt(np.tanh(np.minimum(deep * depth, 50.0)))
    for _ in range(20):
        tanh = np.tanh(np.minimum(k * depth, 50.0))
        slope = gravity * (tanh + k * depth * (1.0 - tanh**2))
        k = k - (gravity * k * tanh - omega**2) / slope
    return k
