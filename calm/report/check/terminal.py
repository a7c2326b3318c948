"""The design check as a terminal shows it: the matrix, the worst of each rule, what to mend."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from calm.checks.assess import OWN
from calm.checks.finding import AS_GIVEN, Finding, State
from calm.checks.limits import said
from calm.checks.rules import RULES
from calm.report.check.summary import (
    abreast,
    margin_of,
    place_of,
    say_in_unit,
    unknown_count,
    worst_by_part,
)
from calm.report.check.verdict import SIGNS, verdict_of
from calm.report.result_tables import UNSEEN
from calm.report.section import ON_THE_WAY
from calm.report.terminal import WARNED, plain_table

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment

STYLES = {
    State.PASS: "green",
    State.ACCEPTED: "",
    State.WARN: "yellow",
    State.UNKNOWN: "bold",
    State.FAIL: WARNED,
}
"""How a state looks; its word tells it without colour."""

_SIGNS = {State.FAIL: "!", State.WARN: "~", State.UNKNOWN: "?"}
_TOLD = 12
"""So many failures, or warnings, are told of a mooring; a report has them all."""
_NAMED = 3


def check_table(assessments: Sequence[Assessment]) -> RenderableType:
    """Everything that a design check says in short, for a rich console.

    Moorings by environments with the worst state in each; of each rule the finding with the worst
    margin; every failure and warning with its figures and remedy. No rule hangs on colour.
    """
    every = [
        finding
        for each in assessments
        for finding in (*each.all_findings(), *each.tighter_findings())
    ]
    parts: list[RenderableType] = [*_matrix(assessments), Text(), _verdict(every), Text()]
    parts.append(_worst(assessments, every))
    for each in assessments:
        parts += [*_told(each), *_accepted(each), *_departing(each)]
    parts += [Text(), Text(UNSEEN[0], style="dim")]
    return Group(*parts)


def _verdict(findings: Sequence[Finding]) -> Text:
    state, words = verdict_of(findings)
    return Text(f"{SIGNS[state]} {words}", style=STYLES[state])


def _accepted(assessment: Assessment) -> Iterator[Text]:
    """What is accepted, and why: a sentence for each reason, with the components it is for."""
    reasons: dict[tuple[str, str], list[str]] = {}
    for finding in assessment.accepted_findings():
        accept = finding.accept
        assert accept is not None
        ends = f" Until {accept.until}." if accept.until else ""
        by = ", ".join(filter(None, (accept.by, accept.date)))
        why = f"{accept.reason}{f' ({by})' if by else ''}.{ends}"
        reasons.setdefault((finding.rule, why), []).append(finding.component or "the line")
    for (rule, why), labels in reasons.items():
        sign = SIGNS[State.ACCEPTED]
        yield Text(f"{sign} {rule} of {', '.join(labels)} is accepted: {why}", style="dim")


def _departing(assessment: Assessment) -> Iterator[Text]:
    """The limits that depart from their defaults."""
    for key in assessment.limits:
        if key.departs:
            yield Text(
                f"~ The limit {key.name} is {said(key, key.value)}; its default is "
                f"{said(key, key.default)} ({key.source}).",
                style="yellow",
            )


def _matrix(assessments: Sequence[Assessment]) -> Iterator[RenderableType]:
    columns = list(
        dict.fromkeys(stand.environment for each in assessments for stand in each.stands)
    )
    for beside in abreast(columns):
        table = plain_table()
        table.add_column("mooring", overflow="fold")
        for column in (*beside, ON_THE_WAY):
            table.add_column(column, overflow="fold")
        for each in assessments:
            found = {stand.environment: (*stand.findings, *stand.tighter) for stand in each.stands}
            cells = [found.get(column) for column in beside]
            table.add_row(each.name, *map(_state, (*cells, each.findings)))
        yield table


def _state(findings: Sequence[Finding] | None) -> Text:
    """The worst state, the rule that makes it, and how much is unknown besides."""
    if not findings:
        return Text("-")
    worst = min(findings, key=lambda finding: finding.rank)
    text = worst.state.value
    if worst.state in (State.FAIL, State.WARN):
        text += f" {worst.rule}"
    missing = unknown_count(findings)
    if missing and worst.state is not State.UNKNOWN:
        text += f", {missing} ?"
    return Text(text, style=STYLES[worst.state])


def _worst(assessments: Sequence[Assessment], findings: Sequence[Finding]) -> Table:
    """Each rule with its finding of the worst margin, and how many of its figures are unknown."""
    table = plain_table()
    for heading in ("rule", "state"):
        table.add_column(heading, no_wrap=True)
    for heading in ("value", "limit", "margin", "unknown"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("where", overflow="fold")
    several = len(assessments) > 1
    for rule in RULES.values():
        found = [finding for finding in findings if finding.rule == rule.name]
        if not found:
            continue
        worst, missing = min(found, key=lambda finding: finding.rank), unknown_count(found)
        table.add_row(
            rule.name,
            Text(worst.state.value, style=STYLES[worst.state]),
            say_in_unit(worst, worst.value),
            say_in_unit(worst, worst.limit),
            margin_of(worst),
            str(missing) if missing else "",
            _where(worst, several),
        )
    return table


def _where(finding: Finding, several: bool) -> str:
    """The component, and what of mooring, environment and situation goes without saying not."""
    places = [finding.component, finding.mooring if several else None]
    if several or finding.environment != OWN or finding.situation != AS_GIVEN:
        places.append(place_of(finding))
    return ", ".join(filter(None, places))


def _told(assessment: Assessment) -> Iterator[RenderableType]:
    """What a mooring fails or is warned of, the gravest first with its remedy; what is missing."""
    every = (*assessment.all_findings(), *assessment.tighter_findings())
    listed = [each for each in worst_by_part(every) if each.state in _SIGNS]
    if not listed:
        return
    yield Text()
    yield Text(assessment.name, style="bold")
    for state, group in groupby(listed, key=lambda finding: finding.state):
        findings = list(group)
        if state is State.UNKNOWN:
            yield from _missing(findings)
            continue
        yield from map(_sentence, findings[:_TOLD])
        if len(findings) > _TOLD:
            yield Text(f"  and {len(findings) - _TOLD} more that {state}; --json has them")


def _sentence(finding: Finding) -> Text:
    text = Text(f"{_SIGNS[finding.state]} ", style=STYLES[finding.state])
    text.append(f"{finding.rule}, {place_of(finding)}: {finding.message}")
    if finding.remedy:
        text.append(f" {finding.remedy}", style="" if finding.state is State.FAIL else "dim")
    return text


def _missing(findings: Sequence[Finding]) -> Iterator[Text]:
    """One sentence for each figure that is missing, with the components that lack it."""
    groups: dict[tuple[str, str], dict[str, None]] = {}
    for finding in findings:
        if finding.component is None:
            yield Text(f"? {finding.rule}: {finding.message} {finding.remedy}", style="dim")
            continue
        lacking = groups.setdefault((finding.rule, finding.remedy or ""), {})
        lacking[finding.component] = None
    for (rule, remedy), names in groups.items():
        named = ", ".join(list(names)[:_NAMED])
        if len(names) > _NAMED:
            named += f" and {len(names) - _NAMED} more"
        yield Text(f"? {rule} of {named} is unknown. {remedy}", style="dim")
