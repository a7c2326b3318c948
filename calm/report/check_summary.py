"""The worst of many findings: of a rule in an environment, of a mooring, of a whole check."""

import math
import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from functools import partial
from itertools import groupby
from operator import attrgetter
from typing import TypeVar

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.criterion import said
from calm.checks.finding import AS_GIVEN, OWN, Finding, State, worst_state
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.report import blocks
from calm.report.blocks import ON_THE_WAY, Cell, Field, Prose, Section, Span, Table, Worst, words

Item = TypeVar("Item")

_ABREAST = 5
"""Environments beside each other in a table; more of them take another table."""

_rank = attrgetter("rank")


def figure_of(finding: Finding, name: str) -> str:
    """The value, limit or margin of a finding with its unit; nothing where it is unknown."""
    value = getattr(finding, name)
    if value is None:
        return ""
    text = QUANTITIES[RULES[finding.rule].quantity].say(value)
    return text if name != "margin" or text.startswith("-") else f"+{text}"


STATE = words("state", lambda one: Cell(one.state.value, state=one.state), 0.0)
VALUE, LIMIT, MARGIN = (
    blocks.number(name, partial(figure_of, name=name)) for name in ("value", "limit", "margin")
)
"""Columns of findings."""


def place_of(finding: Finding) -> str:
    """The environment, and what was changed in it."""
    changed = "" if finding.situation == AS_GIVEN else f", {finding.situation}"
    return f"{finding.environment}{changed}"


def worst_by_rule(assessment: Assessment) -> tuple[Worst, ...]:
    """The worst finding of each rule in each column of the summary."""
    columns = [
        (stand.environment, (*stand.findings, *stand.tighter)) for stand in assessment.stands
    ]
    return tuple(
        Worst(column, min(group, key=_rank), sum(one.state is State.UNKNOWN for one in group))
        for column, findings in (*columns, (ON_THE_WAY, assessment.findings))
        for group in grouped(findings, lambda each: each.rule)
    )


def worst_by_part(findings: Iterable[Finding]) -> list[Finding]:
    """The worst finding of each rule on each component, the gravest first."""
    groups = grouped(findings, lambda each: (each.rule, each.place))
    return sorted((min(group, key=_rank) for group in groups), key=_rank)


def rules_tables(columns: Sequence[str], found: Sequence[Worst]) -> Iterator[Table]:
    """Rules by environments: state, margin and component of the worst finding of each."""
    rows = [
        (rule.title, [each for each in found if each.finding.rule == rule.name])
        for rule in RULES.values()
    ]
    note = "Under each state: the least margin, its component, and what is unknown."
    return _states("Rules by environment", columns, rows, note,
                   lambda one: f"{figure_of(one, 'margin')} {one.component or ''}")  # fmt: skip


def matrix_tables(sections: Sequence[Section]) -> Iterator[Table]:
    """Moorings by environments: the worst state in each, the rule that makes it, and its margin."""
    every = dict.fromkeys(column for section in sections for column in section.columns)
    every.pop(ON_THE_WAY, None)
    rows = [(section.name, section.worst) for section in sections]
    note = "Under each state: the rule that makes it, its least margin, and how many unknown."
    return _states("Moorings by environment", (*every, ON_THE_WAY), rows, note,
                   lambda one: f"{RULES[one.rule].title} {figure_of(one, 'margin')}")  # fmt: skip


def _states(
    title: str,
    columns: Sequence[str],
    rows: Iterable[tuple[str, Sequence[Worst]]],
    note: str,
    detail: Callable[[Finding], str],
) -> Iterator[Table]:
    """Tables of the worst state of each row, a name and what was found of it, in each column.

    The detail of a state stands under it.
    """

    def cell(row: tuple[str, Sequence[Worst]], column: str) -> Cell:
        found = [each for each in row[1] if each.column == column]
        if not found:
            return Cell("–")
        finding = min((each.finding for each in found), key=_rank)
        missing = sum(each.unknown for each in found)
        texts = (detail(finding).strip(), f"{missing} unknown" if missing else "")
        return Cell(finding.state.value, "; ".join(filter(None, texts)), finding.state)

    size = math.ceil(len(columns) / math.ceil(len(columns) / _ABREAST))  # of groups much the same
    for start in range(0, len(columns), size):
        beside = columns[start : start + size]
        yield blocks.table_of(
            title,
            [row for row in rows if any(each.column in beside for each in row[1])],
            words(title.split()[0].lower().removesuffix("s"), lambda row: row[0]),
            *(words(name, partial(cell, column=name)) for name in beside),
            note=note,
        )


def worst_table(sections: Sequence[Section]) -> Table:
    """Each rule with the worst of all its findings, and in how many moorings it fails or warns."""
    several, rows = len(sections) > 1, []
    for name in RULES:
        found = [(one.name, each) for one in sections for each in one.worst]
        found = [(mooring, each) for mooring, each in found if each.finding.rule == name]
        if found:
            states = {(mooring, each.finding.state) for mooring, each in found}
            counts = Counter(state for _, state in states) if several else Counter[State]()
            worst = min((each.finding for _, each in found), key=_rank)
            rows.append((worst, sum(each.unknown for _, each in found), counts))

    def in_so_many(heading: str, state: State) -> Field:
        return blocks.number(heading, lambda row: row[2][state] or None, narrow=False)

    return blocks.table_of(
        "Worst finding of each rule",
        rows,
        *blocks.of_first(words("rule", share=0.0), STATE, VALUE, LIMIT, MARGIN),
        blocks.number("unknown", lambda row: row[1] or None, short="?"),
        in_so_many("moorings that fail", State.FAIL),
        in_so_many("that warn", State.WARN),
        words("where", lambda row: _where(row[0], several)),
        sortable=True,
    )


def _where(finding: Finding, several: bool) -> str:
    """The component, with mooring, environment and situation where they are not plain."""
    places = [finding.component, finding.mooring if several else None]
    if several or finding.environment != OWN or finding.situation != AS_GIVEN:
        places.append(place_of(finding))
    return ", ".join(filter(None, places))


def grouped(items: Iterable[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """Return the items of each key together, in the order in which the keys come."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def joined(findings: Iterable[Finding]) -> list[list[Finding]]:
    """Return together the findings of one rule that say the same of several components."""
    return grouped(findings, lambda one: (one.rule, one.state, _wording(one)))


def _wording(finding: Finding) -> str:
    """What a finding says and advises, without its component and figures."""
    text = f"{finding.message} {finding.remedy or ''}"
    if finding.component is not None:
        text = text.replace(finding.component, "")
    return re.sub(r"\d[\d.]*", "#", text)


def rules_of(findings: Iterable[Finding]) -> list[str]:
    """The titles of the rules of some findings, each once."""
    return list(dict.fromkeys(RULES[one.rule].title for one in findings))


def named(labels: Iterable[str], most: int = 3) -> str:
    """Name labels, each once, such as ``glass 1 to 4, cable``.

    Of more than `most` names, successive numbers as one, how many are left is said.
    """
    numbered: dict[str, list[int]] = {}
    for label in labels:
        match = re.fullmatch(r"(.+ )([1-9]\d{0,5})", label)
        stem, number = match.groups() if match else (label, "0")
        numbered.setdefault(stem, []).append(int(number))
    runs = [run for stem, numbers in numbered.items() for run in _runs(stem, numbers)]
    left = sum(count for _, count in runs[most:])
    return ", ".join(name for name, _ in runs[:most]) + (f" and {left} more" if left else "")


def _runs(stem: str, numbers: Iterable[int]) -> Iterator[tuple[str, int]]:
    """Name each run of successive numbers, and count what it stands for."""
    each = sorted(set(numbers))
    for _, group in groupby(enumerate(each), lambda pair: pair[1] - pair[0]):
        run = [number for _, number in group]
        last = f"{' and ' if len(run) == 2 else ' to '}{run[-1]}" if len(run) > 1 else ""
        yield f"{stem}{run[0] or ''}{last}", len(run)


def named_components(findings: Iterable[Finding]) -> str:
    """Name the components of some findings."""
    return named(one.component or "whole line" for one in findings)


def said_of(finding: Finding) -> Cell:
    """Return what was found and what to do; the figures of a pass say it all, and so does a remedy
    that names the figure missing."""
    if finding.state is State.PASS:
        return Cell()
    if finding.state is State.UNKNOWN and finding.remedy:
        return Cell(finding.remedy)
    return Cell(finding.message, finding.remedy or "")


SIGNS = dict(zip(reversed(State), "!?~≈◦✓", strict=True))
"""What stands before a verdict."""


def counted_states(findings: Iterable[Finding]) -> Counter[State]:
    """How many parts of one or several moorings each state is the worst of, rule by rule.

    A missing figure of a component is counted once.
    """
    by_mooring = grouped(findings, attrgetter("mooring"))
    return Counter(one.state for each in by_mooring for one in worst_by_part(each))


def verdict_of(findings: Iterable[Finding]) -> tuple[State, str]:
    """The worst state of one or several moorings, and the verdict in words."""
    findings = list(findings)
    counts = counted_states(findings)
    unsigned = [one for one in findings if one.accept is not None and one.accept.by is None]
    nobody = len(worst_by_part(unsigned))
    # what is accepted may be a failure, and not only unknown
    failing = any(one.accept is not None and (one.margin or 0.0) < 0.0 for one in findings)
    other = "else " if failing else ""
    state = worst_state(counts)
    told = [
        _counted(counts[State.FAIL], "failure") if counts[State.FAIL] else f"nothing {other}fails",
        _counted(counts[State.UNKNOWN], "figure") + " unknown" if counts[State.UNKNOWN] else "",
        _counted(counts[State.WARN], "warning") if counts[State.WARN] else "",
        f"{counts[State.ESTIMATED]} estimated" if counts[State.ESTIMATED] else "",
        f"{counts[State.ACCEPTED]} accepted" if counts[State.ACCEPTED] else "",
        f"{nobody} of them by nobody" if nobody else "",
    ]
    return state, ", ".join(filter(None, told))


def verdict_prose(findings: Iterable[Finding]) -> Prose:
    """The verdict with its sign, such as ``? nothing fails, 34 figures unknown``."""
    state, told = verdict_of(findings)
    return Prose(((Span(f"{SIGNS[state]} {told}", state),),), state)


def short_verdict(findings: Iterable[Finding]) -> Span:
    """The verdict for the head of a page, such as ``? 0 fail, 34 unknown, 1 warn``."""
    given = [*findings]
    counts = Counter(finding.state for finding in given)
    states = (State.FAIL, State.UNKNOWN, State.WARN)
    state, _ = verdict_of(given)
    return Span(f"{SIGNS[state]} {', '.join(f'{counts[one]} {one}' for one in states)}", state)


def limits_table(limits: Iterable[LimitKey], title: str = "Limits as used") -> Table:
    """Limits with their defaults and the sources of those; departures come first."""
    departs = Cell("departs", state=State.WARN)
    return blocks.table_of(
        title,
        sorted(limits, key=lambda key: not key.departs),
        words("", lambda key: departs if key.departs else None, 0.0),
        words("limit", "name", 1.2),
        blocks.number("as used", lambda key: said(key, key.value)),
        blocks.number("default", lambda key: said(key, key.default)),
        words("source of the default", "source", 2.0),
        note="A limit that departs from its default is the design's own; no source is given "
        "for it.",
    )


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"
