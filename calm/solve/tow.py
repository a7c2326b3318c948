"""A towed line: how deep its free end runs behind a ship that steams on steadily."""

from dataclasses import dataclass, replace
from math import nan

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.compiled import outcome
from calm.physics.hull import AIR_DENSITY
from calm.physics.line import Floats, Line, MarchError, Water
from calm.solve.finish import refuse_unbalanced, solution_of
from calm.solve.least_change import bracketed_root
from calm.solve.search import audit_shape, stated_errors
from calm.solve.solution import OtherEquilibrium, Settings, Solution, Status
from calm.solve.towing import Towed, Waterline, half_out

SURFACE_BAND = 1e-7
"""Thickness of the band from water to air, as a share of the line out."""
SCAN = 16
"""Depths tried where the flow changes with depth: how finely separate equilibria are told apart."""
FARTHER = 1.05
"""In an even current, how far up the other side of the root is tried, in misses: where levels cut a
line a march is not quite the same at every depth."""
FREQUENCY_TOLERANCE = 1e-8
PAY_OUT = "Pay out more line."
NEARLY_OUT = 2e-3
"""Depth at which a line that will not close is taken to be leaving the water, as a share of it."""
AT_SURFACE = "The towed line comes up to the surface behind the ship."
STAY_BELOW = "Give it more weight or a depressor, or tow slower."
_ROUNDS = 20


@dataclass(frozen=True)
class Towing:
    """Hold what tows a line, and in what.

    Attributes
    ----------
    east, north : velocity of the ship over the ground [m/s]
    height : of the tow point above the surface [m]
    wind : velocity of the air to the east and north [m/s], for what of the line is above water
    in_air : whether the whole line is in the fluid of the `Water`, which has no surface: air
    """

    east: float
    north: float
    height: float = 0.0
    wind: tuple[float, float] = (0.0, 0.0)
    in_air: bool = False


def solve_tow(
    line: Line, water: Water, towing: Towing, settings: Settings | None = None
) -> Solution:
    """Solve for the steady shape of a towed line.

    Parameters
    ----------
    line : from the ship to the towed body
    water : current over the ground; its depth is inf where there is no seabed to touch
    settings : angle step, and tolerance as a share of the line out; 1° and 1e-7 where not given

    Returns
    -------
    Solution : from the free end: its piece 0 is the last of `line`, and x, y are those from the
        tow point. Of several equilibria the deepest, the first that a ship gathering way meets.
        At 1° positions are within 5e-5 of the line out, tensions within 2e-4.

    Raises
    ------
    NoEquilibrium
        ``above-surface`` where a part would leave the water, ``grounded`` where one would touch
        the seabed, ``not-converged`` where no shape passes every check.
    """
    towed = replace(line.reversed(), towed=True)
    water = _relative(line, water, towing)
    tow = Towed(towed, water, settings or Settings(), towing.height)
    found = False
    try:
        if tow.span == 0.0:
            raise Status.NO_EQUILIBRIUM.because("The towed line has no length.", advice=PAY_OUT)
        _refuse_limp(towed)
        other_depth = _locate(tow, towing)
        found = True
        if towed.strumming is not None and towed.diameter.any():
            _set_frequency(tow)
        refined = tow.refine(lambda cuts, record: _polish(tow, towing, cuts, record))
    except (MarchError, NoEquilibrium) as failure:
        if found and not towing.in_air and _surfaces(tow):
            raise Status.ABOVE_SURFACE.because(AT_SURFACE, advice=STAY_BELOW) from failure
        if isinstance(failure, MarchError):
            message = f"The march stopped: {failure}."
            raise Status.NOT_CONVERGED.because(message) from failure
        if found and towing.height > 0.0 and not towing.in_air:
            raise half_out(tow) or failure from failure
        raise
    problem = tow.search.problem
    errors = outcome(stated_errors, tow.compiled, problem, refined)
    solution = solution_of(problem, towed, water, tow.settings, refined, errors, tow.frequency)
    _refuse_misplaced(solution, towing)
    closure, moment = outcome(audit_shape, tow.compiled, problem, tow.referee, refined.closed)
    refuse_unbalanced(closure, moment)
    other = None if other_depth is None else OtherEquilibrium(other_depth, 0.0, 1.0, nan, nan)
    return replace(solution, closure=closure, moment_residual=moment, other=other)


def _refuse_limp(towed: Line) -> None:
    """A free end of cable without weight or drag along it bears nothing, and points nowhere."""
    bears = towed.buoyancy[0] or towed.volume[0] or towed.tangential_drag[0]
    clamped = ((towed.clamp_piece == 0) & (towed.clamp_at == 0.0)).any()
    if towed.flexible[0] and not bears and not clamped:
        raise Status.NO_EQUILIBRIUM.because(
            "The free end of {piece} weighs nothing and has no drag along it, so nothing "
            "stretches it.",
            0,
            "Give it a weight or a `ct`, or tow something at its end.",
        )


def _relative(line: Line, water: Water, towing: Towing) -> Water:
    """The water as the ship sees it, air above its surface where the line passes that.

    From water to air the flow and the density change over a thin band about the surface: so thin
    that the shape is the same, and steady enough that the march is.
    """
    u, v = water.u - towing.east, water.v - towing.north
    if towing.in_air or towing.height == 0.0:
        return replace(water, u=u, v=v)
    half = 0.5 * SURFACE_BAND * float(line.length.sum())
    below = water.level > half
    density = water.density_at(np.array(half))
    surface = water.current_at(np.array(half)) - (towing.east, towing.north, 0.0)
    air = np.array([towing.wind[0] - towing.east, towing.wind[1] - towing.north, 0.0])

    # the density changes first: dense air, or water with the speed of the wind, would drag hard
    def column(in_air: float, at_surface: float, values: Floats) -> Floats:
        return np.array([in_air, at_surface, at_surface, *values[below]])

    return replace(
        water,
        level=np.array([-3.0 * half, -half, half, *water.level[below]]),
        u=column(air[0], surface[0], u),
        v=column(air[1], surface[1], v),
        w=column(air[2], surface[2], water.w),
        density=np.array([AIR_DENSITY, AIR_DENSITY, density, *water.density[below]]),
    )


def _locate(tow: Towed, towing: Towing) -> float | None:
    """Find the deepest coarse root; the depth of the free end at the next one above [m]."""
    shallowest = -towing.height - tow.span if towing.in_air else 0.0
    depth = max(tow.span - towing.height, tow.span * 1e-3)
    low = tow.coarse_miss(depth)
    while low > 0.0:  # the line stretches
        if depth > 100.0 * tow.span:
            raise Status.NOT_CONVERGED.because("The line stretches without end.")
        depth += 2.0 * low
        low = tow.coarse_miss(depth)
    found = False
    for upper in _upwards(tow, depth, low, shallowest):
        try:
            high = tow.coarse_miss(upper)
        except MarchError:
            # a line that drifts at the surface is now in the water, now in the air
            if upper != shallowest or towing.in_air or found:
                raise
            upper = NEARLY_OUT * tow.span
            if tow.coarse_miss(upper) <= 0.0:
                raise Status.ABOVE_SURFACE.because(AT_SURFACE, advice=STAY_BELOW) from None
            high = tow.coarse_miss(upper)
        if upper == shallowest and -tow.allowed <= high <= 0.0:
            high = tow.allowed  # at the surface, to within what is allowed
        if (low <= 0.0) is not (high <= 0.0):
            root = tow.coarse_root(upper, high, depth, low)
            if found:
                return root.x
            tow.root, found = root, True
        depth, low = upper, high
    if not found and tow.span <= towing.height:
        raise Status.ABOVE_SURFACE.because(
            f"The line, {tow.span:.2f} m long, does not reach the water from "
            f"{towing.height:g} m above it.",
            advice=PAY_OUT,
        )
    if not found:
        raise Status.ABOVE_SURFACE.because(
            "The towed body would come out of the water: even at the surface the line's upper end "
            f"is {-low:.2f} m below the tow point.",
            advice=STAY_BELOW,
        )
    return None


def _upwards(tow: Towed, depth: float, low: float, shallowest: float) -> list[float]:
    """Depths to try, from below; where nothing changes with depth the miss itself is the way."""
    water = tow.water
    if any(np.ptp(column) for column in (water.u, water.v, water.w, water.density)):
        steps: list[float] = np.linspace(depth, shallowest, SCAN + 1)[1:].tolist()
        return steps
    return [max(depth + FARTHER * low - tow.allowed, shallowest)]


def _set_frequency(tow: Towed) -> None:
    """Find the coarse root of a line that strums at the frequency its angle at the ship gives it.

    The frequency that follows falls as the one assumed rises, since more drag lifts the line: so
    there is one.
    """

    def excess(_: None, frequency: float) -> float:
        tow.strum(frequency)
        tow.find_coarser()
        tow.coarse_miss(tow.root.x)
        return _frequency(tow) - frequency

    most = excess(None, 0.0)
    if most > 0.0:
        frequency, *_ = bracketed_root(
            excess, None, 0.0, most, most, excess(None, most), 1e-3 * most, 1e-9 * most
        )
        tow.strum(frequency)


def _polish(tow: Towed, towing: Towing, cuts: int, record: int) -> None:
    """Close the line on cuts at its own frequency, found by secants, with a node at the surface."""
    tow.polish(cuts, record)
    waterline = None
    if towing.height > 0.0 and not towing.in_air:
        waterline = Waterline(tow, max(tow.allowed, SURFACE_BAND * tow.span))
    before, lacked, slope = 0.0, 0.0, -1.0
    for _ in range(_ROUNDS):
        frequency, lacking = tow.frequency, 0.0
        if frequency > 0.0:
            lacking = _frequency(tow) - frequency
        moved = waterline is not None and waterline.moves(cuts, record)
        if abs(lacking) <= FREQUENCY_TOLERANCE * frequency and not moved:
            return
        if before and frequency != before:
            slope = min((lacking - lacked) / (frequency - before), -1.0)
        before, lacked = frequency, lacking
        tow.strum(frequency - lacking / slope)
        tow.polish(cuts, record)
    raise Status.NOT_CONVERGED.because("The frequency of the strumming line does not settle.")


def _frequency(tow: Towed) -> float:
    """F = 0.166 V₀ sin φ_n/D [Hz], from the angle to the flow at the ship of the last march."""
    law, line = tow.line.strumming, tow.line
    assert law is not None
    diameter = float(line.diameter[line.diameter > 0.0][-1])
    flow = tow.water.current_at(np.array(0.5 * SURFACE_BAND * tow.span))
    force = np.array(tow.force)
    across = float(np.linalg.norm(np.cross(flow, force)) / np.linalg.norm(force))
    return law.strouhal * across / diameter


def _surfaces(tow: Towed) -> bool:
    """Return whether the line comes near to the surface on the far side of its lowest point."""
    try:
        trace = tow.shape_at(tow.root.x, tow.coarse_step)
    except MarchError:
        return tow.root.x < NEARLY_OUT * tow.span
    height = trace.position[:, 2]
    return bool(height[: int(np.argmin(height)) + 1].max() > -NEARLY_OUT * tow.span)


def _refuse_misplaced(solution: Solution, towing: Towing) -> None:
    """Only what hangs between the surface and the ship may be in the air; nothing is in the bed."""
    height, depth = solution.position[:, 2], solution.water.depth
    margin = max(solution.depth_error, 1e-6 * float(solution.line.length.sum()))
    lowest = int(np.argmin(height))
    if height[lowest] < -depth - margin:
        piece = solution.piece_at(lowest)
        raise Status.GROUNDED.because(
            f"The towed line would touch the seabed: {{piece}} comes "
            f"{-depth - height[lowest]:.2f} m below it.",
            piece,
            "Pay out less line, tow faster, or remove weight.",
        )
    if towing.in_air:
        return
    wetted = np.flatnonzero(height <= margin)
    below_water = max(int(wetted[-1]), solution.body_node) if len(wetted) else 0
    out = int(np.argmax(height[: below_water + 1]))
    if not len(wetted) or height[out] > margin:
        piece = solution.piece_at(out)
        raise Status.ABOVE_SURFACE.because(
            f"The towed line would rise out of the water: {{piece}} comes "
            f"{height[out]:.2f} m above the surface.",
            piece,
            STAY_BELOW,
        )
