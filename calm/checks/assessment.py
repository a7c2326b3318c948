"""A mooring judged: in each of its environments, on its way down, and on its way up."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import date
from functools import partial
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
    worst_state,
)
from calm.checks.inventory import InventoryItem
from calm.checks.posture import reaches_the_surface
from calm.checks.recovery import Break, Loss, Recovery
from calm.drop.launch import Launch
from calm.errors import NoEquilibrium
from calm.files import Accept, Clamp, MooringFile, Piece
from calm.files.check_limits import LimitKey
from calm.files.pieces import parts_of
from calm.files.rule_texts import LOADED, RULES
from calm.quantities import say

_Part = TypeVar("_Part", Piece, Clamp)

MISSING = "missing"
"""The rule of figures that components do not give."""

EXAMPLE = "EXAMPLE"
"""By whom an example accepts: a report that rests on it is a draft."""


@dataclass(frozen=True, eq=False)
class Situation:
    """A mooring solved in an environment, as given or with something changed.

    Either `result` or `failure` is None. Environments may have one in common.
    """

    name: str
    result: LegResult | None
    failure: NoEquilibrium | None


@dataclass(frozen=True)
class MooringInEnvironment:
    """Hold what was solved and found of a mooring in one environment.

    Attributes
    ----------
    environment : its name
    leg : of the design in it, which has as many of these as legs
    situations : what was solved, the first as given
    findings : all as given, and of the other situations those whose state is worse
    tighter : of each rule and part the finding of another situation with a greater utilisation
    accepted : of every situation, whether it is listed or not
    lacking : of every situation, what rules cannot judge for want of a figure; not in `findings`
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
        """As given; None where that has no equilibrium."""
        return self.situations[0].result


@dataclass(frozen=True, repr=False)
class Assessment:
    """All that the design check says of one mooring.

    Attributes
    ----------
    name : of the mooring, unlike that of any other that is judged with it
    stands : one for each environment, at least one
    launch, recovery : in the first environment; None where they could not be solved
    backup : a break at each connection above the release, from the top
    inventory : the pieces and clamps as they come to the deck
    findings : those of the launch, the recovery and the breaks
    losses : of each buoyant element above the release, from the top
    limits : all that it is judged by
    notices : what there is to say of accepts that have ended, or that no finding needs
    draws : samples and seed of the probabilities of the findings; None where there are none
    """

    name: str
    stands: tuple[MooringInEnvironment, ...]
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
        """Return how many findings there are of each state."""
        counts = Counter(finding.state for finding in self.all_findings())
        told = ", ".join(f"{count} {state}" for state, count in counts.items())
        return f"{self.name}: {self.state} ({told})"

    @property
    def file(self) -> MooringFile:
        """The file, of several legs that of the first, in its first environment."""
        return self.stands[0].leg.file

    def all_findings(self) -> Iterator[Finding]:
        """Return those of every environment, then those of launch, recovery and breaks."""
        for stand in self.stands:
            yield from stand.findings
        yield from self.findings

    @property
    def state(self) -> State:
        """The worst of all findings; pass where that is accepted or not judged."""
        worst = worst_state(finding.state for finding in self.all_findings())
        return State.PASS if worst in (State.ACCEPTED, State.NOT_JUDGED) else worst

    @property
    def verdict(self) -> Conclusion:
        """What all findings come to."""
        return conclusion_of(self.every_finding())

    @property
    def draft(self) -> bool:
        """Whether it rests on an acceptance of an example, which nobody has signed."""
        return any(
            one.accept is not None and one.accept.by == EXAMPLE for one in self.accepted_findings()
        )

    def every_finding(self) -> Iterator[Finding]:
        """Return all findings, with those of other situations that have a greater utilisation."""
        yield from self.all_findings()
        yield from self.tighter_findings()

    def accepted_findings(self) -> list[Finding]:
        """Return what is accepted, the governing finding of each rule and component."""
        every = (*(one for stand in self.stands for one in stand.accepted), *self.findings)
        found: dict[tuple[str, str | None], list[Finding]] = {}
        for finding in every:
            if finding.accept is not None:
                found.setdefault((finding.rule, finding.component), []).append(finding)
        return [governing(each) for each in found.values()]

    def tighter_findings(self) -> Iterator[Finding]:
        """Of every environment, where another situation has a greater utilisation."""
        for stand in self.stands:
            yield from stand.tighter


@dataclass(frozen=True)
class Handling:
    """Hold what is judged once of a mooring: its launch, recovery and breaks, or why they could not
    be solved, and how it stands in its first environment; `result` is None without equilibrium.
    """

    leg: Leg
    launch: Launch | NoEquilibrium
    recovery: Recovery | NoEquilibrium
    backup: tuple[Break, ...]
    losses: tuple[Loss, ...] = ()
    result: LegResult | None = None


@dataclass(frozen=True)
class Acceptance:
    """The accepts of a mooring file on a day; only failures and what is unknown are accepted.

    `parts` are the pieces and clamps of the line by their labels.
    """

    accepts: tuple[Accept, ...]
    day: date
    parts: Mapping[str, Piece | Clamp]

    @classmethod
    def of_file(cls, file: MooringFile, day: date | None) -> Acceptance:
        """Those of a mooring file on a day, today where none is given."""
        parts = {part.label: part for part in parts_of(file.pieces)}
        return cls(file.accepts, day or date.today(), parts)

    def of(self, finding: Finding) -> Finding:
        """The finding, estimated where it rests on an estimate, accepted where the file does.

        An accept of the rule `missing` covers every rule that lacks a figure of a component.
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
        """Return what a rule says of a mooring in an environment, accepted where it is."""
        return (self.of(rule.find(one, mooring, environment, situation)) for one in verdicts)

    def _estimated(self, finding: Finding) -> Finding:
        """What passes by the least that a figure can be is estimated; what fails is unknown."""
        part, figures = self.parts.get(finding.component or ""), RULES[finding.rule].figures
        own = {} if part is None else part.component.estimates
        used = [one for name, one in own.items() if name in figures]
        if part is None or not used or finding.state not in (State.PASS, State.FAIL):
            return finding
        passes = finding.state is State.PASS
        said = " ".join(f"Its {one}." for one in used)
        return replace(
            finding,
            state=State.ESTIMATED if passes else State.UNKNOWN,
            message=f"{finding.message} {said}",
            lacks=None if passes else Lack(part.label, used[0].quantity),
        )

    def notices(self, accepted: Iterable[Finding]) -> Iterator[str]:
        """Notices of accepts that do not count, or that none of the accepted findings needs."""
        used = {finding.accept for finding in accepted}
        bare = [one for one in self.accepts if None in (one.by, one.until) and one in used]
        if bare:
            said = "1 of 1 `accept` names" if len(self.accepts) == 1 else ""
            said = said or f"{len(bare)} of {len(self.accepts)} `accept` name"
            yield f"{said} nobody (`by`) or no end (`until`): accepted is not passed"
        for accept in sorted(self.accepts, key=lambda one: one.line):
            of = f" of {accept.component}" if accept.component is not None else ""
            what = f"line {accept.line}: `accept` for {accept.rule}{of}"
            if accept.date is not None and accept.date > self.day.isoformat():
                yield f"{what} is dated {accept.date}, in the future: it does not count yet"
            elif not accept.counts_on(self.day):
                yield f"{what} ended on {accept.until}: it no longer counts"
            elif accept not in used:
                yield f"{what} is not needed: nothing there fails or is unknown"


def _accepted(finding: Finding, accept: Accept) -> Finding:
    """The finding as accepted, unless its tension is greater than the load that is accepted.

    That load is the limit of what has none of its own.
    """
    accepted = replace(finding, state=State.ACCEPTED, accept=accept, unaccepted=finding.state)
    load, tension = accept.load, finding.value
    if load is None or tension is None or finding.rule not in LOADED:
        return accepted
    if tension > load:
        message = (
            f"{finding.message} It is accepted up to {say('tension', load)} only, "
            f"in line {accept.line}."
        )
        return replace(finding, message=message)
    return accepted if finding.limit is not None else replace(accepted, limit=load, sense="<=")


def estimated(leg: Leg) -> Leg:
    """Return a leg with the low bounds of estimates for figures that are not given.

    Waves move it where its environment has them, or its float is at the surface.
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
    """Return a result whose leg has the low bounds of estimates, as `estimated`."""
    judged = estimated(result.leg)
    return result if judged is result.leg else replace(result, leg=judged)


def _filled(in_waves: bool, part: _Part) -> _Part:
    estimates = part.component.estimates
    low = {name: one.bound(in_waves=in_waves) for name, one in estimates.items()}
    return replace(part, component=part.component.model_copy(update=low)) if low else part
