"""Indices of Sobol' of polynomials, whose variances are known in closed form."""

import numpy as np
import pytest

from calm.case.draws import normals_of
from calm.case.uncertain import sobol_indices

NORMALS = normals_of(1024, 0)
EXACT = 1e-9
"""The polynomials lie in the span of the fit: what is left is rounding."""


def test_a_sum_of_two_inputs_shares_by_the_squares():
    found = sobol_indices(NORMALS, 5.0 + 3.0 * NORMALS[:, 1] - 4.0 * NORMALS[:, 6])
    assert found.first[[1, 6]] == pytest.approx([9 / 25, 16 / 25], abs=EXACT)
    assert found.total == pytest.approx(found.first, abs=EXACT)
    assert np.delete(found.total, [1, 6]) == pytest.approx(0.0, abs=EXACT)
    assert found.unexplained == pytest.approx(0.0, abs=EXACT)


def test_a_product_counts_for_both_in_the_totals_alone():
    # var(2 a) = 4, var(a b) = 1, var(b² / 2) = 1/2
    a, b = NORMALS[:, 0], NORMALS[:, 8]
    found = sobol_indices(NORMALS, 2.0 * a + a * b + 0.5 * b * b)
    assert found.first[[0, 8]] == pytest.approx([4 / 5.5, 0.5 / 5.5], abs=EXACT)
    assert found.total[[0, 8]] == pytest.approx([5 / 5.5, 1.5 / 5.5], abs=EXACT)


def test_a_cube_is_explained_too():
    # z³ = √6 ψ₃ + 3 ψ₁
    found = sobol_indices(NORMALS, NORMALS[:, 2] ** 3)
    assert found.first[2] == pytest.approx(1.0, abs=EXACT)


def test_what_no_term_explains_is_left_out_of_the_shares():
    # the variance of |z| is 1 - 2/π; that of its part along ψ₂ is (2/π)/2
    found = sobol_indices(NORMALS, np.abs(NORMALS[:, 3]))
    explained = (1.0 / np.pi) / (1.0 - 2.0 / np.pi)
    assert found.unexplained == pytest.approx(1.0 - explained, abs=0.01)
    # the terms of two inputs take up some of the noise that the rest is to them
    assert found.first.sum() == pytest.approx(1.0 - found.unexplained, abs=0.01)


@pytest.mark.parametrize(
    ("normals", "values"),
    [
        (NORMALS, np.full(1024, 7.0)),
        (NORMALS[:128], NORMALS[:128, 0]),
        (NORMALS[:0], NORMALS[:0, 0]),
    ],
)
def test_none_where_nothing_varies_or_samples_are_few(normals, values):
    assert sobol_indices(normals, values) is None
