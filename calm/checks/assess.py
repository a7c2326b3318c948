"""Judging moorings: each in each of its environments, then its launch, recovery and breaks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from calm.case import Mooring, Result
from calm.checks.assessment import Assessment, Situation, Stand
from calm.checks.backup import breaks_of
from calm.checks.finding import Finding, State
from calm.checks.handling import Handling
from calm.checks.inventory import inventory_of
from calm.checks.launch import Launch, launch_of
from calm.checks.recovery import Recovery, recovery_of
from calm.checks.rules import ONCE, STANDING, equilibrium
from calm.checks.situations import STRUMMING, situations_of
from calm.errors import NoEquilibrium

OWN = "own"
"""Name of the environment that a mooring file gives itself."""


def check(*moorings: Mooring) -> Assessment:
    """Judge a mooring by every rule of the design check.

    Parameters
    ----------
    moorings : one mooring, loaded in each of the environments it is judged in
    """
    name = moorings[0].file.name
    return assessment_of(name, [stand_of(mooring, name) for mooring in moorings])


def stand_of(mooring: Mooring, name: str) -> Stand:
    """Solve a mooring in its environment, in every situation, and judge it.

    Parameters
    ----------
    name : of the mooring in its findings

    Findings as given are all there; those of another situation only where it is worse there, and
    a mere warning where only strumming makes it so, which it may not do.
    """
    environment = mooring.file.environment.name or OWN
    situations = situations_of(mooring)
    given, *changed = (list(_judged(each, name, environment)) for each in situations)
    findings, states = list(given), {_of(finding): finding.state for finding in given}
    for finding in (finding for each in changed for finding in each):
        if finding.situation == STRUMMING and finding.state is State.FAIL:
            finding = replace(finding, state=State.WARN)
        if finding.state.gravity > states.get(_of(finding), State.PASS).gravity:
            findings.append(finding)
    return Stand(environment, mooring, situations, tuple(findings))


def assessment_of(name: str, stands: Sequence[Stand]) -> Assessment:
    """Judge a mooring's launch, recovery and breaks too, in the first environment it stands in."""
    first = next((stand for stand in stands if stand.result is not None), stands[0])
    mooring, result = first.mooring, first.result
    launch = recovery = None
    if result is not None:
        launch, recovery = _launched(mooring, result), _risen(mooring, result)
    handling = Handling(mooring, launch, recovery, breaks_of(mooring))
    findings = [
        rule.find(verdict, name, first.environment)
        for rule in ONCE
        for verdict in rule.judge(handling)
    ]
    return Assessment(
        name=name,
        stands=tuple(stands),
        launch=launch,
        recovery=recovery,
        backup=handling.backup,
        inventory=inventory_of(mooring),
        findings=tuple(findings),
    )


def _judged(situation: Situation, mooring: str, environment: str) -> Iterator[Finding]:
    if situation.failure is not None:
        for verdict in equilibrium.judge(situation.failure):
            yield equilibrium.find(verdict, mooring, environment, situation.name)
    if situation.result is not None:
        for rule in STANDING:
            for verdict in rule.judge(situation.result):
                yield rule.find(verdict, mooring, environment, situation.name)


def _of(finding: Finding) -> tuple[str, str | None]:
    return finding.rule, finding.component


def _launched(mooring: Mooring, result: Result) -> Launch | None:
    try:
        return launch_of(mooring, result)
    except NoEquilibrium:
        return None


def _risen(mooring: Mooring, result: Result) -> Recovery | None:
    try:
        return recovery_of(mooring, result)
    except NoEquilibrium:
        return None
