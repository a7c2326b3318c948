"""Whether every piece bears its load, and how the strength goes along the line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from calm.case.warnings import is_synthetic
from calm.checks.finding import State, Verdict, at_least, at_most, rule, unknown
from calm.checks.posture import meant_for_the_surface
from calm.files import Cable, Component, Piece
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Result
    from calm.files import SafetyFactors

WEAK_LINK = 0.5
"""Share of the strength of the cables on both its sides below which a piece is a weak link."""


def allowable_load(component: Component, factors: SafetyFactors, surface: bool) -> float | None:
    """Load that a component may bear in use [N], None where neither of its loads is known.

    The lesser of its working load and of its breaking load over the safety factor of a surface
    mooring, of a synthetic rope, or of steel, as far as they are known.
    """
    return lesser_load(component, 1.0, safety_factor(component, factors, surface))


def lesser_load(component: Component, working_factor: float, factor: float) -> float | None:
    """The lesser of working load × `working_factor` and breaking load / `factor` [N]."""
    known = []
    if component.working_load is not None:
        known.append(working_factor * component.working_load)
    if component.breaking_load is not None:
        known.append(component.breaking_load / factor)
    return min(known, default=None)


def safety_factor(component: Component, factors: SafetyFactors, surface: bool) -> float:
    """The safety factor asked on the breaking load of a component."""
    if surface:
        return factors.surface
    return factors.synthetic if is_synthetic(component) else factors.steel


@rule("strength")
def strength(result: Result) -> Iterator[Verdict]:
    """The greatest tension in every piece against working load, and breaking load / factor.

    UFC 4-159-03 table 3-7 asks for 3 on new breaking strength of chain and wire; oceanographic
    practice for 3 to 5, synthetics and surface moorings at the upper end.
    """
    factors, surface = result.file.checks.safety_factor, meant_for_the_surface(result)
    for row, piece in zip(result.components, result.file.pieces, strict=True):
        component = piece.component
        limit = allowable_load(component, factors, surface)
        bears = f"{row.label} bears {say('tension', row.tension)}"
        if limit is None:
            yield unknown(
                row,
                f"{bears}; neither its working nor its breaking load is known.",
                "Give its `working_load` or `breaking_load`.",
                row.tension,
            )
            continue
        factor = safety_factor(component, factors, surface)
        if limit == component.working_load:
            allowed = f"its working load is {say('tension', limit)}"
        else:
            allowed = (
                f"its breaking load of {say('tension', component.breaking_load)} "
                f"over {factor:g} allows {say('tension', limit)}"
            )
        remedy = (
            f"Take one with a working load of {say('tension', row.tension)} and a breaking load "
            f"of {say('tension', factor * row.tension)} or more."
        )
        yield at_most(row, row.tension, limit, f"{bears}; {allowed}.", remedy)


@rule("strength-steps")
def strength_steps(result: Result) -> Iterator[Verdict]:
    """Every weak link: a piece that bears less than half of what the cables on both its sides do.

    A line whose strength jumps carries weight for nothing, and parts at its weak link. Where there
    is none, the piece that comes nearest to one is told. Chain is left out of the comparison: it is
    heavier than its load asks for, against wear.
    """
    factors, surface = result.file.checks.safety_factor, meant_for_the_surface(result)
    loads = [allowable_load(piece.component, factors, surface) for piece in result.file.pieces[:-1]]
    steps = sorted(_steps(result, loads), key=lambda step: (step[0], step[1].label))
    weak = [step for step in steps if step[0] < WEAK_LINK]
    for _, piece, load, cables in weak or steps[:1]:
        yield at_least(
            piece,
            load,
            WEAK_LINK * cables,
            f"{piece.label} may bear {say('tension', load)}, the cables above and below it "
            f"{say('tension', cables)} and more.",
            "Match its strength to that of the cables beside it, or theirs to its own.",
            State.WARN,
        )


def _steps(
    result: Result, loads: Sequence[float | None]
) -> Iterator[tuple[float, Piece, float, float]]:
    """Of all between two cables: share of their strength, the piece, own load and theirs [N]."""
    cables = [
        load if isinstance(piece.component, Cable) else None
        for piece, load in zip(result.file.pieces, loads, strict=False)
    ]
    for index, load in enumerate(loads):
        above = next((one for one in reversed(cables[:index]) if one is not None), None)
        below = next((one for one in cables[index + 1 :] if one is not None), None)
        if load is not None and above is not None and below is not None:
            beside = min(above, below)
            yield load / beside, result.file.pieces[index], load, beside
