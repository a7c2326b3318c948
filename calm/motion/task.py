"""A mooring, what was measured on it, and what of that is used."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from calm.batch.profiles import Profiles
from calm.batch.statuses import STATUSES
from calm.case import Mooring
from calm.motion.common_unknowns import Common
from calm.motion.estimate import estimated
from calm.motion.line_response import Forward, LineResponse, points
from calm.motion.measurements import FREE, MooringMeasurements
from calm.motion.whole_record import forwards_of
from calm.physics.line import Floats
from calm.records.record import Levels, Record

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
        `current_factor`, `current_doubt`, `residual`, `plain_depth`.
        """
        one = self.measured.at(slice(start, stop))
        moments = LineResponse(one, *self._forwards)
        found = estimated(moments, self.common)
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
        return profiles, {
            "clamp_depth_sd": found.deviation[:, :clamps] * known[:, None],
            "depth_sd": found.deviation[:, clamps:] * known[:, None],
            "current_factor": found.current * known,
            "current_doubt": found.doubt * known[:, None],
            "residual": one.depth - self.common.offset - found.depth[:, one.point],
            "plain_depth": plain(self._alone, one)[:, one.point],
        }

    @cached_property
    def _forwards(self) -> tuple[Forward, dict[str, Forward]]:
        return forwards_of(self.mooring, self.common)

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


def without(measured: MooringMeasurements, labels: Sequence[str]) -> MooringMeasurements:
    """Return what was measured but for some sensors: hidden everywhere, their currents' depths
    too.
    """
    kept = [i for i, label in enumerate(measured.label) if label not in labels]
    point = measured.point[kept]
    places = point.tolist()
    return replace(
        measured,
        label=tuple(measured.label[i] for i in kept),
        point=point,
        depth=measured.depth[:, kept],
        level_sensor=np.array(
            [places.index(at) if at in places else FREE for at in measured.level_point.tolist()],
            np.int64,
        ),
    )
