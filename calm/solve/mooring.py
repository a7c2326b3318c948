"""A moored line: its shape without contact with the seabed, or with its lower part lying there."""

from __future__ import annotations

from calm.physics.compiled import by_address, entry
from calm.physics.line import Line, Water
from calm.physics.passing import FAILURE
from calm.physics.state import NO_ROOM
from calm.solve.asking import AskedSearch, as_told, find_asked, find_now
from calm.solve.audit import referee_of
from calm.solve.closing import miss_at, whole_line
from calm.solve.finish import solution_found
from calm.solve.problem import CHOSEN, NOT_RECORDED, ROOM, About, LineProblem, Search, problem_of
from calm.solve.search import FoundShape, Referee, find_shape
from calm.solve.solution import Settings, Solution
from calm.solve.speed import runs_compiled
from calm.solve.standing import refuse_unsupported, standing_lift
from calm.solve.status import Status

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
