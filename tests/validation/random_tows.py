"""Tows drawn at random: a line from the ship down, its water, and the ship.

Ships of 0.3 to 6 m/s in the seas of `tests.property.strategies`, half of them without a seabed, and
helicopters; lines of its cables, instruments, floats and clamps. At the end hangs a weight, a
depressor, a body that follows the line, or nothing; floats, kites and depressors ride in line. One
tow in three goes over an A-frame with a wind, one in five strums; the friction laws take turns.
The weight of the body is sized for the floats and for the drag of the line.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, exp, log, pi, sin
from random import Random

import numpy as np

from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.physics.strumming import BourgetMarichal
from calm.solve import Towing
from tests.property.strategies import hardware, sea
from tests.validation.pieces import HALF_DENSITY, Piece, line_of, point


def tow(random: Random) -> tuple[Line, Water, Towing]:
    """A line given from the ship down, the water it is in, and the ship."""
    in_air = random.random() < 0.1
    water = sea(random)
    length = _log(random, 0.1, 0.8) * min(water.depth, 2000.0)
    if in_air:
        water = replace(water, density=1.225 * water.density / 1025.0)
    if random.random() < 0.5 or in_air:
        water = replace(water, depth=np.inf)
    speed = _log(random, 10.0, 40.0) if in_air else _log(random, 0.3, 6.0)

    pieces = hardware(random, length)
    while not pieces[0].flexible:  # the line runs over a sheave
        pieces.pop(0)
    for piece in pieces:
        if not piece.flexible and random.random() < 0.3:
            piece.lift = random.choice([-1.0, -1.0, 1.0]) * _log(random, 3.0, 30.0)
        # Not at the upper end, which for the first piece may be where air meets water.
        piece.clamps = [
            (max(at, 0.01 * piece.length), *rest, random.choice([0.0, 0.0, -5.0, 3.0]))
            for at, *rest in piece.clamps
        ]
    strums = random.random() < 0.2
    model = BourgetMarichal()
    for piece in pieces:
        if piece.flexible and strums:
            piece.diameter = piece.normal_drag / (HALF_DENSITY * 1.5)
            piece.normal_drag = HALF_DENSITY * piece.diameter * model.rest

    dense = float(water.density.mean()) / 1025.0
    drag = sum(piece.resistance for piece in pieces) * speed**2 * dense
    lifted = sum(max(piece.total, 0.0) + max(piece.lift, 0.0) * speed**2 for piece in pieces)
    pull = 1.5 * lifted + drag * _log(random, 0.1, 2.0)
    if random.random() < 0.9 or lifted > 0.0:
        pieces.append(_body(random, 50.0 + pull, speed))
    tension = 100.0 + pull + drag
    for piece in pieces:  # until here `compliance` was the strain at this tension
        piece.compliance /= tension

    toward, height, wind = random.uniform(0.0, 2.0 * pi), 0.0, (0.0, 0.0)
    if not in_air and random.random() < 0.33:
        height = random.uniform(0.5, 1.0) * min(8.0, 0.2 * pieces[0].length)
        wind = random.uniform(-15.0, 15.0), random.uniform(-15.0, 15.0)
    line = line_of(
        *pieces, friction=random.choice(list(Friction)), strumming=model if strums else None
    )
    return line, water, Towing(speed * cos(toward), speed * sin(toward), height, wind, in_air)


def _body(random: Random, pull: float, speed: float) -> Piece:
    """What tows at the end, pulling down with so much at a speed."""
    kind = random.choice(["weight", "depressor", "body that follows the line", "fish"])
    drag = pull / speed**2 * _log(random, 0.02, 1.0)
    if kind == "weight":
        return point(-pull, drag)
    if kind == "depressor":
        return replace(point(-0.3 * pull, drag), lift=-0.7 * pull / speed**2)
    length = random.uniform(0.3, 2.5)
    follows = kind == "body that follows the line"
    return Piece(length, False, -pull, drag, random.uniform(0.1, 0.6) * drag, follows)


def _log(random: Random, low: float, high: float) -> float:
    return exp(random.uniform(log(low), log(high)))
