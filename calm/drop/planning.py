"""From a mooring and a ship to the plan of its anchor drop."""

from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, radians, sin

import numpy as np

from calm.assemble import with_axial_clamps
from calm.case import Mooring, Result
from calm.drop.fall import Course, Fineness, Ship, fall, settle, towed
from calm.drop.motion import Anchor, State
from calm.drop.plan import ASTRAY, DropPlan
from calm.drop.record import depths_of, moments_of, path_of, pulls_of, rest_difference
from calm.errors import NoEquilibrium, UsageError
from calm.physics.line import Floats, Water
from calm.quantities import bearing_of
from calm.solve import Status

SHIP_SPEED = 1.0
"""Of a ship that tows the line out [m/s]: some two knots."""
FINE = Fineness(bars=100, steps=100)
FINEST = 4
"""Times as many bars at most, until the line comes to rest in its equilibrium."""
DRAG_BAND = 2.0
"""By how many times the anchor's drag may be more, or less, than given."""
CAUTION = 2.0
"""How many times what steps and bars of twice the length change the stated errors are."""
LEAST_TIME_ERROR = 5e-4
"""Of the fall time, where the changes by steps and bars happen to be small."""
SLOWEST_SHIP = 0.05
"""Through the water, to stream a line at all [m/s]."""


def drop_plan(
    mooring: Mooring,
    ship_speed: float = SHIP_SPEED,
    streamed: float | None = None,
    course: float | None = None,
    result: Result | None = None,
    fineness: Fineness = FINE,
) -> DropPlan:
    """The drop of a mooring's anchor from a ship that streams the line, the anchor last.

    Parameters
    ----------
    ship_speed : over the ground [m/s]
    streamed : horizontal distance from the anchor to the free end when it is let go [m]; that of
        the line as it is towed where not given
    course : of the ship over the ground [degrees]; against the current at the surface where not
        given, and north where there is none
    result : of the mooring in the same environment, where it is solved already
    fineness : of the chain and its steps

    Raises
    ------
    UsageError
        A ship that makes no way through the water, or a distance that the line does not span.
    NoEquilibrium
        As `Mooring.solve`; ``anchor-lifts`` where the anchor does not draw the line down,
        ``not-converged`` where no step is found.
    """
    if result is None:
        result = _equilibrium(mooring)
    course = _into_the_current(mooring.water) if course is None else course % 360.0
    ship = _ship(mooring, ship_speed, streamed, course)
    anchor = Anchor(mooring.anchor_weight, mooring.anchor_drag)
    falling = with_axial_clamps(mooring.line, mooring.file.pieces[:-1])
    water = mooring.water

    def let_go(start: State, drag: float, fineness: Fineness) -> Course:
        return fall(falling, water, replace(anchor, drag=drag), start, fineness)

    def dropped(fine: Fineness) -> tuple[State, Course, Course, float | None]:
        """The line as it is towed, its fall and its rest, and how far from its equilibrium."""
        start = towed(falling, water, anchor, ship, fine)
        drop = let_go(start, anchor.drag, fine)
        rest = settle(mooring.line, water, anchor, drop.states[-1], fine)
        return start, drop, rest, None if result is None else rest_difference(result, rest)

    def is_astray(difference: float | None) -> bool:
        return difference is not None and difference > ASTRAY * water.depth

    fine = fineness
    start, drop, rest, difference = dropped(fine)
    while is_astray(difference) and fine.bars < FINEST * fineness.bars:
        finer = replace(fine, bars=2 * fine.bars)
        try:
            start, drop, rest, difference = dropped(finer)
        except NoEquilibrium:
            break
        fine = finer
    astray = is_astray(difference)
    longer = replace(fine, steps=fine.steps // 2)
    slower = let_go(start, anchor.drag, longer)
    fewer = replace(fine, bars=fine.bars // 2)
    coarser = let_go(towed(falling, water, anchor, ship, fewer), anchor.drag, fewer)
    toward = start.node[0, :2] / np.linalg.norm(start.node[0, :2])
    others = [
        let_go(start, anchor.drag * factor, longer).states[-1]
        for factor in (1.0 / DRAG_BAND, DRAG_BAND)
    ]
    landed, late = drop.states[-1], slower.states[-1]
    back, aside = _split(landed, toward)
    # of steps twice as long, and of bars
    missed = [
        np.subtract(_split(other.states[-1], toward), (back, aside)) for other in (slower, coarser)
    ]
    delays = [other.states[-1].time - landed.time for other in (slower, coarser)]
    backs = [_split(other, toward)[0] - float(missed[0][0]) for other in others]
    times = [other.time - late.time + landed.time for other in others]
    way = np.array([sin(radians(course)), cos(radians(course))])
    released = -landed.node[-1, :2]
    run, run_time = _run(water, way, ship_speed, float(np.linalg.norm(start.node[0, :2])))
    past = float(released @ way)
    pulls = pulls_of(mooring.file.pieces, drop)
    return DropPlan(
        mooring=mooring,
        ship_speed=ship_speed,
        course=course,
        streamed=float(np.linalg.norm(start.node[0, :2])),
        astern=bearing_of(*toward.tolist()),
        fall_time=landed.time,
        fall_back=back,
        aside=aside,
        time_error=max(CAUTION * sum(map(abs, delays)), LEAST_TIME_ERROR * landed.time),
        distance_error=CAUTION * sum(float(np.linalg.norm(each)) for each in missed),
        fall_time_band=(min(times), max(times)),
        fall_back_band=(min(*backs, back), max(*backs, back)),
        touchdown_speed=-float(landed.velocity[-1, 2]),
        greatest_tension=max(pull.tension for pull in pulls),
        tow_past=past,
        run_in=run - past,
        run_time=run_time,
        let_go=(float(released[0]), float(released[1])),
        start=(float(released[0] - run * way[0]), float(released[1] - run * way[1])),
        anchor_drag=anchor.drag,
        drag_known=mooring.file.anchor.kt is not None,
        path=path_of(drop, toward, mooring.line.anchor_height),
        moments=moments_of(drop, None if astray else rest, toward),
        depths=() if astray else depths_of(mooring.file.pieces, drop, rest),
        pulls=pulls,
        rest_difference=difference,
    )


def _equilibrium(mooring: Mooring) -> Result | None:
    """The mooring at rest; None where it has no unique shape, longer than still water is deep."""
    try:
        return mooring.solve()
    except NoEquilibrium as failure:
        if failure.status != Status.SLACK.label:
            raise
        return None


def _into_the_current(water: Water) -> float:
    """Course against the current at the surface, north where there is none [degrees]."""
    (east, north, _), _ = water.at(np.zeros(()))
    return bearing_of(-east, -north) if east or north else 0.0


def _ship(mooring: Mooring, speed: float, streamed: float | None, course: float) -> Ship:
    east, north = speed * sin(radians(course)), speed * cos(radians(course))
    (u, v, _), _ = mooring.water.at(np.zeros(()))
    through = hypot(u - east, v - north)
    if not (speed > 0.0 and through >= SLOWEST_SHIP):
        raise UsageError(
            f"a ship at {speed:g} m/s makes {through:.2g} m/s through the water, which is too "
            "slow to stream the line"
        )
    length = float(mooring.line.length.sum())
    if streamed is not None and not 0.0 < streamed < length:
        raise UsageError(
            f"a line of {length:.1f} m cannot be streamed to {streamed:g} m: give less than its "
            "length"
        )
    return Ship(east, north, streamed)


def _split(state: State, toward: Floats) -> tuple[float, float]:
    """Where the anchor is: towards the float, and to the right of that [m]."""
    (east, north), (x, y) = state.node[-1, :2].tolist(), toward.tolist()
    return east * x + north * y, east * y - north * x


def _run(water: Water, way: Floats, speed: float, streamed: float) -> tuple[float, float]:
    """How far the ship goes while it leaves its float behind [m], and how long that takes [s].

    The float drifts with the water at the surface from where it is put out.
    """
    current, _ = water.at(np.zeros(()))
    leaving = speed * way - current[:2]
    duration = streamed / float(np.linalg.norm(leaving))
    return speed * duration, duration
