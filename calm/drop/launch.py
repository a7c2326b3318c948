"""Loads on the line while the anchor, deployed last, falls to the seabed.

The resolution is half that of a drop plan (`calm.drop.plan`).
"""

from dataclasses import dataclass, replace
from math import cos, hypot, nan, radians, sin
from typing import Any

import numpy as np

from calm.assemble import with_axial_clamps
from calm.case.leg import Leg
from calm.drop.fall import Fineness, Motion, Ship, fall, nothing_limits, towed
from calm.drop.fall_record import piece_tensions
from calm.drop.motion import FallingAnchor, NoStep
from calm.errors import UsageError
from calm.physics.line import Floats, Line, Water
from calm.quantities import bearing_of
from calm.solve import looped

AXIAL_DRAG_BAND = 2.0
"""Uncertainty factor on the tangential drag of the line and on the drag of the anchor."""
SHIP_SPEED = 1.0
"""Speed of a ship that tows the line out [m/s], about two knots."""
SLOWEST_SHIP = 0.05
"""Lowest ship speed through the water that streams a line [m/s]."""
CHECK_FINENESS = Fineness(bars=50, steps=50)
"""Resolution of the fall for the design check, half the resolution of a drop plan."""


@dataclass(frozen=True)
class Launch:
    """Fall of a line behind its anchor, which is released while the ship tows the line.

    The line is towed at 1 m/s against the current. Jerk and swing of the line are neglected.

    Attributes
    ----------
    fall_speed : touchdown speed of the anchor [m/s], positive down
    fall_speed_band : touchdown speeds [m/s] for twice and for half the drag; the drag of the anchor
        and the tangential drag of the line are changed only in the last time step. A speed is NaN
        if this step has no solution
    anchor_tension : maximum load of the line on the anchor [N]
    drift : velocity of the anchor to the east and to the north at touchdown [m/s]
    tension_top, tension_bottom : (n,) maximum tension at the ends of every piece above the anchor
        [N]
    anchor_drag_known : False if the anchor drag is assumed to be that of a cube
    greatest_speed, greatest_tension : upper limits of the touchdown speed [m/s] and of the tension
        (n,) in every piece [N]. If the anchor drag is unknown, the limits also cover a last time
        step without anchor drag
    tangles : indices of the pieces that form loops at touchdown, because the line above has
        overtaken them
    """

    fall_speed: float
    fall_speed_band: tuple[float, float]
    anchor_tension: float
    drift: tuple[float, float]
    tension_top: Floats
    tension_bottom: Floats
    anchor_drag_known: bool
    greatest_speed: float
    greatest_tension: Floats
    tangles: tuple[int, ...]

    def components(self) -> list[dict[str, Any]]:
        """Return one dictionary of tensions [N] per piece above the anchor, for JSON."""
        pairs = zip(self.tension_top.tolist(), self.tension_bottom.tolist(), strict=True)
        return [
            {"index": index, "tension_top": top, "tension_bottom": bottom}
            for index, (top, bottom) in enumerate(pairs)
        ]


def launch_of(leg: Leg, fineness: Fineness = CHECK_FINENESS) -> Launch:
    """Compute the fall of a mooring that is deployed anchor last.

    Raises
    ------
    NoEquilibrium
        The tow or the fall has no solution; for the statuses, see `towed` and `fall`.
    """
    line, water, anchor = falling_line(leg), leg.water, falling_anchor(leg)
    ship = ship_of(leg, SHIP_SPEED, course_into_current(water))
    drop = leg.memory.of(_let_go, line, water, anchor, ship, fineness)
    landed, known = drop.states[-1], leg.file.anchor.kt is not None
    ends, greatest = (tension.max(axis=0) for tension in piece_tensions(drop))
    top, bottom = ends.T
    fastest = -float(landed.velocity[-1, 2])
    if not known:
        try:
            bare = _at_last(drop, fineness, 1.0, 0.0)
        except NoStep as failure:
            raise nothing_limits() from failure
        fastest = max(fastest, -float(bare.states[-1].velocity[-1, 2]))
        greatest = np.maximum(greatest, piece_tensions(bare)[1][-1])

    def speed(drag: float) -> float:
        try:
            last = _at_last(drop, fineness, drag, drag)
        except NoStep:
            return nan
        return -float(last.states[-1].velocity[-1, 2])

    east, north = landed.velocity[-1, :2].tolist()
    return Launch(
        fall_speed=-float(landed.velocity[-1, 2]),
        fall_speed_band=(speed(AXIAL_DRAG_BAND), speed(1.0 / AXIAL_DRAG_BAND)),
        anchor_tension=float(bottom[-1]),
        drift=(east, north),
        tension_top=top,
        tension_bottom=bottom,
        anchor_drag_known=known,
        greatest_speed=fastest,
        greatest_tension=greatest,
        tangles=_tangles(drop),
    )


def _let_go(
    line: Line, water: Water, anchor: FallingAnchor, ship: Ship, fineness: Fineness
) -> Motion:
    return fall(line, water, anchor, towed(line, water, anchor, ship, fineness), fineness)


def falling_line(leg: Leg) -> Line:
    """Return the line of a mooring with the clamp drag that applies during the fall."""
    return with_axial_clamps(leg.line, leg.file.pieces[:-1])


def falling_anchor(leg: Leg) -> FallingAnchor:
    """Return the anchor of a mooring with the weight and drag that apply during the fall."""
    return FallingAnchor(leg.anchor_weight, leg.anchor_drag)


def course_into_current(water: Water) -> float:
    """Return the course against the surface current [degrees]; 0 (north) in still water."""
    east, north, _ = water.current_at(np.zeros(()))
    return bearing_of(-east, -north) if east or north else 0.0


def ship_of(leg: Leg, speed: float, course: float, streamed: float | None = None) -> Ship:
    """Return the ship that tows the line of a mooring, with its velocity.

    Parameters
    ----------
    speed, course : speed [m/s] and course [degrees] over the ground
    streamed : as in `Ship` [m]

    Raises
    ------
    UsageError
        The ship is too slow through the water, or the line is shorter than `streamed`.
    """
    east, north = speed * sin(radians(course)), speed * cos(radians(course))
    u, v, _ = leg.water.current_at(np.zeros(()))
    through = hypot(u - east, v - north)
    if not (speed > 0.0 and through >= SLOWEST_SHIP):
        raise UsageError(
            f"a ship at {speed:g} m/s makes {through:.2g} m/s through the water, which is too "
            "slow to stream the line"
        )
    length = float(leg.line.length.sum())
    if streamed is not None and not 0.0 < streamed < length:
        raise UsageError(
            f"the line is {length:.1f} m long and cannot extend {streamed:g} m astern; the "
            "distance must be shorter than the line"
        )
    return Ship(east, north, streamed)


def _at_last(drop: Motion, fineness: Fineness, along: float, of_anchor: float) -> Motion:
    """Repeat the end of the fall in one time step, with changed drag.

    `along` multiplies the tangential drag of the line, and `of_anchor` the drag of the anchor.
    """
    landed, falling = drop.states[-1], drop.mover
    # the step ends at the touchdown and may be very short
    least = 0.5 * falling.sea.water.depth / fineness.steps
    before = next(
        state for state in reversed(drop.states) if state.node[-1, 2] - landed.node[-1, 2] > least
    )
    loads = falling.chain.elements
    dragged = replace(loads, tangential_drag=along * loads.tangential_drag)
    chain = replace(falling.chain, elements=dragged)
    anchor = replace(falling.anchor, drag=of_anchor * falling.anchor.drag)
    mover = replace(falling, chain=chain, anchor=anchor, bedded=False)
    return Motion(mover, (before, mover.stepped(before, landed.time - before.time)))


def _tangles(drop: Motion) -> tuple[int, ...]:
    chain = drop.mover.chain
    return looped(chain.line, chain.piece, np.diff(drop.states[-1].node[:, 2]))
