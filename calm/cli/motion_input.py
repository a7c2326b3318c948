"""What ``calm motion`` is given: names, times, and files of what was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from calm.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from calm.case import Mooring
    from calm.motion.measured import Measured

_MATCHES = ("label", "height", "depth")


def fitted(text: str | None) -> tuple[str, ...]:
    """The factors that are estimated: those of the drag, and what is asked for besides.

    Raises
    ------
    UsageError
        What is asked for cannot be estimated.
    """
    from calm.motion.forward import FACTORS
    from calm.suggestions import unknown

    asked = [] if text is None else [name.strip() for name in text.split(",")]
    for name in asked:
        if name not in FACTORS:
            raise UsageError(unknown(f"--fit: `{name}` cannot be estimated", name, FACTORS))
    return tuple(name for name in FACTORS if name.endswith("_drag") or name in asked)


def parse_gap(text: str) -> np.timedelta64:
    """A time such as ``2 h``.

    Raises
    ------
    UsageError
        It is none, or is not between 0 and three years.
    """
    import numpy as np

    from calm.units import QuantityError, parse_quantity

    try:
        seconds = parse_quantity(text, "time", usual_unit="h")
    except QuantityError as error:
        raise UsageError(f"--gap: `{text}` {error}") from None
    if not 0.0 <= seconds < 1e8:
        raise UsageError(f"--gap: `{text}` is not between 0 and three years")
    return np.timedelta64(round(seconds * 1e9), "ns")


def read_measured(
    mooring: Mooring,
    currents: list[Path],
    pressures: list[str],
    match: str,
    flags: str,
    gap: np.timedelta64,
    sea_level: Path | None,
    declination: float | None,
) -> tuple[Measured, list[str], dict[str, str]]:
    """What was measured, on common times; what is said of it, and its source."""
    import numpy as np

    from calm.motion.currents import read_currents
    from calm.motion.flags import parse_flags
    from calm.motion.forward import Forward
    from calm.motion.joined import joined
    from calm.motion.matching import (
        instruments_of,
        labels_of,
        matched_by_label,
        matched_by_place,
    )
    from calm.motion.sea_level import read_sea_level
    from calm.motion.sensors import read_sensors
    from calm.motion.task import without
    from calm.motion.usable import plausible, unusable
    from calm.suggestions import not_among

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
    used = []
    for i, at in points.items():
        one, said = plausible(sensors[i], float(still[at]), seabed)
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
        "currents": ", ".join(one.source for one in read),
        "pressures": ", ".join(dict.fromkeys(one.source for one in sensors)),
    }
    return measured, notes, source
