"""A moored line: its shape without contact with the seabed, or with its lower part lying there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Line, Water
from calm.physics.march import Cuts
from calm.physics.state import MarchError
from calm.solve.closing import Closed, Closing, Root
from calm.solve.finish import finished
from calm.solve.locate import locate
from calm.solve.refine import Polish, refine
from calm.solve.solution import Settings, Solution
from calm.solve.standing import refuse_unsupported, too_heavy
from calm.solve.status import Status

BARELY_LANDED = 4.0
"""Length on the seabed, in heights of the anchor, up to which a line that can as well hang between
the seabed and the top of its anchor is taken to hang there."""
PERHAPS_LANDED = 20.0
"""The same, up to which it is looked whether it could hang: the other shape is then reported."""


MOST_DEPTHS = 500
"""The longest line that is solved, in depths: segments are no longer than a hundredth of one."""


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
    out = float(line.length.sum())
    if out > MOST_DEPTHS * water.depth:
        raise Status.NOT_CONVERGED.because(
            f"The line, {out:.0f} m, is {out / water.depth:.0f} times as long as the water is "
            f"deep; up to {MOST_DEPTHS} times is solved.",
            advice="Shorten it: what lies on the seabed does little for the anchor.",
        )
    closing = Closing(line, water, settings or Settings())
    refuse_unsupported(line, water, closing.lift)
    try:
        return _solve(closing)
    except MarchError as error:
        raise Status.NOT_CONVERGED.because(f"The march stopped: {error}.") from error


def _solve(closing: Closing) -> Solution:
    """Try it clear of the seabed or lying on it, the likelier first."""
    ways = [_clear_of_it]
    if closing.track.landing < len(closing.track.stages):
        longer = float(closing.line.length.sum()) > closing.water.depth
        ways.insert(0 if longer else 1, _on_the_seabed)
    refusals = {}
    for way in ways:
        try:
            return _highest(closing, way)
        except NoEquilibrium as refusal:
            refusals[way] = refusal
    slack = [r for r in refusals.values() if r.status == Status.SLACK.label]
    raise (slack or [refusals[_clear_of_it]])[0]


Way = Callable[[Closing, Root], Solution]
"""From a coarse root to the audited solution near it."""


def _highest(closing: Closing, way: Way) -> Solution:
    """The highest solution of a kind, with the depth of the deepest where that is another."""
    lands = way is _on_the_seabed
    if not lands and float(closing.lift.sum()) <= 0.0:
        raise too_heavy(closing.lift)
    root, deeper = locate(closing, lands)
    solution = way(closing, root)
    if deeper is None:
        return solution
    try:
        other = way(closing, deeper)
    except (NoEquilibrium, MarchError):
        return solution
    fall = solution.position[0, 2] - other.position[0, 2]
    if fall <= 2.0 * (solution.depth_error + other.depth_error):
        return solution
    return _beside(solution, other)


def _clear_of_it(closing: Closing, root: Root) -> Solution:
    def polish(root: Root, cuts: Cuts) -> Closed:
        closed = closing.polish(root, cuts)
        _refuse_deep_below(closed, closing.water.depth)
        return closed

    return _solution(closing, root, polish)


def _on_the_seabed(closing: Closing, root: Root) -> Solution:
    if not closing.run(root.unknown, root.x, closing.coarse_step).landed:
        return _solution(closing, closing.clear_of_seabed(root))
    landed = _solution(closing, root)
    if not landed.landed:
        raise Status.GROUNDED.because("The line does not lie on the seabed.")
    height = closing.line.anchor_height
    if landed.grounded_length > PERHAPS_LANDED * height:
        return landed
    try:
        hanging = _solution(closing, closing.clear_of_seabed(root))
    except NoEquilibrium:
        return landed
    if landed.grounded_length > BARELY_LANDED * height:
        return _beside(landed, hanging)
    return _beside(hanging, landed)


def _beside(solution: Solution, other: Solution) -> Solution:
    """The solution, with where the free end is and how much lies on the seabed in another one."""
    depth, grounded = -float(other.position[0, 2]), other.grounded_length
    return replace(solution, other_depth=depth, other_grounded_length=grounded)


def _refuse_deep_below(closed: Closed, depth: float) -> None:
    """Spare a line that hangs far below the seabed the finer cuts."""
    height = closed.trace.position[:, 2]
    lowest = int(np.argmin(height))
    if height[lowest] < -1.01 * depth:
        piece = int(closed.trace.piece[max(lowest - 1, 0)])
        raise _grounded(piece, -depth - float(height[lowest]))


def _grounded(piece: int, below: float) -> NoEquilibrium:
    return Status.GROUNDED.because(
        f"The line would touch the seabed: {{piece}} comes {below:.2f} m below it.", piece
    )


def _solution(closing: Closing, root: Root, polish: Polish | None = None) -> Solution:
    return finished(closing, refine(closing, root, polish), None, refuse_out_of_the_water)


def refuse_out_of_the_water(solution: Solution) -> None:
    """Refuse a shape that comes below the seabed or above the surface.

    Raises
    ------
    NoEquilibrium
    """
    height: Floats = solution.position[:, 2]
    depth = solution.water.depth
    margin = max(solution.depth_error, 1e-6 * depth)
    # a float at the surface may stand out of it, however it is turned
    standing = float(solution.line.length[list(solution.afloat)].sum())
    if solution.riding is not None:
        standing = float(solution.line.length[: max(solution.afloat) + 1].sum())
    lowest, highest = int(np.argmin(height)), int(np.argmax(height))
    if height[lowest] < -depth - margin:
        raise _grounded(solution.piece_at(lowest), -depth - height[lowest])
    if height[highest] > margin + standing:
        piece = solution.piece_at(highest)
        raise Status.ABOVE_SURFACE.because(
            f"The line would rise out of the water: {{piece}} comes "
            f"{height[highest]:.2f} m above the surface.",
            piece,
        )
