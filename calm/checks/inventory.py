"""Inventory of the pieces and clamped instruments on deck, with mass and weight."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from calm.assemble import mass_in_air, net_buoyancy
from calm.case.leg import Leg
from calm.errors import NoEquilibrium
from calm.files import Clamp, Component, Flexible, Piece
from calm.physics.materials import CONCRETE_DENSITY, STEEL_DENSITY


@dataclass(frozen=True)
class InventoryItem:
    """Piece of the line, or instrument clamped on a piece.

    A mass or weight is None if unknown.

    Attributes
    ----------
    index : index of the piece, or of the piece that carries the clamp
    use : component id
    clamped_on : label of the piece that carries the clamp; None for a piece
    at : distance of the clamp from the upper end of this piece [m]; None for a piece
    cut_length : length along the line [m]; None for a fitted cable that cannot reach its target
        depth
    dry_mass : mass in air [kg]
    wet_weight : weight in water of 1025 kg/m³, positive down [N]
    items : number of equal components, such as 2 for a pair of releases
    lift_mass : mass in air of a piece with its clamps [kg]; None for a clamp
    """

    index: int
    use: str
    label: str
    role: str
    kind: str
    name: str | None
    clamped_on: str | None
    cut_length: float | None
    dry_mass: float | None
    wet_weight: float | None
    lift_mass: float | None
    at: float | None = None
    items: int = 1


@dataclass(frozen=True)
class Total:
    """Total mass and weight of several items.

    Attributes
    ----------
    dry_mass, wet_weight : total mass in air [kg], and total weight in water, positive down [N]
    missing_masses, missing_weights : numbers of items with an unknown mass or weight, which the
        totals omit
    """

    dry_mass: float
    missing_masses: int
    wet_weight: float
    missing_weights: int


def total_of(items: Sequence[InventoryItem]) -> Total:
    """Sum the masses in air and weights in water of pieces and clamps."""
    masses, weights = [each.dry_mass for each in items], [each.wet_weight for each in items]
    mass, weight = (sum(one for one in each if one is not None) for each in (masses, weights))
    return Total(mass, masses.count(None), weight, weights.count(None))


def inventory_of(leg: Leg) -> tuple[InventoryItem, ...]:
    """List every piece from the top to the anchor, each followed by its clamps."""
    try:
        lengths: list[float | None] = [*leg.line.length.tolist()]
    except NoEquilibrium:
        lengths = [piece.length for piece in leg.file.pieces[:-1]]
    lengths.append(leg.file.anchor.length)
    gravity = leg.water.gravity
    return tuple(
        item
        for piece, length in zip(leg.file.pieces, lengths, strict=True)
        for item in _items(piece, length, gravity)
    )


def _items(piece: Piece, length: float | None, gravity: float) -> Iterator[InventoryItem]:
    parts: list[tuple[Piece | Clamp, float | None]] = [(piece, length)]
    parts += [(clamp, getattr(clamp.component, "length", 0.0)) for clamp in piece.clamps]
    found = [
        InventoryItem(
            index=piece.index,
            use=part.use,
            label=part.label,
            role=part.component.role,
            kind=part.component.kind,
            name=part.component.name,
            clamped_on=None if part is piece else piece.label,
            cut_length=along,
            dry_mass=_for_whole_piece(part.component, mass_in_air(part.component), along),
            wet_weight=_for_whole_piece(
                part.component, -net_buoyancy(part.component, gravity), along
            ),
            lift_mass=None,
            at=getattr(part, "at", None),
            items=part.component.items or 1,
        )
        for part, along in parts
    ]
    masses = [item.dry_mass for item in found if item.dry_mass is not None]
    yield replace(found[0], lift_mass=sum(masses) if len(masses) == len(found) else None)
    yield from found[1:]


def _for_whole_piece(
    component: Component, figure: float | None, length: float | None
) -> float | None:
    if figure is None or not isinstance(component, Flexible):
        return figure
    return None if length is None else figure * length


def anchor_dry_mass(required_weight: float, density: float, gravity: float) -> tuple[float, float]:
    """Return the masses in air of a steel and a concrete anchor of equal weight in water [kg].

    Parameters
    ----------
    required_weight : weight in water [N]
    density : density of the water [kg/m³]
    gravity : gravitational acceleration [m/s²]
    """
    steel, concrete = (
        required_weight / (gravity * (1.0 - density / material))
        for material in (STEEL_DENSITY, CONCRETE_DENSITY)
    )
    return steel, concrete
