"""How long each wire and rope is cut, where it is marked, and how exactly that has to be."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.deck.deck_items import Order
from calm.errors import NoEquilibrium
from calm.files import Cable, Chain, Flexible, Piece
from calm.solve import expect_many

if TYPE_CHECKING:
    from calm.case import Result
    from calm.deck.deck_items import DeckItem

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
    effect : how much deeper the top is where this is longer by `LENGTH_ERROR` [m]; None where such
        a line does not stand
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
    cables = [one for one in parts if _is_cut(one)]
    count = len(cables)
    expect_many(count * max(1.0, len(result.components) / ORDINARY))
    return tuple(
        _cut(result, one, number if order is Order.ANCHOR_LAST else count + 1 - number, count)
        for number, one in enumerate(cables, 1)
    )


def _is_cut(one: DeckItem) -> bool:
    part = one.part
    if not isinstance(part, Piece):
        return False
    return isinstance(part.component, Cable) or (
        isinstance(part.component, Chain) and bool(part.clamps)
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
        marks=tuple(_marks(piece, longer)),
        termination=piece.equipment.termination,
        tolerance=max(LENGTH_ERROR * length, LEAST_TOLERANCE),
        effect=_effect(result, piece.index, one.cut_length),
        over=over,
        onto=count + 1 - over,
    )


def _marks(piece: Piece, longer: float) -> Iterator[Mark]:
    for clamp in sorted(piece.clamps, key=lambda clamp: clamp.at):
        yield Mark(clamp.label, clamp.at * longer)


def _effect(result: Result, index: int, length: float) -> float | None:
    """Return how much deeper the top is, in the same water, where a piece is cut too long [m]."""
    from calm.case import Mooring

    mooring = result.mooring
    longer = mooring.line.with_length(index, length * (1.0 + LENGTH_ERROR))
    try:
        solution = Mooring(mooring.file, line=longer).equilibrium(mooring.water)
    except NoEquilibrium:
        return None
    return -float(solution.position[0, 2]) - result.top.depth
