"""Assessment of a mooring: in each of its environments, during launch and during recovery."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import date
from functools import lru_cache, partial
from typing import TypeVar

from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.checks.finding import (
    AS_GIVEN,
    Conclusion,
    Finding,
    Lack,
    Rule,
    State,
    Verdict,
    conclusion_of,
    governing,
    grouped_by,
    worst_state,
)
from calm.checks.inventory import InventoryItem
from calm.checks.leg_graph import Break, Loss
from calm.checks.posture import reaches_the_surface
from calm.checks.recovery import Recovery
from calm.drop.launch import Launch
from calm.errors import NoEquilibrium
from calm.files import Accept, Clamp, MooringFile, Piece
from calm.files.check_limits import LimitKey
from calm.files.definition import EstimatedFigure
from calm.files.pieces import parts_of
from calm.files.rule_texts import LOADED, RULES
from calm.quantities import say

_Part = TypeVar("_Part", Piece, Clamp)

MISSING = "missing"
"""Name of the rule for missing values of components."""

EXAMPLE = "EXAMPLE"
"""Placeholder in `accept.by` of the example files; a report with this placeholder is a draft."""


@dataclass(frozen=True, eq=False)
class Situation:
    """Solution of a mooring in an environment, unchanged or with one changed input.

    Exactly one of `result` and `failure` is None.
    """

    name: str
    result: LegResult | None
    failure: NoEquilibrium | None


@dataclass(frozen=True)
class MooringInEnvironment:
    """Solutions and findings of a mooring, or of a leg of a net, in one environment.

    Attributes
    ----------
    situations : solved situations, beginning with the unchanged mooring
    findings : findings for the unchanged mooring, and any more severe findings for other situations
    tighter : further findings for other situations; their utilisation exceeds that in `findings`
    accepted : accepted findings for all situations
    lacking : findings that are unknown because a component value is missing, for all situations;
        `findings` excludes them
    """

    environment: str
    leg: Leg
    situations: tuple[Situation, ...]
    findings: tuple[Finding, ...]
    tighter: tuple[Finding, ...] = ()
    accepted: tuple[Finding, ...] = ()
    lacking: tuple[Finding, ...] = ()

    @property
    def result(self) -> LegResult | None:
        """Result for the unchanged mooring; None if it has no equilibrium."""
        return self.situations[0].result


@dataclass(frozen=True, repr=False)
class Assessment:
    """Result of the design check of one mooring.

    Attributes
    ----------
    name : name of the mooring, unique among the moorings checked together
    in_environments : one entry per environment (for a net, per environment and leg)
    launch, recovery : solutions in the first environment with an equilibrium, if any
    backup : effect of a break at each connection above the release, from the top
    losses : effect of the loss of each buoyant element, from the top
    findings : findings of the rules that are not evaluated in each environment
    notices : messages for the user, such as those about expired acceptances
    draws : number of samples and random seed for probabilities, if any
    """

    name: str
    in_environments: tuple[MooringInEnvironment, ...]
    launch: Launch | None
    recovery: Recovery | None
    backup: tuple[Break, ...]
    inventory: tuple[InventoryItem, ...]
    findings: tuple[Finding, ...]
    losses: tuple[Loss, ...] = ()
    limits: tuple[LimitKey, ...] = ()
    notices: tuple[str, ...] = ()
    draws: tuple[int, int] | None = None

    def __repr__(self) -> str:
        counts = Counter(finding.state for finding in self.all_findings())
        numbers = ", ".join(f"{count} {state}" for state, count in counts.items())
        return f"{self.name}: {self.state} ({numbers})"

    @property
    def file(self) -> MooringFile:
        """Mooring file, resolved for the first environment; in a net, the file of the first leg."""
        return self.in_environments[0].leg.file

    def all_findings(self) -> Iterator[Finding]:
        """Yield the findings in all environments, and then `findings`."""
        for checked in self.in_environments:
            yield from checked.findings
        yield from self.findings

    @property
    def state(self) -> State:
        """Most severe state of all findings.

        Accepted findings and findings that are not judged count as passed.
        """
        worst = worst_state(finding.state for finding in self.all_findings())
        return State.PASS if worst in (State.ACCEPTED, State.NOT_JUDGED) else worst

    @property
    def verdict(self) -> Conclusion:
        """Conclusion of the design check, drawn from all findings."""
        return conclusion_of(self.every_finding())

    @property
    def draft(self) -> bool:
        """Whether an acceptance is signed with the placeholder of the example files."""
        return any(
            one.accept is not None and one.accept.by == EXAMPLE for one in self.accepted_findings()
        )

    def every_finding(self) -> Iterator[Finding]:
        """Yield all findings, followed by the findings in `tighter` of each environment."""
        yield from self.all_findings()
        yield from self.tighter_findings()

    def accepted_findings(self) -> list[Finding]:
        """Return for each rule and component the accepted finding with the largest utilisation."""
        every = (
            *(one for checked in self.in_environments for one in checked.accepted),
            *self.findings,
        )
        accepted = (one for one in every if one.accept is not None)
        found = grouped_by(accepted, lambda one: (one.rule, one.component))
        return [governing(each) for each in found.values()]

    def tighter_findings(self) -> Iterator[Finding]:
        """Yield the findings in `tighter` of each environment."""
        for checked in self.in_environments:
            yield from checked.tighter


@dataclass(frozen=True)
class Handling:
    """Input of the rules that are evaluated once per mooring.

    `launch` and `recovery` are solutions, or the reason why there is no solution. `backup` and
    `losses` are results for breaks and lost floats.
    """

    leg: Leg
    launch: Launch | NoEquilibrium
    recovery: Recovery | NoEquilibrium
    backup: tuple[Break, ...]
    losses: tuple[Loss, ...] = ()
    result: LegResult | None = None


@dataclass(frozen=True)
class Acceptance:
    """Accepted findings (`checks: accept:`) of a mooring file, applied on a given day.

    `parts` maps labels to the pieces and clamps of the line.
    """

    accepts: tuple[Accept, ...]
    day: date
    parts: Mapping[str, Piece | Clamp]

    @classmethod
    def of_file(cls, file: MooringFile, day: date | None) -> Acceptance:
        """Return the acceptances in a mooring file, for use on a given day (by default today)."""
        parts = {part.label: part for part in parts_of(file.pieces)}
        return cls(file.accepts, day or date.today(), parts)

    def of(self, finding: Finding) -> Finding:
        """Return a finding after applying the estimates and acceptances of the file.

        A finding that fails or is unknown becomes accepted if the file accepts the finding. If a
        file accepts the rule `missing` for a component, all findings that lack a value of this
        component are accepted.
        """
        finding = self._estimated(finding)
        if finding.state not in (State.FAIL, State.UNKNOWN):
            return finding
        rules = (finding.rule,) if finding.lacks is None else (finding.rule, MISSING)
        for accept in self.accepts:
            covers = any(accept.covers(rule, finding.component) for rule in rules)
            if covers and accept.counts_on(self.day):
                return _accepted(finding, accept)
        return finding

    def findings(
        self,
        rule: Rule,
        verdicts: Iterable[Verdict],
        mooring: str,
        environment: str,
        situation: str = AS_GIVEN,
    ) -> Iterator[Finding]:
        """Convert the verdicts of a rule to findings, and apply estimates and acceptances."""
        return (self.of(rule.find(one, mooring, environment, situation)) for one in verdicts)

    def _estimated(self, finding: Finding) -> Finding:
        """Change the state of a finding that relies on the lower bound of an estimate.

        A pass becomes estimated, and a failure becomes unknown. A failure is kept if a specified
        value determines its limit.
        """
        part, figures = self.parts.get(finding.component or ""), RULES[finding.rule].figures
        if part is None or not figures or finding.state not in (State.PASS, State.FAIL):
            return finding
        estimates = part.component.estimates
        used = tuple(one for name, one in estimates.items() if name in figures)
        if not used:
            return finding
        passes = finding.state is State.PASS
        if not passes and finding.figure:
            used = tuple(one for one in used if one.quantity == finding.figure)
            if not used:
                return finding
        return finding.but(
            state=State.ESTIMATED if passes else State.UNKNOWN,
            message=f"{finding.message} {_in_words(used)}",
            estimates=used,
            lacks=None if passes else Lack(part.label, used[0].quantity),
        )

    def notices(self, accepted: Iterable[Finding]) -> Iterator[str]:
        """Yield messages about acceptances that are unsigned, not valid today or unused.

        `accepted` are the accepted findings.
        """
        used = {finding.accept for finding in accepted}
        bare = [one for one in self.accepts if None in (one.by, one.until) and one in used]
        if bare:
            count = f"{len(bare)} of {len(self.accepts)} `accept` entries"
            lack = "lacks" if len(bare) == 1 else "lack"
            yield f"{count} {lack} a name (`by`) or an end date (`until`)"
        for accept in sorted(self.accepts, key=lambda one: one.line):
            of = f" of {accept.component}" if accept.component is not None else ""
            what = f"line {accept.line} of the file: `accept` for {accept.rule}{of}"
            if accept.date is not None and accept.date > self.day.isoformat():
                yield f"{what} is dated {accept.date} and does not apply yet"
            elif not accept.counts_on(self.day):
                yield f"{what} expired on {accept.until}"
            elif accept not in used:
                yield f"{what} is not needed: it matches no finding that fails or is unknown"


def _accepted(finding: Finding, accept: Accept) -> Finding:
    """Mark a finding as accepted, unless the tension exceeds the accepted load.

    For a finding without a limit, the accepted load becomes the limit.
    """
    accepted = finding.but(state=State.ACCEPTED, accept=accept, unaccepted=finding.state)
    load, tension = accept.load, finding.value
    if load is None or tension is None or finding.rule not in LOADED:
        return accepted
    if tension > load:
        message = (
            f"{finding.message} The `accept` on line {accept.line} of the file allows "
            f"at most {say('load', load)}."
        )
        return finding.but(message=message)
    return accepted if finding.limit is not None else accepted.but(limit=load, sense="<=")


@lru_cache(maxsize=64)
def _in_words(estimates: tuple[EstimatedFigure, ...]) -> str:
    return " ".join(f"Its {one}." for one in estimates)


def estimated(leg: Leg) -> Leg:
    """Return a copy of a leg in which lower bounds of estimates replace missing values.

    For a surface line or in an environment with waves, the lower bounds for use in waves apply.
    """
    file = leg.file
    if not any(part.component.estimates for part in parts_of(file.pieces)):
        return leg
    filled = partial(_filled, file.environment.waves is not None or reaches_the_surface(leg))
    pieces = tuple(
        filled(piece.with_clamps(filled))
        if any(part.component.estimates for part in parts_of([piece]))
        else piece
        for piece in file.pieces
    )
    file = replace(file, pieces=pieces)
    return Leg(file, leg.for_surface, leg.memory, leg.line, leg.water)


def estimated_result(result: LegResult) -> LegResult:
    """Return a copy of a result in which `estimated` was applied to its leg."""
    judged = estimated(result.leg)
    return result if judged is result.leg else replace(result, leg=judged)


def _filled(in_waves: bool, part: _Part) -> _Part:
    estimates = part.component.estimates
    low = {name: one.bound(in_waves=in_waves) for name, one in estimates.items()}
    return replace(part, component=part.component.model_copy(update=low)) if low else part
