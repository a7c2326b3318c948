"""What hangs on the crane and on the winch at each stage of deployment and recovery."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.deck.order import Order
from calm.files.components import FLEXIBLE_KINDS

if TYPE_CHECKING:
    from calm.checks.inventory import InventoryItem


@dataclass(frozen=True)
class Lift:
    """A stage: a piece at the rail, with what is clamped on it, and all that is over the side.

    Attributes
    ----------
    index, label : of the piece
    mass : of the lift in air [kg]; None where a mass in it is not known, or that of a cable, which
        is not lifted but paid out
    weight : of the lift in water [N], + down; None where a length is not known
    hanging : weight in water of all that is over the side with it [N], + down: what a winch holds
        where all of it hangs from there; negative where it floats
    """

    index: int
    label: str
    mass: float | None
    weight: float | None
    hanging: float | None


@dataclass(frozen=True)
class Lifts:
    """The stages of a deployment and of a recovery.

    Attributes
    ----------
    deployment : in the order over the side
    recovery : from the top of the line down to the release
    unknown : labels of the pieces whose mass in air is not known: the heaviest lift may be one
    """

    deployment: tuple[Lift, ...]
    recovery: tuple[Lift, ...]
    unknown: tuple[str, ...]

    @property
    def heaviest(self) -> Lift | None:
        """The heaviest single lift in air, of those that are known."""
        known = [lift for lift in self.deployment if lift.mass is not None]
        return max(known, key=lambda lift: lift.mass or 0.0, default=None)


def lifts_of(inventory: Sequence[InventoryItem], released: int, order: Order) -> Lifts:
    """The stages of a mooring.

    Parameters
    ----------
    released : index of the lowest piece that comes up
    """
    pieces = [one for one in inventory if one.clamped_on is None]
    weights = _weights(inventory)
    down = pieces if order is Order.ANCHOR_LAST else pieces[::-1]
    up = [piece for piece in pieces if piece.index <= released]
    rising = tuple(_stages(up[::-1], weights))[::-1]
    unknown = tuple(one.label for one in pieces if _is_lifted(one) and one.lift_mass is None)
    return Lifts(tuple(_stages(down, weights)), rising, unknown)


def _weights(inventory: Sequence[InventoryItem]) -> dict[int, float | None]:
    """In water, of each piece with its clamps."""
    weights: dict[int, float | None] = {}
    for one in inventory:
        before, own = weights.get(one.index, 0.0), one.wet_weight
        weights[one.index] = None if before is None or own is None else before + own
    return weights


def _stages(pieces: Sequence[InventoryItem], weights: dict[int, float | None]) -> Iterator[Lift]:
    hanging: float | None = 0.0
    for one in pieces:
        weight = weights[one.index]
        hanging = None if hanging is None or weight is None else hanging + weight
        mass = one.lift_mass if _is_lifted(one) else None
        yield Lift(one.index, one.label, mass, weight, hanging)


def _is_lifted(one: InventoryItem) -> bool:
    return one.kind not in FLEXIBLE_KINDS
