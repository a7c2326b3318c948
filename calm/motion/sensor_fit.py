"""Whether a suspicious sensor fits the line: yes, no, or it cannot be told, with the odds."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from calm.motion.common_unknowns import MISPLACED, SPIKE
from calm.motion.correction import Task
from calm.motion.diagnosis import FEWEST, Diagnosis, law_near
from calm.motion.matching import without
from calm.motion.measurements import MooringMeasurements
from calm.motion.remarks import LIKELY
from calm.motion.suspects import NO_TIME, Suspect

FITS = 5.0
"""Odds from which it does. A zero known to a metre speaks 20 to 1 at most against one off by 20."""


@dataclass(frozen=True)
class SensorFit:
    """Tell whether the pressures of a sensor fit the line.

    Attributes
    ----------
    fits : None where it cannot be told
    odds : that they fit, against that they do not
    reason : what is wrong with it instead, in a sentence; empty where that is not clear
    """

    label: str
    fits: bool | None
    odds: float
    reason: str

    def sentence(self) -> str:
        """Return what is said of it."""
        if self.fits is None:
            return f"{self.label}: whether its pressures fit the line cannot be told ({self._odds})"
        return (
            f"{self.label}: its pressures {'fit' if self.fits else 'do not fit'} the line "
            f"({self._odds}){f'; {self.reason}' if self.reason else ''}"
        )

    @property
    def _odds(self) -> str:
        for_it = self.odds >= 1.0
        times = min(self.odds if for_it else 1.0 / self.odds, 1e6)
        more = "more than " if times == 1e6 else ""
        figure = f"{more}{times:.0f}" if times >= 10.0 else f"{times:.1f}"
        return f"odds {figure} to 1 that they do{'' if for_it else ' not'}"


def fit_of(task: Task, measured: MooringMeasurements, label: str) -> SensorFit:
    """Return whether the pressures of a sensor that was hidden fit the line.

    That they do is weighed, at even odds, against a place or a zero that is wrong, and against
    readings that say nothing of the line; other faults of it are as rare as those of any sensor.
    The others may have faults as well.

    Parameters
    ----------
    task : in which it is hidden
    measured : with it
    label : its name
    """
    kept = without(
        measured, [one for one in measured.label if one not in (*task.measured.label, label)]
    )
    at, one, common = kept.label.index(label), task.measured, task.common
    level = one.level_sensor + (one.level_sensor >= at)
    with_it = replace(one, label=kept.label, point=kept.point, depth=kept.depth, level_sensor=level)
    common = replace(
        common,
        offset=np.insert(common.offset, at, 0.0),
        moved=np.insert(common.moved, at, 0.0),
        since=np.insert(common.since, at, NO_TIME),
        until=None if common.until is None else np.insert(common.until, at, NO_TIME),
        covariance=np.eye(len(common.value) + 2),
    )
    whole = Task(task.mooring, with_it, common)
    law, _ = law_near(task, whole)
    if law is None or law.known[:, at].sum() < FEWEST:
        return SensorFit(label, None, 1.0, "")
    diagnosis = Diagnosis(whole, law, judged=label)
    taken: list[Suspect] = []
    while True:
        both = diagnosis.weighed(taken)
        mine = [one for one in both if label in (one[0].fault.label, one[0].fault.other)]
        others = [one for one in both if label not in (one[0].fault.label, one[0].fault.other)]
        best = max(others, key=lambda one: one[1], default=None)
        if best is None or best[1] < max(np.log(LIKELY), *(log for _, log in mine)):
            break
        taken.append(best[0])
    against = [log - np.log(MISPLACED) * (one.fault.kind == "offset") for one, log in mine]
    wide = law.expected.copy()  # as of readings that say nothing of the line
    wide[:, at, at] += np.where(law.known[:, at], SPIKE**2, 0.0)
    nothing = Diagnosis(whole, replace(law, expected=wide)).fitted(taken, None, 1.0).log
    nothing -= diagnosis.fitted(taken, None, 1.0).log
    size = np.linalg.slogdet(wide)[1] - np.linalg.slogdet(law.expected)[1]
    nothing -= 0.5 * float(size.sum())
    for_it = np.logaddexp.reduce([0.0, *(log for _, log in others)])
    against_it = np.logaddexp.reduce([*against, nothing])
    odds = float(np.exp(np.clip(for_it - against_it, -50.0, 50.0)))
    fits = None if 1.0 / LIKELY < odds < FITS else odds > 1.0
    reason = ""
    if fits is False and max(against) > nothing:
        reason = mine[int(np.argmax(against))][0].fault.sentence()
    return SensorFit(label, fits, odds, reason)
