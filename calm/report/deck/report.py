"""The whole deck of one mooring on pages: the diagram, then the sheets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.drop import DropPlan
from calm.report.blocks import PageBreak, Part, Plate, Prose, Report, Section
from calm.report.deck.diagram import diagram_pages
from calm.report.deck.lists import (
    cutting_part,
    hardware_part,
    instruments_part,
    lifts_part,
    shipping_part,
)
from calm.report.deck.logs import deployment_part, recovery_part
from calm.report.drop.sheet import drop_part
from calm.report.inputs import origin
from calm.report.provenance import date
from calm.report.title_block import document_part

if TYPE_CHECKING:
    from calm.deck import Deck
    from calm.report.deck.paper import Paper


def deck_report(deck: Deck, paper: Paper, notes: tuple[str, ...] = ()) -> Report:
    """Diagram, logs, lists and plans; `notes` is what else is to be said on the first sheet."""
    parts: list[Part] = [*document_part(deck.file)]
    said = (*deck.notes, *notes)
    if said:
        parts.append(Part("To be known", (Prose(said, State.WARN),)))
    parts.append(Part("Inputs", (origin([deck.file]),)))
    parts += (Part(part.title, (*part.blocks, PageBreak())) for part in _sheets(deck))
    subtitle = f"{deck.order}, environment: {deck.environment}"
    section = Section(deck.file.name, tuple(parts))
    return Report(deck.file.name, subtitle, (), (section,), date(), plates(deck, paper))


def diagram_report(deck: Deck, paper: Paper) -> Report:
    """The diagram alone."""
    return Report(deck.file.name, "mooring diagram", (), (), date(), plates(deck, paper))


def plates(deck: Deck, paper: Paper) -> tuple[Plate, ...]:
    """The pages of the diagram."""
    pages = diagram_pages(deck, paper)
    return tuple(
        Plate(f"Mooring diagram, {number} of {len(pages)}", svg)
        for number, svg in enumerate(pages, 1)
    )


def _sheets(deck: Deck) -> Iterator[Part]:
    yield deployment_part(deck)
    yield recovery_part(deck)
    yield cutting_part(deck)
    yield hardware_part(deck)
    yield shipping_part(deck)
    yield lifts_part(deck)
    yield instruments_part(deck)
    if isinstance(deck.plan, DropPlan):
        yield drop_part(deck.plan)
