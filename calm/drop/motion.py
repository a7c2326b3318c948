"""A step of a chain without inertia: where its nodes are a moment later.

The forces on every node cancel at the end of the step, with drag by the velocity V = (X - Xₙ)/Δt
over it (implicit Euler), and every bar is as long as its tension makes it. Unknown are the nodes
and the tensions, together: so a bar may be as stiff as it is, or inextensible. Newton's method; a
node and the bar below it are a block of the matrix, which is block-tridiagonal.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from calm.drop.chain import BarChain
from calm.drop.loads import SLOWEST, Loads, WaterColumn, loads_on
from calm.physics.line import Floats
from calm.physics.reynolds import Smooth, drag_variation
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve.block_tridiagonal import solve_blocks

MOST_ROUNDS = 16
"""Of Newton's method; a step that takes more is too long."""
GENTLE = 10.0
"""Speed below which drag goes with the speed, in the first round of a step from rest [m/s]."""
CLOSE = 1e-5
"""Last change of a place, as a share of the line, and of a tension, as one of all the weights; what
is left is of the order of its square."""
SINKING = 1e-4
"""Depth into the seabed at which it bears what lies there, as a share of the water's depth."""

_UNIT = np.eye(3)


class NoStep(ArithmeticError):
    """Newton's method does not find a step; it may find a shorter one."""


def _overturned(before: Floats, after: Floats) -> bool:
    """Return whether a bar has turned by more than 120°: it may then be pushed, not pulled."""
    chords = before[1:] - before[:-1], after[1:] - after[:-1]
    along = np.einsum("ij,ij->i", *chords)
    if along.min() >= 0.0:  # as nearly always
        return False
    sizes = np.prod([np.linalg.norm(chord, axis=1) for chord in chords], axis=0)
    return bool((along < -0.5 * sizes).any())


@dataclass(frozen=True)
class FallingAnchor:
    """An anchor below a line that falls.

    Attributes
    ----------
    weight : in the water at the seabed [N]
    drag : K of its drag K|V|V in reference water [N/(m/s)²]; 0 where none is known
    """

    weight: float
    drag: float = 0.0


@dataclass(frozen=True)
class ChainState:
    """Hold where a chain is.

    Attributes
    ----------
    time : since it was let go [s]
    node : (n+1, 3) east, north, up [m]
    tension : (n,) in the bars at their middle [N]
    velocity : (n+1, 3) over the step that led here [m/s]
    """

    time: float
    node: Floats
    tension: Floats
    velocity: Floats


@dataclass(frozen=True)
class Mover:
    """A chain in its sea.

    Attributes
    ----------
    held : whether its lower end stays where it is; else it falls with the anchor
    bedded : whether the seabed bears what comes to lie on it
    tether : (2,) horizontal place to which its free end is brought [m]; None where that is free
    """

    chain: BarChain
    sea: WaterColumn
    anchor: FallingAnchor
    held: bool = False
    bedded: bool = True
    tether: Floats | None = None

    def stepped(self, state: ChainState, step: float, gently: bool = False) -> ChainState:
        """The state a time later [s].

        A line at rest begins to move by rounds in which drag goes with the speed: they find the way
        to where it goes with the square. So does one that is to be moved `gently`, as if it were at
        rest. NoStep: where Newton's method does not find it.
        """
        variation = self.variation(state)
        gently = gently or not state.velocity.any()
        node = state.node + (0.0 if gently else step) * state.velocity
        if self.held:
            node[-1] = state.node[-1]
        if self.tether is not None:
            node[0, :2] = self.tether
        tension = state.tension.copy()
        reach = float(self.chain.length.sum())
        slowest = GENTLE if gently else SLOWEST
        nearer = np.inf
        for _ in range(MOST_ROUNDS):
            moved = self._change(state.node, node, tension, variation, step, slowest)
            farthest = float(np.abs(moved[:, :3]).max())
            if not np.isfinite(farthest):
                break
            share = min(1.0, 0.2 * reach / max(farthest, 1e-300))
            node -= share * moved[:, :3]
            tension -= share * moved[:-1, 3]
            close = farthest < CLOSE * reach
            if close and np.abs(moved[:-1, 3]).max() < CLOSE * self.scale and slowest == SLOWEST:
                if _overturned(state.node, node):
                    break
                return ChainState(state.time + step, node, tension, (node - state.node) / step)
            if slowest == SLOWEST and farthest > max(nearer, 0.1 * reach):
                break
            nearer, slowest = farthest, max(0.2 * slowest, SLOWEST)
        raise NoStep("the positions of the nodes could not be found")

    @cached_property
    def scale(self) -> float:
        """Return what forces are measured by [N]."""
        return self.anchor.weight + float(np.abs(self.chain.elements.buoyancy).sum())

    def loads(
        self,
        node: Floats,
        velocity: Floats,
        strain: Floats,
        variation: Floats,
        slowest: float = SLOWEST,
    ) -> tuple[Loads, Floats, Floats]:
        """The forces on the loads, the axes (3, n) of the bars and their lengths (n,) [m].

        Of nodes and velocities (3, n+1), and strains of bars (n,).
        """
        on = self.chain.elements
        bar, (above, below) = on.bar, on.share
        chord = node[:, 1:] - node[:, :-1]
        length = np.sqrt((chord * chord).sum(axis=0))
        axis = chord / length
        height = above * node[2].take(bar) + below * node[2].take(bar + 1)
        moving = above * velocity.take(bar, axis=1) + below * velocity.take(bar + 1, axis=1)
        loads = loads_on(
            self.chain, self.sea, height, moving, axis.take(bar, axis=1), strain[bar], variation,
            slowest,
        )  # fmt: skip
        return loads, axis, length

    def strain(self, tension: Floats) -> tuple[Floats, Floats]:
        """(n,) of the bars and what it grows by [1/N]; a rope that is pushed is as one at rest."""
        strain, growth = self.chain.compliance * tension, self.chain.compliance.copy()
        for bars, knots in self.chain.elongation:
            pull = np.maximum(tension[bars], 0.0)
            origin, a, b, c, d = knots[np.searchsorted(knots[:, 0], pull, side="right") - 1].T
            x = pull - origin
            strain[bars] = a + x * (b + x * (c + x * d))
            growth[bars] = np.where(tension[bars] > 0.0, b + x * (2.0 * c + 3.0 * x * d), 0.0)
        return strain, growth

    def anchor_force(
        self, node: Floats, velocity: Floats, slowest: float = SLOWEST
    ) -> tuple[Floats, Floats]:
        """Weight and drag of the falling anchor (3,) [N], and its change with velocity (3, 3)."""
        current, _, density = self.sea.at(-node[2, -1:])
        flow = current[:, 0] - velocity[:, -1]
        k = self.anchor.drag * float(density[0]) / REFERENCE_DENSITY
        speed = float(np.sqrt(flow @ flow + slowest**2))
        force = k * speed * flow - [0.0, 0.0, self.anchor.weight]
        return force, -k * (speed * _UNIT + flow[:, np.newaxis] * flow / speed)

    def variation(self, state: ChainState) -> Floats:
        """(k,) by how much a smooth body's drag differs from the constant one, as it moved last."""
        on = self.chain.elements
        variation = np.ones(len(on.bar))
        for element, curve in enumerate(on.curve):
            if curve is not None:
                bar, place = on.bar[element], on.place[element]
                node, velocity = state.node[bar : bar + 2], state.velocity[bar : bar + 2]
                lever = np.array([1.0 - place, place])
                depth = -(lever @ node)[2:]
                current, _, _ = self.sea.at(depth)
                flow = current[:, 0] - lever @ velocity
                if on.directional[element]:
                    axis = (node[1] - node[0]) / np.linalg.norm(node[1] - node[0])
                    flow = flow - (flow @ axis) * axis
                viscosity = float(self.sea.water.viscosity_at(depth)[0])
                smooth = Smooth(curve.diameter / viscosity, curve.lengthening)
                variation[element] = drag_variation(smooth, float(np.linalg.norm(flow)))
        return variation

    def _change(
        self,
        before: Floats,
        node: Floats,
        tension: Floats,
        variation: Floats,
        step: float,
        slowest: float,
    ) -> Floats:
        """Return (n+1, 4) what nodes and tensions are too much by; the last tension is none's."""
        chain, on = self.chain, self.chain.elements
        node = np.ascontiguousarray(node.T)
        velocity = (node - before.T) / step
        strain, growth = self.strain(tension)
        loads, axis, length = self.loads(node, velocity, strain, variation, slowest)
        bars = len(length)
        # of nodes and bars in turn, as the unknowns
        residual = np.zeros((4, bars + 1))
        pull = tension * axis
        upper, lower = on.summed(on.share[:, np.newaxis] * loads.force)
        residual[:3, :-1] = upper + pull
        residual[:3, 1:] += lower - pull
        residual[3, :-1] = length - chain.length * (1.0 + strain)
        stiff = tension / length * (_UNIT[:, :, np.newaxis] - axis[:, np.newaxis] * axis)
        own = loads.by_flow / -step
        own[:, 2] += loads.by_height
        leaning = loads.by_axis / length[on.bar]
        # by the place of the upper and of the lower end, each shared between the two
        by_end = on.share[:, np.newaxis, np.newaxis] * own
        by_end[0] -= leaning
        by_end[1] += leaning
        blocks = on.summed(on.share[:, np.newaxis, np.newaxis, np.newaxis] * by_end)
        diagonal = np.zeros((3, 3, bars + 1))
        diagonal[..., :-1] = blocks[0, 0] - stiff
        diagonal[..., 1:] += blocks[1, 1] - stiff
        if self.bedded:
            sunk = np.maximum(-self.sea.water.depth - node[2, :-1], 0.0) / self._sinking
            residual[2, :-1] += self._bearing * sunk**2
            diagonal[2, 2, :-1] -= 2.0 * self._bearing * sunk / self._sinking
        if not self.held:
            force, by_velocity = self.anchor_force(node, velocity, slowest)
            residual[:3, -1] += force
            diagonal[..., -1] += by_velocity / step
        beside = blocks[0, 1] + stiff, blocks[1, 0] + stiff
        return _solved(residual, diagonal, beside, axis, -chain.length * growth, self._fixed)

    @cached_property
    def _sinking(self) -> float:
        return SINKING * self.sea.water.depth

    @cached_property
    def _bearing(self) -> Floats:
        """(n,) of the seabed on a node that has sunk in by `SINKING` [N]."""
        on = self.chain.elements
        weight = on.summed(np.abs(on.buoyancy))
        weight[1:] += weight[:-1]
        bearing: Floats = np.maximum(0.5 * weight, 1e-4 * self.scale)
        return bearing

    @cached_property
    def _fixed(self) -> tuple[int, ...]:
        """The rows of the unknowns that are known: where the ends of the chain are held."""
        last = 4 * len(self.chain.length)
        upper = () if self.tether is None else (0, 1)
        return (*upper, last, last + 1, last + 2) if self.held else upper


def _solved(
    residual: Floats,
    diagonal: Floats,
    beside: tuple[Floats, Floats],
    axis: Floats,
    slack: Floats,
    fixed: tuple[int, ...],
) -> Floats:
    """(n+1, 4) what the nodes and tensions are too much by; 0 at the very last.

    Parameters
    ----------
    residual : (4, n+1) of the forces on the nodes and of the lengths of the bars
    diagonal : (3, 3, n+1) change of the force on a node with its own place
    beside : (3, 3, n) each; that on the node above with the place of the one below, and the
        other way round
    axis : (3, n) of the bars, downward
    slack : (n,) by how much a bar is longer with its tension, negative
    fixed : rows of the unknowns that are known
    """
    nodes, along = residual.shape[1], axis.T
    own, upper = np.zeros((nodes, 4, 4)), np.zeros((nodes - 1, 4, 4))
    lower, equations = np.zeros((nodes - 1, 4, 4)), residual.T.copy()
    own[:, :3, :3] = diagonal.transpose(2, 0, 1)
    own[:-1, :3, 3], own[:-1, 3, :3], own[:-1, 3, 3] = along, -along, slack
    upper[:, :3, :3], lower[:, :3, :3] = (each.transpose(2, 0, 1) for each in beside)
    upper[:, 3, :3], lower[:, :3, 3] = along, -along
    for node, row in (divmod(each, 4) for each in (*fixed, 4 * nodes - 1)):
        own[node, row], equations[node, row] = 0.0, 0.0
        own[node, row, row] = 1.0
        if node:
            lower[node - 1, row] = 0.0
        if node < nodes - 1:
            upper[node, row] = 0.0
    found: Floats = solve_blocks(own, upper, lower, equations[..., np.newaxis])[..., 0]
    return found
