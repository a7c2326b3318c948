"""A leg of a net as it is marched: from its free end, or from its upper end with a pull on it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf, isfinite
from typing import Any

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.compiled import entry
from calm.physics.line import (
    COLUMNS,
    FAILURES,
    GOES_ON,
    NO_ROOM,
    Floats,
    Line,
    MarchError,
    Trace,
    Water,
)
from calm.physics.march import NO_CUTS, Cuts
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
from calm.physics.referee import RefereeShape
from calm.physics.seabed import lay_line
from calm.physics.track import Load
from calm.solve.audit import referee_of
from calm.solve.closing import place
from calm.solve.finish import risen, touching
from calm.solve.problem import BELOW, CHANGED, Unknown, problem_of
from calm.solve.search import residuals
from calm.solve.solution import Settings, Solution, Status


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


@dataclass
class Passed:
    """Where a leg came out: from where it was begun [m], and the force there [N]."""

    way: Floats
    end: float
    force: Floats
    landed: bool


STANDING, HANGING_DOWN, PULLED = range(3)


@dataclass
class LegCourse:
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
        ends = (end.place[2] for end in (leg.upper, leg.lower) if end.place is not None)
        self.highest = max(0.0, *ends, 0.0)
        self.stands = max(self.line.length[0], 0.5) if len(self.line.length) else 0.5
        self.hanging, self.stage, self.grounded, self.hung = -1.0, -1, 0.0, 0
        self.record: Any = ()
        self.last = NO_CUTS
        self.longest = max(
            float(leg.line.length.sum()) * 0.01, min(0.01 * self.water.depth, 50.0) * 0.1
        )

    @property
    def unknowns(self) -> int:
        return 3 if self.kind == PULLED else 1

    def passed(self, x: Floats, z: float, step: float) -> Passed:
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
            given: tuple[Any, ...] = (lengths.copy(), counts.copy(), np.empty((COLUMNS, most)),
                                         np.zeros(LEFT))  # fmt: skip
            if not self.compiled:
                given = (lengths.tolist(), counts.tolist(),
                         [[0.0] * most for _ in range(COLUMNS)], [0.0] * LEFT)  # fmt: skip
            asked: Any = (self.course, self.sea, how, float(depth), float(out), *given)
            (entry(pass_line, *asked) if self.compiled else pass_line)(*asked)
            used, counted, self.record, left = given
            if left[FAILURE] != NO_ROOM:
                break
            self.room *= 8
        return self._came_out(used, counted, left)

    def _came_out(self, used: Any, counted: Any, left: Any) -> Passed:
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
        return Passed(way, end, force, landed)

    def _loaded(self, x: Floats, z: float) -> tuple[float, float]:
        """Set what is unknown; the depth of the start and what of a float stands out of it [m]."""
        if self.kind == PULLED:
            first = Load(0, -1, 0.0, 0.5, 0.0, float(x[2]), 0.0, 0.0, 0.0, 0, 0.0,
                         float(x[0]), float(x[1]), 0.0, 0.0)  # fmt: skip
            loads: Any = self.problem.course.loads
            loads[0] = first
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
            packed: Any = self.course.loads
            for i in range(changed):
                packed[i] = tuple(self.problem.course.loads[i])
        return depth, out

    def lies_otherwise(self) -> bool:
        """Whether it lies on the seabed but was taken to hang clear, or the other way round.

        It is taken to do so from then on.
        """
        if not isfinite(self.leg.lower.seabed) or self.kind == HANGING_DOWN:
            return False
        lowest = min(self.record[2][: self.hung])
        deeper = bool(lowest < self.leg.lower.seabed - 1e-6 * self.water.depth)
        before = self.lands
        self.lands = self.stage >= 0 if before else deeper
        return self.lands != before

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
        columns: dict[str, Any] = {name: getattr(line, name).copy() for name in names}
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
        referee = referee_of(line, self.water, 0.0, self.compiled)
        shape = RefereeShape(self.record, self.nodes, self.hung - 1, referee.first, referee.last)
        loads: Any = np.zeros((3, self.nodes))
        asked = (
            referee.moored, shape, loads if self.compiled else loads.tolist(), self.stage >= 0,
            self.problem.limits,
        )  # fmt: skip
        law = entry(residuals, *asked) if self.compiled else residuals
        off, moment = law(*asked)
        return off, moment


def pulled(line: Line, force: tuple[float, float, float]) -> Line:
    """The line below a piece without length that stands for the pull on its upper end [N]."""
    columns: dict[str, Any] = {
        name: np.concatenate([[0.0], getattr(line, name)])
        for name in (
            "length", "volume", "normal_drag", "tangential_drag", "compliance", "thinning", "lift",
            "diameter",
        )
    }  # fmt: skip
    flags: dict[str, Any] = {
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


def refuse_misplaced(each: LegCourse, leg: Solution, near: float, before: int) -> None:
    """Refuse a leg that is out of the water, or in the seabed where it cannot lie."""
    near += 1e-6 * each.water.depth
    height, hung = leg.position[:, 2], leg.position[: leg.hanging + 1, 2]
    bed = each.leg.lower.seabed if isfinite(each.leg.lower.seabed) else -each.water.depth
    worst, pieces = int(np.argmin(hung)), len(each.leg.line.length)

    def piece(node: int) -> int:
        own = leg.piece_at(node)
        return before + (pieces - 1 - own if each.kind == HANGING_DOWN else own)

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
    if height[highest] > near + each.highest:
        raise risen(piece(highest), float(height[highest]))


def unsettled(why: str) -> NoEquilibrium:
    """Why a net does not come to rest, with advice."""
    return Status.NOT_CONVERGED.because(
        f"The net does not come to rest: {why}.",
        advice="Check the lengths of its legs against the distances of their ends; solve it with "
        "fewer legs, or with less current, to find what prevents it.",
    )
