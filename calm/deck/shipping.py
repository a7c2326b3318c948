"""What is shipped, and what hangs on crane and winch at each stage."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import pi

from calm.checks.inventory import InventoryItem
from calm.deck.deck_items import Order
from calm.files import Cable, Chain, Component, Cylinder, MooringFile, Sphere
from calm.files.components import FLEXIBLE_KINDS
from calm.files.mooring_file import parts_of


@dataclass(frozen=True)
class ShippedComponent:
    """All of one component.

    Attributes
    ----------
    use, name, count : of the component
    length : of cables and chains, in all [m]
    mass : in air, of those whose mass is known [kg]
    volume : of the things themselves, of those whose volume is known [m³]
    missing_masses, missing_volumes : of how many it is not known: the sum is a lower bound
    """

    use: str
    name: str
    count: int
    length: float | None
    mass: float
    volume: float
    missing_masses: int
    missing_volumes: int

    @property
    def known_mass(self) -> float | None:
        """The mass, or its lower bound; None where that of none is known."""
        return None if self.missing_masses == self.count else self.mass

    @property
    def known_volume(self) -> float | None:
        """The volume, or its lower bound; None where that of none is known."""
        return None if self.missing_volumes == self.count else self.volume


def shipped_of(
    file: MooringFile, inventory: Sequence[InventoryItem]
) -> tuple[ShippedComponent, ...]:
    """A row for each component, in the order of the line."""
    components = {
        (piece.index, part.label): part.component
        for piece in file.pieces
        for part in parts_of([piece])
    }
    groups: dict[str, list[InventoryItem]] = {}
    for item in inventory:
        groups.setdefault(item.use, []).append(item)
    return tuple(_shipped_component(use, group, components) for use, group in groups.items())


def total_of(shipped: Sequence[ShippedComponent]) -> ShippedComponent:
    """All of it."""
    return ShippedComponent(
        use="",
        name="Total",
        length=None,
        **{name: sum(getattr(one, name) for one in shipped) for name in _SUMMED},
    )


_SUMMED = ("count", "mass", "volume", "missing_masses", "missing_volumes")


def volume_of(component: Component, length: float | None) -> float | None:
    """Volume of a piece [m³]: of a sphere, cylinder, cable by its size; else what it displaces.

    None where it is not known.
    """
    if isinstance(component, Sphere):
        return pi * component.diameter**3 / 6.0
    if isinstance(component, Cylinder | Cable):
        along = component.length if isinstance(component, Cylinder) else length
        return None if along is None else pi * component.diameter**2 / 4.0 * along
    if isinstance(component, Chain):
        displaced = component.displaced_volume
        return None if displaced is None or length is None else displaced * length
    return component.displaced_volume


def _shipped_component(
    use: str, group: Sequence[InventoryItem], components: dict[tuple[int, str], Component]
) -> ShippedComponent:
    volumes = [volume_of(components[one.index, one.label], one.cut_length) for one in group]
    masses = [one.dry_mass for one in group]
    lengths = [one.cut_length for one in group if one.kind in FLEXIBLE_KINDS]
    return ShippedComponent(
        use=use,
        name=group[0].name or use,
        count=len(group),
        length=sum(one for one in lengths if one is not None) if lengths else None,
        mass=sum(one for one in masses if one is not None),
        volume=sum(one for one in volumes if one is not None),
        missing_masses=masses.count(None),
        missing_volumes=volumes.count(None),
    )


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


def lifts_of(
    inventory: Sequence[InventoryItem], legs: Sequence[int], rising: Collection[int], order: Order
) -> Lifts:
    """The stages of a mooring, leg by leg.

    Parameters
    ----------
    legs : number of the leg of each piece
    rising : indices of the pieces that come up
    """
    pieces = [one for one in inventory if one.clamped_on is None]
    weights = _weights(inventory)
    down: list[Lift] = []
    up: list[Lift] = []
    step = 1 if order is Order.ANCHOR_LAST else -1
    by_leg = [[*group] for _, group in groupby(pieces, key=lambda one: legs[one.index])]
    for leg in by_leg[::step]:
        down += _stages(leg[::step], weights)
    for leg in by_leg:
        up += [*_stages([one for one in leg if one.index in rising][::-1], weights)][::-1]
    unknown = tuple(one.label for one in pieces if _is_lifted(one) and one.lift_mass is None)
    return Lifts(tuple(down), tuple(up), unknown)


def _weights(inventory: Sequence[InventoryItem]) -> dict[int, float | None]:
    """Return the weight in water of each piece with its clamps [N]."""
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
