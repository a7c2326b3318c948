"""What a design check concludes: the verdict in a line, what is accepted, by which limits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from calm.checks.criterion import said
from calm.checks.finding import State, worst_state
from calm.checks.rules import RULES
from calm.report.blocks import Cell, Column, Prose, Table
from calm.report.check.summary import place_of, say_in_unit, worst_by_part

if TYPE_CHECKING:
    from calm.checks.finding import Finding
    from calm.files.check_limits import LimitKey

SIGNS = {
    State.FAIL: "!",
    State.UNKNOWN: "?",
    State.WARN: "~",
    State.ACCEPTED: "◦",
    State.PASS: "✓",
}
"""What stands before a verdict."""


def verdict_of(findings: Iterable[Finding]) -> tuple[State, str]:
    """The worst state of one or several moorings, and the verdict in words.

    A missing figure of a component is counted once.
    """
    by_mooring: dict[str, list[Finding]] = {}
    for finding in findings:
        by_mooring.setdefault(finding.mooring, []).append(finding)
    counts = Counter(one.state for each in by_mooring.values() for one in worst_by_part(each))
    state = worst_state(counts)
    words = [
        _counted(counts[State.FAIL], "failure") if counts[State.FAIL] else "nothing fails",
        _counted(counts[State.UNKNOWN], "figure") + " unknown" if counts[State.UNKNOWN] else "",
        _counted(counts[State.WARN], "warning") if counts[State.WARN] else "",
        f"{counts[State.ACCEPTED]} accepted" if counts[State.ACCEPTED] else "",
    ]
    return state, ", ".join(word for word in words if word)


def verdict_prose(findings: Iterable[Finding]) -> Prose:
    """The verdict with its sign, such as ``? nothing fails, 34 figures unknown``."""
    state, words = verdict_of(findings)
    return Prose((f"{SIGNS[state]} {words}",), state)


def accepted_table(moorings: Sequence[tuple[str, Sequence[Finding]]]) -> Table | None:
    """What is accepted of each mooring, with its reason; None where nothing is."""
    rows = tuple(
        (
            Cell(State.ACCEPTED.value, state=State.ACCEPTED),
            Cell(name),
            Cell(RULES[finding.rule].title, finding.component or "whole line"),
            Cell(finding.message),
            Cell(accept.reason),
            Cell(accept.by or "-", accept.date or ""),
            Cell(accept.until or "for good"),
        )
        for name, findings in moorings
        for finding in findings
        if (accept := finding.accept) is not None
    )
    if not rows:
        return None
    columns = (
        Column("state", share=0.0),
        Column("mooring"),
        Column("rule, component"),
        Column("finding", share=1.5),
        Column("reason", share=1.5),
        Column("by, on"),
        Column("until", share=0.0),
    )
    return Table("Accepted with a reason", columns, rows)


def limits_table(moorings: Sequence[tuple[str, Sequence[LimitKey]]]) -> Table:
    """The limits as used, with their defaults and the sources of those; departures come first."""
    rows = [
        (
            Cell("departs" if key.departs else "", state=State.WARN if key.departs else None),
            Cell(name),
            Cell(key.name),
            Cell(said(key, key.value)),
            Cell(said(key, key.default)),
            Cell(key.source),
        )
        for name, keys in moorings
        for key in sorted(keys, key=lambda key: not key.departs)
    ]
    columns = (
        Column("", share=0.0),
        Column("mooring"),
        Column("limit"),
        Column("as used", numeric=True),
        Column("default", numeric=True),
        Column("source of the default", share=2.0),
    )
    note = "A limit that departs from its default is the design's own; no source stands for it."
    return Table("Limits as used", columns, tuple(rows), note)


def unknown_table(findings: Iterable[Finding]) -> Table | None:
    """What is unknown, piece by piece, and which figure would settle it; None where nothing is."""
    parts: dict[str, list[Finding]] = {}
    for finding in worst_by_part(findings):
        if finding.state is State.UNKNOWN:
            parts.setdefault(finding.component or "whole line", []).append(finding)
    if not parts:
        return None
    rows = tuple(
        (
            Cell(label),
            Cell(", ".join(RULES[one.rule].title for one in found)),
            Cell(" ".join(dict.fromkeys(one.remedy for one in found if one.remedy))),
            Cell(
                ", ".join(
                    f"{say_in_unit(one, one.value)} ({place_of(one)})"
                    for one in found
                    if one.value is not None
                )
            ),
        )
        for label, found in parts.items()
    )
    columns = (
        Column("component"),
        Column("not judged by"),
        Column("what would settle it", share=1.5),
        Column("what it bears or stands there", share=1.5),
    )
    return Table("Unknown, piece by piece", columns, rows, sortable=True)


def _counted(count: int, word: str) -> str:
    return f"{count} {word}{'s' * (count != 1)}"
