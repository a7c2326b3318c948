"""How sure the figures of a mooring are: it is solved for many draws of what it stands on.

The draws are those of a scrambled Sobol' sequence, one of each cause for a mooring: all its cables
are too long alike, the current too fast at all depths alike. Every sample is closed on the cuts of
the mooring as given, or solved anew where it is of another kind, and passes every check of a
solution.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import cos, log1p, radians, sin
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar, cast

import numpy as np

from calm.case.chaos import Indices, sobol_indices
from calm.case.measure import components_of
from calm.case.memory import Forgetful
from calm.case.moored import anchor_load
from calm.case.mooring import Mooring
from calm.errors import NoEquilibrium, UsageError
from calm.files import Spread, Uncertainty
from calm.physics.line import Floats, Line, Water
from calm.physics.stretch import ElongationCurve
from calm.physics.track import Track
from calm.solve import Settings, Solution, expect_many, solve_mooring
from calm.solve.nearby import Nearby

if TYPE_CHECKING:
    from calm.case.result import Result

P = ParamSpec("P")
T = TypeVar("T")

SAMPLES = 2048
FEWEST, MOST = 64, 1 << 20
BLOCK = 128
"""Samples that one process solves at a time."""

LEVELS = (5.0, 50.0, 95.0)
"""Percentiles that are given."""
_AT_95 = 1.6448536269514722
_LEAST_FACTOR = 0.01

CAUSES = tuple(Uncertainty.model_fields)
_ANGLE = "direction"


class Draw(NamedTuple):
    """One draw of all causes: factors of what is given, and an angle [degrees]."""

    current: float = 1.0
    direction: float = 0.0
    cable_drag: float = 1.0
    rigid_drag: float = 1.0
    buoyancy: float = 1.0
    cable_weight: float = 1.0
    length: float = 1.0
    stiffness: float = 1.0
    depth: float = 1.0


def normals_of(samples: int, seed: int) -> Floats:
    """(samples, causes) standard normals, of a scrambled Sobol' sequence.

    Parameters
    ----------
    samples : a power of two
    """
    from scipy.special import ndtri
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(CAUSES), scramble=True, seed=seed)
    normals: Floats = ndtri(np.clip(sequence.random(samples), 1e-12, 1.0 - 1e-12))
    return normals


def draws_of(uncertainty: Uncertainty, normals: Floats) -> list[Draw]:
    """What standard normals (n, causes) stand for.

    A deviation is that of a normal distribution about what is given. A pair is the 5 and the 95 %
    of a normal distribution of an angle, of a lognormal one of a factor.
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
    """The line as a draw has it."""
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
        elongation=tuple(_stiffer(curve, draw.stiffness) for curve in line.elongation),
        clamp_at=longer[on] * line.clamp_at if len(on) else line.clamp_at,
        clamp_drag=draw.rigid_drag * line.clamp_drag,
        clamp_buoyancy=np.where(line.clamp_buoyancy > 0.0, draw.buoyancy, 1.0)
        * line.clamp_buoyancy,
        floating=floating,
    )


def _stiffer(curve: ElongationCurve | None, stiffness: float) -> ElongationCurve | None:
    return None if curve is None else curve.stiffer(stiffness)


def drawn_water(water: Water, draw: Draw) -> Water:
    """The water as a draw has it: its levels stay at their depths below the surface."""
    turn = radians(draw.direction)
    east, north = draw.current * cos(turn), draw.current * sin(turn)
    return replace(
        water,
        depth=draw.depth * water.depth,
        u=east * water.u + north * water.v,
        v=east * water.v - north * water.u,
        w=draw.current * water.w,
    )


class Neighbours(Forgetful):
    """Solves what differs little from a mooring from where that stands, and else anew."""

    def __init__(self, mooring: Mooring) -> None:
        self._mooring = mooring
        self._moving = Nearby(mooring.line, mooring.water, mooring.settings)
        self._still: Nearby | None = None
        self._laid: tuple[Line, Track] | None = None

    def of(self, solver: Callable[P, T], *given: P.args, **named: P.kwargs) -> T:
        """What the solver returns."""
        if solver is solve_mooring:
            solved: Any = self._solved
            return cast("T", solved(*given, **named))
        return super().of(solver, *given, **named)

    def _solved(self, line: Line, water: Water, settings: Settings) -> Solution:
        moving = water.moving or not self._mooring.water.moving
        try:
            if moving:
                return self._moving.solved(line, water, self._track(line))
            return self._at_rest(line, settings).solved(line, water, self._track(line))
        except NoEquilibrium:
            return solve_mooring(line, water, settings)

    def _track(self, line: Line) -> Track:
        if self._laid is None or self._laid[0] is not line:
            self._laid = line, Track.of(line)
        return self._laid[1]

    def _at_rest(self, line: Line, settings: Settings) -> Nearby:
        if self._still is None:
            given = replace(self._mooring.line, floating=line.floating)
            self._still = Nearby(given, self._mooring.water.still(), settings)
        return self._still


def drawn(mooring: Mooring, draws: Iterable[Draw]) -> Iterator[Mooring]:
    """The mooring as some draws have it, each solved from where the mooring stands.

    Raises
    ------
    NoEquilibrium
        The mooring itself has none.
    """
    neighbours = Neighbours(mooring)
    for draw in draws:
        line, water = drawn_line(mooring.line, draw), drawn_water(mooring.water, draw)
        yield Mooring(mooring.file, mooring.for_surface, neighbours, line, water)


@dataclass(frozen=True)
class Contribution:
    """What share of the variance of a quantity a cause explains, alone and with the others."""

    cause: str
    quantity: str
    first: float
    total: float


@dataclass(frozen=True)
class Uncertain:
    """How sure the figures of a mooring are. Percentiles are in the order of `LEVELS`.

    Attributes
    ----------
    result : of the mooring as given
    samples, seed : of the sequence
    failures : samples without equilibrium, by status; all other figures are of the rest
    depth_top, knockdown, tilt, tension : (3, p) of the p pieces, the anchor last; knockdown is
        NaN where the line has no unique shape in still water [m], [m], [degrees], [N]
    offset : (3, p) of the top of each piece from the anchor, the way the free end is off [m]
    anchor_tension, required_weight : (3,) [N]
    contributions : to the top's knockdown, or afloat to its excursion; none where it does not vary
    unexplained : share of that variance that the fit of the indices does not explain
    """

    result: Result
    samples: int
    seed: int
    failures: dict[str, int]
    depth_top: Floats
    knockdown: Floats
    tilt: Floats
    tension: Floats
    offset: Floats
    anchor_tension: Floats
    required_weight: Floats
    contributions: tuple[Contribution, ...]
    unexplained: float

    @property
    def failed(self) -> int:
        """Samples without equilibrium."""
        return sum(self.failures.values())

    def to_dict(self) -> dict[str, Any]:
        """The object `uncertainty` of the result format: SI, null where a figure is unknown."""
        columns = ("depth_top", "knockdown", "tilt", "tension")
        components = [
            {"index": int(index)} | {name: _known(getattr(self, name)[:, row]) for name in columns}
            for row, index in enumerate(self.result.components.index)
        ]
        return {
            "samples": self.samples,
            "seed": self.seed,
            "failed": self.failed,
            "components": components,
            "anchor": {
                "tension": self.anchor_tension.tolist(),
                "required_weight": self.required_weight.tolist(),
            },
            "contributions": [vars(each) for each in self.contributions],
        }


def _known(values: Floats) -> list[float] | None:
    return None if np.isnan(values).any() else [float(value) for value in values]


Mapped = Callable[[Callable[[Any], Any], Sequence[Any]], Iterable[Any]]
"""Makes of every task what a function makes of it, in their order: `map`, or several processes."""


def uncertain(
    result: Result, samples: int = SAMPLES, seed: int = 0, mapped: Mapped = map
) -> Uncertain:
    """How sure the figures of a solved mooring are.

    Parameters
    ----------
    result : of a mooring; what its file says under `uncertainty` is drawn
    samples : a power of two from `FEWEST` to `MOST`
    seed : of the scrambling; the same seed gives the same figures
    mapped : has blocks of samples solved

    Raises
    ------
    UsageError
        The number of samples is none of these.
    NoEquilibrium
        No sample has an equilibrium.
    """
    mooring = result.mooring
    normals = normals_of(checked_samples(samples), seed)
    draws = draws_of(mooring.file.uncertainty, normals)
    expect_many(samples)
    blocks = [draws[first : first + BLOCK] for first in range(0, samples, BLOCK)]
    outcomes = [each for block in mapped(partial(_figures, mooring), blocks) for each in block]
    failures = [one for one in outcomes if isinstance(one, NoEquilibrium)]
    if len(failures) == samples:
        raise failures[0]
    solved = np.array([not isinstance(one, NoEquilibrium) for one in outcomes])
    figures = [one for one in outcomes if not isinstance(one, NoEquilibrium)]
    pieces = np.percentile(np.stack([one[0] for one in figures]), LEVELS, axis=0)
    ends = np.percentile(np.stack([one[1] for one in figures]), LEVELS, axis=0)
    depth_top, knockdown, tilt, tension, offset = np.moveaxis(pieces, 1, 0)
    afloat = result.type == "surface" or bool(np.isnan(knockdown[:, 0]).any())
    quantity, row = ("excursion", 4) if afloat else ("knockdown", 1)
    tops = np.array([one[0][row, 0] for one in figures])
    indices = sobol_indices(normals[solved], tops)
    return Uncertain(
        result=result,
        samples=samples,
        seed=seed,
        failures=dict(Counter(one.status for one in failures)),
        depth_top=depth_top,
        knockdown=knockdown,
        tilt=tilt,
        tension=tension,
        offset=offset,
        anchor_tension=ends[:, 0],
        required_weight=ends[:, 1],
        contributions=_contributions(quantity, indices),
        unexplained=0.0 if indices is None else indices.unexplained,
    )


def checked_samples(samples: int) -> int:
    """The number of samples, if it is one.

    Raises
    ------
    UsageError
    """
    if FEWEST <= samples <= MOST and samples & (samples - 1) == 0:
        return samples
    near = min(max(FEWEST, 1 << max(samples - 1, 1).bit_length()), MOST)
    raise UsageError(
        f"--samples: {samples} is no power of two from {FEWEST} to {MOST}; take {near}"
    )


def _figures(
    mooring: Mooring, draws: Sequence[Draw]
) -> list[tuple[Floats, tuple[float, float]] | NoEquilibrium]:
    """Of each draw (5, p) figures of the pieces, in the order of `Uncertain`, and the anchor's."""
    figures: list[tuple[Floats, tuple[float, float]] | NoEquilibrium] = []
    for one in drawn(mooring, draws):
        try:
            figures.append(_figures_of(one))
        except NoEquilibrium as failure:
            figures.append(failure)
    return figures


def _figures_of(mooring: Mooring) -> tuple[Floats, tuple[float, float]]:
    solution = mooring.equilibrium(mooring.water)
    rows = components_of(mooring.file.pieces[:-1], solution, mooring.still_beside(solution))
    load = anchor_load(mooring, solution)
    pieces = [rows.depth_top, rows.knockdown, rows.tilt, rows.tension]
    anchor = [float(rows.depth_bottom[-1]), 0.0, 0.0, load.tension, 0.0]
    x, y = rows.x_top, rows.y_top
    excursion = float(np.hypot(x[0], y[0]))
    pieces.append((x * x[0] + y * y[0]) / excursion if excursion else np.zeros(len(rows)))
    return np.column_stack([np.stack(pieces), anchor]), (load.tension, load.required_weight)


def _contributions(quantity: str, indices: Indices | None) -> tuple[Contribution, ...]:
    """The greatest first."""
    if indices is None:
        return ()
    found = [
        Contribution(cause, quantity, float(first), float(total))
        for cause, first, total in zip(CAUSES, indices.first, indices.total, strict=True)
    ]
    return tuple(sorted(found, key=lambda each: -each.total))
