"""In which order a mooring goes over the side, and in which it comes up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby
from math import inf, isnan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from calm.checks.recovery import Recovery
    from calm.deck.hung import Hung


class Order(StrEnum):
    """Which end goes over the side last."""

    ANCHOR_LAST = "anchor-last"
    ANCHOR_FIRST = "anchor-first"


@dataclass(frozen=True)
class Surfacing:
    """A piece or clamp as it comes up.

    Attributes
    ----------
    hung : which
    time : after the release [s]; None of what does not come up by itself
    hangs_at : depth of its upper end when all is up that comes up [m]; None where not known
    by_itself : whether it is buoyant enough to come up without what is above it
    """

    hung: Hung
    time: float | None
    hangs_at: float | None
    by_itself: bool


def over_the_side(parts: Sequence[Hung], order: Order) -> tuple[Hung, ...]:
    """The pieces in the order in which they go over the side, each with its clamps after it.

    Anchor first, a piece goes with its lower end ahead, and so its lowest clamp comes first.
    """
    if order is Order.ANCHOR_LAST:
        return tuple(parts)
    groups = [[*group] for _, group in groupby(parts, key=lambda one: one.index)]
    return tuple(each for piece, *clamps in reversed(groups) for each in (piece, *reversed(clamps)))


def surfacing(parts: Sequence[Hung], recovery: Recovery | None) -> tuple[Surfacing, ...]:
    """What comes up, the first first; what hangs below, and what stays, comes after it in order.

    Without a solved rise there are no times, and the order is that of the line.
    """
    released = parts[-1].index - 1 if recovery is None else recovery.released
    rising = [one for one in parts if one.index <= released]
    if recovery is None:
        return tuple(Surfacing(one, None, None, False) for one in rising)
    found = [_surfacing(one, recovery) for one in rising]
    times = [inf if one.time is None else one.time for one in found]
    # stable: what comes up with a piece stays after it
    return tuple(found[i] for i in sorted(range(len(found)), key=times.__getitem__))


def _surfacing(one: Hung, recovery: Recovery) -> Surfacing:
    time = float(recovery.arrival[one.index])
    hangs_at = float(recovery.hangs_at[one.index])
    return Surfacing(
        one,
        None if isnan(time) else time,
        None if isnan(hangs_at) else hangs_at,
        one.index in recovery.order and one.on is None,
    )
