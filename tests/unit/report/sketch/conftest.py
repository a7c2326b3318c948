from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import calm
from calm.case.leg_result import LegResult

LINES = Path(__file__).resolve().parents[4] / "lines"


@cache
def _solved(name: str) -> LegResult:
    return calm.load(LINES / f"{name}.yaml").solve().leg


@pytest.fixture
def solved() -> Callable[[str], LegResult]:
    """A shipped line by its name, solved once for all tests of a worker."""
    return _solved
