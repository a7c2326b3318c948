"""What a page offers to download of a line: its report, diagram, bill of material, deck lists."""

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
    """A kind of file to download.

    Attributes
    ----------
    kind : what the page asks for
    title : on its button
    suffix : after the name of the mooring file
    content : makes it of the mooring in each of its environments
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
    from calm.report.diagram import Paper, diagram_svg

    return diagram_svg(deck_of(moorings), Paper.A4).encode()


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
"""In the order of the buttons."""


def document(kind: str, view: live.View) -> tuple[str, bytes]:
    """Name and content of a document of a line that has been solved.

    Parameters
    ----------
    kind : of `DOCUMENTS`
    view : the line as the builder shows it; what was solved for it is not solved again

    Raises
    ------
    UsageError
        The line is not solved, or is a tow, which has a report alone.
    NoEquilibrium
        It does not stand.
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
