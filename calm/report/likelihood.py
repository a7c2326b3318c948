"""Tables of the probability with which designs exceed a limit."""

from collections.abc import Iterable, Iterator, Sequence
from math import inf

from calm.checks.assess import RULES
from calm.checks.finding import AS_GIVEN, OWN, Finding, by_rule
from calm.report import blocks
from calm.report.blocks import number, words
from calm.report.open_items import limit_text

_NOTE = (
    "Each rule is shown for the component that exceeds its limit most often. The rules about "
    "launch, ascent and breaks use the first 64 samples only. A sample without equilibrium counts "
    "as exceeding every limit."
)


def likelihood_tables(named: Iterable[tuple[str, Sequence[Finding]]]) -> Iterator[blocks.Table]:
    """Yield a table of the probabilities of exceeding limits, with the most critical design first.

    If no finding has a probability, there is no table.
    """
    designs = [(_likeliest_of_each_rule(findings), name) for name, findings in named]
    designs.sort(key=lambda one: -(one[0][0].probability or 0.0) if one[0] else inf)
    if not any(found for found, _ in designs):
        return
    rows: list[tuple[Finding | None, str]] = []
    for found, name in designs:
        likely = [each for each in found if each.probability]
        rows += zip(likely or (None,), (name, *("" for _ in likely[1:])), strict=True)

    def share(finding: Finding) -> blocks.Cell:
        percent = 100.0 * (finding.probability or 0.0)
        digits = 0 if percent >= 9.5 else 1
        text = f"{percent:.{digits}f}" if percent >= 0.05 else "<0.1"
        return blocks.Cell(text, strong=percent >= 5.0)

    fields = [
        words("component", lambda one: one.component or "whole line"),
        words("limit", limit_text),
        words("where", _where_text),
        number("exceeded in", share, "%"),
    ]
    yield blocks.table_of(
        "Probability of exceeding a limit",
        rows,
        words("design", lambda row: row[1]),
        words("rule", lambda row: row[0].rule if row[0] else "no limit exceeded", 0.0),
        *((column, lambda row, show=show: row[0] and show(row[0])) for column, show in fields),
        note=_NOTE,
    )


def _where_text(finding: Finding) -> str:
    changed = "" if finding.situation == AS_GIVEN else f", {finding.situation}"
    environment = "default" if finding.environment == OWN else finding.environment
    return f"{environment}{changed}"


def _likeliest_of_each_rule(findings: Sequence[Finding]) -> list[Finding]:
    counted = by_rule(one for one in findings if one.probability is not None)
    groups = (counted[name] for name in RULES if name in counted)
    found = (max(group, key=lambda one: one.probability or 0.0) for group in groups)
    return sorted(found, key=lambda one: -(one.probability or 0.0))
