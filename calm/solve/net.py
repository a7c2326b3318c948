"""Equilibrium of a net of legs: lines that are joined at nodes.

The march of each leg starts

- at the free end, if there is one;
- at the touchdown or anchor, upwards;
- otherwise at the upper end, with an unknown pull.

The depths of free ends and the positions of nodes are also unknown. Every leg must end at its held
position or node, and the pulls at every node must balance.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import Any, TypeVar

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.compiled import outcome
from calm.physics.line import FAILURES, GOES_ON, NO_ROOM, Floats, Line, Trace, Water
from calm.physics.profile import profile_of
from calm.solve import leg_closing, leg_numbers
from calm.solve.finish import refuse_unbalanced
from calm.solve.leg_closing import NetTask, copy_values, do_task
from calm.solve.leg_layout import LaidLeg, NetLeg, lay_net, leg_found, refuse_misplaced, unsettled
from calm.solve.leg_numbers import Marching
from calm.solve.mooring import SLACK_LINE_CURRENT, stirred
from calm.solve.net_start import NetStart, start_of
from calm.solve.problem import CHOSEN, FINE, ROOM
from calm.solve.solution import (
    FOUND,
    Settings,
    Solution,
    Status,
)
from calm.solve.two_speeds import CompiledPart, count_lines, runs_compiled

MORE_ROOM = 8
Answer = TypeVar("Answer")
LOOSE, TIGHTEST, FALL = 1e-2, 1e-8, 0.1
"""Small pulls of slack legs towards their anchors, for a net that is held by slack legs alone.

LOOSE is the first pull, and TIGHTEST the last, as fractions of the force scale of a leg. FALL is
the ratio of a pull to the preceding pull.
"""


@dataclass(frozen=True)
class NetSolution:
    """A net of legs in equilibrium.

    Attributes
    ----------
    legs : solution of each leg, in the coordinates of the net; a leg with a free lower end starts
        at this end
    nodes : (n, 3) positions of the nodes [m]
    imbalance : (n,) size of the resultant force at each node [N]
    miss : largest distance between a leg's end and its held position or node [m]
    depth_error, tension_error : estimated largest error of depths [m] and of tensions [N]
    """

    legs: tuple[Solution, ...]
    nodes: Floats
    imbalance: Floats
    miss: float
    depth_error: float
    tension_error: float
    marches: int
    unknowns: Floats


class LacksRoom(Exception):
    """Raised if a leg needs more segments than the work arrays hold."""


class NetSearch:
    """Search for the equilibrium of a net.

    The unknowns of all legs come first, followed by the positions of the nodes.
    """

    def __init__(
        self, legs: Sequence[NetLeg], nodes: int, water: Water, settings: Settings,
        room: int = ROOM, rough: bool = False,
    ) -> None:  # fmt: skip
        self.compiled, self.settings = runs_compiled(settings, solver=CompiledPart.LEGS), settings
        self.laid = [LaidLeg.of(leg, water, settings, rough) for leg in legs]
        self.nodes, self.room = nodes, room
        self.net = lay_net(self.laid, nodes, self.compiled, room)
        self.put_in(water)

    def put_in(self, water: Water) -> None:
        """Replace the current around the net; depth and density must stay the same."""
        profile = profile_of(water)
        self.water, self.sea = water, profile.packed if self.compiled else profile.sea

    def begin(self, start: NetStart) -> Floats:
        """Convert approximate positions and forces to the unknowns of the net."""
        x, first = np.zeros(len(self.net.found)), 0
        x[self.net.nodes_at :] = start.nodes.ravel()
        for i, each in enumerate(self.laid):
            down, pull = each.kind == leg_numbers.HANGING_DOWN, start.pull[i]
            x[first : first + each.unknowns] = -(start.lower if down else start.first)[i][2]
            if each.kind == leg_numbers.PULLED:
                x[first : first + 3] = pull
            elif each.kind == leg_numbers.ANCHORED:
                x[first : first + 3] = start.held[i]
                x[first + 3 : first + each.unknowns] = each.leg.lower.seabed
                height = start.first[i][2] - each.leg.lower.seabed
                x[first + 2] = min(x[first + 2], each.most_lying(height))
            # the share of buoyancy in use follows from the pull
            elif x[first] < 0.0 and not down and each.problem.surfacing:
                share = pull[2] / each.problem.surfacing[0].surface_lift
                x[first] = min(max(share, 0.01), 1.0) * each.surface_range - each.surface_range
            first += each.unknowns
        return x

    def do(self, task: int, x: Floats, how: Marching, enough: float = 0.0) -> tuple[int, Floats]:
        """Run a task (see `NetTask`), and return its outcome and the resulting unknowns."""
        own: Any = x.copy() if self.compiled else x.tolist()
        job = NetTask(task, self.net, own, how, enough, False)
        ending: int = outcome(do_task, self.compiled, job)
        closing = task in (leg_closing.CLOSE, leg_closing.SETTLE)
        if ending == (leg_closing.NEEDS_ROOM if closing else NO_ROOM):
            raise LacksRoom
        return ending, np.array(own)

    def marching(
        self, step: float, cuts: int, record: int, *, given: bool, loose: float = 0.0
    ) -> Marching:
        """Return the settings for the march of all legs."""
        return Marching(self.sea, float(step), cuts, given, given, record, loose)

    def closed(self, x: Floats, step: float, enough: float, loose: float = 0.0) -> Floats | None:
        """Return the unknowns of the closed net, or None if Newton's method does not converge.

        `loose` is as in `Marching`.
        """
        how = self.marching(step, CHOSEN, FINE, given=False, loose=loose)
        ending, found = self.do(leg_closing.CLOSE, x, how, enough)
        return found if ending == FOUND else None

    def settled(self, x: Floats) -> Floats:
        """Return the unknowns of the closed net to full precision, on sufficiently short segments.

        Raise NoEquilibrium if Newton's method does not converge.
        """
        how = self.marching(self.settings.angle_step, CHOSEN, FINE, given=False)
        # slack legs may not meet the first limit; the audit decides if only the second is met
        for enough in (leg_closing.CLOSED, 100.0 * leg_closing.CLOSED):
            ending, found = self.do(leg_closing.SETTLE, x, how, enough)
            if ending == FOUND:
                return found
        raise unsettled("the ends of its legs do not coincide to full precision")

    def end(self, i: int, x: Floats) -> Floats:
        """Return the position [m] at which the march of a leg must end."""
        end, first = self.laid[i].ends[1], self.net.nodes_at
        return x[first + 3 * end.node :] if end.place is None else np.array(end.place)

    def shape(self, i: int, x: Floats) -> Trace:
        """Return the shape of a leg in its last march, in the coordinates of the net."""
        nodes = int(self.net.state[i][leg_numbers.COUNT])
        trace = Trace.of(self.net.lines.work.records[i][FINE], nodes)
        trace.position[:, :2] += self.end(i, x)[:2] - trace.position[-1, :2]
        return trace

    def solution(self, x: Floats) -> NetSolution:
        """Audit all legs and nodes of the last settled equilibrium, and return the equilibrium.

        Raise NoEquilibrium if the solution fails a check.
        """
        net, legs, better = self.net, [], np.array(self.net.better)
        water = self.water
        slow = float(np.hypot(water.u, water.v).max(initial=0.0)) <= SLACK_LINE_CURRENT
        how = self.marching(self.settings.angle_step, CHOSEN, FINE, given=True)
        if slow and self.do(leg_closing.DRIFTS, x, how)[0]:
            raise Status.SLACK.because(
                "The net has no horizontal restraint: every anchored leg lies on the seabed and is "
                "slack, so the net can be at any position between its anchors.",
                advice="Shorten a leg, or set the design current.",
            )
        left = np.abs(np.array(net.found) * np.array(net.rows))
        miss = float(left[: net.nodes_at].max())
        if miss > self.settings.tolerance * net.span:
            raise unsettled(f"the computed end of a leg is {miss:.2g} m from its attachment point")
        imbalance = np.linalg.norm(left[net.nodes_at :].reshape(-1, 3), axis=1)
        errors = (
            float(net.errors[leg_closing.DEPTH_ERROR]) + miss + 1e-9 * net.length,
            float(net.errors[leg_closing.TENSION_ERROR]) + 1e-8 * net.force,
        )
        for i, each in enumerate(self.laid):
            ends = self.end(i, x), self.end(i, better)
            legs.append(
                leg_found(each, net, i, ends, errors, self.water, self.settings, self.compiled)
            )
        greatest = max(float(each.tension.max()) for each in legs)
        if len(imbalance) and float(imbalance.max()) > 1e-6 * greatest:
            raise unsettled(f"the forces at a node are out of balance by {imbalance.max():.2g} N")
        for leg in legs:
            refuse_unbalanced(leg.closure, leg.moment_residual)
        return NetSolution(
            tuple(legs), better[net.nodes_at :].reshape(-1, 3).copy(), imbalance, miss, *errors,
            int(sum(state[leg_numbers.MARCHES] for state in net.state)), x,
        )  # fmt: skip


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
    nodes : number of nodes that join the legs
    near : solution of the same net in other water, used as a start

    Raises
    ------
    NoEquilibrium
        No equilibrium was found, or the equilibrium fails a check.
    """
    settings = settings or Settings()
    count_lines(4.0 * len(legs), CompiledPart.LEGS)

    def solved(net: NetSearch) -> NetSolution:
        found = net.solution(settled_from(net, near))
        before = 0
        for each, leg in zip(net.laid, found.legs, strict=True):
            refuse_misplaced(each, leg, found.depth_error, before)
            before += len(each.leg.line.length)
        return found

    while True:
        try:
            return with_room(solved, legs, nodes, water, settings)
        except NoEquilibrium as failure:
            if failure.status == Status.SLACK.label or (moving := stirred(water)) is None:
                raise
            water = moving


def with_room(
    solve: Callable[[NetSearch], Answer],
    legs: Sequence[NetLeg], nodes: int, water: Water, settings: Settings,
) -> Answer:  # fmt: skip
    """Run a search, and repeat it with larger work arrays until the arrays hold all segments."""
    room = ROOM
    while True:
        try:
            return solve(NetSearch(legs, nodes, water, settings, room))
        except LacksRoom:
            room *= MORE_ROOM


def settled_from(net: NetSearch, near: NetSolution | None) -> Floats:
    """Return the unknowns of a net in equilibrium, to full precision.

    Raise NoEquilibrium if no equilibrium is found.

    Parameters
    ----------
    near : another solution of the net, used as a start
    """
    try:
        return net.settled(roughly_closed(net, near))
    except NoEquilibrium as failure:
        # If only slack legs hold a net in still water, no force determines where the net drifts.
        # Slack legs therefore pull towards their anchors at first, by ever smaller forces.
        try:
            x, loose, fall = roughly_closed(net, None, LOOSE), LOOSE, FALL
            while loose > TIGHTEST and fall < 0.6:
                less, step = fall * loose, 4.0 * net.settings.angle_step
                closer = net.closed(x, step, leg_closing.NEAR, less)
                x, loose = (x, loose) if closer is None else (closer, less)
                fall = fall if closer is not None else sqrt(fall)
            return net.settled(x)
        except NoEquilibrium:
            raise failure from None


def roughly_closed(net: NetSearch, near: NetSolution | None, loose: float = 0.0) -> Floats:
    """Return approximate unknowns of a net in equilibrium.

    Raise NoEquilibrium if all searches fail.

    Parameters
    ----------
    near : another solution of the net, used as a start
    loose : as in `Marching`
    """
    water, step = net.water, 4.0 * net.settings.angle_step
    legs = tuple(each.leg for each in net.laid)
    x = None if near is None else net.closed(near.unknowns, step, leg_closing.NEAR, loose)
    if x is not None:
        return x
    # raising the current from zero in steps leads to the highest equilibrium
    still, fraction, stride = water.still(), 0.0, 1.0
    net.put_in(still)
    x = net.closed(net.begin(start_of(legs, net.nodes, still)), step, leg_closing.NEAR, loose)
    why = "its legs do not meet even in still water"
    while x is not None and fraction < 1.0 and stride >= 0.01:
        following = min(fraction + stride, 1.0)
        moving = replace(water, u=following * water.u, v=following * water.v, w=following * water.w)
        net.put_in(moving if following < 1.0 else water)
        closer = net.closed(x, step, leg_closing.NEAR, loose)
        stride = stride if closer is not None else 0.5 * stride
        x, fraction = (x, fraction) if closer is None else (closer, following)
        why = f"its legs do not meet if the current exceeds {fraction:.0%} of its full speed"
    if x is None or fraction < 1.0:
        net.put_in(water)
        x = net.closed(net.begin(start_of(legs, net.nodes, water)), step, leg_closing.NEAR, loose)
    if x is None:
        raise unsettled(why)
    return x


class NearbyNet:
    """A solved net of legs, from which nets with one slightly different leg are solved.

    All these nets have the segments of the solved net. The parameters and exceptions are those of
    `solve_net`.
    """

    def __init__(
        self, legs: Sequence[NetLeg], nodes: int, water: Water, settings: Settings,
        near: NetSolution | None = None,
    ) -> None:  # fmt: skip
        self._net = net = NetSearch(legs, nodes, water, settings)
        step = settings.angle_step
        self._how = net.marching(step, CHOSEN, FINE, given=True)
        chosen = net.marching(step, CHOSEN, FINE, given=False)
        _, x = net.do(leg_closing.MARCH, roughly_closed(net, near), chosen)
        ending, self._x = net.do(leg_closing.CLOSE, x, self._how, leg_closing.CLOSED)
        if ending != FOUND:
            raise unsettled("the ends of its legs do not coincide to full precision")
        net.do(leg_closing.SLOPES, self._x, self._how)
        self._slopes = np.array(net.net.slopes)
        net.do(leg_closing.MARCH, self._x, self._how)

    def node(self, leg: int, piece: int, clamp: int = -1) -> int:
        """Return the number of the node at the top of a piece of a leg, or at a clamp.

        The number holds for all nets solved with this object.
        """
        each, trace = self._net.laid[leg], self._net.shape(leg, self._x)
        if clamp >= 0:
            return int(np.argmax(trace.clamp == clamp))
        if each.kind == leg_numbers.HANGING_DOWN:  # listed from its lower end
            own = len(each.leg.line.length) - 1 - piece
            return int(np.flatnonzero(trace.piece == own)[-1]) + 1
        return int(np.argmax(trace.piece == piece + int(each.below_a_point)))

    def shape(self, number: int, line: Line, leg: int) -> tuple[Floats, float]:
        """Return the node positions and used buoyancy fraction of a leg, after a change of one leg.

        The positions (k+1, 3) [m] have an error of third order in the change. Raise NoEquilibrium
        if a march fails.

        Parameters
        ----------
        number, line : number of the changed leg, and its new line
        leg : number of the leg to return
        """
        net, x = self._net, self._x
        legs = [each.leg for each in net.laid]
        legs[number] = replace(legs[number], line=line)
        other = NetSearch(legs, net.nodes, net.water, net.settings, net.room)
        copy_values(net.net.scale, other.net.scale)
        mine, its = other.net.lines.work, net.net.lines.work
        for i in range(len(legs)):
            mine.chosen[i][:], mine.counts[i][:] = its.chosen[i], its.counts[i]
        for _ in range(2):
            other.do(leg_closing.MARCH, x, self._how)
            left = np.array(other.net.found)
            x = x - np.linalg.lstsq(self._slopes, left, rcond=1e-14)[0] * np.array(net.net.scale)
        failure, _ = other.do(leg_closing.MARCH, x, self._how)
        if failure != GOES_ON:
            raise unsettled(FAILURES[failure])
        return other.shape(leg, x).position, float(other.net.state[leg][leg_numbers.SHARE])
