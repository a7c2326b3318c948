"""The search called by its address: what it is asked for, and told back as numbers."""

from __future__ import annotations

from collections.abc import Callable, MutableSequence, Sequence
from typing import NamedTuple

from calm.solve.closing import Closed, Root
from calm.solve.problem import Search, Unknown
from calm.solve.refine import Errors, Refined
from calm.solve.search import FoundShape, Referee, find_shape


class AskedSearch(NamedTuple):
    """What `find_asked` is asked for."""

    search: Search
    referee: Referee


def find_asked(asked: AskedSearch, _: float) -> float:
    """Look for a shape, and tell what was found in the work of the problem; how it ended."""
    found = find_shape(asked.search, asked.referee)
    tell(found, asked.search.problem.work.found)
    return float(found.ending)


def find_now(find: Callable[[AskedSearch, float], float], asked: AskedSearch) -> float:
    """Call a search by its address."""
    return find(asked, 0.0)


ENDING, VALUE, PIECE, GOAL, SOUGHT, RIDES, LANDS, STAGES, UNKNOWN_VALUE, MISS, SLOPE = range(11)
NODES, HANGING, LANDED, GROUNDED, SEGMENTS, FIRST_ERROR = range(11, 17)
CLOSURE, MOMENT, OTHER_DEPTH, OTHER_GROUNDED = range(22, 26)
"""Where it stands in what a search tells; from `FIRST_ERROR` on the errors."""


def tell(found: FoundShape, told: MutableSequence[float]) -> None:
    """Write down what was found."""
    closed, errors = found.refined.closed, found.errors
    root = closed.root
    unknown = root.unknown
    told[ENDING], told[VALUE], told[PIECE] = found.ending, found.value, found.piece
    told[GOAL], told[SOUGHT] = unknown.goal, unknown.sought
    told[RIDES], told[LANDS], told[STAGES] = unknown.rides, unknown.lands, unknown.stages
    told[UNKNOWN_VALUE], told[MISS], told[SLOPE] = root.x, root.miss, root.slope
    told[NODES], told[HANGING] = closed.nodes, closed.hanging
    told[LANDED], told[GROUNDED] = closed.landed, closed.grounded
    told[SEGMENTS] = found.refined.segments
    told[FIRST_ERROR], told[FIRST_ERROR + 1] = errors.depth, errors.tension
    told[FIRST_ERROR + 2] = errors.relative
    told[FIRST_ERROR + 3], told[FIRST_ERROR + 4] = errors.lift, errors.pull
    told[CLOSURE], told[MOMENT] = found.closure, found.moment
    told[OTHER_DEPTH], told[OTHER_GROUNDED] = found.other_depth, found.other_grounded


def as_told(told: Sequence[float]) -> FoundShape:
    """What was found, by what was written down."""
    whole = [int(told[i]) for i in range(len(told)) if i in WHOLE]
    ending, piece, sought, rides, lands, stages, nodes, hanging, landed, segments = whole
    unknown = Unknown(told[GOAL], sought, bool(rides), bool(lands), stages)
    root = Root(True, unknown, told[UNKNOWN_VALUE], told[MISS], told[SLOPE])
    value = float(told[VALUE])
    closed = Closed(ending, value, piece, root, nodes, hanging, bool(landed), float(told[GROUNDED]))
    errors = Errors(*(float(error) for error in told[FIRST_ERROR : FIRST_ERROR + 5]))
    last = [float(told[i]) for i in (CLOSURE, MOMENT, OTHER_DEPTH, OTHER_GROUNDED)]
    return FoundShape(ending, value, piece, Refined(closed, segments, errors), errors, *last)


WHOLE = (ENDING, PIECE, SOUGHT, RIDES, LANDS, STAGES, NODES, HANGING, LANDED, SEGMENTS)
