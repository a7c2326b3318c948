"""The march of all lanes from their free ends to the anchor."""

from __future__ import annotations

from math import inf

from calm.batch.kernel import lane
from calm.batch.kernel.cable import pass_cable
from calm.batch.kernel.lane import LANES, STATE, Desk
from calm.batch.kernel.layout import Way
from calm.batch.kernel.loads import pass_clamp
from calm.batch.kernel.rod import pass_rod
from calm.batch.kernel.seabed import come_down, keep, lie_down, lie_loads, pass_to_seabed
from calm.physics.line import Floats
from calm.physics.track import CABLE, ROD


def march(desk: Desk, way: Way, halvings: int) -> None:
    """March all lanes from their free ends; their states at every joint go to the desk's nodes.

    A line that may land is cut as its slot of `own` has it: see `calm.batch.kernel.bends`.
    """
    s, water, nodes, forces = desk.scratch, desk.water, desk.nodes, desk.forces
    begin(s)
    note(s, nodes, 0)
    stages, landing = way.course.stages, way.course.landing
    for n in range(len(stages)):
        kind = stages[n].kind
        to_seabed = way.lands and n >= landing
        if to_seabed:
            keep(s)
        if kind == CABLE:
            if way.lands:
                pass_to_seabed(s, water, way, n, halvings, desk.own)
            else:
                first = way.first_cut[stages[n].first]
                end = way.first_cut[stages[n].first + 1]
                pass_cable(s, water, way.course, n, way.cuts[first:end], halvings)
        else:
            if kind == ROD:
                pass_rod(desk, way, n)
            else:
                pass_clamp(s, water, way, n)
            if to_seabed:
                come_down(s, kind, n)
        if to_seabed:
            lie_down(s, way, n)
            if kind == ROD and stages[n].size > 1:
                lie_loads(s, way, n, forces)
        if n >= landing:
            for i in range(LANES):
                fz = s[lane.FZ + i]
                s[lane.LIGHTEST + i] = fz if fz < s[lane.LIGHTEST + i] else s[lane.LIGHTEST + i]
        if n == 0 and kind == ROD:
            for i in range(LANES):
                nodes[lane.Z + i] = s[lane.Z + i] - stages[0].length * s[lane.TZ + i]
        note(s, nodes, n + 1)


def begin(s: Floats) -> None:
    """Put all lanes at their free ends."""
    for i in range(LANES):
        s[lane.X + i], s[lane.Y + i], s[lane.Z + i] = 0.0, 0.0, -s[lane.FREE_END + i]
        s[lane.FX + i], s[lane.FY + i], s[lane.FZ + i] = 0.0, 0.0, 0.0
        s[lane.TX + i], s[lane.TY + i], s[lane.TZ + i] = 0.0, 0.0, -1.0
        s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = 0.0, 0.0, 0.0
        s[lane.LOWEST + i], s[lane.HIGHEST + i] = inf, -inf
        s[lane.LIGHTEST + i], s[lane.LEAST_PULL + i] = inf, inf
        s[lane.RESTING + i], s[lane.HANGING + i], s[lane.SHARPEST + i] = -1.0, 0.0, 0.0


def note(s: Floats, nodes: Floats, n: int) -> None:
    """Record the state of all lanes."""
    base = n * STATE * LANES
    for i in range(STATE * LANES):
        nodes[base + i] = s[i]
    for i in range(LANES):
        z = s[lane.Z + i]
        s[lane.LOWEST + i] = z if z < s[lane.LOWEST + i] else s[lane.LOWEST + i]
        s[lane.HIGHEST + i] = z if z > s[lane.HIGHEST + i] else s[lane.HIGHEST + i]
