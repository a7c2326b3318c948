"""The design check in short: the matrix, the worst of each rule, what to mend."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from calm.checks.finding import Finding, State
from calm.report.blocks import (
    Block,
    Heading,
    Line,
    Note,
    Prose,
    ReportPart,
    Span,
)
from calm.report.check_facts import key_pairs, settled_tables
from calm.report.check_report import judged_section
from calm.report.check_summary import (
    matrix_tables,
    named,
    place_of,
    verdict_prose,
    worst_by_part,
    worst_table,
)
from calm.report.check_tables import likelihood_tables
from calm.report.provenance import UNSEEN

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment
    from calm.report.check_facts import CheckFacts

_SIGNS = {State.FAIL: "!", State.WARN: "~", State.UNKNOWN: "?"}
_TOLD = 12
"""Most failures, or warnings, shown of a mooring; a report has them all."""
_LACKING = 60
"""Most components named that lack a figure."""


def check_part(assessments: Sequence[Assessment]) -> ReportPart:
    """Everything that a design check says in short.

    Moorings by environments with the worst state in each; what decides, what is accepted and what
    departs of each; of each rule the finding with the worst margin; every failure and warning with
    its figures and remedy. No rule hangs on colour.
    """
    sections = [judged_section(each) for each in assessments]
    facts = [each.facts for each in sections if each.facts is not None]
    blocks = (
        *(replace(each, title="", note="") for each in matrix_tables(sections)),
        verdict_prose(finding for each in facts for finding in each.findings),
        *(block for each in facts for block in _decisive(each, several=len(facts) > 1)),
        replace(worst_table(sections), title=""),
        *likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments]),
        *(block for each in facts for block in _told(each)),
    )
    return ReportPart("", (*blocks, Note(UNSEEN[:1])))


def _decisive(facts: CheckFacts, *, several: bool) -> Iterator[Block]:
    """What decides of a mooring, what is accepted, and what departs."""
    if several:
        yield Heading(facts.mooring)
    yield key_pairs(facts)
    yield from settled_tables(facts)


def _told(facts: CheckFacts) -> Iterator[Block]:
    """Return what a mooring fails or is warned of, the gravest first with its remedy; what is
    missing.
    """
    listed = [each for each in worst_by_part(facts.findings) if each.state in _SIGNS]
    if not listed:
        return
    lines: list[Line] = []
    for state, group in groupby(listed, key=lambda finding: finding.state):
        findings = list(group)
        if state is State.UNKNOWN:
            lines += _missing(findings)
            continue
        lines += map(_sentence, findings[:_TOLD])
        if len(findings) > _TOLD:
            lines.append(f"  and {len(findings) - _TOLD} more that {state}; --json has them")
    yield Heading(facts.mooring)
    yield Prose(tuple(lines))


def _sentence(finding: Finding) -> Line:
    sign = Span(f"{_SIGNS[finding.state]} ", finding.state)
    found = Span(f"{finding.rule}, {place_of(finding)}: {finding.message}")
    if not finding.remedy:
        return sign, found
    return sign, found, Span(f" {finding.remedy}", quiet=finding.state is not State.FAIL)


def _missing(findings: Sequence[Finding]) -> Iterator[Line]:
    """One sentence for each figure that is missing, with the components that lack it."""
    groups: dict[tuple[str, str], dict[str, None]] = {}
    for finding in findings:
        if finding.component is None:
            yield (Span(f"? {finding.rule}: {finding.message} {finding.remedy}", quiet=True),)
            continue
        lacking = groups.setdefault((finding.rule, finding.remedy or ""), {})
        lacking[finding.component] = None
    for (rule, remedy), names in groups.items():
        yield (Span(f"? {rule} of {named(names, _LACKING)} is unknown. {remedy}", quiet=True),)
