"""What hangs on the line, in the lanes: the laws of `calm.physics.rod`, all lanes at once."""

from __future__ import annotations

from math import sqrt

from calm.batch.kernel import lane
from calm.batch.kernel.lane import LANES, SINGLY, Tables, look_up, lost
from calm.batch.kernel.layout import Way
from calm.physics.line import Floats
from calm.physics.load import load_force, load_lift, load_variation, speed_across
from calm.physics.profile import viscosity_at
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.track import Load

IN_WATER, AFLOAT, ABOVE_FLOAT, UPPER_FLOAT = range(4)
"""Where a load is while the float is at the surface: below, the float itself, or out of the water
above it by some share. From `UPPER_FLOAT` on the floats at the surface above that one, from the
top down."""


def load_in_lane(s: Floats, i: int, load: Load, place: int, gravity: float) -> Load:
    """A load as a lane has it: what is at the surface, by how much of it is in use."""
    buoyancy, volume, lift = load.buoyancy, load.volume, load.lift
    normal, tangential = load.normal_drag, load.tangential_drag
    east = north = 0.0
    if place == AFLOAT:
        share, held = s[lane.SHARE + i], s[lane.HELD + i]
        buoyancy, volume = share * buoyancy, share * volume
        normal, tangential = held * normal, held * tangential
        east, north = s[lane.WIND_EAST + i], s[lane.WIND_NORTH + i]
    elif place == ABOVE_FLOAT:
        wet = s[lane.WET + i]
        buoyancy -= (1.0 - wet) * REFERENCE_DENSITY * gravity * volume
        volume, lift = wet * volume, wet * lift
        normal, tangential = wet * normal, wet * tangential
    elif place >= UPPER_FLOAT:
        share = s[lane.UPPER + (place - UPPER_FLOAT) * LANES + i]
        buoyancy, volume = share * buoyancy, share * volume
    return Load(
        load.piece, load.clamp, load.at, load.lever, load.length, buoyancy, volume, normal,
        tangential, load.directional, lift, east, north, load.diameter, load.lengthening,
    )  # fmt: skip


def in_registers(load: Load) -> Load:
    """A load out of the way of what is written."""
    return Load(
        load.piece, load.clamp, load.at, load.lever, load.length, load.buoyancy, load.volume,
        load.normal_drag, load.tangential_drag, load.directional, load.lift, load.push_east,
        load.push_north, load.diameter, load.lengthening,
    )  # fmt: skip


def gather_load(s: Floats, load: Load, place: int, gravity: float, several: bool) -> None:
    """Add a load's part in the moments: what turns the rod by itself, and its normal drag."""
    for i in range(LANES):
        mine = load_in_lane(s, i, load, place, gravity)
        lever = mine.lever
        u, v, w, density = s[lane.U + i], s[lane.V + i], s[lane.W + i], s[lane.DENSITY + i]
        squared = u * u + v * v + w * w
        kn = lever * density * lane.PER_DENSITY * mine.normal_drag
        drag = 0.0 if mine.directional else kn * sqrt(squared)
        lift = lever * load_lift(mine, squared, density, gravity)
        s[lane.AX + i] += lever * mine.push_east + drag * u
        s[lane.AY + i] += lever * mine.push_north + drag * v
        s[lane.AZ + i] += lift + drag * w
        share = kn if mine.directional else 0.0
        if several:
            share *= speed_across(u, v, w, s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i])
        s[lane.K + i] += share
        weight = share if several else (1.0 if mine.directional else 0.0)
        s[lane.GX + i] += weight * u
        s[lane.GY + i] += weight * v
        s[lane.GZ + i] += weight * w


def add_load(s: Floats, load: Load, place: int, gravity: float) -> None:
    """Force of a load in the current looked up: in QX, QY, QZ, added to the sums."""
    for i in range(LANES):
        mine = load_in_lane(s, i, load, place, gravity)
        u, v, w, density = s[lane.U + i], s[lane.V + i], s[lane.W + i], s[lane.DENSITY + i]
        tx, ty, tz = s[lane.NX + i], s[lane.NY + i], s[lane.NZ + i]
        qx, qy, qz = load_force(mine, 1.0, u, v, w, density, gravity, tx, ty, tz)
        s[lane.QX + i], s[lane.QY + i], s[lane.QZ + i] = qx, qy, qz
        s[lane.SX + i] += qx
        s[lane.SY + i] += qy
        s[lane.SZ + i] += qz
        s[lane.MX + i] += mine.lever * qx
        s[lane.MY + i] += mine.lever * qy
        s[lane.MZ + i] += mine.lever * qz


def pass_clamp(s: Floats, water: Tables, way: Way, stage: int) -> None:
    """Add an instrument clamped on a cable."""
    load = in_registers(way.course.loads[way.course.stages[stage].first])
    for i in range(LANES):
        s[lane.DEPTH + i] = -s[lane.Z + i]
        s[lane.C + i] = 1.0
    look_up(s, water)
    if SINGLY and load.diameter > 0.0:
        for i in range(LANES):
            if s[lane.BUSY + i] > 0.0 and not lost(s, i):
                viscosity = viscosity_at(water.sea, s[lane.DEPTH + i])
                u, v, w = s[lane.U + i], s[lane.V + i], s[lane.W + i]
                s[lane.C + i] = load_variation(load, viscosity, u, v, w, 0.0, 0.0, -1.0)
    for i in range(LANES):
        u, v, w, density = s[lane.U + i], s[lane.V + i], s[lane.W + i], s[lane.DENSITY + i]
        varied = s[lane.C + i]
        qx, qy, qz = load_force(load, varied, u, v, w, density, water.sea.gravity, 0.0, 0.0, -1.0)
        s[lane.FX + i] += qx
        s[lane.FY + i] += qy
        s[lane.FZ + i] += qz
