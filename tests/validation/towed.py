"""The referee's tows: the mooring's equations followed from the towed body up to the ship.

What flows past a line is the current less the ship's velocity; above the surface it is the wind
less the ship's velocity, in air. Each rigid piece is a body of its own. Unknown are the depth of
the free end and, of a line that strums, the frequency: that of the vortices at the tow point,
F = St |V₀| sin φ_n/D.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, root

from calm.physics.line import Line, Water
from calm.solve import Towing
from tests.validation.cables import NoContinuousSolution
from tests.validation.closing import COARSE, FINE
from tests.validation.continuous import March, Shape
from tests.validation.loads import Profile

AIR_DENSITY = 1.225
SCAN = 60
CLOSED = 1e-9
"""Greatest miss of the tow point, as a share of the line's length, and of the frequency."""


class HalfOut(NoContinuousSolution):
    """Something is half out of the water: what it weighs in either does not let the line close."""


@dataclass(frozen=True)
class Towed:
    """The referee's answer: x and y count from the tow point, pieces from the free end.

    `others` are the depths of the free end in further equilibria, `frequency` [Hz] that of a line
    that strums.
    """

    shape: Shape
    depth: float
    frequency: float = 0.0
    others: tuple[float, ...] = ()


class Passing(Profile):
    """What flows past a towed line, the ship at rest."""

    def __init__(self, water: Water, towing: Towing) -> None:
        levels = water.level
        if not towing.in_air:
            levels = np.concatenate([[0.0], levels[levels > 0.0]])
        past = {name: np.interp(levels, water.level, getattr(water, name)) for name in COLUMNS}
        past["u"], past["v"] = past["u"] - towing.east, past["v"] - towing.north
        super().__init__(replace(water, level=levels, **past))
        if not towing.in_air:
            east, north = towing.wind
            self.values[0] = [east - towing.east, north - towing.north, 0.0, AIR_DENSITY]


COLUMNS = ("u", "v", "w", "density")


class TowMarch(March):
    """Goes from the free end to the ship."""

    def __init__(self, line: Line, water: Water, towing: Towing, tolerance: float) -> None:
        super().__init__(from_free_end(line), water, tolerance)
        self.profile = Passing(water, towing)
        self.height = towing.height

    def up(self, depth: float, frequency: float = 0.0, keeps_paths: bool = False) -> Shape:
        """The shape with the free end at a depth, strumming at a frequency."""
        self.frequency = frequency
        march = self.kept if keeps_paths else self.down
        return march(depth, np.ones(len(self.line.length)))

    def excess(self, depth: float, frequency: float = 0.0) -> float:
        """How much higher than the tow point the line ends [m]."""
        return float(self.up(depth, frequency).bottom[-1, 2]) - self.height

    def shed(self, shape: Shape) -> float:
        """The frequency of the vortices at the tow point [Hz]."""
        model, diameter = self.line.strumming, float(self.line.diameter[-1])
        flow = np.array(self.profile.at(0.0)[:3])
        axis = shape.force_bottom[-1] / np.linalg.norm(shape.force_bottom[-1])
        across = flow - (flow @ axis) * axis
        return float(model.strouhal * np.linalg.norm(across) / diameter)


def from_free_end(line: Line) -> Line:
    """The line of a tow in the order of the march; a clamp's place is from a piece's lower end."""
    turned = {
        name: getattr(line, name)[::-1]
        for name in (
            "length", "flexible", "buoyancy", "volume", "normal_drag", "tangential_drag",
            "directional", "compliance", "thinning", "lift", "diameter",
        )
    }  # fmt: skip
    on, last = line.clamp_piece, len(line.length) - 1
    return replace(
        line, **turned, clamp_piece=last - on, clamp_at=line.length[on] - line.clamp_at, towed=True
    )


def solve_continuous_tow(line: Line, water: Water, towing: Towing) -> Towed:
    """The deepest equilibrium of a tow, its line given from the ship down.

    Raises
    ------
    NoContinuousSolution
        Where there is none, or none without parts out of the water or below the seabed.
    """
    rough, fine = (TowMarch(line, water, towing, tolerance) for tolerance in (COARSE, FINE))
    if line.strumming is None:
        depths = _depths(rough)
        depth = _refined(fine, depths[-1])
        return _answer(fine, depth, 0.0, tuple(depths[:-1]))

    def hum(frequency: float) -> float:
        return rough.shed(rough.up(_depths(rough, frequency)[-1], frequency)) - frequency

    fastest = max(np.hypot(np.hypot(u, v), w) for u, v, w, _ in fine.profile.values)
    most = 1.1 * line.strumming.strouhal * fastest / line.diameter[0]
    frequency = brentq(hum, 0.0, most, xtol=3e-3 * most)
    depth, frequency = _tuned(fine, _depths(rough, frequency)[-1], frequency)
    return _answer(fine, depth, frequency)


def _depths(march: TowMarch, frequency: float = 0.0) -> list[float]:
    """Depths of the free end in every equilibrium, ascending."""
    out = float(march.line.length.sum())
    strained = 1.0 + float((march.line.compliance > 0.0).any())
    passed: list[tuple[float, float]] = []
    refusal = NoContinuousSolution("no depth of the free end brings the line to the ship")
    for depth in np.linspace(0.0, 1.0, SCAN + 1) ** 2 * strained * out * 1.01:
        try:
            excess = march.excess(float(depth), frequency)
        except NoContinuousSolution as none:
            refusal = none
            continue
        passed.append((float(depth), excess))
        if depth > out - march.height and excess < -0.1 * out:
            break
    found = [
        brentq(march.excess, low, high, args=(frequency,), xtol=1e-9 * out)
        for (low, over), (high, under) in pairwise(passed)
        if over * under <= 0.0
    ]
    if not found:
        raise refusal
    return found


def _refined(march: TowMarch, depth: float) -> float:
    """The root close by, by secants: a rough march is 1e-4 of the length off at most."""
    nudge = 1e-4 * float(march.line.length.sum())
    low, high = depth - nudge, depth + nudge
    if march.excess(low) * march.excess(high) > 0.0:
        raise NoContinuousSolution("two equilibria are too close to tell apart")
    return float(brentq(march.excess, low, high, xtol=1e-12, rtol=1e-14))


def _tuned(march: TowMarch, depth: float, frequency: float) -> tuple[float, float]:
    """Depth and frequency close by that fit one another."""
    out = float(march.line.length.sum())

    def misfit(scaled: np.ndarray) -> np.ndarray:
        shape = march.up(scaled[0] * out, scaled[1] * frequency)
        high = (shape.bottom[-1, 2] - march.height) / out
        return np.array([high, march.shed(shape) / frequency - scaled[1]])

    found = root(misfit, np.array([depth / out, 1.0]), tol=1e-13)
    if np.abs(misfit(found.x)).max() > CLOSED:
        raise NoContinuousSolution("no frequency fits the shape it makes")
    return float(found.x[0] * out), float(found.x[1] * frequency)


def _answer(
    march: TowMarch, depth: float, frequency: float, others: tuple[float, ...] = ()
) -> Towed:
    shape = march.up(depth, frequency, keeps_paths=True)
    if abs(shape.bottom[-1, 2] - march.height) > CLOSED * float(march.line.length.sum()):
        raise HalfOut("a piece or a clamp is half out of the water")
    _refuse_impossible(shape, march)
    return Towed(shape.shifted(-shape.bottom[-1, :2]), depth, frequency, others)


def _refuse_impossible(shape: Shape, march: TowMarch) -> None:
    slight = 1e-9 * float(march.line.length.sum())
    if max(shape.depths) > march.depth + slight:
        raise NoContinuousSolution("a part of the line is on the seabed")
    # The line leaves the water once, on its way up to the ship.
    dry = np.array(shape.depths[:-1]) < -slight
    if march.profile.levels[0] == 0.0 and (np.diff(dry.astype(int)) < 0).any():
        raise NoContinuousSolution("a part of the line breaks the surface")
