"""The worst of many findings: of a rule in an environment, of a mooring, of a whole check."""

import re
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import partial
from itertools import groupby
from operator import attrgetter
from typing import TypeVar

from calm.checks.assess import RULES
from calm.checks.criterion import said
from calm.checks.finding import AS_GIVEN, Finding, State, worst_of, worst_state
from calm.files.check_limits import LimitKey
from calm.quantities import QUANTITIES
from calm.report import blocks
from calm.report.blocks import Cell, Prose, Span, Table, words

Item = TypeVar("Item")


def figure_of(finding: Finding, name: str) -> str:
    """The value, limit or margin of a finding with its unit; nothing where it is unknown."""
    value = getattr(finding, name)
    if value is None:
        return ""
    text = QUANTITIES[RULES[finding.rule].quantity].say(value)
    return text if name != "margin" or text.startswith("-") else f"+{text}"


FIGURES = (
    words("state", lambda one: Cell(one.state.value, state=one.state), 0.0),
    *(blocks.number(name, partial(figure_of, name=name)) for name in ("value", "limit", "margin")),
)
"""Columns of findings."""


def place_of(finding: Finding) -> str:
    """The environment, and what was changed in it."""
    changed = "" if finding.situation == AS_GIVEN else f", {finding.situation}"
    return f"{finding.environment}{changed}"


def worst_by_part(findings: Iterable[Finding]) -> list[Finding]:
    """The worst finding of each rule on each component, the gravest first."""
    groups = grouped(findings, lambda each: (each.rule, each.place))
    return sorted(map(worst_of, groups), key=attrgetter("rank"))


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
    return Prose(((Span(f"{state.sign} {told}", state),),), state)


def short_verdict(findings: Iterable[Finding]) -> Span:
    """The verdict for the head of a page, such as ``? 0 fail, 34 unknown, 1 warn``."""
    given = [*findings]
    counts = Counter(finding.state for finding in given)
    states = (State.FAIL, State.UNKNOWN, State.WARN)
    state, _ = verdict_of(given)
    return Span(f"{state.sign} {', '.join(f'{counts[one]} {one}' for one in states)}", state)


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
