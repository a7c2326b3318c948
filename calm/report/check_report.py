"""Report of a design check: several pages for one mooring, or a matrix and one page per mooring."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from calm.checks.assessment import Assessment
from calm.checks.comparison import Comparison
from calm.report import blocks, provenance
from calm.report.blocks import Block, PageBreak, ReportPart, Running, Section
from calm.report.check_matrix import SummaryRow, mooring_page, summary_page, summary_row
from calm.report.check_pages import basis_page, checks_page, handling_page
from calm.report.drawing_page import drawing_pages
from calm.report.explanation import comparison_part
from calm.report.likelihood import likelihood_tables
from calm.report.line_page import line_page
from calm.report.load_cases import load_cases
from calm.report.open_items import open_items
from calm.report.page_one import SignedMooring, page_one
from calm.version import __version__

_SIZE = 9.0
"""Font size of tables [pt]."""


@dataclass(frozen=True, kw_only=True)
class CheckedSection(Section):
    """Section on one mooring in the report of a design check, with its row in the matrix."""

    row: SummaryRow


def signed_mooring(assessment: Assessment) -> SignedMooring:
    """Collect load cases, open items and input hash of a mooring for its report."""
    files = [one.leg.file for one in assessment.in_environments]
    items = open_items(assessment)
    return SignedMooring(assessment, load_cases(assessment), items, provenance.input_hash(files))


def mooring_section(
    assessment: Assessment, against: Comparison | None = None, page_size: str = "a4"
) -> CheckedSection:
    """Build all pages on one mooring, which takes a few tenths of a second.

    Parameters
    ----------
    against : comparison of the mooring with the original design
    """
    signed = signed_mooring(assessment)
    details = chain(
        drawing_pages(signed, page_size), line_page(signed), checks_page(signed),
        _likelihood(assessment), handling_page(signed), basis_page(signed, page_size),
    )  # fmt: skip
    parts = [*_pages([page_one(signed, page_size), details])]
    if against is not None:
        parts += [_page([PageBreak()]), comparison_part(against)]
    return CheckedSection(
        assessment.name, tuple(parts), signed.running(), row=summary_row(assessment)
    )


def _likelihood(assessment: Assessment) -> Iterator[Block]:
    return likelihood_tables([(assessment.name, [*assessment.all_findings()])])


def short_section(assessment: Assessment) -> CheckedSection:
    """Build the single page on a mooring, for a report that begins with the matrix."""
    signed = signed_mooring(assessment)
    parts = tuple(_pages([chain(mooring_page(signed), _likelihood(assessment))]))
    return CheckedSection(assessment.name, parts, signed.running(), row=summary_row(assessment))


def _pages(pages: Iterable[Iterator[Block]]) -> Iterator[ReportPart]:
    full = [blocks_ for page in pages if (blocks_ := [*page])]
    for number, page in enumerate(full):
        yield _page([*([PageBreak()] if number else []), *page])


def _page(shown: Sequence[Block]) -> ReportPart:
    return ReportPart("", tuple(shown), _SIZE)


def check_report(sections: Sequence[CheckedSection]) -> blocks.Report:
    """Build the report of a design check, beginning with a matrix if there are several moorings."""
    rows = [each.row for each in sections]
    if len(rows) == 1:
        name = sections[0].name
        return blocks.Report(
            f"{name}: design check", "", (), tuple(sections), provenance.date(),
            running=sections[0].running,
        )  # fmt: skip
    environments = {name for row in rows for name in row.cells}
    title = (
        f"Design check of {len(rows)} moorings in {len(environments)} "
        f"environment{'s' * (len(environments) != 1)}"
    )
    worst = max((row.conclusion for row in rows), key=[*type(rows[0].conclusion)].index)
    foot = f"CALM {__version__}  the inputs of each mooring are on its own page"
    running = Running("", title, worst.words, provenance.date() or "", foot)
    front = _page([blocks.TitleBlock("", title, (), ()), *summary_page(rows)])
    return blocks.Report(title, "", (front,), tuple(sections), provenance.date(), running=running)
