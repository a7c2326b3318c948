"""Search for the velocity of a freely rising line, by Newton's method with Broyden updates."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import copysign, sqrt

import numpy as np

from calm.physics.line import Floats, Line, MarchError, Water
from calm.physics.march import NO_CUTS, Cuts
from calm.physics.seawater import REFERENCE_DENSITY
from calm.solve.free_march import Rising
from calm.solve.least_change import root_near
from calm.solve.solution import Status

FASTEST = 100.0
"""Speed that no line with drag can reach [m/s]."""
SLOWEST = 0.01
"""Smallest scale of velocities [m/s], used for a line that hardly moves."""
COARSE = 4.0
"""Segment length of the first marches, in units of the final segment length."""
NEAR, CLOSE = 1e-3, 1e-9
"""Allowed imbalance of forces, as a fraction of the net weight of the line.

NEAR applies to coarse segments, CLOSE to the final segments.
"""
SHEARS = ((1.0,), (0.1, 0.25, 0.5, 0.75, 1.0))
"""Fractions of the current shear for which the motion is found in turn: the full shear at once or,
if this fails, in steps.
"""


@dataclass(frozen=True)
class FreePlace:
    """Velocity over the ground (3,) [m/s] of a `Rising` line, and depth of its lower end [m]."""

    velocity: Floats
    depth: float


def terminal(rising: Rising, angle_step: float) -> tuple[FreePlace, Cuts]:
    """Find the terminal velocity of a free line, the depth of its lower end, and its segments.

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` if nothing limits the speed; ``not-converged`` if no motion is found.
    MarchError
        The march of the vertical line failed.
    """
    plumb = _plumb(rising, angle_step)
    for shares in SHEARS:
        found: tuple[FreePlace, Cuts] | None = (plumb, NO_CUTS)
        for share in shares:
            if found is not None:
                found = _closed(_sheared(rising, plumb.velocity, share), found[0], angle_step)
        if found is not None:
            return found
    raise Status.NOT_CONVERGED.because("No steady motion of the line was found.")


def _sheared(rising: Rising, velocity: Floats, share: float) -> Rising:
    """Return the line in a current with weaker shear.

    The difference of the current from `velocity` (3,) [m/s] is multiplied by `share`.
    """
    (east, north, _), water = velocity, rising.water
    u, v = east + share * (water.u - east), north + share * (water.v - north)
    return replace(rising, water=replace(water, u=u, v=v))


def plumb_speed(line: Line, water: Water, top: float) -> float:
    """Return the terminal speed of a vertical line in still water [m/s], positive up.

    The current and the stretch of the line are neglected. In the drag crisis of smooth pieces, the
    speed may not be unique.

    Parameters
    ----------
    top : depth of the line's upper end [m]

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` if no piece has drag.
    """
    whole = np.where(line.flexible, line.length, 1.0)
    middle = top + np.cumsum(line.length) - 0.5 * line.length
    density, on = water.density_at(middle), line.clamp_piece
    lift = float(line.net_force((density - REFERENCE_DENSITY) * water.gravity).sum())
    across = np.concatenate([np.where(line.directional, 0.0, line.normal_drag), line.clamp_drag])
    along = np.append(np.where(line.directional, line.tangential_drag, 0.0), 0.0 * line.clamp_drag)
    upward = np.append(line.lift, line.clamp_lift)
    share = np.append(whole * density, density[on]) / REFERENCE_DENSITY
    viscosity = water.viscosity_at(middle)
    curves = (line.drag_curve or (None,) * len(whole)) + line.clamp_drag_curve
    viscosity = np.append(viscosity, viscosity[on])
    smooth = [
        (place, curve, curve.diameter / viscosity[place])
        for place, curve in enumerate(curves)
        if curve is not None
    ]

    def lifted(_: None, squared: float) -> float:
        """Return the sum of the vertical forces on the line [N].

        `squared` is the square of the vertical speed, negative if the line sinks [m²/s²].
        """
        drag = across.copy()
        for place, curve, reynolds in smooth:
            drag[place] *= curve.factor(reynolds * sqrt(abs(squared)))
        return lift + float(share @ (upward * abs(squared) - (drag + along) * squared))

    slope = lifted(None, copysign(1.0, lift)) - lift
    limit = FASTEST**2
    found, squared, _, _ = root_near(
        lifted, None, 0.0, -abs(slope), -limit, limit, CLOSE * abs(lift), 1e-12
    )
    if not found:
        raise Status.NO_EQUILIBRIUM.because(
            "The rise speed of the line is unlimited, since its pieces have no drag.",
            advice="Set the drag of its pieces.",
        )
    return copysign(sqrt(abs(squared)), squared)


def _plumb(rising: Rising, angle_step: float) -> FreePlace:
    """Estimate the motion, assuming that the line is vertical and drifts with the mean current."""
    still, depth = rising.water.still(), rising.guessed_depth
    velocity = np.array([0.0, 0.0, plumb_speed(rising.line, still, rising.top)])
    upright = replace(rising, water=still)
    met = upright.meet(upright.flow(velocity), depth, COARSE * angle_step)
    place = FreePlace(velocity, depth + met.gap)
    return replace(place, velocity=velocity + _mean_current(rising, place, angle_step))


def _mean_current(rising: Rising, place: FreePlace, angle_step: float) -> Floats:
    """Return the mean horizontal current (3,) over the line, weighted by normal drag [m/s]."""
    water, line = rising.water, rising.line
    if rising.plumb:
        return np.array([water.u[0], water.v[0], 0.0])
    flow = rising.flow(place.velocity)
    trace = rising.meet(flow, place.depth, COARSE * angle_step, record=True).trace
    assert trace is not None
    piece, clamp, height = trace.piece, trace.clamp, trace.position[:, 2]
    drag = line.normal_drag[piece] * np.where(line.flexible[piece], trace.cut, 1.0)
    drag[clamp >= 0] = line.clamp_drag[clamp[clamp >= 0]]
    current = water.current_at(-0.5 * (height[1:] + height[:-1]))
    total = float(drag.sum())
    mean: Floats = drag @ current / total if total > 0.0 else np.zeros(3)
    return mean * [1.0, 1.0, 0.0]


_FOLLOWED = 8
"""Largest number of updates of the lower end's depth for a vertical line. Two or three suffice."""


def _closed(rising: Rising, place: FreePlace, angle_step: float) -> tuple[FreePlace, Cuts] | None:
    """Find the motion near a known motion. Return the motion and its segments, or None."""
    sheared = not rising.plumb
    # The depth of the lower end is an unknown of Newton's method only in shear, since the depth is
    # not continuous if a plumb line doubles back within a cable.
    unknown = np.array([sheared, sheared, True, sheared])
    speed, span = max(float(np.linalg.norm(place.velocity)), SLOWEST), rising.water.depth
    units = np.array([speed, speed, speed, span])[unknown]
    values = np.append(place.velocity, place.depth)

    def at(x: Floats) -> FreePlace:
        values[unknown] = x * units
        return FreePlace(values[:3].copy(), float(values[3]))

    def left(step: float, cuts: Cuts, x: Floats) -> Floats:
        here = at(x)
        met = rising.meet(rising.flow(here.velocity), here.depth, step, cuts)
        forces: Floats = np.append(met.force / rising.weight, met.gap / span)[unknown]
        return forces

    x, slopes = values[unknown] / units, None
    # the imbalance is continuous only on given segments
    for step, small in ((COARSE * angle_step, NEAR), (angle_step, CLOSE)):
        here = at(x)
        try:
            cuts = rising.meet(rising.flow(here.velocity), here.depth, step).cuts
        except MarchError:
            return None
        for _ in range(1 if sheared else _FOLLOWED):
            root = system_root(partial(left, step, cuts), x, small, slopes)
            if root is None:
                return None
            x, slopes = root
            here = at(x)
            if not sheared:
                gap = rising.meet(rising.flow(here.velocity), here.depth, step, cuts).gap
                values[3] += gap
                if abs(gap) <= CLOSE * span:
                    break
    return at(x), cuts


_ROUNDS = 40
_HALVINGS = 6
_DIFFERENCE = 1e-5
"""Change of each scaled unknown for the finite differences."""

System = Callable[[Floats], Floats]


def system_root(
    system: System, start: Floats, small: float, slopes: Floats | None = None
) -> tuple[Floats, Floats | None] | None:
    """Find the root of a system of equations near a start value, or return None.

    Parameters
    ----------
    system : function of k unknowns that returns k residuals, scaled so that 1 is large; may raise
        `MarchError`
    small : absolute residual at which the search stops
    slopes : (k, k) derivatives of a nearly identical system, if known

    Returns
    -------
    The unknowns and the derivatives at the root.

    Source: C. G. Broyden (1965), Mathematics of Computation 19, 577-593.
    """
    x, fresh = start, False
    value = _tried(system, x)
    if value is None:
        return None
    for _ in range(_ROUNDS):
        if np.abs(value).max() <= small:
            return x, slopes
        if slopes is None:
            slopes, fresh = _slopes(system, x, value), True
        found = None if slopes is None else _step(system, x, value, slopes)
        if found is None or slopes is None:
            if fresh:
                return None
            slopes = None
            continue
        following, values = found
        halved = np.linalg.norm(values) <= 0.5 * np.linalg.norm(value)
        step = following - x
        missed = values - value - slopes @ step
        # across a kink, the slopes of one side overshoot; the update averages both sides
        slopes = slopes + np.outer(missed, step) / (step @ step) if halved or fresh else None
        x, value, fresh = following, values, False
    return None


def _step(system: System, x: Floats, value: Floats, slopes: Floats) -> tuple[Floats, Floats] | None:
    """Return unknowns with a smaller residual, and this residual; None if no step reduces it."""
    try:
        step = -np.linalg.solve(slopes, value)
    except np.linalg.LinAlgError:
        return None
    for _ in range(_HALVINGS):
        values = _tried(system, x + step)
        if values is not None and np.linalg.norm(values) < np.linalg.norm(value):
            return x + step, values
        step = 0.5 * step
    return None


def _slopes(system: System, x: Floats, value: Floats) -> Floats | None:
    columns = []
    for direction in np.eye(len(x)) * _DIFFERENCE:
        values = _tried(system, x + direction)
        if values is None:
            return None
        columns.append((values - value) / _DIFFERENCE)
    return np.column_stack(columns)


def _tried(system: System, x: Floats) -> Floats | None:
    try:
        return system(x)
    except MarchError:
        return None
