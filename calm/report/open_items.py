"""Open items of a mooring, grouped by cause, and the verdict on the mooring.

Components with the same finding share an item, which shows the governing values.
"""

import re
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping, Sequence
from math import isfinite
from typing import Literal

from calm.checks.assess import RULES
from calm.checks.assessment import EXAMPLE, Assessment
from calm.checks.finding import (
    Conclusion,
    Finding,
    State,
    conclusion_of,
    governing,
    grouped_by,
    no_capacity,
    percent_used,
    worst_of,
)
from calm.files.definition import EstimatedFigure
from calm.quantities import QUANTITIES
from calm.report.blocks import Cell, OpenItem, Span, number, words
from calm.report.check_tables import joined, named_components

OPEN = (State.FAIL, State.UNKNOWN, State.WARN, State.ACCEPTED, State.ESTIMATED, State.NOT_JUDGED)
"""States of open items, in the order of the list."""

_EXPLAINED = ("planned-depth", "as-deployed", "reserve", "freeboard")
"""Rules whose open items show the message instead of the value and the limit.

The values of these rules are differences or fractions, which the message explains.
"""

_VALUE_NAMES = {
    "current": "current", "stretch": "stretch", "strength-steps": "strength",
    "anchor-weight": "weight in water",
    "anchor-uplift": "vertical load", "anchor-sliding": "horizontal load",
    "slack": "tension", "wave-slack": "tension", "watch-circle": "radius",
    "metals": "potential difference", "backup": "net buoyancy", "recovery": "rise speed",
}  # fmt: skip
"""Names of the checked values, by rule.

The quantities of these rules have more general or different names.
"""

_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


def plain(text: str, *, keys: bool = False) -> str:
    """Format a message for print.

    Keys become words in quotes. A line never breaks between a number and its unit. If `keys` is
    true, as for a terminal, keys are written as in the file, in backticks.
    """
    if not keys:
        text = re.sub(r"`([^`]*)`", _quoted, text)
    text = re.sub(r"(?<![\w-])-(?=\d)", "−", text)
    return re.sub(r"(?<=\d) (?=(?:m/s|mm|m|kN|N|kg|s|min|kn|kgf|lbf|ft)\b|%)", "\u00a0", text)


def _quoted(key: re.Match[str]) -> str:
    return f"“{key[1].rstrip(':').replace('_', ' ')}”"


def without_asides(text: str) -> str:
    """Remove sources and other long passages in brackets from a text."""
    return re.sub(r" \((?:[^()]|\([^()]*\)){30,}\)", "", text)


def short(text: str, most: int) -> str:
    """Shorten a text to at most `most` characters."""
    return text if len(text) <= most else f"{text[: most - 1].rstrip()}…"


def figure_text(finding: Finding, name: Literal["value", "limit"] = "value") -> str:
    """Format the value or the limit of a finding; "" if unknown.

    Value and limit have the same unit, which depends on both.
    """
    value, quantity = getattr(finding, name), QUANTITIES.get(RULES[finding.rule].quantity)
    if value is None or quantity is None:
        return ""
    return plain(quantity.say(value, finding.value, finding.limit))


def limit_text(finding: Finding) -> str:
    """Format the limit of a finding with ≤ or ≥, or as ``none left`` if there is no capacity."""
    if no_capacity(finding):
        return "none left"
    sign = {"<=": "≤\u00a0", ">=": "≥\u00a0"}.get(finding.sense or "", "")
    text = figure_text(finding, "limit")
    return sign + text if text else ""


def percent_text(utilisation: float | None) -> str:
    """Format a utilisation in percent, rounded up; None is shown as a dash."""
    if utilisation is None:
        return "–"
    percent = percent_used(utilisation)
    return ">999" if not isfinite(percent) or percent > 999.0 else f"{percent:.0f}"


FIGURE_FIELDS = (
    number("Use %", lambda one: Cell(percent_text(one.utilisation), strong=True)),
    number("Found", figure_text),
    words("Limit", lambda one: limit_text(one) or "–", 0.0),
)
"""Table columns of findings: utilisation, value and limit."""


def where_text(finding: Finding) -> str:
    """Format the component of a finding, and the code of its load case."""
    component = finding.component or "whole line"
    return f"{component}, {finding.case}" if finding.case else component


def open_groups(assessment: Assessment) -> list[list[Finding]]:
    """Group the open findings by cause, most severe first.

    A group contains findings of one kind:

    - failures, unknowns or warnings that differ only in component and values
    - estimates for one component, unless another group asks for the estimated values
    - acceptances for one component with the same reason and signature
    - findings of one rule with the state `NOT_JUDGED`
    """
    use = {one.label: one.use for one in assessment.inventory}
    return groups_of(assessment.every_finding(), use)


def groups_of(findings: Iterable[Finding], use: Mapping[str, str]) -> list[list[Finding]]:
    """Group open findings by cause, as in `open_groups`.

    Parameters
    ----------
    use : component id of each piece and clamp, by label
    """

    def cause(finding: Finding) -> Hashable:
        if finding.state is State.ACCEPTED and finding.accept is not None:
            accept = finding.accept
            return State.ACCEPTED, use.get(finding.component or ""), accept.reason, accept.by
        if finding.state is State.ESTIMATED:
            return State.ESTIMATED, use.get(finding.component or "")
        return State.NOT_JUDGED, finding.rule

    found: list[list[Finding]] = []
    every = [*findings]
    figures = [one.missing for one in every if one.missing is not None]
    lacking = {(label, one.quantity) for one in figures for label in one.pieces}

    def is_covered(finding: Finding) -> bool:  # by an item on missing values
        own = {(finding.component, one.quantity) for one in finding.estimates}
        return finding.state is State.ESTIMATED and own <= lacking

    every = [one for one in every if not is_covered(one)]
    for state in OPEN:
        those = [one for one in every if one.state is state]
        if state in (State.ACCEPTED, State.ESTIMATED, State.NOT_JUDGED):
            groups = [*grouped_by(those, cause).values()]
        else:
            groups = joined(those)
        found += sorted(groups, key=lambda group: governing(group).rank)
    return found


def open_counts(assessment: Assessment) -> Counter[State]:
    """Count the open items by state."""
    return Counter(worst_of(group).state for group in open_groups(assessment))


def counts_text(groups: Iterable[Sequence[Finding]]) -> str:
    """Format the number of open items by state, such as ``1 warning, 3 accepted``."""
    counts = Counter(worst_of(group).state for group in groups)
    return ", ".join(_count_of_state(counts[state], state) for state in OPEN if counts[state])


def _count_of_state(count: int, state: State) -> str:
    names = {State.FAIL: "failure", State.WARN: "warning", State.NOT_JUDGED: "not judged"}
    plural = count != 1 and state in (State.FAIL, State.WARN)
    return f"{count} {names.get(state, state.value)}{'s' * plural}"


STATES = {
    Conclusion.FAILS: State.FAIL, Conclusion.INCOMPLETE: State.UNKNOWN,
    Conclusion.BY_ACCEPTANCE: State.WARN, Conclusion.OPEN_ITEMS: State.WARN,
    Conclusion.PASSES: State.PASS,
}  # fmt: skip
"""State that determines the colour and the sign of a conclusion."""


def verdict_of(findings: Iterable[Finding], use: Mapping[str, str]) -> Span:
    """Format a verdict and its open items in one line.

    An example is ``passes with open items: 1 warning, 3 accepted``.

    Parameters
    ----------
    use : component id of each piece and clamp, by label
    """
    found = [*findings]
    conclusion = conclusion_of(found)
    counts = counts_text(groups_of(found, use))
    return Span(f"{conclusion.words}{': ' * bool(counts)}{counts}", STATES[conclusion])


def assessment_verdict(assessment: Assessment) -> Span:
    """Format the verdict on a mooring in one line, preceded by the symbol for its state."""
    use = {one.label: one.use for one in assessment.inventory}
    verdict = verdict_of(assessment.every_finding(), use)
    sign = "" if verdict.state is None else f"{verdict.state.sign} "
    return Span(f"{sign}{verdict.text}", verdict.state)


def open_items(assessment: Assessment, *, keys: bool = False) -> list[OpenItem]:
    """Create the numbered open items for page one; `keys` has the same meaning as in `plain`."""
    groups = open_groups(assessment)
    return [_item(group, number, keys=keys) for number, group in enumerate(groups, 1)]


def _item(group: Sequence[Finding], number: int, *, keys: bool) -> OpenItem:
    worst = governing(group)
    if worst.utilisation is None:  # show the most extreme value
        quantity = RULES[worst.rule].quantity
        alike = [one for one in group if RULES[one.rule].quantity == quantity]
        worst = max(alike, key=_extreme)
    text = plain(_item_text(group, worst), keys=keys)
    return OpenItem(worst.state, number, f"{_item_head(group, worst)}.", text)


def _extreme(finding: Finding) -> tuple[int, float]:
    """Sort key for findings without a utilisation: state, then magnitude of the value."""
    value = finding.value or 0.0
    return finding.state.severity, -value if finding.sense == ">=" else abs(value)


def _item_head(group: Sequence[Finding], worst: Finding) -> str:
    labels = list(dict.fromkeys(one.component or "" for one in group))
    of = f", {short(named_components(_one_per_component(group)), 90)}" if labels != [""] else ""
    if worst.missing is not None:
        quantity = worst.missing.quantity.replace("_", " ")
        estimated = worst.missing.class_estimate is not None
        lack = f"estimated {quantity} too low" if estimated else f"{quantity} missing"
        return f"{worst.missing.component_id}: {lack}"
    if worst.state is State.ESTIMATED:
        passes = "passes" if len(labels) == 1 else "pass"
        named = _capitalised(short(named_components(_one_per_component(group)), 90))
        return f"{named}: {passes} with an estimated value"
    use = "" if worst.utilisation is None else f": {percent_text(worst.utilisation)}\u00a0%"
    if worst.state is State.NOT_JUDGED:
        use = " is not judged"
        of = f" ({len(labels)} parts)" if len(labels) > 1 else of
    rules = dict.fromkeys(RULES[one.rule].title for one in group)
    return f"{_capitalised(', '.join(rules).lower())}{of}{use}"


def _item_text(group: Sequence[Finding], worst: Finding) -> str:
    found, limit = figure_text(worst), figure_text(worst, "limit")
    several = len({one.component for one in group}) > 1
    case = f"case {worst.case}" if worst.case else ""
    where = ", ".join(filter(None, (worst.component if several else "", case)))
    where = f" ({where})" if where else ""
    quantity = QUANTITIES.get(RULES[worst.rule].quantity)
    name = _VALUE_NAMES.get(worst.rule, "value" if quantity is None else quantity.heading)
    value = f"The {name} is {found}{where}"
    bound = "minimum" if worst.sense == ">=" else "limit"
    figures = f"{value}; the {bound} is {limit}." if limit else ""
    if worst.accept is not None:
        until = f", until {worst.accept.until}" if worst.accept.until else ""
        by = worst.accept.by or "no name"
        figures = figures or f"{value}; the limit is not published." * bool(found)
        example = " Replace this example before signing." if by == EXAMPLE else ""
        accepted = f"Accepted: “{worst.accept.reason}” ({by}{until}).{example}"
        return f"{figures} {accepted}" if figures else accepted
    if worst.state is State.ESTIMATED:
        limits = (f"the {_limit_name(one)} is {one.bounds_text}" for one in worst.estimates)
        return f"{figures} Estimated: {'; '.join(limits)}. Obtain the manufacturer’s value."
    if figures and worst.rule not in _EXPLAINED and not no_capacity(worst):
        return f"{figures} {worst.remedy or ''}"
    return f"{worst.message} {worst.remedy or ''}"


def _limit_name(estimate: EstimatedFigure) -> str:
    name = estimate.quantity.replace("_", " ")
    return f"{name} limit" if estimate.quantity == "working_load" else name


def advice(finding: Finding) -> str:
    """Return a short form of the recommended action for a finding."""
    if finding.state in (State.PASS, State.NOT_JUDGED):
        return ""
    if finding.accept is not None:
        return "Accepted."
    if finding.state is State.ESTIMATED:
        return "Based on an estimate; obtain the manufacturer’s value."
    return plain(finding.remedy or finding.message)


def _one_per_component(group: Iterable[Finding]) -> list[Finding]:
    return list({one.component: one for one in group}.values())


def _capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]


def draft(assessment: Assessment) -> bool:
    """Return whether a report is a draft, which must not be signed.

    A report is a draft if its document has no number, revision or date. A report is also a draft if
    an acceptance is signed with the placeholder of the example files.
    """
    document = assessment.file.document
    given = document is not None and all((document.id, document.revision, document.date))
    return assessment.draft or not given


def verdict_sentence(assessment: Assessment) -> str:
    """Describe the verdict in sentences, with the number of open items and the rules concerned.

    The sentences also list every utilisation over 100 % that is not a failure.
    """
    groups = open_groups(assessment)
    counts = Counter(governing(group).state for group in groups)
    rules = {
        state: ", ".join(dict.fromkeys(
            RULES[one.rule].title.lower() for group in groups for one in group if one.state is state
        ))
        for state in OPEN
    }  # fmt: skip
    parts = [
        f"{_in_words(counts[State.FAIL], 'failure')} ({rules[State.FAIL]})"
        * (counts[State.FAIL] > 0),
        f"{_in_words(counts[State.UNKNOWN], 'unknown')} ({rules[State.UNKNOWN]})"
        * (counts[State.UNKNOWN] > 0),
        f"{_in_words(counts[State.WARN], 'warning')} ({rules[State.WARN]})"
        * (counts[State.WARN] > 0),
        f"{_in_words(counts[State.ACCEPTED], 'accepted exception')}" * (counts[State.ACCEPTED] > 0),
        f"{_in_words(counts[State.ESTIMATED], 'estimated value')}" * (counts[State.ESTIMATED] > 0),
        f"{_in_words(counts[State.NOT_JUDGED], 'check')} not judged"
        * (counts[State.NOT_JUDGED] > 0),
    ]  # fmt: skip
    failing = {one.rule for group in groups for one in group if one.state is State.FAIL}
    over = [
        f"{short(one.component or 'the line', 30)}, {percent_text(one.utilisation)}\u00a0% "
        f"({RULES[one.rule].title.lower()})"
        for one in map(governing, groups)
        if (one.utilisation or 0.0) > 1.0 and one.rule not in failing
    ]
    items = ", ".join(filter(None, parts))
    sentences = [
        "" if counts[State.FAIL] else "No check fails.",
        f"Open items: {items}." if items else "",
        f"Above 100\u00a0% without being a failure: {'; '.join(dict.fromkeys(over))}."
        if over else "",
    ]  # fmt: skip
    return " ".join(filter(None, sentences))


def _in_words(count: int, word: str) -> str:
    number = _NUMBERS[count] if count < len(_NUMBERS) else str(count)
    return f"{number} {word}{'s' * (count != 1)}"


def verdict_words(conclusion: Conclusion) -> str:
    """Return the short verdict that is printed above `verdict_sentence`."""
    return _capitalised(conclusion.words)
