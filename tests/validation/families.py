"""Random moorings and tows of one kind each, where a solver's estimate of its error is put to test.

A family draws a case from a `Random`: a function that solves it at given settings. The moorings
are those of `tests.property.strategies`, chosen or changed to be deep, on the seabed, stretchy,
in a sheared current and so on; the tows are those of `tests.validation.random_tows`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from math import exp, log, pi
from random import Random

import numpy as np

from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, solve_mooring, solve_tow
from tests.property.strategies import hardware, mooring, sea
from tests.validation.pieces import HALF_DENSITY, Piece, line_of, point
from tests.validation.random_tows import tow
from tests.validation.test_curves import curved
from tests.validation.test_random_floats import surface_mooring

Case = Callable[[Settings], Solution]
Family = Callable[[Random], Case]


def _moored(line: Line, water: Water, friction: float = 0.0) -> Case:
    return lambda settings: solve_mooring(line, water, replace(settings, seabed_friction=friction))


def _of_depth(least: float, most: float) -> Family:
    """Sub-surface moorings in water of a depth [m]."""

    def family(random: Random) -> Case:
        while True:
            line, water = mooring(random, surface=False)
            if least <= water.depth <= most:
                return _moored(line, water)

    return family


def _surface(random: Random) -> Case:
    return _moored(*mooring(random, surface=True))


def _at_its_draft(random: Random) -> Case:
    line, water, _ = surface_mooring(random)
    return _moored(line, water)


def _on_the_seabed(random: Random) -> Case:
    """A scope of 1.05 to 2, the lower part chain; half of them with friction on the seabed."""
    depth = _log(random, 20.0, 1000.0)
    water = _fitted(sea(random), depth)
    share = random.uniform(0.3, 0.9)
    pieces = hardware(random, share * depth)
    bottom = (random.uniform(1.05, 2.0) - share) * depth
    pieces.append(_chain(random.uniform(0.008, 0.03), bottom))
    weight = max(0.0, -min(np.cumsum([piece.total for piece in pieces])))
    tension = 100.0 + weight
    for piece in pieces:
        piece.compliance /= tension
    buoyancy = 100.0 + weight * random.uniform(0.5, 3.0)
    pieces.insert(0, _float(buoyancy, random))
    friction = random.choice([0.0, random.uniform(0.1, 1.0)])
    return _moored(line_of(*pieces), water, friction)


def _stretchy(random: Random) -> Case:
    """Nylon that stretches by 5 to 40 % at its tension, half of it by a table."""
    line, water = mooring(random)
    pull = float(line.total_buoyancy[line.total_buoyancy > 0.0].sum())
    stretch = np.where(line.flexible, random.uniform(0.05, 0.4) / pull, 0.0)
    line = replace(line, compliance=stretch)
    return _moored(curved(line, random) if random.random() < 0.5 else line, water)


def _sheared(random: Random) -> Case:
    """A hundred levels, of a current that wanders from one to the next by up to 0.3 m/s."""
    line, water = mooring(random)
    return _moored(line, _with_levels(water, random))


def _with_levels(water: Water, random: Random) -> Water:
    generator = np.random.default_rng(random.getrandbits(32))
    level = np.linspace(0.0, water.depth, 100)
    walk = np.cumsum(generator.uniform(-0.3, 0.3, (2, 100)), axis=1)
    u, v = walk * random.uniform(0.1, 1.0)
    rising = 1025.0 + 5.0 * np.sort(generator.random(100))
    return replace(water, level=level, u=u, v=v, w=np.zeros(100), density=rising)


def _all_chain(random: Random) -> Case:
    depth = _log(random, 20.0, 500.0)
    water = _fitted(sea(random), depth)
    length = depth * random.uniform(0.3, 1.2)
    pieces = [_chain(random.uniform(0.008, 0.02), length / 3.0) for _ in range(3)]
    weight = -sum(piece.total for piece in pieces)
    pieces.insert(0, _float(100.0 + weight * random.uniform(0.3, 3.0), random))
    return _moored(line_of(*pieces), water)


def _many_clamps(random: Random) -> Case:
    """Twenty to sixty instruments clamped on the cables."""
    line, water = mooring(random)
    count = random.randint(20, 60)
    on = [random.choice(np.flatnonzero(line.flexible).tolist()) for _ in range(count)]
    lift = float(line.buoyancy[~line.flexible].max())
    return _moored(
        replace(
            line,
            clamp_piece=on,
            clamp_at=[random.random() * line.length[piece] for piece in on],
            clamp_buoyancy=[random.uniform(-0.5, 0.2) * lift / count for _ in on],
            clamp_volume=np.zeros(count),
            clamp_drag=[random.uniform(0.0, 15.0) for _ in on],
            clamp_lift=np.zeros(count),
        ),
        water,
    )


def _smooth(random: Random) -> Case:
    """Drag by the Reynolds number, ropes that stretch by a table, the three laws of friction."""
    line, water = mooring(random)
    line = replace(curved(line, random), friction=random.choice(list(Friction)))
    return _moored(line, water)


def _towed(wanted: Callable[[Line, float], bool]) -> Family:
    def family(random: Random) -> Case:
        while True:
            line, water, towing = tow(random)
            if wanted(line, towing.height):
                return partial(solve_tow, line, water, towing)

    return family


def _tow_in_shear(random: Random) -> Case:
    line, water, towing = tow(random)
    depth = min(water.depth, 2.0 * float(line.length.sum()))
    sheared = _with_levels(replace(water, depth=depth), random)
    return partial(solve_tow, line, replace(sheared, depth=water.depth), towing)


def _fitted(water: Water, depth: float) -> Water:
    """The same water over another depth [m]."""
    return replace(water, depth=depth, level=water.level * depth / water.depth)


def _chain(bar: float, length: float) -> Piece:
    normal, tangential = HALF_DENSITY * bar * 2.75, HALF_DENSITY * pi * bar * 0.46
    return Piece(length, True, -170e3 * bar**2, normal, tangential, compliance=1e-9)


def _float(buoyancy: float, random: Random) -> Piece:
    return point(buoyancy, buoyancy * _log(random, 0.003, 0.1))


def _log(random: Random, low: float, high: float) -> float:
    return exp(random.uniform(log(low), log(high)))


FAMILIES: dict[str, Family] = {
    "deep": _of_depth(1000.0, 6000.0),
    "shallow": _of_depth(0.0, 200.0),
    "surface": _surface,
    "at its draft": _at_its_draft,
    "on the seabed": _on_the_seabed,
    "stretchy": _stretchy,
    "sheared": _sheared,
    "all chain": _all_chain,
    "many clamps": _many_clamps,
    "smooth": _smooth,
    "tow": _towed(lambda line, height: line.strumming is None and height == 0.0),
    "tow, A-frame": _towed(lambda line, height: line.strumming is None and height > 0.0),
    "tow, strumming": _towed(lambda line, height: line.strumming is not None),
    "tow in shear": _tow_in_shear,
}
