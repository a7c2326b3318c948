"""One tow solved many times: at several speeds, or with a coefficient of its strumming changed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from calm.case.tow import Tow, TowResult
from calm.errors import NoEquilibrium, UsageError
from calm.files.strumming import BourgetMarichalKeys

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
    outcome: TowResult | NoEquilibrium


def sweep(tow: Tow, speeds: Iterable[float]) -> list[TowResult | NoEquilibrium]:
    """Solve a tow at several speeds [m/s], one after the other.

    Parameters
    ----------
    tow : Tow
        Its own speed only decides the length of a cable that is fitted.
    speeds : iterable of float
        Of the ship [m/s], > 0; taken one at a time.

    Returns
    -------
    list of TowResult or NoEquilibrium
        One for each speed, in order: the result, or the reason why there is none.

    Raises
    ------
    NoEquilibrium
        Where no length of a cable to be fitted reaches its depth at the tow's own speed.
    """
    return [_attempt(tow.at_speed(speed)) for speed in speeds]


def sensitivity(tow: Tow) -> list[Variation]:
    """How a tow answers to A₁, B₁ and C₁ of its strumming, each smaller and greater by `CHANGE`.

    Returns
    -------
    list of Variation
        The tow as it is, then two for each coefficient.

    Raises
    ------
    UsageError
        The tow does not strum by Bourget & Marichal.
    NoEquilibrium
        As in `sweep`.
    """
    keys = tow.file.solver.strumming
    if not isinstance(keys, BourgetMarichalKeys):
        raise UsageError(
            f"{tow.file.name} has no coefficients to change; they belong to "
            "`solver: {strumming: bourget-marichal}`"
        )
    variations = [Variation("", 0.0, _attempt(tow))]
    for name in _COEFFICIENTS:
        for change in (-CHANGE, CHANGE):
            changed = keys.model_copy(update={name: getattr(keys, name) * (1.0 + change)})
            variations.append(Variation(name, change, _attempt(_with_strumming(tow, changed))))
    return variations


def _attempt(tow: Tow) -> TowResult | NoEquilibrium:
    try:
        return tow.solve()
    except NoEquilibrium as failure:
        return failure


def _with_strumming(tow: Tow, keys: BourgetMarichalKeys) -> Tow:
    """The same tow, a fitted cable as long as it is, with other coefficients."""
    pieces = tuple(
        replace(piece, length=float(tow.line.length[piece.index]), fit_body_depth=None)
        if piece.fit_body_depth is not None
        else piece
        for piece in tow.file.pieces
    )
    solver = tow.file.solver.model_copy(update={"strumming": keys})
    return Tow(replace(tow.file, pieces=pieces, solver=solver))
