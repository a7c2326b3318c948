"""Random draws of a mooring's uncertain inputs, and the mooring for each draw.

The draws are a scrambled Sobol' sequence. An input has the same error everywhere in a draw: all
cables are too long by the same factor, for example.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from math import cos, log1p, radians, sin
from typing import Any, NamedTuple, ParamSpec, TypeVar, cast

import numpy as np

from calm.case.leg import Leg
from calm.case.memory import NoMemory
from calm.errors import NoEquilibrium, UsageError
from calm.files import Spread, Uncertainty
from calm.physics.line import Floats, Line, Water
from calm.solve import Settings, Solution, solve_mooring
from calm.solve.mooring import Nearby

P = ParamSpec("P")
T = TypeVar("T")

SAMPLES = 2048
FEWEST, MOST = 64, 1 << 20
_AT_95 = 1.6448536269514722
_LEAST_FACTOR = 0.01

CAUSES = tuple(Uncertainty.model_fields)
_ANGLE = "direction"


class Draw(NamedTuple):
    """One draw of all uncertain inputs: factors on the specified values, and a change of the
    current direction [degrees].
    """

    current: float = 1.0
    direction: float = 0.0
    cable_drag: float = 1.0
    rigid_drag: float = 1.0
    buoyancy: float = 1.0
    cable_weight: float = 1.0
    length: float = 1.0
    stiffness: float = 1.0
    depth: float = 1.0


def checked_samples(samples: int) -> int:
    """Return the number of samples; raise UsageError unless it is a power of two within the
    limits.
    """
    if FEWEST <= samples <= MOST and samples & (samples - 1) == 0:
        return samples
    near = min(max(FEWEST, 1 << max(samples - 1, 1).bit_length()), MOST)
    raise UsageError(
        f"--samples: {samples} is not a power of two from {FEWEST} to {MOST}; use {near}"
    )


def normals_of(samples: int, seed: int) -> Floats:
    """Return standard normal numbers (samples, causes) from a scrambled Sobol' sequence; `samples`
    is a power of two.
    """
    from scipy.special import ndtri
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(CAUSES), scramble=True, seed=seed)
    normals: Floats = ndtri(np.clip(sequence.random(samples), 1e-12, 1.0 - 1e-12))
    return normals


def draws_of(uncertainty: Uncertainty, normals: Floats) -> list[Draw]:
    """Convert standard normal numbers (n, causes) to draws.

    A deviation in the file is the standard deviation of a normal distribution. A pair of values is
    the 5th and 95th percentile of a normal (angle) or lognormal (factor) distribution.
    """
    columns = [
        (_angles if name == _ANGLE else _factors)(getattr(uncertainty, name), normals[:, i])
        for i, name in enumerate(CAUSES)
    ]
    return [Draw(*row) for row in np.column_stack(columns).tolist()]


def _angles(spread: Spread, normal: Floats) -> Floats:
    if spread.between is None:
        return (spread.deviation or 0.0) * normal
    low, high = spread.between
    return 0.5 * (low + high) + (high - low) / (2.0 * _AT_95) * normal


def _factors(spread: Spread, normal: Floats) -> Floats:
    if spread.between is None:
        return np.maximum(1.0 + (spread.deviation or 0.0) * normal, _LEAST_FACTOR)
    low, high = (log1p(end) for end in spread.between)
    factors: Floats = np.exp(0.5 * (low + high) + (high - low) / (2.0 * _AT_95) * normal)
    return factors


def drawn_line(line: Line, draw: Draw) -> Line:
    """Return the line for one random draw of the uncertain inputs."""
    cable, rises = line.flexible, line.buoyancy > 0.0
    drag = np.where(cable, draw.cable_drag, draw.rigid_drag)
    lift = np.where(cable, draw.cable_weight, np.where(rises, draw.buoyancy, 1.0))
    longer = np.where(cable, draw.length, 1.0)
    floating = line.floating
    if floating is not None:
        first = int(np.argmax(~cable & rises))
        more = (draw.buoyancy - 1.0) * float(line.buoyancy[first])
        floating = replace(floating, weight=floating.weight - more, lift=floating.lift + more)
    on = line.clamp_piece
    return replace(
        line,
        length=longer * line.length,
        normal_drag=drag * line.normal_drag,
        tangential_drag=drag * line.tangential_drag,
        buoyancy=lift * line.buoyancy,
        compliance=line.compliance / draw.stiffness,
        elongation=tuple(each and each.stiffer(draw.stiffness) for each in line.elongation),
        clamp_at=longer[on] * line.clamp_at if len(on) else line.clamp_at,
        clamp_drag=draw.rigid_drag * line.clamp_drag,
        clamp_buoyancy=np.where(line.clamp_buoyancy > 0.0, draw.buoyancy, 1.0)
        * line.clamp_buoyancy,
        floating=floating,
    )


def drawn_water(water: Water, draw: Draw) -> Water:
    """Return the water for one random draw of the uncertain inputs.

    If the water depth changes, the depths of the levels below the surface stay the same.
    """
    turn = radians(draw.direction)
    east, north = draw.current * cos(turn), draw.current * sin(turn)
    return replace(
        water,
        depth=draw.depth * water.depth,
        u=east * water.u + north * water.v,
        v=east * water.v - north * water.u,
        w=draw.current * water.w,
    )


class Neighbours(NoMemory):
    """Solver for moorings that differ little from a solved mooring.

    Each search starts from the known equilibrium; if the search fails, the mooring is solved from
    scratch.
    """

    def __init__(self, leg: Leg) -> None:
        self._leg = leg
        self._moving = Nearby(leg.line, leg.water, leg.settings)
        self._still: Nearby | None = None

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """Call a solver with the given arguments, and return the outcome.

        If the solver is `solve_mooring`, a search that starts from the known equilibrium replaces
        it.
        """
        if solver is solve_mooring:
            solved: Any = self._solved
            return cast("T", solved(*given, **named))
        return super().of(solver, *given, **named)

    def _solved(self, line: Line, water: Water, settings: Settings) -> Solution:
        moving = water.moving or not self._leg.water.moving
        try:
            if moving:
                return self._moving.solved(line, water)
            return self._at_rest(line, settings).solved(line, water)
        except NoEquilibrium:
            return solve_mooring(line, water, settings)

    def _at_rest(self, line: Line, settings: Settings) -> Nearby:
        if self._still is None:
            given = replace(self._leg.line, floating=line.floating)
            self._still = Nearby(given, self._leg.water.still(), settings)
        return self._still


def drawn(leg: Leg, draws: Iterable[Draw]) -> Iterator[Leg]:
    """Yield the leg of a mooring for each draw.

    When a drawn leg is solved, the search starts from the equilibrium of the original leg.

    Raises NoEquilibrium if the original leg has no equilibrium.
    """
    neighbours = Neighbours(leg)
    for draw in draws:
        line, water = drawn_line(leg.line, draw), drawn_water(leg.water, draw)
        yield Leg(leg.file, leg.for_surface, neighbours, line, water)
