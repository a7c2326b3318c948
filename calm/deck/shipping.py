"""What is shipped: how many of each component, their masses and the volumes they displace."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from calm.files import Cable, Chain, Cylinder, Sphere
from calm.files.components import FLEXIBLE_KINDS

if TYPE_CHECKING:
    from calm.checks.inventory import InventoryItem
    from calm.files import Component, MooringFile


@dataclass(frozen=True)
class Freight:
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


def freight_of(file: MooringFile, inventory: Sequence[InventoryItem]) -> tuple[Freight, ...]:
    """A row for each component, in the order of the line."""
    components = _components(file)
    groups: dict[str, list[InventoryItem]] = {}
    for item in inventory:
        groups.setdefault(item.use, []).append(item)
    return tuple(_freight(use, group, components) for use, group in groups.items())


def total_of(freight: Sequence[Freight]) -> Freight:
    """All of it."""
    return Freight(
        use="",
        name="Total",
        count=sum(one.count for one in freight),
        length=None,
        mass=sum(one.mass for one in freight),
        volume=sum(one.volume for one in freight),
        missing_masses=sum(one.missing_masses for one in freight),
        missing_volumes=sum(one.missing_volumes for one in freight),
    )


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


def _components(file: MooringFile) -> dict[tuple[int, str], Component]:
    """By index of the piece and label."""
    found: dict[tuple[int, str], Component] = {}
    for piece in file.pieces:
        found[piece.index, piece.label] = piece.component
        found |= {(piece.index, clamp.label): clamp.component for clamp in piece.clamps}
    return found


def _freight(
    use: str, group: Sequence[InventoryItem], components: dict[tuple[int, str], Component]
) -> Freight:
    volumes = [volume_of(components[one.index, one.label], one.cut_length) for one in group]
    masses = [one.dry_mass for one in group]
    lengths = [one.cut_length for one in group if one.kind in FLEXIBLE_KINDS]
    return Freight(
        use=use,
        name=group[0].name or use,
        count=len(group),
        length=sum(one for one in lengths if one is not None) if lengths else None,
        mass=sum(one for one in masses if one is not None),
        volume=sum(one for one in volumes if one is not None),
        missing_masses=masses.count(None),
        missing_volumes=volumes.count(None),
    )
