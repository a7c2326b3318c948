"""A mooring's part of a design check, and the whole report of several of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from calm.checks.criterion import said
from calm.checks.finding import State, worst_state
from calm.checks.rules import RULES
from calm.report.blocks import (
    ON_THE_WAY,
    Block,
    Cell,
    Column,
    Figure,
    Part,
    Prose,
    Report,
    Section,
    Signatures,
    Table,
)
from calm.report.check_figures import check_figure
from calm.report.check_summary import (
    failures,
    matrix_tables,
    place_of,
    rules_tables,
    say_in_unit,
    worst_by_part,
    worst_by_rule,
    worst_table,
)
from calm.report.check_tables import (
    breaks_table,
    checks_table,
    deck_table,
    handling_summary,
    handling_table,
    inventory_table,
    likelihood_tables,
    results_table,
)
from calm.report.differences import comparison_part
from calm.report.provenance import (
    UNSEEN,
    current_listing,
    date,
    document_part,
    environments_table,
    file_listing,
    origin,
)
from calm.report.sheet import sheet

if TYPE_CHECKING:
    from calm.checks.assessment import Assessment
    from calm.checks.comparison import Comparison
    from calm.checks.finding import Finding
    from calm.files.check_limits import LimitKey


def mooring_section(assessment: Assessment, against: Comparison | None = None) -> Section:
    """All that the report says of one mooring; it draws, so it takes some tenths of a second.

    `against` is the mooring compared with the design that it came from.
    """
    columns = (*(stand.environment for stand in assessment.stands), ON_THE_WAY)
    worst = worst_by_rule(assessment)
    compared = () if against is None else (comparison_part(against),)
    parts = (
        *document_part(assessment.mooring.file),
        *compared,
        Part("Judgement", tuple(_judgement(assessment, columns))),
        Part("The line", tuple(_line(assessment))),
        Part("Shape, tension and breaks", tuple(_drawn(assessment))),
        Part("Checks", tuple(_checks(assessment))),
        Part("Launch, recovery, breaks", tuple(_on_the_way(assessment))),
        Part(
            "Inventory",
            (inventory_table(assessment.inventory), deck_table(assessment.inventory)),
        ),
        Part("Inputs", tuple(_inputs(assessment))),
    )
    return Section(
        assessment.name,
        parts,
        columns,
        worst,
        tuple(assessment.all_findings()),
        tuple(assessment.accepted_findings()),
        assessment.limits,
    )


def check_report(sections: Sequence[Section]) -> Report:
    """The report of a design check: the summary, a section for each mooring, the signatures."""
    count = len(sections)
    environments = {column for each in sections for column in each.columns} - {ON_THE_WAY}
    moorings = sections[0].name if count == 1 else f"{count} moorings"
    in_all = f"{len(environments)} environment{'s' if len(environments) != 1 else ''}"
    return Report(
        title="Design check",
        subtitle=f"{moorings}, {in_all}",
        front=(
            Part("Summary", tuple(_summary(sections))),
            Part("Limits", (limits_table([(each.name, each.limits) for each in sections]),)),
            Part("What is not judged", (Prose(UNSEEN, State.UNKNOWN),)),
            Part("Signatures", (Signatures(("Designed by", "Checked by", "Approved by")),)),
        ),
        sections=tuple(sections),
        date=date(),
    )


def _summary(sections: Sequence[Section]) -> Iterator[Block]:
    yield verdict_prose(finding for each in sections for finding in each.findings)
    accepted = accepted_table([(each.name, each.accepted) for each in sections])
    if accepted is not None:
        yield accepted
    yield from matrix_tables(sections)
    if len(sections) > 1:
        yield from likelihood_tables([(each.name, each.findings) for each in sections])
    yield failures(sections)
    yield worst_table(sections)


def _judgement(assessment: Assessment, columns: Sequence[str]) -> Iterator[Block]:
    description = assessment.mooring.file.description
    if description:
        yield Prose((description,))
    yield from rules_tables(columns, worst_by_rule(assessment))
    yield from likelihood_tables([(assessment.name, [*assessment.all_findings()])])
    yield results_table(assessment.stands)


def _line(assessment: Assessment) -> Iterator[Block]:
    """The schematic and the table of the line in the first environment that it stands in."""
    from calm.report.schematic import schematic_svg

    stand = next((stand for stand in assessment.stands if stand.result is not None), None)
    result = stand.result if stand else None
    title = f"Schematic, environment: {stand.environment}" if stand else "Schematic"
    yield Figure(title, schematic_svg(assessment.mooring.file, result), tall=True)
    if stand is not None and result is not None:
        said = sheet(result, places=True)
        yield replace(said.table, title=f"Table of the line, environment: {stand.environment}")
        yield from (*said.summary, Prose((said.convergence,)))


def _drawn(assessment: Assessment) -> Iterator[Block]:
    if all(stand.result is None for stand in assessment.stands):
        yield Prose(("The mooring has no equilibrium in any environment.",), State.FAIL)
        return
    title = "Elevation, current, tension, plan and breaks"
    yield Figure(title, check_figure(assessment))
    yield Prose((_FIGURE_NOTE,))


def _checks(assessment: Assessment) -> Iterator[Block]:
    findings = [*assessment.all_findings()]
    unknown = unknown_table(findings)
    if unknown is not None:
        yield unknown
    yield from checks_table(findings)


def _on_the_way(assessment: Assessment) -> Iterator[Block]:
    if assessment.launch is not None or assessment.recovery is not None:
        yield handling_summary(assessment)
        yield handling_table(assessment)
    else:
        yield Prose(("Neither the launch nor the recovery could be solved.",), State.UNKNOWN)
    if assessment.backup:
        yield breaks_table(assessment.backup)


def _inputs(assessment: Assessment) -> Iterator[Block]:
    names = [stand.environment for stand in assessment.stands]
    waters = [stand.mooring.water for stand in assessment.stands]
    yield environments_table(names, waters)
    yield file_listing(assessment.mooring.file)
    for name, water in zip(names, waters, strict=True):
        yield current_listing(name, water)
    yield origin([stand.mooring.file for stand in assessment.stands])


_FIGURE_NOTE = (
    "Elevations: each in the vertical plane of its own excursion; marks and the line in still "
    "water: of the first environment. Limit: over the tension, the load that a piece may bear "
    "(its working load, or its breaking load over the safety factor; what lies beyond four times "
    "the tension is drawn at the edge); over the breaks, the buoyancy required. "
    "Grey: breaks that are not judged."
)


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
