"""Estimate of the motion from files of sensors: what ``calm motion`` reads and computes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event
from typing import TYPE_CHECKING

import numpy as np

from calm.batch.finished import open_result
from calm.batch.profiles import processors
from calm.batch.run import BatchOutcome, run_kept
from calm.batch.work import Progress
from calm.batch.work_store import identity_of, open_store, to_text
from calm.case import Design
from calm.dataset.discovery import hashed
from calm.errors import UsageError, not_among, unknown
from calm.files.legs import refuse_all_but_moorings
from calm.motion import matching, sensors
from calm.motion.common_unknowns import MISPLACED, SPIKE
from calm.motion.correction import BLOCK, MeasuredRecord, MotionWork, Task, motion_layout
from calm.motion.diagnosis import FEWEST, Diagnosis, diagnosed, law_near
from calm.motion.line_response import FACTORS, instruments_of
from calm.motion.matching import without
from calm.motion.measurements import CurrentMeasurements, MooringMeasurements, joined, read_currents
from calm.motion.remarks import ALL, LIKELY, NO_TIME, Fault, SensorFit
from calm.motion.study import MotionEstimate, cross_validated, judged, prepare, several
from calm.motion.suspects import Suspect, distances_of, torn
from calm.records.instrument_series import split_label

if TYPE_CHECKING:
    from xarray import Dataset


_MATCHES = ("label", "height", "depth")
CORRECTABLE = ("clock", "gain", "offset", "drift", "air")
"""What can be taken off what a sensor reads: of `calm.motion.remarks.Fault`, and the air."""
GAP = np.timedelta64(2, "h")
"""Longest time between two values that are interpolated, where nothing else is asked for."""


def fitted(asked: Sequence[str] = (), currents: bool = True) -> tuple[str, ...]:
    """Return the factors that are estimated: those of the drag, and what is asked for besides.

    Without currents a factor on all drag is one on the currents: that of cables is none unless
    asked for, and the length is one of those that are estimated.

    UsageError: what is asked for cannot be estimated.
    """
    for name in asked:
        if name not in FACTORS:
            raise UsageError(unknown(f"--fit: `{name}` cannot be estimated", name, FACTORS))
    usual = ("cable_drag", "rigid_drag") if currents else ("rigid_drag", "length")
    return tuple(name for name in FACTORS if name in asked or name in usual)


@dataclass
class RecoveredMooring:
    """A mooring that was recovered: read, put right, estimated and judged, in this order.

    Attributes
    ----------
    mooring : with a position
    pressures, currents : files, as their paths or as ``LABEL=PATH``
    match : by `label`, or by nominal `height` or `depth`
    fit : what is estimated besides the drag
    hold_out : labels of sensors that are hidden, and at which the result is judged
    cross_validate : whether each used sensor is hidden in turn
    correct : of `CORRECTABLE`, what is taken off where nothing else is as likely
    judge : label of a sensor that is hidden, and of which is said whether it fits; empty of none
    sea_level : the height of the sea surface, as a path
    flags : of the pressures that count as measured, separated by commas
    gap : longest time between two values that are interpolated
    declination : added to the directions of the currents [degrees]
    prior : a record of currents whose shapes are taken, where none were measured; None of none
    measured, notes, source : what was read, with notes on it and the source files

    Raises
    ------
    InputError, UsageError
        A file cannot be read, the mooring has no position, no sensor is left, or what is asked for
        cannot be done.
    """

    mooring: Design
    pressures: Sequence[str]
    currents: Sequence[str] = ()
    match: str = "label"
    fit: Sequence[str] = ()
    hold_out: Sequence[str] = ()
    cross_validate: bool = False
    correct: Sequence[str] = ()
    judge: str = ""
    sea_level: Path | None = None
    flags: str = "1,2"
    gap: np.timedelta64 = GAP
    declination: float | None = None
    prior: Path | None = None
    _faults: tuple[Fault, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        """Read the files."""
        for kind in self.correct:
            if kind not in CORRECTABLE:
                what = f"--correct: `{kind}` cannot be taken off"
                raise UsageError(unknown(what, kind, CORRECTABLE))
        self.names = fitted(self.fit, bool(self.currents))
        judged_too = [self.judge] if self.judge and self.judge not in self.hold_out else []
        self.hidden = [*self.hold_out, *judged_too]
        self._read()
        self.shapes: list[CurrentMeasurements] = []
        if self.prior is not None:
            if self.currents:
                raise UsageError("--prior is for pressures alone; here --currents are given")
            limit = self.mooring.file.environment.maximum_speed
            depth = float(self.mooring.water.depth)
            self.shapes = read_currents([self.prior], depth, None, self.declination, limit)
            self.notes += [f"{one.source}: {note}" for one in self.shapes for note in one.notes]
        if self.judge and self.judge not in self.measured.label:
            what = f"--judge: no sensor is called `{self.judge}`"
            raise UsageError(unknown(what, self.judge, self.measured.label))
        if self.cross_validate:
            several(self.measured, self.hidden)

    def _read(self) -> None:
        """Read what was measured, at common times, less the faults that are known."""
        mooring, position = self.mooring, self.mooring.file.position
        if self.match not in _MATCHES:
            raise UsageError(not_among("--match", self.match, _MATCHES))
        if position is None:
            raise UsageError(
                f"{mooring.file.path} has no `position`, whose latitude turns pressures into depths"
            )
        seabed, line = float(mooring.water.depth), matching.places_of(mooring)
        wanted = sensors.parse_flags(self.flags)
        given = sensors.read_sensors(self.pressures, wanted, position.latitude, seabed)
        if self.match == "label":
            points, notes = matching.matched_by_label(given, line)
        else:
            points, notes = matching.matched_by_place(given, line, instruments_of(mooring))
        read = read_currents(
            self.currents, seabed, (position.latitude, position.longitude), self.declination,
            mooring.file.environment.maximum_speed,
        )  # fmt: skip
        notes += dict.fromkeys(f"{one.source}: {one.note}" for one in given if one.note)
        used, absolute = [], "air" in self.correct
        for i, at in points.items():
            depth = given[i].value - sensors.AIR * absolute
            one = replace(given[i], label=line.label[at], value=depth)
            for fault in self._faults:
                if fault.label in (ALL, one.label):
                    time, depth = fault.taken_off(one.time, one.value)
                    one = replace(one, time=time, value=depth)
            one, said = sensors.plausible(one, float(line.still[at]), seabed)
            used.append(one)
            notes += said
            if one.dropped:
                notes.append(f"{one.label}: {one.dropped} pressures left out for their flag")
        if not any(np.isfinite(one.value).any() for one in used):
            raise UsageError("--pressures: no sensor has a good pressure: " + "; ".join(notes))
        level = None if self.sea_level is None else sensors.read_sea_level(self.sea_level)
        where = list(points.values())
        measured = joined(read, used, where, line.label, line.still, self.gap, level)
        notes += [f"{one.source}: {note}" for one in read for note in one.notes]
        places = line.still[measured.point]
        notes += sensors.air_notes(measured.depth, places)
        lost = sensors.unusable(measured.label, measured.depth, places)
        notes += [f"{label} {reason}" for label, reason in lost.items()]
        measured = without(measured, list(lost))
        if not measured.label:
            raise UsageError("--pressures: no sensor is left: " + "; ".join(notes))
        self.measured, said = torn(measured, distances_of(mooring))
        self.notes = notes + said
        self.source = {
            "currents": ", ".join(hashed(split_label(one)[1]) for one in self.currents),
            "pressures": ", ".join(hashed(split_label(one)[1]) for one in self.pressures),
        }
        off = [one.sentence() for one in self._faults]
        off += ["all sensors: 10.13 dbar, the pressure of the air"] * absolute
        if off:
            self.source["corrected"] = "taken off: " + "; ".join(off)
        if self.prior is not None:
            self.source["prior"] = hashed(self.prior)

    def _prepared(self, tell: Callable[[str], None]) -> Task:
        return prepare(self.mooring, self.measured, self.names, self.hidden, tell, self.shapes)

    def estimate(
        self,
        output: Path,
        *,
        workers: int | None = None,
        progress: Callable[[Progress], None] | None = None,
        tell: Callable[[str], None] = lambda _: None,
        stop: Event | None = None,
    ) -> BatchOutcome:
        """Estimate what is common to the record, take off what is wrong, and write every time.

        Parameters
        ----------
        output, workers, progress, tell, stop : see `calm.batch.run.run_batch`
        """
        task = self._prepared(tell)
        found = diagnosed(task) if self.correct else ()
        wrong = [one for one in found if one.kind in self.correct and one.certain]
        if wrong:
            self._faults = tuple(replace(one, corrected=True) for one in wrong)
            self._read()
            task = self._prepared(tell)
        self.task, stop = task, stop or Event()
        options = {
            "fit": sorted(self.names),
            "hold_out": sorted(self.hidden),
            "correct": self.source.get("corrected", ""),
            "prior": self.source.get("prior", ""),
        }
        record = MeasuredRecord(self.measured, self.source, self.notes)

        def identify() -> str:
            return to_text(identity_of(self.mooring, record, options, stop))

        def begin(folder: Path, identity: str) -> MotionWork:
            store = open_store(folder, motion_layout(task, record), BLOCK, identity)
            return MotionWork(task, record, store, progress, stop)

        def solve(work: MotionWork) -> None:
            work.here(workers or processors())

        return run_kept(output, identify, begin, solve, tell)

    def study(
        self,
        result: Dataset,
        tell: Callable[[str], None] = lambda _: None,
        workers: int | None = None,
    ) -> MotionEstimate:
        """Return how a finished result agrees with all that was measured.

        Parameters
        ----------
        result : of `estimate`
        tell : is told what is going on
        workers : threads
        """
        faults = (*self._faults, *diagnosed(self.task))
        study = replace(judged(self.task, self.measured, result, faults), notes=tuple(self.notes))
        if self.judge:
            study = replace(study, judged=fit_of(self.task, self.measured, self.judge))
        if self.cross_validate:
            each = cross_validated(
                self.mooring, self.measured, self.names, self.hidden, tell, workers, self.shapes
            )
            held = {**study.held_out, **{one.label: one for one in each}}
            study = replace(study, held_out=held)
        return study


FITS = 5.0
"""Odds from which it does. A zero known to a metre speaks 20 to 1 at most against one off by 20."""


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
    with_it = replace(one, label=kept.label, point=kept.point, depth=kept.depth)
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
    if diagnosis.alone:  # what the line is wrong by where no pressure was is for all times alike
        own = with_it.depth[:, at]
        zero = len(common.factors) + 1 + at
        wrong = common.worst * float(np.nanmean(own) - np.nanpercentile(own, 5.0))
        diagnosis.spread[zero, zero] += wrong**2
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
    other = Diagnosis(whole, replace(law, expected=wide))
    other.spread = diagnosis.spread
    nothing = other.fitted(taken, None, 1.0).log
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


def estimate_motion(
    mooring: Design,
    pressures: Sequence[str | Path],
    currents: Sequence[str | Path] = (),
    *,
    match: str = "label",
    fit: Sequence[str] = (),
    hold_out: Sequence[str] = (),
    cross_validate: bool = False,
    sea_level: str | Path | None = None,
    flags: Sequence[int] = (1, 2),
    gap: float | None = None,
    declination: float | None = None,
    correct: Sequence[str] = (),
    judge: str = "",
    prior: str | Path | None = None,
    workers: int | None = None,
) -> MotionEstimate:
    """Estimate the depth of every part of a mooring at every time, as ``calm motion`` does.

    Parameters
    ----------
    mooring : with a position
    pressures : files of the sensors on the line, as paths or as ``LABEL=PATH``
    currents : files of the current, as paths or as ``LABEL=PATH``; none: they are learnt from the
        pressures of two sensors or more
    match : how sensors are found on the line: by `label`, or by nominal `height` or `depth`
    fit : what to estimate for the whole record besides the drag: `buoyancy`, `length`
    hold_out : labels of sensors that are hidden, and at which the result is judged
    cross_validate : hide each used sensor in turn, and judge
    sea_level : the height of the sea surface over time, as a path
    flags : quality flags of the pressures that count as measured
    gap : longest time between two values that are interpolated [s]; two hours where not given
    declination : added to the directions of the currents [degrees]
    correct : what is taken off where a sensor is wrong: `clock`, `gain`, `offset`, `drift`; `air`
        of absolute pressures
    judge : label of a sensor that is hidden, and of which is said whether it fits the line
    prior : a record of currents whose shapes are taken, without `currents`
    workers : threads; one for each processor that may be used where not given

    Raises
    ------
    InputError, UsageError
        A file cannot be read or does not belong to the mooring; too few sensors are left.
    """
    refuse_all_but_moorings(mooring.file)
    recovery = RecoveredMooring(
        mooring,
        [str(path) for path in pressures],
        [str(path) for path in currents],
        match,
        fit,
        hold_out,
        cross_validate,
        correct,
        judge,
        None if sea_level is None else Path(sea_level),
        ",".join(map(str, flags)),
        GAP if gap is None else np.timedelta64(round(gap * 1e9), "ns"),
        declination,
        None if prior is None else Path(prior),
    )
    with TemporaryDirectory() as folder:
        output = Path(folder) / "motion.nc"
        recovery.estimate(output, workers=workers)
        with open_result(output) as kept:
            dataset = kept.load()
    return recovery.study(dataset, workers=workers)
