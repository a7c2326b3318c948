"""The design check in short: the matrix, the worst of each rule, what to mend."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from calm.checks.criterion import said
from calm.checks.finding import AS_GIVEN, OWN, Finding, State
from calm.checks.rules import RULES
from calm.report.blocks import (
    ON_THE_WAY,
    Block,
    Cell,
    Column,
    Heading,
    Line,
    Note,
    Prose,
    ReportPart,
    Span,
    Table,
)
from calm.report.check_summary import (
    SIGNS,
    abreast,
    margin_of,
    place_of,
    say_in_unit,
    unknown_count,
    verdict_of,
    worst_by_part,
)
from calm.report.check_tables import likelihood_tables
from calm.report.provenance import UNSEEN

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment

_SIGNS = {State.FAIL: "!", State.WARN: "~", State.UNKNOWN: "?"}
_TOLD = 12
"""Most failures, or warnings, shown of a mooring; a report has them all."""
_NAMED = 3
"""Most components named for one reason of acceptance."""
_LACKING = 60
"""Most components named that lack a figure."""


def check_part(assessments: Sequence[Assessment]) -> ReportPart:
    """Everything that a design check says in short.

    Moorings by environments with the worst state in each; of each rule the finding with the worst
    margin; every failure and warning with its figures and remedy. No rule hangs on colour.
    """
    every = [
        finding
        for each in assessments
        for finding in (*each.all_findings(), *each.tighter_findings())
    ]
    reported = (
        block
        for each in assessments
        for block in (*_told(each), *_worded(_accepted(each)), *_worded(_departing(each)))
    )
    likely = likelihood_tables([(each.name, [*each.all_findings()]) for each in assessments])
    blocks = (
        *_matrix(assessments),
        _verdict(every),
        _worst(assessments, every),
        *likely,
        *reported,
    )
    return ReportPart("", (*blocks, Note(UNSEEN[:1])))


def _verdict(findings: Sequence[Finding]) -> Prose:
    state, words = verdict_of(findings)
    return Prose(((Span(f"{SIGNS[state]} {words}", state),),))


def _worded(lines: Iterator[Span]) -> Iterator[Prose]:
    spans = tuple((line,) for line in lines)
    if spans:
        yield Prose(spans)


def _accepted(assessment: Assessment) -> Iterator[Span]:
    """Return what is accepted, and why: a sentence for each reason, with the components it is
    for.
    """
    reasons: dict[tuple[str, str], list[str]] = {}
    for finding in assessment.accepted_findings():
        accept = finding.accept
        assert accept is not None
        ends = f" Until {accept.until}." if accept.until else ""
        by = ", ".join(filter(None, (accept.by, accept.date)))
        why = f"{accept.reason}{f' ({by})' if by else ''}.{ends}"
        reasons.setdefault((finding.rule, why), []).append(finding.component or "the line")
    for (rule, why), labels in reasons.items():
        named = _named(labels, _NAMED)
        yield Span(f"{SIGNS[State.ACCEPTED]} {rule} of {named} is accepted: {why}", quiet=True)


def _named(labels: Sequence[str], most: int) -> str:
    more = f" and {len(labels) - most} more" if len(labels) > most else ""
    return ", ".join(labels[:most]) + more


def _departing(assessment: Assessment) -> Iterator[Span]:
    """The limits that depart from their defaults."""
    for key in assessment.limits:
        if key.departs:
            yield Span(
                f"~ The limit {key.name} is {said(key, key.value)}; its default is "
                f"{said(key, key.default)} ({key.source}).",
                State.WARN,
            )


def _matrix(assessments: Sequence[Assessment]) -> Iterator[Table]:
    columns = list(
        dict.fromkeys(stand.environment for each in assessments for stand in each.stands)
    )
    for beside in abreast(columns):
        rows = []
        for each in assessments:
            found = {stand.environment: (*stand.findings, *stand.tighter) for stand in each.stands}
            cells = [found.get(column) for column in beside]
            rows.append((Cell(each.name), *map(_state, (*cells, each.findings))))
        yield Table("", tuple(map(Column, ("mooring", *beside, ON_THE_WAY))), tuple(rows))


def _state(findings: Sequence[Finding] | None) -> Cell:
    """The worst state, the rule that makes it, and how much is unknown besides."""
    if not findings:
        return Cell("-")
    worst = min(findings, key=lambda finding: finding.rank)
    text = worst.state.value
    if worst.state in (State.FAIL, State.WARN):
        text += f" {worst.rule}"
    missing = unknown_count(findings)
    if missing and worst.state is not State.UNKNOWN:
        text += f", {missing} ?"
    return Cell(text, state=worst.state)


def _worst(assessments: Sequence[Assessment], findings: Sequence[Finding]) -> Table:
    """Each rule with its finding of the worst margin, and how many of its figures are unknown."""
    columns = (
        *(Column(heading, share=0.0) for heading in ("rule", "state")),
        *(Column(heading, numeric=True) for heading in ("value", "limit", "margin", "unknown")),
        Column("where"),
    )
    several = len(assessments) > 1
    rows = []
    for rule in RULES.values():
        found = [finding for finding in findings if finding.rule == rule.name]
        if not found:
            continue
        worst, missing = min(found, key=lambda finding: finding.rank), unknown_count(found)
        rows.append(
            (
                Cell(rule.name),
                Cell(worst.state.value, state=worst.state),
                Cell(say_in_unit(worst, worst.value)),
                Cell(say_in_unit(worst, worst.limit)),
                Cell(margin_of(worst)),
                Cell(str(missing) if missing else ""),
                Cell(_where(worst, several)),
            )
        )
    return Table("", columns, tuple(rows))


def _where(finding: Finding, several: bool) -> str:
    """The component, with mooring, environment and situation where they are not plain."""
    places = [finding.component, finding.mooring if several else None]
    if several or finding.environment != OWN or finding.situation != AS_GIVEN:
        places.append(place_of(finding))
    return ", ".join(filter(None, places))


def _told(assessment: Assessment) -> Iterator[Block]:
    """Return what a mooring fails or is warned of, the gravest first with its remedy; what is
    missing.
    """
    every = (*assessment.all_findings(), *assessment.tighter_findings())
    listed = [each for each in worst_by_part(every) if each.state in _SIGNS]
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
    yield Heading(assessment.name)
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
        named = _named(list(names), _LACKING)
        yield (Span(f"? {rule} of {named} is unknown. {remedy}", quiet=True),)
