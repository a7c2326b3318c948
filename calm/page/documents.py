"""Documents to download from the page: report, diagram, bill of material and deck lists."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.errors import UsageError
from calm.tui import live

if TYPE_CHECKING:
    from calm.case import Design


@dataclass(frozen=True)
class Download:
    """A kind of document to download.

    Attributes
    ----------
    kind : name of the kind in the messages of the page
    title : title of the download button
    suffix : text appended to the name of the mooring file
    content : function that creates the document from designs, one for each environment
    """

    kind: str
    title: str
    suffix: str
    content: Callable[[list[Design]], bytes]


def _report(moorings: list[Design]) -> bytes:
    from calm.checks import design_check
    from calm.report.check_report import check_report, mooring_section
    from calm.report.html import page

    return page(check_report([mooring_section(design_check.check(*moorings))])).encode()


def _diagram(moorings: list[Design]) -> bytes:
    from calm.deck import deck_of
    from calm.report.diagram import PageSize, diagram_svg

    return diagram_svg(deck_of(moorings), PageSize.A4).encode()


def _bill(moorings: list[Design]) -> bytes:
    from calm.checks import design_check
    from calm.report.check_files import inventory_csv

    return inventory_csv([design_check.check(*moorings)]).encode()


def _deck(moorings: list[Design]) -> bytes:
    from calm.deck import deck_of
    from calm.report.deck_files import deck_workbook

    return deck_workbook(deck_of(moorings))


DOCUMENTS = (
    Download("report", "Report", "-report.html", _report),
    Download("diagram", "Diagram", "-diagram.svg", _diagram),
    Download("bill", "Bill of material", "-bill.csv", _bill),
    Download("deck", "Deck lists", "-deck.xlsx", _deck),
)
"""Kinds of documents, in the order of their buttons."""


def document(kind: str, view: live.View) -> tuple[str, bytes]:
    """Create a document for a solved line, and return its name and content.

    `kind` is in `DOCUMENTS`. Raise UsageError if the line is not solved, or the document is not
    available for a tow. Raise NoEquilibrium for a line without equilibrium.
    """
    wanted = next(each for each in DOCUMENTS if each.kind == kind)
    name = f"{view.path.stem}{wanted.suffix}"
    if view.result is None:
        raise view.failure or UsageError(
            "the line is incomplete; the verdict names the missing parts"
        )
    if view.result.towed:
        if kind != "report":
            raise UsageError("for a tow, only the report is available")
        from calm.report.html import page
        from calm.report.result_report import result_report

        return name, page(result_report(view.result)).encode()
    if not view.anchored:
        raise UsageError("the line has no anchor yet")
    moorings, _ = live.in_all_environments(view, view.result.design)
    return name, wanted.content(moorings)
