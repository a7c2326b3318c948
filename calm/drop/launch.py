"""The launch: what an anchor that is let go last does to the line above it, on its whole way down.

The design check judges by it. The plan of the anchor drop (`calm.drop.plan`) is the same fall from
the same start, in finer bars and steps, and told at length.
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
"""Factor by which the drag along the line and of the anchor may be more, or less, than given."""
SHIP_SPEED = 1.0
"""Of a ship that tows the line out [m/s]: some two knots."""
SLOWEST_SHIP = 0.05
"""Through the water, to stream a line at all [m/s]."""
IN_SHORT = Fineness(bars=50, steps=50)
"""For the design check: half as fine as the plan."""


@dataclass(frozen=True)
class Launch:
    """The fall of a line behind its anchor, from a ship that tows it at 1 m/s against the current.

    The jerk as the line comes straight, and its swing, are not in these figures.

    Attributes
    ----------
    fall_speed : that at which the anchor meets the seabed [m/s], + down
    fall_speed_band : with the drag along cables, chains and cylinders, and the drag of the anchor,
        doubled and halved in the last step: the slow and the fast speed [m/s]; nan where that
        step is not found
    anchor_tension : greatest pull of the line on the anchor [N]
    drift : velocity of the anchor to the east and to the north at touchdown [m/s]
    tension_top, tension_bottom : (n,) greatest at the ends of every piece above the anchor, from
        letting go to the touchdown [N]
    anchor_drag_known : False where the anchor gives no `kt`: it is dragged as a cube
    greatest_speed, greatest_tension : speed at touchdown [m/s] and tension of every piece (n,) [N];
        where the anchor's drag is not known, those of one that has none in the last step, where
        they are more
    tangles : the pieces that have, or part of which has, been overtaken by what was above, at
        touchdown
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
        """Return the figures of the pieces above the anchor by their names."""
        pairs = zip(self.tension_top.tolist(), self.tension_bottom.tolist(), strict=True)
        return [
            {"index": index, "tension_top": top, "tension_bottom": bottom}
            for index, (top, bottom) in enumerate(pairs)
        ]


def launch_of(leg: Leg, fineness: Fineness = IN_SHORT) -> Launch:
    """Return the launch of a mooring, anchor last (NoEquilibrium: as `fall`)."""
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
    """Return the line of a mooring with the drag that its clamps have in the fall."""
    return with_axial_clamps(leg.line, leg.file.pieces[:-1])


def falling_anchor(leg: Leg) -> FallingAnchor:
    """Return the anchor of a mooring as it falls."""
    return FallingAnchor(leg.anchor_weight, leg.anchor_drag)


def course_into_current(water: Water) -> float:
    """Return the course against the current at the surface, north where there is none [degrees]."""
    east, north, _ = water.current_at(np.zeros(()))
    return bearing_of(-east, -north) if east or north else 0.0


def ship_of(leg: Leg, speed: float, course: float, streamed: float | None = None) -> Ship:
    """Return the ship that tows the line of a mooring.

    Parameters
    ----------
    speed, course : over the ground [m/s], [degrees]
    streamed : horizontal distance from the anchor to the free end [m]; as it is towed if not given

    Raises
    ------
    UsageError
        It makes no way through the water, or the line does not span the distance.
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
            f"a line of {length:.1f} m cannot be streamed to {streamed:g} m: give less than its "
            "length"
        )
    return Ship(east, north, streamed)


def _at_last(drop: Motion, fineness: Fineness, along: float, of_anchor: float) -> Motion:
    """Return the last step of a fall with the drag along the line, and of the anchor, so many times
    as great.
    """
    landed, falling = drop.states[-1], drop.mover
    # the step in which it landed ends there, and may be very short
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
    """Return the pieces with a bar whose lower end is up when the anchor lands."""
    chain = drop.mover.chain
    return looped(chain.line, chain.piece, np.diff(drop.states[-1].node[:, 2]))
