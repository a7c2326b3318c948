"""Steady shape of a line towed by a ship.

A tow is solved as a leg of a net that is held at the ship (`calm.solve.net`). This module first
finds the approximate depth of the free end.
"""

from dataclasses import dataclass, replace
from functools import partial
from math import inf, isnan, nan

import numpy as np

from calm.errors import NoEquilibrium
from calm.physics.hull import AIR_DENSITY
from calm.physics.line import GOES_ON, Floats, Line, Trace, Water
from calm.physics.passing import FAILURE
from calm.solve import leg_closing
from calm.solve.finish import march_stopped
from calm.solve.least_change import bracketed_root
from calm.solve.leg_layout import LegEnd, NetLeg
from calm.solve.leg_numbers import FREQUENCY, LACKING
from calm.solve.net import NetSearch, NetSolution, with_room
from calm.solve.problem import CHOSEN, COARSE_STEP, FINE, HALVED
from calm.solve.solution import (
    FOUND,
    OtherEquilibrium,
    Settings,
    Solution,
    Status,
)
from calm.solve.two_speeds import CompiledPart, count_lines

SURFACE_BAND = 1e-7
"""Thickness of the transition from water to air, as a fraction of the paid-out length."""
SCAN = 16
"""Number of depths tried if the flow varies with depth. Separate equilibria closer than this
spacing are not distinguished.
"""
OVERSHOOT = 1.05
"""Distance to the second depth tried in uniform water, as a multiple of the height error.

The distance exceeds the height error because the march varies slightly with depth, since water
levels divide a line.
"""
ROUGHLY = 5e-3
"""Height error at which the search for an approximate equilibrium ends.

The error is a fraction of the paid-out length. One linear step then completes the search.
"""
SAME = 1e-6
"""Relative tolerance of the strumming frequency."""
LEAVING_DEPTH = 2e-3
"""Depth of a free end near the surface, as a fraction of the paid-out length.

A line with a shallower free end that cannot be closed is assumed to be leaving the water.
"""
NARROW_JUMP, AT_THE_JUMP = 1e-9, 1e-6
"""Tolerances for a body half out of the water, as fractions of the paid-out length.

The height error of the line's upper end jumps if the midpoint of the body crosses the surface.
NARROW_JUMP is the width of the jump, in depths of the free end. AT_THE_JUMP is the largest distance
of the body from the surface.
"""
PAY_OUT = "Pay out more line."
RIDE_CLEAR = "Pay out or take in some line, so that no rigid piece or clamp is at the surface."
AT_SURFACE = "The towed line reaches the surface behind the ship."
STAY_BELOW = "Add weight or a depressor, or reduce the towing speed."


@dataclass(frozen=True)
class Towing:
    """Motion of the ship, height of the tow point, and wind.

    Attributes
    ----------
    east, north : velocity of the ship over the ground [m/s]
    height : height of the tow point above the surface [m]
    wind : wind velocity to the east and north [m/s]
    in_air : whether the whole line is in air; its `Water` then describes the air
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
    line : the line from the ship to the towed body
    water : water with the current over the ground; its depth is inf if the seabed is ignored
    settings : angle step (1° by default) and tolerance (1e-7 of the paid-out length by default)

    Returns
    -------
    Solution : the deepest equilibrium, which an accelerating ship reaches first. Piece 0 is the
        last piece of `line`; x and y are relative to the tow point. At an angle step of 1°, errors
        of positions are at most 5e-5 of the paid-out length, and relative errors of tensions 2e-4.

    Raises
    ------
    NoEquilibrium
        - ``above-surface`` or ``grounded`` if a part would leave the water or touch the seabed
        - ``no-equilibrium`` if the free end is limp, or a rigid piece or clamp half out of the
          water
        - ``not-converged`` if no shape passes every check
    """
    if not line.length.any():
        raise Status.NO_EQUILIBRIUM.because("The towed line has no length.", advice=PAY_OUT)
    _refuse_limp(line)
    count_lines(1.0, CompiledPart.LEGS)
    water = _relative(line, water, towing)
    u, v, w = map(float, water.current_at(np.zeros(())))
    ship = LegEnd(place=(0.0, 0.0, towing.height), past=(u, v, w))
    leg = NetLeg(line, ship, LegEnd())
    solve = partial(_solved, towing=towing)
    found, other_depth = with_room(solve, [leg], 0, water, settings or Settings())
    other = None if other_depth is None else OtherEquilibrium(other_depth, 0.0, 1.0, nan, nan)
    solution = replace(found.legs[0], miss=found.miss, other=other)
    _refuse_misplaced(solution, towing)
    return solution


def _refuse_limp(line: Line) -> None:
    """Raise NoEquilibrium if the free end is a cable whose direction is undefined.

    Such a cable has neither weight nor tangential drag, and no body at its end.
    """
    bears = line.buoyancy[-1] or line.volume[-1] or line.tangential_drag[-1]
    last = len(line.length) - 1
    clamped = ((line.clamp_piece == last) & (line.clamp_at == line.length[-1])).any()
    if line.flexible[-1] and not bears and not clamped:
        raise Status.NO_EQUILIBRIUM.because(
            "The free end of {piece} has neither weight nor tangential drag, so its "
            "direction is undefined.",
            0,
            "Set its weight or `ct`, or attach a body to its end.",
        )


def _relative(line: Line, water: Water, towing: Towing) -> Water:
    """Return the water as seen from the ship, with air above if the tow point is in air.

    Flow and density change between water and air over a thin band at the surface.
    """
    u, v = water.u - towing.east, water.v - towing.north
    if towing.in_air or towing.height == 0.0:
        return replace(water, u=u, v=v)
    # thin enough not to change the shape, and smooth enough for the march
    half = 0.5 * SURFACE_BAND * float(line.length.sum())
    below = water.level > half
    density = water.density_at(np.array(half))
    surface = water.current_at(np.array(half)) - (towing.east, towing.north, 0.0)
    air = np.array([towing.wind[0] - towing.east, towing.wind[1] - towing.north, 0.0])

    # the density changes first, since dense air, or water with the speed of the wind, would cause
    # large drag
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


class _Marches:
    """Marches of a towed line from given depths of its free end.

    Parameters
    ----------
    step : angle step [rad]
    kept : segment list to use, `CHOSEN` or `HALVED`; None if each march chooses its segments
    """

    def __init__(self, net: NetSearch, step: float, kept: int | None = None) -> None:
        self.net, self.span = net, net.net.length
        cuts = CHOSEN if kept is None else kept
        self._how = net.marching(step, cuts, FINE, given=kept is not None)
        self.failure = GOES_ON

    @property
    def shape(self) -> Trace:
        return self.net.shape(0, np.zeros(1))

    def miss(self, _: None, depth: float) -> float:
        """Return the height of the upper end above the tow point [m], or NaN if the march stops."""
        self.failure, _same = self.net.do(leg_closing.MARCH, np.array([depth]), self._how)
        return float(self.net.net.found[0]) * self.span if self.failure == GOES_ON else nan


def _solved(net: NetSearch, towing: Towing) -> tuple[NetSolution, float | None]:
    """Return the deepest equilibrium, and the free-end depth of the second deepest or None [m]."""
    rough = _Marches(net, max(COARSE_STEP, 2.0 * net.settings.angle_step))
    start, other_depth = _locate(rough, towing)
    how = net.marching(net.settings.angle_step, CHOSEN, FINE, given=False)
    ending, x = net.do(leg_closing.SETTLE, np.array([start]), how, leg_closing.CLOSED)
    if ending != FOUND or _lacking(net):
        raise _why_not(rough, start, float(x[0]), towing)
    return net.solution(x), other_depth


def _lacking(net: NetSearch) -> bool:
    """Return whether the strumming and shedding frequencies at the ship still differ."""
    return bool(abs(net.net.state[0][LACKING]) > SAME * net.net.state[0][FREQUENCY])


def _locate(rough: _Marches, towing: Towing) -> tuple[float, float | None]:
    """Find approximate depths of the free end [m] in the deepest and second deepest equilibria."""
    span = rough.span
    found: list[float] = []
    allowed = rough.net.settings.tolerance * span
    shallowest = -towing.height - span if towing.in_air else 0.0
    depth = max(span - towing.height, 1e-3 * span)
    low = rough.miss(None, depth)
    while low > 0.0:  # the line stretches
        if depth > 100.0 * span:
            raise Status.NOT_CONVERGED.because("The stretch of the line grows without limit.")
        depth += 2.0 * low
        low = rough.miss(None, depth)
    _refuse_stopped(rough, low)
    for upper in _upwards(rough.net.water, depth, low, span, shallowest):
        high = rough.miss(None, upper)
        if isnan(high) and found:
            break
        if isnan(high) and upper == shallowest and not towing.in_air:
            # a line that drifts at the surface is alternately in the water and in the air
            upper = LEAVING_DEPTH * span
            high = rough.miss(None, upper)
            if high <= 0.0:
                raise Status.ABOVE_SURFACE.because(AT_SURFACE, advice=STAY_BELOW)
        _refuse_stopped(rough, high)
        if upper == shallowest and -allowed <= high <= 0.0:
            high = allowed  # at the surface, within the tolerance
        if (low <= 0.0) is not (high <= 0.0):
            found.append(_root(rough, upper, high, depth, low))
            if len(found) > 1:
                break
        depth, low = upper, high
    if found:
        return found[0], found[1] if len(found) > 1 else None
    if span <= towing.height:
        raise Status.ABOVE_SURFACE.because(
            f"The line, {span:.2f} m long, does not reach the water from "
            f"{towing.height:g} m above it.",
            advice=PAY_OUT,
        )
    raise Status.ABOVE_SURFACE.because(
        "The towed body would come out of the water: even with the body at the surface, the upper "
        f"end of the line would be {-low:.2f} m below the tow point.",
        advice=STAY_BELOW,
    )


def _upwards(water: Water, depth: float, low: float, span: float, shallowest: float) -> list[float]:
    """Return the depths of the free end to try, the deepest first.

    In uniform water, one depth is enough: the distance to the equilibrium equals the height error
    `low` of the march at `depth`.
    """
    if any(np.ptp(column) for column in (water.u, water.v, water.w, water.density)):
        steps: list[float] = np.linspace(depth, shallowest, SCAN + 1)[1:].tolist()
        return steps
    return [max(depth + OVERSHOOT * low - NARROW_JUMP * span, shallowest)]


def _root(rough: _Marches, upper: float, high: float, depth: float, low: float) -> float:
    span = rough.span
    x, left, slope = bracketed_root(
        rough.miss, None, upper, high, depth, low, ROUGHLY * span, NARROW_JUMP * span
    )
    _refuse_stopped(rough, left)
    return min(max(x - left / slope, upper), depth) if slope < 0.0 else x


def _refuse_stopped(rough: _Marches, miss: float) -> None:
    if isnan(miss):
        raise march_stopped(rough.failure)


def _why_not(rough: _Marches, start: float, last: float, towing: Towing) -> NoEquilibrium:
    """Diagnose why no exact equilibrium of a tow was found.

    Parameters
    ----------
    start, last : approximate depth of the free end, and depth in the last attempt [m]
    """
    net, nearly_out = rough.net, LEAVING_DEPTH * rough.span
    stopped, lacking = net.net.lines.work.left[0][FAILURE], _lacking(net)
    failure = Status.NOT_CONVERGED.because(
        "No exact equilibrium was found near the approximate shape."
    )
    if stopped != GOES_ON:
        failure = march_stopped(stopped)
    elif lacking:
        failure = Status.NOT_CONVERGED.because(
            "The strumming frequency of the line does not converge."
        )
    if towing.in_air:
        return failure
    half_out = _half_out(net, last, lacking) if towing.height > 0.0 else None
    surfaces = start < nearly_out
    if not isnan(rough.miss(None, start)):
        height = rough.shape.position[:, 2]
        surfaces = bool(height[: int(np.argmin(height)) + 1].max() > -nearly_out)
    if surfaces:
        return Status.ABOVE_SURFACE.because(AT_SURFACE, advice=STAY_BELOW)
    return half_out or failure


def _half_out(net: NetSearch, depth: float, lacking: bool) -> NoEquilibrium | None:
    """Diagnose a rigid piece or a clamp that would be half out of the water, or return None.

    Parameters
    ----------
    depth : depth of the free end in the last attempt to close the line [m]
    lacking : whether the strumming frequency did not converge there
    """
    # The march treats a body as wholly in water or wholly in air, by the position of its midpoint.
    # The miss or the frequency therefore jumps if the midpoint crosses the surface.
    step, flexible = net.settings.angle_step, net.laid[0].line.flexible
    for kept in (_Marches(net, 2.0 * step, CHOSEN), _Marches(net, step, HALVED)):
        beside = NARROW_JUMP * kept.span
        above, below = kept.miss(None, depth - beside), kept.miss(None, depth + beside)
        shape, height = kept.shape, kept.shape.position[:, 2]
        bodies = np.flatnonzero(~flexible[shape.piece] | (shape.clamp >= 0))
        ends = np.sort([height[bodies], height[bodies + 1]], axis=0)
        off = np.maximum(ends[0], -ends[1])  # distance from the surface
        if not (lacking or above > 0.0 > below) or off.min(initial=inf) > AT_THE_JUMP * kept.span:
            continue
        body = bodies[np.argmin(off)]
        what = "{piece}" if shape.clamp[body] < 0 else "a clamp on {piece}"
        why = (
            f"the upper end of the line would be {above:.2g} m above the tow point in one case and "
            f"{-below:.2g} m below it in the other"
        )
        if lacking:
            why = "the strumming frequency of the line does not converge in either case"
        return Status.NO_EQUILIBRIUM.because(
            f"There is no equilibrium with {what} fully in water or fully in air: {why}. CALM does "
            f"not solve an equilibrium with {what} partly out of the water.",
            int(shape.piece[body]),
            RIDE_CLEAR,
        )
    return None


def _refuse_misplaced(solution: Solution, towing: Towing) -> None:
    """Raise NoEquilibrium if a part is below the seabed, or rises out of the water.

    The line between the surface and the ship may be in air.
    """
    height, depth = solution.position[:, 2], solution.water.depth
    margin = max(solution.depth_error, 1e-6 * float(solution.line.length.sum()))
    lowest = int(np.argmin(height))
    if height[lowest] < -depth - margin:
        piece = solution.piece_at(lowest)
        raise Status.GROUNDED.because(
            f"The towed line would touch the seabed: {{piece}} would be "
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
            f"The towed line would rise out of the water: {{piece}} would be {height[out]:.2f} m "
            "above the surface.",
            piece,
            STAY_BELOW,
        )
