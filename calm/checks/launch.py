"""The launch: what an anchor that is let go last does to the line above it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.assemble import with_axial_clamps
from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Line, Water
from calm.physics.track import head_count
from calm.solve import FallingAnchor, FreeMotion, part_of, solve_fall

if TYPE_CHECKING:
    from calm.case import Mooring, Result

AXIAL_DRAG_BAND = 2.0
"""Factor by which the drag along the line and of the anchor may be more, or less, than given."""


@dataclass(frozen=True)
class Launch:
    """The fall of a line behind its anchor, at terminal speed, as the anchor comes to the seabed.

    Where its float rides at the surface, that stays there: the line below it falls, slack until it
    is paid out. The fall then is the fastest that can be: some of the line hardly moves yet.
    Neither the swing of the line as it goes down nor the jerk at its end is in these figures.

    Attributes
    ----------
    fall_speed : that at which the anchor meets the seabed [m/s], + down
    fall_speed_band : with the drag along cables, chains and cylinders, and the drag of the anchor,
        doubled and halved: the slow and the fast speed [m/s]; nan where such a fall is not solved
    anchor_tension : pull of the line on the anchor [N]
    drift : velocity to the east and to the north [m/s]
    tension_top, tension_bottom : (n,) of every piece above the anchor [N]; 0 of what stays at the
        surface
    anchor_drag_known : False where the anchor gives no `kt`: it is dragged as a cube
    greatest_speed, greatest_tension : speed [m/s] and tension of every piece (n,) [N]; where
        the anchor's drag is not known those of one that has none, the most there can be
    tangles : the pieces that have, or part of which has, been overtaken by what was above
    in_still_water : whether the fall is that in still water, because a line that doubles back
        finds no steady motion in this current
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
    in_still_water: bool = False

    def components(self) -> list[dict[str, Any]]:
        """The pieces above the anchor, by name of figure."""
        pairs = zip(self.tension_top.tolist(), self.tension_bottom.tolist(), strict=True)
        return [
            {"index": index, "tension_top": top, "tension_bottom": bottom}
            for index, (top, bottom) in enumerate(pairs)
        ]


def launch_of(mooring: Mooring, result: Result) -> Launch:
    """The launch of a mooring, anchor last.

    Parameters
    ----------
    result : of the mooring where it stands; tells whether its float stays at the surface

    Raises
    ------
    NoEquilibrium
        As `solve_fall`, in still water too.
    """
    whole = with_axial_clamps(mooring.line, mooring.file.pieces[:-1])
    count = len(whole.length)
    first = head_count(whole) if result.type == "surface" else 0
    line, known = part_of(whole, first, count), mooring.file.anchor.kt is not None
    anchor = FallingAnchor(mooring.anchor_weight, mooring.anchor_drag)

    def fall(drag: float, water: Water, own: float = 1.0) -> FreeMotion:
        changed: Line = replace(line, tangential_drag=drag * line.tangential_drag)
        falling = replace(anchor, drag=own * drag * anchor.drag)
        return solve_fall(changed, water, falling, mooring.settings)

    def falls(water: Water) -> tuple[FreeMotion, FreeMotion]:
        """As it falls, and with the least drag that its anchor may have."""
        motion = fall(1.0, water)
        return motion, motion if known else fall(1.0, water, own=0.0)

    def speed(drag: float, water: Water) -> float:
        try:
            return -float(fall(drag, water).velocity[2])
        except NoEquilibrium:
            return nan

    water, still_water = mooring.water, False
    try:
        motion, fastest = falls(water)
    except NoEquilibrium:
        water, still_water = water.still(), True
        motion, fastest = falls(water)
    still = np.zeros(first)
    top, bottom = (np.concatenate([still, end]) for end in _tensions(motion))
    east, north, up = motion.velocity.tolist()
    return Launch(
        fall_speed=-up,
        fall_speed_band=(speed(AXIAL_DRAG_BAND, water), speed(1.0 / AXIAL_DRAG_BAND, water)),
        anchor_tension=float(motion.solution.tension[-1]),
        drift=(east, north),
        tension_top=top,
        tension_bottom=bottom,
        anchor_drag_known=known,
        greatest_speed=-float(fastest.velocity[2]),
        greatest_tension=np.concatenate([still, np.maximum(*_tensions(fastest))]),
        tangles=tuple(first + piece for piece in motion.tangles),
        in_still_water=still_water,
    )


def _tensions(motion: FreeMotion) -> Floats:
    """(2, n) at the upper and at the lower end of every piece that falls [N]."""
    found: Floats = motion.solution.tension[motion.solution.piece_nodes.T]
    return found
