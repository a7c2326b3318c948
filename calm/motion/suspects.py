"""What may be wrong with a record: one thing each, and what it does to the depths.

Of the line and its currents: all currents or those of one level read too low or too high, or a
rotor slows; floats are missing; cables are longer or shorter; the drag is another, or grows by
fouling. Some do nearly the same to the depths: their odds say whether the record tells them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from calm.motion.correction import Task
from calm.motion.line_response import (
    FACTORS,
    STEP,
    Forward,
    Linear,
    LineResponse,
    ReadCurrents,
    labels_of,
)
from calm.motion.measurements import level_names
from calm.motion.remarks import CURRENTS, LINE, Fault
from calm.physics.line import Floats

NO_TIME = np.datetime64("NaT", "ns")
CAUSES: Mapping[str, tuple[float, float]] = {
    "currents": (0.3, 0.02),
    "buoyancy": (0.3, 0.02),
    "length": (0.02, 0.02),
    "drag": (0.3, 0.02),
    "fouling": (0.5, 0.02),
    "speed": (0.3, 0.001),
    "slows": (0.5, 0.01),
}
"""Deviation of the logarithm of each beforehand, beyond what is assumed of every record, and its
probability; that of a level is shared by all levels."""


@dataclass(frozen=True)
class Suspect:
    """What one fault does to n times of s sensors.

    Attributes
    ----------
    fault : what it is
    column : (n, s) change of the depths that are read with its size
    wide : deviation of its size beforehand; 0 of one whose size is fixed
    log : logarithm of its probability beforehand
    shift : (n, s) what is added to the depths that are read beforehand [m]
    ahead : (n, s) change of the depths with a size throughout [m]; None where it is linear
    share : (n, 1) of the size at each time; None of one that is the same throughout
    """

    fault: Fault
    column: Floats
    wide: float
    log: float
    shift: Floats
    ahead: Callable[[float], Floats] | None = None
    share: Floats | None = None

    def at(self, size: float) -> Suspect:
        """Return the same with the change that such a size makes, which is not proportional.

        A parabola through nothing, with the slope there, and through the size throughout.
        """
        if self.ahead is None or self.share is None:
            return self
        slope = np.divide(
            self.column, self.share, out=np.zeros_like(self.column), where=self.share > 0.0
        )
        bend = self.ahead(size) / size - slope
        return replace(self, column=self.share * (slope + bend * self.share))


def line_suspects(
    task: Task, moments: LineResponse, way: ReadCurrents, at: Linear
) -> Iterator[Suspect]:
    """Yield what may be wrong with the line and its currents, where these were measured.

    Parameters
    ----------
    moments : at some of the times
    way, at : the currents there, and the line in them
    """
    common, one = task.common, moments.measured
    good = np.isfinite(at.depth).all(axis=1)
    span = task.measured.time[[0, -1]]
    share = ((one.time[good] - span[0]) / max(span[1] - span[0], np.timedelta64(1, "ns")))[:, None]

    def seen(slope: Floats) -> Floats:
        return slope[good][:, one.point]

    def suspect(
        label: str, kind: str, column: Floats, among: int = 1,
        ahead: Callable[[float], Floats] | None = None, part: Floats | None = None,
    ) -> Suspect:  # fmt: skip
        wide, chance = CAUSES[kind]
        fault = Fault(label, kind, 1.0, 1.0, 1.0, 0.0, NO_TIME, NO_TIME)
        log, none = float(np.log(chance / among)), np.zeros_like(column)
        return Suspect(fault, column, wide, log, none, ahead, part)

    def dragged(size: float) -> Floats:
        factors = {n: v * np.exp(size * n.endswith("drag")) for n, v in common.factors.items()}
        there = moments.depths(way, at.logs, Forward(task.mooring, factors))
        return np.nan_to_num(seen(there - at.depth))

    def misread(level: int) -> Callable[[float], Floats]:
        mine = np.arange(moments.groups) == level
        return lambda size: np.nan_to_num(
            seen(moments.depths(way, at.logs - size * mine) - at.depth)
        )

    names = list(common.factors)
    columns = {name: seen(at.common[:, :, i]) for i, name in enumerate(names)}
    for name in FACTORS:
        if name not in columns:
            forward = Forward(task.mooring, {**common.factors, name: float(np.exp(STEP))})
            ahead = moments.depths(way, at.logs, forward)
            columns[name] = np.nan_to_num(seen((ahead - at.depth) / STEP))
    yield suspect(LINE, "length", columns["length"])
    yield suspect(LINE, "buoyancy", columns["buoyancy"])
    drag = columns["cable_drag"] + columns["rigid_drag"]
    yield suspect(LINE, "drag", drag)
    yield suspect(LINE, "fouling", share * drag, 1, dragged, share)
    slope = seen(at.slope)  # a meter reads less: the line is deeper than by its currents
    yield suspect(CURRENTS, "currents", -slope.sum(axis=2))
    levels = level_names(task.measured, labels_of(task.mooring))
    if len(levels) == moments.groups > 1:
        for k, name in enumerate(levels):
            one_level, many = -slope[:, :, k], len(levels)
            yield suspect(name, "speed", one_level, many, misread(k), np.ones_like(share))
            yield suspect(name, "slows", share * one_level, many, misread(k), share)
