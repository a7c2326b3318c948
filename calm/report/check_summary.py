"""A design check on a terminal: what decides, what is open, and what is not covered."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

from calm.checks.assessment import Assessment
from calm.checks.finding import Finding, State
from calm.report import blocks, check_facts, check_tables, provenance
from calm.report.blocks import Prose, Span
from calm.report.check_facts import CheckFacts
from calm.report.check_tables import place_of
from calm.report.likelihood import likelihood_tables

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
