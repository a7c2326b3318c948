"""Uncertainty of a mooring's results, from solutions for many random draws of its inputs.

Every solution is checked as in a single run. A sample whose solution fails a check counts as a
sample without equilibrium.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from math import hypot
from typing import Any

import numpy as np

from calm.case.design import Result
from calm.case.draws import CAUSES, SAMPLES, Draw, checked_samples, drawn, draws_of, normals_of
from calm.case.ends import anchor_load
from calm.case.leg import Leg
from calm.case.line_figures import ClampFigures, LineFigures
from calm.errors import NoEquilibrium
from calm.physics.line import Floats
from calm.solve import CompiledPart, expect_many

BLOCK = 128
"""Number of samples that a process solves in one task."""

LEVELS = (5.0, 50.0, 95.0)
"""Percentiles of the results [%]."""


@dataclass(frozen=True)
class Contribution:
    """Contribution of one uncertain input to the variance of a quantity.

    Attributes
    ----------
    cause : name of the input
    quantity : name of the quantity
    first : fraction of the variance that the input explains on its own
    total : fraction of the variance that the input explains on its own and in combination with
        other inputs
    """

    cause: str
    quantity: str
    first: float
    total: float


@dataclass(frozen=True)
class Uncertain:
    """Percentiles `LEVELS` of the results of a mooring with uncertain inputs.

    All values exclude samples without an equilibrium. The p pieces include the anchor as the last
    piece.

    Attributes
    ----------
    samples, seed : size and seed of the random sequence
    failures : number of samples without equilibrium, by status
    depth_top, knockdown, tilt, tension : (3, p) in m, m, degrees and N; knockdown is NaN if the
        line has no unique shape in still water
    offset : (3, p) horizontal distance of the top of each piece from the anchor, in the direction
        of the free end [m]
    clamps : (3, 4, m) depth, knockdown, tilt and tension of the m clamps above the anchor
    anchor_tension, required_weight : (3,) anchor tension and required anchor weight [N]
    contributions : contributions of the inputs to the variance of the top's knockdown. The
        excursion of the top replaces the knockdown for a surface mooring, or if the knockdown is
        undefined. Empty if there is no variance, or if there are too few samples
    unexplained : fraction of this variance that the fit does not explain
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
    clamps: Floats
    anchor_tension: Floats
    required_weight: Floats
    contributions: tuple[Contribution, ...]
    unexplained: float

    @property
    def failed(self) -> int:
        """Number of samples without equilibrium."""
        return sum(self.failures.values())

    @property
    def clamped(self) -> list[tuple[int, str]]:
        """Index of the component that carries each clamp, and label of the clamp."""
        given = self.result.clamps
        return list(zip(given.index, given.label, strict=True))[: self.clamps.shape[2]]

    def to_dict(self) -> dict[str, Any]:
        """Return the object `uncertainty` of the JSON results, in SI units; unknown values are
        null.
        """
        columns = ("depth_top", "knockdown", "tilt", "tension")
        clamps = [
            {"index": int(index), "label": label}
            | dict(zip(("depth", *columns[1:]), map(_known, figures), strict=True))
            for (index, label), figures in zip(self.clamped, self.clamps.T, strict=True)
        ]
        components = [
            {"index": int(index)} | {name: _known(getattr(self, name)[:, row]) for name in columns}
            for row, index in enumerate(self.result.components.index)
        ]
        return {
            "samples": self.samples,
            "seed": self.seed,
            "failed": self.failed,
            "components": components,
            "clamps": clamps,
            "anchor": {
                "tension": self.anchor_tension.tolist(),
                "required_weight": self.required_weight.tolist(),
            },
            "contributions": [vars(each) for each in self.contributions],
        }


def _known(values: Floats) -> list[float] | None:
    return None if np.isnan(values).any() else [float(value) for value in values]


Mapped = Callable[[Callable[[Any], Any], Sequence[Any]], Iterable[Any]]
"""Function that applies another function to all tasks in order, in one process (`map`) or in
several.
"""


def uncertain(
    result: Result,
    samples: int = SAMPLES,
    seed: int = 0,
    mapped: Mapped = map,
    normals: Callable[[], Floats] | None = None,
) -> Uncertain:
    """Compute the uncertainty of a solved mooring's results.

    Parameters
    ----------
    result : result of a mooring whose file defines the `uncertainty` of the inputs
    samples : a power of two, from `calm.case.draws.FEWEST` to `calm.case.draws.MOST`
    mapped : function that applies the solver to blocks of samples, like `map`
    normals : function that returns `normals_of(samples, seed)`

    Raises
    ------
    UsageError
        The number of samples is invalid, or the design is a tow or has several legs.
    NoEquilibrium
        No sample has an equilibrium.
    """
    leg = result.design.moored
    checked_samples(samples)
    expect_many(samples, CompiledPart.NEARBY)
    _figures(leg, [Draw()])  # loads compiled code once, before processes are forked
    normal = normals_of(samples, seed) if normals is None else normals()
    draws = draws_of(leg.file.uncertainty, normal)
    blocks = [draws[first : first + BLOCK] for first in range(0, samples, BLOCK)]
    outcomes = [each for block in mapped(partial(_figures, leg), blocks) for each in block]
    failures = [one for one in outcomes if isinstance(one, NoEquilibrium)]
    if len(failures) == samples:
        raise failures[0]
    solved = np.array([not isinstance(one, NoEquilibrium) for one in outcomes])
    figures = [one for one in outcomes if not isinstance(one, NoEquilibrium)]
    pieces = np.percentile(np.stack([one[0] for one in figures]), LEVELS, axis=0)
    ends = np.percentile(np.stack([one[1] for one in figures]), LEVELS, axis=0)
    rows = len(result.components)
    depth_top, knockdown, tilt, tension, offset = np.moveaxis(pieces[..., :rows], 1, 0)
    afloat = result.type == "surface" or bool(np.isnan(knockdown[:, 0]).any())
    quantity, row = ("excursion", 4) if afloat else ("knockdown", 1)
    tops = np.array([one[0][row, 0] for one in figures])
    indices = sobol_indices(normal[solved], tops)
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
        clamps=pieces[:, :4, rows:],
        anchor_tension=ends[:, 0],
        required_weight=ends[:, 1],
        contributions=_contributions(quantity, indices),
        unexplained=0.0 if indices is None else indices.unexplained,
    )


def _figures(
    leg: Leg, draws: Sequence[Draw]
) -> list[tuple[Floats, tuple[float, float]] | NoEquilibrium]:
    """For each draw, compute the values of the pieces and clamps (5, p + m), and the anchor tension
    and required weight.
    """
    figures: list[tuple[Floats, tuple[float, float]] | NoEquilibrium] = []
    for one in drawn(leg, draws):
        try:
            figures.append(_figures_of(one))
        except NoEquilibrium as failure:
            figures.append(failure)
    return figures


def _figures_of(leg: Leg) -> tuple[Floats, tuple[float, float]]:
    solution = leg.equilibrium()
    still = leg.still_counterpart(solution)
    rows = LineFigures(solution, still)
    load = anchor_load(leg, solution)
    (x, y, up), tension = rows.top.T, rows.greatest_tension
    excursion = hypot(x[0], y[0])
    offset = (x * x[0] + y * y[0]) / excursion if excursion else np.zeros(len(x))
    pieces = np.stack([-up, rows.knockdown, rows.tilt, tension, offset])
    anchor = [-rows.bottom[-1, 2], 0.0, 0.0, load.tension, 0.0]
    held = ClampFigures(leg.file.pieces[:-1], solution, still)
    depth = -held.position[:, 2]
    clamps = np.stack([depth, held.knockdown, held.tilt, held.tension, 0.0 * depth])
    return np.column_stack([pieces, anchor, clamps]), (load.tension, load.required_weight)


def _contributions(quantity: str, indices: Indices | None) -> tuple[Contribution, ...]:
    if indices is None:
        return ()
    found = [
        Contribution(cause, quantity, float(first), float(total))
        for cause, first, total in zip(CAUSES, indices.first, indices.total, strict=True)
    ]
    return tuple(sorted(found, key=lambda each: -each.total))


ORDER = 3
"""Highest polynomial order of a single input in the fit. Products of two inputs are also included.
"""
FEWEST = 4
"""Smallest number of samples per fitted coefficient."""


@dataclass(frozen=True)
class Indices:
    """Sobol' indices: fractions of a quantity's variance that each of k inputs explains.

    Attributes
    ----------
    first, total : (k,) first-order index and total index of each input
    unexplained : fraction that no term of the fit explains
    """

    first: Floats
    total: Floats
    unexplained: float


def sobol_indices(normals: Floats, values: Floats) -> Indices | None:
    """Estimate the Sobol' indices of a quantity from samples, by a fit of Hermite polynomials.

    The fit is y = Σ c_a ψ_a(z), where the ψ_a are products of normalised Hermite polynomials. Each
    term contributes c_a² to the variance (Sudret, Reliability Engineering and System Safety 93,
    2008, 964-979). The first-order index of an input is the sum over the terms with this input
    alone. The total index is the sum over all terms with this input.

    Parameters
    ----------
    normals : (n, k) independent standard normal inputs z
    values : (n,) values of the quantity y

    Returns
    -------
    Indices, or None if there are too few samples or the quantity does not vary.
    """
    count, inputs = normals.shape
    powers = [(i, order) for i in range(inputs) for order in range(1, ORDER + 1)]
    pairs = list(combinations(range(inputs), 2))
    variance = float(values.var()) if count else 0.0
    scale = float(np.abs(values).max()) if count else 0.0
    if count < FEWEST * (1 + len(powers) + len(pairs)) or variance <= (1e-9 * scale) ** 2:
        return None
    hermite = (
        normals,
        (normals**2 - 1.0) / np.sqrt(2.0),
        (normals**3 - 3.0 * normals) / np.sqrt(6.0),
    )
    columns = [np.ones(count)]
    columns += [hermite[order - 1][:, i] for i, order in powers]
    columns += [normals[:, i] * normals[:, j] for i, j in pairs]
    terms = np.column_stack(columns)
    coefficients = np.linalg.solve(terms.T @ terms, terms.T @ values)  # terms nearly orthonormal
    left = float((values - terms @ coefficients).var()) / variance
    parts = coefficients[1:] ** 2
    explained = parts.sum()
    parts *= (1.0 - left) / explained
    first: Floats = parts[: len(powers)].reshape(inputs, ORDER).sum(axis=1)
    total = first.copy()
    for pair, part in zip(pairs, parts[len(powers) :], strict=True):
        total[list(pair)] += part
    return Indices(first, total, left)
