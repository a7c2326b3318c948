"""A tow at several speeds, and with other coefficients of its strumming."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from calm.case.design import Design, Result
from calm.errors import NoEquilibrium, UsageError, or_why_not
from calm.files.strumming_keys import BourgetMarichalKeys

SOLVES = 3.0
"""About how many equilibria one speed takes."""

CHANGE = 0.1
"""Share by which `sensitivity` changes a coefficient, down and up."""

_COEFFICIENTS = ("a1", "b1", "c1")


@dataclass(frozen=True)
class Variation:
    """A tow with one coefficient of its strumming changed.

    Attributes
    ----------
    coefficient : ``"a1"``, ``"b1"`` or ``"c1"``; empty for the tow as its file gives it
    change : relative, e.g. -0.1
    outcome : the result, or why there is none
    """

    coefficient: str
    change: float
    outcome: Result | NoEquilibrium


def at_speed(tow: Design, speed: float) -> Design:
    """Return the same tow at another speed [m/s], a fitted cable as long as at its own."""
    assert tow.file.tow is not None
    keys = tow.file.tow.model_copy(update={"speed": speed})
    return Design(replace(tow.file, tow=keys), lines=(tow.line,))


def sweep(tow: Design, speeds: Iterable[float]) -> list[Result | NoEquilibrium]:
    """Return the result at each speed of the ship [m/s], > 0, or the reason why there is none.

    Speeds are taken one at a time; the tow's own only decides the length of a cable that is fitted.
    NoEquilibrium: no length of that reaches its depth at the tow's own speed.
    """
    return [or_why_not(at_speed(tow, speed).solve) for speed in speeds]


def sensitivity(tow: Design) -> list[Variation]:
    """Return a tow as it is, then with A₁, B₁ and C₁ each smaller and greater by `CHANGE`.

    UsageError: the tow does not strum by Bourget & Marichal. NoEquilibrium: as in `sweep`.
    """
    keys = tow.file.solver.strumming
    if not isinstance(keys, BourgetMarichalKeys):
        raise UsageError(
            f"{tow.file.name} has no coefficients to change; they belong to "
            "`solver: {strumming: bourget-marichal}`"
        )
    variations = [Variation("", 0.0, or_why_not(tow.solve))]
    for name in _COEFFICIENTS:
        for change in (-CHANGE, CHANGE):
            changed = keys.model_copy(update={name: getattr(keys, name) * (1.0 + change)})
            solver = tow.file.solver.model_copy(update={"strumming": changed})
            other = Design(replace(tow.leg.cut(tow.file), solver=solver))
            variations.append(Variation(name, change, or_why_not(other.solve)))
    return variations
