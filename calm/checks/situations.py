"""A mooring with something changed: still water, the tide, growth, strumming."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import isnan
from typing import Any

from calm.case import Mooring, Result
from calm.case.band import FACTOR
from calm.checks.assessment import Situation
from calm.checks.finding import AS_GIVEN
from calm.checks.posture import meant_for_the_surface
from calm.errors import NoEquilibrium
from calm.files import Cable, CurrentTable, Fouling, MooringFile, Piece, StrummingFactor
from calm.solve import Status

STILL, STILL_LOW = "still water", "still low water"
HIGH, LOW = "high water", "low water"
SOLVES = 6.0
"""Equilibria that are sought for one mooring in one environment, about."""

FOULED, STRUMMING = "fouling", "strumming"

_NO_CURRENT = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


def situations_of(mooring: Mooring) -> tuple[Situation, ...]:
    """The mooring solved as given, then in every situation that its file asks for.

    Still water, high and low water, and still low water where the environment has a `depth_range`,
    growth where it has `fouling`, and cables with Cn × 1.5 where no law of strumming is in use.
    Pieces that are cut to fit keep the length that fits as given. Still water in which a line to
    the surface is slack, since it is longer than the water is deep, has no unique shape and is
    left out.
    """
    given = solved(AS_GIVEN, mooring)
    if given.result is None:
        return (given,)
    surface = meant_for_the_surface(given.result)
    changed = [solved(name, each) for name, each in _changed(mooring, given.result)]
    return (given, *(each for each in changed if not (surface and _shapeless(each))))


def solved(name: str, mooring: Mooring) -> Situation:
    """The situation of that name, with the result or the failure of a mooring."""
    try:
        return Situation(name, mooring.solve(), None)
    except NoEquilibrium as failure:
        return Situation(name, None, failure)


def _changed(mooring: Mooring, given: Result) -> Iterator[tuple[str, Mooring]]:
    file, surface = cut_like(mooring.file, mooring), meant_for_the_surface(given)
    environment = file.environment

    def changed(depth: float | None = None, **what: Any) -> Mooring:
        there = replace(environment, depth=depth or environment.depth)
        return Mooring(replace(file, **({"environment": there} | what)), surface)

    if mooring.water.moving or environment.wind is not None:
        still = replace(environment, current=_NO_CURRENT, wind=None)
        yield STILL, changed(environment=still)
        if environment.depth_range is not None:
            yield STILL_LOW, changed(environment=replace(still, depth=environment.depth_range[0]))
    if environment.depth_range is not None:
        low, high = environment.depth_range
        yield HIGH, changed(high)
        yield LOW, changed(low)
    if environment.fouling is not None:
        yield FOULED, changed(pieces=_grown(file.pieces, given, environment.fouling))
    if file.solver.strumming is None and any(isinstance(p.component, Cable) for p in file.pieces):
        solver = file.solver.model_copy(update={"strumming": StrummingFactor(factor=FACTOR)})
        yield STRUMMING, changed(solver=solver)


def cut_like(file: MooringFile, mooring: Mooring) -> MooringFile:
    """A file with the piece that is cut to fit at the length that it has in a mooring.

    Raises
    ------
    NoEquilibrium
        No length fits there.
    """
    pieces = tuple(
        piece
        if piece.fit_top_depth is None
        else replace(piece, length=float(mooring.line.length[piece.index]), fit_top_depth=None)
        for piece in file.pieces
    )
    return replace(file, pieces=pieces)


def _shapeless(situation: Situation) -> bool:
    """Whether it is still water in which a slack line has no shape of its own."""
    failure = situation.failure
    still = situation.name in (STILL, STILL_LOW)
    return still and failure is not None and failure.status == Status.SLACK.label


def _grown(pieces: tuple[Piece, ...], given: Result, fouling: Fouling) -> tuple[Piece, ...]:
    """The pieces with growth on their cables down to the depth of it in still water.

    The growth thickens what the water drags at; as heavy as water, it weighs nothing in it. A
    cable that reaches deeper is parted there, both parts under its label.
    """
    grown: list[Piece] = []
    sunk = given.components.knockdown
    for row, piece in zip(given.components, pieces, strict=True):
        rise = 0.0 if isnan(sunk[0]) else row.knockdown
        top, bottom = row.depth_top - rise, row.depth_bottom - rise
        if not isinstance(piece.component, Cable) or top >= fouling.depth:
            grown.append(piece)
            continue
        assert piece.length is not None
        share = 1.0 if bottom <= fouling.depth else (fouling.depth - top) / (bottom - top)
        diameter = piece.component.diameter + 2.0 * fouling.thickness
        thick = piece.component.model_copy(update={"diameter": diameter})
        upper, lower = _parted(piece, share * piece.length)
        grown.append(replace(upper, component=thick))
        if lower is not None:
            grown.append(lower)
    return tuple(replace(piece, index=index) for index, piece in enumerate(grown))


def _parted(piece: Piece, at: float) -> tuple[Piece, Piece | None]:
    """A piece above and below a cut [m from its top], with their clamps; None for nothing below."""
    assert piece.length is not None
    if at >= piece.length:
        return piece, None
    above = tuple(clamp for clamp in piece.clamps if clamp.at <= at)
    below = tuple(replace(c, at=c.at - at) for c in piece.clamps if c.at > at)
    return (
        replace(piece, length=at, clamps=above),
        replace(piece, length=piece.length - at, clamps=below),
    )
