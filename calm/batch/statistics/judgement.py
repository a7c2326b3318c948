"""How often the limits of a design are broken in a batch."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.limits import Limit
from calm.batch.statistics.series import Series
from calm.batch.statuses import Ending
from calm.checks.finding import Rule, State
from calm.checks.rules import equilibrium


@dataclass(frozen=True)
class Exceedance:
    """How often a limit is broken: `share` of the `count` profiles in which it can be judged.

    `worst` is the value furthest beyond the limit, or nearest to it, and `time` its time; None
    where there is no limit or nothing to judge.
    """

    limit: Limit
    count: int
    share: float | None
    worst: float | None
    time: np.datetime64 | None


@dataclass(frozen=True)
class RuleShare:
    """How often a rule fails, or warns, anywhere on the line.

    Attributes
    ----------
    judged : profiles in which one of its limits at least is judged
    fails, warns : share of these in which it fails, or only warns; None where there are none
    fails_at_most : share in which it fails if it does in every profile that has a current and was
        not solved, of these and those judged; None where none is judged
    unknown : limits that are judged in no profile, most often for want of a figure
    exceedances : of its limits
    """

    name: str
    title: str
    judged: int
    fails: float | None
    fails_at_most: float | None
    warns: float | None
    unknown: int
    exceedances: tuple[Exceedance, ...]


def equilibrium_share(ended: Mapping[Ending, int]) -> RuleShare:
    """How often the line has no equilibrium; a profile that did not converge is not judged.

    Parameters
    ----------
    ended : profiles by how they ended
    """
    without = ended[Ending.NO_EQUILIBRIUM]
    judged = ended[Ending.SOLVED] + without
    return _rule_share(equilibrium, judged, without, 0, ended[Ending.NOT_CONVERGED], ())


def shares_of(series: Series, limits: Iterable[Limit], unsolved: int) -> Iterator[RuleShare]:
    """How often each rule fails, from its limits, which follow one another.

    Parameters
    ----------
    unsolved : profiles with a current for which there is no solution to judge
    """
    for rule, group in groupby(limits, key=lambda limit: limit.rule):
        beyond = {state: np.zeros(len(series), np.bool_) for state in (State.FAIL, State.WARN)}
        judged = np.zeros(len(series), np.bool_)
        exceedances = tuple(
            _exceedance(series, limit, beyond[limit.beyond], judged) for limit in group
        )
        beyond[State.WARN] &= ~beyond[State.FAIL]
        yield _rule_share(
            rule,
            int(np.count_nonzero(judged)),
            int(np.count_nonzero(beyond[State.FAIL])),
            int(np.count_nonzero(beyond[State.WARN])),
            unsolved,
            exceedances,
        )


def _rule_share(
    rule: Rule,
    judged: int,
    failed: int,
    warned: int,
    unsolved: int,
    exceedances: tuple[Exceedance, ...],
) -> RuleShare:
    """The shares of a rule from numbers of profiles."""
    return RuleShare(
        name=rule.name,
        title=rule.title,
        judged=judged,
        fails=failed / judged if judged else None,
        fails_at_most=(failed + unsolved) / (judged + unsolved) if judged else None,
        warns=warned / judged if judged else None,
        unknown=sum(one.count == 0 for one in exceedances),
        exceedances=exceedances,
    )


def _exceedance(
    series: Series, limit: Limit, beyond: NDArray[np.bool_], judged: NDArray[np.bool_]
) -> Exceedance:
    """How often a limit is broken; adds the profiles beyond it, and those judged, to the others."""
    if limit.limit is None:
        return Exceedance(limit, 0, None, None, None)
    values = limit.values(series)
    broken, known = limit.broken(values), np.isfinite(values)
    beyond |= broken
    judged |= known
    count = int(np.count_nonzero(known))
    if not count:
        return Exceedance(limit, 0, None, None, None)
    edge = np.fmin.reduce(values) if limit.least else np.fmax.reduce(values)
    share = int(np.count_nonzero(broken)) / count
    return Exceedance(limit, count, share, float(edge), series.time[np.argmax(values == edge)])
