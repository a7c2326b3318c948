"""Random moorings and tows of one kind each, where a solver's estimate of its error is put to test.

A family draws a case from a `Random`: what CALM and the referee are given. The moorings are those
of `tests.property.strategies`, as they are or chosen or changed to be deep, on the seabed,
stretchy, in a current of thin steps and so on; the tows those of `tests.validation.random_tows`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import cos, exp, log, pi, sin
from random import Random

import numpy as np

from calm.case import Design, load
from calm.case.net import net_legs
from calm.files.legs import nodes_of
from calm.physics.drag import Friction
from calm.physics.line import Line, Water
from calm.solve import Settings, Solution, Towing, solve_mooring, solve_tow
from calm.solve.net import NetSolution, solve_net
from tests.property.strategies import float_of, hardware, mooring, sea
from tests.validation.afloat import Hull
from tests.validation.agreement import Ends
from tests.validation.closing import Equilibrium, solve_continuous
from tests.validation.netted import solve_continuous_net
from tests.validation.pieces import HALF_DENSITY, Piece, line_of, point
from tests.validation.random_nets import net_text
from tests.validation.random_tows import tow
from tests.validation.test_curves import curved
from tests.validation.test_random_floats import surface_mooring
from tests.validation.towed import Passing, Towed, solve_continuous_tow


@dataclass(frozen=True)
class MooringCase:
    """A mooring; `friction` is that on the seabed, `hull` the referee's form of its float."""

    line: Line
    water: Water
    friction: float = 0.0
    hull: Hull | None = None

    def __call__(self, settings: Settings) -> Solution:
        """By CALM."""
        return solve_mooring(self.line, self.water, self.settings(settings))

    def settings(self, settings: Settings) -> Settings:
        """Settings with its friction on the seabed."""
        return replace(settings, seabed_friction=self.friction)

    def integrated(self) -> Equilibrium:
        """By the referee."""
        return solve_continuous(self.line, self.water, self.hull, self.friction)

    @property
    def profile(self) -> None:
        """The water that its loads are recomputed in: that of its solution."""


@dataclass(frozen=True)
class TowCase:
    """A tow."""

    line: Line
    water: Water
    towing: Towing

    def __call__(self, settings: Settings) -> Solution:
        """By CALM."""
        return solve_tow(self.line, self.water, self.towing, settings)

    def integrated(self) -> Towed:
        """By the referee."""
        return solve_continuous_tow(self.line, self.water, self.towing)

    @property
    def profile(self) -> Passing:
        """The water that its loads are recomputed in."""
        return Passing(self.water, self.towing)


@dataclass(frozen=True)
class NetCase:
    """A net."""

    net: Design

    def __call__(self, settings: Settings) -> NetSolution:
        """By CALM."""
        nodes = len(nodes_of(self.net.file.legs))
        return solve_net(net_legs(self.net.legs), nodes, self.net.water, settings)

    def integrated(self, found: NetSolution) -> list[Ends]:
        """By the referee, near what CALM found."""
        ends, _ = solve_continuous_net(net_legs(self.net.legs), found, self.net.water)
        return ends


def random_net(random: Random) -> NetCase:
    """A surface buoy on several legs, or floats below the surface."""
    net = load("net.yaml", text=net_text(random))
    return NetCase(net)


Case = MooringCase | TowCase
Family = Callable[[Random], Case]


def _any(random: Random) -> Case:
    return MooringCase(*mooring(random))


def _of_depth(least: float, most: float) -> Family:
    """Sub-surface moorings in water of a depth [m]."""

    def family(random: Random) -> Case:
        while True:
            line, water = mooring(random, surface=False)
            if least <= water.depth <= most:
                return MooringCase(line, water)

    return family


def _surface(random: Random) -> Case:
    return MooringCase(*mooring(random, surface=True))


def _at_its_draft(random: Random) -> Case:
    line, water, hull = surface_mooring(random)
    return MooringCase(line, water, hull=hull)


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
    return MooringCase(line_of(*pieces), water, friction)


def _stretchy(random: Random) -> Case:
    """Nylon that stretches by 5 to 40 % at its tension, half of it by a table."""
    line, water = mooring(random)
    pull = float(line.total_buoyancy[line.total_buoyancy > 0.0].sum())
    stretch = np.where(line.flexible, random.uniform(0.05, 0.4) / pull, 0.0)
    line = replace(line, compliance=stretch)
    return MooringCase(curved(line, random) if random.random() < 0.5 else line, water)


def _sheared(random: Random) -> Case:
    """A hundred levels, of a current that wanders from one to the next by up to 0.3 m/s."""
    line, water = mooring(random)
    return MooringCase(line, _with_levels(water, random))


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
    return MooringCase(line_of(*pieces), water)


def _many_clamps(random: Random) -> Case:
    """Twenty to sixty instruments clamped on the cables."""
    line, water = mooring(random)
    count = random.randint(20, 60)
    on = [random.choice(np.flatnonzero(line.flexible).tolist()) for _ in range(count)]
    lift = float(line.buoyancy[~line.flexible].max())
    return MooringCase(
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
    return MooringCase(line, water)


def _towed(wanted: Callable[[Line, float], bool]) -> Family:
    def family(random: Random) -> Case:
        while True:
            line, water, towing = tow(random)
            if wanted(line, towing.height):
                return TowCase(line, water, towing)

    return family


def _tow_in_shear(random: Random) -> Case:
    line, water, towing = tow(random)
    depth = min(water.depth, 2.0 * float(line.length.sum()))
    sheared = _with_levels(replace(water, depth=depth), random)
    return TowCase(line, replace(sheared, depth=water.depth), towing)


def _stepped(random: Random) -> Case:
    """Layers of one current each, with steps of 1 cm to 1 m between them.

    One line in three hangs in an S; the friction of one in three is constant.
    """
    line, water = _s_shaped(random) if random.random() < 0.33 else mooring(random)
    if random.random() < 0.33:
        line = replace(line, friction=Friction.CONSTANT)
    return MooringCase(line, _in_layers(water, random))


def _in_layers(water: Water, random: Random) -> Water:
    """Three to twelve layers, each at least twice as thick as a step."""
    count = random.randint(3, 12)
    step = _log(random, 0.01, min(1.0, 0.25 * water.depth / count))
    shares = np.array([random.uniform(0.1, 1.0) for _ in range(count)])
    room = water.depth - 2.0 * step * count
    below = np.cumsum(shares / shares.sum() * room + 2.0 * step)[:-1]
    level = np.column_stack([below - 0.5 * step, below + 0.5 * step]).ravel()
    fastest, veer = _log(random, 0.1, 1.5), random.choice([0.0, 0.5, pi])
    toward, u, v = random.uniform(0.0, 2.0 * pi), [], []
    for _ in range(count):
        speed, angle = fastest * random.random(), toward + veer * random.uniform(-1.0, 1.0)
        u.append(speed * cos(angle))
        v.append(speed * sin(angle))
    still, density = np.zeros(len(level)), float(water.density[0])
    return replace(
        water, level=level, u=np.repeat(u, 2)[1:-1], v=np.repeat(v, 2)[1:-1], w=still,
        density=still + density,
    )  # fmt: skip


def _s_shaped(random: Random) -> tuple[Line, Water]:
    """A surface float on a heavy line that sags above floats in its middle."""
    water = _fitted(sea(random), _log(random, 20.0, 3000.0))
    above, below = random.uniform(0.5, 0.8), random.uniform(0.4, 0.8)
    upper, lower = hardware(random, above * water.depth), hardware(random, below * water.depth)
    weight = [-sum(min(piece.total, 0.0) for piece in part) for part in (upper, lower)]
    middle = float_of(random.uniform(0.2, 0.8) * weight[0] + weight[1] + 50.0, 0.6)
    tension = 200.0 + sum(weight)
    pieces = [*upper, middle, *lower]
    for piece in pieces:
        piece.compliance /= tension
    pieces.insert(0, float_of((200.0 + weight[0]) * _log(random, 1.5, 10.0), 0.6))
    return line_of(*pieces), water


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
    "mooring": _any,
    "stepped": _stepped,
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
