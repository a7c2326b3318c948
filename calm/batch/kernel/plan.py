"""A mooring laid out for the kernel: its stages, loads, cuts and limits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from calm.assemble import assemble_water
from calm.batch.kernel.afloat import NO_FLOAT
from calm.batch.kernel.cable import is_packed
from calm.batch.kernel.contact import first_chain_of, grips_on, when_looked_for
from calm.batch.kernel.cuts import cuts_of
from calm.batch.kernel.lane import MOST_UPPER
from calm.batch.kernel.layout import Aim, Ride, Rides, Seabed, Way
from calm.batch.kernel.loads import ABOVE_FLOAT, AFLOAT, IN_WATER, UPPER_FLOAT
from calm.case import Mooring
from calm.files import CurrentTable
from calm.physics.compiled import packed, record_type
from calm.physics.hull import Floating
from calm.physics.line import Floats, Integers, Line, Water
from calm.physics.profile import Profile
from calm.physics.state import MarchError
from calm.physics.track import CABLE, Course, Part, Rod, head_count
from calm.solve.closing import Closing
from calm.solve.locate import NEAR as NEAR_TOP
from calm.solve.locate import SCAN, SHARES, upright_depth
from calm.solve.mooring import BARELY_LANDED
from calm.solve.standing import surface_lift
from calm.solve.unknown import Unknown

NEAR = 2e-6
"""How far the loads of a rod may be from where they are looked up, as a share of the depth."""
NEAR_ON_SEABED = 2e-7
"""The same of a line on the seabed, which may lie far in the direction of its last pull."""
FASTEST, SPEEDS = 4.0, 41
"""Currents up to so many m/s, and how many of them, for which the fall of the line is known."""
SHARES_KNOWN = 1025
"""Shares of its buoyancy in use for which it is known how a float rides."""

_STILL = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


@dataclass(frozen=True)
class Plan:
    """What the kernel reads of a mooring.

    Attributes
    ----------
    water : the sea without the current of the file: density, and what the wind drives
    strata : its viscosity, as in `Sea`
    clear, lying : the line looked for clear of the seabed, and lying on it
    several : both again with two floats at the surface, with three, and so on
    contact : when the second: see `calm.batch.kernel.contact`
    singly : whether it has laws that each lane takes by itself: an elongation or drag curve,
        another friction than Berteaux's, a cable at its free end or without drag
    """

    water: Water
    strata: Any
    clear: Way
    lying: Way
    several: tuple[tuple[Way, Way], ...]
    contact: int
    singly: bool


def base_water(mooring: Mooring) -> Water:
    """The water of a mooring with no current but what the wind drives."""
    return assemble_water(replace(mooring.file.environment, current=_STILL))


def plan_of(mooring: Mooring) -> Plan:
    """Lay a mooring out."""
    line, water = mooring.line, base_water(mooring)
    closing = Closing(line, water, mooring.settings)
    track = closing.track
    first_chain = first_chain_of(mooring, track)
    clear, lying = (_way(closing, first_chain, lands=lands) for lands in (False, True))
    return Plan(
        water=water,
        strata=packed(closing.profile.sea).strata,
        clear=clear,
        lying=lying,
        several=_several(closing, clear, lying),
        contact=when_looked_for(line, water, track),
        singly=_takes_singly(track.course),
    )


def _takes_singly(course: Course) -> bool:
    """Whether a stage has a law that is not made for all lanes at once."""
    cables = [n for n, stage in enumerate(course.stages) if stage.kind == CABLE]
    curved = any(load.diameter > 0.0 for load in course.loads)
    return curved or not all(is_packed(course, n) for n in cables)


def _way(closing: Closing, first_chain: int, *, lands: bool) -> Way:
    """The line clear of the seabed, or on it: how it is cut, where it ends, what it may miss by."""
    line, water, track = closing.line, closing.water, closing.track
    unknown = closing.whole(lands)
    top = upright_depth(closing, unknown)
    course, loads = track.course, packed(track.course).loads
    cuts = cuts_of(track, water.depth, lands)
    afloat = closing.floats[0] if closing.floats else -1
    head = track.stages[0]
    floats = isinstance(head, Rod) and afloat in head.pieces
    clamped = loads["clamp"] >= 0
    falls, step = _falls(closing, unknown, top)
    grips, holds = grips_on(track, water, closing.settings.seabed_friction)
    return Way(
        course=packed(course),
        cuts=np.concatenate([np.zeros(0), *cuts]),
        first_cut=np.cumsum([0, *map(len, cuts)], dtype=np.int64),
        lands=lands,
        near=(NEAR_ON_SEABED if lands else NEAR) * water.depth,
        seabed=Seabed(grips, holds),
        aim=Aim(
            span=float(water.depth),
            goal=float(unknown.goal),
            upright=float(top),
            floats=floats,
            rides=line.floating is not None,
            anchor_height=float(line.anchor_height),
            first_chain=first_chain,
            barely=float(BARELY_LANDED * line.anchor_height),
        ),
        rides=_rides(head, afloat, line.floating if floats else None),
        joints=np.zeros(0, np.int64),
        below=NO_FLOAT,
        standing=0.0,
        lifts=np.ones(1),
        places=_places(line, loads, course.stages[0].size, afloat if floats else -1),
        shares=np.array(SHARES),
        scanned=np.array([*NEAR_TOP, *range(1, SCAN + 1)]) / SCAN,
        falls=falls,
        fall_step=step,
        clamp_row=np.where(clamped, np.cumsum(clamped) - 1, -1),
        lengths=line.length.copy(),
        head=head_count(line),
        fixed=np.column_stack([water.level, water.u, water.v, water.density]),
    )


def _places(line: Line, loads: Any, head: int, afloat: int) -> Integers:
    """Of every load of the head whether it is the float at the surface, or stands out above it."""
    piece, clamp = loads["piece"], loads["clamp"]
    at_head = np.arange(len(piece)) < head
    above = at_head & (piece < afloat) & (line.floating is not None)
    itself = at_head & (piece == afloat) & (clamp < 0)
    return np.where(itself, AFLOAT, np.where(above, ABOVE_FLOAT, IN_WATER))


def _several(closing: Closing, clear: Way, lying: Way) -> tuple[tuple[Way, Way], ...]:
    """The line with two floats at the surface, with three, and so on."""
    line, stages = closing.line, closing.track.stages
    floats = np.array(closing.floats if clear.aim.floats else [], np.intp)
    rods = {p: n for n, stage in enumerate(stages) if isinstance(stage, Rod) for p in stage.pieces}
    at = np.array([rods[piece] for piece in floats], np.int64)
    lift = surface_lift(line, closing.water)[floats]
    loads: Any = clear.course.loads

    def with_upper(way: Way, upper: int) -> Way:
        places = np.full(len(loads), IN_WATER)
        for k in range(upper + 1):
            own = (loads["piece"] == floats[k]) & (loads["clamp"] < 0)
            places[own] = AFLOAT if k == upper else UPPER_FLOAT + k
        afloat = slice(0, upper + 1)
        return way._replace(
            aim=way.aim._replace(upright=0.0, rides=False),
            places=places,
            joints=at[1 : upper + 1],
            below=int(at[upper + 1]) if upper + 1 < len(at) else NO_FLOAT,
            standing=float(line.length[floats[afloat]].sum()),
            lifts=lift[afloat] / lift[afloat].sum(),
            falls=np.zeros_like(way.falls),
        )

    uppers = range(1, min(len(floats), MOST_UPPER + 1))
    return tuple((with_upper(clear, upper), with_upper(lying, upper)) for upper in uppers)


def _rides(head: Part, afloat: int, floating: Floating | None) -> Rides:
    """How the float rides, by 1 - √(1 - share in use); and the lengths that stand out with it."""
    if floating is None or not isinstance(head, Rod):
        return Rides(np.array([Ride(0.0, 0.0, 1.0, 0.0, 0.0)] * 2, record_type(Ride)), 0.0, 0.0)
    *above, own = head.lengths[: head.pieces.index(afloat) + 1]
    riding = [floating.riding(1.0 - (1.0 - at) ** 2) for at in np.linspace(0.0, 1.0, SHARES_KNOWN)]
    table = [Ride(r.standing, r.above, r.drag, *r.push) for r in riding]
    return Rides(np.array(table, record_type(Ride)), sum(above, 0.0), own)


def _falls(closing: Closing, unknown: Unknown, top: float) -> tuple[Floats, float]:
    """How deep even currents of growing speed push the line [m], and the step of the speed [m/s].

    Where one pushes it beyond all bounds, as deep as the water.
    """
    water = closing.water
    falls = []
    speeds, step = np.linspace(0.0, FASTEST, SPEEDS, retstep=True)
    for speed in speeds:
        zero = np.zeros_like(water.u)
        even = Profile(replace(water, u=zero + speed, v=zero, w=zero))
        try:
            height = closing.run(unknown, top, closing.coarse_step, profile=even).z
        except MarchError:
            height = 0.0
        falls.append(max(height - unknown.goal, closing.allowed))
    return np.array(falls), float(step)
