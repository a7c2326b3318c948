"""Apply the design rules to moorings.

The probability that a limit is exceeded is the fraction of random samples that exceed the limit. A
sample without equilibrium counts as exceeding every limit. Launch, recovery and breaks take much
longer to solve. They are solved only for the first `HANDLED` samples.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from datetime import date
from functools import lru_cache, partial
from itertools import chain
from typing import Any

import numpy as np

from calm.case.design import solved_alone
from calm.case.draws import Draw, checked_samples, drawn, draws_of, normals_of
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.case.uncertain import BLOCK, Mapped
from calm.checks import (
    arrangement,
    catalogue_rules,
    handling,
    joints,
    planned,
    posture,
    serials_and_dates,
    situations,
    strength,
)
from calm.checks.assessment import (
    Acceptance,
    Assessment,
    Handling,
    MooringInEnvironment,
    Situation,
    estimated,
    estimated_result,
)
from calm.checks.criterion import limits_used
from calm.checks.drag_range import drag_coefficient
from calm.checks.environments import environment
from calm.checks.finding import AS_GIVEN, OWN, Finding, Rule, State, governing, grouped_by
from calm.checks.inventory import inventory_of
from calm.checks.leg_graph import LegGraph
from calm.checks.missing import is_lacking, missing, with_missing
from calm.checks.posture import left_out_of_a_leg, reaches_the_surface
from calm.checks.recovery import recovery_of
from calm.checks.situations import STRUMMING, currents, equilibrium
from calm.checks.wave_rules import IN_WAVES, MooringInWaves
from calm.drop.launch import launch_of
from calm.errors import NoEquilibrium, or_why_not
from calm.files import MooringFile, Place
from calm.files.pieces import STAND_IN
from calm.files.rule_texts import RULES as TEXTS
from calm.solve import CompiledPart, expect_many


def checked_environment(
    situations: tuple[Situation, ...],
    leg: Leg,
    name: str,
    environment: str,
    day: date | None = None,
) -> MooringInEnvironment:
    """Apply the rules to a leg in all its situations.

    A failure that occurs only with strumming cables becomes a warning, because cables may not
    strum.

    Parameters
    ----------
    situations : solved situations, beginning with the unchanged mooring
    name : mooring name to use in the findings
    day : date on which acceptances must be valid; today by default
    """
    given, *changed = ([*findings_of(each, name, environment, day=day)] for each in situations)
    if not leg.of_several:
        given += _findings_in_waves(situations[0], name, environment, day)
    states = {_of(finding): finding.state.severity for finding in given}
    failed = {_of(finding) for finding in given if finding.state is State.FAIL}
    others = [
        one.but(state=State.WARN)
        if one.situation == STRUMMING and one.state is State.FAIL and _of(one) not in failed
        else one
        for findings in changed
        for one in findings
    ]
    lacking = tuple(filter(is_lacking, (*given, *others)))
    lacked = {_of(finding) for finding in lacking}
    given = [one for one in given if not is_lacking(one)]
    others = [one for one in others if _of(one) not in lacked or one.state is State.FAIL]
    graver = [each for each in others if each.state.severity > states.get(_of(each), -1)]
    listed = (*given, *graver)
    tighter = tuple(_tighter(listed, others))
    accepted = tuple(one for one in (*given, *others) if one.accept is not None)
    return MooringInEnvironment(environment, leg, situations, listed, tighter, accepted, lacking)


def _tighter(listed: Iterable[Finding], others: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the findings in `others` that increase the utilisation of a part under a rule.

    For each rule and part, the largest utilisation in `others` is compared with the largest in
    `listed`. At most one finding is yielded for each rule and part.
    """
    known: dict[tuple[str, Place | None], float] = {}
    for one in listed:
        used = one.utilisation
        known[_of(one)] = max(known.get(_of(one), -1.0), -1.0 if used is None else used)
    for key, found in grouped_by(others, _of).items():
        one = governing(found)
        if one.utilisation is not None and one.utilisation > known.get(key, -1.0):
            yield one


def assessment_of(
    name: str, in_environments: Sequence[MooringInEnvironment], day: date | None = None
) -> Assessment:
    """Check launch, recovery and breaks of a mooring, and build its assessment.

    Launch, recovery and breaks are checked in the first environment with an equilibrium.

    Parameters
    ----------
    day : date on which acceptances must be valid; today by default
    """
    in_environments = with_cases(in_environments)
    first = next(
        (checked for checked in in_environments if checked.result is not None),
        in_environments[0],
    )
    handling = _handled(first)
    acceptance = Acceptance.of_file(first.leg.file, day)
    legs = [checked.leg for checked in in_environments if checked.result is not None]
    findings = list(findings_of_currents(legs, name, acceptance)) if legs else []
    results = [checked.result for checked in in_environments if checked.result is not None]
    findings += findings_of_drag(results, name, acceptance)
    for each in ONCE:
        verdicts = each.judge(handling)
        findings += acceptance.findings(each, verdicts, name, first.environment, each.situation)
    findings = cased(findings, in_environments)
    lacking = [one for checked in in_environments for one in checked.lacking]
    findings = with_missing((*lacking, *findings), acceptance.parts, name, first.environment)
    if first.result is not None and not moving(checked.leg for checked in in_environments):
        still = equilibrium.find(situations.STILL_ONLY, name, first.environment)
        findings.insert(0, still.but(case=situations.case_of(1, AS_GIVEN)))
    return Assessment(
        name=name,
        in_environments=tuple(in_environments),
        launch=None if isinstance(handling.launch, NoEquilibrium) else handling.launch,
        recovery=None if isinstance(handling.recovery, NoEquilibrium) else handling.recovery,
        backup=handling.backup,
        losses=handling.losses,
        limits=limits_used(first.leg.file, reaches_the_surface(first.leg)),
        inventory=inventory_of(first.leg),
        findings=tuple(findings),
        notices=tuple(
            acceptance.notices(
                [
                    *(one for checked in in_environments for one in checked.accepted),
                    *findings,
                ]
            )
        ),
    )


def with_cases(in_environments: Sequence[MooringInEnvironment]) -> tuple[MooringInEnvironment, ...]:
    """Return the environments with load-case codes added to all findings.

    If an anchor is too light in several load cases, each remedy states the largest required weight.
    """
    numbers = _environment_numbers(in_environments)
    every = (one for checked in in_environments for one in (*checked.findings, *checked.tighter))
    weights = strength.heaviest(every)

    def coded(found: Iterable[Finding]) -> tuple[Finding, ...]:
        return tuple(
            one
            if one.case
            else one.but(
                case=situations.case_of(numbers[one.environment], one.situation)
                + "w" * (one.rule in _WAVE_RULES)
            )
            for one in strength.with_one_weight(found, weights)
        )

    return tuple(
        replace(
            checked,
            findings=coded(checked.findings),
            tighter=coded(checked.tighter),
            accepted=coded(checked.accepted),
            lacking=coded(checked.lacking),
        )
        for checked in in_environments
    )


def cased(
    findings: Iterable[Finding], in_environments: Sequence[MooringInEnvironment]
) -> list[Finding]:
    """Add load-case codes to the findings on currents and drag coefficients.

    These findings get the code of their environment, without a suffix for a situation.
    """
    numbers = _environment_numbers(in_environments)
    return [
        one.but(case=situations.case_of(numbers[one.environment], AS_GIVEN))
        if one.rule in (currents.name, drag_coefficient.name)
        else one
        for one in findings
    ]


def _environment_numbers(in_environments: Sequence[MooringInEnvironment]) -> dict[str, int]:
    """Return the number of each environment, from 1, by name.

    The name in the mooring file and the name in `MooringInEnvironment` both lead to the number.
    """
    numbers: dict[str, int] = {}
    for checked in in_environments:
        number = numbers.setdefault(
            checked.leg.file.environment.name or OWN, len({*numbers.values()}) + 1
        )
        numbers.setdefault(checked.environment, number)
    return numbers


def findings_of_currents(
    legs: Sequence[Leg], name: str, acceptance: Acceptance
) -> Iterator[Finding]:
    """Yield the findings of the rules that compare all environments of a mooring."""
    for each in OF_ENVIRONMENTS:
        for leg, verdict in each.judge(legs):
            yield acceptance.of(each.find(verdict, name, leg.file.environment.name or OWN))


OF_ENVIRONMENTS = (currents, environment)
"""Rules that evaluate all environments of a mooring together."""


def findings_of_drag(
    results: Sequence[LegResult], name: str, acceptance: Acceptance
) -> Iterator[Finding]:
    """Yield the finding on drag coefficients, if any, from the results in all environments."""
    for result, verdict in drag_coefficient.judge(results):
        environment = result.file.environment.name or OWN
        yield acceptance.of(drag_coefficient.find(verdict, name, environment))


def moving(legs: Iterable[Leg]) -> bool:
    """Return whether the environment of at least one leg has a current or wind."""
    return any(
        np.hypot(each.water.u, each.water.v).max() >= situations.LEAST_CURRENT
        or each.file.environment.wind is not None
        for each in legs
    )


def findings_of(
    situation: Situation, mooring: str, environment: str, *, day: date | None = None
) -> Iterator[Finding]:
    """Yield the findings of the rules that are evaluated in every situation.

    Rules that do not apply to a leg of a net are omitted (see `is_judged`).

    Parameters
    ----------
    mooring, environment : names in the findings
    day : date on which acceptances must be valid; today by default
    """
    if situation.failure is not None:
        for verdict in equilibrium.judge(situation.failure):
            yield equilibrium.find(verdict, mooring, environment, situation.name)
    if situation.result is not None:
        acceptance = Acceptance.of_file(situation.result.file, day)
        for rule, verdicts in _verdicts_of(situation):
            yield from acceptance.findings(rule, verdicts, mooring, environment, situation.name)


@lru_cache(maxsize=16)  # environments may share situations
def _verdicts_of(situation: Situation) -> list[tuple[Rule, list[Any]]]:
    assert situation.result is not None
    file, result = situation.result.file, _estimated_in(situation)
    end, anchored = file.pieces[-1].place, file.pieces[-1].use != STAND_IN
    return [
        (rule, [one for one in rule.judge(result) if anchored or one.place != end])
        for rule in STANDING
        if is_judged(file, rule)
    ]


@lru_cache(maxsize=16)
def _estimated_in(situation: Situation) -> LegResult:
    assert situation.result is not None
    return estimated_result(situation.result)


def is_judged(file: MooringFile, rule: Rule, piece: int = 0) -> bool:
    """Return whether a rule applies to the piece of a line with the index `piece`.

    Fewer rules apply to a line that is a leg of a net.
    """
    anchored = file.pieces[-1].use != STAND_IN
    applies = anchored or not (rule.of_anchor or piece == len(file.pieces) - 1)
    return applies and rule.name not in left_out_of_a_leg(file)


def _findings_in_waves(
    given: Situation, mooring: str, environment: str, day: date | None
) -> Iterator[Finding]:
    if given.result is None:
        return
    acceptance = Acceptance.of_file(given.result.file, day)
    evidence = MooringInWaves.of(_estimated_in(given).leg)
    for each in IN_WAVES:
        yield from acceptance.findings(each, each.judge(evidence), mooring, environment)


def _of(finding: Finding) -> tuple[str, Place | None]:
    return finding.rule, finding.place


def handled(leg: Leg, result: LegResult) -> Handling:
    """Compute launch, recovery and breaks of a mooring from its equilibrium.

    If launch or recovery has no solution, the result contains the reason instead.
    """
    launch = or_why_not(launch_of, leg)
    recovery = or_why_not(recovery_of, leg, result)
    graph = LegGraph.upright(leg)
    return Handling(leg, launch, recovery, graph.breaks(leg), graph.losses(leg), result)


def _handled(checked: MooringInEnvironment) -> Handling:
    leg, result = checked.leg, checked.result
    if result is not None:
        return replace(handled(leg, result), leg=estimated(leg))
    failure = checked.situations[0].failure
    assert failure is not None
    graph = LegGraph.upright(leg)
    return Handling(leg, failure, failure, graph.breaks(leg), graph.losses(leg))


_MODULES = (
    arrangement,
    catalogue_rules,
    handling,
    joints,
    planned,
    posture,
    serials_and_dates,
    situations,
    strength,
)


_ORDER = list(TEXTS)


def _collected_rules(*, once: bool) -> tuple[Rule, ...]:
    found = chain.from_iterable(vars(module).values() for module in _MODULES)
    rules = [each for each in found if isinstance(each, Rule) and each.once == once]
    # these two rules are evaluated separately
    rules = [each for each in rules if each not in (equilibrium, currents)]
    # the order of the manual, with the rules for a particular situation last
    rules.sort(key=lambda each: (each.situation != AS_GIVEN, _ORDER.index(each.name)))
    return tuple(rules)


STANDING = _collected_rules(once=False)
"""Rules evaluated for a `LegResult`, in every environment and situation."""

ONCE = _collected_rules(once=True)
"""Rules evaluated once per mooring: breaks, launch and recovery."""

_WAVE_RULES = {each.name for each in IN_WAVES}

_WHOLE = equilibrium, *OF_ENVIRONMENTS, drag_coefficient, missing

RULES = {each.name: each for each in (*_WHOLE, *STANDING, *IN_WAVES, *ONCE)}
"""All rules by name."""


HANDLED = 64
"""Number of samples for which launch and recovery are solved.

The first samples are used: the beginning of a Sobol' sequence is itself a valid sequence.
"""

Key = tuple[str, "Place | None"]
"""Name of a rule, and place of the piece or clamp to which its finding refers."""


def with_probabilities(
    assessment: Assessment, samples: int, seed: int, mapped: Mapped = map
) -> Assessment:
    """Return a copy of an assessment with the probability that each limit is exceeded.

    Parameters
    ----------
    samples, seed, mapped : as in `calm.case.uncertain.uncertain`

    Raises
    ------
    UsageError
        The number of samples is not an allowed power of two.
    """
    normals = normals_of(checked_samples(samples), seed)
    expect_many(samples * len(assessment.in_environments), CompiledPart.NEARBY)
    draws = draws_of(assessment.file.uncertainty, normals)
    in_environments = tuple(
        _environment_with_probabilities(checked, draws, mapped)
        for checked in assessment.in_environments
    )
    first = next(
        (checked for checked in assessment.in_environments if checked.result is not None),
        None,
    )
    findings = assessment.findings
    if first is not None:
        broken = _exceeding_samples(first.leg, draws[:HANDLED], mapped, in_equilibrium=False)
        findings = _findings_with_probabilities(findings, broken, min(samples, HANDLED))
    return replace(
        assessment, in_environments=in_environments, findings=findings, draws=(samples, seed)
    )


def _environment_with_probabilities(
    checked: MooringInEnvironment, draws: Sequence[Draw], mapped: Mapped
) -> MooringInEnvironment:
    found = [checked.findings, checked.tighter, checked.accepted]
    wanted = {finding.situation for each in found for finding in each}
    for situation in checked.situations:
        if situation.result is not None and situation.name in wanted:
            broken = _exceeding_samples(situation.result.leg, draws, mapped)
            found = [
                _findings_with_probabilities(each, broken, len(draws), situation.name)
                for each in found
            ]
    return replace(checked, findings=found[0], tighter=found[1], accepted=found[2])


def _findings_with_probabilities(
    findings: tuple[Finding, ...], broken: Counter[Key], samples: int, situation: str | None = None
) -> tuple[Finding, ...]:
    return tuple(
        one.but(probability=(broken[one.rule, one.place] + broken[_ALL]) / samples)
        if one.limit is not None and situation in (None, one.situation)
        else one
        for one in findings
    )


_ALL: Key = ("", None)
"""Key of the number of samples without equilibrium."""


def _exceeding_samples(
    leg: Leg, draws: Sequence[Draw], mapped: Mapped, *, in_equilibrium: bool = True
) -> Counter[Key]:
    """Count the samples that exceed each limit.

    If `in_equilibrium` is true, the rules for the equilibrium are evaluated. Otherwise, the rules
    for launch, recovery and breaks are evaluated.
    """
    block = BLOCK if in_equilibrium else BLOCK // 16
    blocks = [draws[first : first + block] for first in range(0, len(draws), block)]
    broken: Counter[Key] = Counter()
    for each in mapped(partial(_counted, in_equilibrium, leg), blocks):
        broken.update(each)
    return broken


def _counted(in_equilibrium: bool, leg: Leg, draws: Sequence[Draw]) -> Counter[Key]:
    broken: Counter[Key] = Counter()
    for one in drawn(leg, draws):
        try:
            result = solved_alone(one)
        except NoEquilibrium:
            broken[_ALL] += 1
        else:
            if in_equilibrium:
                broken.update(_exceeded_limits(STANDING, result))
            else:
                broken.update(_exceeded_limits(ONCE, handled(one, result)))
    return broken


def _exceeded_limits(rules: Sequence[Rule], evidence: object) -> set[Key]:
    return {
        (rule.name, verdict.place)
        for rule in rules
        for verdict in (rule.counted or rule.judge)(evidence)
        if verdict.margin is not None and verdict.margin < 0.0
    }
