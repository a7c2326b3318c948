"""The referee's nets: legs integrated like moorings and tows, and the balance at their nodes.

Unknown are the places of the nodes, the depth of every free upper end (or the share in use of its
float, at the surface), the depth of every free lower end, and the pull above every leg that hangs
between two points. A leg that is held by an anchor is followed down to it; it may come down level
and lie along its pull. Where that is weak it is followed upwards from the touchdown, and the pull
there and the length that hangs are unknown; of a slack leg, which comes down with no pull at all,
that length alone. Newton's method starts from CALM's answer: what is found is whether that is an
equilibrium of these equations, and where theirs is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calm.physics.line import Line, Water
from calm.solve import Solution
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.net import NetSolution
from tests.validation.afloat import depth_of_free_end, first_float, riding
from tests.validation.agreement import Ends, integrated_ends
from tests.validation.cables import NoContinuousSolution
from tests.validation.closing import FINE
from tests.validation.continuous import March, Shape
from tests.validation.loads import Vector
from tests.validation.ropes import strain_law
from tests.validation.towed import from_free_end

CLOSED, STEPS, NUDGE = 1e-8, 6, 1e-6
"""What may be left of lengths and of forces, as shares; the steps, and that of a slope."""
AT_AN_END = 1e-9
"""Distance of a touchdown from the end of a piece that is there, in depths of the water."""
SLACK, WEAK = 1e-6, 0.05
"""Pull at the touchdown, as a share of the greatest in the net, of a leg that is slack, and of one
that is followed upwards."""


@dataclass(frozen=True)
class Passed:
    """A leg followed from its unknowns: places from where it began, and what it leaves.

    Attributes
    ----------
    way : (3,) from its beginning to its end; only up where it begins wherever that leads to
    force : (3,) on what it ends at
    """

    shape: Shape
    way: Vector
    force: Vector


class Leg:
    """A leg as it is followed: by how many unknowns, and where from.

    It begins at its free end or its touchdown, or else at its upper end. `scale` is what its
    unknowns are measured by.
    """

    def __init__(self, leg: NetLeg, found: Solution, water: Water, greatest: float) -> None:
        self.leg, self.water, self.found = leg, water, found
        self.lands, self.friction = found.landed, found.settings.seabed_friction
        pull = float(np.linalg.norm(found.force[-1]))
        self.hung = float(leg.line.length.sum()) - found.grounded_length
        ends = np.abs(np.cumsum(leg.line.length) - self.hung)
        in_cable = bool(ends.min() > AT_AN_END * water.depth)  # else a weight stands on the seabed
        self.rises = found.landed and not leg.upper.free and pull <= WEAK * greatest and in_cable
        self.slack = self.rises and pull <= SLACK * greatest
        self.begins, self.ends = leg.upper, leg.lower
        if self.rises or (leg.lower.free and not leg.upper.free):
            self.begins, self.ends = leg.lower, leg.upper
        self.free = self.begins.free or self.slack
        self.scale = np.array([water.depth])
        if not self.free:
            self.scale = np.array([pull, pull, water.depth] if self.rises else [greatest] * 3)

    @property
    def start(self) -> Vector:
        """The unknowns as CALM has them."""
        if self.slack:
            return np.array([self.hung])
        if self.rises:
            return np.array([*-self.found.force[-1, :2], self.hung])
        if not self.free:
            return self.found.force[0].copy()
        if self.leg.upper.free and self.found.afloat:
            return np.array([(self.found.buoyancy_used - 1.0) * self.water.depth])
        return np.array([-float(self.found.position[0, 2])])

    def passed(self, unknown: Vector, begins: Vector) -> Passed:
        """Follow it from where it begins, and from its unknowns."""
        line, water, pull, to_touchdown = self.leg.line, self.water, None, np.zeros(3)
        if self.rises:
            march = March(from_free_end(self._hanging(float(unknown[-1]))), water, FINE)
            depth, share = -self.leg.lower.seabed, np.ones(len(line.length))
            if not self.slack:
                pull = np.array([*unknown[:2], 0.0])
                to_touchdown = self._lying(float(unknown[-1]), pull)
        elif not self.free:
            march = March(replace(line, towed=True, floating=None), water, FINE, self.friction)
            depth, share, pull = -float(begins[2]), np.ones(len(line.length)), unknown
        elif not self.leg.upper.free:
            march = March(replace(self.found.line, towed=True), water, FINE)
            depth, share = float(unknown[0]), np.ones(len(line.length))
        else:
            march, depth, share = self._standing(float(unknown[0]))
        shape = march.kept(depth, share, self.lands and not self.rises, pull)
        shape = shape.shifted(to_touchdown[:2])
        way = shape.bottom[-1] * [1.0, 1.0, 0.0] if self.rises else shape.bottom[-1] - shape.top[0]
        if self.free or self.rises:
            way[2] = shape.bottom[-1, 2]
        return Passed(shape, way, shape.force_bottom[-1])

    def _lying(self, hung: float, pull: Vector) -> Vector:
        """The way from the anchor to the touchdown along what lies, against the seabed's pull."""
        size, line = float(np.linalg.norm(pull)), self.leg.line
        lying = line.length - self._suspended(hung)
        stretched = [
            length * (1.0 + strain_law(line, piece)(size)) if line.flexible[piece] else length
            for piece, length in enumerate(lying)
        ]
        return -sum(stretched) * pull / size

    def _standing(self, unknown: float) -> tuple[March, float, Vector]:
        """A leg with a free upper end: below the surface its depth is unknown, and above it the
        share in use of its float.
        """
        line, water = self.leg.line, self.water
        share = np.ones(len(line.length))
        if unknown >= 0.0:
            return March(line, water, FINE, self.friction), unknown, share
        part = 1.0 + unknown / water.depth
        share[first_float(line)] = part
        if line.floating is None:
            return March(line, water, FINE, self.friction), 0.0, share
        loaded, out = riding(line, water, None, part)
        march = March(loaded, water, FINE, self.friction)
        return march, depth_of_free_end(march, share, out), share

    def _suspended(self, length: float) -> Vector:
        """(n,) what hangs of each piece where so much of a slack leg does."""
        whole = self.leg.line.length
        return np.clip(length - (np.cumsum(whole) - whole), 0.0, whole)

    def _lies(self, length: float) -> Vector:
        """(n,) whether no part of a piece hangs."""
        whole = self.leg.line.length
        return np.cumsum(whole) - whole > length

    def _hanging(self, length: float) -> Line:
        """What hangs of a slack leg; pieces that lie are left without length and load."""
        line, lies = self.leg.line, self._lies(length)
        on = lies[line.clamp_piece]
        pieces = ("buoyancy", "volume", "normal_drag", "tangential_drag", "lift")
        clamps = ("clamp_buoyancy", "clamp_volume", "clamp_drag", "clamp_lift")
        columns = {name: np.where(lies, 0.0, getattr(line, name)) for name in pieces}
        columns |= {name: np.where(on, 0.0, getattr(line, name)) for name in clamps}
        return replace(line, length=self._suspended(length), **columns)

    def risen_ends(self, shape: Shape, hung: float) -> Ends:
        """Ends of a leg that was followed upwards, from its upper end down; NaN of what lies."""
        whole, lies = self.leg.line.length, self._lies(hung)
        anchor, touchdown = np.array(self.leg.lower.place)[:2], shape.top[0, :2]
        if self.slack and np.hypot(*(touchdown - anchor)) > whole.sum() - hung:
            raise NoContinuousSolution("a slack leg does not reach its anchor")
        cut = (self._suspended(hung) < whole) | lies
        tops, bottoms = shape.bottom[::-1].copy(), shape.top[::-1].copy()
        forces = shape.force_bottom[::-1].copy(), shape.force_top[::-1].copy()
        for ends, none in ((tops, lies), (bottoms, cut), (forces[0], lies), (forces[1], cut)):
            ends[none] = np.nan
        clamps = shape.clamp.copy()
        clamps[cut[self.leg.line.clamp_piece]] = np.nan
        return (
            np.concatenate([tops, bottoms, clamps]),
            np.linalg.norm(np.concatenate(forces), axis=1),
        )


def solve_continuous_net(
    legs: Sequence[NetLeg], found: NetSolution, water: Water
) -> tuple[list[Ends], Vector]:
    """Ends of the legs, listed as CALM lists them, and the places of the nodes (n, 3).

    Those of what lies of a slack leg are NaN: it lies as it likes.

    Raises
    ------
    NoContinuousSolution
        There is no equilibrium close by.
    """
    greatest = max(float(leg.tension.max()) for leg in found.legs)
    followed = [Leg(leg, one, water, greatest) for leg, one in zip(legs, found.legs, strict=True)]
    scales = [leg.scale for leg in followed]
    scale = np.concatenate([*scales, np.full(found.nodes.size, water.depth)])
    x = np.concatenate([*(leg.start for leg in followed), found.nodes.ravel()]) / scale
    bounds = np.cumsum([0, *(len(each) for each in scales)])
    memory: dict[tuple[int, bytes, bytes], Passed] = {}

    def place_of(end: LegEnd, nodes: Vector) -> Vector:
        return nodes[end.node] if end.node >= 0 else np.array(end.place, dtype=float)

    def passed(x: Vector) -> tuple[list[Passed], Vector]:
        out, nodes = [], (x * scale)[bounds[-1] :].reshape(-1, 3)
        for i, leg in enumerate(followed):
            own = (x * scale)[bounds[i] : bounds[i + 1]]
            begins = np.zeros(3) if leg.free or leg.rises else place_of(leg.begins, nodes)
            key = i, own.tobytes(), begins[2:].tobytes()
            if key not in memory:
                memory[key] = leg.passed(own, begins)
            out.append(memory[key])
        return out, nodes

    def residual(x: Vector) -> Vector:
        out, nodes = passed(x)
        missed, balance = [np.zeros(0)], np.zeros_like(nodes)
        for leg, one in zip(followed, out, strict=True):
            end = place_of(leg.ends, nodes)
            if leg.free:
                missed.append(one.way[2:] - end[2:])
            else:
                begins = place_of(leg.begins, nodes)
                if leg.rises:
                    begins = begins * [1.0, 1.0, 0.0]
                elif leg.lands:
                    end = np.array([*end[:2], leg.leg.lower.seabed])
                missed.append(begins + one.way - end)
                if leg.begins.node >= 0:
                    balance[leg.begins.node] -= one.shape.force_top[0]
            if leg.ends.node >= 0:
                balance[leg.ends.node] += one.force
        missing = np.concatenate(missed) / water.depth
        return np.concatenate([missing, balance.ravel() / greatest])

    best, least = x, np.inf
    for _ in range(STEPS):
        value = residual(x)
        if np.abs(value).max() >= 0.5 * least:
            break  # it is down to rounding
        best, least = x, np.abs(value).max()
        slopes = np.column_stack([
            (residual(x + NUDGE * unit) - residual(x - NUDGE * unit)) / (2.0 * NUDGE)
            for unit in np.eye(len(x))
        ])  # fmt: skip
        x = x - np.linalg.lstsq(slopes, value, rcond=1e-14)[0]
    if least > CLOSED:
        raise NoContinuousSolution(f"no equilibrium of the net is near: it is left {least:.1e} off")
    x = best
    out, nodes = passed(x)
    ends = []
    for i, (leg, one) in enumerate(zip(followed, out, strict=True)):
        by = place_of(leg.ends, nodes)[:2] - one.shape.bottom[-1, :2]
        if not leg.free:
            by = place_of(leg.begins, nodes)[:2]
        hung = float((x * scale)[bounds[i + 1] - 1])
        shape = one.shape.shifted(by)
        ends.append(leg.risen_ends(shape, hung) if leg.rises else integrated_ends(shape))
    return ends, nodes
