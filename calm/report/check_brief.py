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
from calm.report.check_facts import judged_section, key_pairs, settled_tables
from calm.report.check_summary import (
    joined,
    matrix_tables,
    named,
    named_components,
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
    listed = joined(one for one in worst_by_part(facts.findings) if one.state in _SIGNS)
    if not listed:
        return
    lines: list[Line] = []
    for state, groups in groupby(listed, key=lambda found: found[0].state):
        found = list(groups)
        most = len(found) if state is State.UNKNOWN else _TOLD
        lines += map(_sentence, found[:most])
        if len(found) > most:
            lines.append(f"  and {len(found) - most} more that {state}; --json has them")
    yield Heading(facts.mooring)
    yield Prose(tuple(lines))


def _sentence(found: Sequence[Finding]) -> Line:
    """What is found alike of some components, told of the worst of them."""
    worst = found[0]
    sign, quiet = Span(f"{_SIGNS[worst.state]} ", worst.state), worst.state is not State.FAIL
    if worst.state is State.UNKNOWN and worst.component is not None:
        names = named((one.component or "" for one in found), _LACKING)
        return sign, Span(f"{worst.rule} of {names} is unknown. {worst.remedy}", quiet=True)
    others = "" if len(found) == 1 else f" The same holds for {named_components(found[1:])}."
    told = Span(f"{worst.rule}, {place_of(worst)}: {worst.message}{others}")
    return (sign, told, Span(f" {worst.remedy}", quiet=quiet)) if worst.remedy else (sign, told)
