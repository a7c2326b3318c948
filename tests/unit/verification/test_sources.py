"""What every case owes a reader; the figures themselves are checked in tests/validation."""

from __future__ import annotations

import math
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from calm.verification import SOURCES, Kind

DOCS = Path(__file__).resolve().parents[3] / "docs"
CASES = [(source, case) for source in SOURCES for case in source.cases]


def test_names_are_unique():
    assert max(Counter(source.title for source in SOURCES).values()) == 1
    assert max(Counter((source.title, case.name) for source, case in CASES).values()) == 1


def test_every_figure_is_finite_and_every_tolerance_has_a_reason():
    for source, case in CASES:
        assert math.isfinite(case.expected), case.name
        assert 0.0 < case.tolerance < math.inf, case.name
        assert case.why.endswith("."), case.name
        assert source.text


def test_the_points_a_curve_is_drawn_through_verify_nothing():
    copied = [case.name for _, case in CASES if case.kind is Kind.BY_CONSTRUCTION]
    assert all(case.why.startswith("The printed digits") <= (case.name in copied)
               for _, case in CASES)  # fmt: skip
    assert not any(name.startswith("C23 sphere") or "Cheng" in name for name in copied)
    assert "C23 cylinder, Re 31.7, Wieselsberger" in copied


@pytest.mark.parametrize(
    "number", [1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 15, 16, 20, 22, 23], ids="C{}".format
)
def test_no_numbered_case_is_lost(number):
    assert any(f"C{number}" in case.name.split() for _, case in CASES)


@pytest.mark.thorough
def test_the_page_is_what_the_cases_say():
    finished = subprocess.run(
        [sys.executable, DOCS / "generate_verification.py", "--check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert finished.returncode == 0, finished.stderr


def test_every_picture_is_drawn():
    for source in SOURCES:
        if source.picture:
            assert (DOCS / "images" / f"{source.picture}.svg").stat().st_size > 1000
