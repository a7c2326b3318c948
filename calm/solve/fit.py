"""Fit of the length of a piece to a required depth.

The required depth is the depth of the top of a mooring in still water, or the depth of a towed
body.
"""

from dataclasses import replace
from math import inf

from calm.errors import NoEquilibrium
from calm.physics.line import Line, MarchError, Water
from calm.physics.march import march
from calm.physics.profile import Profile
from calm.physics.track import Track
from calm.solve.finish import doubted_depth
from calm.solve.least_change import root_near
from calm.solve.mooring import solve_mooring
from calm.solve.problem import COARSE_STEP, REACH
from calm.solve.solution import (
    Settings,
    Status,
    refuse_unsupported,
    standing_lift,
    too_heavy,
)
from calm.solve.tow import Towing, solve_tow
from calm.solve.two_speeds import runs_compiled


def fit_length(line: Line, water: Water, piece: int, top_depth: float, settings: Settings) -> float:
    """Find the unstretched length [m] of a piece that puts the line's top at a given depth.

    Parameters
    ----------
    line : the line; the present length of the piece is ignored
    top_depth : required depth of the free end in still water [m]

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` if no length fits or the buoyancy is too small; ``slack`` if the line
        would fold; other statuses as in `solve_mooring`.
    """
    still_water = water.still()
    refuse_unsupported(line, still_water)
    upright = _upright_length(line, still_water, piece, top_depth, settings)
    shortest = float(line.clamp_at[line.clamp_piece == piece].max(initial=0.0))
    # long segments are exact for a plumb line
    coarse = replace(settings, angle_step=max(settings.angle_step, COARSE_STEP))

    def excess_depth(_: None, length: float) -> float:
        try:
            solution = solve_mooring(line.with_length(piece, length), still_water, coarse)
        except NoEquilibrium as refusal:
            if refusal.status not in (Status.SLACK.label, Status.ABOVE_SURFACE.label):
                raise
            return -top_depth
        return -float(solution.position[0, 2]) - top_depth

    near = settings.tolerance * water.depth
    if upright is not None and abs(excess_depth(None, upright)) <= near:
        return upright
    # part of the line lies on the seabed, so a longer piece does not lengthen the suspended part
    room = water.depth - line.anchor_height - top_depth
    others = float(line.length.sum()) - float(line.length[piece])
    start = max(room - others, shortest) if upright is None else upright
    found, fitting, left, _ = root_near(
        excess_depth, None, start, -1.0, shortest, water.depth, near, 1e-9 * water.depth
    )
    if found and abs(left) <= near:
        return fitting
    lift = standing_lift(line, water)
    if float(lift[:piece].sum()) <= 0.0:
        raise too_heavy(lift)
    clamped = f", and {{piece}} is at least {shortest:.2f} m long down to its lowest clamp"
    raise Status.NO_EQUILIBRIUM.because(
        f"No length of {{piece}} puts the top of the line at {top_depth:g} m. Only {room:.2f} m is "
        f"available, but the other pieces are {others:.2f} m long (unstretched)"
        f"{clamped if shortest else ''}."
        + (doubted_depth(water.depth) if others > 2.0 * room else ""),
        piece,
    )


def _upright_length(
    line: Line, water: Water, piece: int, top_depth: float, settings: Settings
) -> float | None:
    """Return the length [m] of a piece that gives an upright line the top depth, or None."""
    still, goal = Profile(water), line.anchor_height - water.depth
    room = water.depth - line.anchor_height - top_depth

    compiled = runs_compiled(settings)

    def miss(_: None, length: float) -> float:
        track = Track.of(line.with_length(piece, length))
        # a plumb line's strain is linear along it, so long segments are exact
        end = march(
            track,
            still,
            top_depth,
            angle_step=COARSE_STEP,
            reach=4 * REACH * water.depth,
            compiled=compiled,
        )
        return end.z - goal

    small = 0.01 * settings.tolerance * water.depth
    others = float(line.length.sum()) - float(line.length[piece])
    shortest = float(line.clamp_at[line.clamp_piece == piece].max(initial=0.0))
    try:
        found, fitting, left, _ = root_near(
            miss, None, room - others, -1.0, shortest, water.depth, small, 1e-9 * water.depth
        )
    except MarchError as error:
        raise Status.NOT_CONVERGED.because(
            f"The integration along the line stopped: {error}.", piece
        ) from error
    if not found or abs(left) > settings.tolerance * water.depth:
        return None
    return fitting


def fit_tow_length(
    line: Line, water: Water, towing: Towing, piece: int, depth: float, settings: Settings
) -> float:
    """Find the unstretched length of a towed cable that puts its lower end at a given depth [m].

    Parameters
    ----------
    line : line from the ship to the towed body; the present length of the piece is ignored
    depth : required depth of the cable's lower end at the towing speed [m]

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` if no length up to a thousand times the depth fits, or as in `solve_tow`;
        ``not-converged`` as in `solve_tow`.
    """
    bottomless = replace(water, depth=inf)
    node = len(line.length) - 1 - piece

    def lacking(_: None, length: float) -> float:
        try:
            out = line.with_length(piece, length)
            solution = solve_tow(out, bottomless, towing, settings)
        except NoEquilibrium as refusal:
            if refusal.status != Status.ABOVE_SURFACE.label:
                raise
            return depth
        return depth + float(solution.position[solution.piece_nodes[node, 0], 2])

    shortest = float(line.clamp_at[line.clamp_piece == piece].max(initial=1e-3 * depth))
    longest = 1000.0 * depth
    start = max(depth + towing.height, shortest)
    # the depth jumps, within the accuracy, where the number of segments changes
    found, fitting, left, _ = root_near(
        lacking, None, start, -1.0, shortest, longest, 1e-7 * depth, 1e-9 * depth
    )
    if not found or left > 1e-4 * depth:
        short = lacking(None, shortest)
        out, lack = (shortest, short) if short < 0.0 else (longest, lacking(None, longest))
        raise Status.NO_EQUILIBRIUM.because(
            f"No length of {{piece}} brings its lower end to {depth:g} m at this speed: "
            f"with {out:g} m paid out, the lower end is at {depth - lack:.2f} m.",
            piece,
            "Choose another depth or speed, or change the weight of the cable or towed body.",
        )
    return fitting
