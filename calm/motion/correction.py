"""What is to be estimated of a mooring, in blocks that are kept and taken up where it stopped."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.dataset import laid_out, layout_of
from calm.batch.profiles import Batch, Profiles
from calm.batch.run import BatchOutcome, run_kept
from calm.batch.statuses import STATUSES
from calm.batch.threads import processors
from calm.batch.work import BatchWork, Progress
from calm.batch.work_store import Store, identity_of, open_store, to_text
from calm.case import Mooring
from calm.dataset.netcdf import Attributes, ResultLayout, down_the_line, labels, numbers
from calm.motion.archived import archived, depth_flags
from calm.motion.common_unknowns import Common
from calm.motion.estimate import estimated
from calm.motion.line_response import Forward, LineResponse, points
from calm.motion.matching import labels_of
from calm.motion.measurements import MooringMeasurements, by_neighbours, level_names
from calm.motion.unknown_currents import unknown_state
from calm.motion.whole_record import forwards_of
from calm.physics.line import Floats
from calm.records.record import Levels, Record

_DEVIATION: Attributes = {"standard_name": "depth standard_error"}
OF_MOTION: Mapping[str, tuple[tuple[str, ...], tuple[str, str, Attributes]]] = {
    "clamp_depth_sd": (
        ("clamp",),
        ("m", "standard deviation of the depth of the clamped instrument", _DEVIATION),
    ),
    "depth_sd": (
        ("component",),
        ("m", "standard deviation of the depth of the upper end", _DEVIATION),
    ),
    "current_factor": ((), ("1", "factor on the current, estimated", {})),
    "current_doubt": (
        ("level",),
        ("1", "probability that the current of the level is false", {}),
    ),
    "residual": (("sensor",), ("m", "measured less estimated depth of the sensor", {})),
    "plain_depth": (
        ("sensor",),
        ("m", "depth of the sensor by the currents alone, nothing fitted", {"positive": "down"}),
    ),
}
"""Dimensions besides time, unit, meaning and attributes of what a batch does not have."""
OF_CURRENTS = frozenset({"current_factor", "current_doubt", "plain_depth"})
"""Those of them that need a measured current."""


def run_motion(
    task: Task,
    record: MeasuredRecord,
    output: Path,
    options: Mapping[str, Any],
    *,
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
    tell: Callable[[str], None] = lambda _: None,
    stop: Event | None = None,
) -> BatchOutcome:
    """Estimate every time, and write the result; see `calm.batch.run.run_batch`.

    Parameters
    ----------
    options : what was asked for besides, by which the work is known again

    Raises
    ------
    UsageError
        The output is there already, from another input, or cannot be read.
    """
    stop = stop or Event()
    layout = motion_layout(task, record)

    def identify() -> str:
        return to_text(identity_of(task.mooring, record, options, stop))

    def begin(folder: Path, identity: str) -> MotionWork:
        return MotionWork(task, record, open_store(folder, layout, BLOCK, identity), progress, stop)

    def solve(work: MotionWork) -> None:
        work.here(workers or processors())

    return run_kept(output, identify, begin, solve, tell)


class MotionWork(BatchWork):
    """The blocks of a result that are missing."""

    def __init__(
        self,
        task: Task,
        record: MeasuredRecord,
        store: Store,
        progress: Callable[[Progress], None] | None,
        stop: Event,
    ) -> None:
        super().__init__(Batch(task.mooring), record, store, None, progress, stop)
        self._task = task

    def _solve(self, number: int) -> None:
        start, behind = self.store.span(number)
        profiles, more = self._task.columns(start, behind)
        time = self.record.time[start:behind]
        flags = depth_flags(self._task.measured.at(slice(start, behind)), profiles)
        arrays = laid_out(self.store.layout, time, {**vars(profiles), **more, **flags})
        self.count(profiles)
        self._keep(number, [arrays])


def motion_layout(task: Task, record: MeasuredRecord) -> ResultLayout:
    """Return the result of a batch, with what is estimated besides."""
    layout = layout_of(task.mooring, record, None)
    known = dict(layout.sizes)
    known["sensor"] = len(task.measured.label)
    alone = task.common.law is not None
    names = () if alone else level_names(task.measured, labels_of(task.mooring))
    known["level"] = len(names)
    added = {name: known[name] for name in ("sensor", "level")}
    variables = [*layout.variables, *down_the_line(added)]
    if names:
        variables.append(labels("level_label", "level", names, "levels of the currents"))
    if known["sensor"]:
        meaning = "sensors whose pressures are used, from the top down"
        variables.append(labels("sensor_label", "sensor", task.measured.label, meaning))
    for name, (dimensions, quantity) in OF_MOTION.items():
        if all(known.get(each) for each in dimensions) and not (alone and name in OF_CURRENTS):
            beside = "".join(f"{dimension}_label" for dimension in dimensions)
            variables += numbers(("time", *dimensions), {name: quantity}, beside)
    sizes = {name: size for name, size in known.items() if size}
    attributes = dict(layout.attributes)
    attributes["title"] = attributes["title"].partition(": ")[0] + ": where its parts were"
    attributes["history"] = attributes["history"].replace(" batch", " motion")
    whole = replace(layout, sizes=sizes, variables=tuple(variables), attributes=attributes)
    return archived(whole, task.mooring, task.measured, record.source)


def estimate_in_memory(
    task: Task, points: Sequence[int], workers: int | None = None
) -> tuple[Floats, Floats]:
    """Return (n, m) depths of some points and their deviations [m], which are kept nowhere.

    Parameters
    ----------
    task : what is estimated
    points : which points of the line
    workers : threads
    """
    starts = range(0, len(task.measured.time), BLOCK)

    def one(start: int) -> tuple[Floats, Floats]:
        profiles, more = task.columns(start, start + BLOCK)
        depth = np.hstack([profiles.clamp_depth, profiles.depth_top])
        spread = np.hstack([more["clamp_depth_sd"], more["depth_sd"]])
        return depth[:, points], spread[:, points]

    with ThreadPoolExecutor(workers or processors()) as pool:
        found = list(pool.map(one, starts))
    return np.concatenate([each[0] for each in found]), np.concatenate([each[1] for each in found])


BLOCK = 512
"""Times that are estimated, and kept, together."""


@dataclass(frozen=True)
class Task:
    """Hold what is to be estimated: `measured` has the sensors that are used."""

    mooring: Mooring
    measured: MooringMeasurements
    common: Common

    def columns(self, start: int, stop: int) -> tuple[Profiles, dict[str, NDArray[np.float64]]]:
        """Return some of the times: the line in the most likely currents, and what is known
        besides.

        Returns
        -------
        The profiles with the depths that were estimated, and `clamp_depth_sd`, `depth_sd`,
        `residual`, and of measured currents `current_factor`, `current_doubt`, `plain_depth`.
        """
        one = self.measured.at(slice(start, stop))
        moments = LineResponse(one, *self.forwards)
        law = self.common.law
        state = None if law is None else unknown_state(moments, self.common)
        beside = self._neighbours[0][start:stop], self._neighbours[1][start:stop]
        found = estimated(moments, self.common, state, beside)
        likely = moments.forward.solve(found.likely.level, found.likely.u, found.likely.v)
        clamps = likely.clamp_depth.shape[1]
        shift = found.depth - points(likely)
        surface = (self.common.datum + found.sea)[:, None]
        down = found.depth - surface - moments.forward.still
        profiles = replace(
            likely,
            clamp_depth=found.depth[:, :clamps],
            depth_top=found.depth[:, clamps:],
            clamp_knockdown=down[:, :clamps] + 0.0 * likely.clamp_knockdown,
            knockdown=down[:, clamps:] + 0.0 * likely.knockdown,
            top_depth=likely.top_depth + shift[:, clamps],
        )
        if one.false is not None:
            lost = one.false & (likely.status == STATUSES.index("no-current"))
            status = np.where(lost, STATUSES.index("implausible-current"), likely.status)
            profiles = replace(profiles, status=status.astype(np.int8))
        known = np.where(likely.status == 0, 1.0, np.nan)
        deviation = found.deviation * self.common.widened * known[:, None]
        columns = {
            "clamp_depth_sd": deviation[:, :clamps],
            "depth_sd": deviation[:, clamps:],
            "residual": one.depth - self.common.offset - found.depth[:, one.point],
        }
        if law is None:
            columns |= {
                "current_factor": found.current * known,
                "current_doubt": found.doubt * known[:, None],
                "plain_depth": plain(self._alone, one)[:, one.point],
            }
        return profiles, columns

    @cached_property
    def forwards(self) -> tuple[Forward, dict[str, Forward]]:
        return forwards_of(self.mooring, self.common)

    @cached_property
    def _neighbours(self) -> tuple[Floats, Floats]:
        return by_neighbours(self.measured.time, self.measured.depth)

    @cached_property
    def _alone(self) -> Forward:
        return Forward(self.mooring, {})


def plain(forward: Forward, one: MooringMeasurements) -> Floats:
    """Return (n, p) depths of the points by the currents alone, nothing fitted [m]."""
    moments = LineResponse(one, forward, {})
    depth = np.tile(forward.still, (len(one.time), 1))
    for _ in range(2):
        level = moments.levels(np.nan_to_num(depth))
        u, v, _ = moments.read(level)
        depth = forward.depths(level, u, v)
    return depth


class MeasuredRecord(Record):
    """Hold what was measured, as the record that a result is made from."""

    def __init__(
        self, measured: MooringMeasurements, source: dict[str, str], notes: Sequence[str]
    ) -> None:
        self._measured = measured
        self.time, self.source, self.notes = measured.time, dict(source), tuple(notes)

    def profiles(self, start: int, stop: int) -> Levels:
        """See `Record`; levels that hang on the line have no depth of their own."""
        one = self._measured.at(slice(start, stop))
        return one.level_depth, one.u, one.v, None

    def close(self) -> None:
        """Do nothing: no file is open."""

    def digest(self, check: Callable[[], None] = lambda: None) -> str:
        """SHA-256 of all that was measured."""
        one = self._measured
        digest = hashlib.sha256(" ".join(one.label).encode())
        tide = np.zeros(0) if one.tide is None else one.tide
        arrays = (one.time.astype("M8[ns]").view("<i8"), one.point, one.depth, one.level_depth,
                  one.level_point, one.level_sensor, one.u, one.v, one.flag, tide)  # fmt: skip
        for array in arrays:
            check()
            digest.update(str(array.shape).encode())
            digest.update(np.ascontiguousarray(array).data)
        return digest.hexdigest()
