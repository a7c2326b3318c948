"""Findings of the rules of the design check."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from math import ceil, inf, isfinite
from typing import Any, Literal

from calm.files import Accept, LinePart, Place
from calm.files.definition import EstimatedFigure
from calm.files.rule_texts import RULES as RULE_TEXTS

AS_GIVEN = "as given"
"""The situation of a mooring in its environment, with nothing changed."""

OWN = "own"
"""Name of the environment that a mooring file gives itself."""

ON_THE_WAY = "launch, recovery, breaks"
"""What stands in its place for what is judged of a mooring outside its environments."""


class State(StrEnum):
    """Tell how a rule judges, the least grave first.

    Not judged is a rule without a limit or a plan to judge by. Unknown, where a figure that the
    rule needs is missing, is graver than a warning: it may be a failure. Accepted is a failure or
    an unknown that the design accepts with a reason; estimated passes by the low bound of an
    `estimate`, and not by a figure that anyone prints.
    """

    PASS = "pass"
    NOT_JUDGED = "not-judged"
    ACCEPTED = "accepted"
    ESTIMATED = "estimated"
    WARN = "warn"
    UNKNOWN = "unknown"
    FAIL = "fail"

    @property
    def severity(self) -> int:
        """0 for what passes, more the graver."""
        return _SEVERITIES[self]

    @property
    def sign(self) -> str:
        """Return what stands before a verdict or after a figure, legible without colour."""
        return "✓–◦≈~?!"[self.severity]


_SEVERITIES = {state: severity for severity, state in enumerate(State)}


def worst_state(states: Iterable[State]) -> State:
    """The gravest of some states; pass of none.

    What is not judged counts only beside nothing that is: it says nothing of a mooring.
    """
    every = {*states}
    judged = every - {State.NOT_JUDGED} or every
    return max(judged, key=lambda state: state.severity, default=State.PASS)


class Conclusion(StrEnum):
    """What the design check concludes of a mooring, the best first.

    A mooring is incomplete if a rule could not judge for want of a figure; it passes by acceptance
    if the design accepts what fails, or a utilisation above 1. Open items are warnings, estimates
    and unknowns that are accepted; what is not judged is none.
    """

    PASSES = "passes"
    OPEN_ITEMS = "passes-with-open-items"
    BY_ACCEPTANCE = "passes-by-acceptance"
    INCOMPLETE = "incomplete"
    FAILS = "fails"

    @property
    def words(self) -> str:
        """The conclusion as people say it, such as ``passes with open items``."""
        return self.value.replace("-", " ")


Sense = Literal["<=", ">="]
"""How a value is to keep to its limit."""


@dataclass(frozen=True)
class Lack:
    """A figure of a component without which a rule cannot judge.

    Attributes
    ----------
    label : of a piece or clamp that is such a component
    quantity : key of the component
    """

    label: str
    quantity: str


@dataclass(frozen=True)
class MissingFigure:
    """A figure that a component does not give, once for all rules and pieces.

    Attributes
    ----------
    component_id : as in `use`
    quantity : key of the component
    needed_by : names of the rules that cannot judge without it
    pieces, places : labels and places of the pieces and clamps that are not judged
    class_estimate : estimate of the figure, which is too low to settle the rules; None without one
    """

    component_id: str
    quantity: str
    needed_by: tuple[str, ...]
    pieces: tuple[str, ...]
    places: tuple[Place, ...]
    class_estimate: EstimatedFigure | None

    def to_dict(self) -> dict[str, Any]:
        """The missing figure in JSON."""
        estimate = self.class_estimate
        return {
            "component_id": self.component_id,
            "quantity": self.quantity,
            "needed_by": list(self.needed_by),
            "pieces": list(self.pieces),
            "class_estimate": None if estimate is None else estimate.model_dump(),
        }


@dataclass(frozen=True)
class Verdict:
    """Hold what a rule says of a mooring, or of one of its components.

    Attributes
    ----------
    component, place : label and place of a piece or a clamp; None of the mooring as a whole
    value, limit : SI units and degrees; None where unknown
    sense : how the value is to keep to the limit; None without a limit
    state : of the rule on it
    message : what was found, with both figures
    remedy : what to change; None where nothing need be
    source : of the limit, where it is not that of the rule
    lacks : the figure that the rule needs and a component does not give
    missing : of the rule `missing` alone, the figure with all rules and pieces
    case : code of the load case, where it is not that of the environment and situation
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

    @property
    def margin(self) -> float | None:
        """How far the value keeps within the limit, in its unit, negative where it does not."""
        if self.value is None or self.limit is None or self.sense is None:
            return None
        return self.limit - self.value if self.sense == "<=" else self.value - self.limit

    @property
    def utilisation(self) -> float | None:
        """Demand over capacity: value over limit of a maximum, limit over value of a minimum.

        It is infinite without any capacity, and None without a limit or with one of 0.
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
        """Return what sorts verdicts, the worst first: the state, then the utilisation."""
        used = self.utilisation
        return -self.state.severity, inf if used is None else -used


def percent_used(utilisation: float) -> float:
    """A utilisation in whole percent, rounded up: 100 passes, 101 does not; it may be infinite."""
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
) -> Verdict:
    """The verdict on a value that may not pass a limit; `beyond` is its state where it does.

    With `least` it may not fall short of it.
    """
    sense: Sense = ">=" if least else "<="
    keeps = value >= limit if least else value <= limit
    state, said = (State.PASS, None) if keeps else (beyond, remedy)
    return verdict_on(part, state, message, said, value, limit, sense, source)


at_least = partial(at_most, least=True)
"""The verdict on a value that may not fall short of a limit."""


def unknown(
    part: LinePart | None,
    message: str,
    remedy: str,
    value: float | None = None,
    *,
    lacks: str = "",
    of: LinePart | None = None,
) -> Verdict:
    """The verdict if the rule cannot judge.

    Parameters
    ----------
    lacks : key of the component whose figure is missing, if that is the reason
    of : piece or clamp that lacks it, if it is another than the part judged
    """
    lacking = of or part
    lack = Lack(lacking.label, lacks) if lacks and lacking is not None else None
    return replace(verdict_on(part, State.UNKNOWN, message, remedy, value), lacks=lack)


def verdict_on(
    part: LinePart | None,
    state: State,
    message: str,
    remedy: str | None = None,
    value: float | None = None,
    limit: float | None = None,
    sense: Sense | None = None,
    source: str = "",
) -> Verdict:
    """The verdict on a part of the line; None for the mooring as a whole."""
    label, place = (None, None) if part is None else (part.label, part.place)
    return Verdict(label, value, limit, sense, state, message, remedy, place, source)


@dataclass(frozen=True)
class Rule:
    """A named rule: what it judges, the quantity of its values, and its source.

    Attributes
    ----------
    name : as in findings, e.g. ``depth-rating``
    title : for people
    quantity : of `calm.quantities`, whose unit its values and limits have
    source : of the rule and of its default limit
    judge : from the evidence to verdicts: a `LegResult`, in every environment and situation
    of_anchor : whether it judges the anchor, and nothing where a line has none
    once : whether it judges a `Handling`, once of a mooring
    situation : of what it judges once
    case : code of the load case of what it judges once: L launch, R rise, B break, 0 still water
    counted : from the evidence to the verdicts counted in samples, if they differ from `judge`
    criteria : from a `Leg` to what is asked of it, where that can be counted in many profiles
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
        """The verdict as a finding of this rule."""
        return Finding(
            **(
                vars(verdict)
                | {"source": verdict.source or self.source, "case": verdict.case or self.case}
            ),
            mooring=mooring,
            environment=environment,
            rule=self.name,
            situation=situation,
        )


def rule(
    name: str,
    *,
    of_anchor: bool = False,
    once: bool = False,
    situation: str = AS_GIVEN,
    case: str | None = None,
) -> Callable[[Callable[[Any], Iterator[Any]]], Rule]:
    """Make the `Rule` of that name in `calm.files.rule_texts` from a function that judges."""
    text = RULE_TEXTS[name]

    def of(judge: Callable[[Any], Iterator[Any]]) -> Rule:
        return Rule(
            name, text.title, text.quantity, text.source, judge, of_anchor,
            once=once, situation=situation, case=case,
        )  # fmt: skip

    return of


@dataclass(frozen=True, kw_only=True)
class Finding(Verdict):
    """A verdict, and which rule gave it of which mooring in which environment and situation.

    `source` is that of the rule and its limit; `situation` tells what was changed for it,
    `AS_GIVEN` where nothing was; `accept` is what the design accepts it by, `unaccepted` the state
    without that; both are None otherwise. `probability` is that its limit is broken, where that was
    counted.
    """

    mooring: str
    environment: str
    rule: str
    situation: str = AS_GIVEN
    accept: Accept | None = None
    unaccepted: State | None = None
    probability: float | None = None

    @property
    def utilisation(self) -> float | None:
        """Demand over capacity; None as well where a rule has no like quantity for them."""
        return super().utilisation if RULE_TEXTS[self.rule].has_ratio else None

    def to_dict(self) -> dict[str, Any]:
        """The finding in JSON; a utilisation without any capacity is None there."""
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
        """Places of all pieces and clamps that the finding concerns; none of the whole line."""
        if self.missing is not None:
            return self.missing.places
        return () if self.place is None else (self.place,)


def by_rule(findings: Iterable[Finding]) -> dict[str, list[Finding]]:
    """The findings of each rule, in the order in which these come."""
    found: dict[str, list[Finding]] = {}
    for finding in findings:
        found.setdefault(finding.rule, []).append(finding)
    return found


def worst_of(findings: Iterable[Finding]) -> Finding:
    """The first of those that are as bad as any; one that is not judged only if all are."""
    found = [*findings]
    judged = [one for one in found if one.state is not State.NOT_JUDGED]
    return min(judged or found, key=lambda one: one.rank)


def governing(findings: Iterable[Finding]) -> Finding:
    """The finding with the greatest utilisation, of whatever state; the worst where none has one.

    Of findings with the same utilisation the worst is taken.
    """
    found = [*findings]
    used = [one for one in found if one.utilisation is not None]
    return min(used or found, key=lambda one: (-(one.utilisation or 0.0), one.rank))


def governing_of_each_rule(findings: Iterable[Finding]) -> list[Finding]:
    """The governing finding of each rule, in the order in which the rules come."""
    return [governing(each) for each in by_rule(findings).values()]


def _is_overridden(finding: Finding) -> bool:
    """Whether a failure is accepted, or a utilisation of more than all."""
    fails = finding.unaccepted is State.FAIL or (finding.utilisation or 0.0) > 1.0
    return finding.state is State.ACCEPTED and fails


def conclusion_of(findings: Iterable[Finding]) -> Conclusion:
    """What all findings of a mooring come to."""
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
