"""One time step of a chain without inertia: positions of its nodes at the end of the step.

The method is implicit Euler. The forces on every node cancel at the end of the step. Drag is
computed for the mean velocity over the step, (X - Xₙ)/Δt, from the positions Xₙ at the start and X
at the end of the step. Newton's method finds positions and tensions together, so bars may be stiff
or inextensible.
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

MOST_ROUNDS = 12
"""Largest number of Newton iterations; a time step that needs more is too long."""
LINEAR_DRAG_SPEED = 10.0
"""Speed below which drag is linear in speed, in the first iteration of a time step from
rest [m/s].
"""
CHANGE = 1e-5
"""Newton's method stops after changes smaller than this: for a position, as a fraction of the line
length; for a tension, as a fraction of the sum of all weights. The remaining error is of the order
of the square of the last change.
"""
BEARING_DEPTH = 1e-4
"""Penetration of the seabed at which the seabed carries a node, as a fraction of the water
depth.
"""

_UNIT = np.eye(3)


class NoStep(ArithmeticError):
    """Newton's method does not converge for this time step; a shorter step may converge."""


def _overturned(before: Floats, after: Floats) -> bool:
    """Return whether any bar has rotated by more than 120°, so that it may be under compression."""
    chords = before[1:] - before[:-1], after[1:] - after[:-1]
    along = np.einsum("ij,ij->i", *chords)
    if along.min() >= 0.0:  # almost always
        return False
    sizes = np.prod([np.linalg.norm(chord, axis=1) for chord in chords], axis=0)
    return bool((along < -0.5 * sizes).any())


@dataclass(frozen=True)
class FallingAnchor:
    """Properties of an anchor that falls at the end of a line.

    `weight` is the weight in water at the seabed [N]. `drag` is K of the drag K|V|V in reference
    water [N/(m/s)²], or 0 if unknown.
    """

    weight: float
    drag: float = 0.0


@dataclass(frozen=True)
class ChainState:
    """State of a chain at one time.

    Attributes
    ----------
    time : time since the release [s]
    node, velocity : (n+1, 3) positions of the nodes east, north and up [m], and their mean
        velocities in the last time step [m/s]
    tension : (n,) tension at the midpoint of the bars [N]
    acceleration, tightening : (n+1, 3), (n,) rates of change of velocity and tension; 0 if unknown
    lasted : length of the last time step [s]; 0 if there was none
    """

    time: float
    node: Floats
    tension: Floats
    velocity: Floats
    acceleration: Floats | float = 0.0
    tightening: Floats | float = 0.0
    lasted: float = 0.0


@dataclass(frozen=True)
class Mover:
    """Time-stepping solver for the motion of a chain in the sea.

    Attributes
    ----------
    sea : water around the chain
    held : whether the lower end of the chain is fixed instead of falling with the anchor
    bedded : whether the seabed supports the line
    tether : (2,) horizontal position at which the free end is held [m]; None if it can move
    """

    chain: BarChain
    sea: WaterColumn
    anchor: FallingAnchor
    held: bool = False
    bedded: bool = True
    tether: Floats | None = None

    def stepped(self, state: ChainState, step: float, gently: bool = False) -> ChainState:
        """Return the state of the chain at the end of a time step of length `step` [s].

        If `gently` is true, the first iterations use drag proportional to the speed, which
        converges more easily. A line at rest always starts like that.

        Raises
        ------
        NoStep
            Newton's method does not converge.
        """
        variation = self.variation(state)
        gently = gently or not state.velocity.any()
        node = state.node + (0.0 if gently else step) * state.velocity
        steady = 0.0 if gently or step > 1.1 * state.lasted else step
        node += steady**2 * state.acceleration
        if self.held:
            node[-1] = state.node[-1]
        if self.tether is not None:
            node[0, :2] = self.tether
        tension = state.tension + steady * state.tightening
        reach = float(self.chain.length.sum())
        slowest = LINEAR_DRAG_SPEED if gently else SLOWEST
        nearer = np.inf
        for _ in range(MOST_ROUNDS):
            moved = self._change(state.node, node, tension, variation, step, slowest)
            farthest = float(np.abs(moved[:, :3]).max())
            if not np.isfinite(farthest):
                break
            share = min(1.0, 0.2 * reach / max(farthest, 1e-300))
            node -= share * moved[:, :3]
            tension -= share * moved[:-1, 3]
            close = farthest < CHANGE * reach
            if close and np.abs(moved[:-1, 3]).max() < CHANGE * self.scale and slowest == SLOWEST:
                if _overturned(state.node, node):
                    break
                velocity = (node - state.node) / step
                acceleration = (velocity - state.velocity) / step
                tightening = (tension - state.tension) / step
                return ChainState(
                    state.time + step, node, tension, velocity, acceleration, tightening, step
                )
            if slowest == SLOWEST and farthest > max(nearer, 0.1 * reach):
                break
            nearer, slowest = farthest, max(0.2 * slowest, SLOWEST)
        raise NoStep("the positions of the nodes could not be computed")

    @cached_property
    def scale(self) -> float:
        """Scale of forces [N]: weight of the anchor plus the sum of the absolute buoyancies."""
        return self.anchor.weight + float(np.abs(self.chain.elements.buoyancy).sum())

    def loads(
        self,
        node: Floats,
        velocity: Floats,
        strain: Floats,
        variation: Floats,
        slowest: float = SLOWEST,
    ) -> tuple[Loads, Floats, Floats]:
        """Compute the forces on all loads, and the unit axes (3, n) and lengths (n,) of the bars.

        Parameters
        ----------
        node, velocity : (3, n+1) positions [m] and velocities [m/s] of the nodes
        strain : (n,) strain of the bars
        variation, slowest : as in `loads_on`
        """
        on = self.chain.elements
        bar, (above, below) = on.bar, on.share
        chord = node[:, 1:] - node[:, :-1]
        length = np.sqrt(np.einsum("ij,ij->j", chord, chord))
        axis = chord / length
        moving = np.concatenate([velocity, node[2:]])
        at_load = above * moving.take(bar, axis=1) + below * moving.take(bar + 1, axis=1)
        loads = loads_on(
            self.chain, self.sea, at_load[3], at_load[:3], axis.take(bar, axis=1),
            strain.take(bar), variation, slowest,
        )  # fmt: skip
        return loads, axis, length

    def strain(self, tension: Floats) -> tuple[Floats, Floats]:
        """Return the strain (n,) of the bars, and its derivative with respect to tension [1/N].

        A rope under compression has the same strain as a rope without tension.
        """
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
        """Return the force on the falling anchor, and its derivative with respect to velocity.

        The force (3,) is the weight in water plus the drag [N].
        """
        current, _, density = self.sea.at(-node[2, -1:])
        flow = current[:, 0] - velocity[:, -1]
        k = self.anchor.drag * float(density[0]) / REFERENCE_DENSITY
        speed = float(np.sqrt(flow @ flow + slowest**2))
        force = k * speed * flow - [0.0, 0.0, self.anchor.weight]
        return force, -k * (speed * _UNIT + flow[:, np.newaxis] * flow / speed)

    def variation(self, state: ChainState) -> Floats:
        """Return the ratio (k,) of each load's normal drag to its constant normal drag.

        The ratio depends on the Reynolds number for smooth bodies, and is 1 for other loads.
        """
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
        """Return the Newton correction (n+1, 4): three coordinates of each node, and a tension.

        The tension in a row is that of the bar below the node. In the last row, it is unused.
        """
        chain, on = self.chain, self.chain.elements
        node = np.ascontiguousarray(node.T)
        velocity = (node - before.T) / step
        strain, growth = self.strain(tension)
        loads, axis, length = self.loads(node, velocity, strain, variation, slowest)
        bars = len(length)
        # nodes and bars alternate, as do the unknowns
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
        # derivatives by the positions of the upper and the lower end, distributed to both
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
        return _solved(
            residual, diagonal, beside, axis, -chain.length * growth, self._fixed_unknowns
        )

    @cached_property
    def _sinking(self) -> float:
        return BEARING_DEPTH * self.sea.water.depth

    @cached_property
    def _bearing(self) -> Floats:
        """Reaction (n,) of the seabed on each node that has penetrated by `BEARING_DEPTH` [N]."""
        on = self.chain.elements
        weight = on.summed(np.abs(on.buoyancy))
        weight[1:] += weight[:-1]
        bearing: Floats = np.maximum(0.5 * weight, 1e-4 * self.scale)
        return bearing

    @cached_property
    def _fixed_unknowns(self) -> tuple[int, ...]:
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
    """Solve the linear system for the correction (n+1, 4) of nodes and tensions.

    A row has three coordinates of a node, and the tension of the bar below this node. The last
    node has no bar below it, and the tension in its row is 0.

    Parameters
    ----------
    residual : (4, n+1) residual force on each node, and residual length of the bar below it
    diagonal : (3, 3, n+1) derivative of the force on each node by the position of this node
    beside : two arrays (3, 3, n): derivative of the force on the upper node of each bar by the
        position of the lower node, and of the force on the lower node by the position of the upper
    axis : (3, n) axes of the bars, downward
    slack : (n,) derivative of a bar's length by its tension, negative
    fixed : indices of unknowns whose correction is 0
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
