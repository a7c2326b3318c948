"""Deck sheets of a mooring: pieces and clamps with their depths, order of handling, and weights.

The class `Deck` is the common source of the printed sheets and of their files.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import groupby
from math import inf, isnan
from typing import TypeVar

from calm.case import Design, Result
from calm.case.result_tables import item_numbers
from calm.checks.assessment import Assessment
from calm.checks.design_check import check
from calm.checks.finding import OWN
from calm.checks.inventory import InventoryItem
from calm.checks.leg_graph import LegGraph
from calm.checks.recovery import Recovery, recovery_of
from calm.deck import deck_items
from calm.deck.deck_items import (
    DeckInstrument,
    DeckItem,
    Order,
    deck_items_of,
    instruments_of,
    standing_out,
)
from calm.deck.hardware import Cut, ShippedComponent, Stock, cuts_of, hardware_of, shipped_of
from calm.drop import DropPlan, drop_plan
from calm.drop.launch import SHIP_SPEED
from calm.errors import NoEquilibrium
from calm.files import CurrentTable, MooringFile
from calm.files.components import FLEXIBLE_KINDS
from calm.files.mooring_file import leg_numbers
from calm.solve import Status

FAINT = 0.1
"""Speed of the weak current in which a line is solved if it is slack in still water [m/s]."""

_Listed = TypeVar("_Listed")


@dataclass(frozen=True)
class RecoveredItem:
    """Piece or clamp that rises after release.

    Attributes
    ----------
    time : time from release to surfacing [s]; None if the part stays below
    hangs_at : final depth of a clamp, or of the upper end of a piece [m]; None if unknown
    by_itself : whether the part is buoyant enough to surface on its own
    """

    item: DeckItem
    time: float | None
    hangs_at: float | None
    by_itself: bool


@dataclass(frozen=True)
class Lift:
    """One lift: the piece at the rail with its clamps.

    Attributes
    ----------
    index, label : index and label of the piece
    mass : mass in air [kg]; None if unknown, and for a cable or chain, which is not lifted
    weight : weight in water [N], positive down; None if the length of the piece is unknown
    hanging : winch load [N], which is the weight in water of everything over the side, positive
        down; None if a length is unknown
    """

    index: int
    label: str
    mass: float | None
    weight: float | None
    hanging: float | None


@dataclass(frozen=True)
class Lifts:
    """Lifts during deployment and recovery.

    Attributes
    ----------
    deployment : lifts in the order in which they go over the side
    recovery : lifts from the top of the line down to the release
    unknown : labels of all pieces and clamps of unknown mass
    """

    deployment: tuple[Lift, ...]
    recovery: tuple[Lift, ...]
    unknown: tuple[str, ...]

    @property
    def heaviest(self) -> Lift | None:
        """Heaviest lift among those whose mass in air is known."""
        known = [lift for lift in self.deployment if lift.mass is not None]
        return max(known, key=lambda lift: lift.mass or 0.0, default=None)


@dataclass(frozen=True)
class Deck:
    """Deck sheets of a mooring or of a net.

    Attributes
    ----------
    result : result in the environment for which the sheets are made
    environment : name of this environment
    parts : pieces and clamps down the line, leg by leg in a net
    deployment : parts in the order in which they go over the side
    recovery : parts in the order in which they surface
    rise : rise of the line without its anchor; None for a net, or without a solution
    plan : plan of the anchor drop, or the reason why there is none; None for an anchor-first
        deployment, and for a net
    environments : names of the environments in which the mooring has an equilibrium
    notes : missing information, with reasons
    """

    result: Result
    environment: str
    order: Order
    parts: tuple[DeckItem, ...]
    deployment: tuple[DeckItem, ...]
    recovery: tuple[RecoveredItem, ...]
    rise: Recovery | None
    cuts: tuple[Cut, ...]
    hardware: tuple[Stock, ...]
    shipped: tuple[ShippedComponent, ...]
    lifts: Lifts
    instruments: tuple[DeckInstrument, ...]
    environments: tuple[str, ...]
    notes: tuple[str, ...]
    assessment: Assessment
    plan: DropPlan | NoEquilibrium | None = None

    @property
    def file(self) -> MooringFile:
        """The mooring file as read, with the environment of the sheets."""
        return self.result.file

    @cached_property
    def numbers(self) -> Mapping[str, str]:
        """Item numbers of pieces and clamps by label, equal to those in the design check."""
        return item_numbers(self.result)

    def leg(self, index: int) -> str:
        """Return the name of the leg that contains a piece, or "" for a single line.

        `index` is the index of the piece.
        """
        number = leg_numbers(self.file)[index]
        return self.result.legs[number].name if self.result.several else ""

    def by_leg(
        self, items: Iterable[_Listed], index: Callable[[_Listed], int]
    ) -> Iterator[tuple[str, list[_Listed]]]:
        """Yield the name of each leg and the list of items in this leg.

        For a single line, yield the empty name and all items. The function `index` returns the
        index of the piece to which an item belongs.
        """
        for name, group in groupby(items, key=lambda one: self.leg(index(one))):
            yield name, [*group]


def deck_of(
    moorings: Sequence[Design],
    order: Order = Order.ANCHOR_LAST,
    ship_speed: float = SHIP_SPEED,
    streamed: float | None = None,
    course: float | None = None,
) -> Deck:
    """Create the deck sheets of a mooring or a net.

    The sheets of a net contain neither the anchor drop nor the ascent.

    Parameters
    ----------
    moorings : the mooring in each environment, with equal cut lengths; the sheets are made for the
        environment of the first
    ship_speed, streamed, course : inputs of `calm.drop.drop_plan` [m/s], [m], [degrees]

    Raises
    ------
    NoEquilibrium
        The mooring has no equilibrium in the first environment.
    UsageError
        The ship is too slow to stream the line, or the line is shorter than `streamed`.
    """
    first = moorings[0]
    notes: list[str] = []
    result = _solved(first, notes)
    notes += result.warnings
    results = [(_name(first), result)]
    for other in moorings[1:]:
        try:
            there = other.solve()
        except NoEquilibrium as failure:
            notes.append(f"The mooring has no equilibrium in {_name(other)}: {failure}")
            continue
        results.append((_name(other), there))
    assessment = check(*moorings)
    parts = deck_items_of(result, standing_out(assessment.every_finding()))
    inventory, legs = assessment.inventory, leg_numbers(first.file)
    rise: Recovery | None = None
    plan: DropPlan | NoEquilibrium | None = None
    if first.several:
        notes += assessment.notices
        rising = LegGraph.in_equilibrium(result.legs).coming_up
    else:
        try:
            rise = recovery_of(first.leg, result.leg)
        except NoEquilibrium as failure:
            notes.append(f"The ascent of the line could not be computed: {failure}")
        released = first.file.pieces[-1].index if rise is None else rise.released + 1
        rising = set(range(released))
    if order is Order.ANCHOR_LAST and not first.several:
        try:
            same_design = result if result.design is first else None
            times = _deck_times(first.file)
            plan = drop_plan(
                first, ship_speed, streamed, course, result=same_design, deck_time=times
            )
        except NoEquilibrium as failure:
            plan = failure
            notes.append(f"The anchor drop could not be computed: {failure}")
    return Deck(
        result=result,
        environment=_name(first),
        order=order,
        parts=parts,
        deployment=deck_items.over_the_side(parts, order),
        recovery=surfacing(parts, rising, rise),
        rise=rise,
        cuts=cuts_of(result, parts, order),
        hardware=hardware_of([[*leg] for _, leg in groupby(parts, lambda one: legs[one.index])]),
        shipped=shipped_of(first.file, inventory),
        lifts=lifts_of(inventory, legs, rising, order),
        instruments=instruments_of(parts, results),
        environments=tuple(name for name, _ in results),
        notes=tuple(notes),
        assessment=assessment,
        plan=plan,
    )


def _deck_times(file: MooringFile) -> Mapping[str, float] | None:
    """Return the handling time of one piece [s] for each role, or None if unspecified."""
    given = None if file.document is None else file.document.deck_time
    return None if given is None else {str(role): time for role, time in given.items()}


def _solved(mooring: Design, notes: list[str]) -> Result:
    """Solve the mooring.

    A single line that is slack in still water is solved in a weak current instead. In that case, a
    note is added to `notes`.
    """
    try:
        return mooring.solve()
    except NoEquilibrium as failure:
        if failure.status != Status.SLACK.label or mooring.several:
            raise
        faint = CurrentTable((0.0,), (FAINT,), (0.0,), (0.0,))
        environment = replace(mooring.file.environment, current=faint)
        try:
            result = Design(replace(mooring.file, environment=environment)).solve()
        except NoEquilibrium:
            raise failure from None
        notes.append(
            "The line is longer than the water depth and slack in still water, so the sheets "
            f"show it in a current of {FAINT:g} m/s to the east; the anchor drop is computed "
            "in still water"
        )
        return result


def _name(mooring: Design) -> str:
    return mooring.file.environment.name or OWN


def surfacing(
    parts: Sequence[DeckItem], pieces: Collection[int], recovery: Recovery | None
) -> tuple[RecoveredItem, ...]:
    """List the rising parts in order of surfacing, followed by the parts that stay below.

    `pieces` contains the indices of the pieces that rise. If `recovery` is None, the parts are
    listed in line order, and their times are None.
    """
    rising = [one for one in parts if one.index in pieces]
    if recovery is None:
        return tuple(RecoveredItem(one, None, None, False) for one in rising)
    found = [_surfacing(one, recovery) for one in rising]
    times = [inf if one.time is None else one.time for one in found]
    # stable sort keeps items that surface together in line order
    return tuple(found[i] for i in sorted(range(len(found)), key=times.__getitem__))


def _surfacing(one: DeckItem, recovery: Recovery) -> RecoveredItem:
    time = float(recovery.arrival[one.index])
    share = one.at / one.of_length if one.at is not None and one.of_length else 0.0
    hangs_at = recovery.depth_at(one.index, share)
    return RecoveredItem(
        one,
        None if isnan(time) else time,
        None if isnan(hangs_at) else hangs_at,
        one.index in recovery.order and one.on is None,
    )


def lifts_of(
    inventory: Sequence[InventoryItem], legs: Sequence[int], rising: Collection[int], order: Order
) -> Lifts:
    """List the lifts of a mooring with their crane loads, leg by leg.

    Parameters
    ----------
    legs : leg number of each piece
    rising : indices of the pieces that rise to the surface
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
    unknown = tuple(one.label for one in inventory if one.dry_mass is None)
    return Lifts(tuple(down), tuple(up), unknown)


def _weights(inventory: Sequence[InventoryItem]) -> dict[int, float | None]:
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
