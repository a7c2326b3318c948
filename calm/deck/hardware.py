"""Cutting list with tolerances, hardware list with spares, and shipping list."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, pi

from calm.case import Result
from calm.checks.arrangement import unlike_metals
from calm.checks.finding import grouped_by
from calm.checks.inventory import InventoryItem
from calm.deck.deck_items import DeckItem, Order
from calm.errors import NoEquilibrium
from calm.files import Cable, Chain, Component, Cylinder, Flexible, MooringFile, Piece, Sphere
from calm.files.components import FLEXIBLE_KINDS
from calm.files.mooring_file import leg_numbers
from calm.files.pieces import parts_of
from calm.solve import expect_many

LENGTH_ERROR = 0.005
"""Relative error of a cut length.

This is the default tolerance. The deck sheets also give the effect of this error on depth.
"""

ORDINARY = 20
"""Number of pieces in a typical line, for estimates of computing time."""

LEAST_TOLERANCE = 0.02
"""Smallest error with which a wire can be measured on deck [m]."""


@dataclass(frozen=True)
class Mark:
    """Mark on a cable, at the position of a clamp.

    `label` is the label of the clamp. `at` is the distance from the upper end of the cable under
    the load `Cut.load` [m].
    """

    label: str
    at: float


@dataclass(frozen=True)
class Cut:
    """Wire, rope or chain to be cut.

    Attributes
    ----------
    length, load : length to measure [m], and load under which the length is measured [N]
    unstretched : length without load [m]
    marks : marks for the clamps, from the top of the cable down
    tolerance : allowed error of the length [m]
    effect : increase in depth of the top if the piece is longer by the fraction `LENGTH_ERROR` [m];
        None without an equilibrium
    over : place of a wire or rope in the order of deployment, from 1; None for a chain
    onto : place of a wire or rope in the order of spooling onto the drum, from 1; None for a chain
    """

    item: DeckItem
    length: float
    load: float
    unstretched: float
    marks: tuple[Mark, ...]
    termination: str | None
    tolerance: float
    effect: float | None
    over: int | None
    onto: int | None

    @property
    def is_chain(self) -> bool:
        """Whether the piece is a chain, which is not spooled onto a drum."""
        return isinstance(self.item.part.component, Chain)

    @property
    def marks_text(self) -> str:
        """Marks as text: ``label@metres`` from the upper end, separated by `;`."""
        return ";".join(f"{mark.label.replace(';', ',')}@{mark.at:.3f}" for mark in self.marks)


def cuts_of(result: Result, parts: Sequence[DeckItem], order: Order) -> tuple[Cut, ...]:
    """List all pieces to cut and mark, down the line.

    Parameters
    ----------
    result : result in the environment of the sheets
    parts : every piece and clamp down the line
    order : deployment order
    """
    lengths = [one for one in parts if isinstance(one.part, Piece) and not one.is_rigid]
    spooled = [one for one in lengths if isinstance(one.part.component, Cable)]
    count = len(spooled)
    numbers = range(1, count + 1) if order is Order.ANCHOR_LAST else range(count, 0, -1)
    over = {one.index: number for one, number in zip(spooled, numbers, strict=True)}
    expect_many(len(lengths) * max(1.0, len(result.components) / ORDINARY))
    return tuple(_cut(result, one, over.get(one.index), count) for one in lengths)


def _cut(result: Result, one: DeckItem, over: int | None, count: int) -> Cut:
    piece = one.part
    assert isinstance(piece, Piece) and isinstance(piece.component, Flexible)
    assert one.cut_length is not None
    longer = 1.0 + piece.component.strain_under(piece.measured_load)
    length = one.cut_length * longer
    return Cut(
        item=one,
        length=length,
        load=piece.measured_load,
        unstretched=one.cut_length,
        marks=tuple(
            Mark(clamp.label, clamp.at * longer)
            for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at)
            if clamp.component.kind != "profiler"
        ),
        termination=piece.equipment.termination,
        tolerance=max(LENGTH_ERROR * length, LEAST_TOLERANCE),
        effect=_effect(result, piece.index, one.cut_length),
        over=over,
        onto=None if over is None else count + 1 - over,
    )


def _effect(result: Result, index: int, length: float) -> float | None:
    """Return the increase in depth of the top [m] if one piece is 0.5 % longer.

    The result is None if the longer line has no equilibrium.
    """
    number = leg_numbers(result.file)[index]
    longer = result.design.with_length(index, length * (1.0 + LENGTH_ERROR))
    try:
        leg = longer.solutions[number]
    except NoEquilibrium:
        return None
    upper = leg.position[-1 if leg.line.towed else 0]
    return -float(upper[2]) - result.legs[number].top.depth


SPARE_SHARE = 0.1
"""Ratio of spares to fitted items (CALM default)."""

_KINDS = {
    "cotter pins": r"cotter",
    "shackles": r"shackle",
    "swivels": r"swivel",
    "thimbles": r"thimble",
    "anodes": r"\banode|\bzinc\b",
    "isolators": r"isolat|insulat|bushing",
    "rings": r"\bring\b",
    "links": r"\blink\b|\bpear\b|\bsling\b|hammerlock",
}
"""Kinds of hardware, with a pattern for each.

The first pattern that occurs in the id, name or label of a component determines its kind.
"""
_OTHER, _CHAIN = "other connectors", "chains"
ORDER = ("shackles", "pins", "cotter pins", *(kind for kind in _KINDS if kind not in
         ("shackles", "cotter pins")), _CHAIN, _OTHER)  # fmt: skip
_SMALL = frozenset({"shackles", "pins", "cotter pins", "thimbles"})


@dataclass(frozen=True)
class Stock:
    """Row of the hardware list: number of equal connectors or accessories that a mooring needs.

    Attributes
    ----------
    kind : kind of hardware, which is one of the texts in `ORDER`
    use : id of the component; empty for an accessory without a component
    name : name of the component or accessory
    length : total length of chains [m]
    basis : method of counting accessories
    """

    kind: str
    use: str
    name: str
    count: int
    length: float | None = None
    basis: str = ""

    @property
    def spares(self) -> int:
        """Number of spares: `SPARE_SHARE` of `count`, rounded up.

        The minimum is two spares for a small item, and one for any other item.
        """
        return max(ceil(SPARE_SHARE * self.count), 2 if self.kind in _SMALL else 1)

    @property
    def total(self) -> int:
        """Number of items to bring, spares included."""
        return self.count + self.spares


def hardware_of(legs: Sequence[Sequence[DeckItem]]) -> tuple[Stock, ...]:
    """List the connectors and chains of a line or of legs, with their accessories.

    Accessories are the pins of shackles, the thimbles of cables, and isolators and anodes between
    dissimilar metals.
    """
    parts = [one for leg in legs for one in leg]
    groups: dict[tuple[str, str], list[DeckItem]] = {}
    for one in parts:
        kind = _kind(one)
        if kind is not None:
            groups.setdefault((kind, one.part.use), []).append(one)
    found = []
    for (kind, use), group in groups.items():
        length = sum(one.cut_length or 0.0 for one in group) if kind == _CHAIN else None
        found.append(Stock(kind, use, group[0].name, len(group), length))
    found += _pins(groups)
    found += _thimbles(parts)
    found += _against_corrosion(legs)
    return tuple(sorted(found, key=lambda stock: ORDER.index(stock.kind)))


def _kind(one: DeckItem) -> str | None:
    component = one.part.component
    if isinstance(component, Chain):
        return _CHAIN
    if isinstance(component, Cable):
        return None
    words = f"{one.part.use.replace('-', ' ')} {component.name or ''} {one.label}".lower()
    kind = next((kind for kind, word in _KINDS.items() if re.search(word, words)), None)
    if one.role == "connector":
        return kind or _OTHER
    return kind if kind in ("anodes", "isolators", "thimbles", "cotter pins") else None


def _pins(groups: dict[tuple[str, str], list[DeckItem]]) -> Iterator[Stock]:
    for (kind, use), group in groups.items():
        if kind != "shackles":
            continue
        component, count = group[0].part.component, len(group)
        bolted = "screw" not in f"{component.name or ''} {component.note or ''}".lower()
        pin = "bolt and nut" if bolted else "screw pin"
        name = f"{pin} of {group[0].name}"
        yield Stock("pins", use, name, count, basis="one for each shackle")
        if bolted:
            name = f"cotter pin of {group[0].name}"
            basis = "one for each shackle with bolt"
            yield Stock("cotter pins", use, name, count, basis=basis)


def _against_corrosion(legs: Sequence[Sequence[DeckItem]]) -> Iterator[Stock]:
    contacts = [
        (base, noble)
        for leg in legs
        for base, noble, _ in unlike_metals([o.part for o in leg if isinstance(o.part, Piece)])
    ]
    names = Counter(tuple(sorted((base.use, noble.use))) for base, noble in contacts)
    for (one, other), count in names.items():
        name = f"isolator between {one} and {other}"
        basis = "one for each contact of dissimilar metals"
        yield Stock("isolators", "", name, count, basis=basis)
    for use, count in Counter({base.label: base.use for base, _ in contacts}.values()).items():
        basis = "one for each piece in contact with a nobler metal"
        yield Stock("anodes", use, f"anode on {use}", count, basis=basis)


def _thimbles(parts: Sequence[DeckItem]) -> Iterator[Stock]:
    ends = Counter(
        (one.part.use, one.name)
        for one in parts
        if isinstance(one.part, Piece)
        and "thimble" in (one.part.equipment.termination or "").lower()
    )
    for (use, name), pieces in ends.items():
        basis = "two for each cable, according to its termination"
        yield Stock("thimbles", use, f"thimble for {name}", 2 * pieces, basis=basis)


@dataclass(frozen=True)
class ShippedComponent:
    """Total of one component, for shipping.

    Attributes
    ----------
    count : number of pieces and clamps with this component
    units : number of individual units; for example, a pair of releases has 2 units
    length : total length of cable or chain [m]
    mass, volume : totals of the known masses in air [kg] and volumes without packing [m³]
    missing_masses, missing_volumes : numbers of unknown masses and volumes, which the totals omit
    """

    use: str
    name: str
    count: int
    units: int
    length: float | None
    mass: float
    volume: float
    missing_masses: int
    missing_volumes: int

    @property
    def known_mass(self) -> float | None:
        """Total mass, which may be a lower bound [kg]; None if no mass is known."""
        return None if self.missing_masses == self.count else self.mass

    @property
    def known_volume(self) -> float | None:
        """Total volume, which may be a lower bound [m³]; None if no volume is known."""
        return None if self.missing_volumes == self.count else self.volume


def shipped_of(
    file: MooringFile, inventory: Sequence[InventoryItem]
) -> tuple[ShippedComponent, ...]:
    """Return the shipping list with one row per component, in line order."""
    components = {
        (piece.index, part.label): part.component
        for piece in file.pieces
        for part in parts_of([piece])
    }
    groups = grouped_by(inventory, lambda item: item.use)
    return tuple(_shipped_component(use, group, components) for use, group in groups.items())


def all_shipped(shipped: Sequence[ShippedComponent]) -> ShippedComponent:
    """Return the totals of the shipping list."""
    names = ("count", "units", "mass", "volume", "missing_masses", "missing_volumes")
    sums = {name: sum(getattr(one, name) for one in shipped) for name in names}
    return ShippedComponent(use="", name="Total", length=None, **sums)


def volume_of(component: Component, length: float | None) -> float | None:
    """Return the volume of a piece [m³], or None if unknown.

    The dimensions of spheres, cylinders and cables determine their volume. The volume of any other
    piece is its displaced volume.
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
        units=sum(one.items for one in group),
        length=sum(one for one in lengths if one is not None) if lengths else None,
        mass=sum(one for one in masses if one is not None),
        volume=sum(one for one in volumes if one is not None),
        missing_masses=masses.count(None),
        missing_volumes=volumes.count(None),
    )
