"""The published cases of `calm.verification`, one test each; the reasons of the tolerances stand
with the cases."""

from __future__ import annotations

import pytest

from calm.verification import SOURCES

CASES = [
    pytest.param(case, id=f"{source.title}: {case.name}")
    for source in SOURCES
    for case in source.cases
]


@pytest.mark.parametrize("case", CASES)
def test_figure_is_met(case) -> None:
    outcome = case.check()
    assert outcome.within, f"got {outcome.got} for {case.expected} {case.unit} {outcome.reason}"
