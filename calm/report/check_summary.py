"""The worst of many findings: of a rule in an environment, of a mooring, of a whole check."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from calm.checks.criterion import said
from calm.checks.finding import AS_GIVEN, Finding, State, worst_state
from calm.checks.rules import RULES
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.report.blocks import ON_THE_WAY, Cell, Column, Prose, Section, Table, Worst, table_of

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment

_ABREAST = 5
"""Environments beside each other in a table; more of them take another table."""


def _rank(finding: Finding) -> tuple[int, float]:
    return finding.rank


def say_in_unit(finding: Finding, value: float | None) -> str:
    """A value, limit or margin of a finding with its unit; nothing where it is unknown."""
    return "" if value is None else QUANTITIES[RULES[finding.rule].quantity].say(value)


def margin_of(finding: Finding) -> str:
    """The margin with its sign and unit."""
    text = say_in_unit(finding, finding.margin)
    return text if not text or text.startswith("-") else f"+{text}"


def place_of(finding: Finding) -> str:
    """The environment, and what was changed in it."""
    if finding.situation == AS_GIVEN:
        return finding.environment
    return f"{finding.environment}, {finding.situation}"


def worst_by_rule(assessment: Assessment) -> tuple[Worst, ...]:
    """The worst finding of each rule in each column of the summary."""
    columns = [
        (stand.environment, (*stand.findings, *stand.tighter)) for stand in assessment.stands
    ]
    columns.append((ON_THE_WAY, assessment.findings))
    return tuple(
        Worst(column, min(group, key=_rank), unknown_count(group))
        for column, findings in columns
        for group in _groups(findings, lambda each: each.rule)
    )


def worst_by_part(findings: Iterable[Finding]) -> list[Finding]:
    """The worst finding of each rule on each component, the gravest first."""
    groups = _groups(findings, lambda each: (each.rule, each.place))
    return sorted((min(group, key=_rank) for group in groups), key=_rank)


def rules_tables(columns: Sequence[str], found: Sequence[Worst]) -> Iterator[Table]:
    """Rules by environments: state, margin and component of the worst finding of each."""
    cells = {(each.column, each.finding.rule): each for each in found}
    for beside in abreast(columns):
        rules = [
            rule for rule in RULES.values() if any((one, rule.name) in cells for one in beside)
        ]
        rows = tuple(
            (Cell(rule.title), *(_judged(cells.get((one, rule.name))) for one in beside))
            for rule in rules
        )
        yield Table("Rules by environment", _headed("rule", beside), rows, _RULES_NOTE)


def matrix_tables(sections: Sequence[Section]) -> Iterator[Table]:
    """Moorings by environments: the worst state in each, the rule that makes it, and its margin."""
    every = dict.fromkeys(column for section in sections for column in section.columns)
    every.pop(ON_THE_WAY, None)
    for beside in abreast([*every, ON_THE_WAY]):
        rows = tuple(
            (Cell(section.name), *(_of_column(section, column) for column in beside))
            for section in sections
        )
        yield Table("Moorings by environment", _headed("mooring", beside), rows, _MATRIX_NOTE)


def worst_table(sections: Sequence[Section]) -> Table:
    """Each rule with the worst of all its findings, and in how many moorings it fails or warns."""
    found: dict[str, list[tuple[Section, Finding]]] = {}
    missing: Counter[str] = Counter()
    for section in sections:
        for each in section.worst:
            found.setdefault(each.finding.rule, []).append((section, each.finding))
            missing[each.finding.rule] += each.unknown
    rows = []
    for rule in RULES.values():
        if rule.name not in found:
            continue
        section, finding = min(found[rule.name], key=lambda pair: pair[1].rank)
        rows.append(
            (
                Cell(finding.state.value, state=finding.state),
                Cell(rule.title),
                Cell(say_in_unit(finding, finding.value)),
                Cell(say_in_unit(finding, finding.limit)),
                Cell(margin_of(finding)),
                Cell(section.name, finding.component or ""),
                Cell(place_of(finding)),
                Cell(_moorings(found[rule.name], State.FAIL)),
                Cell(_moorings(found[rule.name], State.WARN)),
                Cell(str(missing[rule.name])),
            )
        )
    columns = (
        Column("state", share=0.0),
        Column("rule"),
        Column("value", numeric=True),
        Column("limit", numeric=True),
        Column("margin", numeric=True),
        Column("mooring, component"),
        Column("environment"),
        Column("moorings that fail", numeric=True),
        Column("that warn", numeric=True),
        Column("figures unknown", numeric=True),
    )
    return Table("Worst finding of each rule", columns, tuple(rows), sortable=True)


def failures(sections: Sequence[Section]) -> Table | Prose:
    """Every rule that a mooring fails, with its worst finding and the remedy."""
    failed = [
        (section.name, min(group, key=_rank), len(group) - 1)
        for section in sections
        for group in _groups(
            (each.finding for each in section.worst if each.finding.state is State.FAIL),
            lambda each: each.rule,
        )
    ]
    if not failed:
        if _failing_accepted(each.finding for section in sections for each in section.worst):
            return Prose(("No rule fails but what is accepted.",), State.ACCEPTED)
        return Prose(("No rule fails.",), State.PASS)
    return table_of(
        "Failures",
        failed,
        (Column("mooring"), lambda one: one[0]),
        (Column("rule"), lambda one: RULES[one[1].rule].title),
        (
            Column("environment"),
            lambda one: Cell(place_of(one[1]), f"and {one[2]} more" if one[2] else ""),
        ),
        (
            Column("finding and remedy", share=2.5),
            lambda one: Cell(one[1].message, one[1].remedy or ""),
        ),
    )


_RULES_NOTE = "Under each state: the least margin, the component that has it, and what is unknown."
_MATRIX_NOTE = (
    "Under each state: the rule that makes it, its least margin, and how many are unknown."
)


def _headed(first: str, columns: Sequence[str]) -> tuple[Column, ...]:
    return (Column(first), *map(Column, columns))


def _judged(worst: Worst | None) -> Cell:
    if worst is None:
        return Cell("–")
    finding = worst.finding
    detail = " ".join(filter(None, (margin_of(finding), finding.component)))
    return Cell(finding.state.value, _with_unknown(detail, worst.unknown), finding.state)


def _of_column(section: Section, column: str) -> Cell:
    here = [each for each in section.worst if each.column == column]
    if not here:
        return Cell("–")
    finding = min((each.finding for each in here), key=_rank)
    detail = f"{RULES[finding.rule].title} {margin_of(finding)}".rstrip()
    missing = sum(each.unknown for each in here)
    return Cell(finding.state.value, _with_unknown(detail, missing), finding.state)


def _with_unknown(detail: str, count: int) -> str:
    """The detail, and how many findings are unknown."""
    return "; ".join(filter(None, (detail, f"{count} unknown" if count else "")))


def unknown_count(findings: Iterable[Finding]) -> int:
    """Return how many of the findings are unknown."""
    return sum(finding.state is State.UNKNOWN for finding in findings)


def _moorings(found: Sequence[tuple[Section, Finding]], state: State) -> str:
    return str(len({section.name for section, finding in found if finding.state is state}))


def abreast(columns: Sequence[str]) -> Iterator[Sequence[str]]:
    """The columns in groups of about the same size that fit the width of a page."""
    groups = math.ceil(len(columns) / _ABREAST)
    size = math.ceil(len(columns) / groups)
    for start in range(0, len(columns), size):
        yield columns[start : start + size]


def _groups(findings: Iterable[Finding], key: Callable[[Finding], Hashable]) -> list[list[Finding]]:
    groups: dict[Hashable, list[Finding]] = {}
    for finding in findings:
        groups.setdefault(key(finding), []).append(finding)
    return list(groups.values())


SIGNS = {
    State.FAIL: "!",
    State.UNKNOWN: "?",
    State.WARN: "~",
    State.ACCEPTED: "◦",
    State.ESTIMATED: "≈",
    State.PASS: "✓",
}
"""What stands before a verdict."""


def counted_states(findings: Iterable[Finding]) -> Counter[State]:
    """How many parts of one or several moorings each state is the worst of, rule by rule.

    A missing figure of a component is counted once.
    """
    by_mooring: dict[str, list[Finding]] = {}
    for finding in findings:
        by_mooring.setdefault(finding.mooring, []).append(finding)
    return Counter(one.state for each in by_mooring.values() for one in worst_by_part(each))


def verdict_of(findings: Iterable[Finding]) -> tuple[State, str]:
    """The worst state of one or several moorings, and the verdict in words."""
    findings = list(findings)
    counts = counted_states(findings)
    unsigned = [one for one in findings if one.accept is not None and one.accept.by is None]
    nobody, other = len(worst_by_part(unsigned)), "else " if _failing_accepted(findings) else ""
    state = worst_state(counts)
    words = [
        _counted(counts[State.FAIL], "failure") if counts[State.FAIL] else f"nothing {other}fails",
        _counted(counts[State.UNKNOWN], "figure") + " unknown" if counts[State.UNKNOWN] else "",
        _counted(counts[State.WARN], "warning") if counts[State.WARN] else "",
        f"{counts[State.ESTIMATED]} estimated" if counts[State.ESTIMATED] else "",
        f"{counts[State.ACCEPTED]} accepted" if counts[State.ACCEPTED] else "",
        f"{nobody} of them by nobody" if nobody else "",
    ]
    return state, ", ".join(word for word in words if word)


def _failing_accepted(findings: Iterable[Finding]) -> bool:
    """Return whether what is accepted is a failure, and not only unknown."""
    return any(one.accept is not None and (one.margin or 0.0) < 0.0 for one in findings)


def verdict_prose(findings: Iterable[Finding]) -> Prose:
    """The verdict with its sign, such as ``? nothing fails, 34 figures unknown``."""
    state, words = verdict_of(findings)
    return Prose((f"{SIGNS[state]} {words}",), state)


def accepted_table(moorings: Sequence[tuple[str, Sequence[Finding]]]) -> Table | None:
    """Return what is accepted of each mooring, with its reason; None where nothing is."""
    accepted = [
        (name, finding, accept)
        for name, findings in moorings
        for finding in findings
        if (accept := finding.accept) is not None
    ]
    if not accepted:
        return None
    state = Cell(State.ACCEPTED.value, state=State.ACCEPTED)
    return table_of(
        "Accepted with a reason",
        accepted,
        (Column("state", share=0.0), lambda one: state),
        (Column("mooring"), lambda one: one[0]),
        (
            Column("rule, component"),
            lambda one: Cell(RULES[one[1].rule].title, one[1].component or "whole line"),
        ),
        (Column("finding", share=1.5), lambda one: one[1].message),
        (Column("reason", share=1.5), lambda one: one[2].reason),
        (Column("by, on"), lambda one: Cell(one[2].by or "-", one[2].date or "")),
        (Column("until", share=0.0), lambda one: one[2].until or "for good"),
    )


def limits_table(moorings: Sequence[tuple[str, Sequence[LimitKey]]]) -> Table:
    """The limits as used, with their defaults and the sources of those; departures come first."""
    limits = [
        (name, key)
        for name, keys in moorings
        for key in sorted(keys, key=lambda key: not key.departs)
    ]
    departs = Cell("departs", state=State.WARN)
    return table_of(
        "Limits as used",
        limits,
        (Column("", share=0.0), lambda one: departs if one[1].departs else ""),
        (Column("mooring"), lambda one: one[0]),
        (Column("limit"), lambda one: one[1].name),
        (Column("as used", numeric=True), lambda one: said(one[1], one[1].value)),
        (Column("default", numeric=True), lambda one: said(one[1], one[1].default)),
        (Column("source of the default", share=2.0), lambda one: one[1].source),
        note="A limit that departs from its default is the design's own; no source stands for it.",
    )


def unknown_table(findings: Iterable[Finding]) -> Table | None:
    """Return what is unknown, piece by piece, and which figure would settle it; None where nothing
    is.
    """
    unknown = [each for each in worst_by_part(findings) if each.state is State.UNKNOWN]
    if not unknown:
        return None
    return table_of(
        "Unknown, piece by piece",
        _groups(unknown, lambda each: each.component),
        (Column("component"), lambda found: found[0].component or "whole line"),
        (
            Column("not judged by"),
            lambda found: ", ".join(RULES[one.rule].title for one in found),
        ),
        (
            Column("what would settle it", share=1.5),
            lambda found: " ".join(dict.fromkeys(one.remedy for one in found if one.remedy)),
        ),
        (Column("what it bears or stands there", share=1.5), _known_values),
        sortable=True,
    )


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"


def _known_values(found: Iterable[Finding]) -> str:
    """The values of some findings with where they are."""
    known = (one for one in found if one.value is not None)
    return ", ".join(f"{say_in_unit(one, one.value)} ({place_of(one)})" for one in known)
