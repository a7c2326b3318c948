"""What is at the surface, in the lanes: a free end, a float that rides there, or several floats.

Several are taken as just below the surface, as `calm.solve.locate` has it: the share in use of an
upper one brings the top of the next to the surface, and follows from the line between them alone;
that of the lowest closes the line. A case seeks them one after the other, from the top down.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from calm.batch.kernel import lane
from calm.batch.kernel.lane import LANES, STATE, Desk
from calm.batch.kernel.layout import Rides, Way
from calm.batch.kernel.search import Searches
from calm.physics.line import Floats

NO_FLOAT = 0
"""In place of the stage of the next float below those at the surface: there is none, or it is not
asked for."""


class Afloat(NamedTuple):
    """The search for one of several floats: as in `Search`; its unknown of the time before."""

    unknown: float
    slope: float
    found: float
    earlier: float


def place_free_end(s: Floats, i: int, y: float, rides: Rides) -> None:
    """Put a lane's free end where its unknown has it."""
    s[lane.FREE_END + i], s[lane.SHARE + i], s[lane.OUT + i] = y, 1.0, 0.0
    s[lane.WET + i], s[lane.HELD + i] = 1.0, 1.0
    s[lane.WIND_EAST + i], s[lane.WIND_NORTH + i] = 0.0, 0.0
    if y < 0.0:
        s[lane.FREE_END + i], s[lane.SHARE + i] = 0.0, 1.0 + y
        last = rides.by_share.size - 1
        at = (1.0 - sqrt(-y)) * last
        j = min(max(int(at), 0), last - 1)
        left = at - j
        here, following = rides.by_share[j], rides.by_share[j + 1]
        standing = here.standing + left * (following.standing - here.standing)
        above = here.above + left * (following.above - here.above)
        s[lane.OUT + i] = above * rides.above + standing * rides.own
        s[lane.WET + i] = 1.0 - above
        s[lane.HELD + i] = here.drag + left * (following.drag - here.drag)
        s[lane.WIND_EAST + i] = here.push_east + left * (following.push_east - here.push_east)
        s[lane.WIND_NORTH + i] = here.push_north + left * (following.push_north - here.push_north)


def place_case(desk: Desk, i: int, seek: Searches, way: Way) -> None:
    """Put a lane's free end, or its floats, where the search of its case has them."""
    s, c = desk.scratch, desk.water.slot[i]
    y, lowest = seek[c].unknown, way.joints.size
    if lowest == 0:
        place_free_end(s, i, y, way.rides)
        return
    place_free_end(s, i, 0.0, way.rides)
    sought = seek[c].sought
    s[lane.SHARE + i] = 1.0 + min(y, 0.0) if sought == lowest else 1.0
    for k in range(lowest):
        upper = y if k == sought else desk.afloat[int(way.lands), c, k].unknown
        s[lane.UPPER + k * LANES + i] = 1.0 + min(upper, 0.0)


def miss_of(desk: Desk, i: int, seek: Searches, way: Way) -> float:
    """The miss of a lane [m]: of the line's end, or of the top of the float that is to come up."""
    sought = seek[desk.water.slot[i]].sought
    if sought < way.joints.size:
        return float(desk.nodes[way.joints[sought] * STATE * LANES + lane.Z + i])
    return float(desk.scratch[lane.Z + i] - way.aim.goal)


def set_out(desk: Desk, seek: Searches, c: int, way: Way) -> None:
    """Set out on the floats of a case, each with all its buoyancy in use; seek the uppermost."""
    for k in range(way.joints.size + 1):
        mine = desk.afloat[int(way.lands), c, k]
        mine.unknown, mine.slope, mine.found, mine.earlier = 0.0, -1.0, 0.0, 0.0
    seek_from(desk, seek, c, way, 0)


def seek_from_the_top(desk: Desk, seek: Searches, c: int, way: Way) -> None:
    """Seek the floats of a case again, from where they have been found."""
    if way.joints.size:
        seek[c].sought = way.joints.size
        keep(desk, seek, c, way)
        seek_from(desk, seek, c, way, 0)


def seek_from(desk: Desk, seek: Searches, c: int, way: Way, k: int) -> None:
    """Seek the k-th float of a case, from what is known of it."""
    mine = desk.afloat[int(way.lands), c, k]
    seek[c].sought, seek[c].turn, seek[c].stuck = k, 0, 0
    seek[c].unknown, seek[c].slope, seek[c].found = mine.unknown, mine.slope, mine.found


def keep(desk: Desk, seek: Searches, c: int, way: Way) -> None:
    """Keep what is known of the float that a case seeks."""
    mine = desk.afloat[int(way.lands), c, seek[c].sought]
    mine.unknown, mine.slope, mine.found = seek[c].unknown, seek[c].slope, seek[c].found


def next_float(desk: Desk, seek: Searches, c: int, way: Way) -> bool:
    """Whether a case has another float to seek, now that it has found one; it then seeks that."""
    if seek[c].sought >= way.joints.size:
        return False
    keep(desk, seek, c, way)
    seek_from(desk, seek, c, way, seek[c].sought + 1)
    return True


def go_back(desk: Desk, seek: Searches, c: int, way: Way) -> None:
    """Put the unknown of a case, or those of its floats, back to the coarse root."""
    for k in range(way.joints.size):
        desk.afloat[int(way.lands), c, k].unknown = desk.afloat[int(way.lands), c, k].found
    if seek[c].sought < way.joints.size:
        seek_from(desk, seek, c, way, way.joints.size)
    seek[c].unknown = seek[c].found


def further(y: float, earlier: float) -> float:
    """Where a root will go by this halving: a quarter as far as by the last."""
    return y + 0.25 * (y - earlier)


def foresee(desk: Desk, seek: Searches, c: int, way: Way, earlier: Floats, first: bool) -> None:
    """Go where the root of a case, and its floats, will be on halved cuts."""
    y = seek[c].unknown
    seek[c].unknown = y if first else further(y, earlier[c])
    earlier[c] = y
    for k in range(way.joints.size):
        mine = desk.afloat[int(way.lands), c, k]
        y = mine.unknown
        mine.unknown = y if first else further(y, mine.earlier)
        mine.earlier = y


def share_in_use(y: float, earlier: float) -> float:
    """Share of a float's buoyancy, by its unknowns on halved cuts and before."""
    return 1.0 + min((4.0 * y - earlier) / 3.0, 0.0)


def used_of(desk: Desk, seek: Searches, c: int, way: Way, earlier: float) -> float:
    """Share in use of the buoyancy at the surface."""
    lowest = way.joints.size
    used = way.lifts[lowest] * share_in_use(seek[c].unknown, earlier)
    for k in range(lowest):
        mine = desk.afloat[int(way.lands), c, k]
        used += way.lifts[k] * share_in_use(mine.unknown, mine.earlier)
    return float(used)
