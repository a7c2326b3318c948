"""Which input a spread comes from: Sobol' indices, from a fit of Hermite polynomials.

A figure y of independent standard normal inputs z is written y = Σ c_a ψ_a(z), ψ_a products of
normalised Hermite polynomials. These are orthonormal, so that c_a² is the part of the variance
that the term adds: all terms of one input alone give its first-order index, all terms that it is
in its total index. The coefficients are found by least squares (Sudret, Reliability Engineering
and System Safety 93, 2008, 964-979).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from calm.physics.line import Floats

ORDER = 3
"""Order of the terms of one input; those of two have the order 2, and there are none of three."""
FEWEST = 4
"""Samples for each coefficient, at least."""


@dataclass(frozen=True)
class Indices:
    """Shares of the variance of a figure.

    Attributes
    ----------
    first : (k,) what each input causes by itself
    total : (k,) what it has a part in
    unexplained : what no term of the fit explains
    """

    first: Floats
    total: Floats
    unexplained: float


def sobol_indices(normals: Floats, values: Floats) -> Indices | None:
    """The indices of a figure from samples of it.

    Parameters
    ----------
    normals : (n, k) independent standard normal inputs
    values : (n,) the figure at them

    Returns
    -------
    Indices, or None where there are too few samples, or the figure does not vary
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
    coefficients, *_ = np.linalg.lstsq(terms, values, rcond=None)
    left = float((values - terms @ coefficients).var()) / variance
    parts = coefficients[1:] ** 2
    explained = parts.sum()
    parts *= (1.0 - left) / explained
    first, total = np.zeros(inputs), np.zeros(inputs)
    for (i, _), part in zip(powers, parts, strict=False):
        first[i] += part
        total[i] += part
    for (i, j), part in zip(pairs, parts[len(powers) :], strict=True):
        total[i] += part
        total[j] += part
    return Indices(first, total, left)
