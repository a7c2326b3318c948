"""Estimation of the depths of a mooring in blocks of times, and layout of the result file."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from calm.batch.blocks import SolvedBlock
from calm.batch.dataset import laid_out, layout_of
from calm.batch.profiles import Profiles, processors
from calm.batch.statuses import STATUSES
from calm.case import Design
from calm.dataset.discovery import (
    ARCHIVED,
    GCMD,
    archive_id,
    coverage,
    mooring_in,
    with_flags,
    written,
)
from calm.dataset.netcdf import Attributes, ResultLayout, down_the_line, labels, numbers, packed
from calm.files.pieces import clamps_down
from calm.motion.common_unknowns import Common
from calm.motion.line_response import Forward, LineResponse, forwards_of, labels_of, points
from calm.motion.matching import serials_of
from calm.motion.measured_currents import CurrentSmoother
from calm.motion.measurements import MooringMeasurements, level_names
from calm.motion.remarks import Fault
from calm.motion.unknown_currents import unknown_state
from calm.physics.line import Floats
from calm.records.card import ReadCard
from calm.records.record import Levels, Record

_DEVIATION: Attributes = {"standard_name": "depth standard_error"}
_DEPTH: Attributes = {"standard_name": "depth", "positive": "down"}
# variables added to a batch result: dimensions after time, and (unit, meaning, attributes)
OF_MOTION: Mapping[str, tuple[tuple[str, ...], tuple[str, str, Attributes]]] = {
    "clamp_depth_sd": (
        ("clamp",), ("m", "standard deviation of the depth of the clamped instrument", _DEVIATION),
    ),
    "depth_sd": (
        ("component",), ("m", "standard deviation of the depth of the upper end", _DEVIATION),
    ),
    "current_factor": ((), ("1", "estimated current divided by measured current", {})),
    "current_doubt": (("level",), ("1", "probability that the current at the level is wrong", {})),
    "residual": (("sensor",), ("m", "measured depth of the sensor minus its estimated depth", {})),
    "plain_depth": (("sensor",), (
        "m", "depth of the sensor computed from the currents alone, without fitting", _DEPTH,
    )),
}  # fmt: skip
OF_CURRENTS = frozenset({"current_factor", "current_doubt", "plain_depth"})  # for measured currents
MEASURED, ESTIMATED, MISSING = 1, 8, 9  # flags of depths, from the flag table of OceanSITES
FLAGGED = {"clamp_depth": ["clamp_depth_sd"], "depth_top": ["depth_sd"]}
_OF_DOCUMENT = {
    "institution": "institution", "author": "creator_name", "email": "creator_email",
    "url": "creator_url", "license": "license", "project": "project", "site": "site_code",
    "platform": "platform_code", "investigator": "principal_investigator",
    "acknowledgement": "acknowledgement", "ship": "platform_deployment_ship_name",
    "cruise": "platform_deployment_cruise_name",
}  # fmt: skip
"""Attributes of ACDD and OceanSITES, by the keys of `document:`."""


def solve_times(
    task: Task, layout: ResultLayout, extent: list[np.float32], start: int
) -> SolvedBlock:
    """Estimate the depths in the block of times that begins at `start`, and pack them for writing.

    The smallest and the largest depth [m] are appended to `extent`.
    """
    stop = start + BLOCK
    profiles, more = task.columns(start, stop)
    flags = depth_flags(task.measured.at(slice(start, stop)), profiles)
    columns = {**vars(profiles), **more, **flags}
    arrays = laid_out(layout, task.measured.time[start:stop], columns)
    depth = np.hstack([arrays[name] for name in FLAGGED if name in arrays])
    known = depth[np.isfinite(depth)]
    extent += [known.min(), known.max()] if known.size else []
    return SolvedBlock(profiles.status, packed(layout, BLOCK, arrays))


def motion_layout(task: Task, record: MeasuredRecord) -> ResultLayout:
    """Return the layout of the result file: a batch result plus the estimates of motion.

    The date is set only if SOURCE_DATE_EPOCH is set, so that equal inputs give equal bytes.
    """
    layout, mooring, measured = layout_of(task.mooring, record), task.mooring, task.measured
    alone = task.common.inferred
    names = () if alone else level_names(measured, labels_of(mooring))
    added = {"sensor": len(measured.label), "level": len(names)}
    known = {**layout.sizes, **added}
    variables = [*layout.variables, *down_the_line(added)]
    if names:
        variables.append(labels("level_label", "level", names, "levels of the currents"))
    if measured.label:
        meaning = "sensors whose pressures are used, from the top down"
        variables.append(labels("sensor_label", "sensor", measured.label, meaning))
    for name, (dimensions, quantity) in OF_MOTION.items():
        if all(known.get(each) for each in dimensions) and not (alone and name in OF_CURRENTS):
            beside = "".join(f"{dimension}_label" for dimension in dimensions)
            variables += numbers(("time", *dimensions), {name: quantity}, beside)
    serials, clamps = serials_of(mooring), len(clamps_down(mooring.file.pieces))
    for dimension, mine in (("clamp", serials[:clamps]), ("component", serials[clamps:])):
        if any(mine):
            variables.append(labels(f"{dimension}_serial", dimension, mine, "serial number"))
    position, deployed = mooring.file.position, mooring.file.deployed
    if deployed is not None and deployed.position is not None:
        position = deployed.position
    place = () if position is None else (position.latitude, position.longitude)
    name = mooring_in(str(layout.attributes["title"]))
    made, *read = str(layout.attributes["history"]).split("\n")
    sources = "; ".join(filter(None, record.source.values()))
    made = f"{made.replace(' batch', ' motion')}: {sources}"
    attributes: Attributes = {
        **layout.attributes,
        "title": f"{name}: motion of the mooring",
        **ARCHIVED,
        **coverage(measured.time, Forward(mooring, {}).still, place),
        **about(mooring),
        "id": archive_id(name, measured.time[0], "DEPTHS"),
        "keywords": "EARTH SCIENCE > OCEANS > OCEAN PRESSURE",
        "keywords_vocabulary": GCMD,
        "processing_level": "Data interpolated",
        "comment": "Depths estimated from the statics of the line; x and y are measured from the "
        "anchor",
        "instrument": ", ".join(measured.label),
        "history": "\n".join([made, *read]),
    }
    if not attributes.get("summary"):
        attributes["summary"] = f"Depths of every part of the mooring {name} over time"
    if os.environ.get("SOURCE_DATE_EPOCH"):
        attributes["date_created"] = attributes["date_modified"] = written()
    sizes = {name: size for name, size in known.items() if size}
    return ResultLayout(sizes, with_flags(variables, FLAGGED), attributes)


def about(mooring: Design) -> Attributes:
    """Return archive attributes from the keys `document` and `deployed` of a mooring file."""
    file = mooring.file
    known = {} if file.document is None else file.document.to_dict()
    attributes: Attributes = {
        name: str(known[key]) for key, name in _OF_DOCUMENT.items() if key in known
    }
    for part in ("name", "email", "url"):  # the creator also publishes the file
        if f"creator_{part}" in attributes:
            attributes[f"publisher_{part}"] = attributes[f"creator_{part}"]
    if "institution" in attributes:
        attributes["creator_institution"] = attributes["institution"]
    if file.deployed is not None and file.deployed.date is not None:
        attributes["platform_deployment_date"] = str(file.deployed.date)
    attributes["water_depth"] = float(mooring.water.depth)
    return attributes


def depth_flags(one: MooringMeasurements, profiles: Profiles) -> dict[str, NDArray[np.int8]]:
    """Return a flag for each depth: measured by a sensor at the point, estimated, or missing."""
    clamps, depth = profiles.clamp_depth.shape[1], points(profiles)
    flag = np.where(np.isfinite(depth), ESTIMATED, MISSING).astype(np.int8)
    for j, point in enumerate(one.point.tolist()):
        own = np.isfinite(one.depth[:, j]) & (flag[:, point] == ESTIMATED)
        flag[own, point] = MEASURED
    return {"clamp_depth_qc": flag[:, :clamps], "depth_top_qc": flag[:, clamps:]}


def estimate_in_memory(
    task: Task, wanted: Sequence[int], workers: int | None = None
) -> tuple[Floats, Floats]:
    """Estimate (n, m) depths of m points, and standard deviations [m], without writing a file."""
    starts = range(0, len(task.measured.time), BLOCK)

    def one(start: int) -> tuple[Floats, Floats]:
        profiles, more = task.columns(start, start + BLOCK)
        spread = np.hstack([more["clamp_depth_sd"], more["depth_sd"]])
        return points(profiles)[:, wanted], spread[:, wanted]

    with ThreadPoolExecutor(workers or processors()) as pool:
        found = list(pool.map(one, starts))
    return np.concatenate([each[0] for each in found]), np.concatenate([each[1] for each in found])


BLOCK = 512  # number of times that are estimated and written together


@dataclass(frozen=True)
class Task:
    """Input of the estimate of depths, from the sensors in use.

    `smoother` is the solution for the whole record; None without measured currents. `faults` are
    the diagnosed faults; None before the diagnosis.
    """

    mooring: Design
    measured: MooringMeasurements
    common: Common
    smoother: CurrentSmoother | None = None
    faults: tuple[Fault, ...] | None = None

    def columns(self, start: int, stop: int) -> tuple[Profiles, dict[str, NDArray[np.float64]]]:
        """Estimate the depths of the line and related results at the times from `start` to `stop`.

        Return the profiles in the most likely currents, and the additional variables of the result
        file by the names in `OF_MOTION`.
        """
        times, smoother = slice(start, stop), self.smoother
        one = self.measured.at(times)
        if smoother is None:
            moments = LineResponse(one, *self.forwards)
            state = unknown_state(moments, self.common)
            found, factor = state.found, np.exp(state.found.logs)
            forward, offset = moments.forward, self.common.offset
            depth, deviation = found.depth, np.sqrt(found.variance)
            read = replace(state.read, u=factor * state.read.u, v=factor * state.read.v)
            surface = self.common.datum + found.sea
        else:
            forward, offset = smoother.best, smoother.offset[times]
            depth, deviation = smoother.depth[times], smoother.deviation[times]
            read, surface = smoother.read(times), smoother.surface[times]
        # inferred currents may exceed the speed limit, which is meant for errors in files
        limit = self.mooring.file.environment.maximum_speed
        share = np.minimum(1.0, (1.0 - 1e-9) * limit / np.maximum(np.hypot(read.u, read.v), 1e-9))
        likely = forward.solve(read.level, share * read.u, share * read.v)
        clamps = likely.clamp_depth.shape[1]
        shift = depth - points(likely)
        down = depth - surface[:, None] - forward.still
        profiles = likely.with_columns(
            clamp_depth=depth[:, :clamps],
            depth_top=depth[:, clamps:],
            clamp_knockdown=down[:, :clamps] + 0.0 * likely.clamp_knockdown,
            knockdown=down[:, clamps:] + 0.0 * likely.knockdown,
            top_depth=likely.top_depth + shift[:, clamps],
        )
        if smoother is not None:
            profiles = without_current(profiles, smoother.lost[times], one.false)
        known = np.where(profiles.status == 0, 1.0, np.nan)
        clamp_deviation, own_deviation = np.split(deviation * known[:, None], [clamps], axis=1)
        columns = {
            "clamp_depth_sd": clamp_deviation, "depth_sd": own_deviation,
            "residual": one.depth - offset - depth[:, one.point],
        }  # fmt: skip
        if smoother is not None:
            columns |= {
                "current_factor": smoother.current_factor[times] * known,
                "current_doubt": smoother.doubt[times] * known[:, None],
                "plain_depth": smoother.plain[times][:, one.point],
            }
        return profiles, columns

    @cached_property
    def forwards(self) -> tuple[Forward, dict[str, Forward]]:
        return forwards_of(self.mooring, self.common)


def without_current(
    profiles: Profiles, lost: NDArray[np.bool_], false: NDArray[np.bool_] | None
) -> Profiles:
    """Set the results to NaN at times that are far from any measured current.

    The mask `lost` (n,) is true at these times. Their status becomes "implausible-current" if the
    mask `false` (n,) is also true, and "no-current" otherwise.
    """
    status = np.where(lost, STATUSES.index("no-current"), profiles.status)
    if false is not None:
        status = np.where(lost & false, STATUSES.index("implausible-current"), status)
    columns = {
        name: np.where(lost.reshape(-1, *[1] * (each.ndim - 1)), np.nan, each)
        for name, each in vars(profiles).items()
        if isinstance(each, np.ndarray) and each.dtype.kind == "f" and len(each) == len(lost)
    }
    return profiles.with_columns(**columns, status=status.astype(np.int8))


class MeasuredRecord(Record):
    """Measured currents as a `Record`, the form in which they are written to a result file."""

    def __init__(
        self,
        measured: MooringMeasurements,
        source: dict[str, str],
        notes: Sequence[str],
        cards: Sequence[ReadCard] = (),
    ) -> None:
        self._measured, self.cards = measured, tuple(cards)
        self.time, self.source, self.notes = measured.time, dict(source), tuple(notes)

    def profiles(self, start: int, stop: int) -> Levels:
        """Return the levels as `Record.profiles` does; depths of levels on the line are NaN."""
        one = self._measured.at(slice(start, stop))
        return one.level_depth, one.u, one.v, None

    def close(self) -> None:
        """Do nothing, as no file is open."""
