"""What a verification found: a table for people, a document for programs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, isnan, log10
from typing import TYPE_CHECKING, Any

from calm.checks.finding import State
from calm.report.blocks import Block, Cell, Column, Heading, Part, Prose, Span, Table

if TYPE_CHECKING:
    from calm.verification import Outcome, Source

    Findings = Sequence[tuple[Source, Sequence[Outcome]]]

COLUMNS = ("case", "expected", "got", "difference", "tolerance", "unit")
_SMALL = 1e-3
"""Figures below it are given with a power of ten."""


def verification_document(findings: Findings) -> dict[str, Any]:
    """The JSON object: `calm`, how many cases were `checked` and are `out`, and the `cases`.

    Parameters
    ----------
    findings : the outcomes of each source

    Returns
    -------
    dict
        `cases` has an object each: `source`, `name`, `expected`, `got`, `difference`, `tolerance`,
        `unit`, `why` (the reason for the tolerance), `within`, and `reason` where nothing was got.
    """
    from calm.version import __version__

    cases = [_case(source, outcome) for source, outcomes in findings for outcome in outcomes]
    return {
        "calm": __version__,
        "checked": len(cases),
        "out": sum(not case["within"] for case in cases),
        "cases": cases,
    }


def verification_part(findings: Findings) -> Part:
    """A table for each source, what is out marked with ``!``."""
    of_sources = (block for source, outcomes in findings for block in _of_source(source, outcomes))
    return Part("", (*of_sources, _sum(findings)))


def figures(outcome: Outcome) -> tuple[str, ...]:
    """The text of `COLUMNS`.

    What was got, and the difference, have one digit more than the tolerance, two where that many
    are printed: what lies beyond is rounding, which differs between machines.
    """
    case = outcome.case
    expected = f"{case.expected:.12g}"
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


def _case(source: Source, outcome: Outcome) -> dict[str, Any]:
    case = outcome.case
    return {
        "source": source.title,
        "name": case.name,
        "expected": case.expected,
        "got": outcome.got,
        "difference": outcome.difference,
        "tolerance": case.tolerance,
        "unit": case.unit,
        "why": case.why,
        "within": outcome.within,
        "reason": outcome.reason or None,
    }


def _of_source(source: Source, outcomes: Sequence[Outcome]) -> Iterator[Block]:
    columns = tuple(Column(name, numeric=name not in ("case", "unit")) for name in COLUMNS)
    rows = []
    for outcome in outcomes:
        name, *others = figures(outcome)
        out = None if outcome.within else State.FAIL
        label = name if outcome.within else f"! {name}"
        rows.append(tuple(Cell(text, state=out) for text in (label, *others)))
    yield Heading(source.title)
    yield Table("", columns, tuple(rows))
    reasons = [f"{outcome.case.name}: {outcome.reason}" for outcome in outcomes if outcome.reason]
    if reasons:
        yield Prose(tuple(reasons), State.WARN)


def _count(things: Sequence[object], name: str) -> str:
    return f"{len(things)} {name}{'s' if len(things) != 1 else ''}"


def _sum(findings: Findings) -> Prose:
    outcomes = [outcome for _, each in findings for outcome in each]
    out = sum(not outcome.within for outcome in outcomes)
    checked = f"Checked {_count(outcomes, 'figure')} of {_count(findings, 'source')}"
    if out:
        return Prose(((Span(f"{checked}: {out} out of tolerance", State.FAIL),),))
    return Prose((f"{checked}: all within tolerance",))
