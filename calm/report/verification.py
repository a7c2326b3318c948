"""Report of a verification: tables for display, and a JSON document."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from math import ceil, isnan, log10
from typing import Any

from calm.checks.finding import State
from calm.report import blocks
from calm.report.blocks import Block, Cell, Heading, Line, Prose, ReportPart, Span, table_of, warned
from calm.report.result_files import members
from calm.verification import Case, CaseOutcome, Kind, Source
from calm.version import __version__

Findings = Sequence[tuple[Source, Sequence[CaseOutcome]]]

COLUMNS = ("case", "expected", "got", "difference", "tolerance", "unit")
_SMALL = 1e-3
"""Value below which numbers are printed with a power of ten."""


def verification_document(findings: Findings) -> dict[str, Any]:
    """Return the JSON object of a verification.

    The keys are:

    - `checked`: number of values, without values of the kind "by construction"
    - `kinds`: number of values of each kind
    - `out`: number of values out of tolerance
    - `cases`: one object per value, in which `why` is the reason for the tolerance and `reason`
      explains a value that was not computed
    """
    cases = [
        _case_document(source, outcome) for source, outcomes in findings for outcome in outcomes
    ]
    kinds = by_kind(outcome.case for _, outcomes in findings for outcome in outcomes)
    return {
        "calm": __version__,
        "checked": _verifying(kinds),
        "kinds": {kind.value: number for kind, number in kinds.items()},
        "out": sum(not case["within"] for case in cases),
        "cases": cases,
    }


def by_kind(cases: Iterable[Case]) -> dict[Kind, int]:
    """Count the cases of each kind, in the order of the members of `Kind`.

    Kinds without cases are omitted.
    """
    number = Counter(case.kind for case in cases)
    return {kind: number[kind] for kind in Kind if number[kind]}


def verification_part(findings: Findings) -> ReportPart:
    """Build a table for each source and kind; values out of tolerance are marked ``!``."""
    of_sources = (
        block for source, outcomes in findings for block in _source_blocks(source, outcomes)
    )
    return ReportPart("", (*of_sources, _total(findings)))


def figures(outcome: CaseOutcome) -> tuple[str, ...]:
    """Format the outcome of a verification case as a row, in the order of `COLUMNS`.

    Computed values have one or two decimal places more than the tolerance.
    """
    case = outcome.case
    expected = f"{case.expected:.12g}"
    # further digits are rounding errors that differ between machines
    decimals = max(0, 1 + ceil(-log10(case.tolerance)))
    decimals += len(expected.partition(".")[2]) > decimals
    return (
        case.name,
        expected,
        _rounded(outcome.got, decimals),
        _rounded(outcome.difference, decimals),
        f"{case.tolerance:.2g}",
        case.unit,
    )


def _rounded(value: float, decimals: int) -> str:
    if isnan(value):
        return "-"
    rounded = round(value, decimals)
    if rounded == 0.0:
        return "0"
    if abs(rounded) < _SMALL:
        return f"{rounded:.2g}"
    text = f"{rounded:.{decimals}f}"
    return text.rstrip("0").rstrip(".") if decimals else text


def _case_document(source: Source, outcome: CaseOutcome) -> dict[str, Any]:
    case = outcome.case
    return {
        "source": source.title,
        **members(case, "name", "kind", "expected"),
        **members(outcome, "got", "difference"),
        **members(case, "tolerance", "unit", "why"),
        "within": outcome.within,
        "reason": outcome.reason or None,
    }


def _source_blocks(source: Source, outcomes: Sequence[CaseOutcome]) -> Iterator[Block]:
    def cell(outcome: CaseOutcome, name: str) -> Cell:
        text = figures(outcome)[COLUMNS.index(name)]
        if outcome.within:
            return Cell(text)
        return Cell(f"! {text}" if name == "case" else text, state=State.FAIL)

    fields = [
        blocks.words(name, partial(cell, name=name), numeric=name not in ("case", "unit"))
        for name in COLUMNS
    ]
    yield Heading(source.title)
    for kind in by_kind(outcome.case for outcome in outcomes):
        of_kind = (outcome for outcome in outcomes if outcome.case.kind is kind)
        yield table_of(_capitalised(kind), of_kind, *fields)
    yield from warned(f"{one.case.name}: {one.reason}" for one in outcomes if one.reason)


def _capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]


def _verifying(kinds: dict[Kind, int]) -> int:
    return sum(number for kind, number in kinds.items() if kind.verifies)


def _count(number: int, name: str) -> str:
    return f"{number} {name}{'s' if number != 1 else ''}"


def _total(findings: Findings) -> Prose:
    outcomes = [outcome for _, each in findings for outcome in each]
    kinds = by_kind(outcome.case for outcome in outcomes)
    out = sum(not outcome.within for outcome in outcomes)
    checked = f"Checked {_count(_verifying(kinds), 'figure')} of {_count(len(findings), 'source')}"
    found = f"{out} out of tolerance" if out else "all within tolerance"
    totals = [f"{number} {kind}" for kind, number in kinds.items() if kind.verifies]
    copied = sum(number for kind, number in kinds.items() if not kind.verifies)
    lines: list[Line] = [(Span(f"{checked}: {found}", State.FAIL if out else None),)]
    if totals:
        lines.append(_capitalised("; ".join(totals)))
    if copied:
        lines.append(f"Not counted: {_count(copied, 'figure')} that are met by construction")
    return Prose(tuple(lines))
