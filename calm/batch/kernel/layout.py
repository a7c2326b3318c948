"""What the lanes read of a mooring."""

from __future__ import annotations

from typing import Any, NamedTuple

from calm.physics.line import Floats, Integers
from calm.physics.track import Course


class Ride(NamedTuple):
    """How a float rides at some share of its buoyancy in use: see `calm.physics.hull.Riding`."""

    standing: float
    above: float
    drag: float
    push_east: float
    push_north: float


class Rides(NamedTuple):
    """How the float at the surface rides.

    Attributes
    ----------
    by_share : of `Ride`, evenly by 1 - √(1 - share in use)
    above, own : lengths of what is rigid with it above it, and of itself [m]
    """

    by_share: Any
    above: float
    own: float


class Aim(NamedTuple):
    """Where a line must end, and what it may be found to do.

    Attributes
    ----------
    span : water depth [m]
    goal : height of its end [m], + up from the surface
    upright : depth of its free end in still water [m]
    floats : whether the head can float at the surface
    rides : whether it is known how
    anchor_height : [m]
    first_chain : the stage from which on there is nothing but chain
    barely : length on the seabed up to which it may as well hang clear of it [m]
    """

    span: float
    goal: float
    upright: float
    floats: bool
    rides: bool
    anchor_height: float
    first_chain: int
    barely: float


class Seabed(NamedTuple):
    """Friction on the seabed [N]: of a metre of cable and of a whole rod or clamp, (stages, 2), and
    of every load."""

    grips: Floats
    holds: Floats


class Way(NamedTuple):
    """A line looked for clear of the seabed, or lying on it.

    Attributes
    ----------
    course : the line as the march takes it
    cuts, first_cut : first lengths of its segments [m], and where those of each cable begin
    lands : whether it may come down
    near : how far the loads of a rod may be from where they are looked up [m]
    seabed, aim, rides : see there
    places : of every load whether it is the float at the surface, see `calm.batch.kernel.loads`
    joints : of every float at the surface above the lowest there, the stage whose top, the next
        float's, is to come to the surface, see `calm.batch.kernel.afloat`
    below : the stage of the next float below the lowest there, see there
    standing : how far they may stand out of the water however they are turned [m]
    lifts : of those floats and the lowest, the share of their buoyancy in all of it
    shares : of its buoyancy in use, at which a float is tried that may be under water
    scanned : shares of the depths to be scanned at which the miss is looked at
    falls, fall_step : how deep even currents of growing speed push the line [m], and the step of
        the speed [m/s]
    clamp_row : of every load its row among the clamps down the line; -1 for a piece
    lengths : of the pieces [m]
    head : how many pieces are rigid with the first float
    fixed : depth, what is added to u and v, and density of the levels that every profile gets
    """

    course: Course
    cuts: Floats
    first_cut: Integers
    lands: bool
    near: float
    seabed: Seabed
    aim: Aim
    rides: Rides
    places: Integers
    joints: Integers
    below: int
    standing: float
    lifts: Floats
    shares: Floats
    scanned: Floats
    falls: Floats
    fall_step: float
    clamp_row: Integers
    lengths: Floats
    head: int
    fixed: Floats


class Results(NamedTuple):
    """Rows of the cases: of pieces (n, 6, p), clamps (n, 5, m) and ends (n, 5); see
    `calm.batch.kernel.outcome`."""

    pieces: Floats
    clamps: Floats
    ends: Floats
