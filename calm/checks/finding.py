"""Findings of the rules of the design check."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from dataclasses import dataclass, fields
from enum import StrEnum
from functools import cached_property, partial
from math import ceil, inf, isfinite
from operator import attrgetter
from typing import Any, Literal, Self, TypeVar

from calm.files import Accept, LinePart, Place
from calm.files.definition import EstimatedFigure
from calm.files.rule_texts import RULES as RULE_TEXTS

_Item = TypeVar("_Item")
_Key = TypeVar("_Key", bound=Hashable)
_Made = TypeVar("_Made")

AS_GIVEN = "as given"
"""Name of the situation without changes."""

OWN = "own"
"""Name of the environment that is defined in the mooring file itself."""

DEFAULT_ENVIRONMENT = "default environment"
"""Printed name of the environment that is defined in the mooring file itself."""

HANDLING_LABEL = "launch, recovery, breaks"
"""Label used in place of an environment name for rules that are evaluated once per mooring."""


def environment_text(name: str) -> str:
    """Return the text that names an environment in print, such as `environment storm`."""
    return DEFAULT_ENVIRONMENT if name == OWN else f"environment {name}"


class State(StrEnum):
    """State of a finding, from the least to the most severe.

    - Not judged: the rule has no limit or planned value.
    - Accepted: the rule fails or lacks a value, and the mooring file accepts this with a reason.
    - Estimated: the rule passes, but relies on the lower bound of an `estimate`.
    - Unknown: the rule lacks a value.
    """

    PASS = "pass"
    NOT_JUDGED = "not-judged"
    ACCEPTED = "accepted"
    ESTIMATED = "estimated"
    WARN = "warn"
    UNKNOWN = "unknown"
    FAIL = "fail"

    @cached_property
    def severity(self) -> int:
        """Rank of the state, 0 for pass and larger for more severe states."""
        return [*State].index(self)

    @property
    def sign(self) -> str:
        """Symbol that shows the state without colour."""
        return "✓–◦≈~?!"[self.severity]


def worst_state(states: Iterable[State]) -> State:
    """Return the most severe state, or pass if there are none.

    `NOT_JUDGED` is returned only if there is no other state.
    """
    every = {*states}
    judged = every - {State.NOT_JUDGED} or every
    return max(judged, key=lambda state: state.severity, default=State.PASS)


class Conclusion(StrEnum):
    """Conclusion of the design check for a mooring, from best to worst.

    - Open items: warnings, estimates and accepted unknown values.
    - By acceptance: the design accepts a failure or a utilisation above 1.
    - Incomplete: a rule lacks a value.
    """

    PASSES = "passes"
    OPEN_ITEMS = "passes-with-open-items"
    BY_ACCEPTANCE = "passes-by-acceptance"
    INCOMPLETE = "incomplete"
    FAILS = "fails"

    @property
    def words(self) -> str:
        """Conclusion in words, such as ``passes with open items``."""
        return self.value.replace("-", " ")


Sense = Literal["<=", ">="]
"""Relation between a value and its limit."""


@dataclass(frozen=True)
class Lack:
    """Missing component value that a rule needs.

    Attributes
    ----------
    label : label of a piece or clamp that uses the component
    quantity : key of the missing value
    """

    label: str
    quantity: str


@dataclass(frozen=True)
class MissingFigure:
    """Missing component value, with all rules and pieces that need the value.

    Attributes
    ----------
    component_id : id of the component, as in `use`
    quantity : key of the missing value
    needed_by : names of the rules
    pieces, places : labels and places of the affected pieces and clamps
    class_estimate : estimate of the value for this class of component, if any; the lower bound of
        the estimate is too low to satisfy the rules
    """

    component_id: str
    kind: str
    quantity: str
    needed_by: tuple[str, ...]
    pieces: tuple[str, ...]
    places: tuple[Place, ...]
    class_estimate: EstimatedFigure | None

    def to_dict(self) -> dict[str, Any]:
        """Return the missing value as a JSON object."""
        estimate = self.class_estimate
        return {
            "component_id": self.component_id,
            "quantity": self.quantity,
            "needed_by": list(self.needed_by),
            "pieces": list(self.pieces),
            "class_estimate": None if estimate is None else estimate.model_dump(),
        }


def _with_fields(kind: type[_Made], values: dict[str, Any]) -> _Made:
    # the constructor and `dataclasses.replace` are too slow for the tens of thousands of verdicts
    # in a check
    made = object.__new__(kind)
    vars(made).update(values)
    return made


@dataclass(frozen=True)
class Verdict:
    """Verdict of a rule on a mooring, or on one of its components.

    Attributes
    ----------
    component, place : label and place of a piece or clamp; None for the mooring as a whole
    value, limit : value and limit in SI units or degrees; None if unknown
    sense : required relation between value and limit
    remedy : suggested change, if any
    source : source of the limit; "" if the source of the rule applies
    lacks : missing component value that the rule requires, if any
    missing : missing value and everything that needs it; for the rule `missing` only
    case : code of the load case; if None, environment and situation determine the code
    figure : key of the component value that determines the limit, for rules that choose between
        several values
    """

    component: str | None
    value: float | None
    limit: float | None
    sense: Sense | None
    state: State
    message: str
    remedy: str | None = None
    place: Place | None = None
    source: str = ""
    lacks: Lack | None = None
    missing: MissingFigure | None = None
    case: str | None = None
    figure: str = ""

    def but(self, **changed: Any) -> Self:
        """Return a copy of the verdict with changed fields."""
        values = vars(self) | changed
        values.pop("utilisation", None)  # a cached property of findings
        return _with_fields(type(self), values)

    @property
    def margin(self) -> float | None:
        """Distance between value and limit, in their unit; negative if the limit is exceeded."""
        if self.value is None or self.limit is None or self.sense is None:
            return None
        return self.limit - self.value if self.sense == "<=" else self.value - self.limit

    @property
    def utilisation(self) -> float | None:
        """Ratio of demand to capacity; above 1 if the limit is exceeded.

        The ratio is infinite without capacity, and None if the limit is missing or 0.
        """
        if self.margin is None or not self.limit or self.value is None:
            return None
        most = self.sense == "<="
        demand, capacity = (self.value, self.limit) if most else (self.limit, self.value)
        if demand <= 0.0:
            return 0.0
        return demand / capacity if capacity > 0.0 else inf

    @property
    def rank(self) -> tuple[int, float]:
        """Sort key that puts the worst verdict first: by state, then by utilisation."""
        used = self.utilisation
        return -self.state.severity, inf if used is None else -used


def no_capacity(verdict: Verdict) -> bool:
    """Return whether an upper limit is negative because other loads use up the capacity."""
    return verdict.sense == "<=" and verdict.limit is not None and verdict.limit < 0.0


def percent_used(utilisation: float) -> float:
    """Return a utilisation in percent, rounded up to an integer.

    Rounding up keeps a utilisation above 1 above 100 %. An infinite utilisation stays infinite.
    """
    percent = 100.0 * utilisation
    return float(ceil(percent - 1e-9)) if isfinite(percent) else percent


def at_most(
    part: LinePart | None,
    value: float,
    limit: float,
    message: str,
    remedy: str,
    beyond: State = State.FAIL,
    source: str = "",
    *,
    least: bool = False,
    figure: str = "",
) -> Verdict:
    """Create the verdict on a value with an upper limit, or a lower limit if `least` is true.

    `beyond` is the state if the value violates the limit. `figure` is as in `Verdict`.
    """
    sense: Sense = ">=" if least else "<="
    keeps = value >= limit if least else value <= limit
    state, advice = (State.PASS, None) if keeps else (beyond, remedy)
    return verdict_on(part, state, message, advice, value, limit, sense, source, figure)


at_least = partial(at_most, least=True)
"""Create the verdict on a value with a lower limit."""


def unknown(
    part: LinePart | None,
    message: str,
    remedy: str,
    value: float | None = None,
    *,
    lacks: str = "",
    of: LinePart | None = None,
) -> Verdict:
    """Create a verdict with the state unknown, for a rule that cannot be evaluated.

    `lacks` is the key of the missing component value, if any. `of` is the piece or clamp that lacks
    the value, by default `part`.
    """
    lacking = of or part
    lack = Lack(lacking.label, lacks) if lacks and lacking is not None else None
    return verdict_on(part, State.UNKNOWN, message, remedy, value).but(lacks=lack)


def verdict_on(
    part: LinePart | None,
    state: State,
    message: str,
    remedy: str | None = None,
    value: float | None = None,
    limit: float | None = None,
    sense: Sense | None = None,
    source: str = "",
    figure: str = "",
) -> Verdict:
    """Create a verdict on a part of the line, or on the whole mooring if `part` is None."""
    label, place = (None, None) if part is None else (part.label, part.place)
    return Verdict(label, value, limit, sense, state, message, remedy, place, source, figure=figure)


@dataclass(frozen=True)
class Rule:
    """Rule of the design check, with the function that evaluates the rule.

    Attributes
    ----------
    name : name used in findings, e.g. ``depth-rating``
    quantity : name in `calm.quantities`, which determines the unit of values and limits
    source : source of the rule and of its default limit
    judge : function that yields verdicts from the evidence, such as a `LegResult`
    of_anchor : whether the rule is skipped without an anchor
    criteria : function that yields the criteria for a `Leg`
    once : whether the rule is evaluated once per mooring, from a `Handling`
    situation : situation in the findings, if `once` is true
    case : load-case code in the findings, if `once` is true: L launch, R rise, B break, 0 still
        water
    counted : function that replaces `judge` when random samples beyond a limit are counted
    """

    name: str
    title: str
    quantity: str
    source: str
    judge: Callable[[Any], Iterator[Any]]
    of_anchor: bool = False
    criteria: Callable[[Any], Iterator[Any]] | None = None
    once: bool = False
    situation: str = AS_GIVEN
    case: str | None = None
    counted: Callable[[Any], Iterator[Any]] | None = None

    def find(
        self, verdict: Verdict, mooring: str, environment: str, situation: str = AS_GIVEN
    ) -> Finding:
        """Convert a verdict of this rule to a finding."""
        of_rule = {
            "source": verdict.source or self.source,
            "case": verdict.case or self.case,
            "mooring": mooring,
            "environment": environment,
            "rule": self.name,
            "situation": situation,
        }
        return _with_fields(Finding, _NOT_ACCEPTED | vars(verdict) | of_rule)


def rule(
    name: str,
    *,
    of_anchor: bool = False,
    once: bool = False,
    situation: str = AS_GIVEN,
    case: str | None = None,
) -> Callable[[Callable[[Any], Iterator[Any]]], Rule]:
    """Return a decorator that creates the rule called `name` from its evaluation function.

    The texts of the rule are in `calm.files.rule_texts`. The parameters are as in `Rule`.
    """
    text = RULE_TEXTS[name]

    def of(judge: Callable[[Any], Iterator[Any]]) -> Rule:
        return Rule(
            name, text.title, text.quantity, text.source, judge, of_anchor,
            once=once, situation=situation, case=case,
        )  # fmt: skip

    return of


@dataclass(frozen=True, kw_only=True)
class Finding(Verdict):
    """Verdict of a rule on a mooring in an environment and a situation.

    Attributes
    ----------
    source : source of the rule and its limit
    situation : name of the change to the design; `AS_GIVEN` for the unchanged design
    accept : entry in the file that accepts the finding, if any
    unaccepted : state without `accept`
    probability : probability that the limit is exceeded
    estimates : estimates on which the finding relies
    """

    mooring: str
    environment: str
    rule: str
    situation: str = AS_GIVEN
    accept: Accept | None = None
    unaccepted: State | None = None
    probability: float | None = None
    estimates: tuple[EstimatedFigure, ...] = ()

    @cached_property
    def utilisation(self) -> float | None:
        """Ratio of demand to capacity; None if such a ratio is not meaningful for the rule."""
        return super().utilisation if RULE_TEXTS[self.rule].has_ratio else None

    def to_dict(self) -> dict[str, Any]:
        """Return the finding as a JSON object; an infinite utilisation is written as None."""
        used = self.utilisation
        figure = {} if self.missing is None else self.missing.to_dict()
        return {
            "mooring": self.mooring,
            "environment": self.environment,
            "situation": self.situation,
            "case": self.case,
            "rule": self.rule,
            "component": self.component,
            "state": self.state,
            "value": self.value,
            "sense": self.sense,
            "limit": self.limit,
            "margin": self.margin,
            "utilisation": used if used is not None and isfinite(used) else None,
            "message": self.message,
            "remedy": self.remedy,
            "source": self.source,
            "reason": None if self.accept is None else self.accept.reason,
            **figure,
        }

    @property
    def places(self) -> tuple[Place, ...]:
        """Places of all affected pieces and clamps. A finding about the whole line has none."""
        if self.missing is not None:
            return self.missing.places
        return () if self.place is None else (self.place,)


_NOT_ACCEPTED = {
    one.name: one.default
    for one in fields(Finding)
    if one.name in ("accept", "unaccepted", "probability", "estimates")
}
"""Default values of the `Finding` fields that rules do not set."""


def grouped_by(items: Iterable[_Item], key: Callable[[_Item], _Key]) -> dict[_Key, list[_Item]]:
    """Group items by a key; groups are in the order of their first items."""
    groups: dict[_Key, list[_Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def by_rule(findings: Iterable[Finding]) -> dict[str, list[Finding]]:
    """Group findings by rule; rules are in the order of their first findings."""
    return grouped_by(findings, attrgetter("rule"))


def worst_of(findings: Iterable[Finding]) -> Finding:
    """Return the most severe finding.

    Of equally severe findings, the finding with the largest utilisation is returned. Without
    utilisations, the smallest margin decides. A finding that is not judged is returned only if
    there are no other findings.
    """
    found = [*findings]
    judged = [one for one in found if one.state is not State.NOT_JUDGED]
    return min(judged or found, key=_worst_first)


def _worst_first(finding: Finding) -> tuple[tuple[int, float], float]:
    margin = finding.margin if finding.utilisation is None else None
    return finding.rank, 0.0 if margin is None else margin


def governing(findings: Iterable[Finding]) -> Finding:
    """Return the finding with the largest utilisation.

    Of findings with equal utilisation, the most severe is returned. Without utilisations, the
    result is the most severe finding with the smallest margin.
    """
    found = [*findings]
    used = [(use, one) for one in found if (use := one.utilisation) is not None]
    if not used:
        return min(found, key=_worst_first)
    return min(used, key=lambda pair: (-pair[0], pair[1].rank))[1]


def reported_findings(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Select the one or two findings of a rule to be reported.

    The first is the governing finding. The second is the most severe finding, if it is more severe
    than the first. If the second is accepted or estimated, it is reported only if the first passes.
    If no finding has a utilisation, only the most severe finding is reported.
    """
    found = [*findings]
    lead, worst = governing(found), worst_of(found)
    if lead.utilisation is None:
        return (worst,)
    passes, minor = lead.state is State.PASS, worst.state.severity < State.WARN.severity
    graver = worst.state.severity > lead.state.severity and (passes or not minor)
    return (lead, worst) if graver else (lead,)


def governing_of_each_rule(findings: Iterable[Finding]) -> list[Finding]:
    """Return the governing finding of each rule; rules are in the order of their first findings."""
    return [governing(each) for each in by_rule(findings).values()]


def _is_overridden(finding: Finding) -> bool:
    fails = finding.unaccepted is State.FAIL or (finding.utilisation or 0.0) > 1.0
    return finding.state is State.ACCEPTED and fails


def conclusion_of(findings: Iterable[Finding]) -> Conclusion:
    """Derive the conclusion of the design check from all findings on a mooring."""
    found = [*findings]
    states = {one.state for one in found}
    if State.FAIL in states:
        return Conclusion.FAILS
    if State.UNKNOWN in states:
        return Conclusion.INCOMPLETE
    if any(map(_is_overridden, found)):
        return Conclusion.BY_ACCEPTANCE
    if states & {State.WARN, State.ESTIMATED, State.ACCEPTED}:
        return Conclusion.OPEN_ITEMS
    return Conclusion.PASSES
