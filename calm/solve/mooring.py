"""A moored line: find where its free end is, so that its other end meets the anchor.

The root is bracketed from the upright side with coarse marches, polished on fixed segments twice
as long as asked for, and polished again with every segment halved. The march is of second order,
so a third of the change is the error of the finer shape; where that is too much, the segments
are halved again.
"""

from __future__ import annotations

from dataclasses import replace
from math import degrees

import numpy as np

from calm.physics.line import REFERENCE_DENSITY, Floats, Line, Water
from calm.physics.march import Cuts
from calm.physics.state import MarchError
from calm.solve import audit
from calm.solve.closing import Closed, Closing
from calm.solve.locate import locate
from calm.solve.solution import Settings, Solution, nodes_of
from calm.solve.status import Status

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Error estimates, relative to the water depth and to the tension, above which segments are
halved again, at an angle step of 1°; they follow its square."""
MOST_HALVINGS = 6
MOST_SEGMENTS = 20_000


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
    closing = Closing(line, water, settings or Settings())
    try:
        if float(line.total_buoyancy.sum()) <= 0.0:
            raise Status.NO_EQUILIBRIUM.because(_too_heavy(line))
        if not water.moving:
            _stands_at_rest(line)
        solution = _refined(closing)
    except MarchError as error:
        raise Status.NOT_CONVERGED.because(f"The march stopped: {error}.") from error
    return _audited(solution)


def _too_heavy(line: Line) -> str:
    total = line.total_buoyancy
    lift, weight = float(total[total > 0].sum()), float(-total[total < 0].sum())
    return (
        f"Too little buoyancy to hold the line up: its buoyant pieces lift {lift:.0f} N, the "
        f"others weigh {weight:.0f} N in water."
    )


def _stands_at_rest(line: Line) -> None:
    """Still water: once the line is held up it must stay so, down to the anchor."""
    above = np.cumsum(line.total_buoyancy)
    first = int(np.argmax(above > 0.0))
    short = np.flatnonzero(above[first:] <= 0.0)
    if len(short):
        piece = first + int(short[0])
        raise Status.SLACK.because(
            f"In still water the line is slack below piece {piece + 1}: {-above[piece]:.0f} N are "
            "lacking to hold up what is above.",
            piece,
        )


def _refined(closing: Closing) -> Solution:
    unknown, x, slope, other_depth = locate(closing)
    step = closing.settings.angle_step
    cuts = closing.run(unknown, x, 2.0 * step).cuts
    fine = closing.polish(unknown, x, slope, cuts)
    for _ in range(MOST_HALVINGS):
        coarse = fine
        cuts = _halved(coarse.end.cuts)
        fine = closing.polish(coarse.unknown, coarse.x, coarse.slope, cuts)
        depth_error, tension_error, relative = _errors(closing.line, coarse, fine)
        scale = degrees(step) ** 2
        good = (
            depth_error <= DEPTH_TARGET * scale * closing.water.depth
            and relative <= TENSION_TARGET * scale
        )
        if good or fine.end.segments > MOST_SEGMENTS:
            break
    return _solution(closing, fine, depth_error, tension_error, other_depth)


def _halved(cuts: Cuts) -> Cuts:
    return [[0.5 * cut for cut in cable for _ in (0, 1)] for cable in cuts]


def _errors(line: Line, coarse: Closed, fine: Closed) -> tuple[float, float, float]:
    """Error of the finer shape: of depths and offsets [m], of tensions [N] and relative."""
    pieces, clamps = np.array(coarse.trace.piece), np.array(coarse.trace.clamp)
    halves = np.where(line.flexible[pieces] & (clamps < 0), 2, 1)
    same = np.concatenate([[0], np.cumsum(halves)])
    position, force = nodes_of(fine.trace)
    before, pulled = nodes_of(coarse.trace)
    tension = np.linalg.norm(force[same], axis=1)
    change = np.abs(np.linalg.norm(pulled, axis=1) - tension) / 3.0
    floor = 1e-3 * float(tension.max())
    return (
        float(np.abs(before - position[same]).max()) / 3.0,
        float(change.max()),
        float((change / np.maximum(tension, max(floor, 1e-300))).max()),
    )


def _solution(
    closing: Closing, fine: Closed, depth_error: float, tension_error: float, other: float | None
) -> Solution:
    position, force = nodes_of(fine.trace)
    used, reserve = _buoyancy_in_use(closing, fine)
    return Solution(
        line=closing.line,
        water=closing.water,
        settings=closing.settings,
        position=position,
        force=force,
        element_piece=np.array(fine.trace.piece, dtype=np.int64),
        element_clamp=np.array(fine.trace.clamp, dtype=np.int64),
        cut=np.array(fine.trace.cut),
        strain=np.array(fine.trace.strain),
        afloat=tuple(fine.unknown.shares(fine.x)),
        buoyancy_used=used,
        reserve=reserve,
        carried=_carried(closing.line, fine.unknown.shares(fine.x)),
        marches=closing.marches,
        segments=fine.end.segments,
        miss=fine.miss,
        depth_error=depth_error + abs(fine.miss),
        tension_error=tension_error,
        other_depth=other,
    )


def _buoyancy_in_use(closing: Closing, fine: Closed) -> tuple[float, float]:
    """Share in use of the buoyancy of the floats at the surface, and the rest of it [N]."""
    shares = fine.unknown.shares(fine.x)
    if not shares:
        return 1.0, 0.0
    _, density = closing.water.at(np.zeros(1))
    excess = (float(density[0]) - REFERENCE_DENSITY) * closing.water.gravity
    lift = {p: float(closing.line.buoyancy[p] + excess * closing.line.volume[p]) for p in shares}
    total = sum(lift.values())
    used = sum(shares[p] * lift[p] for p in shares)
    return used / total, total - used


def _carried(line: Line, shares: dict[int, float]) -> Line:
    """The line with the buoyancies in use: floats at the surface count by their share."""
    share = np.ones(len(line.length))
    for piece, used in shares.items():
        share[piece] = used
    return replace(line, buoyancy=line.buoyancy * share, volume=line.volume * share)


def _audited(solution: Solution) -> Solution:
    """The solution with its closure and moment residual; refused where a check fails."""
    _within_the_water(solution)
    solution = replace(
        solution,
        closure=audit.closure(solution),
        moment_residual=audit.moment_residual(solution),
    )
    if not solution.closure <= audit.LARGEST_CLOSURE:
        raise Status.NOT_CONVERGED.because(
            f"The loads do not sum to the anchor force: they are {solution.closure:.1e} off."
        )
    if not solution.moment_residual <= audit.LARGEST_MOMENT:
        raise Status.NOT_CONVERGED.because(
            f"A piece is {solution.moment_residual:.1e} rad out of balance."
        )
    return solution


def _within_the_water(solution: Solution) -> None:
    height: Floats = solution.position[:, 2]
    depth = solution.water.depth
    margin = max(solution.depth_error, 1e-6 * depth)
    # a float at the surface may stand out of it, however it is turned
    standing = float(solution.line.length[list(solution.afloat)].sum())
    lowest, highest = int(np.argmin(height)), int(np.argmax(height))
    if height[lowest] < -depth - margin:
        piece = _piece_at(solution, lowest)
        raise Status.GROUNDED.because(
            f"The line would touch the seabed: piece {piece + 1} comes "
            f"{-depth - height[lowest]:.2f} m below it.",
            piece,
        )
    if height[highest] > margin + standing:
        piece = _piece_at(solution, highest)
        raise Status.ABOVE_SURFACE.because(
            f"The line would rise out of the water: piece {piece + 1} comes "
            f"{height[highest]:.2f} m above the surface.",
            piece,
        )


def _piece_at(solution: Solution, node: int) -> int:
    return int(solution.element_piece[max(node - 1, 0)])
