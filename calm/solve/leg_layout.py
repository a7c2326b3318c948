"""Preparation of a net's legs for the march, and conversion of a solved leg to a single line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import Any

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.compiled import outcome
from calm.physics.hull import HullRow, SurfaceFloat
from calm.physics.law_kinds import record_type
from calm.physics.line import Bed, Floats, Line, Water, off_bed
from calm.physics.referee import RefereeShape
from calm.physics.stretch import Knot
from calm.physics.strumming import AT_REST
from calm.physics.track import CableStretch, Course, Load, Stage
from calm.solve import leg_numbers
from calm.solve.accuracy import Errors
from calm.solve.audit import referee_of
from calm.solve.closing import Closed, Root
from calm.solve.finish import carried_by, risen, solution_of, touching
from calm.solve.leg_from_below import course_from_below, weight_of
from calm.solve.leg_numbers import LegRow, NetProblem
from calm.solve.line_shape import not_audited
from calm.solve.problem import (
    BELOW,
    CHANGED,
    FINE,
    ROUGH_REACH,
    BuoyantPiece,
    LineProblem,
    SearchArrays,
    Unknown,
    problem_of,
    work_for,
)
from calm.solve.search import residuals
from calm.solve.solution import FOUND, Settings, Solution, Status


@dataclass(frozen=True)
class LegEnd:
    """End of a leg, which is free, at a node, or held at a fixed position.

    Attributes
    ----------
    node : number of the node, or -1
    place : east, north and up position of a held end [m]
    seabed : height of the seabed below an anchor [m]; -inf without an anchor
    deeper : slope of the seabed below an anchor, as depth increase per metre east and north
    past : current at this end [m/s], if the end is held and vortex shedding at this end sets the
        strumming frequency of the leg
    """

    node: int = -1
    place: tuple[float, float, float] | None = None
    seabed: float = -inf
    deeper: tuple[float, float] = (0.0, 0.0)
    past: tuple[float, float, float] | None = None

    @property
    def free(self) -> bool:
        """Whether the end is neither at a node nor held."""
        return self.node < 0 and self.place is None


@dataclass(frozen=True)
class NetLeg:
    """A leg of a net. Its line is listed from the upper to the lower end, without an anchor."""

    line: Line
    upper: LegEnd
    lower: LegEnd


@dataclass(frozen=True)
class LaidLeg:
    """A leg prepared for the march, with the `LineProblem` of its line.

    The pieces of the line begin at the upper end of the leg, unless the lower end is free.
    """

    leg: NetLeg
    line: Line
    kind: int
    problem: LineProblem

    @property
    def ends(self) -> tuple[LegEnd, LegEnd]:
        """The upper and the lower end of the leg, or the lower end first if it is free."""
        upper, lower = self.leg.upper, self.leg.lower
        return (lower, upper) if self.kind == leg_numbers.HANGING_DOWN else (upper, lower)

    @property
    def unknowns(self) -> int:
        """Number of unknowns of the leg.

        The height of the touchdown is one of the unknowns on a sloping seabed.
        """
        if self.kind == leg_numbers.ANCHORED:
            return 3 + any(self.bed[:2])
        return 3 if self.kind == leg_numbers.PULLED else 1

    @property
    def below_a_point(self) -> bool:
        """Whether the line of the leg begins with a point load for the pull on its end."""
        return self.kind in (leg_numbers.PULLED, leg_numbers.ANCHORED)

    @property
    def shedding(self) -> tuple[float, float, float, float]:
        """Vortex shedding at the end of the march: St/D [1/m], and the current [m/s].

        St is the Strouhal number, and D the cable diameter.
        """
        model, diameter, past = self.line.strumming, self.line.diameter, self.ends[1].past
        if model is None or past is None or not diameter.any():
            return 0.0, 0.0, 0.0, 0.0
        return model.strouhal / float(diameter[diameter > 0.0][-1]), *past

    @staticmethod
    def of(leg: NetLeg, water: Water, settings: Settings, rough: bool) -> LaidLeg:
        """Prepare a leg for the march. The parameter `rough` is as in `problem_of`."""
        line = leg.line
        if leg.upper.free:
            kind = leg_numbers.STANDING
        elif leg.lower.free:
            kind, line = leg_numbers.HANGING_DOWN, replace(line.reversed(), towed=True)
        else:
            kind = leg_numbers.ANCHORED if isfinite(leg.lower.seabed) else leg_numbers.PULLED
            line = replace(line.below_a_point(), towed=True, floating=None)
        problem = problem_of(line, water, settings, compiled=False, rough=rough, room=1)
        return LaidLeg(leg, line, kind, problem)

    def row(self, first: int, span: float) -> LegRow:
        """Return the data of the leg in the form that compiled code uses.

        Parameters
        ----------
        first : index of the first unknown of the leg
        span : as in `NetProblem`
        """
        (start, end), (course, limits) = self.ends, (self.problem.course, self.problem.limits)
        length, counted = self.leg.line.length, (len(course.stages), course.landing)
        rough = ROUGH_REACH * limits.depth if limits.near > 0.0 else 0.0
        lower, (lying, weight) = self.leg.lower, self.may_lie
        rise = lower.place[2] - lower.seabed if lower.place and isfinite(lower.seabed) else 0.0
        return LegRow(
            self.kind, first, self.unknowns, start.node, end.node, lower.seabed, rise,
            rise * weight / lying if lying > 0.0 else 0.0, *self.bed[:2],
            max(float(length.sum()) * 0.01, min(0.01 * span, 50.0) * 0.1, rough),
            self.surface_range, self.highest, int(limits.rides), *self.shedding, self.weight,
            *counted, len(course.cables), len(self.problem.surfacing),
            len(self.problem.hull), len(self.line.length),
        )  # fmt: skip

    @property
    def surface_range(self) -> float:
        """Scale that converts the buoyancy fraction of a surface float to a length [m].

        Newton's method uses this length as the unknown. The scale equals the length of the leg, but
        is at least 0.5 m.
        """
        # so long that a Newton step does not skip the range
        return max(float(self.line.length.sum()), 0.5)

    @property
    def bed(self) -> Bed:
        """The seabed below the leg, with its slope and friction."""
        lower, bed = self.leg.lower, self.problem.limits.bed
        own = lower.deeper if isfinite(lower.seabed) else bed[:2]
        return bed._replace(east=own[0], north=own[1])

    @property
    def weight(self) -> float:
        """Sum of the absolute net forces of all pieces [N], but at least 1 mN."""
        line = self.leg.line
        return max(float(np.abs(line.net_force(np.zeros(len(line.length)))).sum()), 1e-3)

    @property
    def may_lie(self) -> tuple[float, float]:
        """Length [m] and weight in water [N] of the part of the leg that may lie on the seabed."""
        course = self.problem.course
        stages = course.stages[max(course.landing, 1) :] if isfinite(self.leg.lower.seabed) else []
        weights = [weight_of(course, stage, self.bed.excess) for stage in stages]
        return sum(stage.length for stage in stages), sum(weights)

    def most_lying(self, height: float) -> float:
        """Return the largest weight of a leg's line that can lie on the seabed [N].

        The weight is inf if no part of the leg may touch the seabed.

        Parameters
        ----------
        height : height of the leg's upper end above the seabed [m]
        """
        course, suspended, weight = self.problem.course, max(height, 0.0), 0.0
        if self.may_lie[1] <= 0.0:
            return inf
        for number, stage in enumerate(course.stages):
            own = weight_of(course, stage, self.bed.excess) if number >= course.landing else 0.0
            share = (
                min(suspended / stage.length, 1.0) if stage.length > 0.0 else float(suspended > 0.0)
            )
            weight, suspended = weight + (1.0 - share) * own, max(suspended - stage.length, 0.0)
        return weight

    @property
    def highest(self) -> float:
        """Largest allowed height of any part of the leg [m].

        The limit is the surface, or a held end if this end is above the surface.
        """
        return max(0.0, *(each.place[2] for each in self.ends if each.place is not None), 0.0)


def lay_net(laid: Sequence[LaidLeg], nodes: int, compiled: bool, room: int) -> NetProblem:
    """Prepare a net for the search, with work arrays for up to `room` segments per leg."""
    firsts = [0, *np.cumsum([each.unknowns for each in laid]).tolist()]
    size, problems = firsts[-1] + 3 * nodes, [each.problem for each in laid]
    courses = [each.course for each in problems]
    length = max(float(each.leg.line.length.sum()) for each in laid)
    force = max(1.0, *(each.weight for each in laid))
    anchored = any(isfinite(each.leg.lower.seabed) for each in laid)
    span = problems[0].limits.depth if anchored else length
    scale, rows = np.full(size, length), np.full(size, length)
    rows[firsts[-1] :] = force
    for first, each in zip(firsts, laid, strict=False):
        if each.unknowns > 1:
            scale[first : first + 3] = each.weight

    stack: Any = np.stack if compiled else list
    no_sea: Any = None

    def taken(array: Any) -> Any:
        return array if compiled else array.tolist()

    def zeros(*shape: int, of: type = float) -> Any:
        return taken(np.zeros(shape, of))

    def stacked(kind: type, given: list[Any]) -> Any:
        if not compiled:
            return [list(row) for row in given]
        array: Any = np.zeros((len(given), max(map(len, given))), record_type(kind))
        for mine, row in zip(array, given, strict=True):
            mine[: len(row)] = [tuple(each) for each in row]
        return array

    def listed(kind: type, given: list[Any]) -> Any:
        return stacked(kind, [given])[0]

    pieces, count = max(len(each.line.length) for each in laid), len(laid)
    most = courses[0]._replace(
        **{name: max((getattr(each, name) for each in courses), key=len)
           for name in ("stages", "loads", "cables")}
    )  # fmt: skip
    works: Any = zip(*[work_for(most, 1, room, compiled) for _ in laid], strict=True)
    vibrations = [each.vibration for each in courses if each.vibration != AT_REST]
    course = Course(
        stacked(Stage, [each.stages for each in courses]),
        stacked(Load, [each.loads for each in courses]),
        stacked(CableStretch, [each.cables for each in courses]),
        stacked(Knot, [each.knots for each in courses]),
        vibrations[0] if vibrations else AT_REST, 0,
    )  # fmt: skip
    lines = problems[0]._replace(
        course=course, loads=stacked(Load, [each.loads for each in problems]),
        surfacing=stacked(BuoyantPiece, [each.surfacing for each in problems]),
        afloat=listed(SurfaceFloat, [each.afloat for each in problems]),
        hull=stacked(HullRow, [each.hull for each in problems]),
        flexible=zeros(1, of=int), starts=zeros(count, 1), sea=no_sea,
        work=SearchArrays(*(stack(own) for own in works)),
    )  # fmt: skip
    below = [course_from_below(own) if each.below_a_point else own
             for own, each in zip(courses, laid, strict=True)]  # fmt: skip
    up = course._replace(
        stages=stacked(Stage, [each.stages for each in below]),
        loads=stacked(Load, [each.loads for each in below]),
        cables=stacked(CableStretch, [each.cables for each in below]),
    )
    places = [[*(end.place or (0.0, 0.0, 0.0))] for each in laid for end in each.ends]
    return NetProblem(
        listed(LegRow, [each.row(at, span) for at, each in zip(firsts, laid, strict=False)]), lines,
        up, zeros(2 * room), taken(np.array(places).reshape(-1, 6)),
        zeros(count, leg_numbers.OF_LEG), zeros(count, leg_numbers.OUT),
        zeros(count, pieces, of=int), zeros(count, pieces, of=int),
        zeros(size), zeros(size), zeros(size, size), zeros(size), zeros(size),
        zeros(size, size + 1), zeros(size, of=int), zeros(size), zeros(size), taken(scale),
        taken(rows), zeros(2),
        firsts[-1], length, force, span,
    )  # fmt: skip


def leg_found(
    laid: LaidLeg, net: NetProblem, i: int, ends: tuple[Floats, Floats],
    errors: tuple[float, float],
    water: Water, settings: Settings, compiled: bool,
) -> Solution:  # fmt: skip
    """Convert a solved leg to the audited solution of a single line.

    Parameters
    ----------
    ends : (3,) position of the leg's end in the fine and in the extrapolated shape [m]
    errors : errors of depths [m] and of tensions [N]
    """
    state, (deep, taut) = net.state[i], errors
    frequency = float(state[leg_numbers.FREQUENCY])
    work = SearchArrays(*(column[i] for column in net.lines.work))
    course = laid.problem.course._replace(loads=net.lines.course.loads[i])
    problem = laid.problem._replace(course=course, work=work)
    first = int(laid.below_a_point)
    if first:
        work.left[CHANGED] = 1.0  # the point load at the upper end
    share, landed = float(state[leg_numbers.SHARE]), bool(state[leg_numbers.STAGE] >= 0.0)
    sought = 0 if share < 1.0 and problem.surfacing else BELOW
    root = Root(True, Unknown(0.0, sought, problem.limits.rides, False, 0), share, 0.0, 0.0)
    closed = Closed(
        FOUND, 0.0, -1, root, int(state[leg_numbers.COUNT]), int(state[leg_numbers.SUSPENDED]) - 1,
        landed, float(state[leg_numbers.GROUNDED]), 2 * int(sum(work.counts)),
    )  # fmt: skip
    errors_found = Errors(deep, taut, 0.0, taut, taut)
    grounded = closed.grounded
    if landed and state[leg_numbers.COARSE_STAGE] >= 0.0:
        grounded += (grounded - float(state[leg_numbers.COARSE_GROUNDED])) / 3.0
    before = not_audited(closed, errors_found, share, grounded)
    found = solution_of(problem, laid.line, water, settings, before, frequency)
    referee = referee_of(carried_by(laid.line, problem), water, frequency, compiled)
    shape = RefereeShape(
        work.records[FINE], closed.nodes, closed.hanging, referee.first, referee.last
    )
    loads: Any = np.zeros((3, closed.nodes))
    arguments = (
        referee.moored, shape, loads if compiled else loads.tolist(), landed, problem.limits
    )  # fmt: skip
    closure, moment = outcome(residuals, compiled, *arguments)
    line, marched = laid.leg.line if first else found.line, found.marched
    assert marched is not None
    place, better = (np.array([*each[:2], 0.0]) for each in ends)
    return replace(
        found,
        line=line,
        carried=line if first else found.carried,
        position=found.position[first:] + better,
        force=found.force[first:],
        element_piece=found.element_piece[first:] - first,
        element_clamp=found.element_clamp[first:],
        hanging=found.hanging - first,
        cut=found.cut[first:],
        strain=found.strain[first:],
        marched=replace(
            marched, position=marched.position[first:] + place, force=marched.force[first:]
        ),
        marches=int(state[leg_numbers.MARCHES]),
        closure=closure,
        moment_residual=moment,
        pulled=bool(first),
        slack=float(state[leg_numbers.SLACK]),
    )


def refuse_misplaced(laid: LaidLeg, leg: Solution, near: float, before: int) -> None:
    """Raise NoEquilibrium if part of a leg is out of the water, or below the seabed.

    Parameters
    ----------
    near : error of depths [m]
    before : number of pieces in the preceding legs
    """
    depth = leg.water.depth
    near += 1e-6 * depth
    height, lower = leg.position[:, 2], laid.leg.lower
    foot = (*lower.place[:2], lower.seabed) if lower.place and isfinite(lower.seabed) else None
    suspended = leg.position[: leg.hanging + 1] - np.array(foot or (0.0, 0.0, -depth))
    above: Any = off_bed(laid.bed, *suspended.T)
    worst, pieces = int(np.argmin(above)), len(leg.line.length)

    def piece(node: int) -> int:
        own = leg.piece_at(node)
        return before + (pieces - 1 - own if laid.kind == leg_numbers.HANGING_DOWN else own)

    if above[worst] < -near:
        raise touching(piece(worst), -float(above[worst]))
    if leg.afloat:
        height = np.where(np.arange(len(height)) > leg.piece_nodes[leg.afloat[0], 1], height, 0.0)
        if leg.buoyancy_used < 0.0:
            raise Status.ABOVE_SURFACE.because(
                "Besides {piece}, other parts of the leg would surface.",
                piece(0),
            )
    highest = int(np.argmax(height))
    if height[highest] > near + laid.highest:
        raise risen(piece(highest), float(height[highest]))


def unsettled(why: str) -> NoEquilibrium:
    """Return the exception, with advice, for a net without equilibrium."""
    return Status.NOT_CONVERGED.because(
        f"No equilibrium of the net was found: {why}.",
        advice="Check the lengths of its legs against the distances between their ends. Solve the "
        "net with fewer legs or with a weaker current to find the cause.",
    )
