"""Approximate start for a net, from the rest positions of lumped masses on springs.

The springs stretch by a few percent, and tangential friction is ignored.
"""

from __future__ import annotations

from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from calm.physics.line import Floats, Integers, Line, Water

if TYPE_CHECKING:
    from calm.solve.leg_layout import NetLeg

MOST_LUMPS, SOFTEST = 14, 0.02
"""Largest number of springs in a leg, and the strain of a spring under the weight of the net."""
ROUNDS, AT_REST, SWAY = 6000, 2e-3, 20
"""Largest number of steps; allowed imbalance, as a fraction of a typical force; number of steps
between two updates of the drag.
"""


class NetStart(NamedTuple):
    """Approximate positions and forces of a net.

    Attributes
    ----------
    nodes : (n, 3) positions of the nodes [m]
    first, lower : (k, 3) positions of each leg's upper and lower ends [m]
    pull : (k, 3) force on each leg's upper end [N]
    held : (k, 3) force on each leg's lower end [N], computed without support by the seabed
    """

    nodes: Floats
    first: Floats
    pull: Floats
    lower: Floats
    held: Floats


class _Lumps:
    """The lumped masses of all legs, with the springs between them."""

    def __init__(self, legs: tuple[NetLeg, ...], nodes: int, water: Water) -> None:
        self.water, self.nodes = water, nodes
        longest = max(float(leg.line.length.sum()) for leg in legs)
        places: list[Floats] = [np.full(3, np.nan) for _ in range(nodes)]
        lift, drag, insensitive, bed = ([0.0] * nodes for _ in range(4))
        bed = [-inf] * nodes
        fixed, springs, lengths = [False] * nodes, [], []
        self.rows: list[list[int]] = []
        for leg in legs:
            count = int(np.clip(round(MOST_LUMPS * leg.line.length.sum() / longest), 1, MOST_LUMPS))
            whole = max(float(leg.line.length.sum()), 1e-3 * longest)
            row = []
            for i in range(count + 1):
                end = leg.upper if i == 0 else leg.lower if i == count else None
                if end is not None and end.node >= 0:
                    row.append(end.node)
                    continue
                row.append(len(places))
                held = end is not None and end.place is not None
                places.append(np.array(end.place if held and end else (np.nan,) * 3, float))
                fixed.append(held)
                lift.append(0.0)
                drag.append(0.0)
                insensitive.append(0.0)
                bed.append(leg.lower.seabed)
            for at, net, normal, any_direction in _points(leg.line, water):
                position = np.clip(at / whole, 0.0, 1.0) * count
                near = min(int(position), count - 1)
                for lump, share in (
                    (row[near], 1.0 - position + near),
                    (row[near + 1], position - near),
                ):
                    lift[lump] += share * net
                    drag[lump] += share * normal
                    insensitive[lump] += share * any_direction
            springs += list(pairwise(row))
            lengths += [whole / count] * count
            self.rows.append(row)
        self.fixed = np.array(fixed)
        self.lift, self.drag = np.array(lift), np.array(drag)
        self.insensitive, self.bed = np.array(insensitive), np.array(bed)
        self.springs: Integers = np.array(springs, dtype=np.intp)
        self.lengths = np.array(lengths)
        self.place = self._spread(np.array(places), legs)
        self.typical = float(np.abs(self.lift).sum()) + 1.0
        self.stiffness = self.typical / SOFTEST / self.lengths

    def _spread(self, place: Floats, legs: tuple[NetLeg, ...]) -> Floats:
        """Place nodes between the held ends of their legs, and other lumps along their legs."""
        for _ in range(200):
            before = place.copy()
            for lump in range(self.nodes):
                near = [
                    before[other]
                    for row in self.rows
                    for mine, other in ((row[0], row[-1]), (row[-1], row[0]))
                    if mine == lump and np.isfinite(before[other]).all()
                ]
                if near:
                    place[lump] = np.mean(near, axis=0)
        for leg, row in zip(legs, self.rows, strict=True):
            length = float(leg.line.length.sum())
            ends = place[row[0]], place[row[-1]]
            if not np.isfinite(ends[0]).all():
                ends = ends[1] + np.array([0.0, 0.0, length]), ends[1]
            elif not np.isfinite(ends[1]).all():
                ends = ends[0], ends[0] - np.array([0.0, 0.0, length])
            for i, lump in enumerate(row):
                if not np.isfinite(place[lump]).all():
                    place[lump] = ends[0] + (ends[1] - ends[0]) * i / (len(row) - 1)
        place[~self.fixed] += (
            1e-3 * np.random.default_rng(1).standard_normal(place.shape)[~self.fixed]
        )
        return place

    def settle(self) -> None:
        """Release all lumps and stop them at every peak of kinetic energy, until they rest."""
        a, b = self.springs.T
        mass = np.zeros(len(self.place))
        for ends in (a, b):
            np.add.at(mass, ends, self.stiffness)
        shallow = 0.01 * self.water.depth
        spring = self.typical / shallow
        mass += spring
        speed, energy = np.zeros_like(self.place), 0.0
        flow = np.zeros_like(self.place)
        for turn in range(ROUNDS):
            if turn % SWAY == 0:
                flow = self._flow()
            force = flow.copy()
            z = self.place[:, 2]
            out = np.maximum(z, 0.0) * np.maximum(self.lift, 0.0) / shallow
            force[:, 2] += self.lift - out + spring * np.maximum(self.bed - z, 0.0)
            pull = self.pulls()
            np.add.at(force, a, pull)
            np.add.at(force, b, -pull)
            force[self.fixed] = 0.0
            if np.abs(force).max() < AT_REST * self.typical / len(mass) and turn > SWAY:
                break
            speed += force / mass[:, None]
            moving = float((mass * (speed**2).sum(axis=1)).sum())
            if moving < energy:
                speed[:], moving = 0.0, 0.0
            energy = moving
            self.place += speed

    def pulls(self) -> Floats:
        """Return the force (m, 3) of every spring on the first of its two lumps [N]."""
        a, b = self.springs.T
        vector = self.place[b] - self.place[a]
        size = np.maximum(np.linalg.norm(vector, axis=1), 1e-12)
        tension = self.stiffness * np.maximum(size - self.lengths, 0.0)
        pull: Floats = (tension / size)[:, None] * vector
        return pull

    def _flow(self) -> Floats:
        """Return the drag (n, 3) on the lumps [N]."""
        current = self.water.current_at(-self.place[:, 2])
        axis = np.zeros_like(self.place)
        a, b = self.springs.T
        vector = self.place[b] - self.place[a]
        np.add.at(axis, a, vector)
        np.add.at(axis, b, vector)
        axis /= np.maximum(np.linalg.norm(axis, axis=1), 1e-12)[:, None]
        across = current - (current * axis).sum(axis=1)[:, None] * axis
        speed, normal = (np.linalg.norm(each, axis=1) for each in (current, across))
        drag: Floats = (self.drag * normal)[:, None] * across
        any_direction: Floats = (self.insensitive * speed)[:, None] * current
        return drag + any_direction


def _points(line: Line, water: Water) -> list[tuple[float, float, float, float]]:
    """List the bodies on a line for the lumped masses.

    A body has a distance from the top [m], a net force [N], and two drag factors per squared speed:
    for flow across the line, and for any direction.
    """
    found, top = [], 0.0
    density = water.density_at(np.array(0.5 * water.depth))
    excess = (float(density) - 1025.0) * water.gravity
    for i, length in enumerate(line.length.tolist()):
        parts = 20 if line.flexible[i] else 1
        amount = length / parts if line.flexible[i] else 1.0
        net = float(line.buoyancy[i] + excess * line.volume[i]) * amount
        drag = float(line.normal_drag[i]) * amount
        across = (drag, 0.0) if line.directional[i] else (0.0, drag)
        found += [(top + (k + 0.5) * length / parts, net, *across) for k in range(parts)]
        for m in np.flatnonzero(line.clamp_piece == i):
            at, lift = top + float(line.clamp_at[m]), float(line.clamp_buoyancy[m])
            found.append((at, lift, 0.0, float(line.clamp_drag[m])))
        top += length
    return found


def start_of(legs: tuple[NetLeg, ...], nodes: int, water: Water) -> NetStart:
    """Compute approximate positions and forces for a net of legs.

    Parameters
    ----------
    legs : legs of the net
    nodes : number of nodes
    """
    lumps = _Lumps(legs, nodes, water)
    lumps.settle()
    pulls, first, pull, lower, held, spring = lumps.pulls(), [], [], [], [], 0
    for leg, row in zip(legs, lumps.rows, strict=True):
        first.append(lumps.place[row[0]])
        lower.append(lumps.place[row[-1]])
        pull.append(-pulls[spring])
        spring += len(row) - 1
        lift = sum(net for _, net, _, _ in _points(leg.line, water))
        held.append([*pulls[spring - 1][:2], -pull[-1][2] - lift])
    ends = (np.array(each) for each in (first, pull, lower, held))
    return NetStart(lumps.place[:nodes], *ends)
