"""Moorings that could be laid, drawn at random: a line and the water it stands in.

Water of 20 to 6000 m with up to eight levels: current from none to 2.5 m/s, uniform, decaying,
veering, reversing, strongest below the surface, some of it vertical; density constant or growing.
Lines of up to six stretches of wire, rope (stretchy, buoyant or neither) and chain, with shackles,
instruments that follow the line or do not, floats between, clamps on cables and on rigid pieces, a
beacon above the first float. The first float is sized for the weight below it and for the lean
that the drag of the line gives it, so that most draws have an equilibrium.

Hypothesis draws the number that seeds a mooring and not its figures: those it would take mostly
from the small ends of their ranges, where moorings are all alike.
"""

from __future__ import annotations

from math import exp, log, pi
from random import Random

import numpy as np
from hypothesis import strategies as st

from calm.physics.line import Line, Water
from tests.validation.pieces import GRAVITY, HALF_DENSITY, Piece, line_of, sphere_drag

MATERIALS = {  # weight in water per volume [N/m³], strain at the tension the line is made for
    "steel": (45e3, 0.002),
    "polyester": (3e3, 0.02),
    "nylon": (1e3, 0.12),
    "polypropylene": (-1e3, 0.05),
    "inextensible": (0.0, 0.0),
}

draws = st.integers(0, 2**32 - 1)
"""Numbers that seed a mooring: `mooring(Random(number))`."""


def mooring(random: Random, surface: bool | None = None) -> tuple[Line, Water]:
    """A line and its water; a line made for the surface may yet be pulled under."""
    surface = random.random() < 0.5 if surface is None else surface
    water = sea(random)
    scope = random.uniform(0.85, 1.3) if surface else random.uniform(0.2, 0.97)
    pieces = hardware(random, scope * water.depth)
    if random.random() < 0.5:
        pieces.append(_chain(random, water.depth))

    weight = max(0.0, -float(np.cumsum([piece.total for piece in pieces]).min()))
    speed = float(np.sqrt(np.mean(water.u**2 + water.v**2)))
    drag = sum(piece.resistance for piece in pieces) * speed**2
    buoyancy = 100.0 + weight * random.uniform(1.05, 3.0) + drag / _log(random, 0.1, 5.0)
    if surface:
        buoyancy *= _log(random, 1.0, 10.0)
    tension = min(buoyancy, 100.0 + 3.0 * weight + 5.0 * drag)
    for piece in pieces:  # until here `compliance` was the strain at this tension
        piece.compliance /= tension
    pieces.insert(0, float_of(buoyancy, random.uniform(0.5, 1.0)))
    if random.random() < 0.25:
        beacon = Piece(random.uniform(0.3, 1.5), False, -random.uniform(10.0, 80.0), 20.0, 5.0)
        beacon.directional = random.random() < 0.5
        pieces.insert(0, beacon)
    return line_of(*pieces, anchor_height=random.uniform(0.0, 1.5)), water


def sea(random: Random) -> Water:
    """Water with a current."""
    depth = _log(random, 20.0, 6000.0)
    n = random.randint(1, 8)
    gaps = np.array([random.uniform(0.05, 1.0) for _ in range(n)])
    level = (np.cumsum(gaps) - gaps[0]) / gaps.sum() * depth
    level *= random.choice([1.0, 1.0, 1.3])  # the last rows may lie below the seabed
    speed = 0.0 if random.random() < 0.05 else _log(random, 0.02, 2.5)
    decay = np.exp(-level / depth * random.choice([0.0, 2.0, 6.0]))
    strength = speed * decay * np.array([random.random() for _ in range(n)])
    veer = random.choice([0.0, 0.5, pi])  # straight, veering, every way
    toward = random.uniform(0.0, 2.0 * pi) + veer * np.array(
        [random.uniform(-1.0, 1.0) for _ in range(n)]
    )
    upward = 0.1 * speed if random.random() < 0.25 else 0.0
    w = upward * np.array([random.uniform(-1.0, 1.0) for _ in range(n)])
    density = random.choice([1025.0, 1025.0, 1000.0]) + random.choice([0.0, 0.005]) * level
    return Water(
        depth=depth, level=level, u=strength * np.cos(toward), v=strength * np.sin(toward), w=w,
        density=density, gravity=GRAVITY,
    )  # fmt: skip


def hardware(random: Random, length: float) -> list[Piece]:
    """Cables of a total length with what stands between them; `compliance` holds their strain."""
    shares = np.array([random.uniform(0.1, 1.0) for _ in range(random.randint(1, 6))])
    pieces: list[Piece] = []
    for part in length * shares / shares.sum():
        pieces += [_instrument(random) for _ in range(random.randint(0, 3))]
        pieces.append(_cable(random, float(part)))
        if random.random() < 0.25:
            pieces.append(float_of(_log(random, 50.0, 2000.0), random.uniform(0.5, 1.0)))
    return pieces


def float_of(buoyancy: float, drag_coefficient: float) -> Piece:
    """A sphere whose net buoyancy is six tenths of the water it displaces."""
    volume = buoyancy / (0.6 * 1025.0 * GRAVITY)
    diameter = (6.0 * volume / pi) ** (1.0 / 3.0)
    drag = sphere_drag(diameter, drag_coefficient)
    return Piece(diameter, False, buoyancy, drag, drag, False, volume)


def _log(random: Random, low: float, high: float) -> float:
    return exp(random.uniform(log(low), log(high)))


def _clamps(random: Random, length: float, most: int) -> list[tuple[float, float, float, float]]:
    return [
        (
            random.choice([0.0, 1.0, random.random(), random.random()]) * length,
            random.uniform(-100.0, 30.0),
            random.uniform(0.0, 0.01),
            random.uniform(0.0, 15.0),
        )
        for _ in range(random.randint(0, most))
    ]


def _cable(random: Random, length: float) -> Piece:
    diameter = _log(random, 0.004, 0.024)
    area = pi / 4.0 * diameter**2
    weight, strain = MATERIALS[random.choice(list(MATERIALS))]
    normal = HALF_DENSITY * diameter * random.uniform(1.0, 2.0)
    tangential = HALF_DENSITY * pi * diameter * random.choice([0.0, random.uniform(0.003, 0.02)])
    return Piece(
        length, True, -weight * area, normal, tangential, True, random.choice([0.0, area]),
        strain * random.uniform(0.3, 1.0), 0.5, _clamps(random, length, most=3),
    )  # fmt: skip


def _chain(random: Random, depth: float) -> Piece:
    bar, length = random.uniform(0.008, 0.02), random.uniform(0.01, 0.1) * min(depth, 300.0)
    normal, tangential = HALF_DENSITY * bar * 2.75, HALF_DENSITY * pi * bar * 0.46
    return Piece(length, True, -170e3 * bar**2, normal, tangential, compliance=1e-4)


def _instrument(random: Random) -> Piece:
    kind = random.choice(["cylinder along the line", "body of any attitude", "shackle"])
    if kind == "shackle":
        return Piece(0.0, False, -random.uniform(2.0, 30.0), random.uniform(0.0, 3.0), 0.0, False)
    length, width = random.uniform(0.3, 2.5), random.uniform(0.08, 0.3)
    face = pi / 4.0 * width**2
    return Piece(
        length, False, -random.uniform(20.0, 400.0), HALF_DENSITY * 0.8 * width * length,
        HALF_DENSITY * 0.85 * face, kind == "cylinder along the line", face * length,
        clamps=_clamps(random, length, most=1),
    )  # fmt: skip
