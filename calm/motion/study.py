"""Preparation of the motion estimate, and comparison of the result with the measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.case import Design
from calm.errors import UsageError
from calm.motion.correction import Task, estimate_in_memory
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import Forward, instruments_of, labels_of
from calm.motion.matching import without
from calm.motion.measured_currents import CurrentSmoother
from calm.motion.measurements import MooringMeasurements, level_names
from calm.motion.remarks import (
    ALL,
    BAND,
    OF_LINE,
    Agreement,
    Fault,
    agreement,
    alone_remarks,
    calm_times,
    coverage,
    current_remarks,
    datum_remarks,
    difference,
    false_current_times,
    linear,
    pchip,
    rms,
)
from calm.motion.sensors import metre_notes
from calm.motion.suspects import meter_remarks
from calm.motion.unknown_currents import learn_currents, with_knots
from calm.physics.line import Floats

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True)
class HeldOut:
    """A withheld sensor, and the errors of the depths estimated without this sensor."""

    label: str
    count: int  # number of times with good pressures of this sensor and of all sensors in use
    bias: float  # mean of estimated minus measured depth [m]
    rms: float  # root mean square of the `difference` of estimated and measured depth [m]
    linear_rms: float  # as `rms`, for depths interpolated by `linear` [m]
    pchip_rms: float  # as `rms`, for depths interpolated by `pchip` [m]
    coverage: float  # share of the differences within the 95 % interval of the estimate


@dataclass(frozen=True, repr=False)
class MotionEstimate:
    """Depths of every part of a mooring at every time, and their agreement with the sensors.

    Attributes
    ----------
    task : input of the estimate, with the common unknowns of the record
    dataset : result of `calm motion`
    factors : value and 95 % interval of each factor on the line
    sensors, plain : agreement of each sensor in use with the estimated depths, and with depths from
        the measured currents alone
    held_out : errors of the estimated depths at each withheld sensor
    diagnosis : faults of sensors, line and currents
    fits : whether the line is consistent with the pressures
    remarks, notes : sentences on doubts about the data, and on the input
    false : times at which the current at a level is probably false, by name of the level
    """

    task: Task
    dataset: Dataset
    factors: Mapping[str, tuple[float, float, float]]
    sensors: Mapping[str, Agreement]
    plain: Mapping[str, Agreement]
    held_out: Mapping[str, HeldOut]
    diagnosis: tuple[Fault, ...]
    fits: bool
    remarks: tuple[str, ...]
    false: Mapping[str, NDArray[np.datetime64]]
    notes: tuple[str, ...] = ()

    def faults(self, *, of_line: bool) -> list[Fault]:
        """Return the faults of line and currents if `of_line`, else the faults of the sensors."""
        return [one for one in self.diagnosis if (one.kind in OF_LINE) == of_line]

    def to_xarray(self) -> Dataset:
        """Return the result dataset of ``calm motion``, with labels and units."""
        return self.dataset.copy()

    def plot(self, ax: Any = None) -> Any:
        """Draw the depths of the sensors over time, with their 95 % bands, and return the axes.

        Measured depths are drawn as dots. `ax` are axes of matplotlib; by default, new axes are
        created.
        """
        if ax is None:
            from matplotlib.figure import Figure

            ax = Figure(figsize=(9.0, 5.0)).add_subplot()
        used, time = self.task.measured, self.task.measured.time
        for j, label in enumerate(used.label):
            depth, spread = depths_at(self.dataset, int(used.point[j]))
            (line,) = ax.plot(time, depth, label=label, linewidth=1.0)
            colour, half = line.get_color(), BAND * spread
            ax.fill_between(time, depth - half, depth + half, color=colour, alpha=0.25)
            ax.plot(time, used.depth[:, j], ".", color=colour, markersize=2.0)
        ax.set_ylabel("depth [m]")
        if not ax.yaxis_inverted():
            ax.invert_yaxis()
        ax.legend(fontsize="small")
        return ax

    def __repr__(self) -> str:
        time = self.task.measured.time
        name = self.task.mooring.file.name or "mooring"
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


def prepare(
    mooring: Design,
    measured: MooringMeasurements,
    names: Sequence[str],
    hidden: Sequence[str],
    tell: Callable[[str], None] = lambda _: None,
) -> Task:
    """Estimate the common unknowns of the record, without the withheld sensors.

    `measured` includes the sensors `hidden`, and `names` are the factors to estimate. `tell`
    receives progress messages.
    """
    used = without(measured, hidden)
    if not used.label:
        raise UsageError("--hold-out: at least one sensor must remain for the estimate")
    if used.u.shape[1]:
        smoother = CurrentSmoother(mooring, used, names)
        smoother.solve()
        task = Task(mooring, used, smoother.common(), smoother)
        found = diagnosed(task)
        slips = [one for one in found if one.kind == "slip" and one.certain]
        if slips:
            begin = np.searchsorted(used.time, [one.since for one in slips]).tolist()
            pairs = zip(begin, slips, strict=True)
            smoother.solve([(used.label.index(one.label), t, one.value) for t, one in pairs])
            return Task(mooring, used, smoother.common(), smoother)
        return replace(task, faults=found)
    used = with_knots(used, mooring)
    return Task(mooring, used, learn_currents(mooring, used, names, tell))


def intervals(task: Task) -> dict[str, tuple[float, float, float]]:
    """Return the value and the limits of the 95 % interval of each factor, by name."""
    spread = np.sqrt(np.diag(task.common.covariance))
    return {
        name: (value, value * float(np.exp(-BAND * sd)), value * float(np.exp(BAND * sd)))
        for (name, value), sd in zip(task.common.factors.items(), spread, strict=False)
    }


def judged(
    task: Task, measured: MooringMeasurements, result: Dataset, diagnosis: Sequence[Fault] = ()
) -> MotionEstimate:
    """Compare a finished result of `calm motion` with all measurements and the withheld sensors."""
    used = task.measured
    alone = task.common.inferred
    plain = None if alone else np.asarray(result["plain_depth"].values, np.float64)
    down = knockdown(used)
    every = np.isfinite(down)
    still = Forward(task.mooring, {}).still
    fit_of, plain_of, at_rest = {}, {}, list[Floats]()
    for j, label in enumerate(used.label):
        calm = calm_times(down, every & np.isfinite(used.depth[:, j]))
        depth, _ = depths_at(result, int(used.point[j]))
        fit_of[label] = agreement(depth, used.depth[:, j], calm, every)
        if plain is not None:
            plain_of[label] = agreement(plain[:, j], used.depth[:, j], calm, every)
        expected = np.full(len(down), still[used.point[j]]) if plain is None else plain[:, j]
        both = np.stack([used.depth[:, j], expected])[:, calm & np.isfinite(expected)]
        if both.size:
            at_rest.append(both.mean(axis=1))
    hidden = [label for label in measured.label if label not in used.label]
    held = {}
    for label in hidden:
        point = int(measured.point[measured.label.index(label)])
        held[label] = judge_hidden(measured, used, label, *depths_at(result, point), still)
    remarks = [
        f"{one.sentence()}{'; this is corrected' if one.corrected else ''}" for one in diagnosis
    ]
    false: Mapping[str, NDArray[np.datetime64]] = {}
    unfit = alone_remarks(task.common) if alone else []
    remarks += unfit
    if plain is not None:
        names = level_names(used, labels_of(task.mooring))
        false = false_current_times(names, used.time, np.asarray(result["current_doubt"].values))
        remarks += [*current_remarks(false, len(used.time)), *meter_remarks(used, names)]
    if not any(one.label == ALL and one.kind == "gain" for one in diagnosis):
        remarks += datum_remarks(task.common, float(task.mooring.water.depth))
    position = task.mooring.file.position
    if position is not None and at_rest:
        mean, reference = np.transpose(at_rest)
        remarks += metre_notes(mean, reference, position.latitude)
    of_line = any(one.kind in OF_LINE for one in diagnosis)
    fits = not (of_line or unfit)
    return MotionEstimate(
        task, result, intervals(task), fit_of, plain_of, held, tuple(diagnosis), fits,
        tuple(remarks), false,
    )  # fmt: skip


def knockdown(used: MooringMeasurements) -> Floats:
    """Return the knockdown (n,) of the highest sensor with a reading, from its least depth [m]."""
    down = np.full(len(used.time), np.nan)
    for j in range(len(used.label)):
        depth = used.depth[:, j]
        if np.isfinite(depth).any():
            down = np.where(np.isfinite(down), down, depth - np.nanmin(depth))
    return down


def judge_hidden(
    measured: MooringMeasurements,
    used: MooringMeasurements,
    label: str,
    depth: Floats,
    spread: Floats,
    still: Floats,
) -> HeldOut:
    """Compare the depths of a withheld sensor with the estimate and with two interpolations.

    `depth` (n,) and `spread` (n,) are the estimated depth and its standard deviation [m]. `still`
    (p,) are the depths of all points in still water [m].
    """
    column = measured.label.index(label)
    own = measured.depth[:, column]
    among = np.isfinite(own) & np.isfinite(used.depth).all(axis=1) & np.isfinite(depth)
    calm = calm_times(knockdown(used), among)
    off = difference(depth, own, calm, among)
    where = used.depth, used.point, still, int(measured.point[column])
    line, curve = (rms(difference(law(*where), own, calm, among)) for law in (linear, pchip))
    bias = float((depth - own)[among].mean()) if among.any() else float("nan")
    return HeldOut(label, int(among.sum()), bias, rms(off), line, curve, coverage(off, spread))


def several(measured: MooringMeasurements, hidden: Sequence[str]) -> list[str]:
    """Return the labels of the sensors to withhold in turn; there must be at least two."""
    rest = [label for label in measured.label if label not in hidden]
    if len(rest) < 2:
        raise UsageError("--cross-validate: at least two sensors are needed")
    return rest


def cross_validated(
    mooring: Design,
    measured: MooringMeasurements,
    names: Sequence[str],
    hidden: Sequence[str],
    tell: Callable[[str], None],
    workers: int | None = None,
) -> list[HeldOut]:
    """Return the errors of the depth of each sensor, estimated without this sensor.

    Each sensor is withheld in turn, in addition to the sensors in `hidden`.
    """
    still = Forward(mooring, {}).still
    held = []
    for label in several(measured, hidden):
        tell(f"estimating without {label}")
        task = prepare(mooring, measured, names, [*hidden, label])
        point = int(measured.point[measured.label.index(label)])
        depth, spread = estimate_in_memory(task, [point], workers)
        held.append(judge_hidden(measured, task.measured, label, depth[:, 0], spread[:, 0], still))
    return held


@dataclass(frozen=True)
class SensorSeries:
    """Depths of one sensor or instrument over time."""

    label: str
    hidden: bool  # True if the estimate uses no pressure of this sensor
    time: NDArray[np.datetime64]  # (n,) times
    measured: Floats  # (n,) measured depths [m]; NaN if not measured
    estimated: Floats  # (n,) estimated depths [m]
    spread: Floats  # (n,) standard deviations of the estimated depths [m]
    # (n,) depths computed from the measured currents alone [m]; otherwise None
    plain: Floats | None


def depths_at(result: Dataset, point: int) -> tuple[Floats, Floats]:
    """Return the depths (n,) of a point in a result, and their standard deviations (n,) [m]."""
    clamps = result.sizes.get("clamp", 0)
    names = ("clamp_depth", "clamp_depth_sd") if point < clamps else ("depth_top", "depth_sd")
    column = point if point < clamps else point - clamps
    depth, spread = (np.asarray(result[name][:, column].values, np.float64) for name in names)
    return depth, spread


def series_of(study: MotionEstimate, measured: MooringMeasurements) -> list[SensorSeries]:
    """Return the depths of all sensors from the top down, followed by the other instruments."""
    mooring, used, result = study.task.mooring, study.task.measured.label, study.dataset
    labels = labels_of(mooring)
    columns = dict(zip(measured.point.tolist(), measured.depth.T, strict=True))
    nothing, found = np.full(len(measured.time), np.nan), []
    for point in dict.fromkeys([*columns, *instruments_of(mooring)]):
        label, plain = labels[point], None
        if label in used and "plain_depth" in result:
            plain = np.asarray(result["plain_depth"][:, used.index(label)].values, np.float64)
        own, estimate = columns.get(point, nothing), depths_at(result, point)
        found.append(SensorSeries(label, label not in used, measured.time, own, *estimate, plain))
    return found
