"""Inventory of the deck: every piece and every clamped instrument, with its mass and weight."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from calm.assemble import mass_in_air, net_buoyancy
from calm.case.leg import Leg
from calm.errors import NoEquilibrium
from calm.files import Clamp, Component, Flexible, Piece
from calm.physics.materials import CONCRETE_DENSITY, STEEL_DENSITY


@dataclass(frozen=True)
class InventoryItem:
    """A piece of the line or an instrument clamped on one.

    Attributes
    ----------
    index : of the piece, of a clamp that of the piece it is on
    use, label, role, kind : as in the file
    name : of the component, None where it gives none
    clamped_on, at : label of the piece that a clamp is on, and how far from its top [m]; None of a
        piece
    cut_length : along the line [m]; None of a cable that no length fits
    dry_mass : in air [kg]; None where it is not known and does not follow
    wet_weight : in water of 1025 kg/m³ under the gravity of the file [N], + down; None where the
        length is not known
    lift_mass : of a piece with its clamps [kg]; None of a clamp, and where a mass is not known
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


@dataclass(frozen=True)
class Total:
    """Hold what all items come to, of those whose figures are known.

    Attributes
    ----------
    dry_mass, missing_masses : in air [kg], and of how many items it is not known: of others than
        none the total is a lower bound
    wet_weight, missing_weights : the same of the weight in water [N], + down
    """

    dry_mass: float
    missing_masses: int
    wet_weight: float
    missing_weights: int


def total_of(items: Sequence[InventoryItem]) -> Total:
    """The sums over pieces and clamps."""
    masses, weights = [each.dry_mass for each in items], [each.wet_weight for each in items]
    mass, weight = (sum(one for one in each if one is not None) for each in (masses, weights))
    return Total(mass, masses.count(None), weight, weights.count(None))


def inventory_of(leg: Leg) -> tuple[InventoryItem, ...]:
    """Every piece from the top to the anchor, each with its clamps after it."""
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
            dry_mass=_in_all(part.component, mass_in_air(part.component), along),
            wet_weight=_in_all(part.component, -net_buoyancy(part.component, gravity), along),
            lift_mass=None,
            at=getattr(part, "at", None),
        )
        for part, along in parts
    ]
    masses = [item.dry_mass for item in found if item.dry_mass is not None]
    yield replace(found[0], lift_mass=sum(masses) if len(masses) == len(found) else None)
    yield from found[1:]


def _in_all(component: Component, figure: float | None, length: float | None) -> float | None:
    """A figure of a piece; of a cable or chain, which has it for each metre, times its length."""
    if figure is None or not isinstance(component, Flexible):
        return figure
    return None if length is None else figure * length


def anchor_dry_mass(required_weight: float, density: float, gravity: float) -> tuple[float, float]:
    """Mass in air of an anchor of a weight in water: of steel, and of concrete [kg].

    Parameters
    ----------
    required_weight : in water [N]
    density : of the water [kg/m³]
    gravity : [m/s²]
    """
    steel, concrete = (
        required_weight / (gravity * (1.0 - density / material))
        for material in (STEEL_DENSITY, CONCRETE_DENSITY)
    )
    return steel, concrete
