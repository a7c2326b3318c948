"""Which readings and which sensors can be right, before anything is estimated from them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calm.errors import UsageError
from calm.motion.measured import Measured
from calm.motion.sensors import Sensor
from calm.physics.line import Floats

CONSTANT = 1e-6
"""A sensor whose depths span no more than this measures nothing [m]."""
MISPLACED = 20.0
"""How far from its place in still water a sensor may be at its least depth [m], where that is
not within a factor of two either."""
BELOW = 1.1
"""No reading is deeper than the seabed by this factor, and by `MISPLACED`."""


def plausible(sensor: Sensor, place: float, seabed: float) -> tuple[Sensor, list[str]]:
    """A sensor without the readings that cannot be from its place, and what is said of them.

    Those far above its place in still water (on deck, a fill value), those far below the seabed,
    and the later ones of a time that stands twice. Where most are so, the sensor is wrong, not
    these readings, and all stay: see `unusable`.

    Parameters
    ----------
    place : depth where it hangs in still water [m]
    seabed : depth of the water [m]
    """
    notes = []
    again = np.zeros(len(sensor.time), bool)
    again[1:] = sensor.time[1:] == sensor.time[:-1]
    if again.any():
        when = np.datetime_as_string(sensor.time[again][0], "s")
        notes.append(
            f"{sensor.label}: {again.sum()} of its times stand twice, the first {when}: the first "
            "reading of each counts"
        )
        sensor = replace(sensor, time=sensor.time[~again], depth=sensor.depth[~again])
    least = min(0.5 * place, place - MISPLACED)
    greatest = max(BELOW * seabed, seabed + MISPLACED)
    wrong = (sensor.depth < least) | (sensor.depth > greatest)
    if wrong.any() and 2 * wrong.sum() < np.isfinite(sensor.depth).sum():
        first = int(wrong.argmax())
        notes.append(
            f"{sensor.label}: {wrong.sum()} of its readings cannot be from its place, "
            f"{place:.1f} m, and are left out: the first is {sensor.depth[first]:.1f} m, at "
            f"{np.datetime_as_string(sensor.time[first], 's')}"
        )
        sensor = replace(sensor, depth=np.where(wrong, np.nan, sensor.depth))
    return sensor, notes


def unusable(measured: Measured, still: Floats) -> dict[str, str]:
    """Sensors that cannot be used, each with the reason; what cannot be right is refused.

    Raises
    ------
    UsageError
        A sensor is nowhere near its place on the line, so that its unit or its label is wrong.
    """
    reasons, complaints = {}, []
    for j, label in enumerate(measured.label):
        depth = measured.depth[:, j][np.isfinite(measured.depth[:, j])]
        if not depth.size:
            reasons[label] = "has no good pressure at any time of the currents"
            continue
        if depth.size > 2 and np.ptp(depth) <= CONSTANT:
            reasons[label] = f"is constant at {depth[0]:.1f} m: it is left out"
            continue
        least, place = float(np.percentile(depth, 5.0)), float(still[measured.point[j]])
        if abs(least - place) > MISPLACED and not 0.5 < least / place < 2.0:
            complaints.append(
                f"`{label}` is at {least:.1f} m at its least, where the line has it at "
                f"{place:.1f} m: its unit (bar, kPa?) or its label is wrong"
            )
    if complaints:
        raise UsageError("--pressures: " + "; ".join(complaints))
    return reasons
