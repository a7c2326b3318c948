"""A mooring's part of a design check, what it concludes, and the whole report of several."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from calm.checks.finding import State
from calm.drawing.check_figures import check_figure
from calm.report.blocks import (
    ON_THE_WAY,
    Block,
    Figure,
    Heading,
    PageBreak,
    Prose,
    Report,
    ReportPart,
    Section,
    Signatures,
)
from calm.report.check_facts import (
    PAGE_ONE,
    CheckFacts,
    facts_of,
    facts_part,
    judged_section,
    left_out,
)
from calm.report.check_summary import (
    limits_table,
    matrix_tables,
    rules_tables,
    verdict_prose,
    worst_table,
)
from calm.report.check_tables import (
    breaks_table,
    checks_table,
    deck_table,
    handling_summary,
    handling_table,
    inventory_table,
    likelihood_tables,
    results_table,
)
from calm.report.differences import comparison_part
from calm.report.provenance import (
    NOT_JUDGED,
    date,
    history_part,
    inputs_part,
)
from calm.report.sheet import sheet

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment
    from calm.checks.comparison import Comparison


def mooring_section(assessment: Assessment, against: Comparison | None = None) -> Section:
    """All that the report says of one mooring; it draws, so it takes some tenths of a second.

    `against` is the mooring compared with the design that it came from.
    """
    stands, facts = assessment.stands, facts_of(assessment)
    judged = judged_section(assessment)
    compared = () if against is None else (comparison_part(against),)
    parts = (
        *history_part(assessment.mooring.file),
        *compared,
        ReportPart("Judgement", tuple(_judgement(assessment, judged))),
        ReportPart("The line", tuple(_line(assessment))),
        ReportPart("Shape, tension and breaks", tuple(_drawn(assessment))),
        ReportPart("Checks", tuple(_checks(assessment, facts))),
        ReportPart("Launch, recovery, breaks", tuple(_on_the_way(assessment))),
        ReportPart(
            "Inventory",
            (inventory_table(assessment.inventory), deck_table(assessment.inventory)),
        ),
        inputs_part(
            [stand.mooring.file for stand in stands],
            [stand.environment for stand in stands],
            [stand.mooring.water for stand in stands],
        ),
    )
    return replace(judged, parts=parts)


def check_report(sections: Sequence[Section]) -> Report:
    """The report of a design check: what is signed, then all that it rests on.

    Page one is all that an engineer signs, of one mooring; of several, a summary follows it.
    """
    count = len(sections)
    environments = {column for each in sections for column in each.columns} - {ON_THE_WAY}
    moorings = sections[0].name if count == 1 else f"{count} moorings"
    in_all = f"{len(environments)} environment{'s' if len(environments) != 1 else ''}"
    facts = [each.facts for each in sections if each.facts is not None]
    verdict = verdict_prose(finding for each in facts for finding in each.findings)
    signatures = Signatures(("Designed by", "Checked by"))
    return Report(
        title="Design check",
        subtitle=f"{moorings}, {in_all}",
        front=(
            ReportPart("", (verdict,), least=PAGE_ONE),
            *(facts_part(each, each.mooring if count > 1 else "") for each in facts),
            ReportPart("Signatures", (signatures, PageBreak()), least=PAGE_ONE),
            *((ReportPart("Summary", tuple(_summary(sections))),) if count > 1 else ()),
            NOT_JUDGED,
        ),
        sections=tuple(sections),
        date=date(),
    )


def _summary(sections: Sequence[Section]) -> Iterator[Block]:
    yield from matrix_tables(sections)
    findings = [(each.name, each.facts.findings) for each in sections if each.facts is not None]
    yield from likelihood_tables(findings)
    yield worst_table(sections)


def _judgement(assessment: Assessment, judged: Section) -> Iterator[Block]:
    description = assessment.mooring.file.description
    if description:
        yield Prose((description,))
    yield from rules_tables(judged.columns, judged.worst)
    yield from likelihood_tables([(assessment.name, [*assessment.all_findings()])])
    yield results_table(assessment.stands)


def _line(assessment: Assessment) -> Iterator[Block]:
    """The schematic and the table of the line in the first environment that it stands in."""
    from calm.drawing.schematic import schematic_svg

    stand = next((stand for stand in assessment.stands if stand.result is not None), None)
    result = stand.result if stand else None
    title = f"Schematic, environment: {stand.environment}" if stand else "Schematic"
    yield Figure(title, schematic_svg(assessment.mooring.file, result), tall=True)
    if stand is not None and result is not None:
        said = sheet(result, places=True)
        yield replace(said.table, title=f"Table of the line, environment: {stand.environment}")
        yield from (*said.summary, Prose((said.convergence,)))


def _drawn(assessment: Assessment) -> Iterator[Block]:
    if all(stand.result is None for stand in assessment.stands):
        yield Prose(("The mooring has no equilibrium in any environment.",), State.FAIL)
        return
    title = "Elevation, current, tension, plan and breaks"
    yield Figure(title, check_figure(assessment))
    yield Prose((_FIGURE_NOTE,))


def _checks(assessment: Assessment, facts: CheckFacts) -> Iterator[Block]:
    yield from checks_table(assessment.all_findings())
    yield from left_out(facts)
    yield limits_table(assessment.limits)


def _on_the_way(assessment: Assessment) -> Iterator[Block]:
    if assessment.launch is not None or assessment.recovery is not None:
        yield Heading("Launch and recovery in short")
        yield handling_summary(assessment)
        yield handling_table(assessment)
    else:
        yield Prose(("Neither the launch nor the recovery could be solved.",), State.UNKNOWN)
    if assessment.backup:
        yield breaks_table(assessment.backup)


_FIGURE_NOTE = (
    "Elevations: each in the vertical plane of its own excursion; marks and the line in still "
    "water: of the first environment. Limit: over the tension, the load that a piece may bear "
    "(its working load, or its breaking load over the safety factor; what lies beyond four times "
    "the tension is drawn at the edge); over the breaks, the buoyancy required. "
    "Grey: breaks that are not judged."
)
