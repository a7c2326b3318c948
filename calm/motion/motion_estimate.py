"""Computation of ``calm motion``: read sensor files and estimate the motion of a mooring."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from calm.batch.blocks import Progress, in_threads, write_solved
from calm.batch.finished import open_result
from calm.batch.resolved import InputHash, resolved_input, with_input
from calm.case import Design
from calm.dataset.discovery import hashed, vertical_extent
from calm.errors import UsageError, not_among, unknown
from calm.files.mooring_file import refuse_all_but_moorings
from calm.motion import matching, sensors
from calm.motion.common_unknowns import FACTORS
from calm.motion.correction import BLOCK, MeasuredRecord, Task, motion_layout, solve_times
from calm.motion.diagnosis import diagnosed
from calm.motion.line_response import instruments_of
from calm.motion.matching import without
from calm.motion.measurements import MooringMeasurements, joined, read_currents, without_spikes
from calm.motion.remarks import ALL, Fault
from calm.motion.study import MotionEstimate, cross_validated, judged, prepare, several
from calm.motion.suspects import common_step, distances_of, torn
from calm.records.given import as_files
from calm.records.instrument_series import split_label

if TYPE_CHECKING:
    from xarray import Dataset

    from calm.records.given import Given


_MATCHES = ("label", "height", "depth")
CORRECTABLE = ("clock", "gain", "offset", "drift", "air")  # kinds of `Fault`, and air pressure
GAP = np.timedelta64(2, "h")  # default limit on the gap over which values are interpolated


RARE = 0.1  # a note is added if the share of times with two sensors is below this value


def shared_times(measured: MooringMeasurements, currents: bool) -> list[str]:
    """Return a note if few times have pressures from two or more sensors.

    A UsageError is raised if no time has such pressures and no current was measured.
    """
    if len(measured.label) < 2:
        return []
    count = np.isfinite(measured.depth).sum(axis=1)
    several, some = int((count >= 2).sum()), int((count >= 1).sum())
    if several >= RARE * some:
        return []
    shared = f"only {several} of {some} times have pressures of two or more sensors"
    if not several and not currents:
        spans = [
            f"{label} {' to '.join(np.datetime_as_string(measured.time[there][[0, -1]], 'D'))}"
            for label, there in zip(measured.label, np.isfinite(measured.depth).T, strict=True)
            if there.any()
        ]
        raise UsageError(
            f"--pressures: {shared}: the records do not overlap ({'; '.join(spans)}). Add "
            "currents, use records of one deployment, or set a longer --gap"
        )
    return [shared]


def fitted(requested: Sequence[str] = (), currents: bool = True) -> tuple[str, ...]:
    """Return the names of the factors to estimate: the default factors and the requested factors.

    The default factors multiply the drag of cables and the drag of rigid pieces. Without measured
    currents, they multiply the drag of rigid pieces and the length of cables.
    """
    for name in requested:
        if name not in FACTORS:
            raise UsageError(unknown(f"--fit: `{name}` cannot be estimated", name, FACTORS))
    # a factor on all drag cannot be distinguished from a factor on unmeasured currents
    usual = ("cable_drag", "rigid_drag") if currents else ("rigid_drag", "length")
    return tuple(name for name in FACTORS if name in requested or name in usual)


@dataclass
class RecoveredMooring:
    """A recovered mooring with its records.

    The constructor reads and corrects the records. Its parameters are those of `estimate_motion`,
    but files are given as paths or ``LABEL=PATH``.

    Attributes
    ----------
    moved : step that is common to the depths of all sensors; empty if there is no such step, or if
        currents were measured
    measured, notes : measurements, and sentences on them
    source : names and hashes of the source files
    """

    mooring: Design
    pressures: Sequence[str]
    currents: Sequence[str] = ()
    match: str = "label"
    fit: Sequence[str] = ()
    hold_out: Sequence[str] = ()
    cross_validate: bool = False
    correct: Sequence[str] = ()
    sea_level: Path | None = None
    flags: str = "1,2"
    gap: np.timedelta64 = GAP
    declination: float | None = None
    without: Sequence[str] = ()
    moved: tuple[Fault, ...] = field(default=(), init=False)
    _faults: tuple[Fault, ...] = field(default=(), init=False)

    def __post_init__(self) -> None:
        for kind in self.correct:
            if kind not in CORRECTABLE:
                what = f"--correct: `{kind}` cannot be corrected"
                raise UsageError(unknown(what, kind, CORRECTABLE))
        self.names = fitted(self.fit, bool(self.currents))
        self.hidden = [*self.hold_out]
        self._read()
        if self.cross_validate:
            several(self.measured, self.hidden)

    def _read(self) -> None:
        """Read the measurements, correct them for known faults, and interpolate to common times."""
        mooring, position = self.mooring, self.mooring.file.position
        if self.match not in _MATCHES:
            raise UsageError(not_among("--match", self.match, _MATCHES))
        if position is None:
            raise UsageError(
                f"{mooring.file.path} has no `position`; its latitude is needed to convert "
                "pressures to depths"
            )
        seabed, line = float(mooring.water.depth), matching.places_of(mooring)
        wanted = sensors.parse_flags(self.flags)
        given = sensors.read_sensors(self.pressures, wanted, position.latitude, seabed)
        if self.match == "label":
            points, notes = matching.points_of(given, line)
        else:
            points, notes = matching.matched_by_place(given, line, instruments_of(mooring))
        parts = [line.label[at] for at in points.values()]
        if twice := next((label for label in parts if parts.count(label) > 1), ""):
            raise UsageError(f"--pressures: two sensors are called `{twice}`")
        of_files = {id(one.card): one.card for one in given if one.card is not None}
        read = read_currents(
            self.currents, seabed, (position.latitude, position.longitude), self.declination,
            mooring.file.environment.maximum_speed,
        )  # fmt: skip
        for i, text in enumerate(self.currents):
            read[i], more = matching.currents_on_line(read[i], split_label(text)[1], line, seabed)
            notes += more
        notes += dict.fromkeys(f"{one.source}: {one.note}" for one in given if one.note)
        self.cards = [*(card for one in read for card in one.cards), *of_files.values()]
        points = self._without(points, line.label)
        first = min(time[0] for time in [one.time for one in read] + [one.time for one in given])
        clocks = matching.clocks_of(mooring, first)
        for i, current in enumerate(read):  # a file has one clock
            for checked in [clocks[label] for label in current.label if label in clocks][:1]:
                read[i] = replace(current, time=checked.true_times(current.time))
        used, absolute = [], "air" in self.correct
        for i, at in points.items():
            depth = given[i].value - sensors.AIR * absolute
            one = replace(given[i], label=line.label[at], value=depth)
            if clock := clocks.get(one.label):
                one = replace(one, time=clock.true_times(one.time))
            for fault in self._faults:
                if fault.label in (ALL, one.label) and fault.kind != "moved":
                    time, depth = fault.taken_off(one.time, one.value)
                    one = replace(one, time=time, value=depth)
            one, more = sensors.plausible(one, float(line.still[at]), seabed)
            used.append(one)
            notes += more
            if one.dropped:
                notes.append(f"{one.label}: {one.dropped} pressures were excluded by their flag")
        notes += [f"{label}: {clock.sentence}" for label, clock in clocks.items()]
        if not any(np.isfinite(one.value).any() for one in used):
            raise UsageError("--pressures: no sensor has a good pressure: " + "; ".join(notes))
        level = None if self.sea_level is None else sensors.read_sea_level(self.sea_level)
        where = list(points.values())
        measured = joined(read, used, where, line.label, line.still, self.gap, level)
        notes += [f"{one.source}: {note}" for one in read for note in one.notes]
        places = line.still[measured.point]
        notes += sensors.air_notes(measured.depth, places)
        shown = [j for j, label in enumerate(measured.label) if label not in self.hidden]
        judged_labels = tuple(measured.label[j] for j in shown)
        lost = sensors.unusable(judged_labels, measured.depth[:, shown], places[shown])
        notes += [f"{label} {reason}" for label, reason in lost.items()]
        measured = without(measured, list(lost))
        if not measured.label:
            raise UsageError("--pressures: no usable sensor remains: " + "; ".join(notes))
        notes += shared_times(without(measured, self.hidden), bool(self.currents))
        self.measured, more = torn(measured, distances_of(mooring), self.hidden)
        self.notes = notes + more
        self.source = {
            "currents": ", ".join(hashed(split_label(one)[1]) for one in self.currents),
            "pressures": ", ".join(hashed(split_label(one)[1]) for one in self.pressures),
        }
        if not self.currents:
            self.measured, more = without_spikes(self.measured, self.hidden)
            self.notes += more
            step = common_step(without(self.measured, self.hidden), line.still)
            if step is not None:
                sunk = np.where(self.measured.time >= step.since, step.value, 0.0)
                self.measured = replace(self.measured, sunk=sunk)
                self.moved = (step,)
        off = [one.sentence() for one in self._faults]
        off += [f"{label}: {clock.sentence}" for label, clock in clocks.items()]
        off += ["all sensors: their pressures include the air pressure, 10.13 dbar"] * absolute
        if off:
            self.source["corrected"] = "corrected for: " + "; ".join(off)

    def _without(self, points: dict[int, int], labels: Sequence[str]) -> dict[int, int]:
        known = [labels[at] for at in points.values()]
        for option, given in (("--without", self.without), ("--hold-out", self.hidden)):
            for label in given:
                if label not in known:
                    what = f"{option}: no sensor is called `{label}`"
                    raise UsageError(unknown(what, label, known))
        return {i: at for i, at in points.items() if labels[at] not in self.without}

    def _prepared(self, tell: Callable[[str], None]) -> Task:
        return prepare(self.mooring, self.measured, self.names, self.hidden, tell)

    def estimate(
        self,
        output: Path,
        *,
        workers: int | None = None,
        progress: Callable[[Progress], None] | None = None,
        tell: Callable[[str], None] = lambda _: None,
    ) -> dict[str, int]:
        """Estimate the common unknowns, correct the requested faults, and write the result.

        The parameters and the result are as in `calm.batch.run.run_batch`.
        """
        task = self._prepared(tell)
        if self.correct:
            task = replace(task, faults=diagnosed(task))
        wrong = [one for one in task.faults or () if one.kind in self.correct and one.certain]
        if wrong:
            self._faults = tuple(replace(one, corrected=True) for one in wrong)
            self._read()
            task = self._prepared(tell)
        self.task = task
        options = {
            "fit": sorted(self.names), "hold_out": sorted(self.hidden),
            "without": sorted(self.without), "correct": self.source.get("corrected", ""),
            "sensors": list(self.measured.label),
        }  # fmt: skip
        text = resolved_input(self.mooring, self.measured.time, {"options": options})
        measured, arrays = InputHash(text), vars(self.measured).items()
        measured.add(one for name, one in arrays if name != "label")
        record = MeasuredRecord(self.measured, self.source, self.notes, self.cards)
        layout = motion_layout(task, record)
        more = {**with_input(text), **measured.attributes()}
        layout = replace(layout, attributes={**layout.attributes, **more})
        starts, extent = range(0, len(self.measured.time), BLOCK), list[np.float32]()
        solve = partial(solve_times, task, layout, extent)
        with closing(in_threads(solve, starts, workers)) as solved:
            return write_solved(
                layout, BLOCK, solved, output, progress, lambda: vertical_extent(np.array(extent))
            )

    def study(
        self, result: Dataset, tell: Callable[[str], None] = lambda _: None,
        workers: int | None = None,
    ) -> MotionEstimate:  # fmt: skip
        """Compare a finished result of `estimate` with all measurements."""
        faults = (*self._faults, *self.moved, *diagnosed(self.task))
        study = replace(judged(self.task, self.measured, result, faults), notes=tuple(self.notes))
        if not self.cross_validate:
            return study
        given = self.mooring, self.measured, self.names, self.hidden
        held = {one.label: one for one in cross_validated(*given, tell, workers)}
        return replace(study, held_out={**study.held_out, **held})


def estimate_motion(
    mooring: Design,
    pressures: Given | Sequence[Given],
    currents: Given | Sequence[Given] = (),
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
    without: Sequence[str] = (),
    workers: int | None = None,
) -> MotionEstimate:
    """Estimate the depth of every part of a mooring at every time, as ``calm motion`` does.

    Parameters
    ----------
    mooring : mooring with a position
    pressures : records of pressure: paths, texts ``LABEL=PATH``, `xarray.Dataset` with the contents
        of such a file, or `pandas.DataFrame` with an index of times and columns such as
        ``LABEL[dbar]``
    currents : records of currents in these forms; if empty, currents are estimated from pressures
    match : key that matches sensors to the line: `label`, or nominal `height` or `depth`
    fit : factors to estimate in addition to the drag: `buoyancy`, `length`
    hold_out : labels of sensors that are withheld to test the result
    cross_validate : whether to withhold each sensor in turn
    sea_level : path of sea-surface heights over time
    flags : accepted quality flags of the pressures
    gap : longest gap over which values are interpolated [s]; two hours by default
    declination : angle added to the directions of the currents [degrees]
    correct : faults to correct: `clock`, `gain`, `offset`, `drift`, or `air` for absolute pressures
    without : labels of sensors to ignore
    workers : number of threads; by default one for each processor

    Raises
    ------
    InputError, UsageError
        A file cannot be read or does not belong to the mooring, or too few sensors are left.
    """
    refuse_all_but_moorings(mooring.file)
    with TemporaryDirectory() as name:
        folder = Path(name)
        recovery = RecoveredMooring(
            mooring, as_files(pressures, folder, "pressures"),
            as_files(currents, folder, "currents"), match, fit, hold_out, cross_validate, correct,
            None if sea_level is None else Path(sea_level), ",".join(map(str, flags)),
            GAP if gap is None else np.timedelta64(round(gap * 1e9), "ns"), declination, without,
        )  # fmt: skip
        output = folder / "motion.nc"
        recovery.estimate(output, workers=workers)
        with open_result(output) as kept:
            dataset = kept.load()
    return recovery.study(dataset, workers=workers)
