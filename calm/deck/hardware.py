"""Lists of what is cut, and how exactly; of what joins the pieces, with spares; and of freight."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, pi

from calm.case import Result
from calm.checks.arrangement import unlike_metals
from calm.checks.inventory import InventoryItem
from calm.deck.deck_items import DeckItem, Order
from calm.errors import NoEquilibrium
from calm.files import Cable, Chain, Component, Cylinder, Flexible, MooringFile, Piece, Sphere
from calm.files.components import FLEXIBLE_KINDS
from calm.files.mooring_file import leg_numbers
from calm.files.pieces import parts_of
from calm.solve import expect_many

LENGTH_ERROR = 0.005
"""Error of a length, as a share of it: the tolerance, and the error whose effect is reported."""

ORDINARY = 20
"""Pieces of a line whose solution takes as long as that of an ordinary one."""

LEAST_TOLERANCE = 0.02
"""Least error with which a wire is measured on a deck [m]."""


@dataclass(frozen=True)
class Mark:
    """Tell where a clamp goes: metres from the upper end, measured as the cable is."""

    label: str
    at: float


@dataclass(frozen=True)
class Cut:
    """A wire, a rope, or a chain that bears clamps.

    Attributes
    ----------
    item : which
    length, load : as it is measured: the length [m] under that load [N]
    unstretched : its length without load [m]
    marks : of the clamps, down the cable, measured under the same load
    termination : as the file says; None where it does not
    tolerance : of its length [m]
    effect : how much deeper the top of its line or leg is where this is longer by `LENGTH_ERROR`
        [m]; None where such a line does not stand
    over, onto : its number over the side, and onto the drum, which is the other way round
    """

    item: DeckItem
    length: float
    load: float
    unstretched: float
    marks: tuple[Mark, ...]
    termination: str | None
    tolerance: float
    effect: float | None
    over: int
    onto: int

    @property
    def marks_text(self) -> str:
        """The marks as ``label@metres`` from the upper end, `;` between them."""
        return ";".join(f"{mark.label.replace(';', ',')}@{mark.at:.3f}" for mark in self.marks)


def cuts_of(result: Result, parts: Sequence[DeckItem], order: Order) -> tuple[Cut, ...]:
    """Return all that is cut and marked, down the line.

    Parameters
    ----------
    result : in the environment of the sheets
    parts : every piece and clamp, down the line
    order : in which the line goes over the side
    """
    cables = [
        one
        for one in parts
        if isinstance(one.part, Piece)
        and (
            isinstance(one.part.component, Cable)
            or (isinstance(one.part.component, Chain) and one.part.clamps)
        )
    ]
    count = len(cables)
    expect_many(count * max(1.0, len(result.components) / ORDINARY))
    return tuple(
        _cut(result, one, number if order is Order.ANCHOR_LAST else count + 1 - number, count)
        for number, one in enumerate(cables, 1)
    )


def _cut(result: Result, one: DeckItem, over: int, count: int) -> Cut:
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
        onto=count + 1 - over,
    )


def _effect(result: Result, index: int, length: float) -> float | None:
    """Return how much deeper the top is, in the same water, where a piece is cut too long [m]."""
    number = leg_numbers(result.file)[index]
    longer = result.design.with_length(index, length * (1.0 + LENGTH_ERROR))
    try:
        leg = longer.solutions[number]
    except NoEquilibrium:
        return None
    upper = leg.position[-1 if leg.line.towed else 0]
    return -float(upper[2]) - result.legs[number].top.depth


SPARE_SHARE = 0.1
"""Of what is in the line, at least one, of small parts two: a default of this program."""

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
"""Kinds of hardware by words of id, name and label, the first that is there."""
_OTHER, _CHAIN = "other connectors", "chains"
ORDER = ("shackles", "pins", "cotter pins", *(kind for kind in _KINDS if kind not in
         ("shackles", "cotter pins")), _CHAIN, _OTHER)  # fmt: skip
_SMALL = frozenset({"shackles", "pins", "cotter pins", "thimbles"})


@dataclass(frozen=True)
class Stock:
    """Count one kind of thing that is brought along.

    Attributes
    ----------
    kind : of `ORDER`
    use, name : id and name of the component; of what belongs to others only the name
    count : in the line
    length : of chains, in all [m]
    basis : what the count follows from, where it is not a piece of the line
    """

    kind: str
    use: str
    name: str
    count: int
    length: float | None = None
    basis: str = ""

    @property
    def spares(self) -> int:
        """A tenth, rounded up, and of what is small and easily lost at least two."""
        return max(ceil(SPARE_SHARE * self.count), 2 if self.kind in _SMALL else 1)

    @property
    def total(self) -> int:
        """To be brought."""
        return self.count + self.spares


def hardware_of(legs: Sequence[Sequence[DeckItem]]) -> tuple[Stock, ...]:
    """The connectors of a line or of legs, the chains, and what belongs to them.

    A shackle has a bolt with nut and cotter pin, unless its definition says that its pin is screwed
    in. A termination that names a thimble has one at each end. Where metals that corrode each other
    touch, an isolator is between them and an anode at the baser one.
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
    """Yield isolators and anodes for the contacts of which `calm check` warns."""
    contacts = [
        (base, noble)
        for leg in legs
        for base, noble, _ in unlike_metals([o.part for o in leg if isinstance(o.part, Piece)])
    ]
    names = Counter(tuple(sorted((base.use, noble.use))) for base, noble in contacts)
    for (one, other), count in names.items():
        name, basis = f"isolator between {one} and {other}", "one for each contact of unlike metals"
        yield Stock("isolators", "", name, count, basis=basis)
    for use, count in Counter({base.label: base.use for base, _ in contacts}.values()).items():
        basis = "one for each piece of the baser metal"
        yield Stock("anodes", use, f"anode on {use}", count, basis=basis)


def _thimbles(parts: Sequence[DeckItem]) -> Iterator[Stock]:
    ends = Counter(
        (one.part.use, one.name)
        for one in parts
        if isinstance(one.part, Piece)
        and "thimble" in (one.part.equipment.termination or "").lower()
    )
    for (use, name), pieces in ends.items():
        basis = "two for each cable, by its termination"
        yield Stock("thimbles", use, f"thimble for {name}", 2 * pieces, basis=basis)


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


def all_shipped(shipped: Sequence[ShippedComponent]) -> ShippedComponent:
    """The total of what is shipped."""
    names = ("count", "mass", "volume", "missing_masses", "missing_volumes")
    sums = {name: sum(getattr(one, name) for one in shipped) for name in names}
    return ShippedComponent(use="", name="Total", length=None, **sums)


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
