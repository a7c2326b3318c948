"""A design check as a report."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from calm.checks.assessment import Assessment
from calm.checks.comparison import Comparison
from calm.checks.finding import OWN, State
from calm.drawing.check_figures import check_figure
from calm.drawing.schematic import schematic_svg
from calm.report import blocks, check_facts, check_tables, provenance
from calm.report.blocks import Block, Figure, Prose, ReportPart, Section
from calm.report.check_facts import PAGE_ONE, CheckFacts, facts_of
from calm.report.check_tables import verdict_prose
from calm.report.explanation import comparison_part
from calm.report.likelihood import likelihood_tables
from calm.report.sheet import quality_of, summary_of, table_of_line


@dataclass(frozen=True)
class CheckedSection(Section):
    """The section of a mooring in the report of a design check, with what is concluded of it."""

    facts: CheckFacts


def mooring_section(assessment: Assessment, against: Comparison | None = None) -> CheckedSection:
    """All that the report says of one mooring; it draws, so it takes some tenths of a second.

    `against` is the mooring compared with the design that it came from.
    """
    facts, items = facts_of(assessment), assessment.inventory
    stood = [one.leg for one in assessment.stands]
    inputs = [(one.file.environment.name or OWN, one.file, one.water) for one in stood]
    checks = (
        *check_tables.checks_table(assessment.all_findings()),
        *check_facts.left_out(facts),
        check_tables.limits_table(assessment.limits),
    )
    parts = (
        *provenance.history_part(assessment.file),
        *([] if against is None else [comparison_part(against)]),
        ReportPart("Judgement", tuple(_judgement(assessment, facts))),
        ReportPart("The line", tuple(_line(assessment))),
        ReportPart("Shape, tension and breaks", tuple(_drawn(assessment))),
        ReportPart("Checks", checks),
        ReportPart("Launch, recovery, breaks", tuple(_on_the_way(assessment))),
        ReportPart(
            "Inventory", (check_tables.inventory_table(items), check_tables.deck_table(items))
        ),
        provenance.inputs_part(inputs),
    )
    return CheckedSection(assessment.name, parts, facts)


def check_report(sections: Sequence[CheckedSection]) -> blocks.Report:
    """The report of a design check: what is signed, then all that it rests on.

    Page one is all that an engineer signs, of one mooring; of several, a summary follows it.
    """
    count = len(sections)
    facts = [each.facts for each in sections]
    environments = {name for each in facts for name in each.environments}
    moorings = sections[0].name if count == 1 else f"{count} moorings"
    in_all = f"{len(environments)} environment{'s' if len(environments) != 1 else ''}"
    findings = [one for each in facts for one in each.findings]
    signatures = blocks.Signatures(("Designed by", "Checked by"))
    unseen = Prose(provenance.unseen(findings), State.UNKNOWN)
    return blocks.Report(
        title="Design check",
        subtitle=f"{moorings}, {in_all}",
        front=(
            ReportPart("", (verdict_prose(findings),), least=PAGE_ONE),
            *(check_facts.facts_part(each, each.mooring if count > 1 else "") for each in facts),
            ReportPart("Signatures", (signatures, blocks.PageBreak()), least=PAGE_ONE),
            *((ReportPart("Summary", tuple(_summary(facts))),) if count > 1 else ()),
            ReportPart(provenance.NOT_JUDGED.title, (unseen,)),
        ),
        sections=tuple(sections),
        date=provenance.date(),
    )


def _summary(facts: Sequence[CheckFacts]) -> Iterator[Block]:
    yield from check_facts.matrix_tables(facts)
    yield from likelihood_tables([(each.mooring, each.findings) for each in facts])
    yield check_facts.worst_table(facts)


def _judgement(assessment: Assessment, facts: CheckFacts) -> Iterator[Block]:
    if description := assessment.file.description:
        yield Prose((description,))
    yield from check_facts.rules_tables(facts)
    yield from likelihood_tables([(assessment.name, [*assessment.all_findings()])])
    yield check_tables.results_table(assessment.stands)


def _line(assessment: Assessment) -> Iterator[Block]:
    """The schematic and the table, of each leg of a net, in the first environment it stands in."""
    solved = [(one, one.result) for one in assessment.stands if one.result is not None]
    if not solved:
        yield Figure("Schematic", schematic_svg(assessment.file, None), tall=True)
    for (one, result), *_ in check_tables.grouped(solved, lambda pair: pair[0].leg.name):
        where = f", environment: {one.environment}"
        yield Figure(f"Schematic{where}", schematic_svg(one.leg.file, result), tall=True)
        yield table_of_line(result, f"Table of the line{where}", places=True)
        yield from (*summary_of(result), quality_of(result))


def _drawn(assessment: Assessment) -> Iterator[Block]:
    if all(stand.result is None for stand in assessment.stands):
        yield Prose(("The mooring has no equilibrium in any environment.",), State.FAIL)
        return
    title = "Elevation, current, tension, plan and breaks"
    yield Figure(title, check_figure(assessment))
    yield Prose((_FIGURE_NOTE,))


def _on_the_way(assessment: Assessment) -> Iterator[Block]:
    if assessment.launch is not None or assessment.recovery is not None:
        yield blocks.Heading("Launch and recovery in short")
        yield check_tables.handling_summary(assessment)
        yield check_tables.handling_table(assessment)
    else:
        of_net = "The launch and the recovery of a net of legs are not judged."
        of_line = "Neither the launch nor the recovery could be solved."
        yield Prose((of_net if assessment.file.legs else of_line,), State.UNKNOWN)
    if assessment.backup:
        yield check_tables.breaks_table(assessment.backup)


_FIGURE_NOTE = (
    "Each elevation is in the vertical plane of its own excursion; marks and the "
    "line in still water are of the first environment. The limit over the tension is "
    "the allowed load of a piece (its working load, or its breaking load over the "
    "safety factor; beyond four times the tension it is drawn at the edge), that "
    "over the breaks the buoyancy required. Grey breaks are not judged."
)
