"""Where a mooring was, from the files of its sensors: what ``calm motion`` reads and estimates."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from calm.batch.finished import open_result
from calm.case import Mooring
from calm.dataset.discovery import hashed
from calm.errors import UsageError, not_among, unknown
from calm.motion.correction import MeasuredRecord, Task, run_motion, without
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import FACTORS, Forward
from calm.motion.matching import (
    instruments_of,
    labels_of,
    matched_by_label,
    matched_by_place,
    named_by_serial,
    plausible,
    unusable,
)
from calm.motion.measurements import MooringMeasurements, joined, read_currents
from calm.motion.remarks import ALL, Agreement, Fault
from calm.motion.sensors import Sensor, parse_flags, read_sea_level, read_sensors, split_label
from calm.motion.study import HeldOut, Study, cross_validated, judged, prepare, several

if TYPE_CHECKING:
    from xarray import Dataset

_MATCHES = ("label", "height", "depth")

GAP = np.timedelta64(2, "h")
"""Longest time between two values that are interpolated, where nothing else is asked for."""


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


def read_measured(
    mooring: Mooring,
    pressures: Sequence[str],
    currents: Sequence[str] = (),
    match: str = "label",
    flags: str = "1,2",
    gap: np.timedelta64 = GAP,
    sea_level: Path | None = None,
    declination: float | None = None,
    faults: Sequence[Fault] = (),
) -> tuple[MooringMeasurements, list[str], dict[str, str]]:
    """Return what was measured, at common times, with notes on what was read and the source files.

    Parameters
    ----------
    pressures, currents : files, as their paths or as ``LABEL=PATH``
    match : by `label`, or by nominal `height` or `depth`
    flags : of the pressures that count as measured, separated by commas
    gap : longest time between two values that are interpolated
    sea_level : the height of the sea surface, as a path
    declination : added to the directions of the currents [degrees]
    faults : of the sensors, that are taken off

    Raises
    ------
    InputError, UsageError
        A file cannot be read, the mooring has no position, or no sensor is left.
    """
    if match not in _MATCHES:
        raise UsageError(not_among("--match", match, _MATCHES))
    position = mooring.file.position
    if position is None:
        raise UsageError(
            f"{mooring.file.path} has no `position`, whose latitude turns pressures into depths"
        )
    place = position.latitude, position.longitude
    seabed = float(mooring.water.depth)
    wanted = parse_flags(flags)
    sensors = read_sensors(pressures, wanted, position.latitude, seabed)
    labels, still = labels_of(mooring), Forward(mooring, {}).still
    notes: list[str] = []
    if match == "label":
        sensors = named_by_serial(sensors, mooring)
        points, notes = matched_by_label(sensors, labels)
    else:
        points = matched_by_place(sensors, instruments_of(mooring), still, labels)
        notes = [
            f"the sensor at {sensors[i].nominal:.1f} m of {sensors[i].source} is `{labels[at]}`"
            for i, at in points.items()
        ]
        sensors = [replace(one, label=labels[points[i]]) for i, one in enumerate(sensors)]
    read = read_currents(
        currents, seabed, place, declination, mooring.file.environment.maximum_speed
    )
    level = None if sea_level is None else read_sea_level(sea_level)
    notes += dict.fromkeys(f"{one.source}: {one.note}" for one in sensors if one.note)
    used = []
    for i, at in points.items():
        one, said = plausible(corrected(sensors[i], faults), float(still[at]), seabed)
        used.append(one)
        notes += said
    notes += [
        f"{one.label}: {one.dropped} pressures left out for their flag"
        for one in used
        if one.dropped
    ]
    if not any(np.isfinite(one.depth).any() for one in used):
        raise UsageError("--pressures: no sensor has a good pressure: " + "; ".join(notes))
    measured = joined(read, used, list(points.values()), labels, still, gap, level)
    notes += [f"{one.source}: {note}" for one in read for note in one.notes]
    lost = unusable(measured, still)
    notes += [f"{label} {reason}" for label, reason in lost.items()]
    measured = without(measured, list(lost))
    if not measured.label:
        raise UsageError("--pressures: no sensor is left: " + "; ".join(notes))
    source = {
        "currents": ", ".join(hashed(split_label(one)[1]) for one in currents),
        "pressures": ", ".join(hashed(split_label(one)[1]) for one in pressures),
    }
    if faults:
        source["corrected"] = "taken off: " + "; ".join(one.sentence() for one in faults)
    return measured, notes, source


CORRECTABLE = ("clock", "gain", "offset", "drift")
"""What can be taken off what a sensor reads, of `calm.motion.diagnosis.Fault`."""


def corrected(sensor: Sensor, faults: Sequence[Fault]) -> Sensor:
    """Return what a sensor would have read without its faults."""
    time, depth = sensor.time, sensor.depth
    for one in faults:
        if one.label not in (ALL, sensor.label):
            continue
        if one.kind == "clock":
            time = time - np.timedelta64(round(one.value * 3.6e12), "ns")
        elif one.kind == "gain":
            depth = depth / one.value
        elif one.kind == "offset":
            depth = depth - one.value
        else:
            share = (time - one.since) / (one.until - one.since)
            depth = depth - one.value * np.clip(share, 0.0, 1.0)
    return replace(sensor, time=time, depth=depth)


Read = tuple[MooringMeasurements, list[str], dict[str, str]]


def put_right(
    task: Task,
    read: Callable[[Sequence[Fault]], Read],
    kinds: Sequence[str],
    again: Callable[[MooringMeasurements], Task],
) -> tuple[Task, Read | None, tuple[Fault, ...]]:
    """Take off what is wrong with the sensors, and estimate again what is common to the record.

    Parameters
    ----------
    task : with the sensors as they are
    read : reads the files without some faults
    kinds : of `CORRECTABLE`, those that are taken off where nothing else is as likely
    again : estimates what is common to the record

    Returns
    -------
    The task; what was read without the faults, None where there are none; the faults.

    Raises
    ------
    UsageError
        A kind is none of these.
    """
    for kind in kinds:
        if kind not in CORRECTABLE:
            raise UsageError(unknown(f"--correct: `{kind}` cannot be taken off", kind, CORRECTABLE))
    faults = [one for one in diagnosed(task) if one.kind in kinds and one.certain] if kinds else []
    if not faults:
        return task, None, ()
    whole = read(faults)
    return again(whole[0]), whole, tuple(replace(one, corrected=True) for one in faults)


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
        """Return what is wrong with the sensors, with sizes and odds."""
        return self.study.diagnosis

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
    workers : threads; one for each processor that may be used where not given

    Raises
    ------
    InputError, UsageError
        A file cannot be read or does not belong to the mooring; too few sensors are left.
    """
    if not isinstance(mooring, Mooring):
        kind = type(mooring).__name__
        raise TypeError(f"a Mooring is needed, as calm.load gives it, not a {kind}")
    names = fitted(fit, bool(currents))

    def read(faults: Sequence[Fault] = ()) -> Read:
        return read_measured(
            mooring,
            [str(path) for path in pressures],
            [str(path) for path in currents],
            match,
            ",".join(map(str, flags)),
            GAP if gap is None else np.timedelta64(round(gap * 1e9), "ns"),
            None if sea_level is None else Path(sea_level),
            declination,
            faults,
        )

    def begin(measured: MooringMeasurements) -> Task:
        return prepare(mooring, measured, names, hold_out)

    measured, notes, source = read()
    if cross_validate:
        several(measured, hold_out)
    task, better, faults = put_right(begin(measured), read, correct, begin)
    measured, notes, source = better or (measured, notes, source)
    options = {"fit": sorted(names), "hold_out": sorted(hold_out), "correct": sorted(correct)}
    with TemporaryDirectory() as folder:
        output = Path(folder) / "motion.nc"
        record = MeasuredRecord(measured, source, notes)
        run_motion(task, record, output, options, workers=workers)
        with open_result(output) as kept:
            dataset = kept.load()
    study = judged(task, measured, dataset, (*faults, *diagnosed(task)))
    if cross_validate:
        each = cross_validated(mooring, measured, names, hold_out, lambda _: None, workers)
        study = replace(study, held_out=(*study.held_out, *each))
    return MotionEstimate(study, tuple(notes), dataset)
