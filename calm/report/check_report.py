"""A mooring's part of a design check, what it concludes, and the whole report of several.

As a document it is JSON, and its findings and pieces are CSV.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, Situation
from calm.checks.finding import ON_THE_WAY, Finding, State, worst_state
from calm.checks.inventory import total_of
from calm.drawing.check_figures import check_figure
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv
from calm.report import blocks, check_facts, check_tables, provenance
from calm.report.blocks import Block, Figure, Prose, Report, ReportPart, Section, Signatures
from calm.report.check_facts import PAGE_ONE, CheckFacts, facts_of, facts_part, left_out
from calm.report.check_summary import limits_table, verdict_prose
from calm.report.check_tables import breaks_table, checks_table, deck_table, likelihood_tables
from calm.report.explanation import comparison_part
from calm.report.provenance import BY_WAVES, NOT_JUDGED, UNJUDGED, date, history_part, inputs_part
from calm.report.result_files import members
from calm.report.sheet import quality_of, summary_of, table_of_line

if TYPE_CHECKING:
    from calm.checks.comparison import Comparison
    from calm.checks.recovery import Recovery
    from calm.drop.launch import Launch


def mooring_section(assessment: Assessment, against: Comparison | None = None) -> Section:
    """All that the report says of one mooring; it draws, so it takes some tenths of a second.

    `against` is the mooring compared with the design that it came from.
    """
    stands, facts = assessment.stands, facts_of(assessment)
    compared = () if against is None else (comparison_part(against),)
    parts = (
        *history_part(assessment.mooring.file),
        *compared,
        ReportPart("Judgement", tuple(_judgement(assessment, facts))),
        ReportPart("The line", tuple(_line(assessment))),
        ReportPart("Shape, tension and breaks", tuple(_drawn(assessment))),
        ReportPart(
            "Checks",
            (
                *checks_table(assessment.all_findings()),
                *left_out(facts),
                limits_table(assessment.limits),
            ),
        ),
        ReportPart("Launch, recovery, breaks", tuple(_on_the_way(assessment))),
        ReportPart(
            "Inventory",
            (check_tables.inventory_table(assessment.inventory), deck_table(assessment.inventory)),
        ),
        inputs_part(
            [stand.mooring.file for stand in stands],
            [stand.environment for stand in stands],
            [stand.mooring.water for stand in stands],
        ),
    )
    return Section(assessment.name, parts, facts)


def check_report(sections: Sequence[Section]) -> Report:
    """The report of a design check: what is signed, then all that it rests on.

    Page one is all that an engineer signs, of one mooring; of several, a summary follows it.
    """
    count = len(sections)
    facts = [each.facts for each in sections if each.facts is not None]
    environments = {column for each in facts for column in each.columns} - {ON_THE_WAY}
    moorings = sections[0].name if count == 1 else f"{count} moorings"
    in_all = f"{len(environments)} environment{'s' if len(environments) != 1 else ''}"
    findings = [one for each in facts for one in each.findings]
    signatures = Signatures(("Designed by", "Checked by"))
    return Report(
        title="Design check",
        subtitle=f"{moorings}, {in_all}",
        front=(
            ReportPart("", (verdict_prose(findings),), least=PAGE_ONE),
            *(facts_part(each, each.mooring if count > 1 else "") for each in facts),
            ReportPart("Signatures", (signatures, blocks.PageBreak()), least=PAGE_ONE),
            *((ReportPart("Summary", tuple(_summary(facts))),) if count > 1 else ()),
            ReportPart(NOT_JUDGED.title, (Prose(provenance.unseen(findings), State.UNKNOWN),)),
        ),
        sections=tuple(sections),
        date=date(),
    )


def _summary(facts: Sequence[CheckFacts]) -> Iterator[Block]:
    yield from check_facts.matrix_tables(facts)
    yield from likelihood_tables([(each.mooring, each.findings) for each in facts])
    yield check_facts.worst_table(facts)


def _judgement(assessment: Assessment, facts: CheckFacts) -> Iterator[Block]:
    description = assessment.mooring.file.description
    if description:
        yield Prose((description,))
    yield from check_facts.rules_tables(facts)
    yield from likelihood_tables([(assessment.name, [*assessment.all_findings()])])
    yield check_tables.results_table(assessment.stands)


def _line(assessment: Assessment) -> Iterator[Block]:
    """The schematic and the table of the line in the first environment that it stands in."""
    from calm.drawing.schematic import schematic_svg

    stand = next((stand for stand in assessment.stands if stand.result is not None), None)
    result = stand.result if stand else None
    title = f"Schematic, environment: {stand.environment}" if stand else "Schematic"
    yield Figure(title, schematic_svg(assessment.mooring.file, result), tall=True)
    if stand is not None and result is not None:
        title = f"Table of the line, environment: {stand.environment}"
        yield table_of_line(result, title, places=True)
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
        net = bool(assessment.mooring.file.legs)
        said = "The launch and the recovery of a net of legs are not judged."
        said = said if net else "Neither the launch nor the recovery could be solved."
        yield Prose((said,), State.UNKNOWN)
    if assessment.backup:
        yield breaks_table(assessment.backup)


_FIGURE_NOTE = (
    "Each elevation is in the vertical plane of its own excursion; marks and the "
    "line in still water are of the first environment. The limit over the tension is "
    "the allowed load of a piece (its working load, or its breaking load over the "
    "safety factor; beyond four times the tension it is drawn at the edge), that "
    "over the breaks the buoyancy required. Grey breaks are not judged."
)


def check_document(assessments: Sequence[Assessment]) -> dict[str, Any]:
    """The JSON object of a design check; what could not be solved is null.

    Returns
    -------
    dict
        `state`, the worst there is; how many findings are `estimated`; what is `accepted`, and why;
        `findings`, and as `tighter` those of other situations that leave less margin; of each
        mooring by its name the `key_figures` of page one, `launch`, `recovery`, `backup`,
        `inventory` and its `totals`, and its `document` where files give any; and `situations`,
        what was solved of each mooring in each environment.
    """
    from calm.version import __version__

    documents = {
        each.name: each.mooring.file.document.to_dict()
        for each in assessments
        if each.mooring.file.document is not None
    }
    return {
        "calm": __version__,
        **({"document": documents} if documents else {}),
        "state": worst_state(each.state for each in assessments),
        "estimated": sum(
            finding.state is State.ESTIMATED
            for each in assessments
            for finding in each.all_findings()
        ),
        "accepted": [
            _accepted(each.name, finding)
            for each in assessments
            for finding in each.accepted_findings()
        ],
        "limits": [
            {"mooring": each.name} | limit_document(key)
            for each in assessments
            for key in each.limits
        ],
        "key_figures": {each.name: facts_of(each).to_dict() for each in assessments},
        "not_judged": [
            one
            for one in UNJUDGED
            if one not in BY_WAVES
            or not all(
                stand.mooring.file.environment.waves
                for each in assessments
                for stand in each.stands
            )
        ],
        "findings": [
            _finding(each, finding) for each in assessments for finding in each.all_findings()
        ],
        "tighter": [
            _finding(each, finding) for each in assessments for finding in each.tighter_findings()
        ],
        "situations": {
            each.name: [
                {"environment": stand.environment, **_situation(situation)}
                for stand in each.stands
                for situation in stand.situations
            ]
            for each in assessments
        },
        "launch": {each.name: _handled(each.launch, _OF_LAUNCH) for each in assessments},
        "recovery": {each.name: _handled(each.recovery, _OF_RECOVERY) for each in assessments},
        "backup": {each.name: [asdict(one) for one in each.backup] for each in assessments},
        "losses": {
            each.name: [members(one, *_OF_LOSS) for one in each.losses] for each in assessments
        },
        "inventory": {each.name: [asdict(one) for one in each.inventory] for each in assessments},
        "totals": {each.name: asdict(total_of(each.inventory)) for each in assessments},
    }


def limit_document(key: LimitKey) -> dict[str, Any]:
    """The JSON object of a limit as used."""
    return members(key, "name", "value", "default", "source", "departs")


def _finding(assessment: Assessment, finding: Finding) -> dict[str, Any]:
    """Return a finding, with its probability if those were counted: null without a limit."""
    counted = {"probability": finding.probability} if assessment.draws else {}
    return finding.to_dict() | counted


def _accepted(mooring: str, finding: Finding) -> dict[str, Any]:
    return {
        "mooring": mooring,
        **members(finding, "rule", "component"),
        **members(finding.accept, "reason", "by", "date", "until"),
    }


def _situation(situation: Situation) -> dict[str, Any]:
    said: dict[str, Any] = {"situation": situation.name}
    if situation.failure is not None:
        return said | situation.failure.to_dict()
    result = situation.result
    assert result is not None
    return {
        **said,
        **members(result, "status", "type"),
        "top_depth": result.top.depth,
        "knockdown": result.top.knockdown,
        "anchor_vertical": result.anchor.vertical,
        "anchor_horizontal": result.anchor.horizontal,
        "required_weight": result.anchor.required_weight,
        "accuracy": asdict(result.accuracy),
        "warnings": result.warnings,
    }


_OF_LAUNCH = (
    "fall_speed", "fall_speed_band", "anchor_tension", "anchor_drag_known", "greatest_speed",
    "drift",
)  # fmt: skip
_OF_LOSS = ("index", "label", "margin", "weight_lifted", "required")
_OF_RECOVERY = ("released", "rise_speed", "time_to_surface", "net_buoyancy", "order")


def _handled(way: Launch | Recovery | None, names: Sequence[str]) -> dict[str, Any] | None:
    """What a launch or a recovery comes to; null where it is not known."""
    return None if way is None else members(way, *names) | {"components": way.components()}


_OF_FINDING = ("mooring", "environment", "situation", "rule", "component")
_TEXTS = ("message", "remedy", "source")
CHECKS_HEADER = (
    *_OF_FINDING, "state", "value", "limit", "margin", "unit", *_TEXTS, "reason", "probability",
)  # fmt: skip
"""First row of `checks_csv`; value, limit and margin are in the unit of their row."""

_OF_ITEM = (
    "index", "label", "use", "name", "role", "kind", "clamped_on", "cut_length", "dry_mass",
    "wet_weight", "lift_mass", "at",
)  # fmt: skip
INVENTORY_HEADER = (
    "mooring",
    *(QUANTITIES[name].header if name in QUANTITIES else name for name in _OF_ITEM),
)
"""First row of `inventory_csv`; weights in water are positive downward."""


def checks_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every finding, of one mooring after the other; what is unknown is left empty."""
    findings = (finding for each in assessments for finding in each.all_findings())
    return table_csv(CHECKS_HEADER, map(_finding_row, findings))


def inventory_csv(assessments: Sequence[Assessment]) -> str:
    """A row for every piece and clamp, from the top of each mooring to its anchor."""
    rows = (
        [each.name, *members(item, *_OF_ITEM).values()]
        for each in assessments
        for item in each.inventory
    )
    return table_csv(INVENTORY_HEADER, rows)


def _finding_row(finding: Finding) -> Sequence[object]:
    quantity = QUANTITIES.get(RULES[finding.rule].quantity)
    return (
        *members(finding, *_OF_FINDING).values(),
        finding.state.value,
        *members(finding, "value", "limit", "margin").values(),
        quantity.unit if quantity else None,
        *members(finding, *_TEXTS).values(),
        None if finding.accept is None else finding.accept.reason,
        finding.probability,
    )
