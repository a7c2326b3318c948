"""How often the limits of a design are broken in a batch."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.limits import Limit
from calm.batch.statistics.series import Column, Series
from calm.checks.finding import State


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
    """How often a rule fails, or warns, anywhere on the line, of the profiles solved."""

    name: str
    title: str
    fails: float
    warns: float
    unknown: int
    exceedances: tuple[Exceedance, ...]


def shares_of(series: Series, limits: Iterable[Limit], solved: int) -> Iterator[RuleShare]:
    """How often each rule fails, from its limits, which follow one another.

    Parameters
    ----------
    solved : profiles that the shares of the rules are of
    """
    for rule, group in groupby(limits, key=lambda limit: limit.rule):
        beyond = {state: np.zeros(len(series), np.bool_) for state in (State.FAIL, State.WARN)}
        exceedances = []
        for limit in group:
            if limit.limit is None:
                exceedances.append(Exceedance(limit, 0, None, None, None))
                continue
            values = limit.values(series)
            broken = limit.broken(values)
            beyond[limit.beyond] |= broken
            exceedances.append(_exceedance(series, limit, values, broken))
        warned = beyond[State.WARN] & ~beyond[State.FAIL]
        yield RuleShare(
            name=rule.name,
            title=rule.title,
            fails=int(beyond[State.FAIL].sum()) / max(solved, 1),
            warns=int(warned.sum()) / max(solved, 1),
            unknown=sum(one.limit.limit is None for one in exceedances),
            exceedances=tuple(exceedances),
        )


def _exceedance(
    series: Series, limit: Limit, values: Column, broken: NDArray[np.bool_]
) -> Exceedance:
    count = int(np.isfinite(values).sum())
    if not count:
        return Exceedance(limit, 0, None, None, None)
    worst = int(np.nanargmin(values) if limit.least else np.nanargmax(values))
    share = int(broken.sum()) / count
    return Exceedance(limit, count, share, float(values[worst]), series.time[worst])
