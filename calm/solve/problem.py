"""A line prepared for the search of its shape, as plain numbers and work arrays."""

from collections.abc import MutableSequence, Sequence
from itertools import accumulate
from math import degrees
from typing import Any, NamedTuple

import numpy as np

from calm.physics.hull import UNKNOWN_FLOAT, HullRow, SurfaceFloat
from calm.physics.law_kinds import record_type
from calm.physics.line import COLUMNS, Bed, Line, Water, once_at_rest
from calm.physics.passing import LEFT
from calm.physics.profile import Interval, Sea, profile_of
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
"""Angle step of the coarse marches that search for approximate equilibria [rad]."""
REACH, ROUGH_REACH = 0.01, 0.013
"""Longest segment at an angle step of 1°, as a fraction of the span: for a single line, and in a
batch.
"""
ROOM, MANY_ROOM = 512, 256
"""Initial number of segments that the work arrays hold, for a single line and in a batch; lines
that need more are solved again with larger arrays.
"""
MOST_AFLOAT = 16
"""Largest number of successive floats at the surface. The solver treats each float together with
all floats above it.
"""
MOST_SAMPLES = 64
STARTS, FASTEST, START_ROWS = 41, 4.0, 7
"""Uniform currents in which a line is solved before a batch: their number, the fastest current
[m/s], and the number of stored values per current.
"""
SHARE_TOLERANCE = 1e-9
"""Tolerance of the used fraction of a surface float's buoyancy."""
ROUGH, ROUGH_SHARE, ROUGHLY_NEAR = 1e-5, 1e-7, 2e-6
"""Tolerances in a batch.

- ROUGH: allowed height error of the line's end, as a fraction of the water depth
- ROUGH_SHARE: tolerance of the used fraction of buoyancy
- ROUGHLY_NEAR: distance of a load from its water sample, as a fraction of the water depth
"""

FOUND_SIZE = 32
"""Length of the array for the results of a search."""

COARSE, FINE, KEPT, OTHER = range(4)
"""Indices of the records of shapes.

- COARSE: shape on the segments chosen by the march
- FINE: shape on the halved segments
- KEPT, OTHER: copies of shapes, kept during another search
"""
CHOSEN, HALVED = range(2)
"""Segment lists: chosen by the march, and halved."""
NOT_RECORDED = -1
MARCHES, CHANGED, LAST = range(LEFT, LEFT + 3)
"""Indices into `SearchArrays.left`, after the results of a march.

- MARCHES: number of marches of the whole line
- CHANGED: number of loads changed for floats at the surface
- LAST: value of the line's unknown in the last march
"""


class BuoyantPiece(NamedTuple):
    """A rigid buoyant piece, which may float at the surface.

    Attributes
    ----------
    load, stage : index of the piece's load, and of the piece's stage, in the `Course`
    rigid_above : length of the rigid pieces directly above this piece [m]
    upto : length of the line from the free end to the lower end of this piece [m]
    surface_lift : net buoyancy in water at the surface [N]
    least : smallest used fraction of the buoyancy for which the line below this piece is upright in
        still water [-]
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
    """Limits and settings of the search for a line's shape.

    Attributes
    ----------
    span : reference length [m]: the water depth or, for a tow, the line length
    depth, anchor_height : water depth, and height of the anchor's top above the seabed [m]
    angle_step, coarse_step : largest rotation of a segment in the final shape, and in the search
        [rad]
    allowed : largest allowed height error of the line's end in a solution [m]
    near : as in `MarchSettings`; not 0 in a batch, which is not audited
    length, standing : unstretched length, and length upright in still water [m]
    lift : net buoyancy of the whole line [N]
    rides : whether the draft of the top float can be computed
    refused, refused_at_rest : results of `support_of` in a current or wind, and at rest
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
    """Work arrays of a search.

    Attributes
    ----------
    left : results of the last march (see `calm.physics.passing`), followed by three values with the
        indices `MARCHES` to `LAST`
    chosen : unstretched lengths of the segments chosen by the march [m]
    counts : number of segments in each cable
    records : shapes of the line, indexed by `COARSE` to `OTHER`
    shares : four rows with a value for each surface float. Row 0 holds the used buoyancy fraction,
        row 1 the derivative of the height error with respect to this fraction. Rows `KEPT` and
        `OTHER` hold the used fractions of the shapes in these records
    samples : depths of the free end, and height errors of the line's end for these depths [m]
    elements : (3, n) loads of every element
    found : results, see `calm.solve.mooring.write_found`
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
    """A line and its water, with limits and work arrays for the search.

    Attributes
    ----------
    course : the line as the march uses it, with loads reduced for floats at the surface
    loads : the loads without this reduction
    surfacing : the rigid buoyant pieces, from the top down
    afloat, hull : the float that may ride at the surface, and its hull table
    starts : solutions from `calm.solve.starts`
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
    """Unknown of a line: depth of its free end, or used fraction of a float's buoyancy.

    Attributes
    ----------
    goal : height above the surface at which the line must end [m]
    sought : index of the float with the unknown buoyancy fraction, which is the lowest float at the
        surface; `BELOW` if the depth of the free end is unknown
    rides : whether the float rides at its draft; otherwise it is just below the surface
    lands : whether the line may have a touchdown
    stages : number of stages to march
    """

    goal: float
    sought: int
    rides: bool
    lands: bool
    stages: int


BELOW = -1


class About(NamedTuple):
    """Arguments of a march, without the value of the line's unknown.

    Attributes
    ----------
    step : angle step [rad]
    cuts : segment list, `CHOSEN` or `HALVED`
    given : whether to use the listed segments; otherwise the march chooses and lists new segments
    record : record for the shape, or `NOT_RECORDED`
    """

    problem: LineProblem
    unknown: Unknown
    step: float
    cuts: int
    given: bool
    record: int


def problem_of(
    line: Line,
    water: Water,
    settings: Settings,
    *,
    compiled: bool,
    rough: bool = False,
    room: int = ROOM,
    intervals: int = 0,
) -> LineProblem:
    """Prepare a line and its water for the search of its shape.

    Parameters
    ----------
    compiled : whether to prepare arrays, as compiled code requires
    rough : whether the line belongs to a batch, which is not audited
    intervals : largest number of depth intervals in any water to be solved
    """
    profile = profile_of(water)
    span = float(line.length.sum()) if line.towed else water.depth
    floating = None if line.towed else line.floating
    surfacing: list[BuoyantPiece] = []
    upright = np.zeros(0)
    moving = at_rest = SUPPORTED
    standing = 0.0
    if not line.towed:
        upright = standing_lift(line, water)
        surfacing = surfacing_pieces(line, water)
        standing = standing_length(line, water)
        moving, at_rest = (support_of(upright, still)[0] for still in (False, True))
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
        lift=float(upright.sum()),
        rides=floating is not None,
        at_rest=not (water.moving or blown),
        blown=bool(blown),
        refused=moving,
        refused_at_rest=at_rest,
    )
    afloat = UNKNOWN_FLOAT if floating is None else floating.as_numbers
    hull = () if floating is None or floating.hull is None else floating.hull.rows
    flexible: Any = line.flexible.astype(np.intp)
    if compiled:
        course, sea = Track.of(line).packed, profile.packed
        loads: Any = course.loads
        course = course._replace(loads=loads.copy())
        rows: Any = np.array(surfacing, record_type(BuoyantPiece))
        hulls: Any = np.array(list(hull), record_type(HullRow))
        starts: Any = np.zeros((START_ROWS, STARTS if rough else 0))
        work = work_for(course, max(len(sea.intervals), intervals), room, True)
        return LineProblem(course, sea, loads, flexible, rows, afloat, hulls, limits, starts, work)
    course, sea, none = Track.of(line).course, profile.sea, [[0.0] * 0] * START_ROWS
    loads = course.loads
    course = course._replace(loads=list(loads))
    work = work_for(course, len(sea.intervals), room, False)
    return LineProblem(
        course, sea, loads, flexible.tolist(), surfacing, afloat, hull, limits, none, work
    )


def work_for(course: Course, intervals: int, room: int, compiled: bool) -> SearchArrays:
    """Create work arrays for given numbers of depth intervals and of segments (`room`)."""
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
            found=zeros(FOUND_SIZE),
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
        found=[0.0] * FOUND_SIZE,
    )


def reach_of(limits: Limits, step: float) -> float:
    """Return the largest allowed length [m] of a segment for a given angle step."""
    reach = ROUGH_REACH if limits.near > 0.0 else REACH
    return reach * degrees(step) * limits.span


@once_at_rest
def surfacing_pieces(line: Line, water: Water) -> list[BuoyantPiece]:
    """Return the rigid buoyant pieces of a line, from the top down."""
    track, lift = Track.of(line), standing_lift(line, water)
    at_surface = surface_lift(line, water).tolist()
    upto, carried = np.cumsum(line.length).tolist(), np.cumsum(lift).tolist()
    lowest = list(accumulate(reversed(carried), min))[::-1]
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
                    least=1.0 - lowest[piece] / at_surface[piece]
                    if at_surface[piece] > 0.0
                    else 1.0,
                )
            )
    return found
