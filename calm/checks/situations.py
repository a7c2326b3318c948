"""A mooring with something changed: still water, the tide, growth, strumming, as deployed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from calm.case import Mooring, Result
from calm.case.strumming import FACTOR
from calm.checks.assessment import Situation
from calm.checks.deployed import as_deployed, cut_like, differs
from calm.checks.finding import AS_GIVEN
from calm.checks.growth import grown
from calm.checks.posture import meant_for_the_surface
from calm.errors import NoEquilibrium
from calm.files import Cable, CurrentTable, StrummingFactor
from calm.solve import Status

STILL, STILL_LOW = "still water", "still low water"
HIGH, LOW = "high water", "low water"
SOLVES = 6.0
"""About how many equilibria one mooring in one environment takes."""

FOULED, STRUMMING, DEPLOYED = "fouling", "strumming", "as deployed"

_NO_CURRENT = CurrentTable((0.0,), (0.0,), (0.0,), (0.0,))


def situations_of(mooring: Mooring) -> tuple[Situation, ...]:
    """The mooring solved as given, then in every situation that its file asks for.

    Still water, high and low water, and still low water where the environment has a `depth_range`,
    growth where it has `fouling`, cables with Cn × 1.5 where no law of strumming is in use, and the
    depth and lengths of `deployed` where they are others than those of the design.
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
        return Mooring(replace(file, **({"environment": there} | what)), surface, mooring.memory)

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
        yield FOULED, changed(pieces=grown(file.pieces, given, environment.fouling))
    if file.solver.strumming is None and any(isinstance(p.component, Cable) for p in file.pieces):
        solver = file.solver.model_copy(update={"strumming": StrummingFactor(factor=FACTOR)})
        yield STRUMMING, changed(solver=solver)
    if file.deployed is not None and differs(mooring, deployed := as_deployed(mooring)):
        yield DEPLOYED, Mooring(deployed.file, surface, mooring.memory)


def _shapeless(situation: Situation) -> bool:
    """Whether it is still water in which a slack line has no shape of its own."""
    failure = situation.failure
    still = situation.name in (STILL, STILL_LOW)
    return still and failure is not None and failure.status == Status.SLACK.label
