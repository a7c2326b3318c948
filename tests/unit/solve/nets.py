"""Nets for tests: lines of wires and points, and an independent solver by relaxation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats, Line, Water
from calm.solve.leg_layout import LegEnd, NetLeg

RHO = 1025.0


@dataclass(frozen=True)
class Wire:
    """A wire: length [m], weight in water [N/m], diameter [m], EA [N], Cn and Ct."""

    length: float
    weight: float = 2.64
    diameter: float = 0.01
    stiffness: float = 4.7e6
    cn: float = 1.5
    ct: float = 0.01


@dataclass(frozen=True)
class Point:
    """A sphere without length: lift [N], diameter [m] and Cx."""

    lift: float
    diameter: float
    cx: float


def line_of(*parts: Wire | Point) -> Line:
    """The line of some parts, its upper end first."""
    rows = []
    for part in parts:
        if isinstance(part, Wire):
            kn = 0.5 * RHO * part.cn * part.diameter
            kt = 0.5 * RHO * part.ct * np.pi * part.diameter
            rows.append((part.length, True, -part.weight, kn, kt, True, 1.0 / part.stiffness))
        else:
            k = 0.5 * RHO * part.cx * np.pi * part.diameter**2 / 4
            rows.append((0.0, False, part.lift, k, k, False, 0.0))
    columns = list(zip(*rows, strict=True))
    none, zero = np.zeros(0), np.zeros(len(rows))
    return Line(
        length=np.array(columns[0]),
        flexible=np.array(columns[1]),
        buoyancy=np.array(columns[2]),
        volume=zero,
        normal_drag=np.array(columns[3]),
        tangential_drag=np.array(columns[4]),
        directional=np.array(columns[5]),
        compliance=np.array(columns[6]),
        thinning=zero,
        clamp_piece=np.zeros(0, np.int64),
        clamp_at=none,
        clamp_buoyancy=none,
        clamp_volume=none,
        clamp_drag=none,
    )


def water_of(depth: float, *flows: tuple[float, float, float], density: float = RHO) -> Water:
    """Water with a current: depth, and its speed to the east and to the north, each [m, m/s]."""
    level, u, v = (np.array(column) for column in zip(*(flows or ((0.0, 0.0, 0.0),)), strict=True))
    flat = np.full(len(level), density)
    return Water(depth, level, u, v, 0.0 * u, flat, 9.81)


def anchored(east: float, north: float, depth: float) -> LegEnd:
    """An end on the seabed at a depth [m]."""
    return LegEnd(place=(east, north, -depth), seabed=-depth)


def relaxed(
    legs: Sequence[NetLeg], nodes: int, water: Water, start: Floats, lumps: int = 12
) -> tuple[Floats, list[Floats]]:
    """Where the nodes and all lumps of a net of elastic legs come to rest.

    Springs between lumps with half of each spring's weight and drag at its ends; let go and damped
    by stopping it whenever it moves fastest. No seabed, no surface. The error is that of chords in
    place of curves, of second order in the length of a spring.

    Parameters
    ----------
    start : (n, 3) where the nodes are at first [m]
    """
    place: list[Floats] = [np.array(each, float) for each in start]
    free = [True] * nodes
    a, b, rest, stiff, weight, kn, kt = ([] for _ in range(7))
    points: list[tuple[int, float, float]] = []
    rows = []
    for leg in legs:
        ends = []
        for end, other, side in ((leg.upper, leg.lower, 1.0), (leg.lower, leg.upper, -1.0)):
            if end.node >= 0:
                ends.append(end.node)
                continue
            at = end.place
            if at is None:
                foot = start[other.node] if other.node >= 0 else np.array(other.place)
                at = (foot[0], foot[1], foot[2] + side * float(leg.line.length.sum()))
            place.append(np.array(at, float))
            free.append(end.place is None)
            ends.append(len(place) - 1)
        wires = [i for i in range(len(leg.line.length)) if leg.line.flexible[i]]
        whole = float(leg.line.length.sum())
        row, done = [ends[0]], 0.0
        for i in range(len(leg.line.length)):
            if i not in wires:
                points.append(
                    (row[-1], float(leg.line.buoyancy[i]), float(leg.line.normal_drag[i]))
                )
                continue
            for k in range(lumps):
                done += float(leg.line.length[i]) / lumps
                last = i == wires[-1] and k == lumps - 1
                if last:
                    lump = ends[1]
                else:
                    place.append(place[ends[0]] + (place[ends[1]] - place[ends[0]]) * done / whole)
                    free.append(True)
                    lump = len(place) - 1
                a.append(row[-1])
                b.append(lump)
                rest.append(float(leg.line.length[i]) / lumps)
                stiff.append(1.0 / float(leg.line.compliance[i]))
                weight.append(-float(leg.line.buoyancy[i]))
                kn.append(float(leg.line.normal_drag[i]))
                kt.append(float(leg.line.tangential_drag[i]))
                row.append(lump)
        rows.append(row)
    at = np.array(place)
    first, second = np.array(a), np.array(b)
    length, ea, w, normal, along = (np.array(each) for each in (rest, stiff, weight, kn, kt))
    spring = ea / length
    mass = np.zeros(len(at))
    np.add.at(mass, first, spring)
    np.add.at(mass, second, spring)
    held = ~np.array(free)
    speed, energy = np.zeros_like(at), 0.0
    at[~held] += 1e-3 * np.random.default_rng(0).standard_normal(at.shape)[~held]
    loads = np.zeros_like(at)
    for turn in range(60_000):
        chord = at[second] - at[first]
        size = np.linalg.norm(chord, axis=1)
        axis = chord / size[:, None]
        if turn % 20 == 0:
            current = water.current_at(-0.5 * (at[first] + at[second])[:, 2])
            flow = (current * axis).sum(axis=1)[:, None] * axis
            across = current - flow
            drag = normal[:, None] * np.linalg.norm(across, axis=1)[:, None] * across
            drag += along[:, None] * np.linalg.norm(flow, axis=1)[:, None] * flow
            drag[:, 2] -= w
            drag *= 0.5 * length[:, None]
            loads = np.zeros_like(at)
            np.add.at(loads, first, drag)
            np.add.at(loads, second, drag)
            for lump, lift, k in points:
                current = water.current_at(-at[lump, 2])
                loads[lump] += k * np.linalg.norm(current) * current + [0.0, 0.0, lift]
        pull = (ea * np.maximum(size / length - 1.0, 0.0))[:, None] * axis
        force = loads.copy()
        np.add.at(force, first, pull)
        np.add.at(force, second, -pull)
        force[held] = 0.0
        if turn % 20 == 0 and np.abs(force).max() < 3e-4:
            break
        speed += 0.95 * force / mass[:, None]
        moving = float((mass * (speed**2).sum(axis=1)).sum())
        if moving < energy:
            speed[:], moving = 0.0, 0.0
        energy = moving
        at += speed
    else:
        raise AssertionError(f"not at rest: {np.abs(force).max():.2g} N")
    return at[:nodes], [at[row] for row in rows]
