"""Where the instruments and releases hang: in still water, now, and in the design currents."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.deck.hung import depth_of

if TYPE_CHECKING:
    from calm.case import Result
    from calm.case.columns import ClampRow, ComponentRow
    from calm.deck.hung import Hung
    from calm.files import Place


@dataclass(frozen=True)
class Extreme:
    """A depth [m] and the environment in which it is."""

    depth: float
    environment: str


@dataclass(frozen=True)
class Posted:
    """An instrument or a release.

    Attributes
    ----------
    hung : where it hangs in the environment of the sheets
    still : depth in still water [m]; None where that has no unique shape
    shallowest, deepest : over all environments
    greatest_tilt : over all environments [degrees]
    """

    hung: Hung
    still: float | None
    shallowest: Extreme
    deepest: Extreme
    greatest_tilt: float


def posted(parts: Sequence[Hung], results: Sequence[tuple[str, Result]]) -> tuple[Posted, ...]:
    """The instruments and releases, down the line.

    Parameters
    ----------
    results : of each environment by its name, that of the sheets first
    """
    rows = [(name, _rows(result)) for name, result in results]
    found = []
    for one in parts:
        if one.role not in ("instrument", "release"):
            continue
        there = [(name, places[one.part.place]) for name, places in rows]
        depths = [Extreme(depth_of(row), name) for name, row in there]
        knockdown = there[0][1].knockdown
        still = None if knockdown != knockdown else one.depth - knockdown
        found.append(
            Posted(
                one,
                still,
                min(depths, key=lambda each: each.depth),
                max(depths, key=lambda each: each.depth),
                max(row.tilt for _, row in there),
            )
        )
    return tuple(found)


def _rows(result: Result) -> dict[Place, ComponentRow | ClampRow]:
    every: list[ComponentRow | ClampRow] = [*result.components, *result.clamps]
    return {row.place: row for row in every}
