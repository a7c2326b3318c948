"""A line to be closed as the search takes it: plain numbers, and room to work in."""

from collections.abc import Callable, MutableSequence, Sequence
from math import degrees
from typing import Any, NamedTuple

import numpy as np

from calm.physics.compiled import record_type
from calm.physics.hull import NEVER_AFLOAT, HullRow, SurfaceFloat
from calm.physics.line import COLUMNS, Bed, Floats, Line, Water
from calm.physics.passing import LEFT
from calm.physics.profile import Interval, Profile, Sea
from calm.physics.track import ROD, Course, Load, Track
from calm.solve.solution import (
    SUPPORTED,
    Settings,
    standing_length,
    standing_lift,
    support_of,
    surface_lift,
)

COARSE_STEP = np.radians(4.0).item()
"""Angle step of the marches that only look for the neighbourhood of a root."""
REACH, ROUGH_REACH = 0.01, 0.013
"""Longest segment at an angle step of 1°, as a share of the span: of a line, and of one of many."""
ROOM, MANY_ROOM = 512, 256
"""Segments that there is room for at first, of one line and of many; where a line needs more, it is
solved with more."""
MOST_AFLOAT = 16
"""Floats at the surface one after the other: each is sought with all those above it."""
MOST_SAMPLES = 64
STARTS, FASTEST, START_ROWS = 41, 4.0, 7
"""Even currents in which a line is sought beforehand, the fastest [m/s], and what is known of each.
"""
SHARE_TOLERANCE = 1e-9
"""How well the share of a surface float's buoyancy in use is found."""
ROUGH, ROUGH_SHARE, ROUGHLY_NEAR = 1e-5, 1e-7, 2e-6
"""The miss allowed of one of many lines, how well its share is found, and how far from a load the
water may be looked up, as shares of the water depth and of the buoyancy."""

TOLD = 32
"""Numbers by which a search tells what it has found."""

COARSE, FINE, KEPT, OTHER = range(4)
"""The records of shapes: on the cuts that the march chose, on these halved, and those kept while
another is looked for."""
CHOSEN, HALVED = range(2)
"""The cuts: as the march chose them, and halved."""
NOT_RECORDED = -1
MARCHES, CHANGED, LAST = range(LEFT, LEFT + 3)
"""In `SearchArrays.left`, after what a march leaves: how many there have been of the whole line,
whether loads are not as they are in the line, and the unknown of the last one."""


class BuoyantPiece(NamedTuple):
    """A rigid buoyant piece, which may lie at the surface.

    Attributes
    ----------
    piece : of the line
    load, stage : where it is among the loads and stages of the course
    length : [m]
    rigid_above : length of what is rigid with it above it [m]
    upto : length of all pieces down to its lower end [m]
    surface_lift : its net force in the water of the surface [N]
    least : share of its buoyancy with which the line below it just stands in still water [-]
    """

    piece: int
    load: int
    stage: int
    length: float
    rigid_above: float
    upto: float
    surface_lift: float
    least: float


class Limits(NamedTuple):
    """Hold what a line is sought within.

    Attributes
    ----------
    span : what lengths are measured by: the water depth, in a tow the line out [m]
    depth : of the water [m]
    anchor_height : [m]
    angle_step, coarse_step : turn of one segment [rad]
    allowed : the greatest miss of a solution [m]
    share_allowed : how well the share of a float's buoyancy in use is found [-]
    bed : the seabed
    near : as in `How`; where it is not 0 the line is one of many, whose shape is not audited
    length, standing : of the line, uncut, and standing upright in still water [m]
    lift : net force of all of it [N]
    rides : whether it is known how the first float rides
    at_rest : whether neither water nor wind moves
    blown : whether there is wind
    refused, refused_at_rest : why such a line need not be sought, in moving and in still water
    """

    span: float
    depth: float
    anchor_height: float
    angle_step: float
    coarse_step: float
    allowed: float
    share_allowed: float
    bed: Bed
    near: float
    length: float
    standing: float
    lift: float
    rides: bool
    at_rest: bool
    blown: bool
    refused: int
    refused_at_rest: int


class SearchArrays(NamedTuple):
    """Hold what a search writes on.

    Attributes
    ----------
    left : see `calm.physics.passing` and above
    chosen : the segments as the march chose them [m]
    counts : how many of them each cable has
    records : of shapes, COARSE to OTHER
    shares : share in use of every float at the surface, the slope of its miss, and the shares of
        the shapes in the records KEPT and OTHER
    samples : unknowns and misses
    even : intervals of an even current
    elements : (3, n) numbers for every element of a shape
    found : see `calm.solve.mooring.tell`
    """

    left: MutableSequence[float]
    chosen: MutableSequence[float]
    counts: MutableSequence[int]
    records: Any
    shares: Sequence[MutableSequence[float]]
    samples: Sequence[MutableSequence[float]]
    even: MutableSequence[Interval]
    elements: Sequence[MutableSequence[float]]
    found: MutableSequence[float]


class LineProblem(NamedTuple):
    """A line and its water, its limits, and room to work in.

    Attributes
    ----------
    course : the line; its loads are as they are at the surface
    loads : as they are in the line
    flexible : whether a piece is a cable or chain
    surfacing : the floats, from the top down
    afloat, hull : the first of them at the surface, and the rows of its hull
    starts : where one of many is found in even currents of growing speed, see `calm.solve.starts`
    """

    course: Course
    sea: Sea
    loads: Sequence[Load]
    flexible: Sequence[int]
    surfacing: Sequence[BuoyantPiece]
    afloat: SurfaceFloat
    hull: Sequence[HullRow]
    limits: Limits
    starts: Sequence[MutableSequence[float]]
    work: SearchArrays


class Unknown(NamedTuple):
    """Hold what closes a line: the depth of its free end, or how much of a float's buoyancy is
    used.

    Attributes
    ----------
    goal : height at which it must end [m], + up from the surface
    sought : the float whose share is sought; those above it are at the surface, too. `BELOW` where
        the free end is below the surface
    rides : whether the float rides at its draft; else it is just below the surface
    lands : whether the line may come down on the seabed before its end
    stages : how many of its stages are marched
    """

    goal: float
    sought: int
    rides: bool
    lands: bool
    stages: int


BELOW = -1


class About(NamedTuple):
    """Hold what a march is about: all but the value of the unknown.

    Attributes
    ----------
    step : angle step [rad]
    cuts : which of the cuts are used, or written
    given : whether they are used
    record : where the shape is recorded, or `NOT_RECORDED`
    """

    problem: LineProblem
    unknown: Unknown
    step: float
    cuts: int
    given: bool
    record: int


class Search(NamedTuple):
    """A problem and the march that it is solved by, see `calm.solve.closing.miss_at`."""

    miss: Callable[[About, float], float]
    problem: LineProblem


def problem_of(
    line: Line,
    water: Water,
    settings: Settings,
    *,
    compiled: bool,
    track: Track | None = None,
    rough: bool = False,
    room: int = ROOM,
    intervals: int = 0,
) -> LineProblem:
    """Lay out a line and its water.

    Parameters
    ----------
    compiled : whether compiled laws are to take it: its sequences are arrays
    track : the line laid out, where it is known
    rough : whether it is solved as one of many, without an audit
    room : for how many segments
    intervals : of other water that it is to be solved in, at most
    """
    track = track or Track.of(line)
    profile = Profile(water)
    span = float(line.length.sum()) if line.towed else water.depth
    floating = None if line.towed else line.floating
    surfacing = []
    lift = np.zeros(0)
    moving = at_rest = SUPPORTED
    standing = 0.0
    if not line.towed:
        lift = standing_lift(line, water)
        surfacing = _surfacing(line, water, track, lift)
        standing = standing_length(line, lift)
        moving, at_rest = (support_of(lift, still)[0] for still in (False, True))
    blown = floating is not None and floating.blown
    excess = profile.excess_at(water.depth) if np.isfinite(water.depth) else 0.0
    bed = Bed(
        float(water.deeper_east), float(water.deeper_north), float(settings.seabed_friction), excess
    )
    limits = Limits(
        span=float(span),
        depth=float(water.depth),
        anchor_height=float(line.anchor_height),
        angle_step=float(settings.angle_step),
        coarse_step=max(COARSE_STEP, 2.0 * settings.angle_step),
        allowed=float((ROUGH if rough else settings.tolerance) * span),
        share_allowed=ROUGH_SHARE if rough else SHARE_TOLERANCE,
        bed=bed,
        near=ROUGHLY_NEAR * span if rough else 0.0,
        length=float(line.length.sum()),
        standing=float(standing),
        lift=float(lift.sum()),
        rides=floating is not None,
        at_rest=not (water.moving or blown),
        blown=bool(blown),
        refused=moving,
        refused_at_rest=at_rest,
    )
    afloat = NEVER_AFLOAT if floating is None else floating.as_numbers
    hull = () if floating is None or floating.hull is None else floating.hull.rows
    flexible: Any = line.flexible.astype(np.intp)
    if compiled:
        course, sea = track.packed, profile.packed
        loads: Any = course.loads
        course = course._replace(loads=loads.copy())
        rows: Any = np.array(surfacing, record_type(BuoyantPiece))
        hulls: Any = np.array(list(hull), record_type(HullRow))
        starts: Any = np.zeros((START_ROWS, STARTS if rough else 0))
        work = work_for(course, max(len(sea.intervals), intervals), room, True)
        return LineProblem(course, sea, loads, flexible, rows, afloat, hulls, limits, starts, work)
    course, sea, none = track.course, profile.sea, [[0.0] * 0] * START_ROWS
    loads = course.loads
    course = course._replace(loads=list(loads))
    work = work_for(course, len(sea.intervals), room, False)
    return LineProblem(
        course, sea, loads, flexible.tolist(), surfacing, afloat, hull, limits, none, work
    )


def work_for(course: Course, intervals: int, room: int, compiled: bool) -> SearchArrays:
    """Room to work in, for so many intervals of the water and so many segments."""
    cables = len(course.cables)
    nodes = 2 * room + 3 * len(course.loads) + 2 * len(course.stages) + 2
    if compiled:
        zeros: Any = np.zeros
        return SearchArrays(
            left=zeros(LAST + 1),
            chosen=zeros(room),
            counts=zeros(cables, np.intp),
            records=zeros((OTHER + 1, COLUMNS, nodes)),
            shares=zeros((OTHER + 1, MOST_AFLOAT + 1)),
            samples=zeros((2, MOST_SAMPLES)),
            even=zeros(intervals, record_type(Interval)),
            elements=zeros((3, nodes)),
            found=zeros(TOLD),
        )

    def rows(count: int, length: int) -> list[list[float]]:
        return [[0.0] * length for _ in range(count)]

    return SearchArrays(
        left=[0.0] * (LAST + 1),
        chosen=[0.0] * room,
        counts=[0] * cables,
        records=[rows(COLUMNS, nodes) for _ in range(OTHER + 1)],
        shares=rows(OTHER + 1, MOST_AFLOAT + 1),
        samples=rows(2, MOST_SAMPLES),
        even=[Interval(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)] * intervals,
        elements=rows(3, nodes),
        found=[0.0] * TOLD,
    )


def reach_of(limits: Limits, step: float) -> float:
    """The longest segment at an angle step [m]."""
    reach = ROUGH_REACH if limits.near > 0.0 else REACH
    return reach * degrees(step) * limits.span


def _surfacing(line: Line, water: Water, track: Track, lift: Floats) -> list[BuoyantPiece]:
    """The rigid buoyant pieces of a line, from the top down."""
    at_surface = surface_lift(line, water).tolist()
    upto, carried = np.cumsum(line.length).tolist(), np.cumsum(lift)
    found = []
    for number, (kind, first, size, _) in enumerate(track.stages):
        if kind != ROD:
            continue
        for place in range(first, first + size):
            load = Load._make(track.loads[place])
            piece = load.piece
            if load.clamp >= 0 or not load.buoyancy > 0.0:
                continue
            found.append(
                BuoyantPiece(
                    piece=piece,
                    load=place,
                    stage=number,
                    length=load.length,
                    rigid_above=load.at - 0.5 * load.length,
                    upto=upto[piece],
                    surface_lift=at_surface[piece],
                    least=1.0 - float(carried[piece:].min()) / at_surface[piece]
                    if at_surface[piece] > 0.0
                    else 1.0,
                )
            )
    return found
