"""Search of the velocity of a line that rises freely: Newton's method, Broyden's updates."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import copysign, sqrt

import numpy as np

from calm.physics.line import Floats, MarchError
from calm.physics.march import NO_CUTS, Cuts
from calm.solve.free_march import Rising
from calm.solve.least_change import root_near
from calm.solve.solution import Status

FASTEST = 100.0
"""Speed that nothing with a drag reaches [m/s]."""
SLOWEST = 0.01
"""Speed by which velocities are measured where the line hardly moves [m/s]."""
COARSE = 4.0
"""Segments of the marches that look for the neighbourhood of a root, in those of the final ones."""
NEAR, CLOSE = 1e-3, 1e-9
"""Force without balance, as a share of the net weight, before and after the last choice of cuts."""
SHEARS = ((1.0,), (0.1, 0.25, 0.5, 0.75, 1.0))
"""By way of which shares of a sheared current the motion in it is sought: at once, or in steps."""


@dataclass(frozen=True)
class FreePlace:
    """Velocity over the ground (3,) [m/s], and the depth that a `Rising` leaves open [m]."""

    velocity: Floats
    depth: float


def terminal(rising: Rising, angle_step: float) -> tuple[FreePlace, Cuts]:
    """Return how fast and where a line moves, and the segments on which it does so exactly.

    Parameters
    ----------
    angle_step : of a segment [rad]

    Raises
    ------
    NoEquilibrium
        ``no-equilibrium`` where nothing limits the speed, ``not-converged`` where no root is found.
    MarchError
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
    """Return the same line in a current that departs from a velocity (3,) [m/s] by a share only."""
    (east, north, _), water = velocity, rising.water
    u, v = east + share * (water.u - east), north + share * (water.v - north)
    return replace(rising, water=replace(water, u=u, v=v))


def _plumb(rising: Rising, angle_step: float) -> FreePlace:
    """The motion of the line if it were plumb, drifting with the mean current.

    The drag goes with the square of the speed or nearly so: secants in that find it at once. Where
    smooth pieces in the drag crisis allow several speeds, it is one of them.
    """
    none = np.zeros_like(rising.water.u)
    upright = replace(rising, water=replace(rising.water, u=none, v=none))
    depth = rising.guessed_depth

    def meeting(squared: float) -> tuple[FreePlace, float]:
        """Return where the line is at the signed square of a speed, and what lifts it there [N]."""
        velocity = np.array([0.0, 0.0, copysign(sqrt(abs(squared)), squared)])
        met = upright.meet(upright.flow(velocity), depth, COARSE * angle_step)
        return FreePlace(velocity, depth + met.gap), float(met.force[2])

    def lifted(_: None, squared: float) -> float:
        return meeting(squared)[1]

    resting = lifted(None, 0.0)
    slope = lifted(None, copysign(1.0, resting)) - resting
    limit = FASTEST**2
    found, squared, _, _ = root_near(
        lifted, None, 0.0, -abs(slope), -limit, limit, NEAR * abs(resting), 1e-9
    )
    if not found:
        raise Status.NO_EQUILIBRIUM.because(
            "Nothing limits the rise speed of the line: none of its pieces has any drag.",
            advice="Set the drag of its pieces.",
        )
    place, _ = meeting(squared)
    return replace(place, velocity=place.velocity + _mean_current(rising, place, angle_step))


def _mean_current(rising: Rising, place: FreePlace, angle_step: float) -> Floats:
    """(3,) horizontal current where the line is, the mean by normal drag or nearly so [m/s]."""
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


def _closed(rising: Rising, place: FreePlace, angle_step: float) -> tuple[FreePlace, Cuts] | None:
    """The motion near a place, on the segments that the march chooses there; None if there is none.

    With its free choice of segments the march is not quite continuous, so it is closed on given
    ones: first on coarse ones, then on those that it chooses at that answer.
    """
    unknown = np.array([not rising.plumb, not rising.plumb, True, True])
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
    for step, small in ((COARSE * angle_step, NEAR), (angle_step, CLOSE)):
        here = at(x)
        try:
            cuts = rising.meet(rising.flow(here.velocity), here.depth, step).cuts
        except MarchError:
            return None
        root = system_root(partial(left, step, cuts), x, small, slopes)
        if root is None:
            return None
        x, slopes = root
    return at(x), cuts


_ROUNDS = 40
_HALVINGS = 6
_DIFFERENCE = 1e-5
"""Step of the differences that the derivatives are taken from, in units of the unknowns."""

System = Callable[[Floats], Floats]


def system_root(
    system: System, start: Floats, small: float, slopes: Floats | None = None
) -> tuple[Floats, Floats | None] | None:
    """Root of a system near a start, with the derivatives there; None where none is found.

    Parameters
    ----------
    system : from k unknowns to k values, both scaled so that 1 is much; it may raise `MarchError`
    small : stop when no value is greater than this
    slopes : (k, k) derivatives of nearly the same system

    The derivatives are taken by differences once, then kept up by Broyden's rule, and taken anew
    where a step by updated ones does not halve the values. A step is halved until they fall.

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
        # across a bend, slopes of one side lead too far; with the update they are those of both
        slopes = slopes + np.outer(missed, step) / (step @ step) if halved or fresh else None
        x, value, fresh = following, values, False
    return None


def _step(system: System, x: Floats, value: Floats, slopes: Floats) -> tuple[Floats, Floats] | None:
    """The next place, where the values are less, and these; None where there is none."""
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
