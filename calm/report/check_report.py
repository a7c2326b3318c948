"""A design check as a report, on a terminal, as JSON and as CSV."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import groupby
from math import inf
from typing import Any

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment, Situation
from calm.checks.comparison import Comparison
from calm.checks.finding import OWN, Finding, State, by_rule, worst_state
from calm.checks.inventory import total_of
from calm.checks.recovery import Recovery
from calm.drawing.check_figures import check_figure
from calm.drawing.schematic import schematic_svg
from calm.drop.launch import Launch
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.records.delimited import table_csv
from calm.report import blocks, check_facts, check_tables, provenance
from calm.report.blocks import Block, Figure, Prose, ReportPart, Section, Span, number, words
from calm.report.check_facts import PAGE_ONE, CheckFacts, facts_of
from calm.report.check_tables import place_of, verdict_prose
from calm.report.explanation import comparison_part
from calm.report.result_files import members
from calm.report.sheet import quality_of, summary_of, table_of_line
from calm.version import __version__


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


_NOTE = (
    "Each rule is shown for the component that breaks its limit most often; launch, recovery and "
    "breaks are counted in the first 64 samples. A sample without equilibrium breaks every limit."
)


def likelihood_tables(named: Iterable[tuple[str, Sequence[Finding]]]) -> Iterator[blocks.Table]:
    """The designs, by name, by their greatest probability; nothing where none was counted."""
    designs = [(_likeliest(findings), name) for name, findings in named]
    designs.sort(key=lambda one: -(one[0][0].probability or 0.0) if one[0] else inf)
    if not any(found for found, _ in designs):
        return
    rows: list[tuple[Finding | None, str]] = []
    for found, name in designs:
        likely = [each for each in found if each.probability]
        rows += zip(likely or (None,), (name, *("" for _ in likely[1:])), strict=True)

    def share(finding: Finding) -> blocks.Cell:
        percent = 100.0 * (finding.probability or 0.0)
        digits = 0 if percent >= 9.5 else 1
        text = f"{percent:.{digits}f}" if percent >= 0.05 else "<0.1"
        return blocks.Cell(text, strong=percent >= 5.0)

    fields = [
        words("component", lambda one: one.component or "whole line"),
        check_tables.FIGURES[2],
        words("where", place_of),
        number("broken in", share, "%"),
    ]
    yield blocks.table_of(
        "Probability of breaking a limit",
        rows,
        words("design", lambda row: row[1]),
        words("rule", lambda row: row[0].rule if row[0] else "none in any sample", 0.0),
        *((column, lambda row, show=show: row[0] and show(row[0])) for column, show in fields),
        note=_NOTE,
    )


def _likeliest(findings: Sequence[Finding]) -> list[Finding]:
    """Return the finding of each rule with the greatest probability, the greatest first."""
    counted = by_rule(one for one in findings if one.probability is not None)
    groups = (counted[name] for name in RULES if name in counted)
    found = (max(group, key=lambda one: one.probability or 0.0) for group in groups)
    return sorted(found, key=lambda one: -(one.probability or 0.0))


_TOLD = 12
"""Most failures, or warnings, shown of a mooring; a report has them all."""
_LACKING = 60
"""Most components named that lack a figure."""


def check_part(assessments: Sequence[Assessment]) -> blocks.ReportPart:
    """Everything that a design check says in short.

    Moorings by environments with the worst state in each; what decides, what is accepted and what
    departs of each; of each rule the finding with the worst margin; every failure and warning with
    its figures and remedy. No rule hangs on colour.
    """
    facts = [check_facts.facts_of(each) for each in assessments]
    findings = [one for each in facts for one in each.findings]
    shown = (
        *(replace(each, title="", note="") for each in check_facts.matrix_tables(facts)),
        check_tables.verdict_prose(findings),
        *(block for each in facts for block in _decisive(each, several=len(facts) > 1)),
        replace(check_facts.worst_table(facts), title=""),
        *likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments]),
        *(block for each in facts for block in _told(each)),
        blocks.Note(provenance.unseen(findings)[:1]),
    )
    return blocks.ReportPart("", shown)


def _decisive(facts: CheckFacts, *, several: bool) -> Iterator[blocks.Block]:
    """Return what decides of a mooring, what is accepted, and what departs."""
    if several:
        yield blocks.Heading(facts.mooring)
    yield check_facts.key_pairs(facts)
    yield from check_facts.settled_tables(facts)


def _told(facts: CheckFacts) -> Iterator[blocks.Block]:
    """Return what a mooring fails, lacks or is warned of, the gravest first, with its remedy."""
    listed = check_tables.to_mend(facts.findings)
    lines: list[blocks.Line] = []
    for state, groups in groupby(listed, key=lambda found: found[0].state):
        found = list(groups)
        most = len(found) if state is State.UNKNOWN else _TOLD
        lines += map(_sentence, found[:most])
        if len(found) > most:
            lines.append(f"  and {len(found) - most} more that {state}; --json has them")
    if lines:
        yield blocks.Heading(facts.mooring)
        yield Prose(tuple(lines))


def _sentence(found: Sequence[Finding]) -> blocks.Line:
    """Return what is found alike of some components, told of the worst of them."""
    worst = found[0]
    sign, quiet = Span(f"{worst.state.sign} ", worst.state), worst.state is not State.FAIL
    if worst.missing is not None:
        return sign, Span(f"{worst.message} {worst.remedy}", quiet=True)
    if worst.state is State.UNKNOWN and worst.component is not None and worst.limit is None:
        names = check_tables.named((one.component or "" for one in found), _LACKING)
        return sign, Span(f"{worst.rule} of {names} is unknown. {worst.remedy}", quiet=True)
    others = check_tables.named_components(found[1:])
    others = others and f" The same holds for {others}."
    told = Span(f"{worst.rule}, {place_of(worst)}: {worst.message}{others}")
    return (sign, told, Span(f" {worst.remedy}", quiet=quiet)) if worst.remedy else (sign, told)


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

    def by_name(told: Callable[[Assessment], Any]) -> dict[str, Any]:
        return {each.name: told(each) for each in assessments}

    def listed(told: Callable[[Assessment], Iterable[Any]]) -> list[Any]:
        return [one for each in assessments for one in told(each)]

    stands = [stand for each in assessments for stand in each.stands]
    seen = provenance.BY_WAVES if all(one.leg.file.environment.waves for one in stands) else ()
    given = by_name(lambda each: each.file.document)
    documents = {name: one.to_dict() for name, one in given.items() if one is not None}
    return {
        "calm": __version__,
        **({"document": documents} if documents else {}),
        "state": worst_state(each.state for each in assessments),
        "estimated": sum(one.state is State.ESTIMATED for one in listed(Assessment.all_findings)),
        "accepted": listed(_accepted),
        "limits": listed(
            lambda each: ({"mooring": each.name} | limit_document(key) for key in each.limits)
        ),
        "key_figures": by_name(lambda each: facts_of(each).to_dict()),
        "not_judged": [one for one in provenance.UNJUDGED if one not in seen],
        "findings": listed(lambda each: _findings(each, each.all_findings())),
        "tighter": listed(lambda each: _findings(each, each.tighter_findings())),
        "situations": by_name(
            lambda each: [
                {"environment": stand.environment, **_situation(situation)}
                for stand in each.stands
                for situation in stand.situations
            ]
        ),
        "launch": by_name(lambda each: _handled(each.launch, _OF_LAUNCH)),
        "recovery": by_name(lambda each: _handled(each.recovery, _OF_RECOVERY)),
        "backup": by_name(lambda each: [*map(asdict, each.backup)]),
        "losses": by_name(lambda each: [members(one, *_OF_LOSS) for one in each.losses]),
        "inventory": by_name(lambda each: [*map(asdict, each.inventory)]),
        "totals": by_name(lambda each: asdict(total_of(each.inventory))),
    }


def limit_document(key: LimitKey) -> dict[str, Any]:
    """The JSON object of a limit as used."""
    return members(key, "name", "value", "default", "source", "departs")


def _findings(assessment: Assessment, findings: Iterable[Finding]) -> Iterator[dict[str, Any]]:
    """Yield findings, with their probability if those were counted: null without a limit."""
    for one in findings:
        yield one.to_dict() | (members(one, "probability") if assessment.draws else {})


def _accepted(assessment: Assessment) -> Iterator[dict[str, Any]]:
    for one in assessment.accepted_findings():
        by = members(one.accept, "reason", "by", "date", "until")
        yield {"mooring": assessment.name, **members(one, "rule", "component"), **by}


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
        "anchor_vertical": result.anchor_load.vertical,
        "anchor_horizontal": result.anchor_load.horizontal,
        "required_weight": result.anchor_load.required_weight,
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
    """Return what a launch or a recovery comes to; null where it is not known."""
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
