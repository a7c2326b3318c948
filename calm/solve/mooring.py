"""A moored line: its shape, searched for as it is or at the address of the compiled search."""

from __future__ import annotations

from collections.abc import Callable, MutableSequence, Sequence
from typing import NamedTuple

from calm.physics.compiled import by_address, entry
from calm.physics.line import Line, Water
from calm.physics.passing import FAILURE
from calm.physics.state import NO_ROOM
from calm.solve.audit import referee_of
from calm.solve.closing import Closed, Root, miss_at, whole_line
from calm.solve.finish import solution_found
from calm.solve.problem import (
    CHOSEN,
    NOT_RECORDED,
    ROOM,
    About,
    LineProblem,
    Search,
    Unknown,
    problem_of,
)
from calm.solve.refine import Errors, Refined
from calm.solve.search import FoundShape, Referee, find_shape
from calm.solve.solution import (
    Settings,
    Solution,
    Status,
    refuse_unsupported,
    runs_compiled,
    standing_lift,
)

MOST_DEPTHS = 500
"""The longest line that is solved, in depths: segments are no longer than a hundredth of one."""
MORE_ROOM = 8
"""How many times as much room a line gets that needs more segments."""


def solve_mooring(line: Line, water: Water, settings: Settings | None = None) -> Solution:
    """Solve for the static equilibrium of a moored line.

    Parameters
    ----------
    line, water : see `calm.physics.line`
    settings : angle step and tolerance; 1° and 1e-7 of the depth where not given

    Returns
    -------
    Solution : of the highest equilibrium found. At 1° its depths and offsets are within 5e-5 of
        the water depth, its tensions within 2e-4, of the continuous line's.

    Raises
    ------
    NoEquilibrium
        With one of the statuses of `Status`: nothing is returned that does not pass every check.
    """
    settings = settings or Settings()
    refuse_endless(line, water)
    refuse_unsupported(line, water, standing_lift(line, water))
    compiled = runs_compiled(settings, line)
    room = ROOM
    while True:
        problem = problem_of(line, water, settings, compiled=compiled, room=room)
        search = search_of(problem, compiled)
        referee = referee_of(line, water, 0.0, compiled)
        found = find_compiled(search, referee) if compiled else find_shape(search, referee)
        if not lacks_room(problem):
            break
        room *= MORE_ROOM
    return solution_found(found, problem, line, water, settings)


def find_compiled(search: Search, referee: Referee) -> FoundShape:
    """`find_shape`, compiled."""
    asked = AskedSearch(search, referee)
    find = by_address(find_asked, asked)
    entry(find_now, find, asked)(find, asked)
    return as_told(list(search.problem.work.found))


def search_of(problem: LineProblem, compiled: bool) -> Search:
    """The search for a problem, at either speed."""
    if not compiled:
        return Search(miss_at, problem)
    whole = whole_line(problem, False)
    about = About(problem, whole, 0.0, CHOSEN, False, NOT_RECORDED)
    return Search(by_address(miss_at, about), problem)


def lacks_room(problem: LineProblem) -> bool:
    """Return whether a search has ended because a line needs more segments than there was room
    for.
    """
    return bool(problem.work.left[FAILURE] == NO_ROOM)


def refuse_endless(line: Line, water: Water) -> None:
    """Refuse a line that is far longer than the water is deep.

    Raises
    ------
    NoEquilibrium
    """
    out = float(line.length.sum())
    if out > MOST_DEPTHS * water.depth:
        raise Status.NOT_CONVERGED.because(
            f"The line, {out:.0f} m, is {out / water.depth:.0f} times as long as the water is "
            f"deep; up to {MOST_DEPTHS} times is solved.",
            advice="Shorten it: what lies on the seabed does little for the anchor.",
        )


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
