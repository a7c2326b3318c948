"""Every time of a record estimated in blocks, kept at once, taken up again where it stopped."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np

from calm.batch.dataset import laid_out, layout_of
from calm.batch.profiles import Batch
from calm.batch.run import BatchOutcome, run_kept
from calm.batch.store.identity import identity_of, to_text
from calm.batch.store.store import Store, open_store
from calm.batch.threads import processors
from calm.batch.work import BatchWork, Progress
from calm.dataset.variables import Attributes, ResultLayout, labels, numbers
from calm.motion.matching import labels_of
from calm.motion.measurements import level_names
from calm.motion.task import BLOCK, MeasuredRecord, Task
from calm.physics.line import Floats

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
        arrays = laid_out(self.store.layout, time, {**vars(profiles), **more})
        self.count(profiles)
        self._keep(number, [arrays])


def motion_layout(task: Task, record: MeasuredRecord) -> ResultLayout:
    """Return the result of a batch, with what is estimated besides."""
    layout = layout_of(task.mooring, record, None)
    known = dict(layout.sizes)
    known["sensor"] = len(task.measured.label)
    names = level_names(task.measured, labels_of(task.mooring))
    known["level"] = len(names)
    variables = [*layout.variables]
    if names:
        variables.append(labels("level_label", "level", names, "levels of the currents"))
    if known["sensor"]:
        meaning = "sensors whose pressures are used, from the top down"
        variables.append(labels("sensor_label", "sensor", task.measured.label, meaning))
    for name, (dimensions, quantity) in OF_MOTION.items():
        if all(known.get(dimension) for dimension in dimensions):
            beside = "".join(f"{dimension}_label" for dimension in dimensions)
            variables += numbers(("time", *dimensions), {name: quantity}, beside)
    sizes = {name: size for name, size in known.items() if size}
    attributes = dict(layout.attributes)
    attributes["title"] = attributes["title"].partition(": ")[0] + ": where its parts were"
    attributes["history"] = attributes["history"].replace(" batch", " motion")
    return replace(layout, sizes=sizes, variables=tuple(variables), attributes=attributes)


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
