"""A net of legs: lines with more ends than one free and one anchored, joined at nodes.

Every leg is passed by the march of a single line: from its free end, if it has one, else from its
upper end with a pull on it that is unknown. Unknown are besides the depths of the free ends and the
places of the nodes; asked is that every leg ends where it is held and that the pulls at every node
balance. Newton's method, by differences of the marches on segments that stay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite

import numpy as np

from calm.physics.line import Floats, MarchError, Trace, Water
from calm.solve.finish import refuse_unbalanced
from calm.solve.net_leg import (
    HANGING_DOWN,
    PULLED,
    STANDING,
    LegCourse,
    LegEnd,
    NetLeg,
    Passed,
    refuse_misplaced,
    unsettled,
)
from calm.solve.net_start import NetStart, start_of
from calm.solve.solution import Settings, Solution, expect_many, runs_compiled

MOST_STEPS, HALVINGS = 60, 9
"""Newton steps towards a shape, and how often one is halved that leads nowhere."""
NEAR, CLOSED = 1e-4, 1e-10
"""What is left of lengths and forces, as shares of the longest leg and of a typical force: before
segments are kept, and in a shape."""
WORTH = 5e-5
"""Errors, as shares of the water depth and of the greatest tension, above which segments are
halved once more, `MOST_HALVINGS` times."""
MOST_HALVINGS = 3


@dataclass(frozen=True)
class NetSolution:
    """A net in equilibrium.

    Attributes
    ----------
    legs : each a line of its own, in the common frame; one that hangs from its upper end is listed
        from its lower one
    nodes : (n, 3) places [m]
    imbalance : (n,) what is left of the pulls at each node [N]
    miss : the worst distance of a leg's end from where it is held [m]
    depth_error, tension_error : own estimate of the worst errors [m], [N]
    marches : done for it
    unknowns, lands : what it was found by, for nets that stand about alike
    """

    legs: tuple[Solution, ...]
    nodes: Floats
    imbalance: Floats
    miss: float
    depth_error: float
    tension_error: float
    marches: int
    unknowns: Floats
    lands: tuple[bool, ...]


class NetSearch:
    """All legs, and what is unknown of them: of each leg its own, then the places of the nodes."""

    def __init__(
        self, legs: tuple[NetLeg, ...], nodes: int, water: Water, settings: Settings
    ) -> None:
        compiled = runs_compiled(settings)
        self.courses = [LegCourse(leg, water, settings, compiled) for leg in legs]
        self.nodes, self.water, self.settings = nodes, water, settings
        self.at = [0, *np.cumsum([each.unknowns for each in self.courses]).tolist()]
        self.size = self.at[-1] + 3 * nodes
        self.length = max(float(leg.line.length.sum()) for leg in legs)
        lifts = [np.abs(leg.line.net_force(np.zeros(len(leg.line.length)))).sum() for leg in legs]
        self.force = float(max(*lifts, 1.0))
        self.scale = np.full(self.size, self.length)
        self.rows = np.full(self.size, self.length)
        self.rows[self.at[-1] :] = self.force
        for i, each in enumerate(self.courses):
            if each.kind == PULLED:
                self.scale[self.at[i] : self.at[i + 1]] = self.force

    def begin(self, start: NetStart) -> Floats:
        """The unknowns of a start."""
        x = np.zeros(self.size)
        x[self.at[-1] :] = start.nodes.ravel()
        for i, each in enumerate(self.courses):
            free = start.first[i] if each.kind == STANDING else start.lower[i]
            own = start.pull[i] if each.kind == PULLED else -free[2]
            x[self.at[i] : self.at[i + 1]] = own
            anchored = isfinite(each.leg.lower.seabed) and each.kind != HANGING_DOWN
            each.lands = anchored and start.lies[i]
        return x

    def place_of(self, end: LegEnd, x: Floats) -> Floats:
        """Where an end that is not free is [m]."""
        if end.place is not None:
            return np.array(end.place)
        first = self.at[-1] + 3 * end.node
        return x[first : first + 3]

    def residual(self, x: Floats, step: float, *, slopes: bool) -> tuple[Floats, Floats]:
        """What is left to be closed and balanced, in shares; its slopes by shares, if asked for.

        Raises
        ------
        MarchError
        """
        found, jacobian = np.zeros(self.size), np.zeros((self.size, self.size))
        first, jump = self.at[-1], 1e-6
        for i, each in enumerate(self.courses):
            mine = slice(self.at[i], self.at[i + 1])
            kept = each.cuts
            base = self._leg(each, x[mine], x, step)
            self._put(found, i, base, x, whole=True)
            if not slopes:
                continue
            each.cuts = each.last
            variables = list(range(self.at[i], self.at[i + 1]))
            if each.kind == PULLED and each.start.node >= 0:
                variables.append(first + 3 * each.start.node + 2)
            reference = base if kept is not None else self._leg(each, x[mine], x, step)
            before = np.zeros(self.size)
            self._put(before, i, reference, x, whole=False)
            for variable in variables:
                moved = x.copy()
                moved[variable] += jump * self.scale[variable]
                other = self._leg(each, moved[mine], moved, step)
                change = np.zeros(self.size)
                self._put(change, i, other, moved, whole=False)
                jacobian[:, variable] += (change - before) / jump
            each.cuts = kept
            self._direct(jacobian, i)
        return found / self.rows, jacobian / self.rows[:, None]

    def _leg(self, each: LegCourse, own: Floats, x: Floats, step: float) -> Passed:
        z = float(self.place_of(each.start, x)[2]) if each.kind == PULLED else 0.0
        return each.passed(own, z, step)

    def _put(self, row: Floats, i: int, out: Passed, x: Floats, *, whole: bool) -> None:
        """Add a leg's share of what is left; not `whole`, only what follows from its march."""
        each, first = self.courses[i], self.at[-1]
        goal = each.goal
        if each.kind == PULLED:
            way = np.array([*out.way, out.end])
            if whole:
                start, end = self.place_of(each.start, x), self.place_of(each.end, x)
                way[:2] += start[:2] - end[:2]
                way[2] -= end[2] if goal is None else goal
            row[self.at[i] : self.at[i + 1]] = way
            if each.start.node >= 0:
                row[first + 3 * each.start.node :][:3] -= x[self.at[i] : self.at[i + 1]]
        else:
            miss = out.end
            if whole:
                miss -= self.place_of(each.end, x)[2] if goal is None else goal
            row[self.at[i]] = miss
        if each.end.node >= 0:
            row[first + 3 * each.end.node :][:3] += out.force

    def _direct(self, jacobian: Floats, i: int) -> None:
        """Add the slopes by the places of nodes that need no march."""
        each, first, own = self.courses[i], self.at[-1], self.at[i]
        if each.kind == PULLED:
            for k in range(3):
                if each.start.node >= 0 and k < 2:
                    jacobian[own + k, first + 3 * each.start.node + k] += self.length
                if each.end.node >= 0:
                    jacobian[own + k, first + 3 * each.end.node + k] -= self.length
        elif each.end.node >= 0:
            jacobian[own, first + 3 * each.end.node + 2] -= self.length

    def closed(self, x: Floats, step: float, enough: float) -> Floats | None:
        """Newton's method; None where it leads nowhere."""
        try:
            found, slopes = self.residual(x, step, slopes=True)
        except MarchError:
            return None
        size = float(np.abs(found).max())
        for _ in range(MOST_STEPS):
            if size <= enough:
                return x
            way = np.linalg.lstsq(slopes, -found, rcond=1e-14)[0]
            share = min(1.0, 0.5 / max(float(np.abs(way).max()), 1e-300))
            for _ in range(HALVINGS):
                following = x + share * way * self.scale
                try:
                    left, slope = self.residual(following, step, slopes=True)
                except MarchError:
                    left, slope = np.full(self.size, inf), slopes
                if float(left @ left) < (1.0 - 1e-3 * share) * float(found @ found):
                    break
                share *= 0.5
            else:
                return x if size <= 100.0 * enough else None
            x, found, slopes, size = following, left, slope, float(np.abs(left).max())
        return None

    def keep_cuts(self, x: Floats, step: float) -> None:
        """Cut the legs as they are now, for good."""
        for each in self.courses:
            each.cuts = None
        self.residual(x, step, slopes=False)
        for each in self.courses:
            each.cuts = each.last

    def lie_as(self, lands: Sequence[bool]) -> None:
        """Take legs to lie on the seabed or not."""
        for each, lies in zip(self.courses, lands, strict=True):
            each.lands = lies

    def in_water(self, water: Water) -> NetSearch:
        """The same net in other water."""
        other = NetSearch(
            tuple(each.leg for each in self.courses), self.nodes, water, self.settings
        )
        other.lie_as([each.lands for each in self.courses])
        return other

    def ends(self, x: Floats) -> list[tuple[Floats, Floats]]:
        """Positions and forces at the ends of every leg's pieces, from its last march."""
        found = []
        for each in self.courses:
            trace = Trace.of(each.record, each.nodes)
            end = self.place_of(each.end, x)
            position = trace.position + np.array([*(end[:2] - trace.position[-1, :2]), 0.0])
            last = np.append(np.flatnonzero(np.diff(trace.piece)) + 1, len(position) - 1)
            last = np.unique(np.append(last, 0))
            found.append((position[last], np.linalg.norm(trace.force[last], axis=1)))
        return found


def solve_net(
    legs: Sequence[NetLeg],
    nodes: int,
    water: Water,
    settings: Settings | None = None,
    near: NetSolution | None = None,
) -> NetSolution:
    """Solve for the equilibrium of a net of legs.

    Parameters
    ----------
    legs : their ends at nodes, held, or free
    nodes : how many nodes there are
    water, settings : as for `solve_mooring`
    near : the same net in other water, from which it is sought first

    Raises
    ------
    NoEquilibrium
        None was found, or what was found does not pass the checks.
    """
    legs, settings = tuple(legs), settings or Settings()
    expect_many(4.0 * len(legs))
    net, x = roughly(legs, nodes, water, settings, near)
    for left in range(len(legs), -1, -1):
        net.keep_cuts(x, 2.0 * settings.angle_step)
        x = closed_or_refused(net, x, 2.0 * settings.angle_step)
        if not any([each.lies_otherwise() for each in net.courses]):
            break
        closer = net.closed(x, 4.0 * settings.angle_step, NEAR) if left else None
        if closer is None:
            raise unsettled("a leg alternately lies on the seabed and lifts off")
        x = closer
    coarse = net.ends(x)
    for _ in range(MOST_HALVINGS):
        for each in net.courses:
            assert each.cuts is not None
            each.cuts = each.cuts.halved()
        x = closed_or_refused(net, x, settings.angle_step)
        fine = net.ends(x)
        depth, tension = (
            max(float(np.abs(a[k] - b[k]).max()) for a, b in zip(coarse, fine, strict=True))
            for k in (0, 1)
        )
        coarse = fine
        greatest = max(float(each[1].max()) for each in fine)
        if 0.5 * depth <= WORTH * water.depth and 0.5 * tension <= WORTH * greatest:
            break
    marches = sum(each.marches for each in net.courses)
    return _told(net, x, 0.5 * depth, 0.5 * tension, marches)


def _told(net: NetSearch, x: Floats, depth: float, tension: float, marches: int) -> NetSolution:
    """The solution, every leg audited and every node in balance."""
    found, _ = net.residual(x, net.settings.angle_step, slopes=False)
    found = np.abs(found * net.rows)
    first = net.at[-1]
    miss = float(found[:first].max())
    if miss > net.settings.tolerance * net.water.depth:
        raise unsettled(f"a leg misses its end by {miss:.2g} m")
    imbalance = np.linalg.norm(found[first:].reshape(-1, 3), axis=1)
    errors = depth + miss + 1e-9 * net.length, tension + 1e-8 * net.force
    legs = []
    for i, each in enumerate(net.courses):
        end = net.place_of(each.end, x)
        legs.append(each.solution(x[net.at[i] : net.at[i + 1]], end, errors))
    greatest = max(float(each.tension.max()) for each in legs)
    if len(imbalance) and float(imbalance.max()) > 1e-6 * greatest:
        raise unsettled(f"the pulls at a node leave {imbalance.max():.2g} N over")
    before = 0
    for each, leg in zip(net.courses, legs, strict=True):
        refuse_unbalanced(leg.closure, leg.moment_residual)
        refuse_misplaced(each, leg, errors[0], before)
        before += len(each.leg.line.length)
    return NetSolution(
        tuple(legs), x[first:].reshape(-1, 3).copy(), imbalance, miss, *errors, marches, x,
        tuple(each.lands for each in net.courses),
    )  # fmt: skip


def roughly(
    legs: tuple[NetLeg, ...], nodes: int, water: Water, settings: Settings,
    near: NetSolution | None,
) -> tuple[NetSearch, Floats]:  # fmt: skip
    """A net about closed, sought near another, where it about is, and from still water on.

    Raises
    ------
    NoEquilibrium
    """
    net, step = NetSearch(legs, nodes, water, settings), 4.0 * settings.angle_step
    if near is not None:
        net.lie_as(near.lands)
        if (x := net.closed(near.unknowns, step, NEAR)) is not None:
            return net, x
    x = net.closed(net.begin(start_of(legs, nodes, water)), step, NEAR)
    if x is not None:
        return net, x
    before = net.in_water(water.still())
    x = before.closed(before.begin(start_of(legs, nodes, water.still())), step, NEAR)
    if x is None:
        raise unsettled("not even in still water do its legs come together")
    way, stride = 0.0, 0.25
    while way < 1.0:
        following = min(way + stride, 1.0)
        moving = replace(water, u=following * water.u, v=following * water.v, w=following * water.w)
        net = before.in_water(moving if following < 1.0 else water)
        closer = net.closed(x, step, NEAR)
        if closer is None:
            stride *= 0.5
            if stride < 0.01:
                raise unsettled(f"beyond {way:.0%} of the current its legs do not come together")
            continue
        x, way, before = closer, following, net
    return net, x


def closed_or_refused(net: NetSearch, x: Floats, step: float) -> Floats:
    """The unknowns closed to the last digits; NoEquilibrium where they are not."""
    closer = net.closed(x, step, CLOSED)
    if closer is None:
        raise unsettled("its legs do not come together to the last digits")
    net.residual(closer, step, slopes=False)
    return closer
