"""Conversion of a closed line to a `Solution`, or to an exception that explains its absence."""

from dataclasses import replace

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.line import FAILURES, Line, Trace, Water
from calm.physics.track import Load
from calm.solve import solution
from calm.solve.closing import Closed
from calm.solve.line_shape import NO_OTHER, FoundShape
from calm.solve.problem import BELOW, CHANGED, FINE, MARCHES, MOST_AFLOAT, LineProblem
from calm.solve.search import ending_of_audit
from calm.solve.solution import Settings, Solution, Status, standing_lift, too_heavy

STATUS_OF = {
    solution.FOUND: Status.CONVERGED,
    solution.MARCH_STOPPED: Status.NOT_CONVERGED,
    solution.NO_SHAPE_NEAR: Status.NOT_CONVERGED,
    solution.MISSES: Status.NOT_CONVERGED,
    solution.SLACK_ON_DIGITS: Status.SLACK,
    solution.SLACK_AT_REST: Status.SLACK,
    solution.TOO_MANY_AFLOAT: Status.ABOVE_SURFACE,
    solution.RISES: Status.ABOVE_SURFACE,
    solution.DRAGGED_DOWN: Status.GROUNDED,
    solution.NOT_LYING: Status.GROUNDED,
    solution.UNSUPPORTED: Status.NO_EQUILIBRIUM,
    solution.BELOW_SEABED: Status.GROUNDED,
    solution.ABOVE_SURFACE: Status.ABOVE_SURFACE,
    solution.NOT_CLOSED: Status.NOT_CONVERGED,
    solution.OUT_OF_BALANCE: Status.NOT_CONVERGED,
    solution.FOLDED: Status.SLACK,
}
"""Status for each outcome of a search."""

_OF_CLAMP = {
    "clamp_buoyancy": "buoyancy",
    "clamp_volume": "volume",
    "clamp_drag": "normal_drag",
    "clamp_lift": "lift",
}
_OF_PIECE = {
    name: name
    for name in (
        "buoyancy",
        "volume",
        "normal_drag",
        "tangential_drag",
        "lift",
        "push_east",
        "push_north",
    )
}
"""Arrays of a `Line` with a force or drag of each piece, and the corresponding fields of `Load`."""


def solution_of(
    problem: LineProblem,
    line: Line,
    water: Water,
    settings: Settings,
    found: FoundShape,
    frequency: float = 0.0,
) -> Solution:
    """Build the solution from the shape on halved segments, in the record `FINE`.

    Parameters
    ----------
    problem : problem of the line, as left by the search
    frequency : strumming frequency of the cables [Hz]
    """
    closed, errors = found.closed, found.errors
    trace = Trace.of(problem.work.records[FINE], closed.nodes)
    trace.position[:, :2] -= trace.position[-1, :2]
    position, force = trace.better[:, :3].copy(), trace.better[:, 3:].copy()
    position[:, :2] -= position[-1, :2]
    used, reserve = _buoyancy_in_use(problem, found)
    unknown = closed.root.unknown
    floats = problem.surfacing[: unknown.sought + 1]
    riding = None
    if unknown.sought != BELOW and unknown.rides and line.floating is not None:
        riding = line.floating.riding(found.share)
    return Solution(
        line=line,
        water=water,
        settings=settings,
        position=position,
        force=force,
        marched=trace,
        element_piece=trace.piece,
        element_clamp=trace.clamp,
        landed=bool(closed.landed),
        hanging=closed.hanging,
        grounded_length=found.grounded,
        cut=trace.cut,
        strain=trace.strain,
        afloat=tuple(int(each[0]) for each in floats),
        buoyancy_used=used,
        reserve=reserve,
        carried=carried_by(line, problem) if unknown.sought != BELOW else line,
        riding=riding,
        marches=int(problem.work.left[MARCHES]),
        segments=closed.segments,
        miss=closed.root.miss,
        depth_error=errors.depth,
        tension_error=errors.tension,
        lift_error=errors.lift,
        pull_error=errors.pull,
        frequency=frequency,
        closure=found.closure,
        moment_residual=found.moment,
        other=None if found.other == NO_OTHER else found.other,
    )


def _buoyancy_in_use(problem: LineProblem, found: FoundShape) -> tuple[float, float]:
    """Return the used fraction of the surface floats' buoyancy, and their unused buoyancy [N]."""
    sought = found.closed.root.unknown.sought
    if sought == BELOW:
        return 1.0, 0.0
    lifts = [float(each[6]) for each in problem.surfacing[: sought + 1]]
    shares = [*problem.work.shares[0][:sought], found.share]
    total, used = sum(lifts), sum(a * b for a, b in zip(shares, lifts, strict=True))
    return float(used / total), float(total - used)


def carried_by(line: Line, problem: LineProblem) -> Line:
    """Return the line with the buoyancy and drag that its pieces have in the solution.

    Only the submerged part of a piece at the surface contributes.
    """
    if not problem.work.left[CHANGED]:
        return line
    columns = {name: getattr(line, name).copy() for name in (*_OF_PIECE, *_OF_CLAMP)}
    for i in range(int(problem.work.left[CHANGED])):
        load = Load(*problem.course.loads[i])
        where, names = (load.piece, _OF_PIECE) if load.clamp < 0 else (load.clamp, _OF_CLAMP)
        for column, name in names.items():
            columns[column][int(where)] = getattr(load, name)
    return replace(line, **columns)


def solution_found(
    found: FoundShape, problem: LineProblem, line: Line, water: Water, settings: Settings
) -> Solution:
    """Return the solution of a search that found an equilibrium.

    Raises
    ------
    NoEquilibrium
        The search found no equilibrium.
    """
    if found.closed.ending != solution.FOUND:
        raise refusal_of(found, line, water)
    return solution_of(problem, line, water, settings, found)


def refuse_unbalanced(closure: float, moment: float) -> None:
    """Raise NoEquilibrium if the forces or the moments of a solution do not balance.

    Parameters
    ----------
    closure : relative error of the force balance [-]
    moment : largest error of the moment balance [rad]
    """
    ending, value = ending_of_audit(closure, moment)
    if ending != solution.FOUND:
        raise audit_refusal(ending, value)


def audit_refusal(ending: int, value: float) -> NoEquilibrium:
    """Return the exception for a shape that failed the audit."""
    if ending == solution.NOT_CLOSED:
        return Status.NOT_CONVERGED.because(
            f"The forces on the line do not balance (relative error {value:.1e})."
        )
    return Status.NOT_CONVERGED.because(
        f"The moments on a piece do not balance (error {value:.1e} rad)."
    )


def closing_refusal(closed: Closed) -> NoEquilibrium:
    """Return the exception for a line that cannot be closed."""
    if closed.ending == solution.MARCH_STOPPED:
        return march_stopped(closed.value)
    if closed.ending == solution.NO_SHAPE_NEAR:
        return Status.NOT_CONVERGED.because(
            "No exact equilibrium was found near the approximate shape."
        )
    if closed.ending == solution.SLACK_ON_DIGITS:
        return Status.SLACK.because(
            "The line is slack: its shape changes if the buoyancy in use is rounded."
        )
    return Status.NOT_CONVERGED.because(
        f"The computed end of the line is {closed.value:.3g} m from the anchor."
    )


def march_stopped(failure: float, piece: int | None = None) -> NoEquilibrium:
    """Return the exception for a march that failed; `failure` is the number of the reason."""
    return Status.NOT_CONVERGED.because(
        f"The integration along the line stopped: {FAILURES[int(failure)]}.", piece
    )


def refusal_of(found: FoundShape, line: Line, water: Water) -> NoEquilibrium:
    """Return the exception for a moored line without a shape."""
    ending, value, piece = found.closed.ending, found.closed.value, found.closed.piece
    if ending in (
        solution.MARCH_STOPPED,
        solution.NO_SHAPE_NEAR,
        solution.MISSES,
        solution.SLACK_ON_DIGITS,
    ):
        return closing_refusal(found.closed)
    if ending == solution.UNSUPPORTED:
        return too_heavy(standing_lift(line, water))
    if ending == solution.SLACK_AT_REST:
        length = float(line.length.sum())
        radius = watch_circle_radius(length, water.depth - line.anchor_height)
        return Status.SLACK.because(
            f"There is no current and the line, {length:.1f} m unstretched, is longer than the "
            "water depth, so it has no unique shape. Its watch circle has a radius of "
            f"{radius:.{0 if radius >= 100.0 else 1}f} m."
        )
    if ending == solution.TOO_MANY_AFLOAT:
        return Status.ABOVE_SURFACE.because(
            f"More than {MOST_AFLOAT} consecutive floats would lie at the surface."
        )
    if ending == solution.RISES:
        return Status.ABOVE_SURFACE.because(
            "Buoyant parts of the line below the consecutive floats at its top would rise above "
            "the surface."
        )
    if ending == solution.DRAGGED_DOWN:
        return Status.GROUNDED.because("The current drags the whole line down to the seabed.")
    if ending == solution.NOT_LYING:
        return Status.GROUNDED.because(
            "The approximate shape has a part on the seabed, but the exact shape does not."
        )
    if ending == solution.BELOW_SEABED:
        return touching(piece, value, _excess_length_note(line, water))
    if ending == solution.ABOVE_SURFACE:
        return risen(piece, value, _excess_length_note(line, water))
    return audit_refusal(ending, value)


def _excess_length_note(line: Line, water: Water) -> str:
    depth, length = water.depth, float(line.length.sum())
    if length <= depth:
        return ""
    message = f" The line is {length:.1f} m long: its float would reach the surface."
    return message + (doubted_depth(depth) if length > 2.0 * depth else "")


def watch_circle_radius(length: float, height: float) -> float:
    """Return the largest horizontal distance of a surface float from its anchor [m].

    Parameters
    ----------
    length : length of the line from the float to the anchor [m]
    height : height of the surface above the top of the anchor [m]
    """
    return float(np.sqrt(max(length**2 - height**2, 0.0)))


def doubted_depth(depth: float) -> str:
    """Return a sentence that advises the user to check the water depth."""
    return f" The water is {depth:.1f} m deep: check `depth` and its unit (m, ft)."


def risen(piece: int, above: float, likely: str = "") -> NoEquilibrium:
    """Return the exception for a line that would rise out of the water."""
    return Status.ABOVE_SURFACE.because(
        f"The line would rise out of the water: {{piece}} is {above:.2f} m above the surface."
        + likely,
        piece,
    )


def touching(piece: int, below: float, likely: str = "") -> NoEquilibrium:
    """Return the exception for a line that would touch the seabed."""
    return Status.GROUNDED.because(
        f"The line would touch the seabed: {{piece}} is {below:.2f} m below it." + likely,
        piece,
    )
