"""The error that every solution states, against the error it has, on random moorings and tows.

Of any depth, offset or tension the true error is at most three times the stated one on 95 % of the
cases, and never ten times. Nor is the estimate idle: on half of the cases the truth is more than
half of it for depths and offsets. Of the anchor's load and needed weight 90 % are within the stated
error and 98 % within twice that. `benchmarks/accuracy.py` holds more against the integration.
"""

from __future__ import annotations

from dataclasses import astuple

import numpy as np
import pytest

from tests.validation.families import FAMILIES
from tests.validation.honesty import Honesty, honesty

CASES = 6


@pytest.fixture(scope="module")
def measured() -> dict[str, list[Honesty]]:
    """The first cases of every family that count."""
    return {family: _first(family, False) for family in FAMILIES}


@pytest.fixture(scope="module")
def marched() -> dict[str, list[Honesty]]:
    """The same of the shapes that were marched, before extrapolation."""
    return {family: _first(family, True) for family in FAMILIES}


def _first(family: str, marched: bool) -> list[Honesty]:
    found: list[Honesty] = []
    number = 0
    while len(found) < CASES:
        number += 1
        assert number <= 10 * CASES, f"{family}: hardly a case stands"
        case = honesty(family, number, marched)
        if isinstance(case, Honesty):
            found.append(case)
    return found


@pytest.mark.parametrize("family", FAMILIES)
def test_no_error_is_ten_times_the_stated_one(measured, family) -> None:
    for case in measured[family]:
        assert max(astuple(case)) <= 10.0


@pytest.mark.parametrize("what", ["anchor", "weight"])
def test_errors_at_the_anchor_are_as_stated(measured, marched, what) -> None:
    """Of the pull on the anchor and of the weight that it needs: 95 % within, all within thrice."""
    for cases in (measured, marched):
        ratios = np.array([getattr(case, what) for found in cases.values() for case in found])
        ratios = ratios[ratios > 0.0]  # a tow has no anchor
        assert np.mean(ratios <= 1.0) >= (0.95 if cases is measured else 0.9)
        assert np.mean(ratios <= 3.0) >= (1.0 if cases is measured else 0.98)
    assert np.median(ratios) >= 0.3  # nor idle, of the shape that was marched


@pytest.mark.parametrize("what", ["place", "tension", "shape", "pull"])
def test_most_errors_are_within_the_stated_one(measured, what) -> None:
    ratios = np.array([getattr(case, what) for cases in measured.values() for case in cases])
    assert np.mean(ratios <= 1.0) >= 0.95
    assert np.mean(ratios <= 3.0) >= 0.99


def test_the_stated_error_is_that_of_the_shape_that_was_marched(marched) -> None:
    ratios = [case.place for cases in marched.values() for case in cases]
    assert np.median(ratios) >= 0.5
