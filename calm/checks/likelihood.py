"""The probability that each limit is broken, given how uncertain the inputs of the design are.

The limits of a line that stands are counted in every sample, in the situation of the finding. A
launch or a rise takes as long to solve as many equilibria: these, and the breaks, are counted in
the first `HANDLED` samples. A sample without equilibrium breaks every limit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from calm.case.draws import Draw, checked_samples, drawn, draws_of, normals_of
from calm.case.uncertain import BLOCK, Mapped
from calm.checks.assess import handled
from calm.checks.finding import Finding, Rule
from calm.checks.rules import ONCE, STANDING
from calm.errors import NoEquilibrium
from calm.solve import expect_many

if TYPE_CHECKING:
    from calm.case import Mooring
    from calm.checks.assessment import Assessment, MooringInEnvironment
    from calm.files import Place

HANDLED = 64
"""Samples whose launch and recovery are solved: the first of the sequence, a sequence as well."""

Key = tuple[str, "Place | None"]
"""A rule, and the part of the line that it is found on."""


def with_probabilities(
    assessment: Assessment, samples: int, seed: int, mapped: Mapped = map
) -> Assessment:
    """The assessment, each of its findings with the probability that its limit is broken.

    Parameters
    ----------
    samples, seed, mapped : as of `calm.case.uncertain.uncertain`

    Raises
    ------
    UsageError
        The number of samples is not a power of two, or none that is solved.
    """
    normals = normals_of(checked_samples(samples), seed)
    expect_many(samples * len(assessment.stands))
    draws = draws_of(assessment.mooring.file.uncertainty, normals)
    stands = tuple(_stand(stand, draws, mapped) for stand in assessment.stands)
    first = next((stand for stand in assessment.stands if stand.result is not None), None)
    findings = assessment.findings
    if first is not None:
        broken = _broken(first.mooring, draws[:HANDLED], mapped, standing=False)
        findings = _probable(findings, broken, min(samples, HANDLED))
    return replace(assessment, stands=stands, findings=findings, draws=(samples, seed))


def _stand(
    stand: MooringInEnvironment, draws: Sequence[Draw], mapped: Mapped
) -> MooringInEnvironment:
    """With the probabilities of every situation that something is listed of."""
    found = [stand.findings, stand.tighter, stand.accepted]
    wanted = {finding.situation for each in found for finding in each}
    for situation in stand.situations:
        if situation.result is not None and situation.name in wanted:
            mooring = situation.result.mooring
            broken = _broken(mooring, draws, mapped)
            found = [_probable(each, broken, len(draws), situation.name) for each in found]
    return replace(stand, findings=found[0], tighter=found[1], accepted=found[2])


def _probable(
    findings: tuple[Finding, ...],
    broken: Counter[Key],
    samples: int,
    situation: str | None = None,
) -> tuple[Finding, ...]:
    """The findings, those of a situation that have a limit with how often it was broken."""
    return tuple(
        replace(one, probability=(broken[one.rule, one.place] + broken[_ALL]) / samples)
        if one.limit is not None and situation in (None, one.situation)
        else one
        for one in findings
    )


_ALL: Key = ("", None)
"""Under which samples without equilibrium are counted."""


def _broken(
    mooring: Mooring, draws: Sequence[Draw], mapped: Mapped, *, standing: bool = True
) -> Counter[Key]:
    """Return how many samples break each limit, of a line that stands or of its handling."""
    block = BLOCK if standing else BLOCK // 16
    blocks = [draws[first : first + block] for first in range(0, len(draws), block)]
    broken: Counter[Key] = Counter()
    for each in mapped(partial(_counted, standing, mooring), blocks):
        broken.update(each)
    return broken


def _counted(standing: bool, mooring: Mooring, draws: Sequence[Draw]) -> Counter[Key]:
    broken: Counter[Key] = Counter()
    for one in drawn(mooring, draws):
        try:
            result = one.solve()
        except NoEquilibrium:
            broken[_ALL] += 1
        else:
            if standing:
                broken.update(_beyond(STANDING, result))
            else:
                broken.update(_beyond(ONCE, handled(one, result)))
    return broken


def _beyond(rules: Sequence[Rule], evidence: object) -> set[Key]:
    """Return what is beyond its limit, each once."""
    return {
        (rule.name, verdict.place)
        for rule in rules
        for verdict in rule.judge(evidence)
        if verdict.margin is not None and verdict.margin < 0.0
    }
