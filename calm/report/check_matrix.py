"""Design check of many moorings in many environments.

The report consists of a matrix of utilisations and one page per mooring.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from calm.checks.assess import RULES
from calm.checks.assessment import Assessment
from calm.checks.finding import (
    DEFAULT_ENVIRONMENT,
    OWN,
    Conclusion,
    Finding,
    State,
    by_rule,
    governing,
    reported_findings,
    worst_of,
)
from calm.report.blocks import Block, Cell, Field, Prose, Span, number, table_of, words
from calm.report.open_items import (
    FIGURE_FIELDS,
    advice,
    percent_text,
    short,
    where_text,
    without_asides,
)
from calm.report.page_one import (
    SignedMooring,
    cases_table,
    governing_rows,
    sign_off,
    title_block,
    verdict_box,
)

_OTHER_KIND = ("slack",)
"""Rules omitted from the matrix.

The utilisation of `slack` is the required minimum tension divided by the actual tension. It is not
comparable with the used part of a strength.
"""
_MOST_ENVIRONMENTS = 12
_NEAR = 0.9


@dataclass(frozen=True)
class MatrixCell:
    """Cell of the matrix: the maximum utilisation of a mooring in an environment.

    `use` is None if no check has a utilisation.
    """

    use: float | None
    state: State
    text: str


@dataclass(frozen=True)
class SummaryRow:
    """Row of the matrix, for one mooring.

    Attributes
    ----------
    cells : cells by name of the environment, in the order of the columns
    handling : cell for launch, recovery, and breaks of the line
    governs : check with the largest utilisation in the first environment
    accepted, findings : numbers of accepted findings and of all findings
    """

    mooring: str
    depth: str
    cells: Mapping[str, MatrixCell]
    handling: MatrixCell | None
    governs: str
    accepted: int
    findings: int
    conclusion: Conclusion

    @property
    def first_failure(self) -> tuple[str, str] | None:
        """First environment in which the mooring fails, and text of the failure; None if none."""
        cells = {**self.cells, "launch": self.handling} if self.handling else self.cells
        failed = (
            (name, cell.text) for name, cell in cells.items()
            if cell is not None and cell.state is State.FAIL
        )  # fmt: skip
        return next(failed, None)


def summary_row(assessment: Assessment) -> SummaryRow:
    """Create the summary row of a mooring."""
    groups: dict[str, list[Finding]] = {}
    lacking = set()
    for checked in assessment.in_environments:
        name = checked.leg.file.environment.name or "own"
        groups.setdefault(name, []).extend((*checked.findings, *checked.tighter))
        if checked.lacking:
            lacking.add(name)
    cells = {name: _cell(found, name in lacking) for name, found in groups.items()}
    handling = [one for one in assessment.findings if one.missing is None and one.rule != "current"]
    depth = assessment.file.environment.depth
    every = [*assessment.every_finding()]
    first = next(iter(cells.values()), None)
    return SummaryRow(
        assessment.name,
        "" if depth is None else f"{depth:.0f}",
        cells,
        _cell(handling, False) if handling else None,
        "" if first is None else first.text,
        len(assessment.accepted_findings()),
        len(every),
        assessment.verdict,
    )


def _cell(findings: Sequence[Finding], lacking: bool) -> MatrixCell:
    used = [one for one in findings if one.utilisation is not None and one.rule not in _OTHER_KIND]
    worst = worst_of(findings) if findings else None
    state = State.UNKNOWN if lacking else State.PASS
    if worst is not None and worst.state in (State.FAIL, State.UNKNOWN):
        state = worst.state
    if not used:
        text = "" if worst is None else RULES[worst.rule].title.lower()
        return MatrixCell(None, state, text)
    lead = governing(used)
    if state is State.FAIL and lead.state is not State.FAIL and worst is not None:
        failed = [one for one in used if one.state is State.FAIL]
        lead = governing(failed) if failed else worst
    title, use = RULES[lead.rule].title.lower(), percent_text(lead.utilisation)
    text = f"{title}, {lead.component or 'whole line'}, {use}\u00a0%"
    return MatrixCell(governing(used).utilisation, state, text)


def summary_page(rows: Sequence[SummaryRow]) -> Iterator[Block]:
    """Yield the matrix of utilisations, and a table of the governing check of each mooring."""
    names, shown, codes = environments_of(rows)
    failing = [row for row in rows if row.conclusion is Conclusion.FAILS]
    incomplete = [row for row in rows if row.conclusion is Conclusion.INCOMPLETE]
    state = State.FAIL if failing else State.UNKNOWN if incomplete else State.PASS
    fail, lack = ("s" * (len(some) == 1) for some in (failing, incomplete))
    verdict = f"{len(failing)} of {len(rows)} moorings fail{fail} in at least one environment"
    more = f"; {len(incomplete)} more lack{lack} values that the check needs"
    verdict += f"{more * bool(incomplete)}."
    head = "Fails: " if failing else "Incomplete: " if incomplete else "Passes: "
    yield Prose(((Span(head, state), Span(verdict)),), state)
    called = {name: DEFAULT_ENVIRONMENT if name == OWN else name for name in shown}
    note = ", ".join(f"{codes[name]} {short(called[name], 24)}" for name in shown)
    note += ". Launch includes recovery and breaks."
    if len(shown) < len(names):
        note += f" Milder environments omitted: {len(names) - len(shown)}."
    yield table_of(
        "Highest utilisation, %",
        rows,
        words("Mooring", lambda row: short(row.mooring, 44), 1.0),
        number("Water\nm", lambda row: row.depth, share=0.2),
        *(_column(codes[name], name) for name in shown),
        number("Launch", lambda row: _shown(row.handling), share=0.24),
        aside="of all checks, rounded up. White on black: a check fails. Hatched: over 100, but "
        "no check fails. Grey: 90 to 100. ?: unknown",
        note=note,
    )
    yield table_of(
        "Governing checks",
        rows,
        words("Mooring", lambda row: short(row.mooring, 44), 1.1),
        words(f"Governs in {codes[names[0]]}", lambda row: short(row.governs, 60), 1.3),
        words("First failure", lambda row: _failure(row, codes), 1.3),
        number("Accepted", lambda row: row.accepted),
        note=f"This page summarises {sum(row.findings for row in rows)} findings. A page on each "
        "mooring follows. Fish bite, metals and minimum tension have no utilisation, because "
        "their limits are not capacities.",
    )


def environments_of(rows: Sequence[SummaryRow]) -> tuple[list[str], list[str], dict[str, str]]:
    """Return all environments, the environments with a column in the matrix, and their codes.

    The matrix has columns for at most `_MOST_ENVIRONMENTS` environments, those with the largest
    utilisations. Codes are E1, E2 and so on.
    """
    names = list(dict.fromkeys(name for row in rows for name in row.cells))
    codes = {name: f"E{at}" for at, name in enumerate(names, 1)}
    if len(names) <= _MOST_ENVIRONMENTS:
        return names, names, codes

    def worst(name: str) -> float:
        return max((row.cells[name].use or 0.0 for row in rows if name in row.cells), default=0.0)

    kept = set(sorted(names, key=worst, reverse=True)[:_MOST_ENVIRONMENTS])
    return names, [name for name in names if name in kept], codes


def _column(code: str, name: str) -> Field:
    return number(code, lambda row: _shown(row.cells.get(name)), share=0.2)


def _shown(cell: MatrixCell | None) -> Cell:
    if cell is None:
        return Cell("–")
    text = percent_text(cell.use)
    if cell.state is State.FAIL:
        return Cell(text if cell.use is not None else "✗", strong=True, tone="fail")
    if cell.state is State.UNKNOWN:
        return Cell(f"? {text}" if cell.use is not None else "?", strong=True)
    if (cell.use or 0.0) > 1.0:
        return Cell(text, strong=True, tone="over")
    return Cell(text, tone="near" if (cell.use or 0.0) >= _NEAR else "")


def _failure(row: SummaryRow, codes: Mapping[str, str]) -> str:
    found = row.first_failure
    return "none" if found is None else f"{codes.get(found[0], found[0])}: {short(found[1], 60)}"


def mooring_page(signed: SignedMooring) -> Iterator[Block]:
    """Yield the blocks of the one-page report on a mooring: verdict, load cases, and every rule."""
    findings = [*signed.assessment.every_finding()]
    yield title_block(signed)
    yield verdict_box(signed)
    yield cases_table(signed)
    groups = by_rule(findings)
    reported = {name: reported_findings(found) for name, found in groups.items()}
    leads = [one.rule for one in governing_rows(findings)]
    order = [*leads, *(name for name in groups if name not in leads)]
    yield table_of(
        "Checks",
        [one for name in order for one in reported[name]],
        words("", lambda one: Cell(state=one.state), 0.0),
        words("Rule", lambda one: RULES[one.rule].title, 1.0),
        *FIGURE_FIELDS,
        words("Where, case", lambda one: short(where_text(one), 36), 1.1),
        number("Over\n100 %", lambda one: _over(groups[one.rule])
               if one is reported[one.rule][0] else None),
        words("Remedy", lambda one: Cell(detail=without_asides(advice(one))), 1.5),
        aside=(
            "Each rule has a row for its finding with the highest utilisation, and a second row if "
            "another finding is more severe. “Over 100 %” counts the findings in all environments."
        ),
        ruled=False,
    )  # fmt: skip
    yield sign_off(signed)


def _over(found: Sequence[Finding]) -> str:
    return f"{sum((one.utilisation or 0.0) > 1.0 for one in found)} of {len(found)}"
