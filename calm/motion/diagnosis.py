"""Diagnosis of sensors: clocks, gains, offsets, drifts, slipped clamps.

Each fault is an additional unknown in the fit of the whole record. A Bayes factor (Kass and Raftery
1995) compares the fit with and without the fault. Errors follow Student's t distribution. An error
that persists over several successive times counts as one error. Faults are accepted one by one, the
most likely first.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from calm.motion import common_unknowns
from calm.motion.common_unknowns import (
    DATUM,
    ROBUST,
    LinearLaw,
    common_beforehand,
    fixed_slopes,
    repeated,
    step_times,
)
from calm.motion.correction import Task
from calm.motion.line_response import LineResponse
from calm.motion.measurements import chosen_times, interpolated
from calm.motion.remarks import ALL, LIKELY, NO_TIME, Fault
from calm.motion.suspects import Suspect, line_suspects
from calm.motion.unknown_currents import SEABED, unknown_state
from calm.physics.line import Floats

# odds above which a fault is reported if no currents were measured, as the line may be the cause
LIKELY_ALONE = 1000.0
MOST = 8  # maximum number of faults
CLOCKS, FURTHEST = 0.01, 13.0  # probability of a wrong clock, and the maximum lag searched [h]
GAIN = 0.02  # prior deviation of a gain
GAINS, ALL_GAINS = 0.01, 0.001  # probability of a wrong gain of one sensor, and of all
LEAST = {
    "moved": 3.0, "clock": 0.08, "gain": 0.003, "offset": 2.5, "drift": 1.0, "slip": 1.5,
    "currents": 0.1, "buoyancy": 0.06, "length": 0.004, "drag": 0.3,
    "fouling": 0.2,
}  # fmt: skip
"""Smallest faults that are reported.

The values for `moved`, `offset`, `drift` and `slip` are in m. The value for `clock` is in hours, or
in time steps of the record if these are longer than an hour. The value for `gain` is a pure number.
The other values are logarithms of factors.
"""
RIVALS = 3  # maximum number of rival explanations reported
FINEST = 0.02  # uncertainty added to the lag of a clock, as a share of the time step of the record
FEWEST = 20  # least number of times for a diagnosis


@dataclass(frozen=True)
class _Found:
    """Fit of a set of faults to the pressures, with its likelihood."""

    log: float  # logarithm of the likelihood
    value: float  # size of the last fault
    deviation: float  # standard deviation of this size
    left: Floats  # (n, s) residuals [m]
    # (n,) derivative of the log-likelihood of each time with respect to the size of the last fault
    pulls: Floats


Weighed = list[tuple[Suspect, float]]


def diagnosed(task: Task) -> tuple[Fault, ...]:
    """Return the faults stored in the task, or else diagnose sensors, currents and line."""
    if task.faults is not None:
        return task.faults
    law, causes = law_near(task)
    if law is None or len(law.time) < FEWEST:
        return ()
    return Diagnosis(task, law, causes).faults()


def law_near(task: Task) -> tuple[LinearLaw | None, list[Suspect]]:
    """Return the linear model of the readings, and the possible faults of line and currents.

    If there are no measurements, the model is None. If no currents were measured, the list of
    possible faults is empty.
    """
    times = chosen_times(task.measured, task.smoother is None)
    if not len(times):
        return None, []
    if task.smoother is not None:
        law, read, at = task.smoother.by_meters(times)
        return law, list(line_suspects(task, read, at, law.share))
    common, part = task.common, task.measured.at(times)
    moments = LineResponse(part, *task.forwards)
    here = unknown_state(moments, replace(common, covariance=np.zeros_like(common.covariance)))
    good = np.isfinite(here.at.depth).all(axis=1)
    time, depth = part.time[good], here.at.depth[good]
    known = np.isfinite(part.depth[good])
    left = np.where(known, here.found.innovation[good], 0.0)
    fixed = fixed_slopes(here.at.common[good][:, part.point])
    raw = np.where(known, left + fixed @ common.value, 0.0)
    fall = common_unknowns.fall(depth, moments.forward.still, part.point)
    expected, share = here.found.expected[good], task.measured.elapsed(time)
    return LinearLaw(time, share, known, raw, left, expected, fixed, fall), []


class Diagnosis:
    """Search for faults in a record; each fault is weighed by the likelihood of the pressures."""

    def __init__(self, task: Task, law: LinearLaw, causes: Sequence[Suspect] = ()) -> None:
        self.causes = causes
        self.label, self.law = task.measured.label, law
        self.measured = task.measured
        depth = float(task.mooring.water.depth) * (SEABED if task.common.inferred else DATUM)
        factors, sensors = task.common.factors, len(self.label)
        self.spread = common_beforehand(factors, depth, sensors).covariance
        self.white = np.linalg.inv(np.linalg.cholesky(law.expected))
        self.seen = self.white @ law.fixed
        self.alone = task.common.inferred
        self.likely = LIKELY_ALONE if self.alone else LIKELY
        self.step = float(np.median(np.diff(self.measured.time)) / np.timedelta64(1, "h"))
        self._kept: dict[int, Floats] = {}
        self.depth = self._after(0)

    def _after(self, steps: int) -> Floats:
        if steps not in self._kept:
            lag = np.timedelta64(round(steps * self.step * 3.6e12), "ns")
            gap = np.timedelta64(round(2.0 * self.step * 3.6e12), "ns")
            one, wanted = self.measured, self.law.time + lag
            columns = [interpolated(one.time, column, wanted, gap) for column in one.depth.T]
            self._kept[steps] = np.stack(columns, axis=1)
        return self._kept[steps]

    def _at(self, late: float) -> Floats:
        """Return the depths (n, s) [m] that the sensors read at a lag of `late` hours.

        The readings are interpolated to the times of the model plus the lag.
        """
        whole = round(late / self.step) if self.step > 0.0 else 0
        part = late / self.step - whole if self.step > 0.0 else 0.0
        before, there, after = (self._after(steps) for steps in (whole - 1, whole, whole + 1))
        # a quarter of the curvature neither amplifies nor smooths noise, which would itself favour
        # a clock error
        bent = 0.5 * part * (after - before) + 0.125 * part**2 * (after - 2.0 * there + before)
        return there + np.nan_to_num(bent)

    def faults(self) -> tuple[Fault, ...]:
        """Find the likely faults, with odds that allow for all other likely faults."""
        taken: list[Suspect] = []
        while len(taken) < MOST:
            likely = self.weighed(taken)
            best = max(likely, key=lambda one: one[1], default=None)
            if best is None:
                break
            # sum the odds of suspects with nearly the same effect on the depths
            kin = [log for one, log in likely if one.fault.alike(best[0].fault)]
            if np.logaddexp.reduce(kin) < np.log(self.likely):
                break
            taken.append(best[0])
        found = []
        for i, one in enumerate(taken):
            rest = [*taken[:i], *taken[i + 1 :]]
            weighed = sorted(self.weighed(rest), key=lambda each: -each[1])
            mine = [each for each in weighed if each[0].fault.same(one.fault)]
            others = [each for each in weighed if not each[0].fault.same(one.fault)]
            if not mine:
                continue
            (suspect, log), *_ = mine
            rest_of = float(np.logaddexp.reduce([0.0, *(each[1] for each in others)]))
            fault = replace(suspect.fault, odds=float(np.exp(min(log - rest_of, 50.0))))
            near = [each for each in others if each[1] > log - np.log(LIKELY)][:RIVALS]
            rival = ", or ".join(
                f"{each.fault.sentence()} ({np.exp(min(other - log, 9.0)):.2g} times as likely)"
                for each, other in near
            )
            found.append(fault if fault.certain else replace(fault, rival=rival))
        return tuple(found)

    def weighed(self, taken: list[Suspect]) -> Weighed:
        """Return every possible fault that is not in `taken`, with its log odds."""
        result = []
        for suspect in self._suspects(taken, self.fitted(taken, None, 1.0)):
            alike = repeated(self.fitted(taken, suspect, 1.0).pulls)
            base = self.fitted(taken, None, alike).log
            found = self.fitted(taken, suspect, alike)
            fault, least, deviation = suspect.fault, LEAST[suspect.fault.kind], found.deviation
            size = found.value if suspect.wide else fault.size
            log = found.log - base + suspect.log
            if fault.kind == "clock":  # uniform prior of the lag
                log += float(np.log(np.sqrt(2.0 * np.pi) * deviation / (2.0 * FURTHEST)))
                least *= max(self.step, 1.0)
                deviation = float(np.hypot(deviation, FINEST * self.step))
            if abs(size) >= least:
                result.append((replace(suspect, fault=fault.sized(size, deviation)), log))
        return result

    def _raw(self, taken: list[Suspect]) -> Floats:
        return self.law.raw + sum(one.shift for one in taken)

    def fitted(self, taken: list[Suspect], last: Suspect | None, alike: float) -> _Found:
        """Fit the sizes of faults to the readings, and return the fit with its likelihood.

        The faults are those in `taken` and, if given, `last`. `alike` is the number of successive
        times that share an error.
        """
        whole = taken if last is None else [*taken, last]
        free = [one for one in whole if one.wide]
        columns = np.stack([self.law.fixed[:, :, 0], *(one.column for one in free)], axis=2)[
            :, :, 1:
        ]
        raw = self._raw(whole)
        seen = np.concatenate([self.seen, self.white @ columns], axis=2)
        left = (self.white @ raw[:, :, None])[:, :, 0]
        turned = seen.transpose(0, 2, 1)
        squares, own = turned @ seen, (turned @ left[:, :, None])[:, :, 0]
        before = np.pad(np.linalg.inv(self.spread), (0, len(free)))
        for i, one in enumerate(free, len(self.spread)):
            before[i, i] = one.wide**-2
        count, most = self.law.known.sum(axis=1), (left**2).sum(axis=1)
        weight = np.ones(len(left))
        for _ in range(4):
            normal = np.einsum("n,nqr->qr", weight / alike, squares) + before
            value = np.linalg.solve(normal, np.einsum("n,nq->q", weight / alike, own))
            misfit = most - 2.0 * own @ value + np.einsum("nqr,q,r->n", squares, value, value)
            misfit = np.maximum(misfit, 0.0)
            weight = (ROBUST + count) / (ROBUST + misfit)
        log = -0.5 * float(((ROBUST + count) * np.log1p(misfit / ROBUST)).sum()) / alike
        log -= 0.5 * float(value @ before @ value + np.linalg.slogdet(normal)[1])
        log += 0.5 * float(np.linalg.slogdet(before)[1])
        size, deviation, pulls = 0.0, 0.0, weight
        if last is not None:
            column = (self.white @ last.column[:, :, None])[:, :, 0]
            pulls = weight * (column * (left - seen @ value)).sum(axis=1)
            information = float((weight * (column**2).sum(axis=1)).sum()) / alike
            size = float(value[-1]) if last.wide else 0.0
            spread = np.linalg.inv(normal)[-1, -1] if last.wide else 1.0 / max(information, 1e-12)
            deviation = float(np.sqrt(spread))
        common, own = np.split(value, [len(self.spread)])
        return _Found(log, size, deviation, raw - self.law.fixed @ common - columns @ own, pulls)

    def _suspects(self, taken: list[Suspect], begun: _Found) -> Iterator[Suspect]:
        law, none = self.law, np.zeros_like(self.law.raw)
        had = {(one.fault.label, one.fault.kind) for one in taken}
        # use fitted depths: with measured ones, a gain below 1 would also shrink the errors
        depth = np.nan_to_num(self.depth - begun.left)
        raw = self._raw(taken)
        for one in taken:
            if one.wide:
                raw = raw - one.column * one.fault.size
        rest = replace(law, raw=raw, left=begun.left)
        sensors = np.arange(len(self.label))
        columns = [law.fall * (sensors == j) for j in sensors]
        *slips, start = step_times(rest, self.spread, [*columns, none + 1.0])
        for j, label in enumerate(self.label):
            mine = sensors == j
            codes = dict.fromkeys(common_unknowns.RAMPS, "drift")
            # inferred currents would absorb the offset of a sensor
            if not self.alone:
                codes |= dict.fromkeys((0, common_unknowns.MISHUNG), "offset")
            if slips[j]:
                codes[slips[j]] = "slip"
            for code, kind in codes.items():
                if (label, kind) in had or law.known[:, j].sum() < common_unknowns.FEWEST:
                    continue
                column = mine * common_unknowns.moved_by(code, law.fall[:, j], law.share)[:, None]
                chance, wide = common_unknowns.chance_of(code, len(law.time))
                since, until = law.time[code] if kind == "slip" else NO_TIME, NO_TIME
                if kind == "drift":
                    since = self.measured.time[0]
                    span = self.measured.time[-1] - since
                    until = since + common_unknowns.RAMPS[code] * span
                fault = Fault(label, kind, since=since, until=until)
                yield Suspect(fault, column, wide, chance)
        several = len(self.label) > 1 and not self.alone
        if several and start and (ALL, "moved") not in had:
            step = np.where(np.arange(len(law.time)) >= start, 1.0, 0.0)[:, None] + none
            fault = Fault(ALL, "moved", since=law.time[start])
            chance = float(np.log(common_unknowns.MOVED / len(law.time)))
            yield Suspect(fault, step, common_unknowns.ELSEWHERE, chance)
        yield from (one for one in self.causes if (one.fault.label, one.fault.kind) not in had)
        whose = [*zip(self.label, np.eye(len(self.label), dtype=bool), strict=True)]
        for label, mine in [*whose, *[(ALL, np.ones(len(self.label), bool))] * several]:
            if (label, "gain") not in had and not self.alone:
                chance = float(np.log(ALL_GAINS if label == ALL else GAINS))
                yield Suspect(Fault(label, "gain"), depth * mine, GAIN, chance)
            if (label, "clock") not in had:
                late = self._late(taken, begun.left, mine)
                if late.fault.value:
                    yield late

    def _shift(self, late: float, mine: NDArray[np.bool_]) -> Floats:
        added: Floats = np.where(mine, np.nan_to_num(self._at(late) - self.depth), 0.0)
        return added

    def _missed(self, left: Floats) -> float:
        """Return twice the negative log-likelihood of residuals (n, s) [m]."""
        misfit = np.square((self.white @ left[:, :, None])[:, :, 0]).sum(axis=1)
        count = self.law.known.sum(axis=1)
        return float(((ROBUST + count) * np.log1p(misfit / ROBUST)).sum())

    def _late(self, taken: list[Suspect], left: Floats, mine: NDArray[np.bool_]) -> Suspect:
        """Find the most likely clock error that the sensors in the mask `mine` have in common."""
        reach, step = int(FURTHEST / self.step) if self.step > 0.0 else 0, self.step

        def miss(late: float) -> float:
            return self._missed(left + self._shift(late, mine))

        late = min((step * lag for lag in range(-reach, reach + 1)), key=miss)
        for _ in range(6):
            suspect = self._clock(late, mine)
            left = self.fitted([*taken, suspect], None, 1.0).left - suspect.shift
            step *= 0.5
            late = min((late - step, late, late + step), key=miss)
        return self._clock(late, mine)

    def _clock(self, late: float, mine: NDArray[np.bool_]) -> Suspect:
        label = ALL if mine.all() and len(mine) > 1 else self.label[int(mine.argmax())]
        shift, half = self._shift(late, mine), 0.5 * self.step
        rate = (self._shift(late + half, mine) - self._shift(late - half, mine)) / self.step
        fault = Fault(label, "clock", late)
        return Suspect(fault, rate, 0.0, float(np.log(CLOCKS)), shift)
