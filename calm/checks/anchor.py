"""Whether the anchor holds: as a whole, against the lift, and against the slide."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from calm.checks.finding import Verdict, at_least, at_most, rule
from calm.checks.inventory import anchor_dry_mass
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Result


@rule("anchor-weight", of_anchor=True)
def anchor_weight(result: Result) -> Iterator[Verdict]:
    """Weight in water ≥ factor (V + H / friction): Dewey's rule for deadweights, factor 1.5."""
    load = result.anchor
    yield at_least(
        result.file.pieces[-1],
        load.weight,
        load.required_weight,
        f"The anchor weighs {say('tension', load.weight)} in water; "
        f"{say('tension', load.required_weight)} are required, "
        f"{_in_air(result, load.required_weight)}.",
        _heavier(result, load.required_weight),
    )


@rule("anchor-uplift", of_anchor=True)
def anchor_uplift(result: Result) -> Iterator[Verdict]:
    """Upward pull V ≤ weight in water / factor."""
    load, factor = result.anchor, result.file.checks.anchor_factor
    limit = load.weight / factor
    yield at_most(
        result.file.pieces[-1],
        load.vertical,
        limit,
        f"The line pulls up with {say('tension', load.vertical)}; the anchor's weight in water "
        f"over {factor:g} is {say('tension', limit)}.",
        _heavier(result, factor * load.vertical),
    )


@rule("anchor-sliding", of_anchor=True)
def anchor_sliding(result: Result) -> Iterator[Verdict]:
    """Horizontal pull H ≤ friction (weight in water / factor - V)."""
    load, factor = result.anchor, result.file.checks.anchor_factor
    friction = load.friction
    limit = friction * (load.weight / factor - load.vertical)
    yield at_most(
        result.file.pieces[-1],
        load.horizontal,
        limit,
        f"The line pulls sideways with {say('tension', load.horizontal)}; friction of "
        f"{friction:g} holds {say('tension', max(limit, 0.0))}.",
        _heavier(result, load.required_weight),
    )


def _heavier(result: Result, weight: float) -> str:
    return f"Take one of {say('tension', weight)} in water: {_in_air(result, weight)}."


def _in_air(result: Result, weight: float) -> str:
    """What weighs so much in water [N]."""
    water = result.mooring.water
    _, density = water.at(np.array(water.depth))
    steel, concrete = anchor_dry_mass(weight, float(density), water.gravity)
    return f"{steel:.0f} kg of steel or {concrete:.0f} kg of concrete in air"
