"""Whether the anchor holds: its weight, against uplift and against sliding."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from calm.checks.criterion import Citing, Criterion, criteria, pieces_of
from calm.checks.inventory import anchor_dry_mass
from calm.quantities import say

if TYPE_CHECKING:
    from calm.case import Mooring, Result

_WHAT_IS_IT = "Give its `weight` in water, or the `density` of its material."


@criteria("anchor-weight", of_anchor=True)
def anchor_weight(mooring: Mooring) -> Iterator[Criterion]:
    """Weight in water ≥ factor (V + H / friction): Dewey's rule for deadweights, factor 1.5."""
    weight = _weight(mooring)

    def words(required: float, result: Result) -> tuple[str, str]:
        needs = f"{say('tension', required)} are required, {_in_air(mooring, required)}."
        if weight is None:
            return f"The anchor's weight in water is not known; {needs}", _WHAT_IS_IT
        weighs = f"The anchor weighs {say('tension', weight)} in water; {needs}"
        return weighs, _heavier(mooring, required)

    yield Criterion(
        pieces_of(mooring)[-1],
        "required_weight",
        weight,
        words,
        source=Citing.of(mooring.file)("anchor_factor", "anchor_friction"),
        stated=lambda required, result: (result.anchor.weight, required),
    )


@criteria("anchor-uplift", of_anchor=True)
def anchor_uplift(mooring: Mooring) -> Iterator[Criterion]:
    """Upward pull V ≤ weight in water / factor."""
    weight, factor = _weight(mooring), mooring.file.checks.anchor_factor
    limit = None if weight is None else weight / factor

    def words(vertical: float, _: Result) -> tuple[str, str]:
        pulls = f"The line pulls up with {say('tension', vertical)}"
        if limit is None:
            return f"{pulls}; the anchor's weight in water is not known.", _WHAT_IS_IT
        return (
            f"{pulls}; the anchor's weight in water over {factor:g} is {say('tension', limit)}.",
            _heavier(mooring, factor * vertical),
        )

    source = Citing.of(mooring.file)("anchor_factor")
    yield Criterion(pieces_of(mooring)[-1], "vertical", limit, words, source=source)


@criteria("anchor-sliding", of_anchor=True)
def anchor_sliding(mooring: Mooring) -> Iterator[Criterion]:
    """Horizontal pull H ≤ friction (weight in water / factor - V)."""
    weight, checks, anchor = _weight(mooring), mooring.file.checks, mooring.file.anchor
    friction = checks.anchor_friction if anchor.friction is None else anchor.friction
    factor = checks.anchor_factor

    def held(result: Result) -> float:
        assert weight is not None
        return friction * (weight / factor - result.anchor.vertical)

    def words(_: float, result: Result) -> tuple[str, str]:
        pulls = f"The line pulls sideways with {say('tension', result.anchor.horizontal)}"
        if weight is None:
            return f"{pulls}; the anchor's weight in water is not known.", _WHAT_IS_IT
        return (
            f"{pulls}; friction of {friction:g} holds {say('tension', max(held(result), 0.0))}.",
            _heavier(mooring, result.anchor.required_weight),
        )

    yield Criterion(
        pieces_of(mooring)[-1],
        "slide",
        None if weight is None else friction * weight / factor,
        words,
        source=Citing.of(mooring.file)("anchor_factor", "anchor_friction"),
        stated=lambda _, result: (result.anchor.horizontal, held(result)),
    )


def _weight(mooring: Mooring) -> float | None:
    """Of the anchor in water [N]; None of a mass of a material that is not known."""
    return mooring.anchor_weight if mooring.file.anchor.material_known else None


def _heavier(mooring: Mooring, weight: float) -> str:
    return f"Take one of {say('tension', weight)} in water: {_in_air(mooring, weight)}."


def _in_air(mooring: Mooring, weight: float) -> str:
    """Return what weighs so much in water [N]."""
    water = mooring.water
    _, density = water.at(np.array(water.depth))
    steel, concrete = anchor_dry_mass(weight, float(density), water.gravity)
    return f"{steel:.0f} kg of steel or {concrete:.0f} kg of concrete in air"
