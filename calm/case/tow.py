"""Solutions of a tow at several ship speeds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from calm.case.design import Design, Result
from calm.errors import NoEquilibrium, or_why_not

SOLVES = 3.0
"""Approximate number of equilibria per speed."""


def at_speed(tow: Design, speed: float) -> Design:
    """Return a copy of a tow at another ship speed [m/s]; a fitted cable keeps its length."""
    assert tow.file.tow is not None
    keys = tow.file.tow.model_copy(update={"speed": speed})
    return Design(replace(tow.file, tow=keys), lines=(tow.line,))


def sweep(tow: Design, speeds: Iterable[float]) -> list[Result | NoEquilibrium]:
    """Solve a tow at several ship speeds > 0 [m/s].

    The list has a result for each speed, or the exception NoEquilibrium for a speed without
    equilibrium. Raises NoEquilibrium if the tow has a fitted cable that cannot reach the required
    depth at the speed in the file.
    """
    return [or_why_not(at_speed(tow, speed).solve) for speed in speeds]
