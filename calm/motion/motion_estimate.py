"""Where a mooring was, from the files of its sensors: what ``calm motion`` reads and estimates."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event
from typing import TYPE_CHECKING

import numpy as np

from calm.batch.finished import open_result
from calm.batch.run import BatchOutcome
from calm.batch.work import Progress
from calm.case import Mooring
from calm.dataset.discovery import hashed
from calm.errors import UsageError, unknown
from calm.motion.correction import MeasuredRecord, Task, run_motion
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import FACTORS
from calm.motion.matching import CORRECTABLE, GAP, read_measured
from calm.motion.measurements import CurrentMeasurements, read_currents
from calm.motion.remarks import Agreement, Fault
from calm.motion.sensor_fit import SensorFit, fit_of
from calm.motion.study import HeldOut, Study, cross_validated, judged, prepare, several

if TYPE_CHECKING:
    from xarray import Dataset


def fitted(asked: Sequence[str] = (), currents: bool = True) -> tuple[str, ...]:
    """Return the factors that are estimated: those of the drag, and what is asked for besides.

    Without currents a factor on all drag is one on the currents: that of cables is none unless
    asked for, and the length is one of those that are estimated.

    Raises
    ------
    UsageError
        What is asked for cannot be estimated.
    """
    for name in asked:
        if name not in FACTORS:
            raise UsageError(unknown(f"--fit: `{name}` cannot be estimated", name, FACTORS))
    usual = ("cable_drag", "rigid_drag") if currents else ("rigid_drag", "length")
    return tuple(name for name in FACTORS if name in asked or name in usual)


@dataclass(frozen=True)
class MotionRequest:
    """Hold a mooring that was recovered, the files of its sensors, and what is asked for.

    Attributes
    ----------
    mooring : with a position
    pressures, currents, match, flags, gap, sea_level, declination : see `read_measured`
    fit : what is estimated besides the drag
    hold_out : labels of sensors that are hidden, and at which the result is judged
    cross_validate : whether each used sensor is hidden in turn
    correct : of `CORRECTABLE`, what is taken off where nothing else is as likely
    judge : label of a sensor that is hidden, and of which is said whether it fits; empty of none
    prior : a record of currents whose shapes are taken, where none were measured; None of none
    """

    mooring: Mooring
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


class RecoveredMooring:
    """What was recovered: read, put right, estimated and judged, in this order.

    Attributes
    ----------
    measured, notes, source : what was read, see `read_measured`
    task : what is estimated; None before `estimate`

    Raises
    ------
    InputError, UsageError
        A file cannot be read, or what is asked for cannot be done.
    """

    def __init__(self, asked: MotionRequest) -> None:
        for kind in asked.correct:
            if kind not in CORRECTABLE:
                what = f"--correct: `{kind}` cannot be taken off"
                raise UsageError(unknown(what, kind, CORRECTABLE))
        self.asked, self.names = asked, fitted(asked.fit, bool(asked.currents))
        judged_too = [asked.judge] if asked.judge and asked.judge not in asked.hold_out else []
        self.hidden = [*asked.hold_out, *judged_too]
        self.task: Task | None = None
        self._faults: tuple[Fault, ...] = ()
        self._read()
        self.prior: list[CurrentMeasurements] = []
        if asked.prior is not None:
            if asked.currents:
                raise UsageError("--prior is for pressures alone; here --currents are given")
            file = asked.mooring.file
            limit = file.environment.maximum_speed
            depth = float(asked.mooring.water.depth)
            self.prior = read_currents([asked.prior], depth, None, asked.declination, limit)
            self.notes += [f"{one.source}: {note}" for one in self.prior for note in one.notes]
        if asked.judge and asked.judge not in self.measured.label:
            what = f"--judge: no sensor is called `{asked.judge}`"
            raise UsageError(unknown(what, asked.judge, self.measured.label))
        if asked.cross_validate:
            several(self.measured, self.hidden)

    def _read(self) -> None:
        asked = self.asked
        self.measured, self.notes, self.source = read_measured(
            asked.mooring, asked.pressures, asked.currents, asked.match, asked.flags, asked.gap,
            asked.sea_level, asked.declination, self._faults,
        )  # fmt: skip
        if asked.prior is not None:
            self.source["prior"] = hashed(asked.prior)

    def _prepared(self, tell: Callable[[str], None]) -> Task:
        return prepare(self.asked.mooring, self.measured, self.names, self.hidden, tell, self.prior)

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
        output, workers, progress, tell, stop : see `calm.motion.correction.run_motion`
        """
        asked = self.asked
        self.task = self._prepared(tell)
        if asked.correct:
            wrong = [
                one for one in diagnosed(self.task) if one.kind in asked.correct and one.certain
            ]
            if wrong:
                self._faults = tuple(replace(one, corrected=True) for one in wrong)
                self._read()
                self.task = self._prepared(tell)
        options = {
            "fit": sorted(self.names),
            "hold_out": sorted(self.hidden),
            "correct": self.source.get("corrected", ""),
            "prior": self.source.get("prior", ""),
        }
        record = MeasuredRecord(self.measured, self.source, self.notes)
        return run_motion(
            self.task, record, output, options,
            workers=workers, progress=progress, tell=tell, stop=stop,
        )  # fmt: skip

    def study(
        self,
        result: Dataset,
        tell: Callable[[str], None] = lambda _: None,
        workers: int | None = None,
    ) -> Study:
        """Return how a finished result agrees with all that was measured.

        Parameters
        ----------
        result : of `estimate`
        tell : is told what is going on
        workers : threads
        """
        assert self.task is not None
        asked, task = self.asked, self.task
        study = judged(task, self.measured, result, (*self._faults, *diagnosed(task)))
        if asked.judge:
            study = replace(study, judged=fit_of(task, self.measured, asked.judge))
        if asked.cross_validate:
            each = cross_validated(
                asked.mooring, self.measured, self.names, self.hidden, tell, workers, self.prior
            )
            study = replace(study, held_out=(*study.held_out, *each))
        return study


@dataclass(frozen=True, repr=False)
class MotionEstimate:
    """The depth of every part of a mooring at every time, and how well it agrees with the sensors.

    Attributes
    ----------
    study : what was estimated for the whole record, and its agreement
    notes : what was said of the input, in sentences
    """

    study: Study
    notes: tuple[str, ...]
    _dataset: Dataset

    @property
    def factors(self) -> Mapping[str, tuple[float, float, float]]:
        """Return each factor of the whole record with the ends of its interval of 95 %."""
        return self.study.factors

    @property
    def sensors(self) -> Mapping[str, Agreement]:
        """Return how the estimate agrees with each used sensor, by label."""
        return self.study.fit

    @property
    def held_out(self) -> Mapping[str, HeldOut]:
        """Return how well the depths of each hidden sensor were found, by label."""
        return {one.label: one for one in self.study.held_out}

    @property
    def diagnosis(self) -> tuple[Fault, ...]:
        """Return what is wrong with sensors, line and currents, with sizes and odds."""
        return (*self.study.diagnosis, *self.study.line)

    @property
    def judged(self) -> SensorFit | None:
        """Return whether the sensor of `judge` fits the line, with the odds."""
        return self.study.judged

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return doubts about the data, in sentences."""
        return self.study.remarks

    def to_xarray(self) -> Dataset:
        """Return the dataset that ``calm motion`` writes, with labels and units."""
        return self._dataset.copy()

    def __repr__(self) -> str:
        """Return the times, the factors and the agreement, in ten lines at most."""
        time = self._dataset["time"].values
        name = self.study.task.mooring.file.name or "mooring"
        span = f"{str(time[0])[:16]} to {str(time[-1])[:16]}"
        lines = [f"{name}: {len(time)} times, {span}"]
        lines += [
            f"{factor}: {value:.3f} ({low:.3f} to {high:.3f})"
            for factor, (value, low, high) in self.factors.items()
        ]
        for title, found in (("used", self.sensors), ("hidden", self.held_out)):
            if found:
                rms = [one.rms for one in found.values()]
                low, high = min(rms), max(rms)
                lines.append(f"{len(rms)} sensors {title}: rms {low:.2f} to {high:.2f} m")
        if self.remarks:
            lines.append(f"{len(self.remarks)} remarks")
        return "\n".join(lines)


def estimate_motion(
    mooring: Mooring,
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
    correct : what is taken off where a sensor is wrong: `clock`, `gain`, `offset`, `drift`
    judge : label of a sensor that is hidden, and of which is said whether it fits the line
    prior : a record of currents whose shapes are taken, without `currents`
    workers : threads; one for each processor that may be used where not given

    Raises
    ------
    InputError, UsageError
        A file cannot be read or does not belong to the mooring; too few sensors are left.
    """
    if not isinstance(mooring, Mooring):
        kind = type(mooring).__name__
        raise TypeError(f"a Mooring is needed, as calm.load gives it, not a {kind}")
    recovery = RecoveredMooring(
        MotionRequest(
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
    )
    with TemporaryDirectory() as folder:
        output = Path(folder) / "motion.nc"
        recovery.estimate(output, workers=workers)
        with open_result(output) as kept:
            dataset = kept.load()
    study = recovery.study(dataset, workers=workers)
    return MotionEstimate(study, tuple(recovery.notes), dataset)
