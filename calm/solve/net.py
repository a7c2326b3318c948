"""A net of legs: lines with more ends than one free and one anchored, joined at nodes.

Every leg is passed by the march of a single line: from its free end, if it has one, else from its
upper end with a pull on it that is unknown. Unknown are besides the depths of the free ends and the
places of the nodes; asked is that every leg ends where it is held and that the pulls at every node
balance. Newton's method, by differences of the marches on segments that stay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from typing import Any

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.closure import closure
from calm.physics.compiled import entry
from calm.physics.line import Floats, Line, Water
from calm.physics.march import Cuts
from calm.physics.passing import (
    FAILURE,
    FX,
    FY,
    FZ,
    HANGING,
    LANDED,
    LEFT,
    NODES,
    USED,
    How,
    Z,
    pass_line,
)
from calm.physics.referee import RefereeShape, element_loads, find_ends, worst_moment
from calm.physics.seabed import lay_line
from calm.physics.state import COLUMNS, FAILURES, GOES_ON, NO_ROOM, MarchError, Trace
from calm.physics.track import Load
from calm.solve.audit import referee_of
from calm.solve.closing import place
from calm.solve.finish import refuse_unbalanced, risen, touching
from calm.solve.net_start import NetStart, start_of
from calm.solve.problem import BELOW, CHANGED, Unknown, problem_of
from calm.solve.solution import Settings, Solution, Status
from calm.solve.speed import expect_many, runs_compiled

MOST_LEGS = 40
MOST_STEPS, HALVINGS = 60, 9
"""Newton steps towards a shape, and how often one is halved that leads nowhere."""
NEAR, CLOSED = 1e-4, 1e-10
"""What is left of lengths and forces, as shares of the longest leg and of a typical force: before
segments are kept, and in a shape."""
MARCHES_PER_LINE = 30
"""Marches that take as long as a mooring."""
WORTH = 5e-5
"""Errors, as shares of the water depth, above which segments are halved once more."""
MOST_HALVINGS = 3


@dataclass(frozen=True)
class LegEnd:
    """Where a leg ends: free, at a node, or held.

    Attributes
    ----------
    node : its number; -1 where it ends at none
    place : east, north and up [m] of an end that is held; None where it is not
    seabed : height of the seabed below an anchor [m]; -inf where the end stands on none
    """

    node: int = -1
    place: tuple[float, float, float] | None = None
    seabed: float = -inf

    @property
    def free(self) -> bool:
        """Return whether nothing holds it."""
        return self.node < 0 and self.place is None


@dataclass(frozen=True)
class NetLeg:
    """A leg of a net: its line from its upper to its lower end, without an anchor."""

    line: Line
    upper: LegEnd
    lower: LegEnd


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
    """

    legs: tuple[Solution, ...]
    nodes: Floats
    imbalance: Floats
    miss: float
    depth_error: float
    tension_error: float
    marches: int


@dataclass
class _Passed:
    """Where a leg came out: from where it was begun [m], and the force there [N]."""

    way: Floats
    end: float
    force: Floats
    landed: bool


STANDING, HANGING_DOWN, PULLED = range(3)


@dataclass
class _Course:
    """A leg as it is marched."""

    leg: NetLeg
    water: Water
    settings: Settings
    compiled: bool
    cuts: Cuts | None = None
    lands: bool = False
    marches: int = field(default=0)

    def __post_init__(self) -> None:
        leg, line = self.leg, self.leg.line
        self.start, self.end = leg.upper, leg.lower
        if leg.upper.free:
            self.kind = STANDING
        elif leg.lower.free:
            self.kind, self.start, self.end = HANGING_DOWN, leg.lower, leg.upper
            line = replace(line.reversed(), towed=True)
        else:
            self.kind, line = PULLED, replace(pulled(line, (0.0, 0.0, 0.0)), towed=True)
        self.line = line
        self.problem = problem_of(line, self.water, self.settings, compiled=False, room=1)
        self.course, self.sea = self.problem.course, self.problem.sea
        if self.compiled:
            laid = problem_of(line, self.water, self.settings, compiled=True, room=1)
            self.course, self.sea = laid.course, laid.sea
        self.room, self.share, self.nodes = 512, 1.0, 0
        self.stands = max(self.line.length[0], 0.5) if len(self.line.length) else 0.5
        self.hanging, self.stage, self.grounded = -1.0, -1, 0.0
        self.longest = max(
            float(leg.line.length.sum()) * 0.01, min(0.01 * self.water.depth, 50.0) * 0.1
        )

    @property
    def unknowns(self) -> int:
        return 3 if self.kind == PULLED else 1

    def passed(self, x: Floats, z: float, step: float) -> _Passed:
        """March the leg from its unknowns, with its start at a height [m] where that is held.

        Raises
        ------
        MarchError
        """
        depth, out = self._loaded(x, z)
        how = How(
            step, np.degrees(step) * self.longest, 0.0, len(self.course.stages), self.lands,
            self.cuts is not None, True,
        )  # fmt: skip
        self.marches += 1
        while True:
            room = self.room if self.cuts is None else len(self.cuts.lengths)
            stages, loads = len(self.course.stages), len(self.course.loads)
            cables, most = len(self.course.cables), 2 * (room + 3 * loads + 2 * stages + 2)
            lengths, counts = self.cuts or (np.zeros(room), np.zeros(cables, np.int64))
            given: tuple[object, ...] = (lengths.copy(), counts.copy(), np.empty((COLUMNS, most)),
                                         np.zeros(LEFT))  # fmt: skip
            if not self.compiled:
                given = (lengths.tolist(), counts.tolist(),
                         [[0.0] * most for _ in range(COLUMNS)], [0.0] * LEFT)  # fmt: skip
            asked = (self.course, self.sea, how, float(depth), float(out), *given)
            (entry(pass_line, *asked) if self.compiled else pass_line)(*asked)  # type: ignore[arg-type]
            used, counted, self.record, left = given
            if left[FAILURE] != NO_ROOM:  # type: ignore[index]
                break
            self.room *= 8
        return self._came_out(used, counted, left)

    def _came_out(self, used: Any, counted: Any, left: Any) -> _Passed:
        if left[FAILURE] != GOES_ON:
            raise MarchError(FAILURES[int(left[FAILURE])])
        if self.cuts is None:
            self.last = Cuts(np.array(used[: int(left[USED])]), np.array(counted, np.int64))
        else:
            self.last = self.cuts
        self.nodes, force = int(left[NODES]), np.array([left[FX], left[FY], left[FZ]])
        self.hung, self.stage, self.hanging = self.nodes, int(left[LANDED]), float(left[HANGING])
        self.grounded, end, landed = 0.0, float(left[Z]), int(left[LANDED]) >= 0
        record = self.record
        if landed:
            limits = self.problem.limits
            self.nodes, self.grounded = lay_line(
                self.problem.course, record, self.nodes, self.stage, self.hanging,
                float(force[0]), float(force[1]), self.leg.lower.seabed, limits.excess,
                limits.friction,
            )  # fmt: skip
            force = np.array([record[k][self.nodes - 1] for k in (3, 4, 5)])
        last = self.nodes - 1
        way = np.array([record[k][last] - record[k][0] for k in range(2)])
        return _Passed(way, end, force, landed)

    def _loaded(self, x: Floats, z: float) -> tuple[float, float]:
        """Set what is unknown; the depth of the start and what of a float stands out of it [m]."""
        if self.kind == PULLED:
            first = Load(0, -1, 0.0, 0.5, 0.0, float(x[2]), 0.0, 0.0, 0.0, 0, 0.0,
                         float(x[0]), float(x[1]), 0.0, 0.0)  # fmt: skip
            self.problem.course.loads[0] = first  # type: ignore[index]
            changed, depth, out = 1, -z, 0.0
        else:
            self.share, sought, shallow = 1.0, BELOW, float(x[0])
            if self.kind == STANDING and shallow < 0.0 and self.problem.surfacing:
                sought, self.share = 0, 1.0 + shallow / self.stands
                shallow = self.share
            unknown = Unknown(0.0, sought, self.problem.limits.rides, False, 0)
            before = int(self.problem.work.left[CHANGED])
            depth, out = place(self.problem, unknown, shallow)
            changed = max(before, int(self.problem.work.left[CHANGED]))
        if self.compiled:
            for i in range(changed):
                self.course.loads[i] = tuple(self.problem.course.loads[i])  # type: ignore[index]
        return depth, out

    @property
    def goal(self) -> float | None:
        """Height at which an end that is held is to come out [m]."""
        if self.end.place is None:
            return None
        return self.end.seabed if self.lands else self.end.place[2]

    def solution(self, x: Floats, ends: Floats, errors: tuple[float, float]) -> Solution:
        """The leg as a line of its own, audited.

        Parameters
        ----------
        x : its unknowns
        ends : (3,) where it ends [m]
        errors : of depths [m] and of tensions [N]

        Raises
        ------
        NoEquilibrium
        """
        trace, line = Trace.of(self.record, self.nodes), self.line
        position = trace.position
        position[:, :2] += ends[:2] - position[-1, :2]
        if self.kind == PULLED:
            line = replace(pulled(self.leg.line, (x[0], x[1], x[2])), towed=True)
        carried = self._carried(line)
        closure, moment = self._audited(carried)
        first = 1 if self.kind == PULLED else 0
        afloat = self.kind == STANDING and bool(x[0] < 0.0 and self.problem.surfacing)
        floating = line.floating
        riding = floating.riding(self.share) if afloat and floating is not None else None
        lift = float(self.problem.surfacing[0].surface_lift) if afloat else 0.0
        if self.kind == PULLED:
            line = carried = self.leg.line
        return Solution(
            line=line,
            water=self.water,
            settings=self.settings,
            position=position[first:],
            force=trace.force[first:],
            element_piece=trace.piece[first:] - first,
            element_clamp=trace.clamp[first:],
            landed=self.stage >= 0,
            hanging=self.hung - 1 - first,
            grounded_length=self.grounded,
            cut=trace.cut[first:],
            strain=trace.strain[first:],
            afloat=(int(self.problem.surfacing[0].piece),) if afloat else (),
            buoyancy_used=self.share,
            reserve=(1.0 - self.share) * lift,
            carried=carried,
            riding=riding,
            marches=self.marches,
            segments=len(self.last.lengths),
            miss=0.0,
            depth_error=errors[0],
            tension_error=errors[1],
            lift_error=errors[1],
            pull_error=errors[1],
            closure=closure,
            moment_residual=moment,
            pulled=self.kind == PULLED,
        )

    def _carried(self, line: Line) -> Line:
        """The line as it is loaded, its float at the surface by what is in the water."""
        names = {"buoyancy", "volume", "normal_drag", "tangential_drag", "lift", "push_east",
                 "push_north"}  # fmt: skip
        columns = {name: getattr(line, name).copy() for name in names}
        clamps = {"clamp_buoyancy": "buoyancy", "clamp_volume": "volume",
                  "clamp_drag": "normal_drag", "clamp_lift": "lift"}  # fmt: skip
        columns |= {name: getattr(line, name).copy() for name in clamps}
        for i in range(int(self.problem.work.left[CHANGED])):
            load = self.problem.course.loads[i]
            if load.clamp < 0:
                for name in names:
                    columns[name][load.piece] = getattr(load, name)
            else:
                for name, of in clamps.items():
                    columns[name][load.clamp] = getattr(load, of)
        return replace(line, **columns)

    def _audited(self, line: Line) -> tuple[float, float]:
        """Closure and moment residual of the last march, recomputed from its coordinates."""
        referee = referee_of(line, self.water, 0.0, False)
        record = [list(column[: self.nodes]) for column in self.record]
        shape = RefereeShape(record, self.nodes, self.hung - 1, referee.first, referee.last)
        find_ends(shape)
        loads = [[0.0] * self.nodes for _ in range(3)]
        element_loads(referee.moored, shape, loads)
        limits = self.problem.limits
        off = closure(
            referee.moored, shape, loads, self.stage >= 0, limits.friction, limits.excess
        )
        return off, worst_moment(referee.moored, shape, loads)


def pulled(line: Line, force: tuple[float, float, float]) -> Line:
    """The line below a piece without length that stands for the pull on its upper end [N]."""
    columns = {
        name: np.concatenate([[0.0], getattr(line, name)])
        for name in (
            "length", "volume", "normal_drag", "tangential_drag", "compliance", "thinning", "lift",
            "diameter",
        )
    }  # fmt: skip
    flags = {
        name: np.concatenate([[False], getattr(line, name)]) for name in ("flexible", "directional")
    }
    east, north, up = force
    return replace(
        line,
        **columns,
        **flags,
        buoyancy=np.concatenate([[up], line.buoyancy]),
        push_east=np.concatenate([[east], line.push_east]),
        push_north=np.concatenate([[north], line.push_north]),
        clamp_piece=line.clamp_piece + 1,
        elongation=(None, *line.elongation) if line.elongation else (),
        drag_curve=(None, *line.drag_curve) if line.drag_curve else (),
        floating=None,
    )


class _Net:
    """All legs, and what is unknown of them: of each leg its own, then the places of the nodes."""

    def __init__(
        self, legs: tuple[NetLeg, ...], nodes: int, water: Water, settings: Settings
    ) -> None:
        compiled = runs_compiled(settings)
        self.courses = [_Course(leg, water, settings, compiled) for leg in legs]
        self.nodes, self.water, self.settings = nodes, water, settings
        self.at: list[int] = list(
            np.concatenate([[0], np.cumsum([each.unknowns for each in self.courses])])
        )
        self.size = self.at[-1] + 3 * nodes
        self.length = max(float(leg.line.length.sum()) for leg in legs)
        lifts = [float(np.abs(leg.line.net_force(np.zeros(len(leg.line.length)))).sum())
                 for leg in legs]  # fmt: skip
        self.force = max(*lifts, 1.0)
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
            if each.kind == PULLED:
                x[self.at[i] : self.at[i + 1]] = start.pull[i]
            else:
                free = start.first[i] if each.kind == STANDING else start.lower[i]
                x[self.at[i]] = -free[2]
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
        first = self.at[-1]
        jump = 1e-6
        for i, each in enumerate(self.courses):
            mine = slice(self.at[i], self.at[i + 1])
            kept, cuts = each.cuts, None
            base = self._leg(each, x[mine], x, step)
            cuts = each.last
            self._put(found, i, base, x, whole=True)
            if not slopes:
                continue
            each.cuts = cuts
            variables = list(range(self.at[i], self.at[i + 1]))
            if each.kind == PULLED and each.start.node >= 0:
                variables.append(first + 3 * each.start.node + 2)
            reference = base if kept is not None else self._leg(each, x[mine], x, step)
            for variable in variables:
                moved = x.copy()
                moved[variable] += jump * self.scale[variable]
                other = self._leg(each, moved[mine], moved, step)
                change = np.zeros(self.size)
                self._put(change, i, other, moved, whole=False)
                before = np.zeros(self.size)
                self._put(before, i, reference, x, whole=False)
                jacobian[:, variable] += (change - before) / jump
            each.cuts = kept
            self._direct(jacobian, i)
        return found / self.rows, jacobian / self.rows[:, None]

    def _leg(self, each: _Course, own: Floats, x: Floats, step: float) -> _Passed:
        z = float(self.place_of(each.start, x)[2]) if each.kind == PULLED else 0.0
        return each.passed(own, z, step)

    def _put(self, row: Floats, i: int, out: _Passed, x: Floats, *, whole: bool) -> None:
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

    def in_water(self, water: Water) -> _Net:
        """The same net in other water."""
        other = _Net(tuple(each.leg for each in self.courses), self.nodes, water, self.settings)
        for mine, its in zip(self.courses, other.courses, strict=True):
            its.lands = mine.lands
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
    legs: Sequence[NetLeg], nodes: int, water: Water, settings: Settings | None = None
) -> NetSolution:
    """Solve for the equilibrium of a net of legs.

    Parameters
    ----------
    legs : their ends at nodes, held, or free
    nodes : how many nodes there are
    water, settings : as for `solve_mooring`

    Raises
    ------
    NoEquilibrium
        None was found, or what was found does not pass the checks.
    """
    legs, settings = tuple(legs), settings or Settings()
    expect_many(4.0 * len(legs))
    net, x = _roughly(legs, nodes, water, settings)
    marches = sum(each.marches for each in net.courses)
    for _ in range(len(legs) + 1):
        x = _finely(net, x, 2.0 * settings.angle_step)
        if not _lands_elsewhere(net, x):
            break
        closer = net.closed(x, 4.0 * settings.angle_step, NEAR)
        if closer is None:
            raise _unsettled("a leg comes to lie on the seabed and not")
        x = closer
    else:
        raise _unsettled("a leg comes to lie on the seabed and not")
    coarse = net.ends(x)
    for _ in range(MOST_HALVINGS):
        for each in net.courses:
            assert each.cuts is not None
            each.cuts = each.cuts.halved()
        x = _closed_or_refused(net, x, settings.angle_step)
        fine = net.ends(x)
        pairs = list(zip(coarse, fine, strict=True))
        depth = max(float(np.abs(a[0] - b[0]).max()) for a, b in pairs)
        tension = max(float(np.abs(a[1] - b[1]).max()) for a, b in pairs)
        coarse = fine
        if 0.5 * depth <= WORTH * water.depth:
            break
    marches += sum(each.marches for each in net.courses)
    return _told(net, x, 0.5 * depth, 0.5 * tension, marches)


def _told(net: _Net, x: Floats, depth: float, tension: float, marches: int) -> NetSolution:
    """The solution, every leg audited and every node in balance."""
    found, _ = net.residual(x, net.settings.angle_step, slopes=False)
    found = np.abs(found * net.rows)
    first = net.at[-1]
    miss = float(found[:first].max())
    if miss > net.settings.tolerance * net.water.depth:
        raise _unsettled(f"a leg misses its end by {miss:.2g} m")
    imbalance = np.linalg.norm(found[first:].reshape(-1, 3), axis=1)
    errors = depth + miss + 1e-9 * net.length, tension + 1e-8 * net.force
    legs = []
    for i, each in enumerate(net.courses):
        end = net.place_of(each.end, x)
        legs.append(each.solution(x[net.at[i] : net.at[i + 1]], end, errors))
    greatest = max(float(each.tension.max()) for each in legs)
    if len(imbalance) and float(imbalance.max()) > 1e-6 * greatest:
        raise _unsettled(f"the pulls at a node leave {imbalance.max():.2g} N over")
    before = 0
    for each, leg in zip(net.courses, legs, strict=True):
        refuse_unbalanced(leg.closure, leg.moment_residual)
        _refuse_misplaced(each, leg, errors[0], before)
        before += len(each.leg.line.length)
    return NetSolution(
        tuple(legs), x[first:].reshape(-1, 3).copy(), imbalance, miss, *errors, marches
    )


def _roughly(
    legs: tuple[NetLeg, ...], nodes: int, water: Water, settings: Settings
) -> tuple[_Net, Floats]:
    """A net about closed, sought where it about is, and from still water on.

    Raises
    ------
    NoEquilibrium
    """
    net, step = _Net(legs, nodes, water, settings), 4.0 * settings.angle_step
    x = net.closed(net.begin(start_of(legs, nodes, water)), step, NEAR)
    if x is not None:
        return net, x
    before = net.in_water(water.still())
    x = before.closed(before.begin(start_of(legs, nodes, water.still())), step, NEAR)
    if x is None:
        raise _unsettled("not even in still water do its legs come together")
    way, stride = 0.0, 0.25
    while way < 1.0:
        following = min(way + stride, 1.0)
        moving = replace(water, u=following * water.u, v=following * water.v, w=following * water.w)
        net = before.in_water(moving if following < 1.0 else water)
        closer = net.closed(x, step, NEAR)
        if closer is None:
            stride *= 0.5
            if stride < 0.01:
                raise _unsettled(f"beyond {way:.0%} of the current its legs do not come together")
            continue
        x, way, before = closer, following, net
    return net, x


def _finely(net: _Net, x: Floats, step: float) -> Floats:
    net.keep_cuts(x, step)
    return _closed_or_refused(net, x, step)


def _closed_or_refused(net: _Net, x: Floats, step: float) -> Floats:
    closer = net.closed(x, step, CLOSED)
    if closer is None:
        raise _unsettled("its legs do not come together to the last digits")
    net.residual(closer, step, slopes=False)
    return closer


def _lands_elsewhere(net: _Net, x: Floats) -> bool:
    """Whether a leg lies on the seabed that was taken to hang clear, or the other way round."""
    changed = False
    for each in net.courses:
        if not isfinite(each.leg.lower.seabed) or each.kind == HANGING_DOWN:
            continue
        lowest = min(each.record[2][: each.hung])
        lies = each.stage >= 0 if each.lands else bool(
            lowest < each.leg.lower.seabed - 1e-6 * net.water.depth
        )
        if lies != each.lands:
            each.lands, changed = lies, True
    return changed


def _refuse_misplaced(each: _Course, leg: Solution, near: float, before: int) -> None:
    """Refuse a leg that is out of the water, or in the seabed where it cannot lie."""
    near += 1e-6 * each.water.depth
    height, hung = leg.position[:, 2], leg.position[: leg.hanging + 1, 2]
    turned = each.kind == HANGING_DOWN
    bed = each.leg.lower.seabed if isfinite(each.leg.lower.seabed) else -each.water.depth
    worst = int(np.argmin(hung))
    pieces = len(each.leg.line.length)

    def piece(node: int) -> int:
        own = leg.piece_at(node)
        return before + (pieces - 1 - own if turned else own)

    if hung[worst] < bed - near:
        raise touching(piece(worst), float(bed - hung[worst]))
    if leg.afloat:
        height = np.where(np.arange(len(height)) > leg.piece_nodes[leg.afloat[0], 1], height, 0.0)
        if leg.buoyancy_used < 0.0:
            raise Status.ABOVE_SURFACE.because(
                "More than the float at the upper end of {piece} would come to the surface.",
                piece(0),
            )
    highest = int(np.argmax(height))
    if height[highest] > near:
        raise risen(piece(highest), float(height[highest]))


def _unsettled(why: str) -> NoEquilibrium:
    return Status.NOT_CONVERGED.because(
        f"The net does not come to rest: {why}.",
        advice="Check the lengths of its legs against the distances of their ends; solve it with "
        "fewer legs, or with less current, to find what prevents it.",
    )
