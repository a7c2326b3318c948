"""A net and those that differ from it a little, by its slopes and on its cuts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calm.physics.line import Floats, Line, MarchError, Trace, Water
from calm.solve.net import NetSolution, closed_or_refused, roughly
from calm.solve.net_leg import HANGING_DOWN, PULLED, LegCourse, NetLeg, unsettled
from calm.solve.solution import Settings


class NearbyNet:
    """A net and those in which one leg differs a little, by the slopes and the cuts of the net.

    Parameters
    ----------
    legs, nodes, water, settings, near : as of `solve_net`

    Raises
    ------
    NoEquilibrium
        As `solve_net` does.
    """

    def __init__(
        self, legs: Sequence[NetLeg], nodes: int, water: Water, settings: Settings,
        near: NetSolution | None = None,
    ) -> None:  # fmt: skip
        self._net, x = roughly(tuple(legs), nodes, water, settings, near)
        self._step = settings.angle_step
        self._net.keep_cuts(x, self._step)
        self._x = closed_or_refused(self._net, x, self._step)
        _, self._slopes = self._net.residual(self._x, self._step, slopes=True)

    def node(self, leg: int, piece: int, clamp: int = -1) -> int:
        """The node at the top of a piece of a leg, or at a clamp, in every one of these shapes."""
        each = self._net.courses[leg]
        trace, own, at = Trace.of(each.record, each.nodes), piece, int(each.kind == PULLED)
        if clamp >= 0:
            return int(np.argmax(trace.clamp == clamp))
        if each.kind == HANGING_DOWN:  # listed from its lower end
            own = len(each.leg.line.length) - 1 - piece
            return int(np.flatnonzero(trace.piece == own)[-1]) + 1
        return int(np.argmax(trace.piece == own + at))

    def shape(self, number: int, line: Line, leg: int) -> tuple[Floats, float]:
        """Nodes of a leg where that of a number has another line, and its buoyancy in use.

        Two steps by the slopes of the net itself leave an error of the third order in the change.

        Raises
        ------
        NoEquilibrium
        """
        net, x = self._net, self._x
        own = net.courses[number]
        other = LegCourse(replace(own.leg, line=line), own.water, own.settings, own.compiled)
        other.cuts, other.lands = own.cuts, own.lands
        net.courses[number] = other
        try:
            for _ in range(2):
                left, _ = net.residual(x, self._step, slopes=False)
                x = x - np.linalg.lstsq(self._slopes, left, rcond=1e-14)[0] * net.scale
            net.residual(x, self._step, slopes=False)
            each = net.courses[leg]
            position, end = Trace.of(each.record, each.nodes).position, net.place_of(each.end, x)
            position[:, :2] += end[:2] - position[-1, :2]
            return position, each.share
        except MarchError as failure:
            raise unsettled(str(failure)) from None
        finally:
            net.courses[number] = own
