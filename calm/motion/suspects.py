"""Suspects: possible faults of a record, with their effects on the depths.

Faults of the line and its currents are: meters that read too low or too high, missing floats, wrong
cable lengths, wrong drag, and fouling. The module also finds readings that contradict the length of
line between two sensors.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from calm.case import Design
from calm.files.pieces import clamps_down
from calm.motion.common_unknowns import FACTORS, NOISE, NORMAL
from calm.motion.correction import Task
from calm.motion.currents_law import Linear, ReadCurrents
from calm.motion.line_response import STEP, Forward
from calm.motion.measurements import MooringMeasurements, exclude_readings
from calm.motion.remarks import ALL, BAND, CURRENTS, LINE, Fault
from calm.physics.line import Floats

# prior standard deviation of the logarithm of each fault, and its prior probability
CAUSES: Mapping[str, tuple[float, float]] = {
    "currents": (0.3, 0.02), "buoyancy": (0.3, 0.02), "length": (0.02, 0.02), "drag": (0.3, 0.02),
    "fouling": (0.5, 0.02),
}  # fmt: skip


@dataclass(frozen=True)
class Suspect:
    """A possible fault, and its effect on the readings of s sensors at n times."""

    fault: Fault
    column: Floats  # (n, s) change in the measured depths per unit of the size of the fault
    wide: float  # prior standard deviation of the size; 0 if the size is fixed
    log: float  # logarithm of the prior probability of the fault
    # (n, s) change in the measured depths due to a fault of fixed size [m]; otherwise 0
    shift: Floats | float = 0.0


def line_suspects(task: Task, read: ReadCurrents, at: Linear, share: Floats) -> Iterator[Suspect]:
    """Yield possible faults of the line and its measured currents.

    `at` is a linear model of the line in the currents `read` at several times; its state is the
    logarithm of a factor on all speeds. `share` is the elapsed share of the record at each of these
    times with an equilibrium.
    """
    factors = task.common.factors
    good = np.isfinite(at.depth).all(axis=1)

    def suspect(label: str, kind: str, slope: Floats, part: Floats | float = 1.0) -> Suspect:
        wide, chance = CAUSES[kind]
        column = part * slope[good][:, task.measured.point]
        return Suspect(Fault(label, kind, value=1.0), column, wide, float(np.log(chance)))

    columns = dict(zip(factors, np.moveaxis(at.common, 2, 0), strict=True))
    for name in FACTORS:
        if name not in columns:
            forward = Forward(task.mooring, {**factors, name: float(np.exp(STEP))})
            ahead = forward.depths(read.level, read.u, read.v)
            columns[name] = np.nan_to_num((ahead - at.depth) / STEP)
    yield suspect(LINE, "length", columns["length"])
    yield suspect(LINE, "buoyancy", columns["buoyancy"])
    drag = columns["cable_drag"] + columns["rigid_drag"]
    yield suspect(LINE, "drag", drag)
    yield suspect(LINE, "fouling", drag, share[:, None])
    # meters that read low: the line is deeper than computed
    yield suspect(CURRENTS, "currents", -at.slope[:, :, 0])


GOOD, FEWEST_TIMES = 2, 20  # highest quality flag of a usable current, and least shared times
COHERENT = 0.8  # least correlation of a level with its neighbours
TURNED, UNLIKE = 10.0, 5.0  # rotation [degrees] and speed ratio above which a meter is reported


def meter_remarks(measured: MooringMeasurements, names: Sequence[str]) -> list[str]:
    """Return a remark on each current meter with rotated or mirrored readings, or a wrong unit.

    A meter is reported if it disagrees with its two nearest meters, and these two meters agree with
    each other. The measure of agreement is the complex correlation r of the currents at two meters
    (Kundu 1976, J. Phys. Oceanogr. 6, 238-242). The phase of r is the mean angle between the
    currents. For n independent times, this phase has the standard deviation
    sqrt((1 - r²) / (2 r² n)).
    """
    flow = np.where(measured.flag <= GOOD, measured.u + 1j * measured.v, np.nan)

    def against(one: int, other: int) -> tuple[complex, complex, float]:
        both = np.isfinite(flow[:, [one, other]]).all(axis=1)
        a, b = flow[both][:, [one, other]].T
        own, his = np.linalg.norm(a), np.linalg.norm(b)
        if both.sum() < FEWEST_TIMES or not own * his:
            return 0j, 0j, 1.0
        return np.vdot(b, a) / (own * his), a @ b / (own * his), float(own / his)

    remarks = []
    for k, name in enumerate(names if len(names) > 2 else []):
        near = sorted((j for j in range(len(names)) if j != k), key=lambda j: abs(j - k))[:2]
        (*straight, agree), (*mirror, _), (*fast, usual) = zip(
            *(against(*pair) for pair in ((k, near[0]), (k, near[1]), near)), strict=True
        )
        if abs(agree) < COHERENT:
            continue
        angle = -np.degrees(np.angle(straight))
        least = TURNED + abs(np.degrees(np.angle(agree)))
        if min(np.abs(mirror)) > max(COHERENT, *np.abs(straight)):
            what = "its east and north components are exchanged, or the sign of one is wrong"
        elif min(np.abs(straight)) < COHERENT:
            continue
        elif min(np.abs(angle)) > least:
            mean = float(-np.degrees(np.angle(sum(straight))))
            known = flow[np.isfinite(flow[:, k]), k]
            alike = abs(np.vdot(known[1:], known[:-1]) / np.vdot(known, known)) ** 2
            count = len(known) * (1.0 - alike) / (1.0 + alike)  # number of independent times
            part = min(min(np.abs(straight)), 1.0) ** 2
            band = BAND * np.degrees(np.sqrt((1.0 - part) / (2.0 * part * count)))
            sense = "clockwise" if mean > 0.0 else "anticlockwise"
            why = "its compass or its declination is wrong, or the current veers there"
            if abs(mean) > 180.0 - least - band:
                why = "it gives the direction from which the current comes, or both signs are wrong"
            what = f"its direction is rotated {abs(mean):.0f}° (± {band:.0f}°) {sense}; {why}"
        elif max(fast) * UNLIKE < min(1.0, usual) or min(fast) > UNLIKE * max(1.0, usual):
            what = (
                f"its speeds are {np.sqrt(np.prod(fast)):.2g} times those of the other "
                "two; its unit is wrong"
            )
        else:
            continue
        remarks.append(
            f"current at {name}, compared with {names[near[0]]} and {names[near[1]]}: {what}"
        )
    return remarks


STRETCHED, AMISS = 1.25, 20.0  # maximum ratio of stretched to unstretched length, and tolerance [m]


def distances_of(mooring: Design) -> Floats:
    """Return distances (p,) of clamps and pieces from the top, along the unstretched line [m]."""
    pieces = mooring.file.pieces
    tops = np.cumsum([0.0, *mooring.line.length.tolist()])[: len(pieces)]
    clamps = [
        top + clamp.at
        for top, piece in zip(tops, pieces, strict=True)
        for clamp in clamps_down([piece])
    ]
    return np.array([*clamps, *tops])


def torn(
    measured: MooringMeasurements, distance: Floats, hidden: Collection[str] = ()
) -> tuple[MooringMeasurements, list[str]]:
    """Remove readings that differ in depth by more than the length of line between the sensors.

    Of two such readings, the one farther from the median of its sensor is removed. A sensor that
    would lose half of its readings keeps all. Sensors in `hidden` are ignored. `distance` (p,) is
    the distance of the points from the top along the line [m]. Also return notes.
    """
    depth, place = measured.depth, distance[measured.point]
    used = [i for i, label in enumerate(measured.label) if label not in hidden]
    away = np.abs(depth - np.nanmedian(depth, axis=0))
    wrong = np.zeros(depth.shape, bool)
    for i, j in combinations(used, 2):
        reach = STRETCHED * abs(place[i] - place[j]) + AMISS
        apart = np.abs(depth[:, i] - depth[:, j]) > reach
        wrong[:, i] |= apart & (away[:, i] > away[:, j])
        wrong[:, j] |= apart & (away[:, i] <= away[:, j])
    wrong &= 2 * wrong.sum(axis=0) < np.isfinite(depth).sum(axis=0)
    kept, excluded = exclude_readings(measured, wrong)
    return kept, [
        f"{label}: {count} of its readings were excluded, because their distance in depth from "
        "another sensor exceeds the length of line between both sensors; the first is "
        f"{first:.1f} m, at {time}"
        for label, count, first, time in excluded
    ]


EITHER_SIDE = 4  # number of times averaged on either side of a step
CLEAR = 8.0  # least ratio of the step of the lowest sensor to the usual change of this sensor
LEAST_STEP = 3.0  # least size of a step [m]


def common_step(measured: MooringMeasurements, still: Floats) -> Fault | None:
    """Find a step common to the depths of all sensors; return None if there is no such step.

    Such a step means that the whole mooring has moved to another depth. It is sought only in
    records without measured currents.
    """
    whole = np.flatnonzero(np.isfinite(measured.depth).all(axis=1))
    order = np.argsort(still[measured.point], kind="stable")
    depth = measured.depth[whole][:, order]
    count, sensors = depth.shape
    if count < 4 * EITHER_SIDE or sensors < 2:
        return None
    sums = np.cumsum(np.pad(depth, ((1, 0), (0, 0))), axis=0)
    means = (sums[EITHER_SIDE:] - sums[:-EITHER_SIDE]) / EITHER_SIDE
    change = means[EITHER_SIDE:] - means[:-EITHER_SIDE]
    usual = NORMAL * np.median(np.abs(change), axis=0) + NOISE
    at = int(np.abs(change[:, -1]).argmax())
    size = float(change[at, -1])
    lasting = np.median(depth[at + EITHER_SIDE :, -1]) - np.median(depth[: at + EITHER_SIDE, -1])
    # a current would lower the lowest sensor less than the highest
    alike = np.abs(change[at] - size) <= 3.0 * usual
    if abs(size) < max(CLEAR * usual[-1], LEAST_STEP) or not alike.all():
        return None
    if abs(lasting - size) > 0.5 * abs(size):
        return None
    since = measured.time[whole[at + EITHER_SIDE]]
    deviation = float(usual[-1] / np.sqrt(EITHER_SIDE))
    return replace(Fault(ALL, "moved", since=since).sized(size, deviation), odds=np.inf)
