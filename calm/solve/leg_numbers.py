"""Data structures of a net of legs for compiled code: arrays and named tuples."""

from collections.abc import MutableSequence, Sequence
from math import inf
from typing import Any, NamedTuple

from calm.physics.compiled import within
from calm.physics.hull import SurfaceFloat
from calm.physics.line import Bed, Record, off_bed
from calm.physics.profile import Sea
from calm.physics.strumming import with_beat
from calm.physics.track import Course
from calm.solve.problem import LineProblem, SearchArrays

STANDING, HANGING_DOWN, PULLED, ANCHORED = range(4)
"""Kinds of march of a leg.

- STANDING: from a free upper end
- HANGING_DOWN: from a free lower end
- PULLED: from an upper end that is held or at a node
- ANCHORED: from the seabed up to an end that is held or at a node
"""
STAGE, GROUNDED, SHARE, MARCHES, COUNT, SUSPENDED = range(6)
"""Indices into the state of a leg after its last march.

- STAGE: stage of the touchdown, or -1
- GROUNDED: length on the seabed [m]
- SHARE: used fraction of a float's buoyancy
- MARCHES, COUNT, SUSPENDED: number of marches, number of nodes, and number of nodes off the seabed
"""
EAST, NORTH, TO_EAST, TO_NORTH, TO_UP, HANGS, LIES, SLACK = range(6, 14)
"""Indices into the state of an anchored leg.

- EAST, NORTH: vector from the touchdown to the upper end of the leg [m]
- TO_EAST, TO_NORTH, TO_UP: pull at the touchdown [N]
- HANGS: hanging length of the stage of the touchdown, as in `calm.physics.seabed` [m]
- LIES: length of the part on the seabed [m]
- SLACK: excess of `LIES` over the distance to the anchor [m]
"""
FREQUENCY, LACKING, YIELD = range(14, 17)
"""Indices into the state of a strumming leg.

- FREQUENCY: strumming frequency of the cables [Hz]
- LACKING: vortex shedding frequency minus strumming frequency [Hz]
- YIELD: slope of `LACKING` against the strumming frequency [-]
"""
COARSE_COUNT, COARSE_SUSPENDED, COARSE_STAGE, COARSE_GROUNDED = range(17, 21)
"""Indices of the state values `COUNT`, `SUSPENDED`, `STAGE` and `GROUNDED` for the shape on coarse
segments.
"""
OF_LEG = 21
OUT = 7
"""Number of results of a march, which are the entries of a row of `passed`.

- 0 and 1: for an anchored leg, horizontal position error at the anchor; for other legs, horizontal
  distance from the start to the end of the march (east, north)
- 2: height of the end of the march
- 3 to 5: force at the end of the march
- 6: error of the height at which an anchored leg begins on a sloping seabed
"""


class LegRow(NamedTuple):
    """Data of a leg in the form that compiled code uses.

    Attributes
    ----------
    kind : kind of march, `STANDING` to `ANCHORED`
    first, own : index of the leg's first unknown, and number of its unknowns
    start, end : numbers of the nodes at the upper and lower ends, or -1. For a leg with a free
        lower end, `start` is at the lower end
    seabed : height of the seabed below the anchor [m]; -inf without an anchor
    rise : height of the anchor's top above the seabed [m]
    lifts : upward pull above which the leg ends at the anchor's top [N]
    deeper_east, deeper_north : slope of the seabed, as in `Water`
    longest : longest segment at an angle step of 1° [m]
    surface_range, highest, weight : as in `LaidLeg`
    rides : as in `Limits`
    sheds : St/D at the end of the march, with Strouhal number St and cable diameter D [1/m]; 0
        without strumming
    past_east, past_north, past_up : current at the end of the march [m/s]
    surfacing, rows : numbers of buoyant pieces, and of rows of the hull table
    landing : as in `Course`
    """

    kind: int
    first: int
    own: int
    start: int
    end: int
    seabed: float
    rise: float
    lifts: float
    deeper_east: float
    deeper_north: float
    longest: float
    surface_range: float
    highest: float
    rides: int
    sheds: float
    past_east: float
    past_north: float
    past_up: float
    weight: float
    stages: int
    landing: int
    cables: int
    surfacing: int
    rows: int
    pieces: int


class NetProblem(NamedTuple):
    """A net of legs to be closed, with the work arrays of the search.

    Attributes
    ----------
    lines : a `LineProblem` whose arrays have a row for each leg
    up : courses of the anchored legs in upward order
    held : (·, 6) positions of the held ends of each leg, in the order `start`, `end` [m]
    state : (·, `OF_LEG`) state of each leg after its last march
    passed : (·, `OUT`) results of each leg's last march
    found : residual of the last march, divided by `rows`
    kept : residual of the best unknowns so far, divided by `rows`
    slopes : Jacobian, the derivatives of `found` with respect to the unknowns divided by `scale`
    update : Newton step of the unknowns divided by `scale`
    coarse, better : unknowns on coarse segments, and extrapolated unknowns
    scale, rows : scales of the unknowns and of the residual
    errors : largest errors of depths [m] and of tensions [N]
    nodes_at : index of the first unknown that belongs to a node
    length, force : length of the longest leg [m], and a typical force [N]
    span : reference length for errors of depth [m]
    """

    legs: Sequence[LegRow]
    lines: Any
    up: Any
    cuts: MutableSequence[float]
    held: Sequence[Sequence[float]]
    state: Sequence[MutableSequence[float]]
    passed: Sequence[MutableSequence[float]]
    first: Sequence[MutableSequence[int]]
    last: Sequence[MutableSequence[int]]
    found: MutableSequence[float]
    kept: MutableSequence[float]
    slopes: Sequence[MutableSequence[float]]
    update: MutableSequence[float]
    trial: MutableSequence[float]
    matrix: Sequence[MutableSequence[float]]
    order: MutableSequence[int]
    coarse: MutableSequence[float]
    better: MutableSequence[float]
    scale: MutableSequence[float]
    rows: Sequence[float]
    errors: MutableSequence[float]
    nodes_at: int
    length: float
    force: float
    span: float


class Marching(NamedTuple):
    """Settings for the march of all legs of a net.

    Attributes
    ----------
    step : angle step [rad]
    cuts, given : segment list, and whether the march uses the listed segments; otherwise it chooses
        and lists new segments
    exact : whether segments are split at every level of the water profile
    record : index of the record for the shapes
    loose : pull of a slack leg towards its anchor, as a fraction of the leg's force scale; the true
        value is 0
    """

    sea: Sea
    step: float
    cuts: int
    given: bool
    # a different split would affect the Jacobian more than the small step of an unknown does
    exact: bool
    record: int
    # at first not 0, so that slack legs determine the direction in which a net drifts
    loose: float


@within
def leg_of(net: NetProblem, sea: Sea, i: int) -> LineProblem:
    """Return a leg in the form of a `LineProblem`, like a single line."""
    leg, lines, own = net.legs[i], net.lines, net.lines.afloat[i]
    courses, works = lines.course, lines.work
    course = Course(
        courses.stages[i][: leg.stages], courses.loads[i], courses.cables[i][: leg.cables],
        courses.knots[i], with_beat(courses.vibration, net.state[i][FREQUENCY]), leg.landing,
    )  # fmt: skip
    afloat = SurfaceFloat(
        own.form, own.height, own.area, own.weight, own.lift, own.surface_drag, own.wind_east,
        own.wind_north, own.wind_area, own.wind_cd,
    )  # fmt: skip
    work = SearchArrays(
        works.left[i], works.chosen[i], works.counts[i], works.records[i],
        works.shares[i], works.samples[i], works.even[i], works.elements[i], works.found[i],
    )  # fmt: skip
    return LineProblem(
        course, sea, lines.loads[i], net.first[i], lines.surfacing[i][: leg.surfacing], afloat,
        lines.hull[i][: leg.rows], lines.limits, lines.starts[i], work,
    )  # fmt: skip


def bed_of(net: NetProblem, i: int) -> Bed:
    """Return the seabed below leg i."""
    leg, bed = net.legs[i], net.lines.limits.bed
    return Bed(leg.deeper_east, leg.deeper_north, bed.friction, bed.excess)


def above_bed(net: NetProblem, i: int, x: Sequence[float], record: Record, n: int) -> float:
    """Return the height of a node of a leg above the seabed [m].

    The seabed is a plane through the foot of the leg's anchor or, without an anchor, at the water
    depth below the origin.
    """
    end, level = int(net.state[i][COUNT]) - 1, net.legs[i].seabed
    east, north = record[0][n] - record[0][end], record[1][n] - record[1][end]
    if level == -inf:
        level, place = -net.lines.limits.depth, place_of(net, i, x, 1)
        east, north = east + place[0], north + place[1]
    return off_bed(bed_of(net, i), east, north, record[2][n] - level)


@within
def place_of(net: NetProblem, i: int, x: Sequence[float], end: int) -> tuple[float, float, float]:
    """Return the position [m] of the first node (`end` is 0) or last node (`end` is 1) of a leg."""
    leg, held = net.legs[i], net.held[i]
    node = leg.end if end else leg.start
    if node >= 0:
        k = net.nodes_at + 3 * node
        return x[k], x[k + 1], x[k + 2]
    return held[3 * end], held[3 * end + 1], held[3 * end + 2]


def end_height(leg: LegRow, lies: bool, pull: float) -> float:
    """Return the height of the lower end of an anchored leg [m].

    The end rises from the seabed to the top of the anchor, in proportion to the pull.

    Parameters
    ----------
    lies : whether part of the leg lies on the seabed; the end is then on the seabed
    pull : upward pull on the anchor [N]
    """
    if lies:
        return leg.seabed
    # without a jump of the height, the solver need not guess where the leg ends
    return leg.seabed + leg.rise * (
        min(max(pull / leg.lifts, 0.0), 1.0) if leg.lifts > 0.0 else 1.0
    )
