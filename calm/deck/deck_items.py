"""Pieces and clamps of a mooring as deck items: position, depth and handling order."""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import groupby

from calm.case.design import AnyResult, Result
from calm.case.result_tables import ClampRow, ComponentRow, rows_by_place, rows_down
from calm.checks.finding import Finding, State, governing_of_each_rule
from calm.files import Clamp, Flexible, Piece
from calm.files.logbook import DeployedItem
from calm.files.mooring_file import leg_numbers
from calm.files.pieces import holds_instrument
from calm.quantities import QUANTITIES

_SIZED = re.compile(r"(shackle|ring|swivel|link)(?:-[a-z]+)?-(\d+)\b.*")
_SIZE = re.compile(r"\d[\d/.-]* (?:mm|in)\b")


@dataclass(frozen=True)
class DeckItem:
    """Piece, or instrument clamped on a piece.

    Attributes
    ----------
    index : index of the piece, or of the piece that carries the clamp
    on : label of the piece that carries the clamp; None for a piece
    at : unstretched distance of a clamp from the upper end of its piece [m]
    of_length : unstretched length of the piece that carries the clamp [m]
    cut_length, stretched : unstretched and stretched length of a piece [m]
    depth, height : depth, and height above the seabed, of a clamp or of the upper end of a piece
        [m]
    tilt : tilt from the vertical [degrees]
    tension : maximum tension in a piece [N]
    serial : serial numbers in the design, separated by commas
    deployed_serial : serial numbers in `deployed`; by default, the serial numbers in the design
    remark : remark in `deployed`
    apart : whether connecting hardware is drawn in a separate row because of the design check
    """

    part: Piece | Clamp
    index: int
    on: str | None
    at: float | None
    of_length: float | None
    cut_length: float | None
    stretched: float | None
    depth: float
    height: float
    tilt: float
    tension: float | None
    serial: str | None
    deployed_serial: str | None
    remark: str | None
    apart: bool = False

    @property
    def label(self) -> str:
        """Label of the part."""
        return self.part.label

    @property
    def name(self) -> str:
        """Name of the component, or its id if it has no name."""
        return self.part.component.name or self.part.use

    @property
    def serials(self) -> tuple[str, ...]:
        """Serial numbers in the design, as a tuple."""
        return self.part.serials

    @property
    def planned_depth(self) -> float | None:
        """Planned depth in still water [m], or None if no depth is planned."""
        return self.part.planned_depth

    @property
    def hardware(self) -> str:
        """Short name of a connector, such as `13 mm shackle`.

        The size is copied from the full name if the full name begins with a size. Otherwise, the
        size in the component id is used, in mm.
        """
        sized = _SIZED.fullmatch(self.part.use)
        if sized is None:
            return self.name
        named = _SIZE.match(self.name)
        return f"{named[0] if named else f'{sized[2]} mm'} {sized[1]}"

    @property
    def is_rigid(self) -> bool:
        """Whether the part is neither cable nor chain."""
        return not isinstance(self.part.component, Flexible)

    @property
    def role(self) -> str:
        """Role of the component."""
        return self.part.component.role

    @property
    def holds_instrument(self) -> bool:
        """Whether the item is an instrument, a release, or a float or frame that holds an
        instrument.
        """
        return holds_instrument(self.part)

    @property
    def is_joint(self) -> bool:
        """Whether the item is a connector without data of its own, such as a serial number or a
        remark.
        """
        return self.is_connector and not self._has_own_data and not self.holds_instrument

    @property
    def is_connector(self) -> bool:
        """Whether the item is connecting hardware in the line, but not a cable, chain or clamp."""
        return self.role == "connector" and self.on is None and self.is_rigid

    @property
    def is_swivel(self) -> bool:
        """Whether the item is a swivel, which drawings always show."""
        return "swivel" in f"{self.part.use} {self.name} {self.label}".lower()

    @property
    def _has_own_data(self) -> bool:
        return any((self.serial, self.deployed_serial, self.remark))

    @property
    def places(self) -> tuple[float, ...]:
        """Distance of a clamp from the upper end of its piece [m].

        A profiler has two distances, one for each stop.
        """
        travel = getattr(self.part, "travel", None)
        ends = (self.at,) if travel is None else (min(end, self.of_length or end) for end in travel)
        return tuple(end for end in ends if end is not None)

    @property
    def kind(self) -> tuple[object, ...]:
        """Key for grouping: consecutive items with the same key share a row.

        Cables, chains, anchors, releases, holders of instruments, and items with a serial number or
        remark have separate rows.
        """
        alone = not self.is_rigid or self.holds_instrument or self.role == "anchor"
        return (self.label,) if alone or self._has_own_data else (self.name, self.on)


@dataclass(frozen=True)
class DeckRow:
    """Items that share a printed row, such as glass floats on chain.

    Attributes
    ----------
    items : consecutive equal pieces or clamps
    floats : equal floats clamped on the cable or chain in `items`
    between : connecting hardware between the items
    after : connecting hardware below the last item
    """

    items: tuple[DeckItem, ...]
    floats: tuple[DeckItem, ...] = ()
    between: tuple[DeckItem, ...] = ()
    after: tuple[DeckItem, ...] = ()

    @property
    def joints(self) -> tuple[DeckItem, ...]:
        """All connecting hardware of the row."""
        return (*self.between, *self.after)

    @property
    def ends(self) -> bool:
        """Whether a swivel follows the items, so that the next item begins a new row."""
        return any(one.is_swivel for one in self.after)

    @property
    def is_followed_by_clamps(self) -> bool:
        """Whether the next rows show the clamps on the piece in this row."""
        return bool(getattr(self.first.part, "clamps", ())) and not self.floats

    @property
    def first(self) -> DeckItem:
        """First item of the row."""
        return self.items[0]

    @property
    def label(self) -> str:
        """Label of the item, or the labels of the first and the last item."""
        return label_of_run(self.items)

    @property
    def name(self) -> str:
        """Names of the items with their counts.

        For a chain with floats, this is the name and the number of the floats.
        """
        floats = f"{len(self.floats)} × " if len(self.floats) > 1 else ""
        return floats + self.floats[0].name if self.floats else name_of_run(self.items)

    @property
    def cluster(self) -> tuple[object, ...]:
        """Key that is equal for similar chains with equal floats.

        Consecutive rows with the same key are joined into one row. The key is empty for a row that
        must not be joined.
        """
        if not self.floats or any(one._has_own_data for one in (*self.items, *self.floats)):
            return ()
        first, floats = self.first, [(one.name, one.places) for one in self.floats]
        stem = first.label.rstrip("0123456789")
        return stem, first.name, round(first.cut_length or 0.0, 3), tuple(floats)

    @property
    def lengths(self) -> str:
        """Cut length of a cable or chain, preceded by the number of pieces of this length."""
        many = f"{len(self.items)} × " if len(self.items) > 1 else ""
        return many + QUANTITIES["length"].format(self.first.cut_length)


def hardware_text(joints: Iterable[DeckItem]) -> str:
    """Describe connecting hardware, such as `2 × 13 mm shackle`. The text is empty without
    hardware.
    """
    counts = Counter(one.hardware for one in joints)
    return ", ".join(f"{n} × {name}" if n > 1 else name for name, n in counts.items())


def printed_rows(items: Sequence[DeckItem], *, drawn: bool = False) -> tuple[DeckRow, ...]:
    """Group consecutive items into printed rows, in line order.

    In a list, the row of a piece contains the connecting hardware below the piece. In a drawing
    (`drawn`), the hardware is in the row of the last clamp on the piece instead. Hardware marked as
    `apart` has a separate row in a drawing.
    """

    def is_joint(one: DeckItem) -> bool:
        return one.is_joint and not (drawn and one.apart)

    rows: list[DeckRow] = []
    for _, group in groupby(items, key=lambda one: is_joint(one) or one.kind):
        run = tuple(group)
        last = rows[-1] if rows else None
        if last is None:
            rows.append(DeckRow(run))
        elif is_joint(run[0]):
            at = len(rows) - 1
            while not drawn and at > 0 and rows[at].first.on is not None:
                at -= 1
            rows[at] = replace(rows[at], after=(*rows[at].after, *run))
        elif last.first.kind == run[0].kind and not last.ends:
            rows[-1] = DeckRow((*last.items, *run), last.floats, last.joints)
        elif _lies_on(run, last, items):
            rows[-1] = replace(last, floats=run)
        else:
            rows.append(DeckRow(run))
    return tuple(_joined_clusters(rows))


def _joined_clusters(rows: Sequence[DeckRow]) -> Iterator[DeckRow]:
    joined: list[DeckRow] = []
    key: tuple[object, ...] = ()
    for row in rows:
        if row.cluster and row.cluster == key and not joined[-1].ends:
            last = joined.pop()
            items, floats = (*last.items, *row.items), (*last.floats, *row.floats)
            row = DeckRow(items, floats, (*last.joints, *row.between), row.after)
        else:
            key = row.cluster
        joined.append(row)
    yield from joined


def _lies_on(run: tuple[DeckItem, ...], row: DeckRow, items: Sequence[DeckItem]) -> bool:
    """Return whether the clamps in `run` may share the row of the piece that carries them.

    The clamps must be equal floats, and must be all clamps on the last piece of `row`.
    """
    first = run[0]
    if first.role != "float" or first.on is None or first.kind == (first.label,):
        return False
    every = [one for one in items if one.on == first.on and one.index == first.index]
    return row.items[-1].label == first.on and len(every) == len(run)


def label_of_run(items: Sequence[DeckItem]) -> str:
    """Format the label of an item, or the labels of the first and the last item."""
    return items[0].label if len(items) == 1 else f"{items[0].label} – {items[-1].label}"


def name_of_run(items: Sequence[DeckItem]) -> str:
    """Format the name of a single item, or the names of several items with their counts."""
    counts = Counter(item.name for item in items)
    if len(items) == 1:
        return items[0].name
    return ", ".join(f"{count} × {name}" for name, count in counts.items())


def standing_out(findings: Iterable[Finding]) -> frozenset[str]:
    """Return the labels of the parts that a drawing shows in a separate row.

    Each of these parts has an open finding in the design check, or has the highest utilisation of a
    rule. In the second case, the utilisation is above `SHOWN_USE`.
    """
    every = [*findings]
    found = {one.component for one in governing_of_each_rule(every)
             if (one.utilisation or 0.0) > SHOWN_USE}  # fmt: skip
    for one in every:
        if one.state not in (State.PASS, State.NOT_JUDGED):
            found.update([one.component] if one.missing is None else one.missing.pieces)
    return frozenset(label for label in found if label is not None)


SHOWN_USE = 0.4999
"""Utilisation above which a part is drawn in a separate row.

Only the part with the highest utilisation of a rule is compared with this value.
"""


def deck_items_of(result: AnyResult, apart: Collection[str] = ()) -> tuple[DeckItem, ...]:
    """List the items from the top to the anchor, leg by leg, with the clamps after their piece.

    Connecting hardware whose label is in `apart` is drawn in a separate row.
    """
    deployed = result.file.deployed
    items = {item.label: item for item in deployed.items} if deployed else {}
    serials = deployed.serials if deployed else {}
    seabeds = [leg.water.depth for leg in result.legs]
    own = leg_numbers(result.file)
    found: list[DeckItem] = []
    for row, clamps in rows_down(result):
        bottom = seabeds[own[row.index]]
        rows: list[ComponentRow | ClampRow] = [row, *clamps]
        found += (_deck_item(row, one, items, serials, bottom) for one in rows)
    return tuple(
        replace(one, apart=True) if one.is_connector and one.label in apart else one
        for one in found
    )


def _deck_item(
    piece: ComponentRow,
    row: ComponentRow | ClampRow,
    items: Mapping[str, DeployedItem],
    serials: Mapping[str, Sequence[str]],
    bottom: float,
) -> DeckItem:
    part = row.part
    item = items.get(part.label)
    clamp = row.part if isinstance(row, ClampRow) else None
    depth, _, _ = row.upper
    return DeckItem(
        part=part, index=piece.index, serial=part.serial, remark=item.remark if item else None,
        deployed_serial=", ".join(serials.get(part.label, ())) or part.serial,
        on=None if clamp is None else piece.label,
        at=None if clamp is None else clamp.at,
        of_length=None if clamp is None else piece.cut_length,
        cut_length=piece.cut_length if clamp is None else None,
        stretched=piece.length if clamp is None else None,
        tension=piece.tension if clamp is None else None,
        depth=depth, height=bottom - depth, tilt=row.tilt,
    )  # fmt: skip


@dataclass(frozen=True)
class Extreme:
    """Extreme depth [m] of a piece or clamp, and the environment in which this depth occurs."""

    depth: float
    environment: str


@dataclass(frozen=True)
class DeckInstrument:
    """Instrument, release, or float or frame that holds an instrument.

    Attributes
    ----------
    item : the item in the environment of the sheets
    still : depth in still water [m]; None if the shape in still water is not unique
    shallowest, deepest, greatest_tilt : extreme depths, and maximum tilt [degrees], over all
        environments
    """

    item: DeckItem
    still: float | None
    shallowest: Extreme
    deepest: Extreme
    greatest_tilt: float


def instruments_of(
    parts: Sequence[DeckItem], results: Sequence[tuple[str, Result]]
) -> tuple[DeckInstrument, ...]:
    """List the instruments, holders of instruments, and releases, down the line.

    `results` lists the name and the result of each environment, beginning with the environment of
    the sheets.
    """
    rows = [(name, rows_by_place(result)) for name, result in results]
    found = []
    for one in parts:
        if not one.holds_instrument:
            continue
        there = [(name, places[one.part.place]) for name, places in rows]
        depths = [Extreme(row.upper[0], name) for name, row in there]
        knockdown = there[0][1].knockdown
        still = None if knockdown != knockdown else one.depth - knockdown
        found.append(
            DeckInstrument(
                one,
                still,
                min(depths, key=lambda each: each.depth),
                max(depths, key=lambda each: each.depth),
                max(row.tilt for _, row in there),
            )
        )
    return tuple(found)


class Order(StrEnum):
    """Order of deployment: anchor first or anchor last."""

    ANCHOR_LAST = "anchor-last"
    ANCHOR_FIRST = "anchor-first"


def over_the_side(parts: Sequence[DeckItem], order: Order) -> tuple[DeckItem, ...]:
    """Sort the pieces in the order of deployment, each followed by its clamps.

    In an anchor-first deployment, the clamps of a piece are listed from the lowest up.
    """
    if order is Order.ANCHOR_LAST:
        return tuple(parts)
    groups = [[*group] for _, group in groupby(parts, key=lambda one: one.index)]
    return tuple(each for piece, *clamps in reversed(groups) for each in (piece, *reversed(clamps)))
